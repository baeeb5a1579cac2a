//! The distance of a point from an edge, and where on a chain of edges a point has its feet.
//!
//! A point lies in the cone of a vertex `v` if it is beside `v` along every edge that meets there, `(p - v)·(w - v) ≤ 0`
//! for each neighbour `w`. Where edges meet in a straight line the two signs are opposite, and a point has either a foot
//! inside one of the edges or lies in the cone of the joint: one row, whichever way it slides. Rounding would spoil that at
//! the joint itself, so both questions are asked of the *same* number against the *same* positive bound (see [`Beside`]):
//! whoever has a foot inside an edge is not in the cone of its end, and two feet inside straight edges would need an error
//! larger than the bound.

use crate::math::{Vec2, cross, perp};

/// Bound of the rounding of coordinates in a projection, in ulp of the largest: two coordinates of the point and four of the
/// joint and its neighbours may be off by one each, and products and sums round again; 16 covers both components of them.
/// The foot it misplaces is some 1e-14 of the coordinates away, less than a millionth of the least distance that bodies in
/// single precision can keep.
const PROJECTION_ULPS: f64 = 16.0;

/// The point of an edge that is closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Where it lies, from 0 at the start to 1 at the end.
    pub xi: f64,
    /// From the foot to the point, of length one; zero where the distance is.
    pub normal: Vec2,
    /// The distance (m).
    pub distance: f64,
}

/// How far a point lies inside each end of an edge, `(p - a)·(b - a)` and `(p - b)·(a - b)` (m²), and what counts as not
/// at all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    pub inside: [f64; 2],
    bounds: [f64; 2],
}

impl Beside {
    #[inline]
    pub fn of(point: Vec2, [a, b]: [Vec2; 2]) -> Self {
        let edge = b - a;
        let largest = |v: Vec2| v.x.abs().max(v.y.abs());
        let size = largest(point).max(largest(a)).max(largest(b));
        let arms = [point - a, b - point];
        // What an error of an ulp in every coordinate makes of a product of two differences.
        let ulps = PROJECTION_ULPS * f64::EPSILON * size;
        Self {
            inside: arms.map(|arm| arm.dot(&edge)),
            bounds: arms.map(|arm| ulps * (largest(edge) + largest(arm))),
        }
    }

    /// Whether the foot lies inside the edge, away from both ends.
    #[inline]
    pub fn is_inner(&self) -> bool {
        self.inside[0] > self.bounds[0] && self.inside[1] > self.bounds[1]
    }

    /// Whether the point is beside an end (0 the start, 1 the end), as the cone of that vertex asks it.
    #[inline]
    pub fn is_beyond(&self, end: usize) -> bool {
        self.inside[end] <= self.bounds[end]
    }
}

/// The closest point of an edge.
#[inline]
pub fn foot_on(point: Vec2, ends: [Vec2; 2]) -> Foot {
    let [a, b] = ends;
    let edge = b - a;
    let (from_start, from_end) = ((point - a).dot(&edge), (b - point).dot(&edge));
    if from_start > 0.0 && from_end > 0.0 {
        return inner_foot(point, ends, [from_start, from_end]);
    }
    // Of an edge of length zero both ends are as good.
    let (xi, vertex) = if from_start <= 0.0 {
        (0.0, a)
    } else {
        (1.0, b)
    };
    let (normal, distance) = direction(vertex, point);
    Foot {
        xi,
        normal,
        distance,
    }
}

/// The square of the distance from an edge (m²).
#[inline]
pub(super) fn square_distance(point: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let (edge, arm, back) = (b - a, point - a, b - point);
    if arm.dot(&edge) <= 0.0 {
        arm.norm_squared()
    } else if back.dot(&edge) <= 0.0 {
        back.norm_squared()
    } else {
        let area = cross(edge, arm);
        area * area / edge.norm_squared()
    }
}

/// The foot inside an edge, from the projections on it. The normal is that of the edge: it does not suffer from the
/// rounding of a short distance.
#[inline]
pub(super) fn inner_foot(point: Vec2, [a, b]: [Vec2; 2], [from_start, from_end]: [f64; 2]) -> Foot {
    let edge = b - a;
    let length = edge.norm();
    // From the nearer end, whose difference rounds less.
    let arm = if from_start <= from_end {
        point - a
    } else {
        point - b
    };
    let height = cross(edge, arm) / length;
    let normal = if height == 0.0 {
        Vec2::zeros()
    } else {
        perp(edge) * (height.signum() / length)
    };
    let xi = from_start / (from_start + from_end);
    Foot {
        xi,
        normal,
        distance: height.abs(),
    }
}

/// Direction, of length one or zero, and distance (m) from one point to another.
#[inline]
pub(super) fn direction(from: Vec2, to: Vec2) -> (Vec2, f64) {
    let way = to - from;
    let distance = way.norm();
    if distance > 0.0 {
        (way / distance, distance)
    } else {
        (Vec2::zeros(), 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{Beside, foot_on};
    use crate::path::samples::Random;

    #[test]
    fn the_foot_is_the_closest_of_many_points_of_the_edge() {
        let mut random = Random::new(1);
        for _ in 0..2_000 {
            let [p, a, b] = [(); 3].map(|()| random.point(1.0));
            let foot = foot_on(p, [a, b]);
            let brute = (0..=1_000).map(|k| (p - a - (b - a) * (f64::from(k) * 1e-3)).norm());
            let brute = brute.fold(f64::INFINITY, f64::min);
            // The nearest sample is half a thousandth of the edge away: d² grows by the square of that.
            assert!(foot.distance <= brute + 1e-15);
            assert!(brute * brute - foot.distance * foot.distance <= 0.25e-6 * 8.0);
            assert!((super::square_distance(p, [a, b]).sqrt() - foot.distance).abs() < 4e-15);
            assert!((a + (b - a) * foot.xi + foot.normal * foot.distance - p).norm() < 8e-15);
        }
    }

    #[test]
    fn inside_an_edge_and_beside_its_end_exclude_each_other() {
        let mut random = Random::new(2);
        for _ in 0..10_000 {
            let [p, a, b] = [(); 3].map(|()| random.point(1.0));
            // Exactly above an end as often as not.
            let p = if random.unit() < 0.5 {
                p
            } else {
                a + crate::math::perp(b - a)
            };
            let beside = Beside::of(p, [a, b]);
            assert_ne!(
                beside.is_inner(),
                beside.is_beyond(0) || beside.is_beyond(1)
            );
        }
    }
}
