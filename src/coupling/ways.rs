//! Ways: which surfaces of an island are kept apart along a feasible path, and at what distance they close.

use super::candidates::Names;
use super::draft::Guest;
pub(super) use super::draft::{Draft, RigidSurface};
use super::flex_cores::{FlexCore, FlexCores, FlexExtent, Inset};
use super::inset::KEPT;
use super::outlines::Piece;
use crate::body::OFFSET;
use crate::constraint::contact::{ContactLaw, Owner};
use crate::kkt::{Island, Way};
use crate::math::judged::Judged;
use crate::system::{Block, FlexBlock};

/// Reach of rows between rigid bodies, relative to the thinner one's width, and of a flexible body's, relative to its shortest edge: bodies are
/// kept apart from whatever is nearer. Between half of it and twice only the number of passes changes.
pub(super) const REACH_OF_WIDTH: Judged = Judged::new("coupling::REACH_OF_WIDTH", 0.1);

/// The same of a flexible body beyond the distance at which contact closes, relative to the margin, which is its offset.
fn reach_of_margin() -> f64 {
    REACH_OF_WIDTH / OFFSET.get()
}

/// Share of a round body's radius that the path may use up.
pub(super) const SOFT_SHARE: Judged = Judged::new("coupling::SOFT_SHARE", 0.5);

/// Part of a core's width that it may be drawn inwards for a flexible body: both sides together take what an edge may lose.
const MOST_INWARDS: Judged = KEPT.times(0.5);

/// Keeps a flexible block apart from the pieces of a rigid collider near it; `reach` is how far around its swept box it may get (m).
///
/// If they are not apart to begin with, drawn inwards as far as may be, nothing is added, and the distance at which they should come to
/// be is returned (m).
pub(super) fn flex_rigid(
    island: &mut Island,
    flex: usize,
    surface: &RigidSurface<'_>,
    names: Names,
    law: ContactLaw,
    reach: f64,
    (draft, cores): (&mut Draft, &mut FlexCores),
) -> Result<(), f64> {
    let Block::Flex(body) = &island.blocks[flex] else {
        return Err(0.0);
    };
    let FlexExtent { bounds, offset } = cores.extent(flex, body);
    if is_below(surface, body, offset, island) {
        return Err(0.0);
    }
    let guest = Guest {
        centre: body.centre(),
        size: body.size(),
        near: bounds.loosened(reach),
    };
    for length in std::iter::once(0.0).chain(Inset::all_of(offset)) {
        let inset = Inset {
            length,
            is_forced: true,
        };
        let Some(own) = cores.core(flex, inset, island) else {
            return Err(0.0);
        };
        if lead_pieces(island, own, surface, (names, law), offset, &guest, draft) {
            return Ok(());
        }
    }
    Err(surface.outline.gap(offset))
}

/// Keeps a flexible surface apart from the pieces of a rigid collider; returns whether they are to begin with. If not, nothing is added.
fn lead_pieces(
    island: &mut Island,
    own: FlexCore,
    surface: &RigidSurface<'_>,
    (names, law): (Names, ContactLaw),
    offset: f64,
    guest: &Guest,
    draft: &mut Draft,
) -> bool {
    let first = island.path.n_ways();
    for (name, piece) in surface.outline.named_pieces() {
        let Some(closing) = draw(draft, piece, surface, offset, guest, island) else {
            continue;
        };
        let other = draft.add_to(island, surface.block, name);
        let way = Way {
            members: [own.member, other],
            owners: [names.one, names.other],
            law,
            places: (0, 0),
            closing: closing.distance + own.round + law.skin,
            margin: closing.margin,
            reach: reach_of_margin() * closing.margin,
        };
        if !island.path.add_way(way) {
            island.path.truncate(first);
            return false;
        }
    }
    true
}

/// Whether a node has begun the step in a half-space: its boundary alone does not tell the sides apart.
fn is_below(surface: &RigidSurface<'_>, body: &FlexBlock, offset: f64, island: &Island) -> bool {
    let pieces = surface.outline.pieces.iter();
    let mut spaces = pieces.filter_map(|piece| surface.boundary(piece, island));
    spaces.any(|[origin, normal]| {
        let mut nodes = body.model().mesh().boundary().nodes().iter();
        nodes.any(|&node| normal.dot(&(body.start_position(node) - origin)) <= -offset)
    })
}

