//! Gathering: an island of blocks and candidates for every component of the claim.

use super::candidates::{self, Names};
use super::claim::{ClaimedPair, Claims};
use super::filter::claimable_parent;
use super::hooks::{HookBook, HookedPair};
use super::links::{LinkBlock, LinkBook};
use super::masters::{Masters, cap_speed};
use super::reading::{
    GatherError, at_rest, is_held_load, is_held_motion, law_of, load_of, offset_of, owner_of,
};
use super::references::References;
use super::rigid_pairs::{Agitation, RigidPair};
use super::sets::RapierSets;
use super::shapes::{ShapeCache, pose_of};
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
struct PlacedCollider {
    block: usize,
    parts: Range<usize>,
}

/// Builds islands; holds the rebuildable half of every flexible body and the converted shapes.
#[derive(Debug, Default)]
pub(crate) struct Gatherer {
    /// One per slot of the flexible set.
    pub(super) pool: Vec<Option<Box<FlexBlock>>>,
    shapes: ShapeCache,
    pub(super) references: References,
    placed: HashMap<ColliderHandle, PlacedCollider>,
    block_of_body: HashMap<RigidBodyHandle, usize>,
    flex_blocks: HashMap<usize, usize>,
    agitation: Agitation,
    /// Multipliers of joints in the last step.
    pub joint_memory: JointMemory,
    /// What the user's hooks said of the contacts gathered.
    pub hooks: HookBook,
    /// Claimed bodies of the island, by block.
    pub bodies: Vec<(usize, RigidBodyHandle)>,
    /// Links of multibodies in the island.
    pub links: Vec<LinkBlock>,
}

/// What all islands of a step have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherSettings {
    /// The component of the claim to gather.
    pub component: usize,
    /// Step length and weights.
    pub step: Step,
    /// Prediction distance of rapier (m).
    pub prediction: f64,
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
                let make = if is_explicit {
                    FlexBlock::explicit
                } else {
                    FlexBlock::new
                };
                Box::new(make(model, fixed, body.frame()))
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
        let load = FlexLoad {
            force: body.nodal_force(),
            gravity,
            prescribed: body.prescribed(),
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
        let (mut motion, acceleration) = masters.motion(handle, body, load.drive());
        cap_speed(&mut motion, body, sets.integration_parameters);
        if !is_held_motion(&motion) || !is_held_load(&load) {
            return Err(GatherError::RigidBody(handle));
        }
        let Step { dt, weights } = settings.step;
        let block = RigidBlock::free(motion, acceleration, &load, weights, dt);
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

    fn add_pair(
        &mut self,
        pair: ClaimedPair,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        claims: &mut Claims,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let component = settings.component;
        match pair {
            ClaimedPair::FlexRigid(flex, collider)
                if claims.component_of_flex(flex) == component =>
            {
                let own = claims.flex[flex];
                let Some(block) = self.flex_blocks.get(&flex).copied() else {
                    return Ok(());
                };
                let Some(placed) = self.place(collider, settings, sets, island)? else {
                    return Ok(());
                };
                let names = Names {
                    one: Owner::Flex(own.index),
                    other: owner_of(collider),
                };
                let law = law_of(sets.colliders, own.collider, collider)?;
                let first = island.candidates.len();
                candidates::flex_rigid(
                    island,
                    block,
                    placed.block,
                    placed.parts,
                    names,
                    law,
                    own.edge + 2.0 * law.skin,
                );
                self.hook([own.collider, collider], names, first, sets, island)?;
            }
            ClaimedPair::FlexFlex(one, other) if claims.component_of_flex(one) == component => {
                // The finer surface is the contactor; the first by place if they are equal.
                let is_finer = claims.flex[other].edge < claims.flex[one].edge * (1.0 - 1e-9);
                let (contactor, target) = if is_finer { (other, one) } else { (one, other) };
                let blocks = [contactor, target].map(|flex| self.flex_blocks.get(&flex).copied());
                let [Some(points), Some(surface)] = blocks else {
                    return Ok(());
                };
                let (points_of, surface_of) = (claims.flex[contactor], claims.flex[target]);
                let names = Names {
                    one: Owner::Flex(points_of.index),
                    other: Owner::Flex(surface_of.index),
                };
                let law = law_of(sets.colliders, points_of.collider, surface_of.collider)?;
                let edge = points_of.edge.max(surface_of.edge) + 2.0 * law.skin;
                let first = island.candidates.len();
                candidates::flex_flex(island, points, surface, names, law, edge);
                let colliders = [points_of.collider, surface_of.collider];
                self.hook(colliders, names, first, sets, island)?;
            }
            ClaimedPair::RigidRigid(one, other) => {
                if self.component_of_pair([one, other], sets, claims) != Some(component) {
                    return Ok(());
                }
                let Some(first) = self.place(one, settings, sets, island)? else {
                    return Ok(());
                };
                let Some(second) = self.place(other, settings, sets, island)? else {
                    return Ok(());
                };
                let names = Names {
                    one: owner_of(one),
                    other: owner_of(other),
                };
                let law = law_of(sets.colliders, one, other)?;
                let blocks = [first.block, second.block];
                let parts = [first.parts, second.parts];
                let first = island.candidates.len();
                let pair = RigidPair {
                    blocks,
                    parts,
                    names,
                    law,
                    prediction: settings.prediction + law.skin,
                    agitation: &self.agitation,
                };
                pair.add_candidates(island, &mut self.references);
                self.hook([one, other], names, first, sets, island)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Shows the candidates from the `first` on to the user's hook.
    fn hook(
        &mut self,
        colliders: [ColliderHandle; 2],
        names: Names,
        first: usize,
        sets: &RapierSets<'_>,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let owners = [names.one, names.other];
        let pair = HookedPair { colliders, owners };
        self.hooks.modify(pair, first, sets, island)
    }

    fn component_of_pair(
        &self,
        pair: [ColliderHandle; 2],
        sets: &RapierSets<'_>,
        claims: &mut Claims,
    ) -> Option<usize> {
        pair.iter()
            .filter_map(|&handle| claimable_parent(sets, sets.colliders.get(handle)?))
            .find_map(|body| claims.component_of_rigid(body))
    }

    /// The block and parts of a collider, added to the island when first met.
    fn place(
        &mut self,
        handle: ColliderHandle,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        island: &mut Island,
    ) -> Result<Option<PlacedCollider>, GatherError> {
        if let Some(placed) = self.placed.get(&handle) {
            return Ok(Some(placed.clone()));
        }
        let Some(collider) = sets.colliders.get(handle) else {
            return Ok(None);
        };
        let parent = collider
            .parent()
            .and_then(|parent| Some((parent, sets.bodies.get(parent)?)));
        let (block, offset) = match parent {
            None => {
                let pose = pose_of(collider.position());
                let motion = at_rest(&pose);
                (
                    self.push_rigid(RigidBlock::prescribed(motion, motion), None, island),
                    Pose2::identity(),
                )
            }
            Some((parent, body)) => {
                let Some(block) = self.block_of(parent, settings, sets, island) else {
                    return Ok(None);
                };
                (block, offset_of(collider, body))
            }
        };
        let shape = self.shapes.parts(handle, collider);
        let shape = shape.map_err(|fault| GatherError::Shape(handle, fault))?;
        let parts = candidates::add_parts(island, shape, offset);
        let placed = PlacedCollider { block, parts };
        self.placed.insert(handle, placed.clone());
        Ok(Some(placed))
    }
}
