//! The committed motion of a body: what a snapshot saves.

/// The committed motion of a flexible body, interleaved per node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlexState {
    /// Positions (m).
    pub position: Vec<f64>,
    /// Velocities (m/s).
    pub velocity: Vec<f64>,
    /// Accelerations without hard contact forces (m/s²).
    pub acceleration: Vec<f64>,
    /// Angle of the co-rotating frame (rad).
    pub angle: f64,
}

