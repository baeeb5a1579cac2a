//! Sensors that are left in rapier's step without length: the user hears of it when the full step agrees.

use super::events::{EventBook, EventGate, lock, name_of};
use super::pair_name::PairName;
use super::sets::RapierSets;
use crate::rapier::prelude::*;

impl EventBook {
    /// Tells which sensors have been left.
    pub(super) fn tell_left(&mut self, sets: &RapierSets<'_>) {
        let mut left = std::mem::take(&mut lock(&self.heard).left);
        for (index, first) in left.iter().enumerate() {
            let same = |event: &&CollisionEvent| name_of(event) == name_of(first);
            let is_first = !left[..index].iter().any(|event| same(&event));
            let last = left[index..].iter().rev().find(same).unwrap_or(first);
            if is_first && last.stopped() {
                let user = sets.events;
                user.handle_collision_event(sets.bodies, sets.colliders, *first, None);
            }
        }
        left.clear();
        lock(&self.heard).left = left;
    }
}

impl EventGate<'_> {
    /// Holds back that a sensor is left in the step without length, and whatever the full step says of the pair then: with the pair
    /// gone, rapier takes the last bit of the way for a crossing of its own.
    pub(super) fn holds_back(&self, name: PairName, event: &CollisionEvent) -> bool {
        let mut heard = lock(&self.book.heard);
        let is_held = heard.left.iter().any(|held| name_of(held) == name);
        if event.removed() {
            heard.left.retain(|held| name_of(held) != name);
            return false;
        }
        let leaves = self.claims.is_none() && event.stopped();
        if is_held || leaves {
            heard.left.push(*event);
        }
        is_held || leaves
    }

    /// Tells that a pair which is a sensor's no more has stopped to intersect, before it starts to touch.
    pub(super) fn end_intersection(
        &self,
        name: PairName,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
    ) {
        let mut heard = lock(&self.book.heard);
        let held = heard.left.iter().find(|held| name_of(held) == name);
        let Some(stop) = held.copied() else {
            return;
        };
        heard.left.retain(|held| name_of(held) != name);
        drop(heard);
        self.user
            .handle_collision_event(bodies, colliders, stop, None);
    }
}
