//! Gmsh's types of elements.

use crate::fe::mesh::CellKind;

/// What an element of a file is to a plane mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementKind {
    /// A cell. Gmsh lists its nodes as [`CellKind`] does: corners, then midsides from the side between the first two corners on.
    Cell(CellKind),
    /// A point or a piece of a curve, with its number of nodes.
    Part { dimension: i64, n_nodes: usize },
    /// Something else, with its name and what to do.
    Other(&'static str, &'static str),
}

const VOLUME: &str = "a plane body has no volumes: mesh in two dimensions only (gmsh -2)";
const ORDER: &str = "set Mesh.ElementOrder to 1 or 2";
const INNER_NODE: &str =
    "use serendipity elements (Mesh.SecondOrderIncomplete), or those of first order";

impl ElementKind {
    /// The element of gmsh's number `kind`.
    pub(super) fn of(kind: i64) -> Self {
        match kind {
            15 => Self::Part {
                dimension: 0,
                n_nodes: 1,
            },
            1 => Self::Part {
                dimension: 1,
                n_nodes: 2,
            },
            8 => Self::Part {
                dimension: 1,
                n_nodes: 3,
            },
            2 => Self::Cell(CellKind::Tri3),
            3 => Self::Cell(CellKind::Quad4),
            9 => Self::Cell(CellKind::Tri6),
            16 => Self::Cell(CellKind::Quad8),
            10 => Self::Other("9-node quadrilateral", INNER_NODE),
            4 | 11 | 29..=31 => Self::Other("tetrahedron", VOLUME),
            5 | 12 | 17 | 92 | 93 => Self::Other("hexahedron", VOLUME),
            6 | 13 | 18 | 90 | 91 => Self::Other("prism", VOLUME),
            7 | 14 | 19 | 118 => Self::Other("pyramid", VOLUME),
            20..=25 => Self::Other("triangle of higher order", ORDER),
            26..=28 => Self::Other("line of higher order", ORDER),
            36..=38 | 47..=51 => Self::Other("quadrilateral of higher order", ORDER),
            _ => Self::Other("thing that is not known", ORDER),
        }
    }

    pub(super) fn dimension(self) -> i64 {
        match self {
            Self::Part { dimension, .. } => dimension,
            Self::Cell(_) | Self::Other(..) => 2,
        }
    }
}

/// Lists the nodes of a cell the other way round, from the same first corner.
pub(super) fn turn(kind: CellKind, nodes: &mut [usize]) {
    let (corners, midsides) = nodes.split_at_mut(kind.n_corners());
    corners[1..].reverse();
    midsides.reverse();
}
