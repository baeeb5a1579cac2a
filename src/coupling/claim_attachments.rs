//! Claiming along attachments: what a flexible body is attached to is solved with it.

use super::filter::claimable_body;
use super::members::Members;
use super::roster::Roster;
use super::sets::RapierSets;
use crate::body::{AttachmentTarget, FlexBody, FlexBodySet};
use crate::rapier::prelude::*;

/// An attachment taking part in the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClaimedAttachment {
    /// Index and generation in the set.
    pub parts: (u32, u32),
    /// Its body among the claimed ones.
    pub flex: usize,
    /// The other body, if that is a flexible one.
    pub other: Option<usize>,
    /// The other body, if that is a rigid one.
    pub rigid: Option<RigidBodyHandle>,
    first_node: usize,
    contacts_enabled: bool,
}

/// The attachments taking part in the step, in the order of their bodies' places.
#[derive(Debug, Default)]
pub(super) struct Attached {
    all: Vec<ClaimedAttachment>,
}

impl Attached {
    /// Lists the attachments of the flexible bodies that take part.
    pub fn list(&mut self, flex: &Roster, flex_bodies: &FlexBodySet) {
        self.all.clear();
        for (parts, attachment) in flex_bodies.attachments().iter() {
            let slot_of = |handle| {
                let index = crate::body::FlexBodyHandle::into_raw_parts(handle).0;
                flex.iter().position(|flex| flex.index == index)
            };
            let Some(own) = slot_of(attachment.body()) else {
                continue;
            };
            let is_out = |handle| {
                let body = flex_bodies.get(handle);
                body.is_some_and(FlexBody::is_quarantined)
            };
            if matches!(attachment.target(), AttachmentTarget::Flexible(other) if is_out(other)) {
                continue;
            }
            let (other, rigid) = match attachment.target() {
                AttachmentTarget::World => (None, None),
                AttachmentTarget::RigidBody(handle) => (None, Some(handle)),
                AttachmentTarget::Flexible(handle) => (slot_of(handle), None),
            };
            self.all.push(ClaimedAttachment {
                parts,
                flex: own,
                other,
                rigid,
                first_node: attachment.nodes()[0],
                contacts_enabled: attachment.contacts_enabled(),
            });
        }
        // The order of insertion is not physics.
        let order = |one: &ClaimedAttachment| (one.flex, one.first_node, one.other, one.parts);
        self.all.sort_unstable_by_key(order);
    }

    /// Whether something is attached of which only a detection step can tell what it touches.
    pub fn has_rigid_bodies(&self, sets: &RapierSets<'_>) -> bool {
        let mut rigid = self.all.iter().filter_map(|one| one.rigid);
        rigid.any(|handle| claimable_body(sets, handle))
    }

    /// All of them.
    pub fn as_slice(&self) -> &[ClaimedAttachment] {
        &self.all
    }

    /// Claims the bodies that flexible ones are attached to.
    pub fn claim(&self, sets: &RapierSets<'_>, members: &mut Members) {
        for one in &self.all {
            if let Some(other) = one.other {
                members.unite(one.flex, other);
            }
            if let Some(handle) = one.rigid.filter(|&handle| claimable_body(sets, handle)) {
                let member = members.claim(handle);
                members.unite(one.flex, member);
            }
        }
    }

    /// Whether an attachment keeps a flexible body from touching a collider.
    pub fn forbids(
        &self,
        sets: &RapierSets<'_>,
        roster: &Roster,
        flex: usize,
        other: ColliderHandle,
    ) -> bool {
        if self.all.is_empty() {
            return false;
        }
        let target = roster.slot_of(other);
        let parent = sets.colliders.get(other).and_then(Collider::parent);
        self.all.iter().any(|one| {
            let is_rigid = one.flex == flex && one.rigid.is_some() && one.rigid == parent;
            let is_flexible = target.is_some_and(|target| {
                (one.flex, one.other) == (flex, Some(target))
                    || (one.flex, one.other) == (target, Some(flex))
            });
            !one.contacts_enabled && (is_rigid || is_flexible)
        })
    }
}
