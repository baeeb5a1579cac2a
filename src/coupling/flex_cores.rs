//! Surfaces of flexible bodies as members of the path: where they are, or drawn inwards.
//!
//! Two flexible bodies meet by their surfaces drawn inwards and rounded by as much: bodies laid flush on each other touch, and cores are
//! apart. Drawn further inwards they have room for an overlap. What has been crushed until there is no room for this stays where it is. By
//! how much a surface can be drawn inwards is told by the body at rest, whatever has crushed it since; which way each vertex goes, by the
//! surface where the step begins.

use super::candidates::Bounds;
use super::inset::{KEPT, inwards, most_inwards};
use crate::body::contact_offset;
use crate::kkt::Island;
use crate::math::{HashMap, Vec2, judged::Judged, node_vec, perp, rotation};
use crate::system::{Block, FlexBlock};

/// How much farther than at rest a vertex may go inwards, relative to the edges beside it, until these count as folded: a straight surface by
/// 96°.
const FOLDED: Judged = Judged::new("coupling::FOLDED", 1.5);

/// Share of an edge that drawing inwards may take where it has been crushed: twice as much as at rest.
const LEFT: Judged = KEPT.times(2.0);

/// How often a rounding is doubled for a pair that overlaps by more than both have: up to a third of the width of rigid bodies that are as
/// wide as each other, a sixth of a cell. What is deeper is left to signed rows.
pub(super) const DOUBLINGS: u8 = 3;

/// How a surface is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inset {
    /// Up to this far inwards (m).
    pub length: f64,
    /// Also where edges have been folded or crushed; they then lie less far inwards. If not, what has such edges stays where it is.
    pub is_forced: bool,
}

impl Inset {
    /// An offset (m), doubled up to [`DOUBLINGS`] times.
    pub fn all_of(offset: f64) -> impl Iterator<Item = f64> {
        (0..=DOUBLINGS).map(move |doublings| f64::from(1u32 << doublings) * offset)
    }
}

/// The surface of a flexible block on the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlexCore {
    pub member: usize,
    /// By how much it is drawn inwards and rounded (m).
    pub round: f64,
}

/// What all pairs of a flexible body ask for.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlexExtent {
    /// Box of its surface over the step.
    pub bounds: Bounds,
    /// Offset of its surface (m).
    pub offset: f64,
}

/// Members of the flexible blocks of an island, with their buffers.
#[derive(Debug, Default)]
pub(super) struct FlexCores {
    /// By block, and how it was drawn.
    known: HashMap<(usize, u64, bool), FlexCore>,
    /// By block.
    extents: HashMap<usize, FlexExtent>,
    ring: Vec<Vec2>,
    corners: Vec<Vec2>,
}

impl FlexCores {
    /// Forgets the members of the last island.
    pub fn clear(&mut self) {
        self.known.clear();
        self.extents.clear();
    }

    /// What is asked of a body for every pair, found when first asked for.
    pub fn extent(&mut self, block: usize, body: &FlexBlock) -> FlexExtent {
        let extent = self.extents.entry(block);
        *extent.or_insert_with(|| FlexExtent {
            bounds: bounds_of(body),
            offset: contact_offset(body.model(), body.extent()),
        })
    }

    /// The surface of a block, drawn when first asked for.
    pub fn core(&mut self, block: usize, inset: Inset, island: &mut Island) -> Option<FlexCore> {
        let key = (block, inset.length.to_bits(), inset.is_forced);
        if let Some(core) = self.known.get(&key) {
            return Some(*core);
        }
        let Block::Flex(body) = &island.blocks[block] else {
            return None;
        };
        self.corners.clear();
        let round = if inset.length > 0.0 {
            self.draw(body, inset)
        } else {
            0.0
        };
        if round <= 0.0 {
            self.corners.clear();
        }
        let member = island.path.flex_member(block, body, round, &self.corners);
        let core = FlexCore { member, round };
        self.known.insert(key, core);
        Some(core)
    }

    /// Draws a surface inwards; returns by how much (m).
    fn draw(&mut self, body: &FlexBlock, inset: Inset) -> f64 {
        let boundary = body.model().mesh().boundary();
        let rest = body.model().placed_positions();
        self.ring.clear();
        let mut round = inset.length;
        for own in boundary.loops() {
            let first = self.ring.len();
            let places = own.nodes().iter().map(|&node| node_vec(rest, node));
            self.ring.extend(places);
            round = round.min(most_inwards(&self.ring[first..], inset.length));
        }
        let start = |slot: usize| body.start_position(boundary.nodes()[slot]);
        for own in boundary.loops() {
            let ring = &self.ring[own.segments()];
            for slot in own.segments() {
                let [before, after] =
                    [boundary.previous_segment(slot), boundary.next_segment(slot)];
                let at_rest = inwards(ring, slot - own.segments().start);
                let (now, is_folded) = inwards_now([before, slot, after].map(start), at_rest);
                if is_folded && !inset.is_forced {
                    return 0.0;
                }
                self.corners.push(-round * now);
            }
        }
        let is_kept = |slot: usize| {
            let next = boundary.next_segment(slot);
            let along = start(next) - start(slot);
            let taken = self.corners[next] - self.corners[slot];
            taken.dot(&along) <= LEFT * along.norm_squared()
        };
        if !inset.is_forced && !(0..self.corners.len()).all(is_kept) {
            return 0.0;
        }
        let back = rotation(-body.start_frame().angle);
        for corner in &mut self.corners {
            *corner = back * *corner;
        }
        round
    }
}

/// How a vertex between two others moves when both its edges move inwards by one, and whether they are folded: then it moves less far, or as
/// it would at rest if they lie on each other.
fn inwards_now([before, own, after]: [Vec2; 3], at_rest: Vec2) -> (Vec2, bool) {
    let normals = [own - before, after - own].map(|along| perp(along) / along.norm());
    let sum = normals[0] + normals[1];
    let (far, most) = (2.0 / sum.norm(), FOLDED * at_rest.norm());
    let now = far.min(most) / sum.norm() * sum;
    if now.x.is_finite() && now.y.is_finite() {
        (now, far > most)
    } else {
        (at_rest, true)
    }
}

/// Box of a surface over the step.
fn bounds_of(body: &FlexBlock) -> Bounds {
    let nodes = body.model().mesh().boundary().nodes().iter();
    let ends = nodes.map(|&node| Bounds::of(&[body.start_position(node), body.drift(node)]));
    let none = Bounds::of(&[body.centre()]);
    ends.reduce(Bounds::merged).unwrap_or(none)
}
