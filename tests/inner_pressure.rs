//! Pressure in holes: its forces and tangents, rings with known answers, steps that conserve, tyres and balloons in worlds.

mod common;
#[path = "inner_pressure/forces.rs"]
mod forces;
#[path = "inner_pressure/rings.rs"]
mod rings;
#[path = "inner_pressure/support.rs"]
mod support;
#[path = "inner_pressure/worlds.rs"]
mod worlds;
