//! A rigid placement in the plane, `world = translation + R local` with `R = [[cos, -sin], [sin, cos]]`.

use crate::math::{Vec2, sin_cos};

/// Position and orientation of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose2 {
    /// World position of the local origin (m).
    pub translation: Vec2,
    /// Cosine of the angle.
    pub cos: f64,
    /// Sine of the angle.
    pub sin: f64,
}

impl Default for Pose2 {
    fn default() -> Self {
        Self::identity()
    }
}

impl Pose2 {
    /// A pose from the world position of the local origin (m) and an angle (rad).
    pub fn new(translation: Vec2, angle: f64) -> Self {
        let (sin, cos) = sin_cos(angle);
        Self {
            translation,
            cos,
            sin,
        }
    }

    /// The pose that leaves every point in place.
    pub fn identity() -> Self {
        Self {
            translation: Vec2::zeros(),
            cos: 1.0,
            sin: 0.0,
        }
    }

    /// World position of a local point.
    #[inline]
    pub fn transform(&self, point: Vec2) -> Vec2 {
        self.translation + self.rotate(point)
    }

    /// Local position of a world point.
    #[inline]
    pub fn inverse_transform(&self, point: Vec2) -> Vec2 {
        self.inverse_rotate(point - self.translation)
    }

    /// World components of a local vector.
    #[inline]
    pub fn rotate(&self, v: Vec2) -> Vec2 {
        Vec2::new(
            self.cos * v.x - self.sin * v.y,
            self.sin * v.x + self.cos * v.y,
        )
    }

    /// Local components of a world vector.
    #[inline]
    pub fn inverse_rotate(&self, v: Vec2) -> Vec2 {
        Vec2::new(
            self.cos * v.x + self.sin * v.y,
            self.cos * v.y - self.sin * v.x,
        )
    }

    /// What `local` is in the coordinates of this pose, in the world.
    #[inline]
    pub fn place(&self, local: &Self) -> Self {
        Self {
            translation: self.transform(local.translation),
            cos: self.cos * local.cos - self.sin * local.sin,
            sin: self.sin * local.cos + self.cos * local.sin,
        }
    }

    /// This pose as seen from `base`: maps local points of `self` to local points of `base`.
    #[inline]
    pub fn relative_to(&self, base: &Self) -> Self {
        Self {
            translation: base.inverse_transform(self.translation),
            cos: base.cos * self.cos + base.sin * self.sin,
            sin: base.cos * self.sin - base.sin * self.cos,
        }
    }
}
