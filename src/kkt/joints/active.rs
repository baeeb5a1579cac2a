//! A joint row at work.

use super::law::Finish;
use crate::constraint::joint::{JointGrip, JointRow, RememberedJoint, unit_wrench};
use crate::linalg::complementarity::{RowKind, Status};
use crate::math::Vec2;
use crate::system::{Block, Response};

/// A joint row at work.
#[derive(Clone, Copy, Debug)]
pub struct ActiveJoint {
    /// The row.
    pub row: JointRow,
    /// Whether only rigid blocks take part.
    pub is_hard: bool,
    /// Whether all nodes of flexible blocks that take part have mass.
    pub(in crate::kkt) has_mass: bool,
    /// Share of the velocity that the row keeps when others give impulses, 0 to 1 (-).
    pub(in crate::kkt) share: f64,
    pub(in crate::kkt) finish: Finish,
    /// Measured number at the beginning, and where it is to be (m or rad).
    pub(in crate::kkt) start: f64,
    pub(in crate::kkt) goal: f64,
    /// How far a unit multiplier lets the row give way (m/N or rad/(N m)).
    pub(in crate::kkt) give: f64,
    /// The same of a joint that nothing bounds, see `yielding` (m/N or rad/(N m)).
    pub(in crate::kkt) yielding: f64,
    pub(in crate::kkt) kind: RowKind,
    /// Distance from the goal at the last iterate (m or rad).
    pub(in crate::kkt) gap: f64,
    /// Directions of the forces: now, when the last iterate was found, and at the end of the step.
    pub(in crate::kkt) direction: Vec2,
    pub(in crate::kkt) applied: Vec2,
    pub(in crate::kkt) end: Vec2,
    /// Multiplier of the position stage (N or N m).
    pub multiplier: f64,
    pub(in crate::kkt) status: Status,
    /// How far the step brings ends that were put apart nearer to each other (m or rad), and the part of the multiplier that does so.
    pub(in crate::kkt) closing: f64,
    pub(in crate::kkt) closer: f64,
    /// The part of the multiplier that answers to contacts of rigid bodies, which velocities do not feel (N or N m).
    pub(in crate::kkt) answer: f64,
    /// Goal and closing before it was asked whether the bodies can come that near (m or rad).
    pub(in crate::kkt) asked: [f64; 2],
    /// Impulses along the rows of the beginning and of the end (N s or N m s).
    pub(in crate::kkt) kick: f64,
    pub(in crate::kkt) impulse: f64,
    /// Force of the acceleration stage (N or N m).
    pub(in crate::kkt) settled: f64,
    /// Rate of what is not driven from outside when the step begins, and the rate at which that is driven when it ends (m/s or rad/s).
    pub(in crate::kkt) began: f64,
    pub(in crate::kkt) driven: f64,
    /// Whether something can move the row at all.
    pub(in crate::kkt) is_movable: bool,
    /// Where the row is to be in the end (m or rad).
    pub(in crate::kkt) target: f64,
    /// Gap after the pass before (m or rad), how often it has been the same, and whether it is left open as other rows contradict it.
    pub(in crate::kkt) seen: f64,
    pub(in crate::kkt) n_same: usize,
    pub(in crate::kkt) is_left: bool,
    /// Whether it is left open by more than what counts, as the bodies cannot come that near.
    pub(in crate::kkt) is_out_of_reach: bool,
}

impl ActiveJoint {
    /// Whether its ends were put apart, and are not where they are to be yet.
    pub fn closes_on(&self) -> bool {
        self.closing != 0.0 && self.goal != self.target
    }

    /// What the row leaves for the next step; `closes`: whether a row of its joint [closes on](Self::closes_on).
    pub fn left_behind(&self, closes: bool) -> RememberedJoint {
        RememberedJoint {
            multiplier: self.multiplier - self.closer,
            lasting: self.lasting(),
            driven: self.driven,
            closes: if self.is_hard {
                closes
            } else {
                self.closes_on()
            },
        }
    }

    /// The force that is left in the stored accelerations of flexible bodies (N or N m).
    pub(in crate::kkt) fn lasting(&self) -> f64 {
        if self.is_hard {
            0.0
        } else {
            self.multiplier - self.closer + self.settled
        }
    }

    /// Takes a force of the acceleration stage; `late` of its time is in the next step (N or N m, s).
    pub(in crate::kkt) fn settle(&mut self, force: f64, late: f64) {
        if !self.is_hard {
            self.settled += force;
            self.impulse += late * force;
        }
    }

    /// Mean force or torque over the step, along `+∂q/∂x` (N or N m).
    pub fn force(&self, dt: f64) -> f64 {
        let impulse = (self.kick + self.impulse) / dt;
        let steady = if self.is_hard {
            0.0
        } else {
            self.multiplier - self.closer
        };
        self.row.sign * (steady + impulse)
    }

    /// Mean force of a joint row over the step in the world, on the side of positive weights, or its torque (N or N m).
    pub fn force_in_world(&self, dt: f64) -> (Vec2, f64) {
        let force = self.force(dt);
        if self.row.measure.is_turn() {
            return (Vec2::zeros(), force);
        }
        if !self.is_hard {
            return (force * self.row.sign * self.direction, 0.0);
        }
        let sum = (self.kick * self.direction + self.impulse * self.end) / dt;
        (sum, 0.0)
    }

