//! Ways: which surfaces of an island are kept apart along a feasible path, and at what distance they close.

use super::candidates::{Bounds, Names};
use super::outlines::{Outline, Piece, draw_inwards};
use crate::body::contact_offset;
use crate::constraint::contact::ContactLaw;
use crate::constraint::geometry::Pose2;
use crate::kkt::{Island, Way};
use crate::math::{Vec2, perp, rotation};
use crate::system::{Block, FlexBlock};

/// Reach of rows beyond the distance at which contact closes, relative to the margin: a tenth of an edge, as the offset is a hundredth.
/// Between half of it and twice only the number of passes changes.
const REACH: f64 = 10.0;

/// Reach of rows between rigid bodies, relative to the thinner one's width.
pub(super) const REACH_OF_WIDTH: f64 = 0.1;

/// Half the length of a half-space's boundary, relative to the body that it meets.
const FAR: f64 = 1e3;

/// A collider of a rigid block.
pub(super) struct RigidSurface<'a> {
    /// Its block in the island.
    pub block: usize,
    /// Its outline.
    pub outline: &'a Outline,
    /// Its pose about the centre of mass of the block.
    pub offset: Pose2,
}

/// Keeps a flexible block apart from the pieces of a rigid collider near it; `reach` is how far around its swept box it may get (m).
///
/// If they are not apart to begin with, nothing is added, and the distance at which they should come to be is returned (m).
pub(super) fn flex_rigid(
    island: &mut Island,
    flex: usize,
    surface: &RigidSurface<'_>,
    names: Names,
    law: ContactLaw,
    reach: f64,
    draft: &mut Draft,
) -> Result<(), f64> {
    let Block::Flex(body) = &island.blocks[flex] else {
        return Err(0.0);
    };
    if is_below(surface, body, island) {
        return Err(0.0);
    }
    let near = bounds_of(body).loosened(reach);
    let offset = offset_of(body);
    let (centre, size) = (body.centre(), body.size());
    let first = island.path.n_ways();
    let own = island.path.flex_member(flex, &island.blocks);
    let mut name = 0;
    for piece in &surface.outline.pieces {
        let Some(closing) = draft.fill(piece, surface, offset, (centre, size), island, &near)
        else {
            name += piece.n_points();
            continue;
        };
        let other = island.path.rigid_member(
            surface.block,
            &island.blocks,
            name,
            draft.round,
            &draft.points,
            &draft.edges,
        );
        name += piece.n_points();
        let way = Way {
            members: [own, other],
            owners: [names.one, names.other],
            law,
            closing: closing.distance + law.skin,
            margin: closing.margin,
            reach: REACH * closing.margin,
        };
        if !island.path.add_way(way) {
            island.path.truncate(first);
            return Err(surface.outline.gap(offset));
        }
    }
    Ok(())
}

/// Whether a node has begun the step in a half-space: its boundary alone does not tell the sides apart.
fn is_below(surface: &RigidSurface<'_>, body: &FlexBlock, island: &Island) -> bool {
    let Block::Rigid(motion) = &island.blocks[surface.block] else {
        return false;
    };
    let spaces = surface
        .outline
        .pieces
        .iter()
        .filter_map(|piece| match piece {
            Piece::HalfSpace { origin, normal } => Some((
                motion.start().point(surface.offset.transform(*origin)),
                rotation(motion.start().angle) * surface.offset.rotate(*normal),
            )),
            _ => None,
        });
    let offset = offset_of(body);
    spaces.into_iter().any(|(origin, normal)| {
        let nodes = body.model().mesh().boundary().nodes().iter();
        let depth = |node: &usize| normal.dot(&(body.start_position(*node) - origin));
        nodes.map(depth).any(|height| height <= -offset)
    })
}

/// Keeps two flexible blocks apart. If they are not to begin with, returns the distance at which they should come to be (m).
pub(super) fn flex_flex(
    island: &mut Island,
    blocks: [usize; 2],
    names: Names,
    law: ContactLaw,
) -> Result<(), f64> {
    let [Block::Flex(one), Block::Flex(other)] = blocks.map(|block| &island.blocks[block]) else {
        return Err(0.0);
    };
    let offset = offset_of(one).min(offset_of(other));
    let members = blocks.map(|block| island.path.flex_member(block, &island.blocks));
    let way = Way {
        members,
        owners: [names.one, names.other],
        law,
        closing: offset + law.skin,
        margin: offset,
        reach: REACH * offset,
    };
    if island.path.add_way(way) {
        Ok(())
    } else {
        Err(offset)
    }
}

