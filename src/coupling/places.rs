//! Where colliders are: boxes swept over the step, and an order by place that no insertion changes.

use super::sets::RapierSets;
use crate::rapier::math::{Real, Vector};
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;
use std::cmp::Ordering;

/// Order of two colliders by their places, which neither handles nor rapier's graphs change; by handle at the same place.
pub(super) fn order_of_colliders(
    sets: &RapierSets<'_>,
    one: ColliderHandle,
    other: ColliderHandle,
) -> Ordering {
    let place = |handle| {
        let collider: &Collider = sets.colliders.get(handle)?;
        let pose = collider.position();
        Some([pose.translation.x, pose.translation.y, pose.rotation.re])
    };
    order_of_numbers(
        &place(one).unwrap_or_default(),
        &place(other).unwrap_or_default(),
    )
    .then_with(|| one.into_raw_parts().cmp(&other.into_raw_parts()))
}

/// Order of two rigid bodies by their places.
pub(super) fn order_of_bodies(
    sets: &RapierSets<'_>,
    one: RigidBodyHandle,
    other: RigidBodyHandle,
) -> Ordering {
    let place = |handle| {
        let pose = sets.bodies.get(handle)?.position();
        Some([pose.translation.x, pose.translation.y, pose.rotation.re])
    };
    order_of_numbers(
        &place(one).unwrap_or_default(),
        &place(other).unwrap_or_default(),
    )
    .then_with(|| one.into_raw_parts().cmp(&other.into_raw_parts()))
}

pub(super) fn order_of_boxes(one: &Aabb, other: &Aabb) -> Ordering {
    let corners = |aabb: &Aabb| [aabb.mins.x, aabb.mins.y, aabb.maxs.x, aabb.maxs.y];
    order_of_numbers(&corners(one), &corners(other))
}

/// Lexicographic order.
fn order_of_numbers(one: &[Real], other: &[Real]) -> Ordering {
    let pairs = one.iter().zip(other);
    pairs
        .map(|(a, b)| a.total_cmp(b))
        .find(|order| order.is_ne())
        .unwrap_or(Ordering::Equal)
}

/// A box grown by a margin; one that is no number counts as none.
pub(super) fn loosened(aabb: Aabb, margin: Real) -> Aabb {
    aabb.loosened(margin.max(0.0))
}

/// Pose of a collider on its body, up to date even where the user has moved the body since the last step.
pub(super) fn placed_on(body: &RigidBody, collider: &Collider) -> Pose {
    let offset = collider.position_wrt_parent().copied().unwrap_or_default();
    *body.position() * offset
}

/// Box of a collider from where it is to where its velocity takes it.
pub(super) fn swept_box(bodies: &RigidBodySet, collider: &Collider, dt: Real) -> Aabb {
    let skin = collider.contact_skin();
    let Some(body) = collider.parent().and_then(|parent| bodies.get(parent)) else {
        return loosened(collider.compute_aabb(), skin);
    };
    let aabb = collider.shape().compute_aabb(&placed_on(body, collider));
    let aabb = loosened(aabb, skin);
    if body.is_fixed() {
        return aabb;
    }
    let extents = aabb.half_extents();
    let turn = (body.angvel().abs() * dt).min(1.0) * extents.length();
    let shift: Vector = body.linvel() * dt;
    let moved = Aabb::new(aabb.mins + shift, aabb.maxs + shift);
    loosened(aabb.merged(&moved), turn + 0.01 * extents.length())
}
