//! Fast bodies: whatever hits, at whatever speed, stays on its side.

#[path = "common/mod.rs"]
mod common;
#[path = "fast/crossing.rs"]
mod crossing;
#[path = "fast/falls.rs"]
mod falls;
#[path = "fast/range.rs"]
mod range;
#[path = "fast/shots.rs"]
mod shots;
