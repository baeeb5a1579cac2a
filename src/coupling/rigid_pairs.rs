//! Candidates between the parts of two rigid bodies.
//!
//! What moves little within the step touches at its end where it faced the other at its beginning: up to two points of a pair
//! against one face. Boxes that turn or meet fast bring other corners down, by their own spin or by that of the impact: then
//! every vertex is a candidate against the whole other part.

use super::candidates::{Names, part_bounds, world_pose};
use super::references::References;
use crate::constraint::contact::{Candidate, ContactKey, ContactLaw, Pair};
use crate::constraint::geometry::{FaceOrVertex, PairContacts, Pose2, RESTING, polygon_pair};
use crate::kkt::Island;
use crate::math::{Vec2, judged::Judged};
use crate::system::{Block, RigidBlock};

/// Motion within the step, relative to the smaller part's size, from which other features may meet than faced each other.
/// The tests hold from 0.7 to 1.4 times this value; at half, a heavy box on two light ones needs a linearised step, and at twice,
/// bodies jam in more than a tenth of the steps of a random world.
const FAR: Judged = Judged::new("coupling::FAR", 0.05);

/// Multiple of the motion before an impact that a corner may make after it: its own, and that of the other end of a free bar, which a blow
/// on one end moves twice as fast.
const THROW: f64 = 1.0 + 2.0;

/// Turn within the step (rad), and slope of one face to the other, up to which faces meet flat: both ends of a face then rest on the
/// other, their own two points say all, and the corners of equal boxes need not be told apart.
const FLAT: Judged = RESTING;

/// Stands for the face in the key of a vertex that may meet any.
const ANY_FACE: u32 = 0x7fff << 15;

/// How far the members of an island move against each other in the step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Agitation {
    /// Largest difference of two members' motions (m).
    shift: f64,
    /// Largest turn (rad).
    turn: f64,
}

impl Agitation {
    /// Of the free members.
    pub fn of(blocks: &[Block]) -> Self {
        let (mut low, mut high) = (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY));
        let mut turn = 0.0f64;
        for block in blocks {
            let shift = match block {
                Block::Flex(block) => {
                    let node = block.model().mesh().boundary().nodes()[0];
                    block.drift(node) - block.start_position(node)
                }
                Block::Rigid(block) => {
                    turn = turn.max(turn_of(block).abs());
                    block.drift().centre - block.start().centre
                }
            };
            (low, high) = (low.inf(&shift), high.sup(&shift));
        }
        let shift = if blocks.is_empty() {
            0.0
        } else {
            (high - low).norm()
        };
        Self { shift, turn }
    }

    /// How far around their swept boxes two bodies may get within the step (m), and by what they may turn (rad).
    pub fn reach(&self, [one, other]: [&RigidBlock; 2], prediction: f64) -> (f64, f64) {
        let turn = self.turn + (turn_of(one) - turn_of(other)).abs();
        let moved = self.shift + relative_motion([one, other]);
        (prediction + THROW * moved, THROW * turn)
    }
}

/// Two blocks, or two parts of theirs, and what is the same for all their parts.
pub(super) struct RigidPair<'a> {
    /// Both blocks in the island.
    pub blocks: [usize; 2],
    /// Their parts in the island.
    pub parts: [std::ops::Range<usize>; 2],
    /// Both colliders.
    pub names: Names,
    /// Friction and restitution.
    pub law: ContactLaw,
    /// Prediction distance of rapier (m).
    pub prediction: f64,
    /// How lively the island is.
    pub agitation: &'a Agitation,
}

