//! Sleep: what has come to rest sleeps with its island in rapier and is not solved; its motion and its contact forces wait.
//!
//! A carrier never moves, so rapier would let it sleep at once: its timer is set back while a node of the body moves. What
//! rapier wakes is awake here too. What is awake and comes near a sleeper wakes it before they touch: see [`super::waking`].

use super::landing::Landing;
use super::quarantine::is_out;
use super::sets::RapierSets;
use crate::body::{FlexBody, FlexBodySet, Rest, rest_way};
use crate::math::from_rapier;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::Aabb;
use crate::rapier::prelude::*;

/// Part of the time until sleep at which the timer of a body that moves is set back: not in every step, for rapier then looks at
/// the body again.
const SET_BACK: Real = 0.5;

/// A flexible body whose carrier sleeps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Sleeper {
    /// Slot in the set.
    pub index: u32,
    /// Its body in rapier.
    pub carrier: RigidBodyHandle,
    /// Its surface in rapier.
    pub collider: ColliderHandle,
    /// Box of its surface.
    pub surface: Aabb,
}

impl Sleeper {
    /// The sleeper that a body is, unless it is awake.
    pub fn new(index: u32, body: &FlexBody, sets: &RapierSets<'_>) -> Option<Self> {
        let collider = sets.colliders.get(body.collider_handle())?;
        body.is_sleeping(sets.bodies).then(|| Self {
            index,
            carrier: body.rigid_body_handle(),
            collider: body.collider_handle(),
            surface: collider.compute_aabb(),
        })
    }
}

impl FlexBody {
    /// Whether the body sleeps in the world of these bodies.
    pub fn is_sleeping(&self, bodies: &RigidBodySet) -> bool {
        let carrier = bodies.get(self.rigid_body_handle());
        carrier.is_some_and(RigidBody::is_sleeping)
    }
}

/// Wakes the bodies that the user changed; all of them if `all`.
pub(crate) fn wake_disturbed(sets: &mut RapierSets<'_>, flex_bodies: &mut FlexBodySet, all: bool) {
    for (_, body) in flex_bodies.iter_mut() {
        if is_out(body, sets.bodies) {
            body.be_new();
        }
        if !body.is_quarantined() && (body.is_disturbed() || all) {
            body.clear_disturbance();
            sets.islands
                .wake_up(sets.bodies, body.rigid_body_handle(), true);
        }
    }
}

/// Whether a box meets a segment of a surface.
pub(super) fn reaches(sets: &RapierSets<'_>, surface: ColliderHandle, other: &Aabb) -> bool {
    let shape = sets.colliders.get(surface).map(Collider::shape);
    let polyline = shape.and_then(|shape| shape.as_polyline());
    polyline.is_none_or(|polyline| polyline.bvh().intersect_aabb(other).next().is_some())
}

/// Keeps the carrier of a body awake while a node moves, or while it is restless: attached to something, of which rapier knows nothing, or in a
/// step that is not finished. To be called before rapier's step counts the time that it has been still.
pub(crate) fn keep_awake(
    body: &FlexBody,
    velocities: &[f64],
    is_restless: bool,
    sets: &mut RapierSets<'_>,
) {
    let handle = body.rigid_body_handle();
    let Some(carrier) = sets.bodies.get(handle) else {
        return;
    };
    let dt = sets.integration_parameters.dt;
    let activation = carrier.activation();
    let patience = activation.time_until_sleep;
    let is_due = activation.time_since_can_sleep + dt >= SET_BACK * patience;
    if activation.normalized_linear_threshold < 0.0 || !is_due {
        return;
    }
    if (is_restless || moves(body, velocities, patience, sets))
        && let Some(carrier) = sets.bodies.get_mut(handle)
    {
        // The step adds its length.
        carrier.activation_mut().time_since_can_sleep = -dt;
    }
}

