//! Whether an obstacle goes through the surface within an increment. Nodes are kept out of obstacles where increments end; on the way between, taken as
//! straight, the line that an obstacle is around must cross no segment of the surface: its ends none of these, and their nodes not the line.

use super::obstacle::Obstacle;
use crate::math::{Vec2, cross, node_vec};

/// Places at the beginning and at the end of an increment (m).
type Way = [Vec2; 2];

/// A node of the surface that an obstacle goes through, with the place of the obstacle in the list.
///
/// - `segments`: of the surface, by their nodes;
/// - `positions`: of the nodes at the beginning and at the end (m);
/// - `shares`: of the case, at the beginning and at the end (-).
pub(super) fn passed(
    obstacles: &[Obstacle],
    segments: &[[usize; 2]],
    positions: [&[f64]; 2],
    shares: [f64; 2],
) -> Option<(usize, usize)> {
    let way_of = |node: usize| positions.map(|positions| node_vec(positions, node));
    obstacles.iter().enumerate().find_map(|(index, obstacle)| {
        let line = obstacle.line()?;
        let line = line.map(|end| shares.map(|share| end + obstacle.gone(share)));
        let is_long = line[0] != line[1];
        let mut passes = segments.iter().filter(|nodes| {
            let surface = nodes.map(way_of);
            line.iter().any(|end| crosses(*end, surface)) || is_long && crosses(surface[0], line)
        });
        passes.next().map(|nodes| (nodes[0], index))
    })
}

/// Whether a point crosses a segment while it and both ends of that go straight on.
///
/// In line with both ends it is where `(b - a) × (p - a) = 0`, a quadratic equation in the share of the way.
fn crosses(point: Way, [first, second]: [Way; 2]) -> bool {
    let relative = |way: Way| {
        let start = way[0] - first[0];
        (start, way[1] - first[1] - start)
    };
    let ((p, p_moved), (e, e_moved)) = (relative(point), relative(second));
    let constant = cross(e, p);
    let linear = cross(e, p_moved) + cross(e_moved, p);
    let square = cross(e_moved, p_moved);
    let root = (linear * linear - 4.0 * square * constant).sqrt();
    let sum = -0.5 * (linear + root.copysign(linear));
    [sum / square, constant / sum].into_iter().any(|share| {
        let (at, edge) = (p + share * p_moved, e + share * e_moved);
        let along = at.dot(&edge);
        (0.0..=1.0).contains(&share) && along >= 0.0 && along <= edge.norm_squared()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::samples::Random;

    /// Random ways of a point and a segment, against a thousand places on them.
    #[test]
    fn a_crossing_is_one_of_places_on_the_way() {
        let mut random = Random::new(17);
        let (mut n_crossed, mut n_apart) = (0, 0);
        for _ in 0..2000 {
            let mut way = || [random.point(1.0), random.point(1.0)];
            let (point, ends) = (way(), [way(), way()]);
            let side = |share: f64| {
                let [p, a, b] =
                    [point, ends[0], ends[1]].map(|way| way[0] + share * (way[1] - way[0]));
                let edge = b - a;
                let along = (p - a).dot(&edge) / edge.norm_squared();
                (cross(edge, p - a), along)
            };
            let mut last = side(0.0);
            let (mut expected, mut is_clear) = (false, true);
            for k in 1..=1000 {
                let now = side(f64::from(k) / 1000.0);
                if last.0 * now.0 <= 0.0 {
                    let along = 0.5 * (last.1 + now.1);
                    expected |= (0.0..=1.0).contains(&along);
                    // At an end a thousandth decides.
                    is_clear &= along.abs() > 0.02 && (along - 1.0).abs() > 0.02;
                }
                // Two roots between two places.
                is_clear &= now.0.abs() > 1e-5 || last.0 * now.0 <= 0.0;
                last = now;
            }
            if is_clear {
                assert_eq!(crosses(point, ends), expected, "{point:?} {ends:?}");
                n_crossed += usize::from(expected);
                n_apart += usize::from(!expected);
            }
        }
        assert!(n_crossed > 200 && n_apart > 200, "{n_crossed} {n_apart}");
    }

    /// What goes along with the point is not crossed, and what stands still is.
    #[test]
    fn what_goes_along_is_not_crossed() {
        let down = Vec2::new(0.1, -2.0);
        let [point, left, right] = [[0.0, 0.1], [-1.0, 0.0], [1.0, 0.0]].map(Vec2::from);
        let at_rest = |place: Vec2| [place, place];
        let along = |place: Vec2| [place, place + down];
        assert!(crosses(along(point), [left, right].map(at_rest)));
        assert!(!crosses(along(point), [left, right].map(along)));
        assert!(!crosses(at_rest(point), [left, right].map(at_rest)));
    }
}
