//! Ways between rigid bodies: their outlines drawn inwards and rounded, kept apart from each other.
//!
//! Rapier hands over bodies that overlap a little, and they go back to it. The rounding is where that overlap has its place: cores are
//! apart as long as it is not deeper, and what is deeper is left to signed rows.

use super::candidates::{Bounds, Names};
use super::outlines::{Piece, draw_inwards};
use super::ways::{REACH_OF_WIDTH, RigidSurface};
use crate::constraint::contact::ContactLaw;
use crate::kkt::{Island, Way};
use crate::math::{Vec2, perp};
use crate::rapier::prelude::ColliderHandle;
use crate::system::{Block, RigidBlock};
use std::collections::HashMap;

/// Rounding of a rigid body's outline, relative to its width: what rapier leaves of boxes at rest in piles of thirty is one to five
/// hundredths of their size for each pair.
const ROUNDING: f64 = 2e-2;

/// Share of a ball's radius that the path may use up.
const SOFT_SHARE: f64 = 0.5;

/// A piece of a collider as a member of the path.
#[derive(Clone, Copy, Debug)]
struct Core {
    member: usize,
    /// Distance at which it closes, and the part of it that may be used up (m).
    closing: f64,
    margin: f64,
    width: f64,
}

/// Members of the rigid colliders of an island, with their buffers.
#[derive(Debug, Default)]
pub(super) struct RigidCores {
    known: HashMap<(ColliderHandle, usize), Core>,
    points: Vec<(u32, Vec2, Vec2)>,
    edges: Vec<[u32; 2]>,
    sharp: Vec<Vec2>,
    inset: Vec<Vec2>,
    place: Vec<u32>,
}

/// Two rigid colliders, how far around their swept boxes they may get (m), and by what they may turn (rad).
pub(super) struct RigidWay<'a> {
    pub handles: [ColliderHandle; 2],
    pub surfaces: [RigidSurface<'a>; 2],
    pub names: Names,
    pub law: ContactLaw,
    pub reach: f64,
    pub turn: f64,
}

impl RigidCores {
    /// Forgets the members of the last island.
    pub fn clear(&mut self) {
        self.known.clear();
    }

    /// Keeps two rigid colliders apart; returns whether they are to begin with, as far as their rounding goes. If not, nothing is added.
    pub fn lead(&mut self, way: &RigidWay<'_>, island: &mut Island) -> bool {
        let first = island.path.n_ways();
        let [one, other] = &way.surfaces;
        for (a, first_piece) in one.outline.pieces.iter().enumerate() {
            for (b, second_piece) in other.outline.pieces.iter().enumerate() {
                let sides = [(a, first_piece), (b, second_piece)];
                if !self.lead_pieces(way, sides, island) {
                    island.path.truncate(first);
                    return false;
                }
            }
        }
        true
    }

    fn lead_pieces(
        &mut self,
        way: &RigidWay<'_>,
        sides: [(usize, &Piece); 2],
        island: &mut Island,
    ) -> bool {
        // What has no size of its own is drawn as far as the other piece needs it.
        let is_round = |side: usize| matches!(sides[side].1, Piece::Convex { .. });
        let (own, other) = match [is_round(0), is_round(1)] {
            [true, _] => (0, 1),
            [false, true] => (1, 0),
            [false, false] => return false,
        };
        let bounds = |side: usize| swept(sides[side].1, &way.surfaces[side], island);
        let loose = |bounds: Bounds| bounds.loosened(way.reach + way.turn * bounds.size());
        let Some(near) = bounds(own).map(loose) else {
            return false;
        };
        if is_round(other) && !bounds(other).is_some_and(|bounds| bounds.intersects(&near)) {
            return true;
        }
        let Some(core) = self.core(way, own, sides[own], island) else {
            return false;
        };
        let met = if is_round(other) {
            self.core(way, other, sides[other], island)
        } else {
            match self.draw_open(
                &way.surfaces[other],
                sides[other],
                &near,
                core.width,
                island,
            ) {
                Some(met) => Some(met),
                None => return true,
            }
        };
        let Some(met) = met else {
            return false;
        };
        let mut members = [core.member, met.member];
        if own == 1 {
            members.swap(0, 1);
        }
        island.path.add_way(Way {
            members,
            owners: [way.names.one, way.names.other],
            law: way.law,
            closing: core.closing + met.closing + way.law.skin,
            margin: core.margin + met.margin,
            reach: REACH_OF_WIDTH * core.width.min(met.width),
        })
    }

