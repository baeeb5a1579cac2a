//! A motion to be tried: where every point goes while `t` runs from 0 to 1.
//!
//! `x(t) = c + t v + R(t θ) r`: a carrier `c` that moves along a line and an arm `r` that turns about it. Points of still
//! and flexible members are their own carriers and have no arm.

use super::surfaces::{MotionKind, Surfaces};
use crate::math::{Vec2, perp, sin_cos};
use std::ops::Range;

/// How a rigid member moves: its centre now (m), the way of the centre (m), the angle it turns by (rad), and the longest
/// arm (m).
#[derive(Clone, Copy, Debug, Default)]
struct RigidMotion {
    centre: Vec2,
    shift: Vec2,
    turn: f64,
    radius: f64,
}

/// The way of one point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    pub carrier: Vec2,
    pub shift: Vec2,
    pub arm: Vec2,
    /// Length of the arm (m); zero where nothing turns.
    pub radius: f64,
    pub turn: f64,
}

impl Track {
    /// Position and its derivative by `t`, with sine and cosine of the angle turned by until then.
    #[inline]
    pub fn at(&self, t: f64, (sin, cos): (f64, f64)) -> (Vec2, Vec2) {
        let arm = turned(self.arm, (sin, cos));
        let position = self.carrier + self.shift * t + arm;
        (position, self.shift + perp(arm) * self.turn)
    }

    /// Sine and cosine of the angle turned by until `t`.
    #[inline]
    pub fn heading(&self, t: f64) -> (f64, f64) {
        if self.turn == 0.0 {
            (0.0, 1.0)
        } else {
            sin_cos(self.turn * t)
        }
    }
}

#[inline]
pub(super) fn turned(v: Vec2, (sin, cos): (f64, f64)) -> Vec2 {
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// Where all points go. Positions must be finite: the searches pass over those that are not.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    ends: Vec<Vec2>,
    rigid: Vec<RigidMotion>,
}

impl Motion {
    /// No motion, of nothing.
    #[cfg(test)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins anew: everything stays where it is.
    pub fn rest(&mut self, surfaces: &Surfaces) {
        self.ends.clear();
        self.ends.extend_from_slice(surfaces.points());
        self.rigid.clear();
        self.rigid
            .resize(surfaces.members().len(), RigidMotion::default());
    }

    /// Moves a rigid member.
    ///
    /// - `centre`: about which it turns, now (m).
    /// - `shift`: the way of the centre (m).
    /// - `turn`: the angle, of any size (rad).
    ///
    /// # Panics
    /// If the member is not rigid.
    pub fn move_rigid(
        &mut self,
        surfaces: &Surfaces,
        member: usize,
        centre: Vec2,
        shift: Vec2,
        turn: f64,
    ) {
        let points = &surfaces.members()[member];
        assert!(
            points.kind == MotionKind::Rigid,
            "member {member} is not rigid"
        );
        let full = sin_cos(turn);
        let mut square = 0.0_f64;
        for point in points.points.clone() {
            let arm = surfaces.points()[point] - centre;
            square = square.max(arm.norm_squared());
            // Without a turn exactly, so that members that move together keep their distance to the last digit.
            self.ends[point] = if turn == 0.0 {
                surfaces.points()[point] + shift
            } else {
                centre + shift + turned(arm, full)
            };
        }
        self.rigid[member] = RigidMotion {
            centre,
            shift,
            turn,
            radius: square.sqrt(),
        };
    }

    /// Where the points of a flexible member go (m), to be written.
    ///
    /// # Panics
    /// If the member is not flexible.
    pub fn ends_mut(&mut self, surfaces: &Surfaces, member: usize) -> &mut [Vec2] {
        let points = &surfaces.members()[member];
        assert!(
            points.kind == MotionKind::Flexible,
            "member {member} is not flexible"
        );
        &mut self.ends[points.points.clone()]
    }

    /// Where all points go (m).
    pub fn ends(&self) -> &[Vec2] {
        &self.ends
    }

    /// How far a point of a member may leave the line from its start to its end (m): `r θ² / 8` bounds what an arc leaves
    /// its chord by, and neither is farther than an arm from the carrier.
    #[inline]
    pub(super) fn bulge(&self, member: usize) -> f64 {
        let motion = &self.rigid[member];
        motion.radius * (motion.turn * motion.turn / 8.0).min(2.0)
    }

    #[inline]
    pub(super) fn track(&self, surfaces: &Surfaces, member: usize, point: usize) -> Track {
        let position = surfaces.points()[point];
        let motion = &self.rigid[member];
        if motion.turn == 0.0 {
            // `ends` holds the sum for rigid members too.
            let shift = self.ends[point] - position;
            return Track {
                carrier: position,
                shift,
                arm: Vec2::zeros(),
                radius: 0.0,
                turn: 0.0,
            };
        }
        let arm = position - motion.centre;
        Track {
            carrier: motion.centre,
            shift: motion.shift,
            arm,
            radius: arm.norm(),
            turn: motion.turn,
        }
    }
}

impl Surfaces {
    /// Goes a part of a motion's way with all members.
    pub fn advance(&mut self, motion: &Motion, t: f64) {
        (0..self.members().len()).for_each(|member| self.advance_member(motion, member, t));
    }

    /// Goes a part of a motion's way with one member.
    pub fn advance_member(&mut self, motion: &Motion, member: usize, t: f64) {
        let Range { start, end } = self.members()[member].points.clone();
        if self.members()[member].kind == MotionKind::Still {
            return;
        }
        if t == 1.0 {
            self.points_mut(member)
                .copy_from_slice(&motion.ends[start..end]);
            return;
        }
        let full = sin_cos(motion.rigid[member].turn * t);
        for point in start..end {
            let to = motion.track(self, member, point).at(t, full).0;
            self.points_mut(member)[point - start] = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Motion;
    use crate::math::Vec2;
    use crate::path::{MotionKind, Surfaces};

    #[test]
    fn a_motion_in_two_parts_ends_where_the_whole_does() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y));
        let mut surfaces = Surfaces::new();
        let rigid = surfaces.add_chain(MotionKind::Rigid, true, &square, true);
        let soft = surfaces.add_chain(MotionKind::Flexible, true, &square, true);
        let mut motion = Motion::new();
        motion.rest(&surfaces);
        motion.move_rigid(
            &surfaces,
            rigid,
            Vec2::new(0.5, 0.5),
            Vec2::new(2.0, -1.0),
            3.0,
        );
        motion
            .ends_mut(&surfaces, soft)
            .iter_mut()
            .for_each(|end| *end *= 3.0);
        let whole = motion.ends().to_vec();
        surfaces.advance(&motion, 0.25);
        motion.rest(&surfaces);
        motion.move_rigid(
            &surfaces,
            rigid,
            Vec2::new(1.0, 0.25),
            Vec2::new(1.5, -0.75),
            2.25,
        );
        motion
            .ends_mut(&surfaces, soft)
            .copy_from_slice(&whole[4..]);
        surfaces.advance(&motion, 1.0);
        for (end, goal) in surfaces.points().iter().zip(&whole) {
            // A handful of roundings of numbers of order one.
            assert!((end - goal).norm() < 1e-14);
        }
    }
}
