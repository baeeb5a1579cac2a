//! Scenes that a new user found to go wrong, as physics.

#[path = "reproductions/boards.rs"]
mod boards;
#[path = "common/mod.rs"]
mod common;
#[path = "reproductions/cost.rs"]
mod cost;
#[path = "reproductions/discs.rs"]
mod discs;
#[path = "reproductions/ropes.rs"]
mod ropes;
#[path = "reproductions/wheels.rs"]
mod wheels;
