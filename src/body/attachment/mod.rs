//! Attachments: what holds a flexible body without touching it.
//!
//! The nodes of an attachment lie on the body's surface. They are held by the world, by a rigid body of any kind or by the surface of
//! another flexible body, with multipliers in the same system as contacts.

mod arena;
mod builder;
mod error;

pub use arena::AttachmentHandle;
pub(in crate::body) use arena::Attachments;
pub use builder::AttachmentBuilder;
pub(crate) use builder::{Choice, Plan};
pub use error::AttachmentError;

use super::handle::FlexBodyHandle;
use crate::math::Vec2;
use crate::rapier::prelude::RigidBodyHandle;

/// What an attachment holds on to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum AttachmentTarget {
    /// The world; [`Attachment::set_target`] moves it.
    World,
    /// A rigid body: dynamic, kinematic or fixed.
    RigidBody(RigidBodyHandle),
    /// Another flexible body.
    Flexible(FlexBodyHandle),
}

/// How an attachment holds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum AttachmentKind {
    /// The mean of the nodes stays at a point of the target; the body may turn about it.
    Pin,
    /// Every node stays at its point of the target, which keeps the direction too.
    Weld,
    /// A spring and a damper between the mean of the nodes and a point of the target.
    Spring {
        /// Stiffness (N/m).
        stiffness: f64,
        /// Damping (N s/m).
        damping: f64,
        /// Length at rest (m).
        rest_length: f64,
    },
}

/// A point of the target that nodes are held at.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) enum Anchor {
    /// A point of the world or of a rigid body, in its coordinates (m).
    Point(Vec2),
    /// A point of a flexible body's surface: the nodes of a segment and the place between them, 0 to 1.
    Surface([usize; 2], f64),
}

/// Offset and turn of the world's side of an attachment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Shift {
    pub offset: Vec2,
    pub angle: f64,
}

/// One attachment of a flexible body.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Attachment {
    pub(crate) body: FlexBodyHandle,
    pub(crate) target: AttachmentTarget,
    pub(crate) kind: AttachmentKind,
    pub(crate) nodes: Vec<usize>,
    /// One per node of a weld, one for all otherwise.
    pub(crate) anchors: Vec<Anchor>,
    /// What the world's side turns about (m).
    pub(crate) pivot: Vec2,
    pub(crate) contacts_enabled: bool,
    pub(crate) last: Shift,
    pub(crate) next: Shift,
    pub(crate) force: [f64; 2],
    pub(crate) torque: f64,
}

impl Attachment {
    /// The body that is attached.
    pub fn body(&self) -> FlexBodyHandle {
        self.body
    }

    /// What it is attached to.
    pub fn target(&self) -> AttachmentTarget {
        self.target
    }

    /// How it is held.
    pub fn kind(&self) -> AttachmentKind {
        self.kind
    }

    /// The nodes that are held.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Mean force on the attached body over the last step (N). With small strain a part of it acts in the step after, as that of
    /// [contacts](crate::pipeline::ContactReport) does.
    pub fn force(&self) -> [f64; 2] {
        self.force
    }

    /// Mean torque on the attached body over the last step, about the mean of the nodes (N m).
    pub fn torque(&self) -> f64 {
        self.torque
    }

    /// Whether both bodies may touch each other.
    pub fn contacts_enabled(&self) -> bool {
        self.contacts_enabled
    }

    /// Moves the world's side: where it is to be at the end of the next step, from where it was when the attachment was made, and
    /// turned by an angle about the mean of the nodes then (m, rad). Call it before every step of a prescribed motion.
    ///
    /// # Errors
    /// If the target is not the world: attach the body to a kinematic body and move that; or if a number is not finite.
    pub fn set_target(&mut self, offset: [f64; 2], angle: f64) -> Result<(), AttachmentError> {
        if self.target != AttachmentTarget::World {
            return Err(AttachmentError::NotWorld);
        }
        let offset = Vec2::from(offset);
        if !(offset.iter().all(|value| crate::math::is_held(*value)) && angle.is_finite()) {
            return Err(AttachmentError::NotFinite("the target"));
        }
        self.next = Shift { offset, angle };
        Ok(())
    }
}
