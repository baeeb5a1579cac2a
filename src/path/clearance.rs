//! How near a surface is to itself.

use super::{MotionKind, Path, Surfaces};
use crate::math::Vec2;

/// The least distance of a surface from itself (m), of its points from the edges that do not end in them; zero where it crosses or touches
/// itself.
///
/// It is no longer than the shortest edge, whose ends lie that far from edges of each other; a point or a single edge has no other part, and
/// is infinitely far.
pub fn clearance(points: &[Vec2], edges: &[[u32; 2]]) -> f64 {
    if points.is_empty() {
        return f64::INFINITY;
    }
    let lengths = edges.iter().map(|edge| {
        let [from, to] = edge.map(|end| points[end as usize]);
        (to - from).norm()
    });
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    let mut surfaces = Surfaces::default();
    let own = surfaces.add(MotionKind::Flexible, true, points, edges.iter().copied());
    let found = Path::default().apart(&surfaces, [own, own], shortest);
    found.unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::clearance;
    use crate::math::Vec2;

    fn ring(points: &[[f64; 2]]) -> f64 {
        let n = points.len() as u32;
        let points: Vec<Vec2> = points.iter().map(|p| Vec2::new(p[0], p[1])).collect();
        let edges: Vec<[u32; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
        clearance(&points, &edges)
    }

    #[test]
    fn it_is_the_shortest_edge_or_the_narrowest_gap_or_neck() {
        assert_eq!(ring(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), 1.0);
        // A slit of 0.1 from above, and the neck of 0.2 below it.
        let slit = |depth: f64, width: f64| {
            let (left, right) = (1.0 - 0.5 * width, 1.0 + 0.5 * width);
            ring(&[
                [0.0, 0.0],
                [2.0, 0.0],
                [2.0, 1.0],
                [right, 1.0],
                [right, 1.0 - depth],
                [left, 1.0 - depth],
                [left, 1.0],
                [0.0, 1.0],
            ])
        };
        assert!((slit(0.5, 0.1) - 0.1).abs() < 1e-15);
        assert!((slit(0.8, 0.3) - 0.2).abs() < 1e-15);
        // A corner of 30°: the far end of one side is nearer to the other than that is long.
        let sharp = ring(&[[0.0, 0.0], [1.0, 0.0], [0.75_f64.sqrt(), 0.5]]);
        assert!((sharp - 0.5).abs() < 1e-15, "{sharp}");
        assert_eq!(ring(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), 0.0);
        // A side that lies on its neighbour.
        assert_eq!(ring(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0], [0.5, 1.0]]), 0.0);
    }
}
