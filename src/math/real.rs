//! The only place where rapier's `Real` and our `f64` meet.

use super::Vec2;
use crate::rapier::math::{Real, Vector};

/// A vector of rapier's, in `f64`.
#[inline]
pub fn from_rapier(v: Vector) -> Vec2 {
    Vec2::new(f64::from(v.x), f64::from(v.y))
}

/// A vector of ours, rounded to rapier's precision.
#[inline]
pub fn to_rapier(v: Vec2) -> Vector {
    Vector::new(v.x as Real, v.y as Real)
}

/// Whether a number is finite and not beyond use: rapier's `f32` holds its square, and in `f64` its products with forces
/// stay finite.
#[inline]
pub fn is_held(value: f64) -> bool {
    value.abs() <= 1e18
}

/// Whether all numbers are held; looks at every one of them, which is faster than to stop at the first that is not.
#[inline]
pub fn are_held(values: &[f64]) -> bool {
    values.iter().fold(true, |all, &value| all & is_held(value))
}

/// Spacing of rapier's numbers at one.
pub const REAL_EPSILON: f64 = Real::EPSILON as f64;
