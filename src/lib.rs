#![doc = include_str!("../README.md")]
//!
//! # Where to begin
//!
//! | you look for | read |
//! |---|---|
//! | how things are done, page by page | [`guide`] |
//! | a body and its builder | [`body`] |
//! | the step, its settings and its report | [`pipeline`] |
//! | files in and out | [`io`] |
//! | equilibria without a world | [`large`] |
//! | likely mistakes | [`doctor`] |
//! | why a body is the way it is: meshes, elements, materials | [`fe`] |
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(all(feature = "f32", feature = "f64"))]
compile_error!(
    "features `f32` and `f64` exclude each other: build the f64 version with `--no-default-features --features f64`"
);
#[cfg(not(any(feature = "f32", feature = "f64")))]
compile_error!("choose rapier's precision: feature `f32` (the default) or `f64`");

#[cfg(all(feature = "f32", not(feature = "f64")))]
pub use rapier2d as rapier;
#[cfg(feature = "f64")]
pub use rapier2d_f64 as rapier;

pub mod body;
pub mod constraint;
pub mod coupling;
pub mod doctor;
pub mod fe;
pub mod guide;
pub mod integrator;
pub mod io;
pub mod kkt;
pub mod large;
pub mod linalg;
pub mod math;
pub mod nonlinear;
pub(crate) mod path;
pub mod pipeline;
pub mod system;

/// What most programs need.
pub mod prelude {
    pub use crate::body::{
        Attachment, AttachmentBuilder, AttachmentHandle, ContactInertia, FlexBody, FlexBodyBuilder,
        FlexBodyHandle, FlexBodySet, Pin, PreStretch,
    };
    pub use crate::fe::finite_strain::InnerPressure;
    pub use crate::fe::material::hyperelastic::{
        Corotated, HyperelasticSolid, NeoHookean, StableNeoHookean,
    };
    pub use crate::fe::material::{LinearElastic, Material};
    pub use crate::fe::mesh::{CellKind, Mesh};
    pub use crate::fe::model::MassKind;
    pub use crate::integrator::Beta2;
    pub use crate::kkt::{ConstraintFunction, ContactMethod, ImpactTreatment};
    pub use crate::pipeline::{FlexParameters, FlexPipeline, StepReport};
}
