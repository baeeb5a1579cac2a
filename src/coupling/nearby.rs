//! Whether a step needs rapier's detection step at all.
//!
//! A detection step of zero length is not free of traces: rapier keeps contacts that will close within the step, and in
//! a step without length none does, so bodies that collide far away would do so a little differently. Where flexible
//! bodies meet each other and fixed colliders only, all that a claim needs is known without it.

use super::claim::Claims;
use super::places::{loosened, placed_on, swept_box};
use super::sets::RapierSets;
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

impl Claims {
    /// Meets all colliders with the swept boxes of the flexible bodies; returns whether anything was met of which only a
    /// detection step can tell more.
    ///
    /// Rapier's tree does not know what the user has inserted or moved since the last step, so every collider is asked.
    pub fn needs_detection(&mut self, sets: &RapierSets<'_>) -> bool {
        self.swept_hits.clear();
        let boxes = self.flex.iter().map(|flex| flex.swept);
        let Some(around) = boxes.reduce(|one, other| one.merged(&other)) else {
            return false;
        };
        let dt = sets.integration_parameters.dt;
        for (handle, collider) in sets.colliders.iter() {
            if self.is_surface(handle) {
                continue;
            }
            let swept = swept_box(sets.bodies, collider, dt);
            // A box that is no number may be anywhere, and rapier must take it out first.
            if !(swept.mins.is_finite() && swept.maxs.is_finite()) {
                return true;
            }
            if !swept.intersects(&around) {
                continue;
            }
            for (index, flex) in self.flex.iter().enumerate() {
                if swept.intersects(&flex.swept) {
                    if !is_fixed_and_settled(sets, collider) {
                        return true;
                    }
                    self.swept_hits.push((index, handle));
                }
            }
        }
        self.meet_each_other();
        self.swept_hits.sort_unstable_by_key(|(index, _)| *index);
        false
    }

    /// Adds to the neighbours of a claimed collider what it will reach within the step: rapier lists a pair only when the boxes
    /// nearly touch, and bodies of a few metres a second then are in each other at its end.
    pub(super) fn look_around(
        &mut self,
        sets: &RapierSets<'_>,
        body: RigidBodyHandle,
        own: ColliderHandle,
    ) {
        let (Some(collider), Some(body)) = (sets.colliders.get(own), sets.bodies.get(body)) else {
            return;
        };
        let dt = sets.integration_parameters.dt;
        let travel = body.linvel().length() * dt;
        let swept = swept_box(sets.bodies, collider, dt);
        if travel + self.farthest <= sets.integration_parameters.prediction_distance() {
            return;
        }
        let mut meets_itself = false;
        let (flex_of_collider, asleep) = (&self.flex_of_collider, &self.asleep);
        let neighbours = &mut self.neighbours;
        let mut visit = |handle: ColliderHandle, other: &Collider| {
            let is_surface = flex_of_collider.contains_key(&handle)
                || asleep.iter().any(|sleeper| sleeper.collider == handle);
            if handle != own
                && !is_surface
                && other.parent() != collider.parent()
                && swept_box(sets.bodies, other, dt).intersects(&swept)
            {
                neighbours.push(handle);
            }
        };
        let query = sets.broad_phase.as_query_pipeline(
            sets.narrow_phase.query_dispatcher(),
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        let near = loosened(swept, self.farthest);
        for (handle, other) in query.intersect_aabb_conservative(near) {
            meets_itself |= handle == own;
            visit(handle, other);
        }
        // A detection step may leave the tree empty: then all colliders are asked.
        if !meets_itself {
            sets.colliders
                .iter()
                .for_each(|(handle, other)| visit(handle, other));
        }
    }

    /// Meets flexible bodies with each other.
    fn meet_each_other(&mut self) {
        for (index, one) in self.flex.iter().enumerate() {
            for other in &self.flex[index + 1..] {
                if one.swept.intersects(&other.swept) {
                    self.swept_hits.push((index, other.collider));
                }
            }
        }
    }
}

/// Whether a collider stays where it is, and rapier knows it: the user may have moved or disabled its body.
pub(super) fn is_fixed_and_settled(sets: &RapierSets<'_>, collider: &Collider) -> bool {
    let Some(body) = collider.parent().and_then(|parent| sets.bodies.get(parent)) else {
        return true;
    };
    let is_placed = *collider.position() == placed_on(body, collider);
    body.is_fixed() && is_placed && (body.is_enabled() || !collider.is_enabled())
}
