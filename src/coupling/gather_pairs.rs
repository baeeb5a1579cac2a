//! Gathering: the pairs of a component. Flexible surfaces are led along a path; what is shown to hooks, or overlaps to begin with, and
//! pairs of rigid bodies become candidates.

use super::candidates::{self, Names};
use super::claim::{ClaimedPair, Claims};
use super::filter::claimable_parent;
use super::gather::{GatherSettings, Gatherer, PlacedCollider};
use super::hooks::{HookBook, HookedPair};
use super::reading::{GatherError, at_rest, law_of, offset_of, owner_of};
use super::rigid_pairs::RigidPair;
use super::rigid_ways::RigidWay;
use super::sets::RapierSets;
use super::shapes::pose_of;
use super::ways::{self, RigidSurface};
use crate::constraint::contact::{ContactLaw, Owner};
use crate::constraint::geometry::Pose2;
use crate::kkt::Island;
use crate::rapier::prelude::*;
use crate::system::{Block, RigidBlock};

impl Gatherer {
    pub(super) fn add_pair(
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
                let mut law = law_of(sets.colliders, own.collider, collider)?;
                if settings.uses_path && !HookBook::asks([own.collider, collider], sets) {
                    let led = self.lead(
                        collider,
                        block,
                        (&placed, own.reach()),
                        (names, law),
                        sets,
                        island,
                    );
                    match led {
                        Ok(()) => return Ok(()),
                        Err(gap) => law.skin += gap,
                    }
                }
                let first = island.candidates.len();
                candidates::flex_rigid(
                    island,
                    block,
                    placed.block,
                    placed.parts.clone(),
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
                let mut law = law_of(sets.colliders, points_of.collider, surface_of.collider)?;
                let edge = points_of.edge.max(surface_of.edge) + 2.0 * law.skin;
                let colliders = [points_of.collider, surface_of.collider];
                if settings.uses_path && !HookBook::asks(colliders, sets) {
                    match ways::flex_flex(
                        island,
                        [points, surface],
                        names,
                        law,
                        &mut self.flex_cores,
                    ) {
                        Ok(()) => return Ok(()),
                        Err(gap) => law.skin += gap,
                    }
                }
                let first = island.candidates.len();
                candidates::flex_flex(island, points, surface, names, law, edge);
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
                let placed = [&first, &second];
                if settings.uses_path
                    && !HookBook::asks([one, other], sets)
                    && self.lead_rigid([one, other], placed, (names, law, settings), sets, island)
                {
                    return Ok(());
                }
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

    /// Keeps surfaces of the island apart from themselves, after all others; but for sensors, which touch nothing, and bodies of small strain:
    /// before these are bent so far that they meet themselves, they are no longer described.
    pub(super) fn add_own_pairs(
        &mut self,
        settings: &GatherSettings,
        sets: &RapierSets<'_>,
        claims: &Claims,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        self.crossed.clear();
        if !settings.uses_path {
            return Ok(());
        }
        island.path.begin_own();
        for (flex, own) in claims.flex.iter().enumerate() {
            let Some(block) = self.flex_block(flex) else {
                continue;
            };
            let collider = sets.colliders.get(own.collider);
            let is_large = matches!(&island.blocks[block], Block::Flex(body) if body.is_large());
            if !is_large || collider.is_none_or(Collider::is_sensor) {
                continue;
            }
            let law = law_of(sets.colliders, own.collider, own.collider)?;
            let owner = Owner::Flex(own.index);
            if !ways::flex_own(island, block, owner, law, &mut self.flex_cores) {
                self.crossed.push(own.index);
            }
        }
        Ok(())
    }

    /// Leads a flexible block along a path that keeps it apart from a collider; see [`ways::flex_rigid`].
    fn lead(
        &mut self,
        handle: ColliderHandle,
        flex: usize,
        (placed, reach): (&PlacedCollider, f64),
        (names, law): (Names, ContactLaw),
        sets: &RapierSets<'_>,
        island: &mut Island,
    ) -> Result<(), f64> {
        let Some(collider) = sets.colliders.get(handle) else {
            return Err(0.0);
        };
        let surface = RigidSurface {
            block: placed.block,
            outline: self.outlines.outline(handle, collider),
            offset: placed.offset,
        };
        let drawing = (&mut self.draft, &mut self.flex_cores);
        ways::flex_rigid(island, flex, &surface, names, law, reach, drawing)
    }

    /// Leads two rigid colliders along a path that keeps them apart; returns whether they are.
    fn lead_rigid(
        &mut self,
        handles: [ColliderHandle; 2],
        placed: [&PlacedCollider; 2],
        (names, law, settings): (Names, ContactLaw, &GatherSettings),
        sets: &RapierSets<'_>,
        island: &mut Island,
    ) -> bool {
        let [Block::Rigid(one), Block::Rigid(other)] =
            placed.map(|collider| &island.blocks[collider.block])
        else {
            return false;
        };
        let (reach, turn) = self.agitation.reach(
            [one, other],
            settings.prediction + settings.excess + law.skin,
        );
        for handle in handles {
            if let Some(collider) = sets.colliders.get(handle) {
                self.outlines.outline(handle, collider);
            }
        }
        let [Some(first), Some(second)] = handles.map(|handle| self.outlines.known(handle)) else {
            return false;
        };
        let outlines = [first, second];
        let surfaces = [0, 1].map(|side| RigidSurface {
            block: placed[side].block,
            outline: outlines[side],
            offset: placed[side].offset,
        });
        let way = RigidWay {
            handles,
            surfaces,
            names,
            law,
            reach,
            turn,
        };
        self.cores.lead(&way, island)
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
        let placed = PlacedCollider {
            block,
            parts,
            offset,
        };
        self.placed.insert(handle, placed.clone());
        Ok(Some(placed))
    }
}