/// Distance of cores at which a contact closes, and the part of it that the path may use up (m).
struct Closing {
    distance: f64,
    margin: f64,
}

/// Points and edges of one piece, in the axes of its block.
#[derive(Debug, Default)]
pub(super) struct Draft {
    /// Names, places, and ways to the sharp corners that they stand for.
    points: Vec<(u32, Vec2, Vec2)>,
    edges: Vec<[u32; 2]>,
    /// Radius by which a core with sharp corners is rounded (m).
    round: f64,
    sharp: Vec<Vec2>,
    inset: Vec<Vec2>,
    place: Vec<u32>,
}

impl Draft {
    /// Draws a piece; `None` if it is not near.
    fn fill(
        &mut self,
        piece: &Piece,
        surface: &RigidSurface<'_>,
        offset: f64,
        (centre, size): (Vec2, f64),
        island: &Island,
        near: &Bounds,
    ) -> Option<Closing> {
        self.points.clear();
        self.edges.clear();
        self.round = 0.0;
        let Block::Rigid(motion) = &island.blocks[surface.block] else {
            return None;
        };
        let ends = [*motion.start(), motion.drift()];
        let swept = |arms: &[Vec2]| {
            let places = arms.iter().flat_map(|arm| ends.map(|end| end.point(*arm)));
            places
                .map(|place| Bounds::of(&[place]))
                .reduce(Bounds::merged)
        };
        match piece {
            Piece::HalfSpace { origin, normal } => {
                let (origin, normal) = (
                    surface.offset.transform(*origin),
                    surface.offset.rotate(*normal),
                );
                let seen = motion.start().arm(centre);
                let along = perp(normal);
                let foot = seen - normal * normal.dot(&(seen - origin)) - offset * normal;
                // Its material is on the left of the edge.
                let far = FAR * size * along;
                let none = Vec2::zeros();
                self.points
                    .extend([(0, foot - far, none), (1, foot + far, none)]);
                self.edges.push([0, 1]);
                Some(Closing {
                    distance: offset,
                    margin: offset,
                })
            }
            Piece::Convex {
                vertices,
                radius,
                width,
            } => {
                let n = vertices.len();
                let arms = vertices
                    .iter()
                    .map(|vertex| surface.offset.transform(*vertex));
                self.sharp.clear();
                self.sharp.extend(arms);
                let closing = if *radius > 0.0 || n < 3 {
                    self.inset.clone_from(&self.sharp);
                    Closing {
                        distance: *radius,
                        margin: offset.min(0.5 * radius),
                    }
                } else {
                    let by = draw_inwards(&self.sharp, offset.min(0.125 * width), &mut self.inset);
                    self.round = by;
                    Closing {
                        distance: by,
                        margin: by,
                    }
                };
                let bounds = swept(&self.inset)?.loosened(closing.distance);
                if !bounds.intersects(near) {
                    return None;
                }
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
                Some(closing)
            }
            Piece::Chain { points, edges } => {
                self.place.clear();
                self.place.resize(points.len(), u32::MAX);
                for edge in edges {
                    let arms = edge.map(|end| surface.offset.transform(points[end as usize]));
                    if !swept(&arms).is_some_and(|bounds| bounds.loosened(offset).intersects(near))
                    {
                        continue;
                    }
                    let ends = [0, 1].map(|side| {
                        let place = &mut self.place[edge[side] as usize];
                        if *place == u32::MAX {
                            *place = self.points.len() as u32;
                            self.points.push((edge[side], arms[side], Vec2::zeros()));
                        }
                        *place
                    });
                    self.edges.push(ends);
                }
                (!self.edges.is_empty()).then_some(Closing {
                    distance: offset,
                    margin: offset,
                })
            }
        }
    }
}

impl Piece {
    fn n_points(&self) -> u32 {
        match self {
            Self::HalfSpace { .. } => 2,
            Self::Convex { vertices, .. } => vertices.len() as u32,
            Self::Chain { points, .. } => points.len() as u32,
        }
    }
}

/// The offset of a flexible body's surface (m).
fn offset_of(body: &FlexBlock) -> f64 {
    contact_offset(body.model(), body.extent())
}

/// Box of a surface over the step.
fn bounds_of(body: &FlexBlock) -> Bounds {
    let nodes = body.model().mesh().boundary().nodes().iter();
    let ends = nodes.map(|&node| Bounds::of(&[body.start_position(node), body.drift(node)]));
    let none = Bounds::of(&[body.centre()]);
    ends.reduce(Bounds::merged).unwrap_or(none)
}
