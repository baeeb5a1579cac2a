//! The step: detect, claim, predict, constrain, solve, correct, hand back.

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
