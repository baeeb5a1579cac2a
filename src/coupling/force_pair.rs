//! Contact pairs for the user's event handler, with the impulses that the flexible stage found.
//!
//! Rapier's own pairs of carriers and claimed bodies hold no impulse of ours, and cannot be written. A handler is given a
//! pair of the same form instead, so that [`ContactForceEvent::from_contact_pair`] reads our forces from it.

use super::pressed_point::PressedPoint;
use crate::math::{Vec2, perp, to_rapier};
use crate::rapier::math::Real;
use crate::rapier::parry::shape::PackedFeatureId;
use crate::rapier::prelude::*;
use std::sync::Mutex;

/// Two pairs that are filled anew for every event: one that reads as `started`, one that does not.
#[derive(Default)]
pub(super) struct ForcePairs {
    starting: ContactPair,
    lasting: Option<ContactPair>,
}

impl std::fmt::Debug for ForcePairs {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ForcePairs").finish_non_exhaustive()
    }
}

impl ForcePairs {
    /// A pair whose force was below the threshold in the last step, or above it, with the contacts of `points`.
    pub fn fill(
        &mut self,
        names: [ColliderHandle; 2],
        was_above: bool,
        points: &[PressedPoint],
        colliders: &ColliderSet,
        dt: f64,
    ) -> &ContactPair {
        let pair = self.blank(names, was_above);
        if let PairContacts::Rigid(contacts) = &mut pair.contacts {
            let manifolds = points
                .iter()
                .filter_map(|point| manifold(names, point, colliders, dt));
            contacts.manifolds.extend(manifolds);
        }
        pair
    }

    /// A pair of rapier's as it would be had its force been above the threshold in the last step.
    pub fn lasting(&mut self, pair: &ContactPair) -> &ContactPair {
        let lasting = self.blank([pair.collider1, pair.collider2], true);
        lasting.contacts = pair.contacts.clone();
        lasting
    }

    fn blank(&mut self, [one, other]: [ColliderHandle; 2], was_above: bool) -> &mut ContactPair {
        let pair = if was_above {
            self.lasting.get_or_insert_with(pair_above_its_threshold)
        } else {
            &mut self.starting
        };
        pair.collider1 = one;
        pair.collider2 = other;
        pair.clear();
        pair
    }
}

/// One point of contact as a manifold of its own, with rapier's signs: the normal points from the first collider to the
/// second, and impulses act on the first.
fn manifold(
    names: [ColliderHandle; 2],
    point: &PressedPoint,
    colliders: &ColliderSet,
    dt: f64,
) -> Option<ContactManifold> {
    let [first, second] = [colliders.get(names[0])?, colliders.get(names[1])?];
    // Our normal points from the target to the contactor.
    let sign = if point.contactor == names[0] {
        -1.0
    } else {
        1.0
    };
    let normal = sign * point.normal;
    let [pressure, friction] = point.force;
    let force_on_first = -sign * (pressure * point.normal + friction * perp(point.normal));
    let tangent: Vec2 = -perp(normal);
    let mut manifold = ContactManifold::with_data(0, 0, ContactManifoldData::default());
    manifold.data.rigid_body1 = first.parent();
    manifold.data.rigid_body2 = second.parent();
    manifold.data.normal = to_rapier(normal);
    manifold.data.solver_flags = SolverFlags::COMPUTE_RIGID_IMPULSES;
    let (pose1, pose2) = (first.position(), second.position());
    let at = to_rapier(point.position);
    manifold.local_n1 = pose1.rotation.inverse() * to_rapier(normal);
    manifold.local_n2 = pose2.rotation.inverse() * to_rapier(-normal);
    let mut contact = Contact::new(
        pose1.inverse_transform_point(at),
        pose2.inverse_transform_point(at),
        PackedFeatureId::UNKNOWN,
        PackedFeatureId::UNKNOWN,
        point.gap as Real,
    );
    contact.data.impulse = (pressure * dt) as Real;
    contact.data.tangent_impulse.x = (force_on_first.dot(&tangent) * dt) as Real;
    manifold.points.push(contact);
    Some(manifold)
}

/// A pair that knows its force was above the threshold: rapier keeps that to itself, so it is learnt from rapier, by a box
/// that presses on a floor for a second step.
fn pair_above_its_threshold() -> ContactPair {
    let learner = Learner::default();
    let mut world = PhysicsWorld::new();
    world.insert_collider(ColliderBuilder::cuboid(1.0, 1.0), None);
    let above = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 1.5));
    let shape = ColliderBuilder::cuboid(0.5, 0.5).active_events(ActiveEvents::CONTACT_FORCE_EVENTS);
    world.insert(above, shape);
    for _ in 0..STEPS_TO_LEARN {
        world.step_with_events(&(), &learner);
    }
    let learnt = learner.0.into_inner();
    learnt.ok().flatten().unwrap_or_default()
}

/// Steps after which a box that begins with a contact has pressed twice.
const STEPS_TO_LEARN: usize = 8;

/// Keeps the first pair that has been above its threshold before.
#[derive(Default)]
struct Learner(Mutex<Option<ContactPair>>);

impl EventHandler for Learner {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        _: &ColliderSet,
        _: CollisionEvent,
        _: Option<&ContactPair>,
    ) {
    }

    fn handle_contact_force_event(
        &self,
        dt: Real,
        _: &RigidBodySet,
        _: &ColliderSet,
        pair: &ContactPair,
        force: Real,
    ) {
        let is_new = ContactForceEvent::from_contact_pair(dt, pair, force).started;
        if let (false, Ok(mut learnt)) = (is_new, self.0.lock()) {
            learnt.get_or_insert_with(|| pair.clone());
        }
    }

    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_that_lasted_above_their_threshold_do_not_read_as_started() {
        let mut pairs = ForcePairs::default();
        let colliders = ColliderSet::new();
        for was_above in [true, false] {
            let names = [ColliderHandle::from_raw_parts(3, 1); 2];
            let pair = pairs.fill(names, was_above, &[], &colliders, 0.01);
            let event = ContactForceEvent::from_contact_pair(0.01, pair, 7.0);
            assert_eq!(event.started, !was_above);
            assert_eq!(
                (event.collider1, event.total_force_magnitude),
                (names[0], 7.0)
            );
            assert_eq!(event.total_force, Vector::ZERO);
        }
    }
}
