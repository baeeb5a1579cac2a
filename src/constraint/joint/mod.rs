//! Joints: rows of `G` between blocks that need not touch.
//!
//! A [`JointRow`] measures one number `q` of the relative position (along an axis, a distance, a turn) and holds it by a
//! [`JointLaw`]. A multiplier pushes along `+∂q/∂x`. Kinematics know no step, laws no shape function.

mod kinematics;
mod law;
mod memory;

pub(crate) use kinematics::unit_wrench;
pub use kinematics::{JointGrip, Measure, When};
pub use law::{JointLaw, Spring};
pub use memory::{JointKey, JointMemory, JointOwner, RememberedJoint};

/// One row of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointRow {
    /// Its name across steps.
    pub key: JointKey,
    /// What is measured.
    pub measure: Measure,
    /// +1, or -1 for a bound from above: what is measured is `sign q`.
    pub sign: f64,
    /// Range of the island's joint grips.
    pub grips: (usize, usize),
    /// How it is held.
    pub law: JointLaw,
    /// What it has left behind in the last step, if it was there.
    pub remembered: Option<RememberedJoint>,
}

impl JointRow {
    /// Its multiplier in the last step, for the warm start (N or N m).
    pub fn last_multiplier(&self) -> f64 {
        self.remembered.map_or(0.0, |last| last.multiplier)
    }

    /// What the last step has left of it in stored accelerations (N or N m).
    pub fn last_lasting(&self) -> f64 {
        self.remembered.map_or(0.0, |last| last.lasting)
    }
}
