//! The step as its user sees it: time, bodies that come and go, rapier's events and queries, pins and loads.

#[path = "pipeline/beside.rs"]
mod beside;
#[path = "pipeline/coming_and_going.rs"]
mod coming_and_going;
mod common;
#[path = "pipeline/half_spaces.rs"]
mod half_spaces;
#[path = "pipeline/late_loads.rs"]
mod late_loads;
#[path = "pipeline/loads.rs"]
mod loads;
#[path = "pipeline/put_across.rs"]
mod put_across;
#[path = "pipeline/put_together.rs"]
mod put_together;
#[path = "pipeline/rapier_features.rs"]
mod rapier_features;
#[path = "pipeline/stability.rs"]
mod stability;
#[path = "pipeline/steering.rs"]
mod steering;
#[path = "pipeline/support.rs"]
mod support;
#[path = "pipeline/time.rs"]
mod time;
#[path = "pipeline/wedged.rs"]
mod wedged;
