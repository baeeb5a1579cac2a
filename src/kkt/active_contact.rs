//! A contact of the working set.

use super::settings::SolveSettings;
use crate::constraint::contact::{Kinematics, Remembered};
use crate::linalg::complementarity::Status;
use crate::math::Vec2;
use crate::path::NearPair;
use crate::system::Block;

/// A contact of the working set: its kinematics, multipliers and state.
#[derive(Clone, Copy, Debug)]
pub struct ActiveContact {
    /// Index of the candidate.
    pub candidate: usize,
    /// The row that the forces act along, with the gap beyond the allowance at the last iterate.
    pub kinematics: Kinematics,
    /// Geometry at the last iterate.
    pub(super) measured: Kinematics,
    /// The row that the multipliers acted along when the last iterate was found.
    pub(super) applied: Kinematics,
    /// Multipliers of the position stage, normal and tangential (N).
    pub multiplier: [f64; 2],
    /// Impulse of the velocity stage, normal and tangential (N s).
    pub impulse: [f64; 2],
    /// What the force gives beyond that along its row as it [acts midway](super::midway) through the step, along its normal and its tangent (N s).
    pub(super) midway: [f64; 2],
    /// How far its place has come against the rigid body of the pair since then (m).
    pub(super) since_midway: Vec2,
    /// What the lasting force counts beyond its time (N s).
    pub(super) late: [f64; 2],
    /// Force of the acceleration stage (N).
    pub(super) settled: [f64; 2],
    /// Relative velocity along the normal and the tangent after the velocity stage (m/s).
    pub(super) parting: [f64; 2],
    /// Velocity at the end of the step of a hit that goes on within it (m/s).
    pub(super) rebound: Option<f64>,
    /// Status of the normal and of the friction row.
    pub status: [Status; 2],
    /// Whether it is one of rigid bodies only.
    pub is_hard: bool,
    /// Whether some grip carries no inertia.
    pub is_massless: bool,
    /// Whether its multiplier alone decides its velocity: no impulse of the velocity stage follows.
    pub is_settled: bool,
    /// Gap and relative motion `Σ w u` at the last measurement, from which gaps are extrapolated where the
    /// geometry has no answer or keeps changing.
    pub(super) known: Option<(f64, Vec2)>,
    /// How far apart the bodies are where geometry has no gap but a force acts, 0 elsewhere (m).
    pub(super) apart: f64,
    /// Whether geometry has no gap, so that no force may act.
    pub(super) is_lost: bool,
    /// How often it has been let go for that within the step.
    pub(super) losses: u8,
    /// Tangential motion since the beginning of the step (m).
    pub slip: f64,
    /// The part of it that was gone on rows that this one has taken the force over from, less what its own row tells of that (m).
    pub(super) slip_before: f64,
    /// Share of the contact that is shorter than the step, 0 to 1 (-): the springs of the surface do not give way within it.
    pub unresolved: f64,
    /// Share of the contact in which the bodies meet as rigid ones within the step, 0 to 1 (-).
    pub rigid: f64,
    /// How far the row gives way to its own force in the problem solved, along its normal and its tangent (m/N).
    pub(super) yielding: [f64; 2],
    /// How far a force of its own moves it within the step, along its normal and its tangent, where that is known (m/N).
    pub(super) mobility: Option<[f64; 2]>,
    /// Gap that is left of an overlap the step began with, zero or negative (m): what was put into each other parts by and
    /// by. The solver's gap counts from here.
    pub allowance: f64,
    /// The same before it was asked whether rigid bodies can part by that much (m).
    pub(super) asked: f64,
    /// Tangential motion by which they part, which is no slip (m).
    pub(super) aside: f64,
    /// What the contact was in the last step.
    pub remembered: Remembered,
    /// Where the contact was at the base of the path; `None` for signed rows, which know no path.
    pub(super) base: Option<AtBase>,
}

