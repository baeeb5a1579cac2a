//! A rigid motion over a step.

use crate::math::{Vec2, perp, rotation};

/// Where a rigid motion leads in a step, and how fast it goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidWay {
    /// Where it is measured at the beginning of the step (m).
    pub about: Vec2,
    /// How far that goes (m).
    pub shift: Vec2,
    /// Turn (rad).
    pub turn: f64,
    /// Velocity at the end, there (m/s).
    pub velocity: Vec2,
    /// Spin at the end (rad/s).
    pub spin: f64,
    /// Acceleration (m/s²).
    pub acceleration: Vec2,
}

impl RigidWay {
    /// Where a point ends (m).
    pub fn end(&self, point: Vec2) -> Vec2 {
        self.about + self.shift + rotation(self.turn) * (point - self.about)
    }

    /// Velocity at a point at the end (m/s).
    pub fn velocity_at(&self, end: Vec2) -> Vec2 {
        self.velocity + self.spin * perp(end - self.about - self.shift)
    }
}
