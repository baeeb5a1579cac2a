//! The step: detect, claim, predict, constrain, solve, correct, hand back.

mod accounts;
mod checks;
mod error;
mod flex_pipeline;
mod joint_accounts;
mod quarantine;
mod report;
mod settings;

pub use error::StepError;
pub use flex_pipeline::FlexPipeline;
pub use report::{
    ContactReport, EnergyReport, Held, JointReport, Participant, StageTimes, StepReport,
};
