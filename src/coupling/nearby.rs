//! Whether a step needs rapier's detection step at all.
//!
//! A detection step of zero length is not free of traces: rapier keeps contacts that will close within the step, and in
//! a step without length none does, so bodies that collide far away would do so a little differently. Where flexible
//! bodies meet each other and fixed colliders only, all that a claim needs is known without it.

use super::claim::{ClaimedFlex, Claims};
use super::places::{loosened, placed_on, swept_box, travel_of};
use super::sets::RapierSets;
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

impl Claims {
    /// Meets the swept boxes of the flexible bodies with what is around them; returns whether anything was met of which only a
    /// detection step can tell more.
    ///
    /// Rapier's tree does not know what the user has inserted or moved since the last step, and a body that is awake goes where the
    /// tree does not have it: these are asked by themselves.
    pub fn needs_detection(&mut self, sets: &RapierSets<'_>) -> bool {
        let mut hits = std::mem::take(&mut self.swept_hits);
        hits.clear();
        // Surfaces are marked in every step, by ourselves.
        let mut strangers = std::mem::take(&mut self.changes.strangers);
        strangers.clear();
        let changed = self.changes.colliders.iter().copied();
        strangers.extend(changed.filter(|&handle| !self.is_surface(handle)));
        self.changes.strangers = strangers;
        let needs = self.meets_unsettled(sets) || self.meets_settled(sets, &mut hits);
        self.swept_hits = hits;
        let needs = needs || self.meet_struck(sets);
        if !needs {
            self.meet_each_other();
            self.swept_hits.sort_unstable_by_key(|(index, _)| *index);
        }
        needs
    }

    /// Whether a flexible body meets something that moves or was changed.
    fn meets_unsettled(&self, sets: &RapierSets<'_>) -> bool {
        let boxes = self.flex.iter().map(|flex| flex.swept);
        let Some(around) = boxes.reduce(|one, other| one.merged(&other)) else {
            return false;
        };
        let dt = sets.integration_parameters.dt;
        self.unsettled(sets).any(|(handle, collider)| {
            if self.is_surface(handle) {
                return false;
            }
            let swept = swept_box(sets.bodies, collider, dt);
            // A box that is no number may be anywhere, and rapier must take it out first.
            let is_somewhere = swept.mins.is_finite() && swept.maxs.is_finite();
            let meets = |flex: &ClaimedFlex| swept.intersects(&flex.swept);
            !is_somewhere
                || (swept.intersects(&around)
                    && !is_fixed_and_settled(sets, collider)
                    && self.flex.iter().any(meets))
        })
    }

    /// Lists what rapier's tree has near the flexible bodies; returns whether that is more than fixed colliders.
    fn meets_settled(
        &self,
        sets: &RapierSets<'_>,
        hits: &mut Vec<(usize, ColliderHandle)>,
    ) -> bool {
        let dt = sets.integration_parameters.dt;
        let query = sets.broad_phase.as_query_pipeline(
            sets.narrow_phase.query_dispatcher(),
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        for (index, flex) in self.flex.iter().enumerate() {
            let (mut meets_itself, mut needs) = (false, false);
            let mut visit = |handle: ColliderHandle, collider: &Collider| {
                if !self.is_surface(handle)
                    && swept_box(sets.bodies, collider, dt).intersects(&flex.swept)
                {
                    needs |= !is_fixed_and_settled(sets, collider);
                    hits.push((index, handle));
                }
            };
            for (handle, collider) in query.intersect_aabb_conservative(flex.swept) {
                meets_itself |= handle == flex.collider;
                visit(handle, collider);
            }
            // The tree may be out, and does not know what was changed.
            if meets_itself {
                let changed = self.changes.strangers.iter();
                changed
                    .filter_map(|&handle| Some((handle, sets.colliders.get(handle)?)))
                    .for_each(|(handle, collider)| visit(handle, collider));
            } else {
                sets.colliders
                    .iter()
                    .for_each(|(handle, collider)| visit(handle, collider));
            }
            if needs {
                return true;
            }
        }
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
        let travel = travel_of(body, dt);
        let swept = loosened(swept_box(sets.bodies, collider, dt), self.excess);
        if travel + self.farthest + self.excess <= sets.integration_parameters.prediction_distance()
        {
            return;
        }
        let mut meets_itself = false;
        let (flex_of_collider, sleeping) = (&self.flex_of_collider, &self.sleeping_surfaces);
        let neighbours = &mut self.neighbours;
        let mut visit = |handle: ColliderHandle, other: &Collider| {
            let is_surface = flex_of_collider.contains_key(&handle) || sleeping.contains(&handle);
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

    /// Meets flexible bodies with each other; they are in the order of their left ends.
    fn meet_each_other(&mut self) {
        for (index, one) in self.flex.iter().enumerate() {
            for other in &self.flex[index + 1..] {
                if other.swept.mins.x > one.swept.maxs.x {
                    break;
                }
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
