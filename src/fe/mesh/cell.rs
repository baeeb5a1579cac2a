//! Kinds of cells and the order of their nodes, counter-clockwise for all of them.

use super::geometry;

/// Shape and node order of a cell.
///
/// Corners come first and run counter-clockwise, then the midside nodes in the order of the sides.
///
/// ```text
///  Tri3        2            Tri6        2            Quad4   3-----------2
///             / \                      / \                   |           |
///            /   \                    5   4                  |           |
///           /     \                  /     \                 |           |
///          0-------1                0---3---1                0-----------1
///
///  Quad8   3-----6-----2
///          |           |
///          7           5
///          |           |
///          0-----4-----1
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum CellKind {
    /// Triangle with its three corners.
    Tri3,
    /// Triangle with corners 0, 1, 2 and midside nodes 3 (on 0-1), 4 (on 1-2), 5 (on 2-0).
    Tri6,
    /// Convex quadrilateral with its four corners.
    Quad4,
    /// Quadrilateral with corners 0 to 3 and midside nodes 4 (on 0-1), 5 (on 1-2), 6 (on 2-3), 7 (on 3-0).
    Quad8,
}

/// Side of a cell in local node numbers, the cell on its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LocalEdge {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) midside: Option<usize>,
}

impl CellKind {
    /// Number of nodes.
    pub const fn n_nodes(self) -> usize {
        match self {
            Self::Tri3 => 3,
            Self::Quad4 => 4,
            Self::Tri6 => 6,
            Self::Quad8 => 8,
        }
    }

    /// Number of corners, which is also the number of sides.
    pub const fn n_corners(self) -> usize {
        match self {
            Self::Tri3 | Self::Tri6 => 3,
            Self::Quad4 | Self::Quad8 => 4,
        }
    }

    /// Whether its sides have midside nodes.
    pub const fn is_quadratic(self) -> bool {
        matches!(self, Self::Tri6 | Self::Quad8)
    }

    /// Name as written in the code, such as `Tri3`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tri3 => "Tri3",
            Self::Tri6 => "Tri6",
            Self::Quad4 => "Quad4",
            Self::Quad8 => "Quad8",
        }
    }

    pub(super) fn edges(self) -> impl Iterator<Item = LocalEdge> {
        let n = self.n_corners();
        (0..n).map(move |from| LocalEdge {
            from,
            to: (from + 1) % n,
            midside: self.is_quadratic().then_some(n + from),
        })
    }
}

impl std::fmt::Display for CellKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// One cell of a [`Mesh`](super::Mesh), borrowed from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell<'a> {
    /// Shape and node order.
    pub kind: CellKind,
    /// Indices of its nodes in the mesh, in the order of [`CellKind`].
    pub nodes: &'a [usize],
    /// What it is made of: its region, 0 unless [said](super::Mesh::with_regions) otherwise.
    pub region: u32,
}

impl<'a> Cell<'a> {
    /// Indices of its corners, counter-clockwise.
    pub fn corners(&self) -> &'a [usize] {
        &self.nodes[..self.kind.n_corners()]
    }

    /// Coordinates of its nodes (m); only the first `kind.n_nodes()` entries are used.
    pub(super) fn points(&self, nodes: &[[f64; 2]]) -> [[f64; 2]; 8] {
        let mut points = [[0.0; 2]; 8];
        for (point, &node) in points.iter_mut().zip(self.nodes) {
            *point = nodes[node];
        }
        points
    }

    /// Signed area (m^2) and first moments (m^3) about the first node.
    pub(super) fn moments(&self, nodes: &[[f64; 2]]) -> (f64, [f64; 2]) {
        geometry::cell_moments(self.kind, &self.points(nodes))
    }
}
