//! How exactly steps are solved, how fast vibrations decay, and how hard to try.

use super::LargeError;

/// Settings of [`LargeStepper`](super::LargeStepper) and [`LoadStepper`](super::LoadStepper).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargeSettings {
    /// Residual over the largest load or inertia force of a step, or load or reaction of an equilibrium, that ends the iterations (-).
    ///
    /// 1e-4 leaves an error of some 1e-6 in the path of a swing; 1e-6 is for verification, 1e-9 shows conservation.
    pub tolerance: f64,
    /// The decay `χ ≥ 0` of vibrations that the step cannot resolve (-); 0 conserves energy.
    pub decay: f64,
    /// Iterations of one attempt at most.
    pub max_iterations: usize,
    /// How often a step or load increment may be halved.
    pub max_cutbacks: usize,
    /// Iterations of all parts of one step at most, so that a step cannot take for ever.
    pub budget: usize,
}

impl Default for LargeSettings {
    /// `damped(0.9)`.
    fn default() -> Self {
        Self::damped(0.9)
    }
}

impl LargeSettings {
    /// Without decay: free bodies keep their energy.
    pub fn conserving() -> Self {
        Self {
            tolerance: 1e-6,
            decay: 0.0,
            max_iterations: 40,
            max_cutbacks: 8,
            budget: 1000,
        }
    }

    /// With the decay `χ = (1 - ρ)/(1 + ρ)`, at which vibrations much faster than the step shrink by `ρ` in each (-).
    pub fn damped(rho: f64) -> Self {
        Self {
            decay: (1.0 - rho) / (1.0 + rho),
            ..Self::conserving()
        }
    }

    /// The same with another [`tolerance`](Self::tolerance) (-).
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    pub(super) fn check(&self) -> Result<(), LargeError> {
        let refuse = |name, value, range| Err(LargeError::Setting { name, value, range });
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return refuse("the tolerance", self.tolerance, "(0, 1)");
        }
        if !(self.decay >= 0.0 && self.decay.is_finite()) {
            return refuse("the decay", self.decay, "[0, infinity)");
        }
        if self.max_iterations == 0 {
            return refuse("the number of iterations", 0.0, "[1, infinity)");
        }
        if self.max_cutbacks > 30 {
            let value = self.max_cutbacks as f64;
            return refuse("the number of cutbacks", value, "[0, 30]");
        }
        Ok(())
    }
}
