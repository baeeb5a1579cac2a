//! What a feasible path asks of a flexible block: where it begins, how far its frame has turned, and to stop on the way.

use super::flex_block::FlexBlock;
use crate::body::{Frame, FrameMotion};
use crate::fe::model::Model;
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{Vec2, node_vec, rotation, set_node_vec};
use crate::path::clearance;

impl FlexBlock {
    /// `A` in the frame, pinned dofs taken out.
    pub fn effective(&self) -> &BlockMatrix {
        &self.effective
    }

    /// Least distance of the surface from itself at rest (m).
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Operations of one factorization of `A`, roughly.
    pub fn factor_operations(&self) -> f64 {
        let stored = self.factor.n_nonzeros() as f64;
        stored * stored / self.n_dofs() as f64
    }

    /// A direction at a node in the frame, without what pins hold.
    pub fn local_row(&self, node: usize, direction: Vec2) -> [f64; 2] {
        let local = self.turn.transpose() * direction;
        [0, 1].map(|axis| {
            if self.is_fixed[2 * node + axis] {
                0.0
            } else {
                local[axis]
            }
        })
    }

    /// All positions at the beginning of the step, interleaved (m).
    pub fn start_positions(&self) -> &[f64] {
        &self.start_position
    }

    /// The frame at the beginning of the step.
    pub fn start_frame(&self) -> &FrameMotion {
        &self.start_frame
    }

    /// Angle of the frame at the iterate (rad).
    pub fn angle(&self) -> f64 {
        self.frame.angle
    }

    /// Puts the nodes where the step could go (m), with the velocities and accelerations that its forces lead to.
    pub fn stop_at(&mut self, positions: &[f64]) {
        self.position.copy_from_slice(positions);
        if self.is_large() {
            self.follow_centre();
            return;
        }
        if self.kind == Frame::Fixed {
            let pairs = self.position.iter().zip(self.model.rest_positions());
            for (u, (x, rest)) in self.displacement.iter_mut().zip(pairs) {
                *u = x - rest;
            }
            return;
        }
        let centre = self
            .arms
            .centre(self.kind, &self.position, self.frame.centre);
        let angle = self.arms.angle(&self.position, centre, self.frame.angle);
        (self.frame.centre, self.frame.angle) = (centre, angle);
        self.turn = rotation(angle);
        let back = self.turn.transpose();
        for node in 0..self.model.n_nodes() {
            let arm = back * (node_vec(&self.position, node) - centre);
            let reference = node_vec(&self.arms.reference, node);
            set_node_vec(&mut self.displacement, node, arm - reference);
        }
        self.inertia = self.inertia_of(&self.displacement);
    }
}

/// Least distance of a model's surface from itself at rest (m).
pub(super) fn clearance_of(model: &Model) -> f64 {
    let boundary = model.mesh().boundary();
    let nodes = boundary.nodes().iter();
    let points: Vec<Vec2> = nodes
        .map(|&node| node_vec(model.rest_positions(), node))
        .collect();
    // Segment k starts at boundary node k.
    let edges: Vec<[u32; 2]> = (0..boundary.segments().len())
        .map(|segment| [segment as u32, boundary.next_segment(segment) as u32])
        .collect();
    clearance(&points, &edges)
}