impl RigidPair<'_> {
    /// Adds the candidates of all parts that may meet.
    pub fn add_candidates(&self, island: &mut Island, references: &mut References) {
        for a in self.parts[0].clone() {
            for b in self.parts[1].clone() {
                self.add_parts(island, [a, b], references);
            }
        }
    }

    fn add_parts(&self, island: &mut Island, pair: [usize; 2], references: &mut References) {
        let [Block::Rigid(block_a), Block::Rigid(block_b)] =
            self.blocks.map(|block| &island.blocks[block])
        else {
            return;
        };
        let [part_a, part_b] = pair.map(|part| &island.parts[part]);
        let size = part_a.part.size().min(part_b.part.size());
        let turn = self.agitation.turn + (turn_of(block_a) - turn_of(block_b)).abs();
        let moved = self.agitation.shift + relative_motion([block_a, block_b]) + size * turn;
        let reach = approach(block_a) + approach(block_b) + self.prediction + THROW * moved;
        let near = part_bounds(block_a, part_a).loosened(self.prediction + THROW * moved);
        if !near.intersects(&part_bounds(block_b, part_b)) {
            return;
        }
        let poses = [
            world_pose(block_a.start(), part_a),
            world_pose(block_b.start(), part_b),
        ];
        let owners = [self.names.one, self.names.other];
        let part_names = [0, 1].map(|side| (pair[side] - self.parts[side].start) as u32);
        let names = [(owners[0], part_names[0]), (owners[1], part_names[1])];
        let found = polygon_pair(
            &part_a.part,
            &poses[0],
            &part_b.part,
            &poses[1],
            reach,
            references.recall(names),
        );
        references.remember(names, found.reference);
        let meets_flat = turn <= FLAT && is_flat(&found, FLAT * size);
        if moved > FAR * size && !meets_flat {
            self.add_vertices(island, pair, part_names, &found, poses);
        } else {
            self.add_manifold(island, pair, part_names, &found);
        }
    }

    /// The points that face the other part when the step begins.
    fn add_manifold(
        &self,
        island: &mut Island,
        pair: [usize; 2],
        part_names: [u32; 2],
        found: &PairContacts,
    ) {
        let owners = [self.names.one, self.names.other];
        let placed = pair.map(|part| island.parts[part].pose);
        let radius = pair
            .map(|part| island.parts[part].part.radius())
            .iter()
            .sum();
        for contact in found {
            let (point, face) = if contact.point_on_b { (1, 0) } else { (0, 1) };
            let key = ContactKey {
                contactor: owners[point],
                // The owners say who carries the point, in whatever order the pair comes.
                point: contact.id & !(1 << 31),
                target: owners[face],
                part: (part_names[point] << 16) | part_names[face],
            };
            let ends = match contact.face {
                FaceOrVertex::Face(ends) => ends.map(|end| placed[face].transform(end)),
                FaceOrVertex::Vertex(at) => [placed[face].transform(at); 2],
            };
            let pair = Pair::PointOnFace {
                point: (self.blocks[point], placed[point].transform(contact.point)),
                face: self.blocks[face],
                ends,
                radius,
            };
            let law = self.law;
            island.candidates.push(Candidate { key, pair, law });
        }
    }

    /// All vertices of either part against the other.
    fn add_vertices(
        &self,
        island: &mut Island,
        pair: [usize; 2],
        part_names: [u32; 2],
        found: &PairContacts,
        poses: [Pose2; 2],
    ) {
        let owners = [self.names.one, self.names.other];
        // The direction from the second part to the first.
        let apart = found.iter().next().map_or(Vec2::zeros(), |contact| {
            if contact.point_on_b {
                -contact.normal
            } else {
                contact.normal
            }
        });
        let is_polygon = |part: &usize| island.parts[*part].part.vertices().len() > 2;
        if pair.iter().all(is_polygon) {
            let key = ContactKey {
                contactor: owners[0],
                point: ANY_FACE | 0x7fff,
                target: owners[1],
                part: (part_names[0] << 16) | part_names[1],
            };
            let pair = Pair::Crossing {
                blocks: self.blocks,
                parts: pair,
            };
            let law = self.law;
            island.candidates.push(Candidate { key, pair, law });
        }
        for (point, face) in [(0, 1), (1, 0)] {
            let carrier = island.parts[pair[point]].clone();
            let towards = if point == 0 { apart } else { -apart };
            for (vertex, &at) in carrier.part.vertices().iter().enumerate() {
                let key = ContactKey {
                    contactor: owners[point],
                    point: ANY_FACE | vertex as u32,
                    target: owners[face],
                    part: (part_names[point] << 16) | part_names[face],
                };
                let pair = Pair::VertexOnPart {
                    point: (self.blocks[point], carrier.pose.transform(at)),
                    radius: carrier.part.radius(),
                    rigid: self.blocks[face],
                    part: pair[face],
                    towards: poses[face].inverse_rotate(towards),
                    meets_vertices: point == 0,
                };
                let law = self.law;
                island.candidates.push(Candidate { key, pair, law });
            }
        }
    }
}

/// Whether two points face the other part at one distance, but for `slope` (m).
fn is_flat(found: &PairContacts, slope: f64) -> bool {
    let mut distances = found.iter().map(|contact| contact.distance);
    match (distances.next(), distances.next()) {
        (Some(one), Some(other)) => (one - other).abs() <= slope,
        _ => false,
    }
}

/// How far a point of a block may move in the step (m).
fn approach(block: &RigidBlock) -> f64 {
    let [start, drift, pulled] = block.places();
    let ways = [drift, pulled].map(|end| (end.centre - start.centre).norm());
    ways[0].max(ways[1])
}

fn turn_of(block: &RigidBlock) -> f64 {
    block.drift().angle - block.start().angle
}

/// The larger motion of a block's centre as seen from the other block (m).
fn relative_motion(blocks: [&RigidBlock; 2]) -> f64 {
    let seen = |one: &RigidBlock, other: &RigidBlock| {
        let carried = other.drift().point(other.start().arm(one.start().centre));
        (one.drift().centre - carried).norm()
    };
    // A small body on a large one that turns: what counts is the motion where they meet.
    seen(blocks[0], blocks[1]).min(seen(blocks[1], blocks[0]))
}
