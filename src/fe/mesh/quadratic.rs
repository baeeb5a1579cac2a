//! From 3-node to 6-node triangles: one midside node per edge, `x_m = (x_a + x_b) / 2`.

use super::geometry::lerp;
use super::{CellKind, Cells, Mesh, MeshError};

impl Mesh {
    /// Gives every edge of a mesh of [`CellKind::Tri3`] a midside node in its middle.
    ///
    /// Old nodes and cells keep their numbers, and cells their regions; the new nodes follow in the order in which the sides
    /// 0-1, 1-2, 2-0 of the cells first name their edge.
    ///
    /// # Errors
    /// [`MeshError::NotTri3`] if there are cells of another kind.
    pub fn to_tri6(&self) -> Result<Self, MeshError> {
        self.to_tri6_with(|a, b| lerp(self.nodes[a], self.nodes[b], 0.5))
    }

    /// As [`Mesh::to_tri6`], with the place (m) of the midside node of an edge between the nodes
    /// `a < b` given by `midside(a, b)`.
    pub(super) fn to_tri6_with(
        &self,
        midside: impl Fn(usize, usize) -> [f64; 2],
    ) -> Result<Self, MeshError> {
        let mut cells = Vec::with_capacity(self.n_cells());
        let mut sides = Vec::with_capacity(3 * self.n_cells());
        for (index, cell) in self.cells().enumerate() {
            let &[a, b, c] = cell.nodes else {
                return Err(MeshError::NotTri3 {
                    cell: index,
                    kind: cell.kind,
                });
            };
            cells.push([a, b, c, 0, 0, 0]);
            for (side, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                sides.push(([from.min(to), from.max(to)], index, side));
            }
        }
        // sort sides by edge, then edges by the first side that names them
        sides.sort_unstable();
        let mut edges: Vec<_> = sides.chunk_by(|p, q| p.0 == q.0).collect();
        edges.sort_unstable_by_key(|edge| (edge[0].1, edge[0].2));
        let mut nodes = self.nodes.clone();
        for edge in edges {
            let [a, b] = edge[0].0;
            for &(_, cell, side) in edge {
                cells[cell][3 + side] = nodes.len();
            }
            nodes.push(midside(a, b));
        }
        let cells = cells.iter().map(|cell| (CellKind::Tri6, cell.as_slice()));
        let mut mesh = Self::from_parts(nodes, Cells::new(cells)?)?;
        mesh.cells.regions.clone_from(&self.cells.regions);
        mesh.region_names.clone_from(&self.region_names);
        Ok(mesh)
    }
}
