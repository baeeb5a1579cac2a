//! Impact treatments: what is done beyond (C.5) when bodies collide.

/// How impacts are treated. Whether a body's contact boundary carries inertia is chosen per body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImpactTreatment {
    /// Velocity impulses between masses and on impacts shorter than the step, and no energy from contact: stable at any
    /// step and mesh.
    #[default]
    Stabilized,
    /// (C.5) as printed, multipliers enter the stored acceleration. Unstable on impact: for comparison only.
    Plain,
}
