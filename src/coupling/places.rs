//! Where colliders are: boxes swept over the step, and an order by place that no insertion changes.

use super::sets::RapierSets;
use crate::body::FlexBody;
use crate::math::{node_vec, rotation, to_rapier};
use crate::rapier::math::Real;
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

/// Where a body will be at the end of the step, as it is set: where its velocity and the user's force take it without turning, or where its user
/// sends it.
fn foreseen(body: &RigidBody, dt: Real) -> Pose {
    if body.body_type() == RigidBodyType::KinematicPositionBased {
        return *body.next_position();
    }
    let mut pose = *body.position();
    let gained = body.user_force() * body.mass_properties().effective_inv_mass * dt;
    // A force that is no number is refused by the name of its body, which is looked for where it is.
    let gained = if gained.is_finite() {
        gained
    } else {
        Vector::ZERO
    };
    pose.translation += (body.linvel() + gained) * dt;
    pose
}

/// Where to a body goes in the step (m).
pub(super) fn travel_vector(body: &RigidBody, dt: Real) -> Vector {
    foreseen(body, dt).translation - body.position().translation
}

/// How far a body goes in the step (m).
pub(super) fn travel_of(body: &RigidBody, dt: Real) -> Real {
    travel_vector(body, dt).length()
}

/// How far gravity takes a body in the step (m), from the velocity that it has.
fn fall_of(body: &RigidBody, sets: &RapierSets<'_>) -> Vector {
    if !body.is_dynamic() || body.is_sleeping() {
        return Vector::ZERO;
    }
    let dt = sets.integration_parameters.dt;
    sets.gravity * body.gravity_scale() * dt * dt
}

/// How far some point of a body goes in the step at most, by its turn and by gravity as well (m).
pub(super) fn reach_of(body: &RigidBody, sets: &RapierSets<'_>) -> Real {
    let dt = sets.integration_parameters.dt;
    let turn = turn_of(body, dt);
    let goes = (travel_vector(body, dt) + fall_of(body, sets)).length();
    if turn == 0.0 {
        return goes;
    }
    let own = body.colliders().iter();
    let swings = own
        .filter_map(|&handle| sets.colliders.get(handle))
        .map(|collider| {
            swing_of(
                body,
                &collider.shape().compute_aabb(&placed_on(body, collider)),
                turn,
            )
        });
    goes + swings.fold(0.0, Real::max)
}

/// How far a body turns in the step (rad).
fn turn_of(body: &RigidBody, dt: Real) -> Real {
    if body.body_type() == RigidBodyType::KinematicPositionBased {
        let (from, to) = (body.rotation(), body.next_position().rotation);
        return (to * from.inverse()).angle().abs();
    }
    body.angvel().abs() * dt
}

/// How far a turn moves what is in a box on a body at most (m): along a chord.
fn swing_of(body: &RigidBody, aabb: &Aabb, turn: Real) -> Real {
    let off = (aabb.center() - body.center_of_mass()).abs();
    turn.min(2.0) * (off + aabb.half_extents()).length()
}

/// Box of a collider from where it is to where its body will be.
pub(super) fn swept_box(sets: &RapierSets<'_>, collider: &Collider) -> Aabb {
    let skin = collider.contact_skin();
    let parent = collider.parent();
    let Some(body) = parent.and_then(|parent| sets.bodies.get(parent)) else {
        return loosened(collider.compute_aabb(), skin);
    };
    let aabb = collider.shape().compute_aabb(&placed_on(body, collider));
    let aabb = loosened(aabb, skin);
    if body.is_fixed() {
        return aabb;
    }
    let dt = sets.integration_parameters.dt;
    let mut to = foreseen(body, dt);
    to.translation += fall_of(body, sets);
    let swing = swing_of(body, &aabb, turn_of(body, dt));
    let offset = collider.position_wrt_parent().copied().unwrap_or_default();
    let moved = loosened(collider.shape().compute_aabb(&(to * offset)), skin);
    loosened(
        aabb.merged(&moved),
        swing + 0.01 * aabb.half_extents().length(),
    )
}

/// Box of a flexible body's surface from where it is to where its velocities and accelerations take it, and how far its
/// fastest node goes (m).
pub(super) fn swept_surface(body: &FlexBody, dt: f64) -> (Aabb, Real) {
    let (positions, velocities) = (body.positions(), body.velocities());
    let state = body.state();
    let turn = rotation(state.frame.angle);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut travel = 0.0f64;
    for &node in body.mesh().boundary().nodes() {
        let position = node_vec(positions, node);
        let shift = dt * node_vec(velocities, node);
        // Vibrations that the step does not resolve move a node by its acceleration.
        let own = turn * node_vec(&state.acceleration, node);
        let bent = shift + 0.5 * dt * dt * (state.frame.acceleration + own);
        travel = larger(larger(travel, shift.norm_squared()), bent.norm_squared());
        for axis in 0..2 {
            let least = smaller(0.0, smaller(shift[axis], bent[axis]));
            let most = larger(0.0, larger(shift[axis], bent[axis]));
            low[axis] = smaller(low[axis], position[axis] + least);
            high[axis] = larger(high[axis], position[axis] + most);
        }
    }
    let swept = Aabb::new(to_rapier(low.into()), to_rapier(high.into()));
    (swept, travel.sqrt() as Real)
}

/// The smaller of two finite numbers: one instruction, where `f64::min` looks for NaN.
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger of two finite numbers.
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
