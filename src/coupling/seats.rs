//! Seats: which block of an island a body is.

use super::gather_settings::GatherSettings;
use super::reading::prescribed_block;
use super::sets::RapierSets;
use crate::body::KeptForce;
use crate::kkt::{Island, LeftOnDriven, left_on_driven};
use crate::math::HashMap;
use crate::rapier::prelude::*;
use crate::system::{Block, FlexBlock, RigidBlock};

/// The members of the island that is gathered, or was gathered last.
#[derive(Debug, Default)]
pub(crate) struct Seats {
    /// Blocks of flexible bodies, by their slots in the roster.
    flex: HashMap<usize, usize>,
    /// Blocks of rigid bodies, claimed or not.
    rigid: HashMap<RigidBodyHandle, usize>,
    claimed: Vec<(usize, RigidBodyHandle)>,
    /// Those that move as rapier says.
    driven: Vec<(usize, RigidBodyHandle)>,
    /// Flexible bodies whose surfaces cross themselves where the step begins, by their slots in the set.
    crossed: Vec<u32>,
}

impl Seats {
    /// Begins with an empty island.
    pub fn clear(&mut self) {
        self.flex.clear();
        self.rigid.clear();
        self.claimed.clear();
        self.driven.clear();
        self.crossed.clear();
    }

    /// Claimed rigid bodies, with their blocks.
    pub fn claimed(&self) -> &[(usize, RigidBodyHandle)] {
        &self.claimed
    }

    /// Adds what the flexible bodies of a solved island keep of their forces on rapier's bodies that move as they must, by the index of each.
    pub fn add_kept_forces(&self, island: &Island, all: &mut Vec<(u32, KeptForce)>) {
        for left in left_on_driven(island) {
            let LeftOnDriven {
                flex,
                block,
                wrench,
            } = left;
            let mut bodies = self.driven.iter().chain(&self.claimed);
            let Some(&(_, on)) = bodies.find(|(own, _)| *own == block) else {
                continue;
            };
            let pair = |one: &&mut (u32, KeptForce)| one.0 == flex && one.1.on == on;
            match all.iter_mut().rev().find(pair) {
                Some((_, known)) => {
                    let sum = known.wrench.iter_mut().zip(wrench);
                    sum.for_each(|(sum, part)| *sum += part);
                }
                None => all.push((flex, KeptForce { on, wrench })),
            }
        }
    }

    /// Flexible bodies whose surfaces cross themselves where the step begins, by their slots in the set.
    pub fn crossed(&self) -> &[u32] {
        &self.crossed
    }

    /// Notes that the surface of a flexible body crosses itself.
    pub fn add_crossed(&mut self, index: u32) {
        self.crossed.push(index);
    }

    /// The block of a claimed flexible body.
    pub fn flex_block(&self, flex: usize) -> Option<usize> {
        self.flex.get(&flex).copied()
    }

    /// Adds a flexible body, with the energy that contact may give back to it (J): by its slot in the roster and its index in the set.
    pub fn add_flex(
        &mut self,
        (flex, index): (usize, u32),
        (block, reserve): (Box<FlexBlock>, f64),
        island: &mut Island,
    ) {
        island.blocks.push(Block::Flex(block));
        island.flex_index.push(Some(index));
        island.reserves.push(reserve);
        self.flex.insert(flex, island.blocks.len() - 1);
    }

    /// Adds a claimed rigid body.
    pub fn add_claimed(&mut self, handle: RigidBodyHandle, block: RigidBlock, island: &mut Island) {
        let block = self.add_rigid(block, Some(handle), island);
        self.claimed.push((block, handle));
    }

    /// Adds what moves as a rigid body: one of rapier's, or what has no body. Returns its block.
    fn add_rigid(
        &mut self,
        block: RigidBlock,
        handle: Option<RigidBodyHandle>,
        island: &mut Island,
    ) -> usize {
        island.blocks.push(Block::Rigid(block));
        island.flex_index.push(None);
        island.reserves.push(0.0);
        let index = island.blocks.len() - 1;
        if let Some(handle) = handle {
            self.rigid.insert(handle, index);
        }
        index
    }
}

/// An island that is being filled.
pub(super) struct OpenIsland<'a, 'r> {
    pub settings: &'a GatherSettings,
    pub sets: &'a RapierSets<'r>,
    pub seats: &'a mut Seats,
    pub island: &'a mut Island,
}

impl OpenIsland<'_, '_> {
    /// The block of a rigid body: its own if it is claimed, or one that moves as rapier says, added when first asked for.
    pub fn block_of(&mut self, handle: RigidBodyHandle) -> Option<usize> {
        if let Some(&block) = self.seats.rigid.get(&handle) {
            return Some(block);
        }
        let span = self.settings.span;
        let is_link = self.sets.multibody_joints.rigid_body_link(handle).is_some();
        let body = self.sets.bodies.get(handle)?;
        let parameters = self.sets.integration_parameters;
        let block = prescribed_block(body, is_link, parameters, span);
        let block = self.seats.add_rigid(block, Some(handle), self.island);
        if !body.is_fixed() {
            self.seats.driven.push((block, handle));
        }
        Some(block)
    }

    /// Adds what moves as a rigid body and is none of rapier's; returns its block.
    pub fn add_rigid(&mut self, block: RigidBlock) -> usize {
        self.seats.add_rigid(block, None, self.island)
    }
}
