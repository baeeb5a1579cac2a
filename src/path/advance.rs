//! Directional advancement of one point against one edge.
//!
//! At an instant with closest points, distance `d` and direction `n` between them, look at
//! `f(s) = n·(p - x) - floor` for the point `p` and each end `x` of the edge, `s` from 0 to 1 over what is left of the
//! motion. While both are ≥ 0 the line across `n` keeps the pair apart, so `d ≥ floor`. Motion across `n` and motion shared
//! by both do not enter: who slides or moves along is never slowed down. Turning bends `f` by `|f''| ≤ C`, so
//!
//! ```text
//! f(s) ≥ (1 - s) A + s B - ½ C s (1 - s),    A = f(0), B = f(1)
//! f(s) ≥ A + f'(0) s - ½ C s²
//! ```
//!
//! The first is ≥ 0 throughout iff `A, B ≥ 0` and `√A + √B ≥ √(C/2)`. Otherwise the motion is safe up to the later of the
//! first roots, from where it goes on with new closest points. The same holds with `n` turning at the rate of the edge's
//! body, seen from which the edge stands still; without that choice a long edge that turns fast leaves `n` behind at once.

use super::Surfaces;
use super::distance::foot_on;
use super::motion::{Motion, Track, turned};
use crate::math::{Vec2, perp, sin_cos};

/// Advances of one point against one edge before what is safe by then is taken. A few are usual; a point that follows an
/// edge through several turns takes some tens.
const ADVANCES: usize = 128;

/// A point and an edge whose ways come near each other, with distance and direction at the start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub point: usize,
    pub edge: usize,
    pub members: [usize; 2],
    pub distance: f64,
    pub normal: Vec2,
}

/// What became of a candidate.
pub(super) struct Advanced {
    /// Up to where it is safe; `None` if all the way.
    pub stop: Option<f64>,
    pub advances: usize,
    /// Stopped because the advances ran out.
    pub exhausted: bool,
}

/// A point, both ends of an edge, how they move, how near they may come, and what counts as there (m).
pub(super) struct Ways {
    point: Track,
    ends: [Track; 2],
    /// From each end to the point when the motion is over (m).
    last: [Vec2; 2],
    floor: f64,
    arrived: f64,
}

impl Ways {
    #[inline]
    pub fn of(
        (surfaces, motion): (&Surfaces, &Motion),
        candidate: &Candidate,
        (floor, arrived): (f64, f64),
    ) -> Self {
        let [of, against] = candidate.members;
        let ends = surfaces.edges()[candidate.edge].map(|end| end as usize);
        let to = motion.ends()[candidate.point];
        Self {
            point: motion.track(surfaces, of, candidate.point),
            ends: ends.map(|end| motion.track(surfaces, against, end)),
            last: ends.map(|end| to - motion.ends()[end]),
            floor,
            arrived,
        }
    }

    /// Advances from the start until the floor, or until an instant beyond which nobody asks.
    pub fn advance(&self, candidate: &Candidate, until: f64) -> Advanced {
        let mut advanced = Advanced {
            stop: None,
            advances: 0,
            exhausted: false,
        };
        let (mut normal, mut distance, mut t) = (candidate.normal, candidate.distance, 0.0);
        if distance == 0.0 {
            // No direction keeps them apart.
            advanced.stop = Some(0.0).filter(|&t| t < until);
            return advanced;
        }
        loop {
            let now = Instant::of(self, t);
            if t > 0.0 {
                let foot = foot_on(now.point, now.ends);
                (normal, distance) = (foot.normal, foot.distance);
            }
            let safe = self.safe_share(&now, normal);
            let next = t + (1.0 - t) * safe;
            if safe >= 1.0 || next >= until {
                return advanced;
            }
            let has_arrived = t > 0.0 && distance <= self.arrived;
            if has_arrived || advanced.advances == ADVANCES {
                advanced.exhausted = !has_arrived;
                advanced.stop = Some(t);
                return advanced;
            }
            advanced.advances += 1;
            t = next;
        }
    }

