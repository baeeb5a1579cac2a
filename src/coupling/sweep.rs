//! The sweep: what the boxes meet in which flexible bodies are looked for, and whether that needs rapier's detection step at all.
//!
//! A detection step of zero length is not free of traces: rapier keeps contacts that will close within the step, and in
//! a step without length none does, so bodies that collide far away would do so a little differently. Where flexible
//! bodies meet each other and fixed colliders only, all that a claim needs is known without it.

use super::changes::Changes;
use super::places::{loosened, placed_on, reach_of, swept_box};
use super::roster::{ClaimedFlex, Roster};
use super::sets::RapierSets;
use super::strikes::Strikes;
use crate::math::HashMap;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

/// What the swept boxes of the flexible bodies meet.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    /// By slot of the flexible body, in their order.
    hits: Vec<(usize, ColliderHandle)>,
    /// How far around its own way a collider may be driven that is struck (m).
    driven: HashMap<ColliderHandle, Real>,
    /// How far the fastest body goes in the step (m).
    farthest: Real,
    /// Changed colliders that are no surfaces: scratch.
    strangers: Vec<ColliderHandle>,
}

impl Sweep {
    /// What the box of a flexible body meets.
    pub fn hits_of(&self, slot: usize) -> impl Iterator<Item = ColliderHandle> + '_ {
        let first = self.hits.partition_point(|(index, _)| *index < slot);
        let own = self.hits[first..].iter();
        own.take_while(move |(index, _)| *index == slot)
            .map(|&(_, handle)| handle)
    }

    /// How far around its own way a collider may be driven that is struck (m).
    pub fn driven(&self, collider: ColliderHandle) -> Real {
        self.driven.get(&collider).copied().unwrap_or(0.0)
    }

    /// How far the fastest body goes in the step (m).
    pub fn farthest(&self) -> Real {
        self.farthest
    }

    /// Finds what the swept boxes meet, with rapier's tree, after the detection step has taken over the user's changes.
    pub fn all(
        &mut self,
        sets: &RapierSets<'_>,
        flex: &Roster,
        changes: &Changes,
        strikes: &mut Strikes,
    ) {
        self.hits.clear();
        self.farthest = farthest_travel(sets, flex);
        let dispatcher = sets.narrow_phase.query_dispatcher();
        let query = sets.broad_phase.as_query_pipeline(
            dispatcher,
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        let hits = &mut self.hits;
        for (index, own) in flex.iter().enumerate() {
            let near = loosened(own.swept, self.farthest);
            let mut meets_itself = false;
            let mut visit = |handle: ColliderHandle, collider: &Collider| {
                let other = match flex.slot_of(handle) {
                    Some(other) => flex[other].swept,
                    None => swept_box(sets, collider),
                };
                if handle != own.collider && other.intersects(&own.swept) {
                    hits.push((index, handle));
                }
            };
            for (handle, collider) in query.intersect_aabb_conservative(near) {
                meets_itself |= handle == own.collider;
                visit(handle, collider);
            }
            // A detection step may leave the tree empty: then all colliders are asked.
            if !meets_itself {
                sets.colliders
                    .iter()
                    .for_each(|(handle, collider)| visit(handle, collider));
            }
        }
        self.meet_struck(sets, flex, changes, strikes);
        self.hits.sort_unstable_by_key(|(index, _)| *index);
    }

    /// Meets the swept boxes of the flexible bodies with what is around them; returns whether anything was met of which only a
    /// detection step can tell more.
    ///
    /// Rapier's tree does not know what the user has inserted or moved since the last step, and a body that is awake goes where the
    /// tree does not have it: these are asked by themselves.
    pub fn needs_detection(
        &mut self,
        sets: &RapierSets<'_>,
        flex: &Roster,
        changes: &Changes,
        strikes: &mut Strikes,
    ) -> bool {
        self.hits.clear();
        // Surfaces are marked in every step, by ourselves.
        self.strangers.clear();
        let changed = changes.colliders().iter().copied();
        self.strangers
            .extend(changed.filter(|&handle| !flex.is_surface(handle)));
        let needs = meets_unsettled(sets, flex, changes)
            || self.meets_settled(sets, flex)
            || self.meet_struck(sets, flex, changes, strikes);
        if !needs {
            self.meet_each_other(flex);
            self.hits.sort_unstable_by_key(|(index, _)| *index);
        }
        needs
    }

    /// Lists what rapier's tree has near the flexible bodies; returns whether that is more than fixed colliders.
    fn meets_settled(&mut self, sets: &RapierSets<'_>, flex: &Roster) -> bool {
        let query = sets.broad_phase.as_query_pipeline(
            sets.narrow_phase.query_dispatcher(),
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        let hits = &mut self.hits;
        for (index, own) in flex.iter().enumerate() {
            let (mut meets_itself, mut needs) = (false, false);
            let mut visit = |handle: ColliderHandle, collider: &Collider| {
                if !flex.is_surface(handle) && swept_box(sets, collider).intersects(&own.swept) {
                    needs |= !is_fixed_and_settled(sets, collider);
                    hits.push((index, handle));
                }
            };
            for (handle, collider) in query.intersect_aabb_conservative(own.swept) {
                meets_itself |= handle == own.collider;
                visit(handle, collider);
            }
            // The tree may be out, and does not know what was changed.
            if meets_itself {
                let changed = self.strangers.iter();
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

    /// Adds to what the swept boxes meet what may be driven into them; returns whether there is any.
    fn meet_struck(
        &mut self,
        sets: &RapierSets<'_>,
        flex: &Roster,
        changes: &Changes,
        strikes: &mut Strikes,
    ) -> bool {
        self.driven.clear();
        if flex.len() == 0 {
            return false;
        }
        let n_met = self.hits.len();
        let boxes = flex.iter().map(|own| own.swept);
        strikes.meet(sets, (flex, changes), boxes, |slot, handle, reach| {
            self.hits.push((slot, handle));
            self.driven.insert(handle, reach);
        });
        self.hits.len() > n_met
    }

    /// Meets flexible bodies with each other; they are in the order of their left ends.
    fn meet_each_other(&mut self, flex: &Roster) {
        for (index, one) in flex.iter().enumerate() {
            for other in flex.iter().skip(index + 1) {
                if other.swept.mins.x > one.swept.maxs.x {
                    break;
                }
                if one.swept.intersects(&other.swept) {
                    self.hits.push((index, other.collider));
                }
            }
        }
    }
}

/// Whether a flexible body meets something that moves or was changed.
fn meets_unsettled(sets: &RapierSets<'_>, flex: &Roster, changes: &Changes) -> bool {
    let boxes = flex.iter().map(|flex| flex.swept);
    let Some(around) = boxes.reduce(|one, other| one.merged(&other)) else {
        return false;
    };
    changes.unsettled(sets).any(|(handle, collider)| {
        if flex.is_surface(handle) {
            return false;
        }
        let swept = swept_box(sets, collider);
        // A box that is no number may be anywhere, and rapier must take it out first.
        let is_somewhere = swept.mins.is_finite() && swept.maxs.is_finite();
        let meets = |own: &ClaimedFlex| swept.intersects(&own.swept);
        !is_somewhere
            || (swept.intersects(&around)
                && !is_fixed_and_settled(sets, collider)
                && flex.iter().any(meets))
    })
}

/// How far the fastest body that is awake goes in the step (m), after the detection step.
pub(super) fn farthest_travel(sets: &RapierSets<'_>, flex: &Roster) -> Real {
    let awake = sets.islands.active_bodies();
    awake
        .filter_map(|handle| sets.bodies.get(handle))
        .filter(|body| !body.is_fixed() && !body.is_sleeping())
        .map(|body| reach_of(body, sets))
        .chain(flex.iter().map(|flex| flex.travel))
        .fold(0.0, Real::max)
}

/// Whether a collider stays where it is, and rapier knows it: the user may have moved or disabled its body.
pub(super) fn is_fixed_and_settled(sets: &RapierSets<'_>, collider: &Collider) -> bool {
    let Some(body) = collider.parent().and_then(|parent| sets.bodies.get(parent)) else {
        return true;
    };
    let is_placed = *collider.position() == placed_on(body, collider);
    body.is_fixed() && is_placed && (body.is_enabled() || !collider.is_enabled())
}
