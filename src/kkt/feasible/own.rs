//! Surfaces against themselves.
//!
//! A surface is asked against itself only where it may be near: distances of its parts change by no more than twice what its points have
//! moved against a placement that it fits best, so with `c` the least distance there, `ε` the farthest that a point is off it, and `Δθ` the
//! turn of the fit between both ends of a motion along straight lines,
//!
//! ```text
//! d ≥ c - 2 ε,     d(t) ≥ c cos(Δθ/2) - 2 max(ε₀, ε₁)
//! ```
//!
//! The placement is that at rest, or where the surface has left it too far, the one that the step begins with. Where nothing is near, a
//! surface so changes no digit of what happens to its body.

use super::straight::MOST_TURN;
use super::{FeasiblePath, Way};
use crate::math::{Vec2, atan2, cos, cross, node_vec, perp};
use crate::path::MemberPair;
use crate::system::{Block, FlexBlock};
use std::ops::Range;

/// A surface that is kept apart from itself.
#[derive(Clone, Debug)]
pub(super) struct OwnWay {
    /// Its points in the placement that it is compared with, from their middle, among those of all.
    reference: Range<usize>,
    /// Its least distance from itself there (m).
    clearance: f64,
    /// Whether some of it has been near within the step.
    is_near: bool,
}

/// How points lie to those of a placement.
struct Fit {
    middle: Vec2,
    /// Cosine and sine of the turn.
    turn: Vec2,
    /// How far the farthest is off (m).
    off: f64,
}

impl Fit {
    fn of(reference: &[Vec2], points: &[Vec2]) -> Self {
        let middle = middle_of(points);
        let mut sum = Vec2::zeros();
        for (arm, point) in reference.iter().zip(points) {
            let own = point - middle;
            sum += Vec2::new(arm.dot(&own), cross(*arm, own));
        }
        let length = sum.norm();
        let turn = if length > 0.0 {
            sum / length
        } else {
            Vec2::new(1.0, 0.0)
        };
        let off = |(arm, point): (&Vec2, &Vec2)| (point - middle - turned(*arm, turn)).norm();
        let offs = reference.iter().zip(points).map(off);
        Self {
            middle,
            turn,
            off: offs.fold(0.0, f64::max),
        }
    }

    /// Cosine and sine of the turn from this one to another.
    fn turn_to(&self, other: &Self) -> Vec2 {
        Vec2::new(self.turn.dot(&other.turn), cross(self.turn, other.turn))
    }
}

fn middle_of(points: &[Vec2]) -> Vec2 {
    points.iter().sum::<Vec2>() / points.len() as f64
}

fn turned(v: Vec2, turn: Vec2) -> Vec2 {
    turn.x * v + turn.y * perp(v)
}

impl FeasiblePath {
    /// Says that all surfaces that meet others have been added, before those that meet themselves are.
    pub(crate) fn begin_own(&mut self) {
        self.n_shared = Some(self.surfaces.points().len());
    }

    /// Keeps the surface of a flexible block apart from itself; returns whether it is to begin with. If not, nothing is added.
    ///
    /// - `clearance`: its least distance from itself at rest (m).
    pub(crate) fn add_own_way(&mut self, way: Way, body: &FlexBlock, clearance: f64) -> bool {
        let member = way.members[0];
        let asked = way.closing + way.reach;
        let points = &self.surfaces.points()[self.surfaces.members()[member].points.clone()];
        let first = self.references.len();
        let rest = body.model().placed_positions();
        let nodes = body.model().mesh().boundary().nodes().iter();
        self.references
            .extend(nodes.map(|&node| node_vec(rest, node)));
        centre(&mut self.references[first..]);
        let off = Fit::of(&self.references[first..], points).off;
        let mut own = OwnWay {
            reference: first..self.references.len(),
            clearance,
            is_near: false,
        };
        let mut least = clearance - 2.0 * off;
        if least < asked {
            let found = self.search.apart(&self.surfaces, way.members, clearance);
            let Some(found) = found else {
                self.references.truncate(first);
                return false;
            };
            least = found.min(clearance);
            own.clearance = least;
            let points = &self.surfaces.points()[self.surfaces.members()[member].points.clone()];
            self.references[first..].copy_from_slice(points);
            centre(&mut self.references[first..]);
        }
        self.is_led |= least < asked;
        self.pairs.push(MemberPair {
            one: member,
            other: member,
            name: self.pairs.len() as u64,
            closing: way.closing,
            margin: way.margin,
            least,
            is_asleep: true,
        });
        self.ways.push(way);
        self.own.push(own);
        true
    }

    /// The first of the ways of surfaces with themselves: the last ones.
    pub(super) fn first_own(&self) -> usize {
        self.ways.len() - self.own.len()
    }

    /// Whether a way counts: that of a surface with itself if some of it has been near within the step.
    pub(super) fn is_counted(&self, way: usize) -> bool {
        let first = self.first_own();
        way < first || self.own[way - first].is_near
    }

