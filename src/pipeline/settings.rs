//! What a user chooses of a pipeline.

use super::flex_pipeline::FlexPipeline;
use crate::integrator::Beta2;
use crate::kkt::{ContactMethod, ImpactTreatment};
use crate::linalg::complementarity::Method;

impl FlexPipeline {
    /// Chooses the member of the Beta-2 family.
    ///
    /// An explicit one (`β0 = 0`, [`Beta2::central_difference`]) needs a lumped mass; contact forces then are multipliers at
    /// the forward increment, and the [treatment of impacts](Self::with_impact) does not matter. Steps longer than the
    /// critical one of a body are refused, see [`Self::insisting`].
    pub fn with_integrator(mut self, integrator: Beta2) -> Self {
        self.integrator = integrator;
        self
    }

    /// Chooses what is done on impact.
    pub fn with_impact(mut self, impact: ImpactTreatment) -> Self {
        self.impact = impact;
        self
    }

    /// Chooses how the laws of contact are enforced: by Lagrange multipliers, or for comparison by the constraint functions of
    /// ADINA. Steps in which the latter fail are counted, see [`StepReport::n_failed`](super::StepReport::n_failed).
    pub fn with_contact_method(mut self, method: ContactMethod) -> Self {
        self.contact = method;
        self
    }

    /// Chooses the solver of the contact problems: the active set, a direct method, by default;
    /// [`Method::GaussSeidel`] for the modified Gauss–Seidel method of Carpenter, Taylor and Katona.
    pub fn with_contact_solver(mut self, method: Method) -> Self {
        self.solver = method;
        self
    }

    /// Takes steps longer than the critical one of a conditionally stable integrator instead of refusing them.
    ///
    /// The critical step of a body is that of a safe bound, so a step a little longer may be stable; one much longer makes the highest
    /// frequencies grow until numbers are no longer finite. The same goes for rigid bodies that are light on the surface of an
    /// explicit body.
    pub fn insisting(mut self) -> Self {
        self.insists = true;
        self
    }

    /// Refuses steps that are not [solved](super::Quality::Solved), with [`StepError::Unsolved`](super::StepError::Unsolved), instead of
    /// taking them and telling of it in the report.
    pub fn refusing_unsolved(mut self) -> Self {
        self.refuses_unsolved = true;
        self
    }

    /// Approach velocity (m/s) below which restitution is ignored, so that resting contacts do not bounce.
    pub fn with_restitution_threshold(mut self, threshold: f64) -> Self {
        self.restitution_threshold = threshold;
        self
    }

    /// The integrator.
    pub fn integrator(&self) -> Beta2 {
        self.integrator
    }
}
