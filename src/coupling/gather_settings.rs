//! What an island is gathered for.

use super::under_way::Span;
use crate::system::Step;

/// What all members of an island have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherSettings {
    /// The component of the claim to gather.
    pub component: usize,
    /// Step length and weights, those of the part that is solved.
    pub step: Step,
    /// Which part of the step it is.
    pub span: Span,
    /// Prediction distance of rapier (m).
    pub prediction: f64,
    /// By how much members have left the boxes they were looked for in (m).
    pub excess: f64,
    /// Whether flexible surfaces are led along a feasible path.
    pub uses_path: bool,
}
