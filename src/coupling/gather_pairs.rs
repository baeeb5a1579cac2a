//! Gathering: the pairs of a component. Flexible surfaces are led along a path; what is shown to hooks, or overlaps to begin with, and
//! pairs of rigid bodies become candidates.

use super::candidates::{self, Names};
use super::claim::Claims;
use super::filter::claimable_parent;
use super::flex_cores::FlexCores;
use super::hooks::{HookBook, HookedPair};
use super::memory::Memory;
use super::outlines::OutlineCache;
use super::reading::{GatherError, at_rest, law_of, offset_of, owner_of};
use super::rigid_pairs::{Agitation, RigidPair};
use super::rigid_ways::{RigidCores, RigidWay};
use super::seats::OpenIsland;
use super::sets::RapierSets;
use super::shapes::{ShapeCache, pose_of};
use super::tangles;
use super::walk::ClaimedPair;
use super::ways::{self, Draft, RigidSurface};
use crate::constraint::contact::{ContactLaw, Owner};
use crate::constraint::geometry::Pose2;
use crate::kkt::Island;
use crate::math::{HashMap, rounding};
use crate::rapier::prelude::*;
use crate::system::{Block, RigidBlock};
use std::ops::Range;

/// Where a collider's parts are in the island being gathered.
#[derive(Clone, Debug)]
struct PlacedCollider {
    block: usize,
    parts: Range<usize>,
    offset: Pose2,
}

/// Adds pairs to islands; holds the converted shapes of colliders.
#[derive(Debug, Default)]
pub(super) struct PairGatherer {
    shapes: ShapeCache,
    outlines: OutlineCache,
    /// The island's.
    placed: HashMap<ColliderHandle, PlacedCollider>,
    cores: RigidCores,
    flex_cores: FlexCores,
    draft: Draft,
}

impl PairGatherer {
    /// Drops what belongs to removed colliders.
    pub fn retain(&mut self, colliders: &ColliderSet) {
        self.shapes.retain(colliders);
        self.outlines.retain(colliders);
    }

    /// Begins with an empty island.
    pub fn clear(&mut self) {
        self.placed.clear();
        self.cores.clear();
        self.flex_cores.clear();
    }

