//! Rows of a member with itself.

use super::tests::PAIR;
use crate::math::Vec2;
use crate::path::{MemberPair, MotionKind, Path, Surfaces, Target};

const OWN: MemberPair = MemberPair { other: 0, ..PAIR };

#[test]
fn a_member_against_itself_leaves_out_the_edges_of_a_point_but_not_their_ends() {
    // A hairpin: two long legs, .1 apart.
    let hairpin = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.1], [0.0, 0.1]].map(|[x, y]| Vec2::new(x, y));
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Flexible, false, &hairpin, false);
    let mut rows = Vec::new();
    Path::new().near(&surfaces, &[OWN], 0.2, &mut rows);
    // The free ends are in each other's cones, and so are the corners, but for the edge that joins them: it may not vanish.
    let found: Vec<_> = rows.iter().map(|row| (row.point, row.target)).collect();
    assert_eq!(found, [(0, Target::Vertex(3)), (1, Target::Vertex(2))]);
    // Known to stay apart, it is not asked.
    let asleep = MemberPair {
        is_asleep: true,
        ..OWN
    };
    Path::new().near(&surfaces, &[asleep], 0.2, &mut rows);
    assert!(rows.is_empty());
}

#[test]
fn a_member_folded_at_a_vertex_has_a_row_with_its_neighbour() {
    // Two edges that close to 3°: the free end of the shorter one over the inside of the other.
    let fold = [[0.6, 0.03], [0.0, 0.0], [1.0, 0.0]].map(|[x, y]| Vec2::new(x, y));
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Flexible, false, &fold, false);
    let mut rows = Vec::new();
    Path::new().near(&surfaces, &[OWN], 0.1, &mut rows);
    let found: Vec<_> = rows.iter().map(|row| (row.point, row.target)).collect();
    assert_eq!(found, [(0, Target::Edge(1))]);
    assert!((rows[0].distance - 0.03).abs() < 1e-15);
}
