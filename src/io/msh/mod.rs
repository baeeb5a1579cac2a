//! Meshes that gmsh has made: files `.msh` of the versions 2.2 and 4.1, as text and binary of either byte order.
//!
//! What is read: triangles of three and six nodes and quadrilaterals of four, with their physical groups by name. Cells that run clockwise,
//! as on a surface that looks down, are turned; nodes of no cell are dropped; z is left out where it is constant.
//!
//! The format is described in the manual of gmsh, section "Gmsh file formats".

mod assemble;
mod element;
mod error;
mod file;
mod reader;

pub use error::{MshError, MshPlace};

use crate::fe::mesh::{Mesh, MeshError};
use std::path::Path;

/// A mesh of a file, with the physical groups of its surfaces, curves and points.
///
/// ```
/// use foil2d::io::MshMesh;
/// use foil2d::prelude::*;
///
/// let file = br#"$MeshFormat
/// 2.2 0 8
/// $EndMeshFormat
/// $PhysicalNames
/// 2
/// 1 1 "wall"
/// 2 2 "rubber"
/// $EndPhysicalNames
/// $Nodes
/// 4
/// 1 0 0 0
/// 2 1 0 0
/// 3 1 1 0
/// 4 0 1 0
/// $EndNodes
/// $Elements
/// 2
/// 1 1 2 1 4 4 1
/// 2 3 2 2 1 1 2 3 4
/// $EndElements
/// "#;
/// let msh = MshMesh::from_bytes(file)?;
/// assert_eq!(msh.region("rubber"), Some(&[0][..]));
/// let wall = msh.boundary("wall").unwrap_or_default().to_vec();
/// assert_eq!(wall, [0, 3]);
/// let mut body = FlexBodyBuilder::mesh(msh.mesh);
/// for node in wall {
///     body = body.pin(node, Pin::both());
/// }
/// # Ok::<(), foil2d::io::MshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MshMesh {
    /// Nodes and cells, in the order of the file.
    pub mesh: Mesh,
    /// Physical surfaces, by number. A group without a name has its number for one. Groups may share cells.
    pub regions: Vec<NamedCells>,
    /// Physical curves, then physical points, by number; those of the same name are one. A group that only has nodes of no cell, such as the centre of an
    /// arc, is empty.
    pub boundaries: Vec<NamedNodes>,
    /// Nodes of the file that belong to no cell, and were dropped.
    pub n_dropped_nodes: usize,
}

/// A physical surface: some cells with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedCells {
    /// The name, or the number where there is no name.
    pub name: String,
    /// Indices of the cells in the mesh, ascending.
    pub cells: Vec<usize>,
}

/// A physical curve or point: some nodes with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedNodes {
    /// The name, or the number where there is no name.
    pub name: String,
    /// Indices of the nodes in the mesh, ascending.
    pub nodes: Vec<usize>,
}

impl MshMesh {
    /// Reads a file whose cells hang together.
    ///
    /// # Errors
    /// If the file cannot be read, is none of gmsh's, or gives no mesh: see [`MshError`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, MshError> {
        Self::from_bytes(&contents(path.as_ref())?)
    }

    /// Reads the contents of a file whose cells hang together.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, MshError> {
        assemble::whole(bytes)
    }

    /// Reads a file with any number of pieces, each a mesh of its own, ordered by their first cells. A group is told with each piece that it has a part in.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_pieces(path: impl AsRef<Path>) -> Result<Vec<Self>, MshError> {
        Self::pieces_from_bytes(&contents(path.as_ref())?)
    }

    /// Reads the contents of a file with any number of pieces, as [`read_pieces`](Self::read_pieces).
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn pieces_from_bytes(bytes: &[u8]) -> Result<Vec<Self>, MshError> {
        assemble::pieces(bytes)
    }

    /// The mesh with its physical surfaces as named regions, for [`FlexBodyBuilder::region_material`](crate::body::FlexBodyBuilder::region_material):
    /// numbered from one in their order, zero where there is none. A cell of several is of the one with the fewest cells.
    ///
    /// # Errors
    /// If two of the same name remain.
    pub fn mesh_with_regions(&self) -> Result<Mesh, MeshError> {
        let mut numbered: Vec<(u32, &NamedCells)> = (1..).zip(&self.regions).collect();
        numbered.sort_by_key(|(_, region)| std::cmp::Reverse(region.cells.len()));
        let mut regions = vec![0; self.mesh.n_cells()];
        for &(number, region) in &numbered {
            for &cell in &region.cells {
                regions[cell] = number;
            }
        }
        let mut mesh = self.mesh.clone().with_regions(regions)?;
        let present = mesh.regions();
        for (number, region) in numbered {
            if present.contains(&number) {
                mesh = mesh.with_region_name(number, &region.name)?;
            }
        }
        Ok(mesh)
    }

    /// Cells of the physical surface of this name.
    pub fn region(&self, name: &str) -> Option<&[usize]> {
        let found = self.regions.iter().find(|region| region.name == name)?;
        Some(&found.cells)
    }

    /// Nodes of the physical curves and points of this name.
    pub fn boundary(&self, name: &str) -> Option<&[usize]> {
        let found = self.boundaries.iter().find(|set| set.name == name)?;
        Some(&found.nodes)
    }
}

fn contents(path: &Path) -> Result<Vec<u8>, MshError> {
    std::fs::read(path).map_err(|source| MshError::Unreadable {
        path: path.to_owned(),
        source,
    })
}
