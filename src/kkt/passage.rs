//! Whether a solved step has led the middle of a member into or through another one.
//!
//! Contact points may be led astray where bodies move by several times their size, fold or turn about: the middle of a body
//! is never touched by what is solved right.

use super::island::{ActiveContact, Island};
use crate::constraint::contact::{
    Pair, PlacedPart, core_of, enters_surface, middle_of, pierces_surface,
};
use crate::constraint::geometry::{Path, passage_through};
use crate::math::Vec2;
use crate::system::{Block, RigidBlock};

/// Motion of two members against each other within the step, relative to the smaller, from which the way counts and not only
/// its end. The tests hold with half of this value and with twice.
const FAR: f64 = 0.03;

/// Motion of a vertex from which it may pierce a sheet, relative to the sheet's length.
const STIRRED: f64 = 1e-3;

/// Multiple of the way of what hits that no blow sends a light body on: a free one goes twice as far, the tip of a bar some times
/// more. The tests hold with half of this value and with twice.
const THROWN_FAR: f64 = 5.0;

/// Depth behind a surface from which a point has come through it, relative to the smaller flexible body.
const DEEP: f64 = 0.1;

impl Island {
    /// Whether the step leads through something or throws a body about: where members move by several times their size, gaps hold at
    /// places that no motion leads to.
    pub(super) fn is_astray(&self) -> bool {
        let has_left = |contact: &ActiveContact| self.has_left_behind(contact);
        self.contacts.iter().any(has_left) || self.is_thrown_far() || self.passes_through()
    }

    /// Whether the point of a contact that geometry has no gap for has gone deep behind what it met, in bodies that move by more than
    /// their size: then it has not slid to a neighbour but come through.
    fn has_left_behind(&self, contact: &ActiveContact) -> bool {
        let attachments = contact.kinematics.attachments().iter();
        let sizes = attachments.map(|grip| match &self.blocks[grip.block] {
            Block::Flex(block) => block.size(),
            Block::Rigid(_) => f64::INFINITY,
        });
        let size = sizes.fold(f64::INFINITY, f64::min);
        let way = contact.known.map_or(0.0, |(_, moved)| moved.norm());
        contact.is_lost && contact.gap() < -DEEP * size && way > size
    }

    /// Whether contact has thrown a flexible member farther than its size and than what hit it went.
    fn is_thrown_far(&self) -> bool {
        if self.contacts.is_empty() {
            return false;
        }
        let (mut before, mut excess) = (0.0f64, 0.0f64);
        for block in &self.blocks {
            match block {
                Block::Flex(block) => {
                    let [start, _] = block.fastest();
                    before = before.max(start * block.step_length()).max(block.size());
                    excess = excess.max(block.excess_motion() * block.size());
                }
                Block::Rigid(block) => {
                    before = before.max((block.drift().centre - block.start().centre).norm());
                }
            }
        }
        excess > THROWN_FAR * before
    }

    /// Whether a member has come into or through another by its middle. Only pairs that move far against each other are asked.
    pub(super) fn passes_through(&self) -> bool {
        let (mut asked, mut line, mut net) = (None, None, 0);
        for candidate in self.candidates.iter().filter(|one| !one.law.may_pass) {
            match candidate.pair {
                Pair::NodeOnPart { node, rigid, part } if asked != Some((node.0, part)) => {
                    asked = Some((node.0, part));
                    if line != Some((node.0, rigid)) {
                        if net != 0 {
                            return true;
                        }
                        line = Some((node.0, rigid));
                    }
                    let core = self.core(node.0);
                    let Some(passage) = self.passage(core, node.0, rigid, &self.parts[part]) else {
                        return true;
                    };
                    net += passage;
                }
                Pair::NodeOnSurface { node, flex, .. } if asked != Some((node.0, flex)) => {
                    asked = Some((node.0, flex));
                    let pair = [node.0, flex];
                    let paths = pair.map(|block| self.core(block));
                    if self.meet_by_their_middles(pair, paths) {
                        return true;
                    }
                }
                Pair::VertexOnSurface {
                    rigid,
                    arm,
                    radius: 0.0,
                    flex,
                    segments,
                    ..
                } => {
                    let listed = &self.segments[segments.0..segments.1];
                    if self.pierces(rigid, arm, flex, listed) {
                        return true;
                    }
                }
                _ => {}
            }
        }
        net != 0
    }

    /// Whether a sharp vertex has gone in on one side of a flexible member and out on another.
    fn pierces(&self, rigid: usize, arm: Vec2, flex: usize, listed: &[u32]) -> bool {
        let (Block::Rigid(motion), Block::Flex(body)) = (&self.blocks[rigid], &self.blocks[flex])
        else {
            return false;
        };
        let path = [motion.start().point(arm), motion.current().point(arm)];
        shift(path, core_of(body)) > STIRRED * body.size() && pierces_surface(body, listed, path)
    }

    fn core(&self, block: usize) -> Path {
        match &self.blocks[block] {
            Block::Flex(block) => core_of(block),
            Block::Rigid(block) => [block.start().centre, block.current().centre],
        }
    }

    /// How the middle of a flexible member has passed through a part; `None` if the part has passed into the member.
    fn passage(&self, core: Path, flex: usize, rigid: usize, placed: &PlacedPart) -> Option<i32> {
        let (Block::Flex(body), Block::Rigid(motion)) = (&self.blocks[flex], &self.blocks[rigid])
        else {
            return Some(0);
        };
        if let Some(middle) = middle_of(motion, placed) {
            let is_far = shift(core, middle) > FAR * placed.part.size().min(body.size());
            if is_far && enters_surface(body, middle) {
                return None;
            }
        }
        let seen = seen_from(motion, placed, core);
        let is_far = (seen[1] - seen[0]).norm() > FAR * body.size();
        Some(if is_far {
            passage_through(&placed.part, seen)
        } else {
            0
        })
    }

    fn meet_by_their_middles(&self, pair: [usize; 2], paths: [Path; 2]) -> bool {
        let [Block::Flex(one), Block::Flex(other)] = pair.map(|block| &self.blocks[block]) else {
            return false;
        };
        let is_far = shift(paths[0], paths[1]) > FAR * one.size().min(other.size());
        is_far && (enters_surface(other, paths[0]) || enters_surface(one, paths[1]))
    }
}

/// Motion of one point against another (m).
fn shift(one: Path, other: Path) -> f64 {
    ((one[1] - one[0]) - (other[1] - other[0])).norm()
}

/// The path of a point in the coordinates of a part.
fn seen_from(motion: &RigidBlock, placed: &PlacedPart, [start, end]: Path) -> Path {
    let arms = [motion.start().arm(start), motion.current().arm(end)];
    arms.map(|arm| placed.pose.inverse_transform(arm))
}
