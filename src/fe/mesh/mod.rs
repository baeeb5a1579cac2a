//! Meshes: a body is one connected set of cells that cover each of its points once,
//! `Ω = ∪ cells`, with its boundary `∂Ω` as closed loops that keep the material on their left.
//!
//! A [`Mesh`] is checked when it is made and does not change afterwards, so whoever holds one may
//! rely on positive Jacobians, on conforming edges and on a boundary that never meets itself.
//! [`generate`] makes meshes of common shapes and of polygons with holes.

mod boundary;
mod cell;
mod crossing;
mod error;
pub mod generate;
mod geometry;
mod quadratic;
mod quality;
mod regions;
mod validate;

use crate::math::hypot;
pub use boundary::{Boundary, BoundaryLoop};
pub use cell::{Cell, CellKind};
pub use error::MeshError;
pub use quality::Quality;

/// Nodes and cells of one body, checked, with its boundary.
///
/// Kinds of cells may be mixed as long as neighbours agree about the nodes on a shared edge.
///
/// ```
/// # use foil2d::fe::mesh::{CellKind, Mesh};
/// let nodes = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let mesh = Mesh::from_cells(nodes, CellKind::Tri3, &[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!(mesh.boundary().nodes(), [0, 1, 2, 3]);
/// assert_eq!(mesh.area(), 1.0);
/// # Ok::<(), foil2d::fe::mesh::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<[f64; 2]>,
    cells: Cells,
    boundary: Boundary,
    /// Of regions that have some, ascending.
    region_names: Vec<(u32, String)>,
}

/// Flat connectivity: cell `c` has the nodes `connectivity[offsets[c]..offsets[c + 1]]`.
#[derive(Debug, Clone, PartialEq)]
struct Cells {
    kinds: Vec<CellKind>,
    offsets: Vec<usize>,
    connectivity: Vec<usize>,
    /// The region of each, or nothing where all are in region 0.
    regions: Vec<u32>,
}

impl Cells {
    fn new<'a>(cells: impl Iterator<Item = (CellKind, &'a [usize])>) -> Result<Self, MeshError> {
        let mut flat = Self {
            kinds: Vec::new(),
            offsets: vec![0],
            connectivity: Vec::new(),
            regions: Vec::new(),
        };
        for (cell, (kind, nodes)) in cells.enumerate() {
            if nodes.len() != kind.n_nodes() {
                return Err(MeshError::WrongNodeCount {
                    cell,
                    kind,
                    expected: kind.n_nodes(),
                    found: nodes.len(),
                });
            }
            flat.kinds.push(kind);
            flat.connectivity.extend_from_slice(nodes);
            flat.offsets.push(flat.connectivity.len());
        }
        Ok(flat)
    }

    fn len(&self) -> usize {
        self.kinds.len()
    }

    fn get(&self, cell: usize) -> Cell<'_> {
        Cell {
            kind: self.kinds[cell],
            nodes: &self.connectivity[self.offsets[cell]..self.offsets[cell + 1]],
            region: self.regions.get(cell).copied().unwrap_or(0),
        }
    }

    fn iter(&self) -> impl ExactSizeIterator<Item = Cell<'_>> + Clone {
        (0..self.len()).map(|cell| self.get(cell))
    }
}

impl Mesh {
    /// Checks and takes a mesh of one kind of cell.
    ///
    /// - `nodes`: coordinates (m).
    /// - `cells`: node indices of each cell, in the order of [`CellKind`]: `&[[usize; 3]]`,
    ///   `&[Vec<usize>]` or anything else that reads as slices.
    ///
    /// # Errors
    /// The first thing found wrong, see [`MeshError`].
    pub fn from_cells<C: AsRef<[usize]>>(
        nodes: Vec<[f64; 2]>,
        kind: CellKind,
        cells: &[C],
    ) -> Result<Self, MeshError> {
        let cells = Cells::new(cells.iter().map(|cell| (kind, cell.as_ref())))?;
        Self::from_parts(nodes, cells)
    }

