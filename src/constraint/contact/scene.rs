//! Where contacts are measured: blocks, convex parts on them, and lists of boundary segments.

use crate::constraint::geometry::{ConvexPart, Pose2};
use crate::system::{Block, FlexBlock, RigidBlock};
use std::sync::Arc;

/// A convex part and where it sits on its body.
#[derive(Clone, Debug)]
pub struct PlacedPart {
    /// The part, in its own coordinates.
    pub part: Arc<ConvexPart>,
    /// Its pose in the body's axes about the centre of mass.
    pub pose: Pose2,
}

/// What the kinematics of an island's candidates look at.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The blocks, at their current iterate.
    pub blocks: &'a [Block],
    /// Convex parts of the rigid blocks.
    pub parts: &'a [PlacedPart],
    /// Lists of near segments.
    pub segments: &'a [u32],
}

pub(super) fn rigid_of<'a>(scene: &Scene<'a>, block: usize) -> Option<&'a RigidBlock> {
    match &scene.blocks[block] {
        Block::Rigid(rigid) => Some(rigid),
        Block::Flex(_) => None,
    }
}

pub(super) fn flex_of<'a>(scene: &Scene<'a>, block: usize) -> Option<&'a FlexBlock> {
    match &scene.blocks[block] {
        Block::Flex(flex) => Some(flex),
        Block::Rigid(_) => None,
    }
}
