//! What acts on a body of small strain in a step besides contact, and what of it is late.

use super::step::FlexLoad;
use crate::body::AppliedLoad;

/// Loads of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct StepLoads {
    /// Those of the step.
    pub own: AppliedLoad,
    /// They are late by `1 - β1` of a step of this length (s).
    pub lag: f64,
    /// What is late to come in the step, less what would have been late to it, as a mean force (N); empty where loads are what they were.
    pub late: Vec<f64>,
}

impl StepLoads {
    /// Begins a step.
    pub fn begin(&mut self, load: &FlexLoad<'_>, lag: f64) {
        self.own.assign(load.force, load.gravity);
        self.lag = lag;
        self.late.clear();
    }
}
