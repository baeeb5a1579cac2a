//! What a step leaves to the next: a snapshot saves it, and nothing else that bears on the motion but the bodies themselves.

use super::hooks::HookBook;
use super::masters::Masters;
use super::references::References;
use crate::constraint::contact::{ContactMemory, Owner};
use crate::constraint::joint::JointMemory;

/// Memory from step to step. What the islands of a step note is not remembered before the step has been taken.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// Multipliers of contacts.
    pub contacts: ContactMemory,
    /// Multipliers of joints.
    pub joints: JointMemory,
    /// Faces that pairs of rigid parts were measured to.
    pub(super) references: References,
    /// What the user's hooks said of contacts.
    pub hooks: HookBook,
    /// Motions of claimed rigid bodies.
    pub masters: Masters,
}

impl Memory {
    /// Begins with the islands of a step, of which nothing is noted yet.
    pub fn begin_step(&mut self) {
        self.discard_notes();
        self.hooks.begin();
    }

    /// Throws away what was noted of a step that is not taken.
    pub fn discard_notes(&mut self) {
        self.contacts.discard_notes();
        self.joints.discard_notes();
        self.references.discard_notes();
    }

    /// Remembers what was noted of a step that has been taken.
    pub fn turn_over(&mut self) {
        self.contacts.turn_over();
        self.references.turn_over();
        self.joints.turn_over();
        self.hooks.turn_over();
    }

    /// Keeps what contacts of sleepers will be asked for when they wake.
    pub fn keep(&mut self, sleeps: impl Fn(Owner) -> bool) {
        self.references.keep(&sleeps);
        self.contacts
            .keep(|key| sleeps(key.contactor) || sleeps(key.target));
    }
}
