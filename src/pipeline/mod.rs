//! The step: detect, claim, predict, constrain, solve, correct, hand back.

mod accounts;
mod flex_pipeline;
mod report;

pub use flex_pipeline::{FlexPipeline, StepError};
pub use report::{ContactReport, EnergyReport, Participant, StageTimes, StepReport};
