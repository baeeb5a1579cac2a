//! Snapshots: a run that was saved and restored goes on bit for bit, and data that is not ours or damaged is refused.

mod common;
#[path = "snapshot/laws.rs"]
mod laws;
#[path = "snapshot/rapier_alone.rs"]
mod rapier_alone;
#[path = "snapshot/refusals.rs"]
mod refusals;
#[path = "snapshot/resume.rs"]
mod resume;
#[path = "snapshot/scenes.rs"]
mod scenes;
#[path = "snapshot/support.rs"]
mod support;
