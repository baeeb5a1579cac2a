//! The step of a world with flexible bodies, its settings, and what it tells.
//!
//! [`FlexPipeline::step`] takes the place of rapier's step. It looks for what flexible bodies may meet, solves them together with those rigid bodies,
//! and hands poses and velocities back to rapier, which steps the rest of the world. [`FlexParameters`] say how, [`StepReport`] tells what has come of it, and a
//! [`StepError`] says why a step was not taken; nothing has then been changed.
//!
//! | word | means |
//! |---|---|
//! | claimed | of a rigid body: solved here in this step, as it touches or is joined to a flexible body, directly or through others |
//! | island | flexible and claimed bodies that touch or are joined: one system of equations |
//! | pass | one round of solving an island: gaps are measured, forces found, bodies moved |
//! | part | a half, a quarter, ... of a step: an island that is not solved in one piece is solved in parts |
//! | led | of surfaces: moved along a *feasible path*, on which they are never in each other |
//! | contactor, target | of a contact: the body whose point touches, and the one whose surface is touched |
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! flex_bodies.insert(FlexBodyBuilder::disc(0.5, 0.2).material(rubber), &mut world)?;
//! world.gravity = Vector::new(f32::NAN.into(), 0.0);
//! let error = FlexPipeline::new().step(&mut world, &mut flex_bodies).unwrap_err();
//! assert!(error.to_string().contains("set `gravity` to finite numbers"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accounts;
mod checks;
mod clearing;
mod clock;
mod cutback;
#[cfg(feature = "debug-render")]
mod debug_render;
mod entries;
mod error;
mod flex_pipeline;
mod islands;
mod joint_accounts;
mod known_cuts;
mod names;
mod notes;
mod outcome;
mod overbent;
mod participant;
mod quality;
mod report;
// Scaled values are those of one thread.
#[cfg(all(test, not(feature = "parallel")))]
mod sensitivity;
mod settings;
#[cfg(feature = "serde-serialize")]
mod snapshot;
mod solve;
mod solved;
mod step;
mod unsolved;

#[cfg(feature = "debug-render")]
pub use debug_render::FlexDebugRender;
pub use entries::{ContactReport, EnergyReport, JointReport, StageTimes};
pub use error::StepError;
pub use flex_pipeline::FlexPipeline;
pub use notes::InsertionNote;
pub use overbent::Overbent;
pub use participant::{Held, Participant};
pub use quality::{Quality, Unsolved};
pub use report::StepReport;
pub use settings::FlexParameters;
#[cfg(feature = "serde-serialize")]
pub use snapshot::{Snapshot, SnapshotError};