/// A contact at the base of the feasible path.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtBase {
    /// Distance beyond the one at which the contact closes (m).
    pub gap: f64,
    /// Motion of the material points against each other since the beginning of the step (m); of vertices that are held together, from
    /// where they are.
    pub moved: Vec2,
    /// How far the target carries the point along within the step, as a belt does (m).
    pub carried: Vec2,
    /// The near pair.
    pub near: NearPair,
    /// Whether it stands for two vertices that are held together.
    pub is_meeting: bool,
}

impl ActiveContact {
    /// Force over the step: the multiplier, or for contacts of rigid bodies the impulse over the step length (N).
    pub fn force(&self, dt: f64) -> [f64; 2] {
        if self.is_hard {
            self.impulse.map(|impulse| impulse / dt)
        } else {
            let sum = |axis| self.multiplier[axis] + (self.impulse[axis] + self.late[axis]) / dt;
            [sum(0), sum(1)]
        }
    }

    /// What the force has beyond [`Self::force`] as it acts midway through the step, along the same axes (N).
    pub fn midway_force(&self, dt: f64) -> [f64; 2] {
        self.midway.map(|impulse| impulse / dt)
    }

    /// Impulse that the step's own force has given, normal and tangential (N s): of one in the stored accelerations `β1`, for the rest acts in the next step.
    pub(super) fn given(&self, settings: &SolveSettings) -> [f64; 2] {
        if self.is_hard {
            return self.impulse;
        }
        let late = settings.late();
        [0, 1].map(|axis| {
            let acts = (settings.dt - late) * self.multiplier[axis];
            acts + self.impulse[axis] + self.midway[axis] - late * self.settled[axis]
        })
    }

    /// What has been taken of its force, or added, since its normal turned on the way, times how far it has slid (N s m).
    pub(super) fn pushed_along(&self) -> f64 {
        (self.midway[1] * self.slip).abs()
    }

    /// Velocity along the normal and the tangent at which the bodies came to where they are (m/s), see [`Block::approaching_velocity`].
    pub(super) fn approach(&self, blocks: &[Block]) -> [f64; 2] {
        let row = &self.kinematics;
        let velocity = row.relative(blocks, |block, grip| block.approaching_velocity(grip));
        [velocity.dot(&row.normal), velocity.dot(&row.tangent())]
    }

    /// The force that is left in the stored accelerations (N).
    pub fn lasting(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.multiplier[axis] + self.settled[axis])
    }

    /// How far the velocity stage holds the contact's relative velocity, 0 to 1 (-): masses that meet would ring at every
    /// mesh's highest frequency; a massless surface only where the step is longer than the impact.
    pub(super) fn holds_velocity(&self) -> f64 {
        if self.is_settled {
            0.0
        } else if self.is_massless {
            self.unresolved
        } else {
            1.0
        }
    }

    /// Multipliers that the next step begins with (N). What parts bodies is no force, and may be of any size where something else holds them: of those
    /// the next step knows the impulse alone.
    pub fn handed_on(&self, dt: f64) -> [f64; 2] {
        if self.is_parting() {
            self.force(dt)
        } else {
            self.multiplier
        }
    }

    /// The gap (m).
    pub fn gap(&self) -> f64 {
        self.kinematics.gap + self.allowance
    }

    /// Whether it is one of rigid bodies that the step began with in each other.
    pub(super) fn is_parting(&self) -> bool {
        self.is_hard && self.asked < 0.0
    }

    /// Leaves this of the overlap, zero or less (m).
    pub(super) fn leave(&mut self, left: f64) {
        let deeper = left - self.allowance;
        self.allowance = left;
        self.kinematics.gap -= deeper;
        self.known = self.known.map(|(gap, at)| (gap - deeper, at));
    }

    /// Takes this tangential motion out of the slip (m).
    pub(super) fn part_aside(&mut self, aside: f64) {
        self.slip -= aside - self.aside;
        self.aside = aside;
    }

    /// Whether the contact carries or would carry a force.
    pub fn is_closed(&self) -> bool {
        self.multiplier[0] > 0.0
    }
}
