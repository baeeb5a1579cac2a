//! What is written of a run is what the library says of it.

#[path = "results/grid.rs"]
mod grid;
#[path = "results/replay.rs"]
mod replay;
#[path = "results/vtu.rs"]
mod vtu;
