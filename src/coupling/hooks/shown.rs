//! One contact as it is shown to the user's hook, and what that leaves of it.

use crate::coupling::sets::RapierSets;
use crate::rapier::math::Real;
use crate::rapier::parry::shape::PackedFeatureId;
use crate::rapier::prelude::*;

/// A contact as the hook sees it and leaves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    pub normal: Vector,
    pub friction: Real,
    pub restitution: Real,
    pub gap: Real,
    /// The velocity along the contact that friction leads to (m/s).
    pub belt: Vector,
    pub user_data: u32,
    pub is_kept: bool,
}

impl Shown {
    /// What the user's hook makes of it.
    pub fn asked(
        self,
        [collider1, collider2]: [ColliderHandle; 2],
        ([anchor1, anchor2], reaches): ([Vector; 2], Real),
        sets: &RapierSets<'_>,
    ) -> Self {
        let mut answer = self;
        let parent = |handle| sets.colliders.get(handle).and_then(Collider::parent);
        let pose = |handle| {
            sets.colliders
                .get(handle)
                .map(|collider| *collider.position())
        };
        let (pose1, pose2) = (
            pose(collider1).unwrap_or_default(),
            pose(collider2).unwrap_or_default(),
        );
        let mut manifold = ContactManifold::with_data(0, 0, ContactManifoldData::default());
        manifold.local_n1 = pose1.rotation.inverse() * self.normal;
        manifold.local_n2 = pose2.rotation.inverse() * -self.normal;
        manifold.data.normal = self.normal;
        manifold.data.rigid_body1 = parent(collider1);
        manifold.data.rigid_body2 = parent(collider2);
        manifold.data.friction = self.friction;
        manifold.data.restitution = self.restitution;
        manifold.data.user_data = self.user_data;
        let mut solver_contacts = SolverContacts::new();
        let behind = anchor1 + self.normal * reaches;
        let own = (0, anchor1, self.gap);
        let farthest = (1, behind, self.gap - reaches);
        let shown = [Some(own), (reaches > 0.0).then_some(farthest)];
        for (id, anchor1, dist) in shown.into_iter().flatten() {
            manifold.points.push(Contact::new(
                pose1.inverse_transform_point(anchor1),
                pose2.inverse_transform_point(anchor2),
                PackedFeatureId::UNKNOWN,
                PackedFeatureId::UNKNOWN,
                dist,
            ));
            solver_contacts.push(SolverContact {
                anchor1,
                anchor2,
                dist,
                tangent_velocity: self.belt,
                contact_id: [id],
            });
        }
        sets.hooks
            .modify_solver_contacts(&mut ContactModificationContext {
                bodies: sets.bodies,
                colliders: sets.colliders,
                collider1,
                collider2,
                rigid_body1: parent(collider1),
                rigid_body2: parent(collider2),
                contacts: ModifiableContacts::Rigid(ModifiableManifold {
                    manifold: &manifold,
                    solver_contacts: &mut solver_contacts,
                    normal: &mut answer.normal,
                    friction: &mut answer.friction,
                    restitution: &mut answer.restitution,
                    user_data: &mut answer.user_data,
                }),
            });
        let own = solver_contacts
            .iter()
            .find(|contact| contact.contact_id == [0]);
        answer.is_kept = own.is_some();
        if let Some(contact) = own {
            (answer.gap, answer.belt) = (contact.dist, contact.tangent_velocity);
        }
        answer
    }

    pub fn is_finite(&self) -> bool {
        let numbers = [self.friction, self.restitution, self.gap];
        numbers.iter().all(|number| number.is_finite())
            && self.normal.is_finite()
            && self.belt.is_finite()
            && self.normal.length() > 0.0
    }
}
