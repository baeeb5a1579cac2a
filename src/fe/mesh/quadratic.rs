//! From cells with straight sides to cells with midside nodes: one per edge, `x_m = (x_a + x_b) / 2`.

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
        let mut cells = self.cells().enumerate();
        if let Some((cell, other)) = cells.find(|(_, cell)| cell.kind != CellKind::Tri3) {
            let kind = other.kind;
            return Err(MeshError::NotTri3 { cell, kind });
        }
        self.to_quadratic()
    }

    /// Gives every edge a midside node in its middle: [`CellKind::Tri3`] become [`CellKind::Tri6`], [`CellKind::Quad4`] become
    /// [`CellKind::Quad8`], numbered as [`Mesh::to_tri6`] does.
    ///
    /// # Errors
    /// [`MeshError::NotLinear`] if there are cells with midside nodes already.
    pub fn to_quadratic(&self) -> Result<Self, MeshError> {
        self.to_quadratic_with(|a, b| lerp(self.nodes[a], self.nodes[b], 0.5))
    }

    /// As [`Mesh::to_quadratic`], with the place (m) of the midside node of an edge between the nodes
    /// `a < b` given by `midside(a, b)`.
    pub(super) fn to_quadratic_with(
        &self,
        midside: impl Fn(usize, usize) -> [f64; 2],
    ) -> Result<Self, MeshError> {
        let mut cells = Vec::with_capacity(self.n_cells());
        let mut sides = Vec::with_capacity(4 * self.n_cells());
        for (index, cell) in self.cells().enumerate() {
            let kind = match cell.kind {
                CellKind::Tri3 => CellKind::Tri6,
                CellKind::Quad4 => CellKind::Quad8,
                kind => return Err(MeshError::NotLinear { cell: index, kind }),
            };
            let mut nodes = cell.nodes.to_vec();
            nodes.resize(kind.n_nodes(), 0);
            for edge in kind.edges() {
                let [from, to] = [edge.from, edge.to].map(|corner| cell.nodes[corner]);
                sides.push(([from.min(to), from.max(to)], index, edge.from));
            }
            cells.push((kind, nodes));
        }
        // sort sides by edge, then edges by the first side that names them
        sides.sort_unstable();
        let mut edges: Vec<_> = sides.chunk_by(|p, q| p.0 == q.0).collect();
        edges.sort_unstable_by_key(|edge| (edge[0].1, edge[0].2));
        let mut nodes = self.nodes.clone();
        for edge in edges {
            let [a, b] = edge[0].0;
            for &(_, cell, side) in edge {
                let (kind, own) = &mut cells[cell];
                own[kind.n_corners() + side] = nodes.len();
            }
            nodes.push(midside(a, b));
        }
        let cells = cells.iter().map(|(kind, nodes)| (*kind, nodes.as_slice()));
        let mut mesh = Self::from_parts(nodes, Cells::new(cells)?)?;
        mesh.cells.regions.clone_from(&self.cells.regions);
        mesh.region_names.clone_from(&self.region_names);
        Ok(mesh)
    }
}
