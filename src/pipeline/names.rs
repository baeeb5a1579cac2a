//! What the user knows the owners of contacts and joints as.

use super::participant::{Held, Participant};
use crate::body::FlexBodySet;
use crate::constraint::contact::Owner;
use crate::constraint::joint::JointOwner;
use crate::coupling::RapierSets;
use crate::rapier::prelude::{
    ColliderHandle, ImpulseJointHandle, MultibodyJointHandle, RigidBodyHandle,
};

/// Looks owners up.
#[derive(Clone, Copy)]
pub(super) struct Names<'a, 'r> {
    pub sets: &'a RapierSets<'r>,
    pub flex_bodies: &'a FlexBodySet,
}

impl Names<'_, '_> {
    /// The body or collider of an owner.
    pub fn participant(&self, owner: Owner) -> Option<Participant> {
        match owner {
            Owner::Flex(index) => {
                let body = self.flex_bodies.at_index(index);
                body.map(|(handle, _)| Participant::Flex(handle))
            }
            Owner::Collider(_) => self.collider(owner).map(Participant::Rigid),
        }
    }

    /// The collider of an owner: of a flexible body its surface.
    pub fn collider(&self, owner: Owner) -> Option<ColliderHandle> {
        match owner {
            Owner::Flex(index) => {
                let body = self.flex_bodies.at_index(index);
                body.map(|(_, body)| body.collider_handle())
            }
            Owner::Collider(index) => {
                let collider = self.sets.colliders.get_unknown_gen(index);
                collider.map(|(_, handle)| handle)
            }
        }
    }

    /// The joint or attachment of an owner.
    pub fn held(&self, owner: JointOwner) -> Held {
        match owner {
            JointOwner::Impulse(index, generation) => {
                Held::Joint(ImpulseJointHandle::from_raw_parts(index, generation))
            }
            JointOwner::Multibody(index, generation) => {
                let body = RigidBodyHandle::from_raw_parts(index, generation);
                Held::MultibodyJoint(MultibodyJointHandle(body.0))
            }
            JointOwner::Attachment(index, generation) => {
                let parts = (index, generation);
                Held::Attachment(self.flex_bodies.attachment_handle(parts))
            }
        }
    }
}

impl Participant {
    /// The owner that it is in contacts.
    pub(super) fn owner(self) -> Owner {
        match self {
            Self::Flex(body) => Owner::Flex(body.into_raw_parts().0),
            Self::Rigid(collider) => Owner::Collider(collider.into_raw_parts().0),
        }
    }
}