    /// Adds a pair, if it is one of the component's.
    pub fn add(
        &mut self,
        pair: ClaimedPair,
        claims: &Claims,
        agitation: &Agitation,
        memory: &mut Memory,
        open: &mut OpenIsland<'_, '_>,
    ) -> Result<(), GatherError> {
        let OpenIsland { settings, sets, .. } = *open;
        let component = settings.component;
        match pair {
            ClaimedPair::FlexRigid(flex, collider)
                if claims.component_of_flex(flex) == component =>
            {
                let own = claims.flex[flex];
                let Some(block) = open.seats.flex_block(flex) else {
                    return Ok(());
                };
                let Some(placed) = self.placed(collider, open)? else {
                    return Ok(());
                };
                let names = Names {
                    one: Owner::Flex(own.index),
                    other: owner_of(collider),
                };
                let mut law = law_of(sets.colliders, own.collider, collider)?;
                let asks = HookBook::asks([own.collider, collider], sets);
                let is_across = settings.uses_path && !asks;
                if is_across {
                    let led =
                        self.lead(collider, block, (&placed, own.reach()), (names, law), open);
                    match led {
                        Ok(()) => return Ok(()),
                        Err(gap) => law.skin += gap,
                    }
                }
                let island = &mut *open.island;
                let first = island.candidates.len();
                candidates::flex_rigid(
                    island,
                    block,
                    placed.block,
                    placed.parts.clone(),
                    names,
                    law,
                    own.edge + 2.0 * (own.fall + law.skin),
                );
                if is_across {
                    self.part(collider, block, (&placed, first), (names, law), open);
                }
                let colliders = [own.collider, collider];
                let is_plain = hook(colliders, names, first, &mut memory.hooks, open)?;
                let way = open.island.path.n_ways();
                if settings.uses_path && is_plain {
                    let led =
                        self.lead(collider, block, (&placed, own.reach()), (names, law), open);
                    if let Err(gap) = led {
                        law.skin += gap;
                        widen(open.island, first, gap);
                        self.part(collider, block, (&placed, first), (names, law), open);
                    } else {
                        open.island.candidates.truncate(first);
                        open.island.path.place_laws(way, &memory.hooks.laws);
                    }
                }
            }
            ClaimedPair::FlexFlex(one, other) if claims.component_of_flex(one) == component => {
                // The finer surface is the contactor; the first by place if they are equal.
                let is_finer =
                    claims.flex[other].edge < claims.flex[one].edge * (1.0 - rounding::SHARE);
                let (contactor, target) = if is_finer { (other, one) } else { (one, other) };
                let blocks = [contactor, target].map(|flex| open.seats.flex_block(flex));
                let [Some(points), Some(surface)] = blocks else {
                    return Ok(());
                };
                let (points_of, surface_of) = (claims.flex[contactor], claims.flex[target]);
                let names = Names {
                    one: Owner::Flex(points_of.index),
                    other: Owner::Flex(surface_of.index),
                };
                let mut law = law_of(sets.colliders, points_of.collider, surface_of.collider)?;
                let edge = points_of.edge.max(surface_of.edge);
                let edge = edge + 2.0 * (points_of.fall.max(surface_of.fall) + law.skin);
                let colliders = [points_of.collider, surface_of.collider];
                let is_across = settings.uses_path && !HookBook::asks(colliders, sets);
                if is_across {
                    match ways::flex_flex(
                        open.island,
                        [points, surface],
                        names,
                        law,
                        &mut self.flex_cores,
                    ) {
                        Ok(()) => return Ok(()),
                        Err(gap) => law.skin += gap,
                    }
                }
                let island = &mut *open.island;
                let first = island.candidates.len();
                candidates::flex_flex(island, points, surface, names, law, edge);
                if is_across {
                    tangles::flex_flex(island, first, [points, surface], names, law);
                }
                let is_plain = hook(colliders, names, first, &mut memory.hooks, open)?;
                let way = open.island.path.n_ways();
                if settings.uses_path && is_plain {
                    let (island, blocks) = (&mut *open.island, [points, surface]);
                    let led = ways::flex_flex(island, blocks, names, law, &mut self.flex_cores);
                    if let Err(gap) = led {
                        law.skin += gap;
                        widen(island, first, gap);
                        tangles::flex_flex(island, first, blocks, names, law);
                    } else {
                        island.candidates.truncate(first);
                        island.path.place_laws(way, &memory.hooks.laws);
                    }
                }
            }
            ClaimedPair::RigidRigid(one, other) => {
                if component_of_pair([one, other], sets, claims) != Some(component) {
                    return Ok(());
                }
                let Some(first) = self.placed(one, open)? else {
                    return Ok(());
                };
                let Some(second) = self.placed(other, open)? else {
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
                    && self.lead_rigid([one, other], placed, (names, law), agitation, open)
                {
                    return Ok(());
                }
                let blocks = [first.block, second.block];
                let parts = [first.parts, second.parts];
                let island = &mut *open.island;
                let first = island.candidates.len();
                let pair = RigidPair {
                    blocks,
                    parts,
                    names,
                    law,
                    prediction: settings.prediction + law.skin,
                    agitation,
                };
                pair.add_candidates(island, &mut memory.references);
                hook([one, other], names, first, &mut memory.hooks, open)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Keeps surfaces of the island apart from themselves, after all others; but for sensors, which touch nothing, and bodies of small strain:
    /// before these are bent so far that they meet themselves, they are no longer described.
    pub fn add_own(
        &mut self,
        claims: &Claims,
        open: &mut OpenIsland<'_, '_>,
    ) -> Result<(), GatherError> {
        let OpenIsland { settings, sets, .. } = *open;
        if !settings.uses_path {
            return Ok(());
        }
        open.island.path.begin_own();
        for (flex, own) in claims.flex.iter().enumerate() {
            let Some(block) = open.seats.flex_block(flex) else {
                continue;
            };
            let collider = sets.colliders.get(own.collider);
            let body = &open.island.blocks[block];
            let is_large = matches!(body, Block::Flex(body) if body.is_large());
            if !is_large || collider.is_none_or(Collider::is_sensor) {
                continue;
            }
            let law = law_of(sets.colliders, own.collider, own.collider)?;
            let owner = Owner::Flex(own.index);
            if !ways::flex_own(open.island, block, owner, law, &mut self.flex_cores) {
                open.seats.add_crossed(own.index);
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
        open: &mut OpenIsland<'_, '_>,
    ) -> Result<(), f64> {
        let Some(collider) = open.sets.colliders.get(handle) else {
            return Err(0.0);
        };
        let surface = RigidSurface {
            block: placed.block,
            outline: self.outlines.outline(handle, collider),
            offset: placed.offset,
        };
        let drawing = (&mut self.draft, &mut self.flex_cores);
        ways::flex_rigid(open.island, flex, &surface, names, law, reach, drawing)
    }

    /// Parts a flexible block and a collider that begin the step across each other; see [`tangles::flex_rigid`].
    fn part(
        &mut self,
        handle: ColliderHandle,
        flex: usize,
        (placed, first): (&PlacedCollider, usize),
        (names, law): (Names, ContactLaw),
        open: &mut OpenIsland<'_, '_>,
    ) {
        if let Some(outline) = self.outlines.known(handle) {
            let surface = RigidSurface {
                block: placed.block,
                outline,
                offset: placed.offset,
            };
            tangles::flex_rigid(open.island, first, flex, &surface, names, law);
        }
    }

    /// Leads two rigid colliders along a path that keeps them apart; returns whether they are.
    fn lead_rigid(
        &mut self,
        handles: [ColliderHandle; 2],
        placed: [&PlacedCollider; 2],
        (names, law): (Names, ContactLaw),
        agitation: &Agitation,
        open: &mut OpenIsland<'_, '_>,
    ) -> bool {
        let OpenIsland { settings, sets, .. } = *open;
        let [Block::Rigid(one), Block::Rigid(other)] =
            placed.map(|collider| &open.island.blocks[collider.block])
        else {
            return false;
        };
        let (reach, turn) = agitation.reach(
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
        self.cores.lead(&way, open.island)
    }

    /// The block and parts of a collider, added to the island when first met.
    fn placed(
        &mut self,
        handle: ColliderHandle,
        open: &mut OpenIsland<'_, '_>,
    ) -> Result<Option<PlacedCollider>, GatherError> {
        let sets = open.sets;
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
                let block = RigidBlock::prescribed(motion, motion);
                (open.add_rigid(block), Pose2::identity())
            }
            Some((parent, body)) => {
                let Some(block) = open.block_of(parent) else {
                    return Ok(None);
                };
                (block, offset_of(collider, body))
            }
        };
        let shape = self.shapes.parts(handle, collider);
        let shape = shape.map_err(|fault| GatherError::Shape(handle, fault))?;
        let parts = candidates::add_parts(open.island, shape, offset);
        let placed = PlacedCollider {
            block,
            parts,
            offset,
        };
        self.placed.insert(handle, placed.clone());
        Ok(Some(placed))
    }
}

/// Lets the candidates from the `first` on close farther off by so much (m).
fn widen(island: &mut Island, first: usize, gap: f64) {
    for candidate in &mut island.candidates[first..] {
        candidate.law.skin += gap;
    }
}

/// Shows the candidates from the `first` on to the user's hook; returns whether it leaves where they are all that may be met in the step.
fn hook(
    colliders: [ColliderHandle; 2],
    names: Names,
    first: usize,
    book: &mut HookBook,
    open: &mut OpenIsland<'_, '_>,
) -> Result<bool, GatherError> {
    let owners = [names.one, names.other];
    let pair = HookedPair { colliders, owners };
    book.modify(pair, first, (open.sets, open.settings.step.dt), open.island)
}

fn component_of_pair(
    pair: [ColliderHandle; 2],
    sets: &RapierSets<'_>,
    claims: &Claims,
) -> Option<usize> {
    pair.iter()
        .filter_map(|&handle| claimable_parent(sets, sets.colliders.get(handle)?))
        .find_map(|body| claims.component_of_rigid(body))
}
