//! Where a rigid body is and how fast it moves.

use crate::math::{Vec2, perp, rotation};

/// Position and velocity of a rigid body about its centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct RigidMotion {
    /// Centre of mass (m).
    pub centre: Vec2,
    /// Angle (rad).
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vec2,
    /// Angular velocity (rad/s).
    pub spin: f64,
}

impl RigidMotion {
    /// World position of the material point at `arm` (body axes, m).
    pub fn point(&self, arm: Vec2) -> Vec2 {
        self.centre + rotation(self.angle) * arm
    }

    /// World velocity of the material point at `arm` (body axes, m).
    pub fn point_velocity(&self, arm: Vec2) -> Vec2 {
        self.velocity + self.spin * perp(rotation(self.angle) * arm)
    }

    /// Moves the centre and turns (m, m, rad).
    pub(super) fn shift(&mut self, [x, y, turn]: [f64; 3]) {
        self.centre += Vec2::new(x, y);
        self.angle += turn;
    }

    /// `arm` (body axes, m) of a world point.
    pub fn arm(&self, point: Vec2) -> Vec2 {
        rotation(-self.angle) * (point - self.centre)
    }
}