    /// Checks and takes a mesh in which every cell names its kind.
    ///
    /// - `nodes`: coordinates (m).
    /// - `cells`: kind and node indices of each cell, in the order of [`CellKind`].
    ///
    /// # Errors
    /// The first thing found wrong, see [`MeshError`].
    pub fn from_mixed_cells<C: AsRef<[usize]>>(
        nodes: Vec<[f64; 2]>,
        cells: &[(CellKind, C)],
    ) -> Result<Self, MeshError> {
        let cells = Cells::new(cells.iter().map(|(kind, cell)| (*kind, cell.as_ref())))?;
        Self::from_parts(nodes, cells)
    }

    fn from_parts(nodes: Vec<[f64; 2]>, cells: Cells) -> Result<Self, MeshError> {
        validate::check_nodes(&nodes)?;
        validate::check_indices(&cells, nodes.len())?;
        validate::check_coincidence(&nodes)?;
        validate::check_shapes(&nodes, &cells)?;
        let boundary = Boundary::new(&nodes, &cells)?;
        validate::check_connected(&cells, nodes.len())?;
        boundary.check_simple(&nodes)?;
        Ok(Self {
            nodes,
            cells,
            boundary,
            region_names: Vec::new(),
        })
    }

    /// Coordinates of the nodes (m).
    pub fn nodes(&self) -> &[[f64; 2]] {
        &self.nodes
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Number of cells.
    pub fn n_cells(&self) -> usize {
        self.cells.len()
    }

    /// Cell number `cell`.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn cell(&self, cell: usize) -> Cell<'_> {
        self.cells.get(cell)
    }

    /// All cells in order.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = Cell<'_>> + Clone {
        self.cells.iter()
    }

    /// The boundary loops.
    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// All edges of cells, each once; one with a midside node in two pieces.
    pub fn edges(&self) -> Vec<[usize; 2]> {
        let mut pieces: Vec<[usize; 2]> = Vec::new();
        for cell in self.cells() {
            for edge in cell.kind.edges() {
                let [from, to] = [edge.from, edge.to].map(|corner| cell.nodes[corner]);
                match edge.midside.map(|midside| cell.nodes[midside]) {
                    Some(midside) => pieces.extend([[from, midside], [midside, to]]),
                    None => pieces.push([from, to]),
                }
            }
        }
        for [a, b] in &mut pieces {
            (*a, *b) = (*a.min(b), *a.max(b));
        }
        pieces.sort_unstable();
        pieces.dedup();
        pieces
    }

    /// Area (m^2), with curved sides of quadratic cells integrated exactly.
    pub fn area(&self) -> f64 {
        self.cells().map(|cell| cell.moments(&self.nodes).0).sum()
    }

    /// Centroid of the area (m), with curved sides of quadratic cells integrated exactly.
    pub fn centroid(&self) -> [f64; 2] {
        // moments about a node of the mesh, for accuracy far from the origin
        let origin = self.nodes[0];
        let mut area = 0.0;
        let mut moment = [0.0; 2];
        for cell in self.cells() {
            let (cell_area, cell_moment) = cell.moments(&self.nodes);
            area += cell_area;
            for axis in 0..2 {
                let arm = self.nodes[cell.nodes[0]][axis] - origin[axis];
                moment[axis] += cell_moment[axis] + cell_area * arm;
            }
        }
        [origin[0] + moment[0] / area, origin[1] + moment[1] / area]
    }

    /// The cell nearest to the centroid.
    pub fn middle_cell(&self) -> usize {
        let [x, y] = self.centroid();
        let off = |cell: &usize| {
            let corners = self.cell(*cell).corners();
            let sum = corners.iter().fold([0.0; 2], |[sx, sy], &node| {
                [sx + self.nodes[node][0], sy + self.nodes[node][1]]
            });
            let n = corners.len() as f64;
            hypot(sum[0] / n - x, sum[1] / n - y)
        };
        let nearest = (0..self.n_cells()).min_by(|one, other| off(one).total_cmp(&off(other)));
        nearest.unwrap_or(0)
    }

    /// Measures of the shape of the cells.
    pub fn quality(&self) -> Quality {
        Quality::measure(self)
    }
}
