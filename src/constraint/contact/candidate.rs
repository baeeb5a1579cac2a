//! Candidates: pairs of a point and a target that may touch during the step.

use super::law::ContactLaw;
use super::surface::Cone;
use crate::math::Vec2;
use crate::system::Point;

/// What a point or a target belongs to, stable from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Owner {
    /// A flexible body, by its index in the set.
    Flex(u32),
    /// A collider of a rigid body, by its index in rapier's set.
    Collider(u32),
}

/// Names a contact across steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ContactKey {
    /// Owner of the point.
    pub contactor: Owner,
    /// Node, or part and vertex of the point.
    pub point: u32,
    /// Owner of the target.
    pub target: Owner,
    /// Part of the target; 0 for a flexible body.
    pub part: u32,
}

impl ContactKey {
    /// The two owners, in an order that does not depend on whose point it is.
    pub fn owners(&self) -> [Owner; 2] {
        let pair = [self.contactor, self.target];
        [pair[0].min(pair[1]), pair[0].max(pair[1])]
    }
}

/// How the point and the target of a candidate are held by the island's blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pair {
    /// A node of a flexible block against a convex part of a rigid one.
    NodeOnPart {
        /// Flexible block, its node and the boundary segment that starts there.
        node: (usize, usize, usize),
        /// Rigid block.
        rigid: usize,
        /// Index into the island's parts.
        part: usize,
    },
    /// A core vertex of a rigid part, with the part's radius, against the surface of a flexible block.
    VertexOnSurface {
        /// Rigid block.
        rigid: usize,
        /// The vertex from the centre of mass, in body axes (m).
        arm: Vec2,
        /// Radius around the vertex (m).
        radius: f64,
        /// Where the vertex points, in body axes; `None` for parts without faces, and for round vertices, which point anywhere.
        cone: Option<Cone>,
        /// Flexible block.
        flex: usize,
        /// Range of the island's list of near segments; of one segment if the vertex is round, which may touch several.
        segments: (usize, usize),
    },
    /// A node of a flexible block against the surface of another.
    NodeOnSurface {
        /// Contactor block, its node and the boundary segment that starts there.
        node: (usize, usize, usize),
        /// Target block.
        flex: usize,
        /// Range of the island's list of near segments.
        segments: (usize, usize),
    },
    /// A point of one rigid block against a face (or a point) of another.
    PointOnFace {
        /// Block and arm of the point.
        point: (usize, Vec2),
        /// Block of the face.
        face: usize,
        /// Ends of the face from the centre of mass, in body axes (m); equal ends mean a point.
        ends: [Vec2; 2],
        /// Sum of both radii (m).
        radius: f64,
    },
    /// A core vertex of one rigid part against another part, wherever it comes in: for pairs that move or turn so far in
    /// the step that the faces which meet at its end are not those that faced each other at its beginning.
    VertexOnPart {
        /// Block and arm of the vertex.
        point: (usize, Vec2),
        /// Radius around the vertex (m).
        radius: f64,
        /// Block of the part.
        rigid: usize,
        /// Index of the part into the island's parts.
        part: usize,
        /// Direction from the part to the body of the vertex when the step began, in the part's axes; zero if they were
        /// far apart.
        towards: Vec2,
        /// Whether vertices of the part count: two round vertices meet once, not twice.
        meets_vertices: bool,
    },
    /// A point near an edge or a point of another surface, on a feasible path: the path measures it.
    Near {
        /// Blocks of the point and of the target.
        blocks: [usize; 2],
    },
    /// A point of a surface that began the step on the wrong side of another, and where that one was along the way out: along a direction
    /// of the law, which knows the gap.
    Astray {
        /// Block and node or arm.
        point: (usize, Point),
        /// What holds the place, with weights that sum to 1.
        target: [(usize, Point, f64); 2],
    },
    /// Two polygonal parts whose edges may cross without a vertex of either in the other: what [`Pair::VertexOnPart`]
    /// does not see.
    Crossing {
        /// Both blocks.
        blocks: [usize; 2],
        /// Their parts, as indices into the island's parts.
        parts: [usize; 2],
    },
}

impl Pair {
    /// The blocks of the point and of the target.
    pub fn blocks(&self) -> [usize; 2] {
        match *self {
            Self::NodeOnPart { node, rigid, .. } => [node.0, rigid],
            Self::VertexOnSurface { rigid, flex, .. } => [rigid, flex],
            Self::NodeOnSurface { node, flex, .. } => [node.0, flex],
            Self::PointOnFace { point, face, .. } => [point.0, face],
            Self::VertexOnPart { point, rigid, .. } => [point.0, rigid],
            Self::Astray { point, target } => [point.0, target[0].0],
            Self::Crossing { blocks, .. } | Self::Near { blocks } => blocks,
        }
    }
}

/// A point and a target that may touch, with their law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Its name.
    pub key: ContactKey,
    /// Who holds it.
    pub pair: Pair,
    /// Friction and restitution.
    pub law: ContactLaw,
}
