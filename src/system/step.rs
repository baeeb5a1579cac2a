//! What a block is told of a step, and what it may be asked for.

use crate::integrator::Weights;
use crate::math::Vec2;

/// Everything about a step that is the same for all flexible bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Beta-2 weights.
    pub weights: Weights,
}

impl Step {
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
