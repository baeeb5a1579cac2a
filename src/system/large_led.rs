//! A body of large strain whose end under given contact forces is not found: led along the path by one Newton step from the base of each
//! pass.
//!
//! Forces that are far from right fling a body farther than its cells are wide, and no iteration comes back from there. From the base,
//! which is a place that was reached, the body is answered for by what it is there,
//!
//! ```text
//! x = b + K(b)⁻¹ (f + Gᵀp - r(b)),
//! ```
//!
//! which is what the rows of the contact problem know of it: the forces found from them lead where they are meant to lead. The path goes
//! there as far as surfaces stay apart and no cell turns over, and the next pass begins from there (Newton's method on the contact problem as a whole).

/// Length of the last increment, relative to the body's size, from which the end is looked for under given forces again (-).
const NEAR: f64 = 1e-3;

/// What is known of the way of a body that is led.
#[derive(Clone, Debug, Default)]
pub(super) struct Led {
    /// Whether it is. Not where the iterate has been put elsewhere: increments count from where the base has led.
    pub is_led: bool,
    /// Positions at the base of the path (m); none where there is no path.
    pub base: Vec<f64>,
    /// Contact forces at the iterate (N).
    pub force: Vec<f64>,
    /// Length of the increment from the base without new forces, relative to the body's size (-).
    pub left: f64,
    /// Share of the way from the base on which no cell turns over (-).
    pub reach: f64,
    /// A place on the way (m).
    pub place: Vec<f64>,
}

impl Led {
    /// Begins a step.
    pub fn forget(&mut self) {
        self.is_led = false;
        self.base.clear();
    }

    pub fn has_base(&self) -> bool {
        !self.base.is_empty()
    }

    /// Whether its end under given forces may be looked for.
    pub fn is_near(&self) -> bool {
        !self.is_led || self.left <= NEAR
    }
}
