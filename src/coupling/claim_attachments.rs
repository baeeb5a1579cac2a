//! Claiming along attachments: what a flexible body is attached to is solved with it.

use super::claim::Claims;
use super::filter::claimable_body;
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

impl Claims {
    /// Lists the attachments; the flexible bodies have been found already.
    pub(super) fn list_attachments(&mut self, flex_bodies: &FlexBodySet) {
        self.attached.clear();
        for (parts, attachment) in flex_bodies.attachments().iter() {
            let slot_of = |handle| {
                let index = crate::body::FlexBodyHandle::into_raw_parts(handle).0;
                self.flex.iter().position(|flex| flex.index == index)
            };
            let Some(flex) = slot_of(attachment.body()) else {
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
            self.attached.push(ClaimedAttachment {
                parts,
                flex,
                other,
                rigid,
                first_node: attachment.nodes()[0],
                contacts_enabled: attachment.contacts_enabled(),
            });
        }
        // The order of insertion is not physics.
        let order = |one: &ClaimedAttachment| (one.flex, one.first_node, one.other, one.parts);
        self.attached.sort_unstable_by_key(order);
    }

    /// Whether something is attached of which only a detection step can tell what it touches.
    pub fn has_attached_bodies(&self, sets: &RapierSets<'_>) -> bool {
        let mut rigid = self.attached.iter().filter_map(|one| one.rigid);
        rigid.any(|handle| claimable_body(sets, handle))
    }

    /// Claims the bodies that flexible ones are attached to.
    pub(super) fn claim_attached(&mut self, sets: &RapierSets<'_>) {
        for slot in 0..self.attached.len() {
            let ClaimedAttachment {
                flex, other, rigid, ..
            } = self.attached[slot];
            if let Some(other) = other {
                self.unite(flex, other);
            }
            if let Some(handle) = rigid.filter(|&handle| claimable_body(sets, handle)) {
                let member = self.claim(handle);
                self.unite(flex, member);
            } else {
                self.meet_link(sets, rigid, flex);
            }
        }
    }

    /// Whether an attachment keeps a flexible body from touching a collider.
    pub(super) fn attachment_forbids(
        &self,
        sets: &RapierSets<'_>,
        flex: usize,
        other: ColliderHandle,
    ) -> bool {
        if self.attached.is_empty() {
            return false;
        }
        let target = self.flex_of_collider.get(&other).copied();
        let parent = sets.colliders.get(other).and_then(Collider::parent);
        self.attached.iter().any(|one| {
            let is_rigid = one.flex == flex && one.rigid.is_some() && one.rigid == parent;
            let is_flexible = target.is_some_and(|target| {
                (one.flex, one.other) == (flex, Some(target))
                    || (one.flex, one.other) == (target, Some(flex))
            });
            !one.contacts_enabled && (is_rigid || is_flexible)
        })
    }
}
