//! All attachments of a set, with generational handles.

use super::{Attachment, AttachmentError, AttachmentTarget};
use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::rapier::prelude::RigidBodyHandle;

/// Names an attachment of one [`FlexBodySet`]; stays invalid for ever once it is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct AttachmentHandle {
    set: u32,
    index: u32,
    generation: u32,
}

impl AttachmentHandle {
    /// Names no attachment of any set, for what is to be filled in later, as rapier's handles have it.
    pub fn invalid() -> Self {
        Self {
            set: u32::MAX,
            index: u32::MAX,
            generation: u32::MAX,
        }
    }

    /// Position in the set and generation, for display and logs.
    pub fn into_raw_parts(self) -> (u32, u32) {
        (self.index, self.generation)
    }
}

impl Default for AttachmentHandle {
    /// The [invalid](Self::invalid) one.
    fn default() -> Self {
        Self::invalid()
    }
}

#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
struct Slot {
    generation: u32,
    attachment: Option<Attachment>,
}

/// Attachments by handle, in the order of their slots.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Attachments {
    slots: Vec<Slot>,
}

impl Attachments {
    pub fn iter(&self) -> impl Iterator<Item = ((u32, u32), &Attachment)> {
        let slots = self.slots.iter().enumerate();
        slots.filter_map(|(index, slot)| {
            let attachment = slot.attachment.as_ref()?;
            Some(((index as u32, slot.generation), attachment))
        })
    }

    pub fn iter_mut(&mut self) -> impl Iterator<Item = ((u32, u32), &mut Attachment)> {
        let slots = self.slots.iter_mut().enumerate();
        slots.filter_map(|(index, slot)| {
            let attachment = slot.attachment.as_mut()?;
            Some(((index as u32, slot.generation), attachment))
        })
    }

    pub fn get(&self, (index, generation): (u32, u32)) -> Option<&Attachment> {
        let slot = self.slots.get(index as usize)?;
        slot.attachment
            .as_ref()
            .filter(|_| slot.generation == generation)
    }

    pub fn get_mut(&mut self, (index, generation): (u32, u32)) -> Option<&mut Attachment> {
        let slot = self.slots.get_mut(index as usize)?;
        slot.attachment
            .as_mut()
            .filter(|_| slot.generation == generation)
    }

    fn insert(&mut self, attachment: Attachment) -> (u32, u32) {
        let vacant = self.slots.iter().position(|slot| slot.attachment.is_none());
        let index = vacant.unwrap_or_else(|| {
            self.slots.push(Slot {
                generation: 0,
                attachment: None,
            });
            self.slots.len() - 1
        });
        self.slots[index].attachment = Some(attachment);
        (index as u32, self.slots[index].generation)
    }

    fn remove(&mut self, (index, generation): (u32, u32)) -> Option<Attachment> {
        let slot = self.slots.get_mut(index as usize)?;
        if slot.generation != generation || slot.attachment.is_none() {
            return None;
        }
        slot.generation += 1;
        slot.attachment.take()
    }

    /// Removes the attachments that do not fulfil a condition.
    pub fn retain(&mut self, keeps: impl Fn(&Attachment) -> bool) {
        for slot in &mut self.slots {
            if slot.attachment.as_ref().is_some_and(|one| !keeps(one)) {
                slot.attachment = None;
                slot.generation += 1;
            }
        }
    }
}

impl FlexBodySet {
    /// The attachment of a handle.
    ///
    /// # Errors
    /// If the handle is stale, because it or a body it held was removed, or foreign.
    pub fn attachment(&self, handle: AttachmentHandle) -> Result<&Attachment, AttachmentError> {
        self.check_attachment(handle)?;
        let parts = handle.into_raw_parts();
        let found = self.attachments().get(parts);
        found.ok_or(AttachmentError::Stale(handle))
    }

    /// The attachment of a handle, to move its target.
    ///
    /// # Errors
    /// As [`FlexBodySet::attachment`].
    pub fn attachment_mut(
        &mut self,
        handle: AttachmentHandle,
    ) -> Result<&mut Attachment, AttachmentError> {
        self.check_attachment(handle)?;
        let parts = handle.into_raw_parts();
        let found = self.attachments_mut().get_mut(parts);
        found.ok_or(AttachmentError::Stale(handle))
    }

    /// Removes an attachment; its bodies move freely from the next step on.
    ///
    /// # Errors
    /// As [`FlexBodySet::attachment`].
    pub fn detach(&mut self, handle: AttachmentHandle) -> Result<Attachment, AttachmentError> {
        self.check_attachment(handle)?;
        let parts = handle.into_raw_parts();
        let found = self.attachments_mut().remove(parts);
        let removed = found.ok_or(AttachmentError::Stale(handle))?;
        self.wake_ends(&removed);
        Ok(removed)
    }

    /// All attachments with their handles.
    pub fn iter_attachments(&self) -> impl Iterator<Item = (AttachmentHandle, &Attachment)> {
        let all = self.attachments().iter();
        all.map(|(parts, attachment)| (self.attachment_handle(parts), attachment))
    }

    pub(crate) fn insert_attachment(&mut self, attachment: Attachment) -> AttachmentHandle {
        self.wake_ends(&attachment);
        let parts = self.attachments_mut().insert(attachment);
        self.attachment_handle(parts)
    }

    /// Wakes the flexible bodies at the ends of an attachment.
    fn wake_ends(&mut self, attachment: &Attachment) {
        let other = match attachment.target() {
            AttachmentTarget::Flexible(other) => Some(other),
            AttachmentTarget::World | AttachmentTarget::RigidBody(_) => None,
        };
        for handle in [Some(attachment.body()), other].into_iter().flatten() {
            if let Some(body) = self.get_mut(handle) {
                body.wake_up();
            }
        }
    }

    /// Whether something is attached to a body.
    pub fn is_attached(&self, handle: FlexBodyHandle) -> bool {
        self.attachments().iter().any(|(_, attachment)| {
            attachment.body() == handle || attachment.target() == AttachmentTarget::Flexible(handle)
        })
    }

    /// Whether a rigid body is attached to a flexible one.
    pub(crate) fn has_attached(&self, rigid: RigidBodyHandle) -> bool {
        let target = AttachmentTarget::RigidBody(rigid);
        let mut attachments = self.attachments().iter();
        attachments.any(|(_, attachment)| attachment.target() == target)
    }

    pub(crate) fn attachment_handle(&self, (index, generation): (u32, u32)) -> AttachmentHandle {
        AttachmentHandle {
            set: self.id(),
            index,
            generation,
        }
    }

    fn check_attachment(&self, handle: AttachmentHandle) -> Result<(), AttachmentError> {
        if handle.set == self.id() {
            Ok(())
        } else {
            Err(AttachmentError::Foreign(handle))
        }
    }
}
