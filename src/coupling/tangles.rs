//! Surfaces that begin a step across each other: what has gone astray is led out along one direction for each tangle.

use super::candidates::Names;
use super::draft::RigidSurface;
use super::outlines::{Piece, outline_of as outline_of_shape};
use crate::body::FlexBody;
use crate::constraint::contact::{Candidate, ContactKey, ContactLaw, Direction, Owner, Pair};
use crate::constraint::geometry::Pose2;
use crate::constraint::geometry::tangle::{Exit, Loops, tangles};
use crate::fe::mesh::Boundary;
use crate::kkt::Island;
use crate::math::{Vec2, node_vec};
use crate::rapier::parry::shape::Shape;
use crate::system::{Block, FlexBlock, Point, RigidMotion};

/// Marks names of vertices, which candidates of convex parts count in another way.
const VERTEX: u32 = 1 << 31;

/// One of two surfaces that are across each other.
struct Side<'a> {
    block: usize,
    owner: Owner,
    loops: &'a Loops,
    /// Where a rigid block begins the step; `None` for a flexible one.
    start: Option<&'a RigidMotion>,
    /// Name of the piece.
    part: u32,
}

impl Side<'_> {
    /// The point where an edge starts.
    fn point(&self, edge: usize) -> Point {
        match self.start {
            Some(start) => Point::Arm(start.arm(self.loops.start(edge))),
            None => Point::Node(self.loops.name(edge) as usize),
        }
    }

    /// What holds the place where a way out ends, with weights.
    fn grips(&self, exit: &Exit) -> [(usize, Point, f64); 2] {
        if let Some(start) = self.start {
            let arm = Point::Arm(start.arm(exit.place));
            return [(self.block, arm, 1.0), (self.block, arm, 0.0)];
        }
        let [from, to] = self.loops.edge(exit.edge);
        let along = to - from;
        let xi = (along.dot(&(exit.place - from)) / along.norm_squared()).clamp(0.0, 1.0);
        let after = self.loops.next(exit.edge);
        [
            (self.block, self.point(exit.edge), 1.0 - xi),
            (self.block, self.point(after), xi),
        ]
    }

    fn name(&self, edge: usize) -> u32 {
        match self.start {
            Some(_) => VERTEX | (self.part + self.loops.name(edge)),
            None => self.loops.name(edge),
        }
    }
}

/// Replaces the candidates from the `first` on of points that have gone astray between a flexible block and a rigid collider.
pub(super) fn flex_rigid(
    island: &mut Island,
    first: usize,
    flex: usize,
    surface: &RigidSurface<'_>,
    names: Names,
    law: ContactLaw,
) {
    let (Block::Flex(body), Some(motion)) = (&island.blocks[flex], surface.motion(island)) else {
        return;
    };
    let start = *motion.start();
    let own = outline_at_start(body);
    let mut found = Vec::new();
    for (name, piece) in surface.outline.named_pieces() {
        let Some(loops) = loops_of(piece, |point| start.point(surface.offset.transform(point)))
        else {
            continue;
        };
        let sides = [
            Side {
                block: flex,
                owner: names.one,
                loops: &own,
                start: None,
                part: 0,
            },
            Side {
                block: surface.block,
                owner: names.other,
                loops: &loops,
                start: Some(&start),
                part: name,
            },
        ];
        add_rows(&sides, law, &mut found);
    }
    replace(island, first, &[(&own, flex)], found);
}

/// The same between two flexible blocks.
pub(super) fn flex_flex(
    island: &mut Island,
    first: usize,
    blocks: [usize; 2],
    names: Names,
    law: ContactLaw,
) {
    let [Block::Flex(one), Block::Flex(other)] = blocks.map(|block| &island.blocks[block]) else {
        return;
    };
    let outlines = [outline_at_start(one), outline_at_start(other)];
    let owners = [names.one, names.other];
    let sides = [0, 1].map(|side| Side {
        block: blocks[side],
        owner: owners[side],
        loops: &outlines[side],
        start: None,
        part: 0,
    });
    let mut found = Vec::new();
    add_rows(&sides, law, &mut found);
    let own = [(&outlines[0], blocks[0]), (&outlines[1], blocks[1])];
    replace(island, first, &own, found);
}

fn outline_at_start(body: &FlexBlock) -> Loops {
    outline_of(body.model().mesh().boundary(), |node| {
        body.start_position(node)
    })
}

fn outline_of(boundary: &Boundary, place: impl Fn(usize) -> Vec2) -> Loops {
    let nodes = boundary.nodes();
    let starts = nodes.iter().map(|&node| place(node));
    let next = (0..nodes.len()).map(|segment| boundary.next_segment(segment));
    let names = nodes.iter().map(|&node| node as u32);
    Loops::new(starts.collect(), next.collect(), names.collect())
}

