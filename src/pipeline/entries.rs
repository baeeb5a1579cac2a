//! What a report of a step is made of: contacts, joints, energies, times.

use super::participant::{Held, Participant};

/// One contact at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ContactReport {
    /// Position where the step ends (m); of a contact that has opened in an earlier part of a step that was taken in parts, where it was then.
    pub position: [f64; 2],
    /// Unit normal, from the target to the contactor.
    pub normal: [f64; 2],
    /// Gap (m), negative for overlap.
    pub gap: f64,
    /// Compressive force on the contactor along the normal (N): the impulse that the step adds to the bodies over its length. The
    /// part `1 - β1` of a force that lasts acts in the next step, so that sums over time, not single steps, balance momentum.
    /// Negative where energy that the last step's force had added is taken back; what is taken at a contact that has just opened is in
    /// [`StepReport::force_on`](super::StepReport::force_on) and
    /// [`FlexBody::total_contact_force`](crate::body::FlexBody::total_contact_force) alone.
    pub normal_force: f64,
    /// Force on the contactor along the tangent, a quarter turn counter-clockwise from the normal (N). Where the normal turns within steps, what the energy stage
    /// takes from what slides there is in it, without friction too.
    pub tangential_force: f64,
    /// What the force on the contactor is beyond these two as it acts (N): with a body of large strain it does so midway through the step, along the
    /// normal and at the lever that the contact has there. [`StepReport::force_on`](super::StepReport::force_on) counts it.
    pub midway: [f64; 2],
    /// Whether friction holds.
    pub sticks: bool,
    /// The body whose point touches.
    pub contactor: Participant,
    /// The body whose surface is touched.
    pub target: Participant,
}

/// What a step has given at a contact that is open at its end, where the force of the step before acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Opened {
    /// The contactor and the target.
    pub between: [Participant; 2],
    /// Force on the contactor (N).
    pub force: [f64; 2],
}

impl ContactReport {
    /// The force on the contactor (N), in the directions at the end of the step: with [`position`](Self::position) it gives torques.
    pub fn force(&self) -> [f64; 2] {
        let [nx, ny] = self.normal;
        [
            self.normal_force * nx - self.tangential_force * ny,
            self.normal_force * ny + self.tangential_force * nx,
        ]
    }
}

/// Reaction of one joint of claimed bodies, or of one attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct JointReport {
    /// Which.
    pub joint: Held,
    /// Where it pulls at the second body, or the mean of the nodes it holds (m).
    pub position: [f64; 2],
    /// Mean force over the step on the second body of the joint, or on the attached body (N); with small strain a part of it acts in the step after.
    pub force: [f64; 2],
    /// Mean torque on it about the position (N m).
    pub torque: f64,
}

/// Energy of all flexible and claimed rigid bodies (J). What springs of joints and attachments store is not in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct EnergyReport {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Elastic energy, and that of gases shut in holes: the work they can do until they are at the pressure outside.
    pub elastic: f64,
    /// Potential energy of gravity, zero at the origin.
    pub potential: f64,
    /// By how much an explicit step's energy swings about the one it conserves, `dt²/8 a·M a` at this instant; zero for implicit
    /// integrators. `total() - swing` is constant where nothing dissipates, up to the step's limit of stability.
    pub swing: f64,
    /// What plastic flow took in this step, never negative; it is in `dissipated` as well.
    pub flowed: f64,
    /// What friction, damping, plastic flow, restitution and the integrator took since the pipeline was made: work done by applied
    /// forces, constant inner pressures and prescribed motion less the gain of kinetic and elastic energy, over bodies while they were claimed.
    pub dissipated: f64,
}

impl EnergyReport {
    /// Kinetic, elastic and potential energy (J).
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.potential
    }
}

/// Wall-clock time of the stages (s); zero without the feature `timing`, and on `wasm32-unknown-unknown`, which has no clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTimes {
    /// Rapier's step, and the one without length before it where there was one.
    pub rapier: f64,
    /// Look-ahead and claim.
    pub claim: f64,
    /// Predictors, candidates.
    pub gather: f64,
    /// Free motion, multipliers, impacts.
    pub solve: f64,
    /// Commit, hand-back, surfaces.
    pub hand_back: f64,
}

impl StageTimes {
    /// Time outside rapier (s).
    pub fn own(&self) -> f64 {
        self.claim + self.gather + self.solve + self.hand_back
    }
}

/// How far tangential forces leave Coulomb's cone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct ConeExcess {
    /// Largest `|t| - μ n` (N).
    excess: f64,
    /// Largest `n` (N).
    normal: f64,
}

impl ConeExcess {
    /// Notes a contact of these normal and tangential forces (N) and this coefficient of friction (-).
    pub fn note(&mut self, [normal, tangent]: [f64; 2], friction: f64) {
        self.excess = self.excess.max(tangent.abs() - friction * normal);
        self.normal = self.normal.max(normal);
    }

    /// The largest excess over the largest normal force (-).
    pub fn residual(&self) -> f64 {
        if self.normal > 0.0 {
            self.excess / self.normal
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ConeExcess;

    /// A weak contact that slips a little too hard says little beside a strong one: 0.1 N of 1000 N, not of 1 N.
    #[test]
    fn excess_is_relative_to_the_largest_normal_force_of_the_step() {
        let mut cone = ConeExcess::default();
        assert_eq!(cone.residual(), 0.0);
        cone.note([1.0, -0.6], 0.5);
        assert!((cone.residual() - 0.1).abs() < 1e-15);
        cone.note([1000.0, 400.0], 0.5);
        assert!((cone.residual() - 1e-4).abs() < 1e-18);
        cone.note([10.0, 9.0], 0.5);
        assert!((cone.residual() - 4e-3).abs() < 1e-17);
    }
}
