//! Points of contact as events tell of them.

use super::pair_name::{PairName, pair_name};
use crate::math::Vec2;
use crate::rapier::prelude::ColliderHandle;

/// A point at which two colliders press each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressedPoint {
    /// Collider of the point.
    pub contactor: ColliderHandle,
    /// Collider of the surface.
    pub target: ColliderHandle,
    /// Where (m).
    pub position: Vec2,
    /// Unit normal from the target to the contactor.
    pub normal: Vec2,
    /// Gap (m).
    pub gap: f64,
    /// Force on the contactor, along the normal and a quarter turn counter-clockwise from it (N).
    pub force: [f64; 2],
    /// Whether it is closed at the end of the step; an opened one may still have had a force.
    pub is_closed: bool,
    /// Whether rapier solved the pair in the last step, and found its force above the threshold.
    pub was_above: bool,
}

impl PressedPoint {
    /// Its pair.
    pub(super) fn name(&self) -> PairName {
        pair_name(self.contactor, self.target)
    }
}