    /// The member of a convex piece, drawn when first asked for.
    fn core(
        &mut self,
        way: &RigidWay<'_>,
        side: usize,
        (index, piece): (usize, &Piece),
        island: &mut Island,
    ) -> Option<Core> {
        let key = (way.handles[side], index);
        if let Some(core) = self.known.get(&key) {
            return Some(*core);
        }
        let Piece::Convex {
            vertices,
            radius,
            width,
        } = piece
        else {
            return None;
        };
        let surface = &way.surfaces[side];
        let n = vertices.len();
        self.sharp.clear();
        let arms = vertices
            .iter()
            .map(|vertex| surface.offset.transform(*vertex));
        self.sharp.extend(arms);
        let (closing, margin, width, round) = if *radius > 0.0 || n < 3 {
            self.inset.clone_from(&self.sharp);
            (*radius, SOFT_SHARE * radius, 2.0 * radius, 0.0)
        } else {
            let by = draw_inwards(&self.sharp, ROUNDING * width, &mut self.inset);
            (by, by, *width, by)
        };
        if closing <= 0.0 {
            return None;
        }
        self.points.clear();
        self.edges.clear();
        let pairs = self.inset.iter().zip(&self.sharp).enumerate();
        let named = pairs.map(|(name, (arm, sharp))| (name as u32, *arm, sharp - arm));
        self.points.extend(named);
        match n {
            1 => {}
            2 => self.edges.push([0, 1]),
            _ => self
                .edges
                .extend((0..n as u32).map(|a| [a, (a + 1) % n as u32])),
        }
        let name = (index as u32) << PIECE_BITS;
        let member = island.path.rigid_member(
            surface.block,
            &island.blocks,
            name,
            round,
            &self.points,
            &self.edges,
        );
        let core = Core {
            member,
            closing,
            margin,
            width,
        };
        self.known.insert(key, core);
        Some(core)
    }

    /// A member of what a piece without a core has near a box; `None` if that is nothing.
    fn draw_open(
        &mut self,
        surface: &RigidSurface<'_>,
        (index, piece): (usize, &Piece),
        near: &Bounds,
        width: f64,
        island: &mut Island,
    ) -> Option<Core> {
        self.points.clear();
        self.edges.clear();
        let Block::Rigid(motion) = &island.blocks[surface.block] else {
            return None;
        };
        let none = Vec2::zeros();
        match piece {
            Piece::HalfSpace { origin, normal } => {
                let (origin, normal) = (
                    surface.offset.transform(*origin),
                    surface.offset.rotate(*normal),
                );
                let along = perp(normal);
                let seen = motion.start().arm(near.middle());
                let foot = seen - normal * normal.dot(&(seen - origin));
                let far = FAR * near.size() * along;
                // Its material is on the left of the edge.
                self.points
                    .extend([(0, foot - far, none), (1, foot + far, none)]);
                self.edges.push([0, 1]);
            }
            Piece::Chain { points, edges } => {
                self.place.clear();
                self.place.resize(points.len(), u32::MAX);
                for edge in edges {
                    let arms = edge.map(|end| surface.offset.transform(points[end as usize]));
                    if !swept_arms(&arms, motion).is_some_and(|bounds| bounds.intersects(near)) {
                        continue;
                    }
                    let ends = [0, 1].map(|side| {
                        let place = &mut self.place[edge[side] as usize];
                        if *place == u32::MAX {
                            *place = self.points.len() as u32;
                            self.points.push((edge[side], arms[side], none));
                        }
                        *place
                    });
                    self.edges.push(ends);
                }
            }
            Piece::Convex { .. } => return None,
        }
        if self.edges.is_empty() {
            return None;
        }
        let name = (index as u32) << PIECE_BITS;
        let member = island.path.rigid_member(
            surface.block,
            &island.blocks,
            name,
            0.0,
            &self.points,
            &self.edges,
        );
        Some(Core {
            member,
            closing: 0.0,
            margin: 0.0,
            width,
        })
    }
}

/// Bits of a point's name that count within its piece.
const PIECE_BITS: u32 = 20;

/// Half the length of a half-space's boundary, relative to the body that it meets.
const FAR: f64 = 1e3;

fn swept(piece: &Piece, surface: &RigidSurface<'_>, island: &Island) -> Option<Bounds> {
    let (
        Piece::Convex {
            vertices, radius, ..
        },
        Block::Rigid(motion),
    ) = (piece, &island.blocks[surface.block])
    else {
        return None;
    };
    let arms = vertices
        .iter()
        .map(|vertex| surface.offset.transform(*vertex));
    let bounds = arms.filter_map(|arm| swept_arms(&[arm], motion));
    let bounds = bounds.reduce(Bounds::merged)?;
    Some(bounds.loosened(*radius))
}

fn swept_arms(arms: &[Vec2], motion: &RigidBlock) -> Option<Bounds> {
    let ends = [*motion.start(), motion.drift()];
    let places = arms.iter().flat_map(|arm| ends.map(|end| end.point(*arm)));
    places
        .map(|place| Bounds::of(&[place]))
        .reduce(Bounds::merged)
}
