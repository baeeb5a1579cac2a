//! Members of the path: ways between them, their points, and where their blocks are at the base.

use crate::constraint::contact::{ContactLaw, Owner};
use crate::math::{Mat2, Vec2, rotation};
use crate::system::Point;

/// Two members that are kept apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// Both members.
    pub members: [usize; 2],
    /// Their names in contact keys.
    pub owners: [Owner; 2],
    /// Friction and restitution, for points of the first member.
    pub law: ContactLaw,
    /// The laws that hold in its place, each about a place of its own, among those of the path; none if it is the same everywhere.
    pub places: (u32, u32),
    /// Distance of cores at which contact closes (m).
    pub closing: f64,
    /// The part of it that the path may use up (m).
    pub margin: f64,
    /// Reach of the rows beyond that distance (m).
    pub reach: f64,
}

/// A member: its block, whether that is flexible, and how deep its core is under its surface at most (m).
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    pub block: usize,
    pub is_flex: bool,
    pub depth: f64,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint {
    /// Its place on its block.
    pub point: Point,
    /// Its name in contact keys.
    pub name: u32,
    /// From a core's vertex to the corner or node that it stands for, in body axes (m).
    pub corner: Vec2,
    /// Radius by which the core is rounded there (m).
    pub round: f64,
}

impl SurfacePoint {
    /// Where it is, with the node that it stands for there (m) and its body turned by this.
    pub fn beside(&self, node: Vec2, axes: &Mat2) -> Vec2 {
        if self.round == 0.0 {
            return node;
        }
        node - axes * self.corner
    }
}

/// Where a block is at the base; of a flexible one its frame, and where its nodes begin among those of all.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BlockBase {
    pub centre: Vec2,
    angle: f64,
    /// What turns it by its angle.
    axes: Mat2,
    pub nodes: Option<usize>,
}

impl BlockBase {
    pub fn new(centre: Vec2, angle: f64, nodes: Option<usize>) -> Self {
        Self {
            centre,
            angle,
            axes: rotation(angle),
            nodes,
        }
    }

    pub fn angle(&self) -> f64 {
        self.angle
    }

    pub fn axes(&self) -> &Mat2 {
        &self.axes
    }

    /// Puts it elsewhere (m, rad).
    pub fn place(&mut self, centre: Vec2, angle: f64) {
        *self = Self::new(centre, angle, self.nodes);
    }

    /// Position of the material point at `arm` (body axes, m).
    pub fn point(&self, arm: Vec2) -> Vec2 {
        self.centre + self.axes * arm
    }

    /// `arm` (body axes, m) of a position.
    pub fn arm(&self, point: Vec2) -> Vec2 {
        self.axes.transpose() * (point - self.centre)
    }
}