/// Keeps two flexible blocks apart. If they are not to begin with, drawn inwards as far as may be, the distance at which they should come
/// to be is returned (m).
pub(super) fn flex_flex(
    island: &mut Island,
    blocks: [usize; 2],
    names: Names,
    law: ContactLaw,
    cores: &mut FlexCores,
) -> Result<(), f64> {
    let mut offset = f64::INFINITY;
    for block in blocks {
        let Block::Flex(body) = &island.blocks[block] else {
            return Err(0.0);
        };
        offset = offset.min(cores.extent(block, body).offset);
    }
    // What has been folded or crushed within a step is not drawn inwards any more where it need not be, and would begin the rest of the step as
    // near as surfaces that touch are: no way leads on from there.
    let manners = [(false, true), (true, true), (false, false), (true, false)];
    for (is_forced, needs_room) in manners {
        let mut margin = f64::INFINITY;
        for length in Inset::all_of(offset) {
            let inset = Inset { length, is_forced };
            let [Some(one), Some(other)] = blocks.map(|block| cores.core(block, inset, island))
            else {
                return Err(0.0);
            };
            let closing = (one.round + other.round).max(offset);
            margin = margin.min(closing);
            let way = Way {
                members: [one.member, other.member],
                owners: [names.one, names.other],
                law,
                places: (0, 0),
                closing: closing + law.skin,
                margin,
                reach: reach_of_margin() * offset,
            };
            let is_added = match needs_room {
                true => island.path.add_roomy_way(way),
                false => island.path.add_way(way),
            };
            if is_added {
                return Ok(());
            }
        }
    }
    Err(0.0)
}

/// Keeps the surface of a flexible block apart from itself; returns whether it is to begin with.
///
/// It closes at the offset, or where it is nearer to itself at rest at half of that: what is at rest then touches nothing, and has half of the
/// way left that it may go.
pub(super) fn flex_own(
    island: &mut Island,
    block: usize,
    owner: Owner,
    law: ContactLaw,
    cores: &mut FlexCores,
) -> bool {
    // As it is drawn for rigid bodies, where it is.
    let inset = Inset {
        length: 0.0,
        is_forced: true,
    };
    let Some(core) = cores.core(block, inset, island) else {
        return false;
    };
    let Block::Flex(body) = &island.blocks[block] else {
        return false;
    };
    let (offset, clearance) = (cores.extent(block, body).offset, body.clearance());
    let closing = (offset + law.skin).min(0.5 * clearance);
    let margin = offset.min(closing);
    let way = Way {
        members: [core.member; 2],
        owners: [owner; 2],
        law,
        places: (0, 0),
        closing,
        margin,
        reach: reach_of_margin() * margin,
    };
    clearance > 0.0 && island.path.add_own_way(way, body, clearance)
}

/// Distance of cores at which a contact closes, and the part of it that the path may use up (m).
struct Closing {
    distance: f64,
    margin: f64,
}

/// Draws a piece that a flexible body meets at an offset (m); `None` if it is not near.
fn draw(
    draft: &mut Draft,
    piece: &Piece,
    surface: &RigidSurface<'_>,
    offset: f64,
    guest: &Guest,
    island: &Island,
) -> Option<Closing> {
    let Piece::Convex {
        vertices,
        radius,
        width,
    } = piece
    else {
        let is_near = draft.draw_open(piece, surface, offset, guest, island);
        return is_near.then_some(Closing {
            distance: offset,
            margin: offset,
        });
    };
    let inwards = offset.min(MOST_INWARDS.get() * width);
    let distance = draft.draw_core((vertices, *radius), surface, inwards);
    let bounds = draft.bounds(surface, island)?.loosened(distance);
    let is_near = bounds.intersects(&guest.near);
    let margin = if *radius > 0.0 || vertices.len() < 3 {
        offset.min(SOFT_SHARE.get() * radius)
    } else {
        distance
    };
    is_near.then_some(Closing { distance, margin })
}