    /// Whether a row of rigid bodies that is not driven is farther than this from where it is to hold (m or rad): when the step began, or now if rows
    /// may contradict each other.
    pub(in crate::kkt) fn is_open(&self, slop: f64, contradicts: bool) -> bool {
        let is_driven = matches!(self.finish, Finish::Hold { rate } if rate != 0.0);
        if !self.is_hard || self.give > 0.0 || is_driven {
            return false;
        }
        // What its own force has opened it by is no gap that was there.
        let yielded = -self.yielding * self.row.last_multiplier();
        let began = self.off(self.start - self.asked[0] - yielded);
        self.asked[1] != 0.0 || began > slop || contradicts && self.error() > slop
    }

    /// How far the row is from holding where it is this far from where it is to be (m or rad).
    fn off(&self, from: f64) -> f64 {
        match self.kind {
            RowKind::Unilateral => (-from).max(0.0),
            RowKind::Bilateral => from.abs(),
            _ => 0.0,
        }
    }

    /// How far the step brings its ends nearer to where they are to be (m or rad): all at once, as it is made, where that is next
    /// to nothing.
    pub(in crate::kkt) fn closes_by(&self) -> f64 {
        let is_still = matches!(self.finish, Finish::Hold { rate: 0.0 });
        let is_new = self.row.last_multiplier() == 0.0;
        match self.closing {
            0.0 if is_new && is_still && self.holds() => (self.start - self.goal).abs(),
            closing => closing.abs(),
        }
    }

    /// Whether its ends move against each other in the step, drawn together or left elsewhere than where they are to be.
    pub(in crate::kkt) fn moves_apart(&self) -> bool {
        self.closing != 0.0 || self.is_hard && self.goal != self.target
    }

    /// Leaves the row open by this beyond what was asked of it. It is told if that is more than `slop` (m or rad) and the row does not come half as near
    /// as asked: what closes in its time is no more than late.
    pub(in crate::kkt) fn leave(&mut self, open: f64, slop: f64) {
        let [goal, closing] = self.asked;
        let [began, asked, ends] =
            [self.start, goal, goal + open].map(|place| self.off(place - self.target));
        self.is_out_of_reach = ends > asked + slop && ends > 0.5 * (began + asked);
        self.gap += self.goal - (goal + open);
        self.goal = goal + open;
        self.closing = (closing + open).clamp(closing.min(0.0), closing.max(0.0));
    }

    /// How far the row has moved since the step began, linear in the dofs of the blocks (m or rad).
    pub(in crate::kkt) fn moved(&self, blocks: &[Block], grips: &[JointGrip]) -> f64 {
        let is_turn = self.row.measure.is_turn();
        let grips = grips[self.row.grips.0..self.row.grips.1].iter();
        let moved = grips.map(|grip| match &blocks[grip.block] {
            Block::Rigid(block) => {
                let wrench = unit_wrench(grip, self.direction, is_turn);
                let moved = block.moved();
                wrench.iter().zip(moved).map(|(w, x)| w * x).sum::<f64>()
            }
            block => grip.weight * self.direction.dot(&block.displacement(grip.grip())),
        });
        moved.sum()
    }

    /// How far the law is from holding (m or rad).
    pub(in crate::kkt) fn error(&self) -> f64 {
        if !self.is_movable {
            return 0.0;
        }
        let off = self.gap + (self.give + self.yielding) * self.multiplier;
        match (self.kind, self.status) {
            (RowKind::Unilateral, Status::Open) | (_, Status::SlipNegative) => (-off).max(0.0),
            (_, Status::SlipPositive) => off.max(0.0),
            _ => off.abs(),
        }
    }

    /// Share of the row's motion that a problem holds (-).
    pub(in crate::kkt) fn share_of(&self, of: Response) -> f64 {
        match of {
            Response::Position => 1.0,
            Response::Velocity | Response::Acceleration | Response::ByMass => self.share,
        }
    }

    /// Whether the row holds its velocity in this step.
    pub(in crate::kkt) fn is_closed(&self) -> bool {
        !matches!(self.kind, RowKind::Unilateral) || self.multiplier > 0.0
    }

    /// Whether the row holds nodes of flexible bodies that all have mass.
    pub(in crate::kkt) fn holds_masses(&self) -> bool {
        !self.is_hard && self.has_mass
    }

    /// Whether the row answers to what contacts of rigid bodies do: it holds, with any force.
    pub(in crate::kkt) fn answers(&self) -> bool {
        let is_bounded = matches!(self.kind, RowKind::Box { .. });
        self.is_hard && self.holds() && !is_bounded
    }

    /// The part of the multiplier that velocities feel (N or N m).
    pub(in crate::kkt) fn felt(&self) -> f64 {
        let felt = self.multiplier - self.closer - self.answer;
        match self.kind {
            // A limit that only contacts press against does not pull.
            RowKind::Unilateral => felt.max(0.0),
            _ => felt,
        }
    }

    /// Whether the row is a spring or damper, which leaves its ends to move by themselves.
    pub(in crate::kkt) fn is_spring(&self) -> bool {
        matches!(
            self.finish,
            Finish::Spring | Finish::Stiff(_) | Finish::Nothing
        )
    }

    /// Whether the row has held what it measures in this step.
    pub(in crate::kkt) fn holds(&self) -> bool {
        self.is_law() && self.is_movable && !self.is_left && self.is_closed()
    }

    /// Whether the row is to hold what it measures, as joints and limits do.
    fn is_law(&self) -> bool {
        matches!(self.finish, Finish::Hold { .. } | Finish::Limit)
    }

    /// How far from where it is to be in the end the last iterate has left it (m or rad).
    pub(in crate::kkt) fn open(&self) -> f64 {
        let from = self.goal + self.gap - self.target;
        if self.is_law() { self.off(from) } else { 0.0 }
    }
}