    /// Smallest margin of the ways (m).
    pub(in crate::kkt) fn least_margin(&self) -> f64 {
        let least = |counts: &dyn Fn(usize) -> bool| {
            let counted = self.ways.iter().enumerate();
            let counted = counted.filter(|(index, _)| counts(*index));
            counted.fold(f64::INFINITY, |least, (_, way)| least.min(way.margin))
        };
        let near = least(&|way| self.is_counted(way));
        if near.is_finite() {
            near
        } else {
            least(&|_| true)
        }
    }

    /// Forgets what has been near within the step.
    pub(super) fn forget_own(&mut self) {
        self.own.iter_mut().for_each(|own| own.is_near = false);
    }

    /// Notes which surfaces are near themselves.
    pub(super) fn note_own(&mut self) {
        let first = self.first_own();
        for near in self.near.iter().filter(|near| near.pair >= first) {
            self.own[near.pair - first].is_near = true;
        }
    }

    /// Number of points whose way tells how passes go on: those of surfaces that only might meet themselves do not.
    pub(super) fn n_followed(&self) -> usize {
        let n_points = self.surfaces.points().len();
        if self.own.iter().any(|own| own.is_near) {
            n_points
        } else {
            self.n_shared.unwrap_or(n_points)
        }
    }

    /// Wakes the surfaces that may have rows with themselves at the base.
    pub(super) fn wake_at_base(&mut self) {
        let first = self.first_own();
        for (index, own) in self.own.iter().enumerate() {
            let way = &self.ways[first + index];
            let points = self.surfaces.members()[way.members[0]].points.clone();
            let reference = &self.references[own.reference.clone()];
            let off = Fit::of(reference, &self.surfaces.points()[points]).off;
            let least = own.clearance - 2.0 * off;
            self.pairs[first + index].is_asleep = least >= way.closing + way.reach;
        }
    }

    /// Wakes the surfaces that may meet themselves in the motion, and returns the part of it on which these do not turn too far for lines
    /// to stand for arcs.
    pub(super) fn wake_on_way(&mut self) -> f64 {
        let (first, mut part) = (self.first_own(), 1.0f64);
        for index in 0..self.own.len() {
            let [start, end] = self.fits(index);
            let turn = start.turn_to(&end);
            let angle = atan2(turn.y, turn.x).abs();
            let own = &self.own[index];
            let least = own.clearance * cos(0.5 * angle) - 2.0 * start.off.max(end.off);
            let is_asleep = least >= self.ways[first + index].closing;
            self.pairs[first + index].is_asleep = is_asleep;
            if !is_asleep && angle > MOST_TURN {
                part = part.min(MOST_TURN / angle);
            }
        }
        part
    }

    /// How the points of a surface lie to its reference at the start and at the end of the motion.
    fn fits(&self, index: usize) -> [Fit; 2] {
        let member = self.ways[self.first_own() + index].members[0];
        let points = self.surfaces.members()[member].points.clone();
        let reference = &self.references[self.own[index].reference.clone()];
        [self.surfaces.points(), self.motion.ends()]
            .map(|places| Fit::of(reference, &places[points.clone()]))
    }

    /// Takes the motion of its whole out of that of a surface, for a question that only its shape decides: lines stand for arcs then.
    pub(super) fn follow_shape(&mut self, index: usize) {
        let member = self.ways[self.first_own() + index].members[0];
        let [start, end] = self.fits(index);
        let back = end.turn_to(&start);
        let ends = self.motion.ends_mut(&self.surfaces, member);
        for place in ends {
            *place = start.middle + turned(*place - end.middle, back);
        }
    }

    /// Whether a surface has met itself on the way from where the step begins to the blocks' iterate, in a step that no path has led.
    pub(in crate::kkt) fn has_met_itself(&mut self, blocks: &[Block]) -> bool {
        if self.is_led || self.own.is_empty() {
            return false;
        }
        self.motion.rest(&self.surfaces);
        let first = self.first_own();
        let mut is_asked = false;
        for index in 0..self.own.len() {
            self.aim(
                self.ways[first + index].members[0],
                Default::default(),
                blocks,
            );
            self.follow_shape(index);
            let off = self.fits(index).map(|fit| fit.off);
            let least = self.own[index].clearance - 2.0 * off[0].max(off[1]);
            let is_asleep = least >= self.ways[first + index].closing;
            self.pairs[first + index].is_asleep = is_asleep;
            is_asked |= !is_asleep;
        }
        if !is_asked {
            return false;
        }
        let own = &self.pairs[first..];
        let impact = self
            .search
            .time_of_impact(&self.surfaces, &self.motion, own, &mut self.hits);
        self.surfaces.advance(&self.motion, 1.0);
        let own = &self.pairs[first..];
        self.search.near(&self.surfaces, own, 0.0, &mut self.near);
        let is_met = impact.t < 1.0 || !self.near.is_empty();
        self.near.clear();
        self.is_led = is_met;
        is_met
    }
}

fn centre(points: &mut [Vec2]) {
    let middle = middle_of(points);
    points.iter_mut().for_each(|point| *point -= middle);
}

#[cfg(test)]
mod tests;
