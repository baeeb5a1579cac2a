//! The step: detect, claim, predict, constrain, solve, correct, hand back.

mod accounts;
mod checks;
mod error;
mod flex_pipeline;
mod joint_accounts;
mod report;
mod settings;
#[cfg(feature = "serde-serialize")]
mod snapshot;

pub use error::StepError;
pub use flex_pipeline::FlexPipeline;
pub use report::{
    ContactReport, EnergyReport, Held, JointReport, Participant, StageTimes, StepReport,
};
#[cfg(feature = "serde-serialize")]
pub use snapshot::{Snapshot, SnapshotError};
