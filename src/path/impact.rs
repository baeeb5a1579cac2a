//! The time of impact: how much of a motion is safe.
//!
//! Directional advancement. At an instant with closest points, distance `d` and direction `n` between them, look at
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

use super::distance::foot_on;
use super::motion::{Motion, Track, turned};
use super::search::Extent;
use super::surfaces::MotionKind;
use super::{MemberPair, Path, Surfaces};
use crate::math::{Vec2, perp, sin_cos};

/// Advances of one point against one edge before what is safe by then is taken. A few are usual; a point that follows an
/// edge through several turns takes some tens.
const ADVANCES: usize = 128;
/// Share of the way from the start to the floor at which an approach counts as arrived: each advance covers at least half
/// of what is left when nothing turns, so this costs six advances and a fiftieth of the way.
const ARRIVED: f64 = 0.02;

/// A member pair that comes to its floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which of the member pairs.
    pub pair: usize,
    /// The point.
    pub point: usize,
    /// The edge it comes near to.
    pub edge: usize,
    /// Up to where the pair's motion is safe, in [0, 1).
    pub t: f64,
}

/// How much of a motion is safe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Toi {
    /// Up to where all pairs keep their floor, in [0, 1].
    pub t: f64,
    /// The pair that stops it first, if any does.
    pub first: Option<Hit>,
    /// How many points were stopped where the advances ran out; safe, but farther might have been.
    pub n_exhausted: usize,
    /// Advances in all, a measure of work.
    pub n_advances: usize,
}

/// A point and an edge whose ways come near each other, with distance and direction at the start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    point: usize,
    edge: usize,
    members: [usize; 2],
    distance: f64,
    normal: Vec2,
}

/// What became of a candidate.
struct Advanced {
    /// Up to where it is safe; `None` if all the way.
    stop: Option<f64>,
    advances: usize,
    exhausted: bool,
}

impl Path {
    /// Finds how much of a motion keeps every pair at its floor or above, all the way.
    ///
    /// The floor of a pair follows from its distance now, so that a point that slides over the joints of a chain below
    /// `closing` is not stopped by the edges ahead; only where some point is at the guard, each has its own.
    ///
    /// - `hits`: overwritten with the first hit of each pair that has one, in the order of the pairs.
    pub fn time_of_impact(
        &mut self,
        surfaces: &Surfaces,
        motion: &Motion,
        pairs: &[MemberPair],
        hits: &mut Vec<Hit>,
    ) -> Toi {
        hits.clear();
        let mut toi = Toi {
            t: 1.0,
            first: None,
            n_exhausted: 0,
            n_advances: 0,
        };
        let extent = Extent::swept(surfaces, motion);
        self.search.refresh(extent);
        for (index, pair) in pairs.iter().enumerate() {
            let is_still = |member: usize| surfaces.members()[member].kind == MotionKind::Still;
            if is_still(pair.one) && is_still(pair.other) {
                continue;
            }
            let least = self.list_candidates(extent, surfaces, pair);
            if let Some(hit) = self.first_hit((surfaces, motion), (index, pair), least, &mut toi) {
                hits.push(hit);
                if hit.t < toi.t {
                    (toi.t, toi.first) = (hit.t, Some(hit));
                }
            }
        }
        toi
    }

    /// Lists who may come to the floor and returns the least distance among them (m).
    fn list_candidates(&mut self, extent: Extent, surfaces: &Surfaces, pair: &MemberPair) -> f64 {
        let candidates = &mut self.candidates;
        candidates.clear();
        let mut least = f64::INFINITY;
        let own = pair.one == pair.other;
        for members in [[pair.one, pair.other], [pair.other, pair.one]]
            .into_iter()
            .take(2 - usize::from(own))
        {
            self.search
                .points_and_edges(extent, members, pair.highest_floor(), |point, edge| {
                    if own && surfaces.edges()[edge].contains(&(point as u32)) {
                        return;
                    }
                    let foot = foot_on(surfaces.points()[point], surfaces.ends(edge));
                    least = least.min(foot.distance);
                    let (distance, normal) = (foot.distance, foot.normal);
                    candidates.push(Candidate {
                        point,
                        edge,
                        members,
                        distance,
                        normal,
                    });
                });
        }
        least
    }

    fn first_hit(
        &self,
        (surfaces, motion): (&Surfaces, &Motion),
        (index, pair): (usize, &MemberPair),
        least: f64,
        toi: &mut Toi,
    ) -> Option<Hit> {
        let mut hit: Option<Hit> = None;
        for candidate in &self.candidates {
            let until = hit.map_or(1.0, |hit| hit.t);
            let from = if least > pair.guard() {
                least
            } else {
                candidate.distance
            };
            let ways = Ways::of(surfaces, motion, candidate, pair.floor(from));
            let advanced = ways.advance(candidate, until);
            toi.n_advances += advanced.advances;
            toi.n_exhausted += usize::from(advanced.exhausted);
            if let Some(t) = advanced.stop {
                hit = Some(Hit {
                    pair: index,
                    point: candidate.point,
                    edge: candidate.edge,
                    t,
                });
            }
        }
        hit
    }
}

/// A point, both ends of an edge, how they move, and how near they may come.
struct Ways {
    point: Track,
    ends: [Track; 2],
    /// From each end to the point when the motion is over (m).
    last: [Vec2; 2],
    floor: f64,
}

impl Ways {
    #[inline]
    fn of(surfaces: &Surfaces, motion: &Motion, candidate: &Candidate, floor: f64) -> Self {
        let [of, against] = candidate.members;
        let ends = surfaces.edges()[candidate.edge].map(|end| end as usize);
        let to = motion.ends()[candidate.point];
        Self {
            point: motion.track(surfaces, of, candidate.point),
            ends: ends.map(|end| motion.track(surfaces, against, end)),
            last: ends.map(|end| to - motion.ends()[end]),
            floor,
        }
    }

    /// Advances from the start until the floor, or until an instant beyond which nobody asks.
    fn advance(&self, candidate: &Candidate, until: f64) -> Advanced {
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
        let arrived = self.floor + ARRIVED * (distance - self.floor);
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
            let has_arrived = t > 0.0 && distance <= arrived;
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
        let (point, point_rate) = ways.point.at(t, ways.point.sin_cos(t));
        // Both ends turn alike.
        let turned_by = ways.ends[0].sin_cos(t);
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
mod tests;
