//! Small vectors and the border between our `f64` and rapier's `Real`.

use nalgebra::{Matrix2, Vector2};

/// A point or vector in the plane.
pub type Vec2 = Vector2<f64>;

/// A 2×2 matrix.
pub type Mat2 = Matrix2<f64>;

/// `v` turned by a right angle counter-clockwise, `J v = (-v_y, v_x)`.
#[inline]
pub fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// The third component of the cross product, `a_x b_y - a_y b_x`.
#[inline]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The angle from one vector to another, counter-clockwise, in (-π, π] (rad).
#[inline]
pub fn angle_between(from: Vec2, to: Vec2) -> f64 {
    atan2(cross(from, to), from.dot(&to))
}

/// The rotation matrix of an angle (rad).
#[inline]
pub fn rotation(angle: f64) -> Mat2 {
    let (sin, cos) = sin_cos(angle);
    Mat2::new(cos, -sin, sin, cos)
}

/// The equivalent angle in [-π, π] (rad).
pub fn wrap_angle(angle: f64) -> f64 {
    let turns = (angle / std::f64::consts::TAU).round();
    angle - turns * std::f64::consts::TAU
}

/// The two entries of node `node` in an interleaved dof vector.
///
/// # Panics
/// If `dofs.len() < 2 * node + 2`.
#[inline]
pub fn node_vec(dofs: &[f64], node: usize) -> Vec2 {
    Vec2::new(dofs[2 * node], dofs[2 * node + 1])
}

/// Overwrites the two entries of node `node` in an interleaved dof vector.
///
/// # Panics
/// If `dofs.len() < 2 * node + 2`.
#[inline]
pub fn set_node_vec(dofs: &mut [f64], node: usize, value: Vec2) {
    dofs[2 * node] = value.x;
    dofs[2 * node + 1] = value.y;
}

/// Adds to the two entries of node `node` in an interleaved dof vector.
///
/// # Panics
/// If `dofs.len() < 2 * node + 2`.
#[inline]
pub fn add_node_vec(dofs: &mut [f64], node: usize, value: Vec2) {
    dofs[2 * node] += value.x;
    dofs[2 * node + 1] += value.y;
}

mod elementary;
mod hashed;
pub(crate) mod judged;
mod mix;
#[cfg(feature = "serde-serialize")]
pub(crate) mod ordered;
mod real;
pub(crate) mod rounding;
mod sum;
mod wide;

pub use elementary::{atan, atan2, cos, exp, exp_m1, hypot, ln, ln_1p, sin, sin_cos, tan};
pub(crate) use hashed::{HashMap, HashSet};
pub use mix::mix;
pub use real::{REAL_EPSILON, are_held, from_rapier, is_held, to_rapier};
pub use sum::{sum_over, sum_over_dofs};
pub(crate) use wide::{LANES, Number, Wide};
