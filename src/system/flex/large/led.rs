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
//! there as far as surfaces stay apart, no cell turns over and the forces out of balance do work, and the next pass begins from there
//! (Newton's method on the contact problem as a whole).
//!
//! `r` is made with the stress of the end, which has a potential: `K` is symmetric, and with it the contact problem goes down in the
//! energy. The conserving stress has a derivative that is not symmetric; in a cell that is all but flat, the direction in which the force grows
//! is not the one in which it acts.

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
    /// Share of the way from the base on which no cell turns over and the forces out of balance do work (-).
    pub reach: f64,
    /// A place on the way (m).
    pub place: Vec<f64>,
}

impl Led {
    /// Begins a step.
    pub fn forget(&mut self) {
        self.is_led = false;
        self.reach = 1.0;
        self.base.clear();
    }

    pub fn has_base(&self) -> bool {
        !self.base.is_empty()
    }
}
