//! Gathering: an island of blocks and candidates for every component of the claim.

use super::claim::Claims;
use super::flex_cores::FlexCores;
use super::hooks::HookBook;
use super::links::{LinkBlock, LinkBook};
use super::masters::{Masters, cap_speed};
use super::outlines::OutlineCache;
use super::reading::{GatherError, is_held_load, is_held_motion, load_of};
use super::references::References;
use super::rigid_pairs::Agitation;
use super::rigid_ways::RigidCores;
use super::sets::RapierSets;
use super::shapes::ShapeCache;
use super::under_way::{Span, UnderWay};
use super::ways::Draft;
use crate::body::FlexBodySet;
use crate::constraint::contact::Owner;
use crate::constraint::geometry::Pose2;
use crate::constraint::joint::JointMemory;
use crate::kkt::Island;
use crate::math::{Vec2, from_rapier};
use crate::rapier::prelude::*;
use crate::system::{Block, FlexBlock, FlexLoad, RigidBlock, Step};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Where a collider's parts are in the island being gathered.
#[derive(Clone, Debug)]
pub(super) struct PlacedCollider {
    pub(super) block: usize,
    pub(super) parts: Range<usize>,
    pub(super) offset: Pose2,
}

/// Builds islands; holds the rebuildable half of every flexible body and the converted shapes.
#[derive(Debug, Default)]
pub(crate) struct Gatherer {
    /// One per slot of the flexible set.
    pub(super) pool: Vec<Option<Box<FlexBlock>>>,
    pub(super) shapes: ShapeCache,
    pub(super) outlines: OutlineCache,
    pub(super) draft: Draft,
    pub(super) cores: RigidCores,
    pub(super) flex_cores: FlexCores,
    pub(super) references: References,
    pub(super) placed: HashMap<ColliderHandle, PlacedCollider>,
    block_of_body: HashMap<RigidBodyHandle, usize>,
    pub(super) flex_blocks: HashMap<usize, usize>,
    pub(super) agitation: Agitation,
    /// Where members are between two parts of a step.
    pub under_way: UnderWay,
    /// Multipliers of joints in the last step.
    pub joint_memory: JointMemory,
    /// What the user's hooks said of the contacts gathered.
    pub hooks: HookBook,
    /// Claimed bodies of the island, by block.
    pub bodies: Vec<(usize, RigidBodyHandle)>,
    /// Links of multibodies in the island.
    pub links: Vec<LinkBlock>,
    /// Flexible bodies of the island whose surfaces cross themselves where the step begins.
    pub crossed: Vec<u32>,
}

/// What all islands of a step have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherSettings {
    /// The component of the claim to gather.
    pub component: usize,
    /// Step length and weights, those of the part that is solved.
    pub step: Step,
    /// Which part of the step it is.
    pub span: Span,
    /// Prediction distance of rapier (m).
    pub prediction: f64,
    /// By how much members have left the boxes they were looked for in (m).
    pub excess: f64,
    /// Whether flexible surfaces are led along a feasible path.
    pub uses_path: bool,
}

impl Gatherer {
    /// The number of numeric factorizations of a body so far.
    pub fn n_factorizations(&self) -> u64 {
        self.pool
            .iter()
            .flatten()
            .map(|block| block.n_factorizations())
            .sum()
    }

    /// Keeps the reference faces noted since the last call, or with `false` throws them away.
    pub fn turn_over(&mut self, keeps: bool) {
        if keeps {
            self.references.turn_over();
            self.joint_memory.turn_over();
            self.hooks.turn_over();
        } else {
            self.references.discard_notes();
            self.joint_memory.discard_notes();
            self.hooks.begin();
        }
    }

    /// Keeps the reference faces of owners that sleep.
    pub fn keep(&mut self, sleeps: impl Fn(Owner) -> bool) {
        self.references.keep(sleeps);
    }

    /// The rebuildable half of a body, if it took part in a step.
    pub fn block(&self, index: u32) -> Option<&FlexBlock> {
        self.pool.get(index as usize)?.as_deref()
    }

    /// Drops what belongs to removed bodies and colliders.
    pub fn retain(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        for (index, slot) in self.pool.iter_mut().enumerate() {
            let lives = flex_bodies.at_index(index as u32).is_some_and(|(_, body)| {
                slot.as_ref()
                    .is_some_and(|block| Arc::ptr_eq(block.model(), body.model()))
            });
            if !lives {
                *slot = None;
            }
        }
        self.shapes.retain(sets.colliders);
        self.outlines.retain(sets.colliders);
    }

