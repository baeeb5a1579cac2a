//! Hooks that change their mind between steps, and a handler that looks at what it is told.

use crate::common::*;
use foil2d::rapier::math::Real;
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Clone, Copy, Debug, Default)]
pub enum Mood {
    /// Nothing is changed.
    #[default]
    Calm,
    /// Every third pair passes through each other.
    Filters,
    /// Pairs are listed and push nothing.
    Loosens,
    /// No friction, and all bounces.
    Alters,
    /// Every other contact is cleared.
    Clears,
}

#[derive(Default)]
pub struct Hooks(pub Mood);

fn parity(one: ColliderHandle, other: ColliderHandle) -> u32 {
    one.into_raw_parts().0 + other.into_raw_parts().0
}

impl PhysicsHooks for Hooks {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let sum = parity(context.collider1, context.collider2);
        match self.0 {
            Mood::Filters if sum.is_multiple_of(3) => None,
            Mood::Loosens => Some(SolverFlags::empty()),
            _ => Some(SolverFlags::default()),
        }
    }

    fn filter_intersection_pair(&self, context: &PairFilterContext) -> bool {
        !matches!(self.0, Mood::Filters)
            || !parity(context.collider1, context.collider2).is_multiple_of(3)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let sum = parity(context.collider1, context.collider2);
        let Some(rigid) = context.rigid_mut() else {
            return;
        };
        match self.0 {
            Mood::Alters => (*rigid.friction, *rigid.restitution) = (0.0, 1.0),
            Mood::Clears if sum.is_multiple_of(2) => {
                rigid.solver_contacts.clear();
            }
            _ => {}
        }
    }
}

/// Counts what no handler should hear.
#[derive(Default)]
pub struct Listener {
    pub n_events: AtomicUsize,
    /// Of colliders that are gone, though they do not say so, or with forces that are no numbers.
    pub n_wrong: AtomicUsize,
}

impl Listener {
    fn note(&self, is_right: bool) {
        self.n_events.fetch_add(1, Ordering::Relaxed);
        self.n_wrong
            .fetch_add(usize::from(!is_right), Ordering::Relaxed);
    }
}

impl EventHandler for Listener {
    fn handle_collision_event(
        &self,
        _bodies: &RigidBodySet,
        colliders: &ColliderSet,
        event: CollisionEvent,
        _pair: Option<&ContactPair>,
    ) {
        let both = [event.collider1(), event.collider2()];
        let is_alive = both.iter().all(|&handle| colliders.contains(handle));
        self.note(is_alive || event.stopped());
    }

    fn handle_contact_force_event(
        &self,
        _dt: Real,
        _bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
        force: Real,
    ) {
        let both = [pair.collider1, pair.collider2];
        let is_alive = both.iter().all(|&handle| colliders.contains(handle));
        self.note(is_alive && force.is_finite());
    }

    fn handle_soft_body_tear_event(&self, _soft: &SoftBodySet, _event: &SoftBodyTearEvent) {}
}
