//! A handler that writes down what it is told.

use super::*;
use std::sync::{Mutex, MutexGuard};

/// One event.
#[derive(Clone, Copy, Debug)]
pub enum Told {
    Collision(CollisionEvent),
    /// A contact force between two colliders (N).
    Force([ColliderHandle; 2], Real),
}

/// What was told, in the order in which it was.
#[derive(Default)]
pub struct Recorder(Mutex<Vec<Told>>);

impl EventHandler for Recorder {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        _: &ColliderSet,
        event: CollisionEvent,
        _: Option<&ContactPair>,
    ) {
        self.told().push(Told::Collision(event));
    }

    fn handle_contact_force_event(
        &self,
        _: Real,
        _: &RigidBodySet,
        _: &ColliderSet,
        pair: &ContactPair,
        force: Real,
    ) {
        let colliders = [pair.collider1, pair.collider2];
        self.told().push(Told::Force(colliders, force));
    }

    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
}

impl Recorder {
    fn told(&self) -> MutexGuard<'_, Vec<Told>> {
        self.0.lock().expect("no handler panicked")
    }

    pub fn collisions(&self) -> Vec<CollisionEvent> {
        let told = self.told();
        let events = told.iter().filter_map(|told| match told {
            Told::Collision(event) => Some(*event),
            Told::Force(..) => None,
        });
        events.collect()
    }

    /// How many collisions started and how many stopped.
    pub fn starts_and_stops(&self) -> (usize, usize) {
        let all = self.collisions();
        let started = all.iter().filter(|event| event.started()).count();
        (started, all.len() - started)
    }

    /// Contact forces (N).
    pub fn forces(&self) -> Vec<f64> {
        let told = self.told();
        let forces = told.iter().filter_map(|told| match told {
            Told::Collision(_) => None,
            Told::Force(_, force) => Some(f64::from(*force)),
        });
        forces.collect()
    }

    /// Everything since it was last asked, as text that tells any two numbers apart.
    pub fn take(&self) -> Vec<String> {
        let told = std::mem::take(&mut *self.told());
        told.iter().map(|told| format!("{told:?}")).collect()
    }
}
