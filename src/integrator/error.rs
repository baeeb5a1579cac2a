//! Why the Beta-2 method cannot take a step.

use thiserror::Error;

/// A choice of parameters or step that the Beta-2 method cannot take.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum IntegratorError {
    /// A parameter is not a number or outside its range.
    #[error("{name} is {value}: choose a finite value in {range}")]
    Parameter {
        /// Which parameter.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// The admissible range.
        range: &'static str,
    },
    /// The member is only conditionally stable and the step is too long for the mesh.
    #[error(
        "the step of {dt} s is longer than the critical step {critical} s of a conditionally stable integrator on this mesh (largest frequency {frequency} rad/s): shorten the step, coarsen the mesh, or choose beta0 >= beta1 >= 1/2"
    )]
    Unstable {
        /// The step asked for (s).
        dt: f64,
        /// The longest stable step (s).
        critical: f64,
        /// Upper bound of the largest natural frequency (rad/s).
        frequency: f64,
    },
    /// The member is only conditionally stable, and nodes of the surface have no mass: no step is short enough for these.
    #[error(
        "nodes of the surface have no mass, and no step of this conditionally stable integrator is short enough for them: keep the inertia of the surface (`ContactInertia::Kept`), or choose beta0 >= beta1 >= 1/2"
    )]
    MasslessSurface,
    /// The member has `β0 = 0` and the mass matrix is not diagonal.
    #[error(
        "beta0 is 0 and the mass is consistent, so that a step would have to solve for accelerations: choose `MassKind::Lumped`, or beta0 > 0"
    )]
    ConsistentMass,
    /// The member has `β0 = 0` and the body is one of large strain.
    #[error(
        "beta0 is 0 and the body is one of large strain, whose steps are implicit: choose beta0 > 0, or `FlexBodyBuilder::small_strain()` and a `LinearElastic` material"
    )]
    LargeStrain,
    /// The member has `β0 = 0`, for which the second row of (C.5) vanishes.
    #[error(
        "beta0 is 0: positions at the end of the step do not depend on the contact forces of the step, so (C.5) is singular; choose beta0 > 0, or integrate with multipliers at the forward increment"
    )]
    Explicit,
}
