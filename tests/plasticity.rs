//! Bodies that flow plastically: stresses with known answers, limit loads, steps that account for all energy, bodies in a world.

#[path = "plasticity/bodies.rs"]
mod bodies;
mod common;
#[path = "plasticity/dynamics.rs"]
mod dynamics;
#[path = "plasticity/limit_loads.rs"]
mod limit_loads;
#[path = "plasticity/statics.rs"]
mod statics;
#[path = "plasticity/support.rs"]
mod support;
