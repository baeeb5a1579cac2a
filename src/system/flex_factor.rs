//! The factor of a flexible block, `A = b2 M + b1 C + b0 K` in its frame: once for ever, until the weights change.

use super::flex_block::FlexBlock;
use super::flex_surface::FollowingSurface;
use crate::body::Frame;
use crate::integrator::Weights;
use crate::linalg::cholesky::CholeskyError;

/// Error of a rigid motion from which contact iterations no longer converge.
const MOST_HIDDEN: f64 = 1e-3;

impl FlexBlock {
    /// Factorizes the effective matrix, if the weights are new.
    ///
    /// # Errors
    /// If it is not positive definite, or rounding hides the mass in it.
    pub(super) fn factorize(&mut self, weights: Weights) -> Result<(), CholeskyError> {
        if self.factored_for == Some(weights) {
            return Ok(());
        }
        let rayleigh = self.model.rayleigh();
        self.effective.assign_scaled(
            weights.b0 + rayleigh.stiffness * weights.b1,
            self.model.stiffness(),
        );
        self.model
            .mass()
            .add_to(1.0 + rayleigh.mass * weights.b1, &mut self.effective);
        self.effective.constrain(&self.is_fixed);
        self.factored_for = None;
        if self.surface.is_none() && self.has_massless_surface() {
            self.surface = Some(FollowingSurface::new(&self.model, &self.is_fixed)?);
        }
        self.factor.factorize(&self.effective)?;
        self.n_factorizations += 1;
        self.compliance.clear();
        if self.kind == Frame::Free {
            self.check_rigid_motion(1.0 + rayleigh.mass * weights.b1)?;
        }
        self.factored_for = Some(weights);
        Ok(())
    }

    /// Refuses a matrix in which rounding of the stiffness hides the mass: `A e = (1 + α b1) M e` for every rigid translation `e`.
    fn check_rigid_motion(&mut self, factor: f64) -> Result<(), CholeskyError> {
        self.scratch.iter_mut().enumerate().for_each(|(dof, e)| {
            *e = if dof % 2 == 0 { 1.0 } else { -1.0 };
        });
        self.local.fill(0.0);
        self.model
            .mass()
            .multiply_add(factor, &self.scratch, &mut self.local);
        self.factor.solve_in_place(&mut self.local);
        let pairs = self.local.iter().zip(&self.scratch);
        let error = pairs.fold(0.0f64, |error, (found, e)| error.max((found - e).abs()));
        if error <= MOST_HIDDEN {
            Ok(())
        } else {
            Err(CholeskyError::IllConditioned { error })
        }
    }
}
