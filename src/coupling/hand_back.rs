//! Handing back: rapier's own step carries claimed bodies to where the flexible stage put them.
//!
//! All axes are locked for that step, so neither contacts nor gravity act, and the velocity is the one that lands the
//! body on our result; then axes ([`super::loan`]) and true end velocities return.

use super::landing::Landing;
use super::masters::{Masters, cap_speed};
use super::placed::{Placed, pose_after};
use super::sets::RapierSets;
use super::waking::keep_timers;
use crate::math::{REAL_EPSILON, Vec2, atan2, from_rapier, tan, to_rapier, wrap_angle};
use crate::rapier::math::{Pose, Real, Rotation};
use crate::rapier::prelude::*;
use crate::system::RigidMotion;

/// Locks claimed bodies and gives them the velocity that lands them; the axes that were locked before are added to `axes`.
pub(super) fn hand_back(
    landings: &[Landing],
    axes: &mut Vec<(RigidBodyHandle, LockedAxes)>,
    sets: &mut RapierSets<'_>,
) {
    let dt = f64::from(sets.integration_parameters.dt);
    let iterations = sets.integration_parameters.num_solver_iterations;
    wake(landings, sets);
    for landing in landings {
        if is_link(landing, sets) {
            // Moved by its joints.
            continue;
        }
        let Some(body) = sets.bodies.get_mut(landing.handle) else {
            continue;
        };
        axes.push((landing.handle, body.locked_axes()));
        let n = (iterations + body.additional_solver_iterations()).max(1) as f64;
        let angle = atan2(f64::from(body.rotation().im), f64::from(body.rotation().re));
        let turned = wrap_angle(landing.motion.angle - angle);
        let moved = landing.motion.centre - from_rapier(body.center_of_mass());
        body.set_locked_axes(
            LockedAxes::TRANSLATION_LOCKED | LockedAxes::ROTATION_LOCKED,
            false,
        );
        body.set_linvel(to_rapier(moved / dt), false);
        // Rapier integrates a linearised rotation, `n` times per step.
        body.set_angvel((tan(turned / n) * n / dt) as Real, false);
    }
}

/// Wakes claimed bodies that sleep, those that move for good: rapier knows nothing of attachments and may find an attached body at rest alone. What
/// rests beside a body that is awake sleeps on as soon as it may.
fn wake(landings: &[Landing], sets: &mut RapierSets<'_>) {
    let is_sleeping = |bodies: &RigidBodySet, handle| {
        let body: Option<&RigidBody> = bodies.get(handle);
        body.is_some_and(RigidBody::is_sleeping)
    };
    let mut asleep = landings.iter().map(|landing| landing.handle);
    if !asleep.any(|handle| is_sleeping(sets.bodies, handle)) {
        return;
    }
    keep_timers(sets, |sets| {
        for landing in landings {
            if is_sleeping(sets.bodies, landing.handle) {
                sets.islands.wake_up(sets.bodies, landing.handle, true);
            }
        }
    });
}

/// Gives claimed bodies their end velocities after rapier's step.
///
/// Rapier's continuous collision detection sweeps every fast body along a straight way and stops it where nothing was solved. What `is_led`
/// along a feasible path passes through nothing, and is put where it was led to; of others rapier's pose counts. Links are put by their
/// coordinates, see [`super::lent_multibodies`].
pub(super) fn land(landings: &[Landing], is_led: bool, sets: &mut RapierSets<'_>) {
    for landing in landings {
        if is_led && !is_link(landing, sets) {
            put_where_led(landing, sets);
        }
        let end = end_of(landing, sets);
        if let (Some(motion), Some(body)) = (end, sets.bodies.get_mut(landing.handle)) {
            body.set_linvel(to_rapier(motion.velocity), false);
            body.set_angvel(motion.spin as Real, false);
        }
    }
}

/// Keeps the motions of landed bodies in `f64`.
pub(super) fn keep(landings: &[Landing], sets: &RapierSets<'_>, masters: &mut Masters) {
    for landing in landings {
        let end = end_of(landing, sets);
        if let (Some(motion), Some(body)) = (end, sets.bodies.get(landing.handle)) {
            let missed = from_rapier(body.center_of_mass()) - motion.centre;
            if missed.norm() <= LANDING_TOLERANCE * (1.0 + motion.centre.norm()) {
                let placed = Placed::of(landing.handle, body, sets.multibody_joints);
                masters.keep(landing, motion, placed);
            }
        }
    }
    masters.turn_over(sets.bodies);
}

fn is_link(landing: &Landing, sets: &RapierSets<'_>) -> bool {
    let link = sets.multibody_joints.rigid_body_link(landing.handle);
    link.is_some()
}

/// The motion that a body is left with: none if rapier has put it to sleep, and no faster than rapier lets it be.
fn end_of(landing: &Landing, sets: &RapierSets<'_>) -> Option<RigidMotion> {
    let mut motion = landing.motion;
    let body = sets.bodies.get(landing.handle)?;
    if body.is_sleeping() {
        (motion.velocity, motion.spin) = (Vec2::zeros(), 0.0);
    }
    if !is_link(landing, sets) {
        cap_speed(&mut motion, body, sets.integration_parameters);
    }
    Some(motion)
}

/// Pose of a body where it was led to.
pub(super) fn end_pose(body: &RigidBody, landing: &Landing) -> Pose {
    let pose = pose_after(body, &landing.motion);
    let rotation = Rotation {
        re: pose.cos as Real,
        im: pose.sin as Real,
    };
    Pose::from_parts(to_rapier(pose.translation), rotation)
}

/// Puts a body where it was led to, if rapier has stopped it on the way.
fn put_where_led(landing: &Landing, sets: &mut RapierSets<'_>) {
    let Some(body) = sets.bodies.get(landing.handle) else {
        return;
    };
    let motion = &landing.motion;
    let angle = atan2(f64::from(body.rotation().im), f64::from(body.rotation().re));
    let missed = from_rapier(body.center_of_mass()) - motion.centre;
    let rounding = LANDED * REAL_EPSILON;
    let is_there = missed.norm() <= rounding * (1.0 + motion.centre.norm())
        && wrap_angle(motion.angle - angle).abs() <= rounding;
    // What rapier has just put to sleep stays where it is.
    if is_there || !body.is_enabled() || body.is_sleeping() {
        return;
    }
    let pose = end_pose(body, landing);
    put(landing.handle, pose, sets);
}

/// Puts a body, and its colliders, where rapier has not.
pub(super) fn put(handle: RigidBodyHandle, pose: Pose, sets: &mut RapierSets<'_>) {
    let Some(body) = sets.bodies.get_mut(handle) else {
        return;
    };
    body.set_position(pose, false);
    for &handle in body.colliders() {
        let Some(collider) = sets.colliders.get_mut(handle) else {
            continue;
        };
        if let Some(own) = collider.position_wrt_parent() {
            collider.set_position(pose * own);
            sets.broad_phase
                .set_aabb(sets.integration_parameters, handle, collider.compute_aabb());
        }
    }
}

/// Roundings by which a landing may miss: of rapier's substeps.
pub(super) const LANDED: f64 = 64.0;

/// A landing this exact, relative to the distance from the origin, is rapier's rounding and no clamp.
const LANDING_TOLERANCE: f64 = 1e-4;
