//! Waking: sleepers that something awake may meet in the step wake before they touch.

use super::changes::Changes;
use super::places::{loosened, swept_box};
use super::roster::Roster;
use super::sets::RapierSets;
use super::sleep::reaches;
use super::strikes::Strikes;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// Wakes sleepers that something awake may meet in the step; returns whether one woke, so that the look-ahead has to begin anew.
///
/// - `excess`: by how much the boxes have grown in this step (m).
pub(super) fn wake_met(
    sets: &mut RapierSets<'_>,
    flex: &Roster,
    changes: &Changes,
    strikes: &mut Strikes,
    excess: Real,
) -> bool {
    if flex.asleep().is_empty() {
        return false;
    }
    let dt = sets.integration_parameters.dt;
    let fall = sets.gravity.length() * dt * dt;
    let margin = sets.integration_parameters.prediction_distance() + fall;
    let (mut woken, mut beside) = (Vec::new(), Vec::new());
    for one in flex {
        let list = match one.rests {
            true => &mut beside,
            false => &mut woken,
        };
        list_met(flex, sets, &loosened(one.swept, margin), list);
    }
    for (handle, collider) in changes.unsettled(sets) {
        if is_awake(sets, collider) && flex.slot_of(handle).is_none() {
            let swept = swept_box(sets, collider);
            let list = match has_come_to_rest(sets, collider) {
                true => &mut beside,
                false => &mut woken,
            };
            list_met(flex, sets, &loosened(swept, margin + excess), list);
        }
    }
    let surfaces = flex.asleep().iter().map(|sleeper| sleeper.surface);
    strikes.meet(sets, (flex, changes), surfaces, |slot, struck, _| {
        let carrier = flex.asleep()[slot].carrier;
        let collider = sets.colliders.get(struck);
        let list = match collider.is_some_and(|collider| has_come_to_rest(sets, collider)) {
            true => &mut beside,
            false => &mut woken,
        };
        if !list.contains(&carrier) {
            list.push(carrier);
        }
    });
    let has_woken = wake_carriers(sets, &woken);
    beside.retain(|&carrier| sets.bodies.get(carrier).is_some_and(RigidBody::is_sleeping));
    wake_for_now(sets, &beside) || has_woken
}

/// Wakes the bodies of surfaces that what is claimed touches; returns whether one woke.
pub(super) fn wake_surfaces(sets: &mut RapierSets<'_>, surfaces: &[ColliderHandle]) -> bool {
    let carriers = surfaces.iter().filter_map(|&surface| {
        let collider = sets.colliders.get(surface);
        collider.and_then(Collider::parent)
    });
    let carriers: Vec<_> = carriers.collect();
    wake_for_now(sets, &carriers)
}

/// Wakes bodies beside others that may have come to rest; returns whether one woke. They sleep on as soon as they may, or each would wake the other
/// for ever, asleep in turns.
fn wake_for_now(sets: &mut RapierSets<'_>, carriers: &[RigidBodyHandle]) -> bool {
    let mut has_woken = false;
    if !carriers.is_empty() {
        keep_timers(sets, |sets| has_woken = wake_carriers(sets, carriers));
    }
    has_woken
}

/// Lets all whom a call wakes sleep on as soon as they may: rapier wakes whole islands, for the time until sleep at least. Whoever moves has his time
/// reset after the solve.
pub(super) fn keep_timers(sets: &mut RapierSets<'_>, wake: impl FnOnce(&mut RapierSets<'_>)) {
    let asleep = sets.bodies.iter().filter(|(_, body)| body.is_sleeping());
    let timers: Vec<_> = asleep
        .map(|(handle, body)| (handle, body.activation().time_since_can_sleep))
        .collect();
    wake(sets);
    for (handle, timer) in timers {
        if let Some(body) = sets.bodies.get_mut(handle)
            && !body.is_sleeping()
        {
            body.activation_mut().time_since_can_sleep = timer;
        }
    }
}

fn wake_carriers(sets: &mut RapierSets<'_>, carriers: &[RigidBodyHandle]) -> bool {
    let mut has_woken = false;
    for &carrier in carriers {
        sets.islands.wake_up(sets.bodies, carrier, true);
        // Rapier wakes no body that the user has made a fixed one.
        has_woken |= sets
            .bodies
            .get(carrier)
            .is_some_and(|body| !body.is_sleeping());
    }
    has_woken
}

/// Lists the sleepers whose surface a box reaches.
fn list_met(flex: &Roster, sets: &RapierSets<'_>, near: &Aabb, woken: &mut Vec<RigidBodyHandle>) {
    for sleeper in flex.asleep() {
        if near.intersects(&sleeper.surface)
            && !woken.contains(&sleeper.carrier)
            && reaches(sets, sleeper.collider, near)
        {
            woken.push(sleeper.carrier);
        }
    }
}

/// Whether a collider's body is one that forces move and that has stayed where it is since the step before, at least.
fn has_come_to_rest(sets: &RapierSets<'_>, collider: &Collider) -> bool {
    let parent = collider.parent().and_then(|parent| sets.bodies.get(parent));
    parent.is_some_and(|body| body.is_dynamic() && body.activation().time_since_can_sleep > 0.0)
}

/// Whether a collider belongs to a body that may move.
fn is_awake(sets: &RapierSets<'_>, collider: &Collider) -> bool {
    let parent = collider.parent().and_then(|parent| sets.bodies.get(parent));
    collider.is_enabled()
        && !collider.is_sensor()
        && parent.is_some_and(|body| !body.is_fixed() && !body.is_sleeping())
}
