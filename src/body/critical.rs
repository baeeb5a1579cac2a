//! Natural frequencies of a body: the largest one, which bounds the step of an explicit integrator, and the lowest ones.

use super::flex_body::FlexBody;
use crate::fe::frequency::frequency_bound;
use crate::fe::modes::{Modes, ModesError, lowest_modes, lowest_modes_at};
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

    /// The `n_modes` lowest natural modes of the body as it is pinned, known to `tolerance`; see [`lowest_modes`].
    ///
    /// Of a body of small strain in its frame, whatever its place; of one of large strain about where it is now and in the world's axes, which
    /// is meant for equilibria. Contacts, joints, attachments and damping are left out.
    ///
    /// # Errors
    /// [`ModesError`], as of [`lowest_modes`] and [`lowest_modes_at`].
    pub fn natural_modes(&self, n_modes: usize, tolerance: f64) -> Result<Modes, ModesError> {
        let is_fixed = self.fixed_dofs();
        match self.large() {
            Some(large) => lowest_modes_at(large, self.positions(), is_fixed, n_modes, tolerance),
            None => lowest_modes(self.model(), is_fixed, n_modes, tolerance),
        }
    }
}
