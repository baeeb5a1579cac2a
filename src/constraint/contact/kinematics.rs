//! Contact kinematics: gap `g = n·(x_point - x_target)` and the rows of `G` that move it (Eq. C.2).
//!
//! The normal points from the target to the point, so a compressive multiplier pushes the point along `+n`. At the
//! closest point the change of the normal does not move the gap to first order: `∂g = n·(∂x_point - Σ N_i ∂x_i)`.

use super::scene::Scene;
use crate::constraint::geometry::Feature;
use crate::math::{Vec2, perp, rounding};
use crate::system::{Block, Grip, Point};

/// One grip of a row with its weight: +1 at the point, `-N_i` at the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// Index of the block in the island.
    pub block: usize,
    /// Node or arm.
    pub grip: Grip,
    /// Weight (-).
    pub weight: f64,
}

/// Gap, directions and attachments of one contact in one configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// Gap, negative when overlapping (m).
    pub gap: f64,
    /// Unit normal, from the target to the point.
    pub normal: Vec2,
    /// Contact position (m).
    pub position: Vec2,
    /// Touched feature of a rigid target.
    pub feature: Option<Feature>,
    attachments: [Attachment; 3],
    n_attachments: usize,
    is_quasi_static: bool,
}

impl Kinematics {
    /// The grips of the row.
    pub fn attachments(&self) -> &[Attachment] {
        &self.attachments[..self.n_attachments]
    }

    /// Unit tangent, a quarter turn from the normal.
    pub fn tangent(&self) -> Vec2 {
        perp(self.normal)
    }

    /// Relative motion `Σ w_i f(grip_i)` of the point against the target.
    pub fn relative(&self, blocks: &[Block], value: impl Fn(&Block, Grip) -> Vec2) -> Vec2 {
        self.attachments()
            .iter()
            .map(|a| a.weight * value(&blocks[a.block], a.grip))
            .sum()
    }

    /// Whether one block alone takes part, which meets itself.
    pub fn is_own(&self) -> bool {
        let [first, others @ ..] = self.attachments() else {
            return false;
        };
        !others.is_empty() && others.iter().all(|a| a.block == first.block)
    }

    /// Whether only rigid blocks take part.
    pub fn is_rigid(&self, blocks: &[Block]) -> bool {
        self.attachments()
            .iter()
            .all(|a| matches!(blocks[a.block], Block::Rigid(_)))
    }

    /// Whether some grip with a weight has no inertia.
    pub fn is_massless(&self, blocks: &[Block]) -> bool {
        self.attachments()
            .iter()
            .any(|a| a.weight.abs() > rounding::SHARE && blocks[a.block].is_massless(a.grip.point))
    }

    /// Whether an explicit body is met through a node without mass, which a force moves at once, while it moves
    /// masses only from the end of the step on.
    pub fn is_quasi_static(&self) -> bool {
        self.is_quasi_static
    }

    /// Whether a flexible body takes part that steps by central difference.
    pub fn is_explicit(&self, blocks: &[Block]) -> bool {
        self.attachments()
            .iter()
            .any(|a| blocks[a.block].is_explicit())
    }

    /// The same row as seen from the other side: the target as the point and the point as the target.
    pub(crate) fn swapped(mut self) -> Self {
        self.normal = -self.normal;
        for attachment in &mut self.attachments {
            attachment.weight = -attachment.weight;
        }
        self
    }

    /// A row whose grips have the levers given: block, point, weight, and lever from the block's centre (m).
    ///
    /// # Panics
    /// If there are more than three grips.
    pub(crate) fn with_levers(
        gap: f64,
        normal: Vec2,
        position: Vec2,
        grips: &[(usize, Point, f64, Vec2)],
    ) -> Self {
        let unused = Attachment {
            block: 0,
            grip: Grip {
                point: Point::Node(0),
                lever: Vec2::zeros(),
            },
            weight: 0.0,
        };
        let mut attachments = [unused; 3];
        for (slot, &(block, point, weight, lever)) in grips.iter().enumerate() {
            attachments[slot] = Attachment {
                block,
                grip: Grip { point, lever },
                weight,
            };
        }
        Self {
            gap,
            normal,
            position,
            feature: None,
            attachments,
            n_attachments: grips.len(),
            is_quasi_static: false,
        }
    }

    pub(super) fn new(
        scene: &Scene<'_>,
        gap: f64,
        normal: Vec2,
        position: Vec2,
        grips: &[(usize, Point, f64)],
    ) -> Self {
        let mut attachments = [Attachment {
            block: 0,
            grip: Grip {
                point: Point::Node(0),
                lever: Vec2::zeros(),
            },
            weight: 0.0,
        }; 3];
        // One point of action for all, so that the forces of a contact have no couple.
        for (slot, &(block, point, weight)) in attachments.iter_mut().zip(grips) {
            let lever = position - scene.blocks[block].centre();
            *slot = Attachment {
                block,
                grip: Grip { point, lever },
                weight,
            };
        }
        let mut kinematics = Self {
            gap,
            normal,
            position,
            feature: None,
            attachments,
            n_attachments: grips.len(),
            is_quasi_static: false,
        };
        kinematics.is_quasi_static =
            kinematics.is_explicit(scene.blocks) && kinematics.is_massless(scene.blocks);
        kinematics
    }
}