    /// Fills `island` with one component.
    ///
    /// # Errors
    /// If an effective matrix is not positive definite or a rigid body is not finite. The blocks taken are then lost and
    /// will be built anew.
    pub fn gather(
        &mut self,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        claims: &mut Claims,
        (masters, book): (&Masters, &LinkBook),
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let component = settings.component;
        island.clear();
        self.placed.clear();
        self.cores.clear();
        self.flex_cores.clear();
        self.block_of_body.clear();
        self.flex_blocks.clear();
        self.bodies.clear();
        self.links.clear();
        for flex in 0..claims.flex.len() {
            if claims.component_of_flex(flex) == component {
                self.add_flex(flex, settings, sets, flex_bodies, claims, island)?;
            }
        }
        for index in 0..claims.rigid.len() {
            let handle = claims.rigid[index];
            if claims.component_of_rigid(handle) == Some(component) {
                self.add_claimed(handle, settings, sets, masters, island)?;
            }
        }
        self.agitation = Agitation::of(&island.blocks);
        for slot in 0..claims.pairs.len() {
            let pair = claims.pairs[slot];
            self.add_pair(pair, settings, sets, claims, island)?;
        }
        self.add_own_pairs(settings, sets, claims, island)?;
        self.add_joints(settings, sets, flex_bodies, claims, island)?;
        self.finish_links(settings, book, sets, island)
    }

    /// Puts the flexible blocks of a solved island back into the pool.
    pub fn give_back(&mut self, island: &mut Island) {
        for (block, index) in island.blocks.drain(..).zip(&island.flex_index) {
            if let (Block::Flex(block), Some(index)) = (block, index) {
                self.pool[*index as usize] = Some(block);
            }
        }
        island.flex_index.clear();
    }

    fn add_flex(
        &mut self,
        flex: usize,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        claims: &Claims,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let index = claims.flex[flex].index;
        let Some(handle) = flex_bodies.at_index(index).map(|(handle, _)| handle) else {
            return Ok(());
        };
        let Some(body) = flex_bodies.at_index_mut(index) else {
            return Ok(());
        };
        let slot = index as usize;
        if self.pool.len() <= slot {
            self.pool.resize_with(slot + 1, || None);
        }
        let lives = self.pool[slot]
            .as_ref()
            .is_some_and(|block| Arc::ptr_eq(block.model(), body.model()));
        let is_explicit = settings.step.is_explicit();
        let kept = self.pool[slot].take();
        let mut block = match kept.filter(|block| lives && block.is_explicit() == is_explicit) {
            Some(block) => block,
            None => {
                let (model, fixed) = (Arc::clone(body.model()), body.fixed_dofs().to_vec());
                Box::new(match body.large() {
                    Some(large) => FlexBlock::large(model, Arc::clone(large), fixed, body.frame()),
                    None if is_explicit => FlexBlock::explicit(model, fixed, body.frame()),
                    None => FlexBlock::new(model, fixed, body.frame()),
                })
            }
        };
        let own: Vec2 = body.body_force().into();
        let gravity = body.gravity_scale() * from_rapier(sets.gravity) + own;
        let mut outcome = Ok(());
        if !body.is_started() {
            body.start_with(|state, force, prescribed, reaction| {
                outcome = block.start(
                    settings.step,
                    state,
                    &FlexLoad {
                        force,
                        gravity,
                        prescribed,
                        reaction,
                    },
                );
                outcome.is_ok()
            });
        }
        let rest = body.model().rest_positions();
        let pins = self
            .under_way
            .pins(index, settings.span, rest, body.prescribed());
        let load = FlexLoad {
            force: body.nodal_force(),
            gravity,
            prescribed: pins.as_deref().unwrap_or(body.prescribed()),
            reaction: body.reactions(),
        };
        let outcome = outcome.and_then(|()| block.predict(settings.step, body.state(), &load));
        island.blocks.push(Block::Flex(block));
        island.flex_index.push(Some(index));
        self.flex_blocks.insert(flex, island.blocks.len() - 1);
        outcome.map_err(|source| GatherError::Factorization {
            body: handle,
            source,
        })
    }

    fn add_claimed(
        &mut self,
        handle: RigidBodyHandle,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        masters: &Masters,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let Some(body) = sets.bodies.get(handle) else {
            return Ok(());
        };
        let load = load_of(body, from_rapier(sets.gravity));
        let (mut motion, acceleration) = match self.under_way.rigid(handle) {
            Some(known) => known,
            None => masters.motion(handle, body, load.drive()),
        };
        cap_speed(&mut motion, body, sets.integration_parameters);
        if !is_held_motion(&motion) || !is_held_load(&load) {
            return Err(GatherError::RigidBody(handle));
        }
        let block = RigidBlock::free(motion, acceleration, &load, &settings.step);
        self.push_rigid(block, Some(handle), island);
        self.bodies.push((island.blocks.len() - 1, handle));
        Ok(())
    }

    /// The block of a rigid body that is in the island already.
    pub(super) fn known_block(&self, handle: RigidBodyHandle) -> Option<usize> {
        self.block_of_body.get(&handle).copied()
    }

    /// The block of a claimed flexible body.
    pub(super) fn flex_block(&self, flex: usize) -> Option<usize> {
        self.flex_blocks.get(&flex).copied()
    }

    pub(super) fn push_rigid(
        &mut self,
        block: RigidBlock,
        handle: Option<RigidBodyHandle>,
        island: &mut Island,
    ) -> usize {
        let is_link = block.link_response().is_some();
        island.blocks.push(Block::Rigid(block));
        island.flex_index.push(None);
        let index = island.blocks.len() - 1;
        if let Some(handle) = handle {
            self.block_of_body.insert(handle, index);
            if is_link {
                self.links.push(LinkBlock {
                    block: index,
                    handle,
                });
            }
        }
        index
    }
}