    /// How much of what is left is safe with this direction, either standing or turning with the edge's body.
    fn safe_share(&self, now: &Instant, normal: Vec2) -> f64 {
        let left = 1.0 - now.t;
        let [rate, own] = [self.ends[0].turn * left, self.point.turn * left];
        let radius = self.ends[0].radius.max(self.ends[1].radius);
        // Standing: only the arms bend the ways.
        let bend = self.point.radius * own * own + radius * rate * rate;
        let standing = self.share(now, (normal, normal, 0.0), bend);
        if rate == 0.0 || standing >= 1.0 {
            return standing;
        }
        // Turning: y = R(-ω s)(C + s V + R(ω_p s) r_p) - r_x with the edge's body at the origin, so
        // |y''| ≤ ω² |C + s V| + 2 |ω V| + (ω_p - ω)² r_p.
        let carrier = |track: &Track, t: f64| track.carrier + track.shift * t;
        let apart = |t: f64| (carrier(&self.point, t) - carrier(&self.ends[0], t)).norm();
        let shift = (self.point.shift - self.ends[0].shift).norm() * left;
        let relative = own - rate;
        let bend = rate * rate * apart(now.t).max(apart(1.0))
            + 2.0 * rate.abs() * shift
            + relative * relative * self.point.radius;
        let last = turned(normal, sin_cos(rate));
        standing.max(self.share(now, (normal, last, rate), bend))
    }

    /// The same for one direction: now, at the end, and its rate of turning (rad over what is left).
    #[inline]
    fn share(&self, now: &Instant, (normal, last, rate): (Vec2, Vec2, f64), bend: f64) -> f64 {
        let left = 1.0 - now.t;
        let across = perp(normal) * rate;
        let mut share = 1.0_f64;
        for end in 0..2 {
            let arm = now.point - now.ends[end];
            let first = (normal.dot(&arm) - self.floor).max(0.0);
            let final_ = last.dot(&self.last[end]) - self.floor;
            let by_chord = chord_root(first, final_, 0.5 * bend);
            if by_chord >= 1.0 {
                continue;
            }
            let slope =
                normal.dot(&(now.point_rate - now.end_rates[end])) * left + across.dot(&arm);
            share = share.min(by_chord.max(tangent_root(first, slope, bend)));
        }
        share
    }
}

/// Positions (m) and their derivatives by `t` at an instant.
struct Instant {
    t: f64,
    point: Vec2,
    point_rate: Vec2,
    ends: [Vec2; 2],
    end_rates: [Vec2; 2],
}

impl Instant {
    #[inline]
    fn of(ways: &Ways, t: f64) -> Self {
        let (point, point_rate) = ways.point.at(t, ways.point.heading(t));
        // Both ends turn alike.
        let turned_by = ways.ends[0].heading(t);
        let [(a, a_rate), (b, b_rate)] = ways.ends.map(|end| end.at(t, turned_by));
        Self {
            t,
            point,
            point_rate,
            ends: [a, b],
            end_rates: [a_rate, b_rate],
        }
    }
}

/// First root in (0, 1) of `(1 - s) first + s last - half_bend s (1 - s)` with `first ≥ 0`; 1 if there is none.
#[inline]
fn chord_root(first: f64, last: f64, half_bend: f64) -> f64 {
    if last >= 0.0 && first.sqrt() + last.sqrt() >= half_bend.sqrt() {
        return 1.0;
    }
    // half_bend s² - slope s + first = 0, in the form that does not cancel.
    let slope = first - last + half_bend;
    let root = (slope * slope - 4.0 * half_bend * first).max(0.0).sqrt();
    (2.0 * first / (slope + root)).min(1.0)
}

/// First positive root of `first + slope s - ½ bend s²` with `first ≥ 0`; infinite if there is none.
#[inline]
fn tangent_root(first: f64, slope: f64, bend: f64) -> f64 {
    let root = (slope * slope + 2.0 * bend * first).sqrt();
    if slope < 0.0 {
        2.0 * first / (root - slope)
    } else if bend > 0.0 {
        (root + slope) / bend
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::{chord_root, tangent_root};

    #[test]
    fn the_bound_by_start_and_end_is_sharp() {
        // (1 - s) A + s B - h s (1 - s) touches zero where √A + √B = √h.
        for (a, b) in [(0.04, 0.09), (1e-6, 0.2), (0.0, 0.3), (0.5, 0.0)] {
            let half_bend = (f64::sqrt(a) + f64::sqrt(b)).powi(2);
            assert_eq!(chord_root(a, b, half_bend * (1.0 - 1e-9)), 1.0);
            let root = chord_root(a, b, half_bend * (1.0 + 1e-9));
            let touch = f64::sqrt(a) / half_bend.sqrt();
            // A relative change of 1e-9 moves a double root by its square root.
            assert!((root - touch).abs() < 1e-4, "{root} {touch}");
        }
        assert_eq!(chord_root(1.0, -1.0, 0.0), 0.5);
        assert_eq!(tangent_root(1.0, -2.0, 0.0), 0.5);
        assert_eq!(tangent_root(1.0, 0.0, 2.0), 1.0);
        assert_eq!(tangent_root(1.0, 0.0, 0.0), f64::INFINITY);
    }
}
