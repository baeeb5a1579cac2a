//! The set of all flexible bodies of a world, with generational handles.

use super::attachment::{AttachmentTarget, Attachments};
use super::error::FlexBodyError;
use super::flex_body::FlexBody;
use super::handle::FlexBodyHandle;
use std::ops::{Index, IndexMut};
use std::sync::atomic::{AtomicU32, Ordering};

static NEXT_SET: AtomicU32 = AtomicU32::new(0);

/// Flexible bodies by handle.
///
/// Bodies are visited in the order of their slots, so results do not depend on hashing.
#[derive(Debug)]
pub struct FlexBodySet {
    pub(super) id: u32,
    pub(super) slots: Vec<Slot>,
    pub(super) vacant: Vec<u32>,
    attachments: Attachments,
}

#[derive(Debug)]
pub(super) struct Slot {
    pub(super) generation: u32,
    pub(super) body: Option<FlexBody>,
}

impl Default for FlexBodySet {
    fn default() -> Self {
        Self::new()
    }
}

impl FlexBodySet {
    /// An empty set.
    pub fn new() -> Self {
        Self {
            id: NEXT_SET.fetch_add(1, Ordering::Relaxed),
            slots: Vec::new(),
            vacant: Vec::new(),
            attachments: Attachments::default(),
        }
    }

    /// A set of parts that fit each other; sets made from now on have other numbers.
    #[cfg(feature = "serde-serialize")]
    pub(super) fn from_parts(
        id: u32,
        slots: Vec<Slot>,
        vacant: Vec<u32>,
        attachments: Attachments,
    ) -> Self {
        NEXT_SET.fetch_max(id.wrapping_add(1), Ordering::Relaxed);
        Self {
            id,
            slots,
            vacant,
            attachments,
        }
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.slots.len() - self.vacant.len()
    }

    /// Whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The body of a handle.
    ///
    /// # Errors
    /// If the handle is stale or foreign.
    pub fn try_get(&self, handle: FlexBodyHandle) -> Result<&FlexBody, FlexBodyError> {
        self.check(handle)?;
        self.slots[handle.index as usize]
            .body
            .as_ref()
            .ok_or(FlexBodyError::Stale(handle))
    }

    /// The body of a handle, to change.
    ///
    /// # Errors
    /// If the handle is stale or foreign.
    pub fn try_get_mut(&mut self, handle: FlexBodyHandle) -> Result<&mut FlexBody, FlexBodyError> {
        self.check(handle)?;
        self.slots[handle.index as usize]
            .body
            .as_mut()
            .ok_or(FlexBodyError::Stale(handle))
    }

    /// The body of a handle, `None` if it is stale or foreign.
    pub fn get(&self, handle: FlexBodyHandle) -> Option<&FlexBody> {
        self.try_get(handle).ok()
    }

    /// The body of a handle, `None` if it is stale or foreign.
    pub fn get_mut(&mut self, handle: FlexBodyHandle) -> Option<&mut FlexBody> {
        self.try_get_mut(handle).ok()
    }

    /// All bodies with their handles, in the order of their slots.
    pub fn iter(&self) -> impl Iterator<Item = (FlexBodyHandle, &FlexBody)> {
        let set = self.id;
        self.slots
            .iter()
            .enumerate()
            .filter_map(move |(index, slot)| {
                let handle = FlexBodyHandle {
                    set,
                    index: index as u32,
                    generation: slot.generation,
                };
                slot.body.as_ref().map(|body| (handle, body))
            })
    }

    /// All bodies with their handles, to change.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (FlexBodyHandle, &mut FlexBody)> {
        let set = self.id;
        self.slots
            .iter_mut()
            .enumerate()
            .filter_map(move |(index, slot)| {
                let handle = FlexBodyHandle {
                    set,
                    index: index as u32,
                    generation: slot.generation,
                };
                slot.body.as_mut().map(|body| (handle, body))
            })
    }

    /// The handle and body in a slot.
    pub fn at_index(&self, index: u32) -> Option<(FlexBodyHandle, &FlexBody)> {
        let slot = self.slots.get(index as usize)?;
        let handle = FlexBodyHandle {
            set: self.id,
            index,
            generation: slot.generation,
        };
        slot.body.as_ref().map(|body| (handle, body))
    }

    pub(crate) fn at_index_mut(&mut self, index: u32) -> Option<&mut FlexBody> {
        self.slots.get_mut(index as usize)?.body.as_mut()
    }

    /// Adds a body already bound to its carrier.
    pub(crate) fn insert_body(&mut self, body: FlexBody) -> FlexBodyHandle {
        if let Some(index) = self.vacant.pop() {
            let slot = &mut self.slots[index as usize];
            slot.body = Some(body);
            return FlexBodyHandle {
                set: self.id,
                index,
                generation: slot.generation,
            };
        }
        let index = self.slots.len() as u32;
        self.slots.push(Slot {
            generation: 0,
            body: Some(body),
        });
        FlexBodyHandle {
            set: self.id,
            index,
            generation: 0,
        }
    }

    /// Takes a body out; its handle is stale from now on.
    pub(crate) fn take_body(&mut self, handle: FlexBodyHandle) -> Result<FlexBody, FlexBodyError> {
        self.check(handle)?;
        let slot = &mut self.slots[handle.index as usize];
        let body = slot.body.take().ok_or(FlexBodyError::Stale(handle))?;
        slot.generation += 1;
        self.vacant.push(handle.index);
        self.attachments.retain(|attachment| {
            attachment.body() != handle && attachment.target() != AttachmentTarget::Flexible(handle)
        });
        Ok(body)
    }

    pub(crate) fn attachments(&self) -> &Attachments {
        &self.attachments
    }

    pub(crate) fn attachments_mut(&mut self) -> &mut Attachments {
        &mut self.attachments
    }

    pub(crate) fn id(&self) -> u32 {
        self.id
    }

    fn check(&self, handle: FlexBodyHandle) -> Result<(), FlexBodyError> {
        if handle.set != self.id {
            return Err(FlexBodyError::Foreign(handle));
        }
        match self.slots.get(handle.index as usize) {
            Some(slot) if slot.generation == handle.generation && slot.body.is_some() => Ok(()),
            _ => Err(FlexBodyError::Stale(handle)),
        }
    }
}

impl Index<FlexBodyHandle> for FlexBodySet {
    type Output = FlexBody;

    /// # Panics
    /// If the handle is stale or foreign; [`FlexBodySet::get`] returns an option instead.
    fn index(&self, handle: FlexBodyHandle) -> &FlexBody {
        match self.try_get(handle) {
            Ok(body) => body,
            Err(error) => panic!("{error}"),
        }
    }
}

impl IndexMut<FlexBodyHandle> for FlexBodySet {
    /// # Panics
    /// If the handle is stale or foreign; [`FlexBodySet::get_mut`] returns an option instead.
    fn index_mut(&mut self, handle: FlexBodyHandle) -> &mut FlexBody {
        match self.try_get_mut(handle) {
            Ok(body) => body,
            Err(error) => panic!("{error}"),
        }
    }
}
