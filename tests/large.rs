//! Bodies of large deformation: forces and tangents, equilibria with known answers, steps that conserve, bodies that are crushed.

#[path = "large/dynamics.rs"]
mod dynamics;
#[path = "large/forces.rs"]
mod forces;
#[path = "../examples/verify/frame.rs"]
mod frame;
#[path = "large/locking.rs"]
mod locking;
#[path = "large/obstacles.rs"]
mod obstacles;
#[path = "large/paths.rs"]
mod paths;
#[path = "large/robustness.rs"]
mod robustness;
#[path = "large/smoothed.rs"]
mod smoothed;
#[path = "large/statics.rs"]
mod statics;
#[path = "large/stress.rs"]
mod stress;
#[path = "large/support.rs"]
mod support;
