//! The energy stage: contact may store energy and give it back; what it would add is taken from the velocities.
//!
//! With `E` the kinetic and elastic energy and `W` the work of applied forces and of prescribed motion, the step may end
//! with `E' <= E + W + reserve`. The reserve is what contact has taken since it began, as far as that is the swing of the integrator about
//! the energy and no more: the rest is heat of dampers and impacts, which gives nothing back. Beyond that the end velocity is
//! changed along the response to the contact forces, which leaves momentum alone.
//!
//! With joints the reserve is all that was taken, unless forces act wholly within their step: they swing in the stored accelerations by more
//! than that, and velocities that are changed against it make it grow.

use super::calm::remove_relative_motion;
use super::delassus::RowDirection;
use super::island::{Island, SolveSettings};
use super::summary::IslandSummary;
use super::work::{
    JointWork, WorkGrips, actual_work, flow_energy, joint_work, kinetic_energy, momentum_at_most,
};
use crate::math::{judged::Judged, rounding};
use crate::system::{Block, Response};

impl Island {
    /// What plastic flow dissipates in the step, which is in the elastic energy of its end (J).
    pub fn flow_energy(&self) -> f64 {
        flow_energy(&self.blocks)
    }

    /// Work of applied forces and of the contact forces of driven bodies (J).
    pub(super) fn actual_work(&self, settings: &SolveSettings) -> f64 {
        actual_work(&self.blocks, &self.contacts, settings.dt)
    }

    /// Work of the joints on what is not driven from outside.
    pub(super) fn joint_work(&self, settings: &SolveSettings) -> JointWork {
        joint_work(&self.blocks, &self.ties, self.work_grips(), settings.dt)
    }