/// Keeps a claimed rigid body awake that its solved step moves faster than rapier lets a body at rest, or whose step is not finished, or that is
/// attached to a flexible one.
/// Rapier counts how long a body has been still by the steps before, and would stop it in the step in which it is hit.
pub(crate) fn keep_landing_awake(
    landing: &Landing,
    is_attached: impl Fn() -> bool,
    sets: &mut RapierSets<'_>,
) {
    let RapierSets {
        bodies,
        colliders,
        integration_parameters: parameters,
        ..
    } = sets;
    let Some(body) = bodies.get(landing.handle) else {
        return;
    };
    let activation = body.activation();
    let (dt, patience) = (parameters.dt, activation.time_until_sleep);
    let is_due = activation.time_since_can_sleep + dt >= SET_BACK * patience;
    let threshold = activation.normalized_linear_threshold * parameters.length_unit;
    if threshold < 0.0 || !is_due {
        return;
    }
    let centre = body.center_of_mass();
    let reaches = body.colliders().iter().map(|&handle| {
        let shape = colliders.get(handle).map(Collider::compute_aabb);
        shape.map_or(0.0, |aabb| {
            (aabb.center() - centre).length() + aabb.half_extents().length()
        })
    });
    let extent = f64::from(reaches.fold(0.0, Real::max));
    let motion = &landing.motion;
    let speed = motion.velocity.norm() + motion.spin.abs() * extent;
    let moved = (motion.centre - from_rapier(centre)).norm();
    // As rapier judges: half of the way of the farthest point.
    let is_moving = 0.5 * speed.max(moved / f64::from(dt)) >= f64::from(threshold);
    if (is_moving || landing.is_unfinished || is_attached())
        && let Some(body) = bodies.get_mut(landing.handle)
    {
        // The step adds its length.
        body.activation_mut().time_since_can_sleep = -dt;
    }
}

/// Wakes the carrier of a body that moves, or is restless, all the same: surfaces that were written set its timer to zero, and a step may be longer
/// than the time until sleep.
pub(crate) fn wake_moving(
    body: &FlexBody,
    velocities: &[f64],
    is_restless: bool,
    sets: &mut RapierSets<'_>,
) {
    let handle = body.rigid_body_handle();
    let carrier = sets.bodies.get(handle);
    let Some(carrier) = carrier.filter(|carrier| carrier.is_sleeping()) else {
        return;
    };
    let patience = carrier.activation().time_until_sleep;
    if is_restless || moves(body, velocities, patience, sets) {
        sets.islands.wake_up(sets.bodies, handle, true);
    }
}

/// Whether a body that may sleep has come to rest, to some six digits.
pub(crate) fn rests(body: &FlexBody, sets: &RapierSets<'_>) -> bool {
    let carrier = sets.bodies.get(body.rigid_body_handle());
    carrier.is_some_and(|carrier| {
        let activation = carrier.activation();
        activation.normalized_linear_threshold >= 0.0
            && !moves(body, body.velocities(), activation.time_until_sleep, sets)
    })
}

/// Looks whether a body has stayed where it is in a step, after it.
pub(crate) fn look_whether_still(body: &mut FlexBody, sets: &RapierSets<'_>) {
    let carrier = sets.bodies.get(body.rigid_body_handle());
    let patience = carrier.map_or(1.0, |carrier| carrier.activation().time_until_sleep);
    let patience = f64::from(patience).max(f64::MIN_POSITIVE);
    let way = rest_way(size_of(body, sets));
    let dt = f64::from(sets.integration_parameters.dt);
    // Without loads, what would move it as far until it sleeps.
    let unbalance = match fastest(body.velocities()) * dt > way {
        true => 0.0,
        false => body.unbalance_at_rest(from_rapier(sets.gravity)) + way / patience / patience,
    };
    body.look_whether_still(Rest { dt, way, unbalance });
}

/// Whether a node was elsewhere within the last part of the time until sleep, or out of balance, or goes elsewhere within the step.
fn moves(body: &FlexBody, velocities: &[f64], patience: Real, sets: &RapierSets<'_>) -> bool {
    let dt = f64::from(sets.integration_parameters.dt);
    let leaves = fastest(velocities) * dt > rest_way(size_of(body, sets));
    leaves || body.time_still() < f64::from(SET_BACK * patience)
}

/// Speed of the fastest of some nodes (m/s).
fn fastest(velocities: &[f64]) -> f64 {
    let nodes = velocities.chunks_exact(2);
    let squared = nodes.map(|v| v[0] * v[0] + v[1] * v[1]);
    squared.fold(0.0, f64::max).sqrt()
}

/// The longer side of a body's box (m).
fn size_of(body: &FlexBody, sets: &RapierSets<'_>) -> f64 {
    let collider = sets.colliders.get(body.collider_handle());
    f64::from(collider.map_or(0.0, |collider| {
        collider.compute_aabb().extents().max_element()
    }))
}

/// Stops a body whose carrier has fallen asleep in rapier's step.
pub(crate) fn stop_if_asleep(body: &mut FlexBody, bodies: &RigidBodySet) {
    if body.is_sleeping(bodies) {
        body.stop();
    }
}
