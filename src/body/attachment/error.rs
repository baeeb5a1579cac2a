//! Why an attachment cannot be made or found.

use super::AttachmentHandle;
use crate::body::FlexBodyError;
use crate::rapier::prelude::RigidBodyHandle;
use thiserror::Error;

/// Why an attachment cannot be made or found. Nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum AttachmentError {
    /// A flexible body is not in the set.
    #[error(transparent)]
    Body(#[from] FlexBodyError),
    /// No node was chosen.
    #[error(
        "the attachment holds no node: name nodes, or choose a region that has some of the body's surface in it (in the mesh's own coordinates, before the builder's translation and rotation)"
    )]
    NoNodes,
    /// A node is not on the surface.
    #[error("node {0} lies inside the body: attach nodes of its boundary")]
    InteriorNode(usize),
    /// A node is named twice.
    #[error("node {0} is named twice: name every node once")]
    RepeatedNode(usize),
    /// A node is pinned by the body's builder.
    #[error(
        "node {0} is pinned by the builder and cannot move: attach others, or leave out the pin"
    )]
    PinnedNode(usize),
    /// One node has no direction.
    #[error("a weld of one node cannot keep a direction: name two nodes or more, or use a pin")]
    WeldOfOne,
    /// Nothing was named to attach to.
    #[error("the attachment has no target: say `to_world`, `to_rigid_body` or `to_flexible`")]
    NoTarget,
    /// The rigid body is not in the set given.
    #[error(
        "{0:?} is not in the rigid-body set given: it was removed, or belongs to another world"
    )]
    RigidBody(RigidBodyHandle),
    /// The rigid body carries a flexible one.
    #[error("{0:?} carries a flexible body and moves with nothing: use `to_flexible`")]
    Carrier(RigidBodyHandle),
    /// Both sides are the same body.
    #[error("a body cannot be attached to itself")]
    SameBody,
    /// A pin or weld would have to pull two flexible bodies together over a distance that only force could close in a few steps.
    #[error(
        "nodes are {distance} m from where they are to be held on the other body, beyond {most} m, half the smaller body's size: bring the bodies together first, name a nearer point, or use a spring"
    )]
    TooFar {
        /// Distance of the nodes, or of their mean, from the point on the other body's surface (m).
        distance: f64,
        /// Largest distance that is closed (m).
        most: f64,
    },
    /// A weld would hold neighbouring nodes much nearer to each other than they are, or farther apart, as where nodes lie beside the other
    /// body and all have its corner nearest.
    #[error(
        "nodes {} and {} are {length} m apart and the weld would hold them {held} m apart: choose only nodes that lie along the other body's surface", nodes[0], nodes[1]
    )]
    Strained {
        /// The nodes, neighbours on the boundary.
        nodes: [usize; 2],
        /// Their distance (m).
        length: f64,
        /// The distance of the points where they would be held (m).
        held: f64,
    },
    /// Stiffness, damping or length is negative.
    #[error("{0} is negative: give zero or more")]
    Negative(&'static str),
    /// A number is not finite, or too large for rapier's precision.
    #[error("{0} holds a number that is not finite or too large for rapier")]
    NotFinite(&'static str),
    /// Only the world's side can be moved.
    #[error(
        "only an attachment to the world has a target to set: attach the body to a kinematic body and move that"
    )]
    NotWorld,
    /// A point given for a weld, which holds every node where it is.
    #[error("a weld holds every node where it is and has no single point: leave out `at_point`")]
    WeldAtPoint,
    /// A length at rest given for a pin or a weld.
    #[error(
        "a pin or a weld has no length at rest: leave out `rest_length`, or use `spring_damper`"
    )]
    NoSpring,
    /// The attachment was removed, or a body it held.
    #[error("{0:?} names an attachment that was removed, or whose body was: drop the handle")]
    Stale(AttachmentHandle),
    /// The handle came from another set.
    #[error(
        "{0:?} comes from another FlexBodySet, or was never filled in: use the set that returned it"
    )]
    Foreign(AttachmentHandle),
}