/// The outline of a piece in the world; `None` of half-spaces, and of segments that are not rounded.
fn loops_of(piece: &Piece, in_world: impl Fn(Vec2) -> Vec2) -> Option<Loops> {
    let places = |points: &[Vec2]| -> Vec<Vec2> { points.iter().map(|p| in_world(*p)).collect() };
    match piece {
        Piece::Convex {
            vertices, radius, ..
        } => match *radius > 0.0 {
            true => Some(Loops::rounded(&places(vertices), *radius)),
            false => (vertices.len() > 2).then(|| Loops::polygon(&places(vertices))),
        },
        Piece::Chain {
            points,
            edges,
            is_rim,
        } => match is_rim {
            true => Loops::rim(&places(points), edges),
            false => Loops::lines(&places(points), edges),
        },
        Piece::HalfSpace { .. } => None,
    }
}

/// The rows that part two surfaces, each point by its own.
fn add_rows(sides: &[Side<'_>; 2], law: ContactLaw, found: &mut Vec<Candidate>) {
    let Some(tangles) = tangles(sides[0].loops, sides[1].loops) else {
        return;
    };
    for tangle in tangles {
        for way in tangle.ways_out(sides[0].loops, sides[1].loops) {
            let [of, to] = match way.is_of_first {
                true => [&sides[0], &sides[1]],
                false => [&sides[1], &sides[0]],
            };
            let key = ContactKey {
                contactor: of.owner,
                point: of.name(way.edge),
                target: to.owner,
                part: to.part,
            };
            if found.iter().any(|candidate| candidate.key == key) {
                continue;
            }
            let direction = Direction {
                normal: way.normal,
                gap: Some(-way.exit.distance - law.skin),
            };
            let pair = Pair::Astray {
                point: (of.block, of.point(way.edge)),
                target: to.grips(&way.exit),
            };
            let law = ContactLaw {
                direction: Some(direction),
                ..law
            };
            found.push(Candidate { key, pair, law });
        }
    }
}

/// How far a point of a flexible body and a shape, or of the shape, has to go at most for them to be apart (m); zero if they are not across each other.
pub(super) fn depth_in_shape(body: &FlexBody, shape: &dyn Shape, pose: &Pose2) -> f64 {
    let own = outline_now(body);
    let outline = outline_of_shape(shape);
    let pieces = outline.pieces.iter();
    let loops = pieces.filter_map(|piece| loops_of(piece, |point| pose.transform(point)));
    loops.map(|loops| depth(&own, &loops)).fold(0.0, f64::max)
}

/// The same for two flexible bodies.
pub(super) fn depth_in_body(one: &FlexBody, other: &FlexBody) -> f64 {
    depth(&outline_now(one), &outline_now(other))
}

fn outline_now(body: &FlexBody) -> Loops {
    outline_of(body.mesh().boundary(), |node| {
        node_vec(body.positions(), node)
    })
}

fn depth(first: &Loops, second: &Loops) -> f64 {
    let tangles = tangles(first, second).unwrap_or_default();
    let ways = tangles
        .iter()
        .flat_map(|tangle| tangle.ways_out(first, second));
    ways.map(|way| way.exit.distance).fold(0.0, f64::max)
}

/// Puts candidates of points that are astray in the place of those from the `first` on of the same points, and of points that are in one of the bodies.
fn replace(island: &mut Island, first: usize, own: &[(&Loops, usize)], found: Vec<Candidate>) {
    if found.is_empty() {
        return;
    }
    let is_astray = |block: usize, node: usize| {
        found.iter().any(|candidate| match candidate.pair {
            Pair::Astray { point, .. } => point == (block, Point::Node(node)),
            _ => false,
        })
    };
    let blocks = &island.blocks;
    let is_in = |flex: usize, block: usize, point: Point| {
        let place = blocks[block].start_position(point);
        let mut outlines = own.iter().filter(|(_, of)| *of == flex);
        outlines.any(|(outline, _)| outline.contain(place))
    };
    let mut slot = 0;
    island.candidates.retain(|candidate| {
        slot += 1;
        slot <= first
            || match candidate.pair {
                Pair::NodeOnPart { node, .. } => !is_astray(node.0, node.1),
                Pair::NodeOnSurface { node, flex, .. } => {
                    !(is_astray(node.0, node.1) || is_in(flex, node.0, Point::Node(node.1)))
                }
                Pair::VertexOnSurface {
                    rigid, arm, flex, ..
                } => !is_in(flex, rigid, Point::Arm(arm)),
                _ => true,
            }
    });
    island.candidates.extend(found);
}
