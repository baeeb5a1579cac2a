//! Outlines drawn inwards: each edge moved by the same distance into the material.

use crate::math::{Vec2, cross, judged::Judged, perp};

/// A convex polygon drawn inwards by up to `offset` (m), over `inset`; returns by how much: never so far that an edge would vanish.
pub(super) fn draw_inwards(vertices: &[Vec2], offset: f64, inset: &mut Vec<Vec2>) -> f64 {
    inset.clear();
    let most = most_inwards(vertices, offset);
    let places = vertices.iter().enumerate();
    inset.extend(places.map(|(vertex, place)| place + most * inwards(vertices, vertex)));
    most
}

/// By how much a loop with its material on the left can be drawn inwards, up to `offset` (m): no edge loses more than a share of
/// itself, and no corner stands out by more than that of a right angle does.
pub(super) fn most_inwards(ring: &[Vec2], offset: f64) -> f64 {
    let n = ring.len();
    let mut most = offset;
    for edge in 0..n {
        let length = (ring[(edge + 1) % n] - ring[edge]).norm();
        let own = bend(ring, edge);
        let taken = own + bend(ring, (edge + 1) % n);
        if taken > 0.0 {
            most = most.min(KEPT * length / taken);
        }
        // How far the tip of a corner stands out of its rounding, per unit.
        let tip = (1.0 + own.powi(2)).sqrt() - 1.0;
        most = most.min(TIP * offset / tip.max(TIP));
    }
    most
}

/// How a vertex of a loop with its material on the left moves when both its edges move inwards by one.
pub(super) fn inwards(ring: &[Vec2], vertex: usize) -> Vec2 {
    let along = direction(ring, vertex);
    perp(along) + bend(ring, vertex) * along
}

fn direction(ring: &[Vec2], edge: usize) -> Vec2 {
    (ring[(edge + 1) % ring.len()] - ring[edge]).normalize()
}

/// Tangent of half the turn at a vertex: how far a unit offset moves it along either edge.
fn bend(ring: &[Vec2], vertex: usize) -> f64 {
    let n = ring.len();
    let [before, after] = [(vertex + n - 1) % n, vertex].map(|edge| direction(ring, edge));
    cross(before, after) / (1.0 + before.dot(&after)).max(f64::MIN_POSITIVE)
}

/// What the tip of a corner may stand out of its rounding, relative to the offset: as much as that of a right angle does.
const TIP: f64 = std::f64::consts::SQRT_2 - 1.0;

/// Share of an edge that drawing inwards may take: a quarter leaves a core that is no sliver, whatever the polygon.
pub(super) const KEPT: Judged = Judged::new("coupling::KEPT", 0.25);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_drawn_inwards_keeps_its_faces_at_the_offset() {
        let corners = [[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]].map(Vec2::from);
        let mut inset = Vec::new();
        let by = draw_inwards(&corners, 0.1, &mut inset);
        assert_eq!(by, 0.1);
        let expected = [[-1.9, -0.9], [1.9, -0.9], [1.9, 0.9], [-1.9, 0.9]].map(Vec2::from);
        for (found, expected) in inset.iter().zip(expected) {
            assert!((found - expected).norm() < 1e-15, "{found}");
        }
    }

    #[test]
    fn a_sliver_is_drawn_inwards_by_less_than_its_shortest_edge() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-3]].map(Vec2::from);
        let mut inset = Vec::new();
        let by = draw_inwards(&corners, 0.1, &mut inset);
        assert!(by > 1e-5 && by < 5e-4, "{by}");
        let area = cross(inset[1] - inset[0], inset[2] - inset[0]);
        assert!(area > 0.0);
    }

    #[test]
    fn the_edges_of_a_loop_with_a_notch_and_of_a_hole_move_into_the_material() {
        let notched = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 2.0], [0.0, 4.0]].map(Vec2::from);
        let hole = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]].map(Vec2::from);
        for ring in [&notched[..], &hole[..]] {
            let by = most_inwards(ring, 0.01);
            assert!(by > 0.0 && by <= 0.01, "{by}");
            let n = ring.len();
            for edge in 0..n {
                let next = (edge + 1) % n;
                let [start, end] =
                    [edge, next].map(|vertex| ring[vertex] + by * inwards(ring, vertex));
                let inner = perp(direction(ring, edge));
                for place in [start, end] {
                    let depth = inner.dot(&(place - ring[edge]));
                    assert!((depth - by).abs() < 1e-12, "{depth} of {by}");
                }
            }
        }
    }
}
