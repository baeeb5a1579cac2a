//! What a block is told of a step, and what it may be asked for.

use crate::integrator::{Beta2, Weights};
use crate::math::Vec2;

/// Everything about a step that is the same for all flexible bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Beta-2 weights of multipliers, and of everything else that small-strain bodies feel.
    pub weights: Weights,
    /// Beta-2 weights of what rigid bodies feel without multipliers.
    pub own: Weights,
    /// How long the forces that the last step has left in stored accelerations act on (s).
    pub late: f64,
    /// Decay `χ` of the vibrations of bodies of large strain.
    pub decay: f64,
}

impl Step {
    /// A step of a member of the family.
    pub fn new(member: &Beta2, dt: f64) -> Self {
        let weights = member.weights(dt);
        Self {
            dt,
            weights,
            own: weights,
            late: dt - weights.b1,
            decay: member.decay(),
        }
    }

    /// The step of an island with bodies of large strain: multipliers act wholly within the step that finds them.
    ///
    /// With the share `1 - β1` of a contact force that acts on in the next step, contacts that open are pushed apart by what pressed them.
    /// Where a stiff surface closes here in one step and there in the next, that is energy from nowhere. A force that acts where the step ends
    /// in contact, and nowhere else, does no work on what stays, and takes energy from what closes.
    pub fn with_large(self) -> Self {
        Self {
            weights: Weights::within(self.dt),
            ..self
        }
    }

    /// A half of the step.
    pub fn halved(self, member: &Beta2) -> Self {
        let half = Self::new(member, 0.5 * self.dt);
        if self.is_within() {
            half.with_large()
        } else {
            half
        }
    }

    /// Whether multipliers act wholly within the step.
    pub fn is_within(&self) -> bool {
        self.weights == Weights::within(self.dt)
    }

    /// Whether positions at the end do not depend on accelerations there: `b0 = 0`.
    pub fn is_explicit(&self) -> bool {
        self.weights.b0 == 0.0
    }
}

/// What responds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// The end position, to forces.
    Position,
    /// The end velocity, to impulses.
    Velocity,
    /// The end acceleration, to forces.
    Acceleration,
    /// The masses alone, as if nothing held them together: a flexible body answers only where it is pushed.
    ByMass,
}

/// Applied loads of one step.
#[derive(Clone, Copy, Debug)]
pub struct FlexLoad<'a> {
    /// Nodal forces without gravity, interleaved (N).
    pub force: &'a [f64],
    /// Gravity and other forces per mass (m/s²).
    pub gravity: Vec2,
    /// Displacement of the pinned dofs, interleaved (m).
    pub prescribed: &'a [f64],
    /// Reactions of the pins at the beginning of the step, interleaved (N).
    pub reaction: &'a [f64],
}
