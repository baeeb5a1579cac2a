//! Ways between rigid bodies: their outlines drawn inwards and rounded, kept apart from each other.
//!
//! Rapier hands over bodies that overlap a little, and they go back to it. The rounding is where that overlap has its place: cores are
//! apart as long as it is not deeper, and are drawn further inwards where it is.

use super::candidates::{Bounds, Names};
use super::draft::{Draft, Guest, RigidSurface, swept};
use super::flex_cores::DOUBLINGS;
use super::outlines::Piece;
use super::ways::{REACH_OF_WIDTH, SOFT_SHARE};
use crate::constraint::contact::ContactLaw;
use crate::kkt::{Island, Way};
use crate::math::HashMap;
use crate::math::judged::Judged;
use crate::rapier::prelude::ColliderHandle;

/// Rounding of a rigid body's outline, relative to its width: what rapier leaves of boxes at rest in piles of thirty is one to five
/// hundredths of their size for each pair.
const ROUNDING: Judged = Judged::new("coupling::ROUNDING", 2e-2);

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
    /// By collider, name of their first point, and doublings of their rounding.
    known: HashMap<(ColliderHandle, u32, u8), Core>,
    draft: Draft,
}

/// By how much a core of this width (m) is drawn inwards, twice as far each time (m).
fn rounding(width: f64, doublings: u8) -> f64 {
    f64::from(1u32 << doublings) * ROUNDING.get() * width
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
        (0..=DOUBLINGS).any(|doublings| self.lead_rounded(way, doublings, island))
    }

    fn lead_rounded(&mut self, way: &RigidWay<'_>, doublings: u8, island: &mut Island) -> bool {
        let first = island.path.n_ways();
        let [one, other] = &way.surfaces;
        for (a, first_piece) in one.outline.named_pieces() {
            for (b, second_piece) in other.outline.named_pieces() {
                let sides = [(a, first_piece), (b, second_piece)];
                if !self.lead_pieces(way, sides, doublings, island) {
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
        sides: [(u32, &Piece); 2],
        doublings: u8,
        island: &mut Island,
    ) -> bool {
        // What has no size of its own is drawn as far as the other piece needs it.
        let is_round = |side: usize| matches!(sides[side].1, Piece::Convex { .. });
        let (own, other) = match [is_round(0), is_round(1)] {
            [true, _] => (0, 1),
            [false, true] => (1, 0),
            [false, false] => return false,
        };
        let bounds = |side: usize| bounds_of(sides[side].1, &way.surfaces[side], island);
        let loose = |bounds: Bounds| bounds.loosened(way.reach + way.turn * bounds.size());
        let Some(near) = bounds(own).map(loose) else {
            return false;
        };
        if is_round(other) && !bounds(other).is_some_and(|bounds| bounds.intersects(&near)) {
            return true;
        }
        if self.is_below(way, [own, other], sides, doublings, island) {
            return false;
        }
        let Some(core) = self.core(way, own, (sides[own], doublings), island) else {
            return false;
        };
        let met = if is_round(other) {
            self.core(way, other, (sides[other], doublings), island)
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
            places: (0, 0),
            closing: core.closing + met.closing + way.law.skin,
            margin: core.margin + met.margin,
            reach: REACH_OF_WIDTH * core.width.min(met.width),
        })
    }

    /// Whether the core of one piece would begin the step in a half-space, the other one: its boundary alone does not tell the sides apart.
    fn is_below(
        &mut self,
        way: &RigidWay<'_>,
        [own, other]: [usize; 2],
        sides: [(u32, &Piece); 2],
        doublings: u8,
        island: &Island,
    ) -> bool {
        let space = way.surfaces[other].boundary(sides[other].1, island);
        let surface = &way.surfaces[own];
        let (
            Some([origin, normal]),
            Some(motion),
            Piece::Convex {
                vertices,
                radius,
                width,
            },
        ) = (space, surface.motion(island), sides[own].1)
        else {
            return false;
        };
        self.draft
            .draw_core((vertices, *radius), surface, rounding(*width, doublings));
        let mut places = (self.draft.core_arms().iter()).map(|arm| motion.start().point(*arm));
        places.any(|place| normal.dot(&(place - origin)) <= 0.0)
    }

    /// The member of a convex piece, drawn when first asked for.
    fn core(
        &mut self,
        way: &RigidWay<'_>,
        side: usize,
        ((name, piece), doublings): ((u32, &Piece), u8),
        island: &mut Island,
    ) -> Option<Core> {
        let key = (way.handles[side], name, doublings);
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
        let least = rounding(*width, 0);
        let inwards = rounding(*width, doublings);
        let closing = self.draft.draw_core((vertices, *radius), surface, inwards);
        if closing <= 0.0 {
            return None;
        }
        let (margin, width) = if *radius > 0.0 || vertices.len() < 3 {
            (SOFT_SHARE.get() * radius, 2.0 * radius)
        } else {
            (closing.min(least), *width)
        };
        let member = self.draft.add_to(island, surface.block, name);
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
        (name, piece): (u32, &Piece),
        near: &Bounds,
        width: f64,
        island: &mut Island,
    ) -> Option<Core> {
        let guest = Guest {
            centre: near.middle(),
            size: near.size(),
            near: *near,
        };
        if !self.draft.draw_open(piece, surface, 0.0, &guest, island) {
            return None;
        }
        let member = self.draft.add_to(island, surface.block, name);
        Some(Core {
            member,
            closing: 0.0,
            margin: 0.0,
            width,
        })
    }
}

/// Box of a convex piece over the step.
fn bounds_of(piece: &Piece, surface: &RigidSurface<'_>, island: &Island) -> Option<Bounds> {
    let Piece::Convex {
        vertices, radius, ..
    } = piece
    else {
        return None;
    };
    let arms = vertices
        .iter()
        .map(|vertex| surface.offset.transform(*vertex));
    let bounds = swept(arms, surface.motion(island)?)?;
    Some(bounds.loosened(*radius))
}

#[cfg(test)]
mod tests;