    fn work_grips(&self) -> WorkGrips<'_> {
        WorkGrips {
            start: &self.joint_grips,
            end: &self.end_grips,
        }
    }

    /// Keeps contact, and turning frames, from adding energy.
    ///
    /// `reserve` is what contact has taken since it began and may give back (J); a debt is kept until it is paid.
    pub(super) fn limit_energy(
        &mut self,
        settings: &SolveSettings,
        allowance: f64,
        reserve: &mut f64,
        summary: &mut IslandSummary,
    ) {
        let touches = self
            .contacts
            .iter()
            .any(|contact| contact.multiplier[0] > 0.0 || contact.remembered.normal > 0.0);
        let [kinetic, elastic] = summary.end_energy;
        let swings = self.has_swinging_joints(settings.is_within);
        let kept = match (touches, swings) {
            (false, false) => 0.0,
            (false, true) => kinetic + elastic,
            (true, false) => SWING * (kinetic + elastic),
            (true, true) => f64::INFINITY,
        };
        *reserve = reserve.min(kept);
        let gain =
            kinetic + elastic - summary.start_energy[0] - summary.start_energy[1] - allowance;
        *reserve -= gain;
        let band = if touches { ROUND_OFF } else { SWING.get() };
        // What is there by mistake is no measure of it.
        let had = summary.start_energy[0] + summary.start_energy[1] + allowance.abs();
        let debt = -*reserve - band * (kinetic + elastic).min(had);
        // At rest under load there are only rounding errors to take.
        let is_still = kinetic <= ROUND_OFF * elastic;
        if debt <= 0.0 || is_still {
            return;
        }
        let mut taken = if touches {
            self.remove_along_contacts(debt, settings)
        } else {
            0.0
        };
        if taken < debt {
            taken += self.remove_vibration(debt - taken);
        }
        if taken < debt && swings {
            let leaders = self.groups_of(|block| !block.is_prescribed());
            let joints = (&self.ties[..], &self.joint_grips[..]);
            let excess = debt - taken;
            summary.calmed = remove_relative_motion(&mut self.blocks, joints, &leaders, excess);
            taken += summary.calmed;
        }
        summary.limited = taken;
        summary.end_energy[0] -= taken;
        *reserve += taken;
    }

    /// Changes the end velocity along the response to the contact forces until `excess` (J) is gone, or as far as that
    /// direction carries energy; returns what was removed.
    fn remove_along_contacts(&mut self, excess: f64, settings: &SolveSettings) -> f64 {
        self.rows.clear();
        self.multipliers.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let force = contact.multiplier[0].max(contact.remembered.normal);
            if force > 0.0 && !contact.is_hard {
                self.rows.push(RowDirection {
                    contact: index,
                    direction: contact.kinematics.normal,
                });
                self.multipliers.push(force * settings.dt);
            }
        }
        if self.rows.is_empty() {
            return 0.0;
        }
        // Along what contacts and joints together allow.
        if self.hold_joints(settings).is_err() {
            return 0.0;
        }
        self.clear_impulses();
        self.gather_rows(Response::Velocity);
        self.respond();
        // Kinetic energy along v' + s z is a parabola in s; three samples give it exactly.
        let before = kinetic_energy(&self.blocks);
        let after = self.add_responses(1.0);
        let mirrored = self.add_responses(-2.0);
        let curvature = 0.5 * (after + mirrored) - before;
        let slope = 0.5 * (after - mirrored);
        // What presses against something that does not give way moves nothing, however often it is taken: it is taken no more often than would
        // undo it and bring all that moves to rest.
        let pressed: f64 = self.multipliers[..self.rows.len()].iter().sum();
        let most = 1.0 + momentum_at_most(&self.blocks) / pressed;
        let step = step_of_parabola(curvature, slope, excess)
            .min(most)
            .max(-most);
        for (row, impulse) in self.rows.iter().zip(&self.multipliers) {
            self.contacts[row.contact].impulse[0] += step * impulse;
        }
        let of_joints = &self.multipliers[self.rows.len()..];
        for (&row, impulse) in self.joint_rows.iter().zip(of_joints) {
            self.ties[row].impulse += step * impulse;
        }
        self.add_responses(1.0 + step);
        // What has flown away has slid since its row was measured: the levers of its force have a couple.
        self.balance_angular_momentum();
        before - kinetic_energy(&self.blocks)
    }

    /// Adds a multiple of the responses to the velocities; returns the kinetic energy (J).
    fn add_responses(&mut self, scale: f64) -> f64 {
        self.add_to_rigid(Response::Velocity, scale);
        self.add_to_flexible(Response::Velocity, scale);
        kinetic_energy(&self.blocks)
    }

    /// Scales down the vibration of the flexible blocks until `excess` (J) is gone; returns what was removed.
    fn remove_vibration(&mut self, excess: f64) -> f64 {
        let mut vibration = 0.0;
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                vibration += block.vibration_energy();
            }
        }
        if vibration <= 0.0 {
            return 0.0;
        }
        let before = kinetic_energy(&self.blocks);
        let factor = (1.0 - excess / vibration).max(0.0).sqrt();
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.scale_vibration(factor);
            }
        }
        before - kinetic_energy(&self.blocks)
    }

    /// Whether joints leave forces in stored accelerations, which swing from step to step.
    pub fn has_swinging_joints(&self, is_within: bool) -> bool {
        !self.ties.is_empty() && !is_within
    }
}

/// Energy error of one step by rounding, relative.
const ROUND_OFF: f64 = rounding::SUM;

/// Change of energy, relative, within which the integrator swings about it and gains nothing in the long run: of a body that turns freely,
/// and of what rests on each other and rocks.
const SWING: Judged = Judged::new("kkt::SWING", 1e-3);

/// The root nearer to zero of `curvature s² + slope s + excess = 0`, or the lowest point of the parabola.
fn step_of_parabola(curvature: f64, slope: f64, excess: f64) -> f64 {
    if curvature <= 0.0 {
        return 0.0;
    }
    let discriminant = slope * slope - 4.0 * curvature * excess;
    if discriminant <= 0.0 {
        return -slope / (2.0 * curvature);
    }
    let root = discriminant.sqrt().copysign(slope);
    (root - slope) / (2.0 * curvature)
}
