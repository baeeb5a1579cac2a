//! The largest frequency of a body, which bounds the step of an explicit integrator.

use super::flex_body::FlexBody;
use crate::fe::frequency::frequency_bound;
use crate::math::hypot;

impl FlexBody {
    /// An upper bound of the largest natural frequency of the body as it is held (rad/s), with nodes without mass held too,
    /// as a contact may; a step by central difference may last `2 / ω`.
    ///
    /// With stiffness damping it is `ω (√(1 + ζ²) + ζ)`, `ζ = β ω / 2`: that of an undamped body with the same critical
    /// step, where damping takes its rate from the half step before.
    ///
    /// The first call costs one small eigenvalue problem per cell.
    pub fn explicit_frequency(&self) -> f64 {
        *self.frequency.get_or_init(|| {
            let bound = frequency_bound(self.model(), self.fixed_dofs());
            let omega = bound.unwrap_or(f64::INFINITY);
            let ratio = 0.5 * self.model().rayleigh().stiffness * omega;
            omega * (ratio + hypot(ratio, 1.0))
        })
    }
}
