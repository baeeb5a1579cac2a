//! Events of rapier as messages of Bevy.

use bevy::prelude::*;
use bevy_rapier2d::prelude::{CollisionEvent, ContactForceEvent};
use foil2d::rapier::dynamics::SoftBodyTearEvent as RapierSoftBodyTearEvent;
use foil2d::rapier::geometry::{
    CollisionEvent as RapierCollisionEvent, ContactForceEvent as RapierContactForceEvent,
};
use foil2d::rapier::prelude::{
    ColliderHandle, ColliderSet, ContactPair, EventHandler, Real, RigidBodySet, SoftBodySet,
};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// Entities of colliders.
pub type Known = HashMap<ColliderHandle, Entity>;

/// The entity whose collider it is.
fn entity_of(colliders: &ColliderSet, known: &Known, handle: ColliderHandle) -> Option<Entity> {
    let live = colliders.get(handle);
    live.and_then(|collider| Entity::try_from_bits(collider.user_data as u64))
        .or_else(|| known.get(&handle).copied())
}

/// Entities of all colliders there are.
pub fn known(colliders: &ColliderSet, known: &mut Known) {
    known.clear();
    let named = colliders.iter().filter_map(|(handle, collider)| {
        Some((handle, Entity::try_from_bits(collider.user_data as u64)?))
    });
    known.extend(named);
}

/// Collects events of steps. Rapier may call it from several threads.
pub struct Collector<'a> {
    known: &'a Known,
    collisions: Mutex<Vec<CollisionEvent>>,
    forces: Mutex<Vec<ContactForceEvent>>,
}

impl<'a> Collector<'a> {
    pub fn new(known: &'a Known) -> Self {
        let (collisions, forces) = Default::default();
        Self {
            known,
            collisions,
            forces,
        }
    }

    /// What was collected.
    pub fn into_messages(self) -> (Vec<CollisionEvent>, Vec<ContactForceEvent>) {
        let collisions = self.collisions.into_inner();
        let forces = self.forces.into_inner();
        (
            collisions.unwrap_or_else(PoisonError::into_inner),
            forces.unwrap_or_else(PoisonError::into_inner),
        )
    }
}

impl EventHandler for Collector<'_> {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        colliders: &ColliderSet,
        event: RapierCollisionEvent,
        _: Option<&ContactPair>,
    ) {
        let entity = |handle| entity_of(colliders, self.known, handle);
        let event = match event {
            RapierCollisionEvent::Started(a, b, flags) => {
                let pair = entity(a).zip(entity(b));
                pair.map(|(a, b)| CollisionEvent::Started(a, b, flags))
            }
            RapierCollisionEvent::Stopped(a, b, flags) => {
                let pair = entity(a).zip(entity(b));
                pair.map(|(a, b)| CollisionEvent::Stopped(a, b, flags))
            }
        };
        let collisions = self.collisions.lock();
        collisions
            .unwrap_or_else(PoisonError::into_inner)
            .extend(event);
    }

    fn handle_contact_force_event(
        &self,
        dt: Real,
        _: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
        total_force_magnitude: Real,
    ) {
        let event = RapierContactForceEvent::from_contact_pair(dt, pair, total_force_magnitude);
        let entity = |handle| entity_of(colliders, self.known, handle);
        let Some((collider1, collider2)) = entity(event.collider1).zip(entity(event.collider2))
        else {
            return;
        };
        let mut forces = self.forces.lock().unwrap_or_else(PoisonError::into_inner);
        forces.push(ContactForceEvent {
            collider1,
            collider2,
            total_force: event.total_force,
            total_force_magnitude: event.total_force_magnitude,
            max_force_direction: event.max_force_direction,
            max_force_magnitude: event.max_force_magnitude,
            started: event.started,
        });
    }
    // Entities of the pieces are made by bevy_rapier2d itself, which keeps to itself what it needs to know for that.
    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &RapierSoftBodyTearEvent) {}
}
