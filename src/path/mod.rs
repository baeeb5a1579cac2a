//! The way from one placement of surfaces to the next: who is near, how far one may go, and whether nothing overlaps.
//!
//! Everything is a point against an edge. A ball is one point, a capsule one edge, a convex polygon or the boundary of a
//! flexible body a closed chain, terrain an open one; roundings are in the distance at which contact closes. Contact asks
//! for `d ≥ closing`, the path guarantees `d ≥ guard > 0`:
//!
//! ```text
//! 0        guard          floor      closing            closing + reach
//! |----------|--------------|-----------|----------------------|------> distance d of two cores (m)
//!            |  .2 margin   |           |
//!  closing - .8 margin      `- where this motion stops: guard + min(.1 (d0 - guard), .3 margin)
//! ```
//!
//! A step reads: [`Path::near`] gives the rows at the present placement, the solver a [`Motion`],
//! [`Path::time_of_impact`] how much of it is safe, [`Surfaces::advance`] goes that far; the tests check the
//! result in exact arithmetic (`Path::certificate`). No other part of the stage looks at geometry.

mod advance;
mod bounds;
mod certificate;
mod clearance;
mod distance;
mod impact;
mod motion;
mod near;
mod search;
mod surfaces;

#[cfg(test)]
pub(crate) mod samples;
#[cfg(test)]
mod tests;

// What a step ends with is checked by the tests; a step of its own does not pay for it yet.
#[cfg(test)]
pub use certificate::Certificate;
pub use clearance::clearance;
pub use impact::Hit;
pub use motion::Motion;
pub use near::{NearPair, Target, add_beyond};
pub use surfaces::{MotionKind, Surfaces};

/// How far below `closing` the guard lies, as a share of the margin: the rest, a fifth, is what the path keeps at least
/// where `closing` is the margin alone. Any share in (0, 1) is safe; a larger one leaves more room to a solver that has
/// not converged before it is cut.
const GUARD_DEPTH: f64 = 0.8;
/// Share of the distance over the guard that one motion leaves untouched. Positive, so that repeated motions approach the
/// guard geometrically and never reach it.
const KEPT_SHARE: f64 = 0.1;
/// The most that one motion leaves over the guard, as a share of the margin: less than [`GUARD_DEPTH`], so that a first
/// approach from afar reaches the distance at which contact closes and is not cut before.
const KEPT_MOST: f64 = 0.3;
/// Share of the distance before all motions that is kept where that was below the guard: what slides along at that distance needs some
/// room, and so does what turns there, whose rows are those of the sharp corner, while its rounded one comes nearer by the radius times the change
/// of a sine.
const KEPT_OF_LEAST: f64 = 0.9;
/// Relative approach that counts as none where a pair is at its guard: above the rounding of a distance of 1e-6 of the
/// coordinates (2e-10), and so small that a thousand steps spend a thousandth.
const NO_APPROACH: f64 = 1e-6;

/// Two members that are asked against each other. Both the same: a member against itself, without the edges that meet in
/// the point. Of these, the two ends are asked against each other, so that no edge vanishes: it could come out the other way round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemberPair {
    /// Index of the first member.
    pub one: usize,
    /// Index of the second member.
    pub other: usize,
    /// A name of the pair that stays from step to step; part of [`NearPair::key`].
    pub name: u64,
    /// Distance of the cores at which contact closes (m): the radii, the skin and the offset.
    pub closing: f64,
    /// The part of `closing` that is there to be used up (m), `0 < 0.8 margin < closing`.
    pub margin: f64,
    /// Distance that they have had before all motions (m).
    pub least: f64,
    /// Whether they are known to stay apart by more than is asked for next: then they are passed over.
    pub is_asleep: bool,
}

impl MemberPair {
    /// The distance that every placement keeps (m): nearly the one they began with, where that was less than the path would ask for.
    #[inline]
    pub fn guard(&self) -> f64 {
        self.usual_guard().min(KEPT_OF_LEAST * self.least)
    }

    /// Whether they have begun with all the room that the path may use up.
    #[inline]
    pub fn has_room(&self) -> bool {
        self.least >= self.usual_guard()
    }

    /// The distance that is kept by what begins with more (m).
    #[inline]
    fn usual_guard(&self) -> f64 {
        self.closing - GUARD_DEPTH * self.margin
    }

    /// Where a motion stops that starts at some distance (m), below that distance. At the guard nothing may approach: a
    /// guard that shrank with the distance would end at zero in a jam.
    #[inline]
    pub fn floor(&self, distance: f64) -> f64 {
        let guard = self.guard();
        if distance > guard {
            guard + (KEPT_SHARE * (distance - guard)).min(KEPT_MOST * self.margin)
        } else {
            distance * (1.0 - NO_APPROACH)
        }
    }

    /// The highest floor there is (m).
    #[inline]
    fn highest_floor(&self) -> f64 {
        self.guard() + KEPT_MOST * self.margin
    }
}

/// The buffers of the searches; nothing in them outlives a call.
#[derive(Clone, Debug, Default)]
pub struct Path {
    search: search::Search,
    candidates: Vec<advance::Candidate>,
}

#[cfg(test)]
impl Path {
    /// Empty buffers; they grow with the first calls.
    pub fn new() -> Self {
        Self::default()
    }
}
