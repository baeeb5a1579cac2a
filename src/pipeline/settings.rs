//! What a user chooses of a pipeline.

use super::error::StepError;
use crate::integrator::Beta2;
use crate::kkt::{ContactMethod, ImpactTreatment};
use crate::linalg::complementarity::Method;
use crate::system::Step;

/// Halvings of a step that may be asked for.
const MOST_CUTBACKS: usize = 10;

/// How a [`FlexPipeline`](super::FlexPipeline) takes its steps, as rapier's `IntegrationParameters` say it of rapier: plain values, read at the beginning of each
/// step.
///
/// The `with_*` methods of the pipeline set the same values.
///
/// ```
/// use foil2d::prelude::*;
/// let mut flex = FlexPipeline::new();
/// flex.parameters.max_newton *= 2;
/// flex.parameters.integrator = Beta2::trapezoidal();
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct FlexParameters {
    /// The member of the Beta-2 family; [`Beta2::damped`]`(0.9)` by default. See [`FlexPipeline::with_integrator`](super::FlexPipeline::with_integrator).
    pub integrator: Beta2,
    /// What is done on impact; stabilized by default.
    pub impact: ImpactTreatment,
    /// How the laws of contact are enforced; by Lagrange multipliers by default. See [`FlexPipeline::with_contact_method`](super::FlexPipeline::with_contact_method).
    pub contact_method: ContactMethod,
    /// The solver that contact problems are given to first; the active set by default.
    pub contact_solver: Method,
    /// Approach velocity (m/s) below which restitution is ignored, so that resting contacts do not bounce; 0.5 by default, times the world's `length_unit`.
    pub restitution_threshold: f64,
    /// Most passes (Newton iterations) of an island in a step, at least 1; 20 by default, twice as many along a feasible path. What becomes of an island that needs more is told
    /// by [`StepReport::quality`](super::StepReport::quality).
    pub max_newton: usize,
    /// How many times the step of an island that is not solved may be cut in halves; 3 by default, so that it is taken in 8 parts at most. What is not
    /// finished for many steps is tried with more cuts now and then.
    /// See [`StepReport::n_parts`](super::StepReport::n_parts). Explicit steps are not cut.
    pub max_cutbacks: usize,
    /// The same of an island with bodies of large strain, whose equations get easier with every cut; 5 by default. A step after which such a
    /// body might be in more places than one is cut at once.
    pub max_cutbacks_large: usize,
    /// Pivots of dense problems after which the step of an island is not cut any more, and its parts go on after a few passes each; 5000 by
    /// default. What can be solved takes some hundreds, seldom thousands ([`StepReport::n_pivots`](super::StepReport::n_pivots)); what is crushed between driven bodies would take tens of thousands,
    /// and not be solved.
    pub max_pivots: usize,
    /// Whether implicit steps with Lagrange multipliers lead the surfaces of bodies along a *feasible path*; yes by default.
    ///
    /// A step goes from placement to placement and stops where surfaces would meet, whatever the forces are. What is not solved within the
    /// budget ends there, and [`StepReport::quality`](super::StepReport::quality) tells of it. Flexible bodies rest
    /// [`FlexBody::contact_offset`](crate::body::FlexBody::contact_offset) from themselves and from terrain without thickness, and touch all else. Pairs whose contacts hooks take away or move, and what overlaps to begin with, are not led.
    pub feasible_path: bool,
    /// Whether steps longer than the critical one are taken all the same; no by default. See [`FlexPipeline::insisting`](super::FlexPipeline::insisting).
    pub insists: bool,
    /// Whether steps that are not solved are refused; no by default. See [`FlexPipeline::refusing_unsolved`](super::FlexPipeline::refusing_unsolved).
    pub refuses_unsolved: bool,
}

impl Default for FlexParameters {
    fn default() -> Self {
        Self {
            integrator: Beta2::default(),
            impact: ImpactTreatment::default(),
            contact_method: ContactMethod::default(),
            contact_solver: Method::ActiveSet,
            restitution_threshold: 0.5,
            max_newton: 20,
            max_cutbacks: 3,
            max_cutbacks_large: 5,
            max_pivots: 5000,
            feasible_path: true,
            insists: false,
            refuses_unsolved: false,
        }
    }
}

impl FlexParameters {
    /// Refuses values that no step can be taken with.
    pub(super) fn check(&self) -> Result<(), StepError> {
        let threshold = self.restitution_threshold;
        if threshold.is_nan() || threshold < 0.0 {
            return Err(StepError::Parameter {
                name: "restitution_threshold",
                value: threshold,
                cure: "set it to zero or a positive number (m/s), infinity for no restitution",
            });
        }
        if self.max_newton == 0 {
            return Err(StepError::Parameter {
                name: "max_newton",
                value: 0.0,
                cure: "set it to one or more",
            });
        }
        let cutbacks = [
            ("max_cutbacks", self.max_cutbacks),
            ("max_cutbacks_large", self.max_cutbacks_large),
        ];
        for (name, value) in cutbacks {
            if value > MOST_CUTBACKS {
                return Err(StepError::Parameter {
                    name,
                    value: value as f64,
                    cure: "set it to ten or less: that is a step in a thousand parts",
                });
            }
        }
        Ok(())
    }

    /// Whether surfaces are led along a feasible path.
    pub(super) fn leads(&self, step: Step) -> bool {
        self.feasible_path && !step.is_explicit() && self.contact_method == ContactMethod::Lagrange
    }

    /// How often the step of an island may be halved.
    pub(super) fn most_cutbacks(&self, has_large: bool) -> usize {
        match has_large {
            true => self.max_cutbacks_large,
            false => self.max_cutbacks,
        }
    }
}
