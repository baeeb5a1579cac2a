//! Drafts: a piece of a collider's outline, drawn as points and edges in the axes of its block, for whoever keeps away from it.

use super::candidates::Bounds;
use super::inset::draw_inwards;
use super::outlines::{Outline, Piece};
use crate::constraint::geometry::Pose2;
use crate::kkt::Island;
use crate::math::{Vec2, perp, rotation};
use crate::system::{Block, RigidBlock};

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

impl RigidSurface<'_> {
    /// The motion of its block.
    pub fn motion<'b>(&self, island: &'b Island) -> Option<&'b RigidBlock> {
        match &island.blocks[self.block] {
            Block::Rigid(motion) => Some(motion),
            Block::Flex(_) => None,
        }
    }

    /// A point of the boundary of a half-space, and the normal out of it, where the step begins (m, -); `None` of other pieces.
    pub fn boundary(&self, piece: &Piece, island: &Island) -> Option<[Vec2; 2]> {
        let Piece::HalfSpace { origin, normal } = piece else {
            return None;
        };
        let start = self.motion(island)?.start();
        let origin = start.point(self.offset.transform(*origin));
        Some([origin, rotation(start.angle) * self.offset.rotate(*normal)])
    }
}

/// What a piece without a core is drawn for: a body with its centre (m) and size (m), and the box in which it may be met.
pub(super) struct Guest {
    pub centre: Vec2,
    pub size: f64,
    pub near: Bounds,
}

/// Points and edges of one piece, in the axes of its block.
#[derive(Debug, Default)]
pub(super) struct Draft {
    /// Names, places, and ways to the sharp corners that they stand for.
    points: Vec<(u32, Vec2, Vec2)>,
    edges: Vec<[u32; 2]>,
    /// Radius by which a core with sharp corners is rounded (m).
    round: f64,
    /// How deep what is drawn is under the surface that it stands for (m).
    depth: f64,
    sharp: Vec<Vec2>,
    inset: Vec<Vec2>,
    place: Vec<u32>,
}

impl Draft {
    /// Draws a convex core; returns the distance at which it closes (m): its own radius, or by how much a core without one has been
    /// drawn inwards, at most `inwards` (m).
    pub fn draw_core(
        &mut self,
        (vertices, radius): (&[Vec2], f64),
        surface: &RigidSurface<'_>,
        inwards: f64,
    ) -> f64 {
        self.clear();
        self.sharp.clear();
        let arms = vertices
            .iter()
            .map(|vertex| surface.offset.transform(*vertex));
        self.sharp.extend(arms);
        let n = vertices.len();
        let closing = if radius > 0.0 || n < 3 {
            self.inset.clone_from(&self.sharp);
            radius
        } else {
            self.round = draw_inwards(&self.sharp, inwards, &mut self.inset);
            self.round
        };
        self.depth = closing;
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
        closing
    }

    /// The places of the core last drawn, in the axes of its block.
    pub fn core_arms(&self) -> &[Vec2] {
        &self.inset
    }

    /// Draws what a half-space or a chain has near a guest that stays `offset` (m) away from it; returns whether it has anything.
    ///
    /// The boundary of a half-space is drawn that much below it, a chain where it is.
    pub fn draw_open(
        &mut self,
        piece: &Piece,
        surface: &RigidSurface<'_>,
        offset: f64,
        guest: &Guest,
        island: &Island,
    ) -> bool {
        self.clear();
        let Some(motion) = surface.motion(island) else {
            return false;
        };
        let none = Vec2::zeros();
        match piece {
            Piece::HalfSpace { origin, normal } => {
                let (origin, normal) = (
                    surface.offset.transform(*origin),
                    surface.offset.rotate(*normal),
                );
                let seen = motion.start().arm(guest.centre);
                let along = perp(normal);
                let foot = seen - normal * normal.dot(&(seen - origin)) - offset * normal;
                self.depth = offset;
                // Its material is on the left of the edge.
                let far = FAR * guest.size * along;
                self.points
                    .extend([(0, foot - far, none), (1, foot + far, none)]);
                self.edges.push([0, 1]);
            }
            Piece::Chain { points, edges, .. } => {
                self.place.clear();
                self.place.resize(points.len(), u32::MAX);
                for edge in edges {
                    let arms = edge.map(|end| surface.offset.transform(points[end as usize]));
                    let bounds = swept(arms.into_iter(), motion);
                    if !bounds.is_some_and(|own| own.loosened(offset).intersects(&guest.near)) {
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
            Piece::Convex { .. } => {}
        }
        !self.edges.is_empty()
    }

    /// Box over the step of the points that are drawn.
    pub fn bounds(&self, surface: &RigidSurface<'_>, island: &Island) -> Option<Bounds> {
        let arms = self.points.iter().map(|(_, arm, _)| *arm);
        swept(arms, surface.motion(island)?)
    }

    /// Adds what is drawn to the path, with names counted from `name`; returns its member.
    pub fn add_to(&self, island: &mut Island, block: usize, name: u32) -> usize {
        island.path.rigid_member(
            block,
            &island.blocks,
            name,
            [self.round, self.depth],
            &self.points,
            &self.edges,
        )
    }

    fn clear(&mut self) {
        self.points.clear();
        self.edges.clear();
        self.round = 0.0;
        self.depth = 0.0;
    }
}

/// Box of arms of a block over the step.
pub(super) fn swept(arms: impl Iterator<Item = Vec2>, motion: &RigidBlock) -> Option<Bounds> {
    let ends = motion.places();
    let places = arms.flat_map(|arm| ends.map(|end| end.point(arm)));
    places
        .map(|place| Bounds::of(&[place]))
        .reduce(Bounds::merged)
}
