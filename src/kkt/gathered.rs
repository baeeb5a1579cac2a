//! Multipliers of rows as impulses on the blocks, and what these answer.

use super::island::Island;
use crate::system::{Block, Response};

impl Island {
    /// Gathers the current row multipliers as impulses on the flexible blocks, and as wrenches on the rigid ones.
    pub(super) fn gather_rows(&mut self, of: Response) {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for (row, direction) in self.rows.iter().enumerate() {
            let value = self.multipliers[row];
            if value == 0.0 {
                continue;
            }
            let kinematics = &self.contacts[direction.contact].kinematics;
            let is_normal = direction.direction == kinematics.normal;
            let force = if is_normal {
                [value, 0.0]
            } else {
                [0.0, value]
            };
            Self::spread(
                &mut self.blocks,
                kinematics,
                force,
                Some(&mut self.wrenches),
                |block, node, impulse, lever| block.gather_impulse(of, node, impulse, lever),
            );
        }
        self.gather_joint_rows(of);
    }

    pub(super) fn clear_impulses(&mut self) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.clear_impulses();
            }
        }
    }

    /// Finds what the flexible blocks answer to the gathered impulses.
    pub(super) fn respond(&mut self) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.respond();
            }
        }
    }

    /// Adds a multiple of the gathered wrenches' effect to the rigid blocks.
    pub(super) fn add_to_rigid(&mut self, of: Response, scale: f64) {
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            if let Block::Rigid(block) = block {
                let wrench = wrench.map(|value| scale * value);
                match of {
                    Response::Acceleration => block.add_smooth_acceleration(wrench),
                    _ => block.add_impulse(wrench),
                }
            }
        }
        self.add_across(of, scale);
    }

    /// Adds a multiple of the responses to the flexible blocks.
    pub(super) fn add_to_flexible(&mut self, of: Response, scale: f64) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.add_response(of, scale);
            }
        }
    }

    pub(super) fn set_soft_forces(&mut self) {
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            if let Block::Rigid(block) = block
                && !block.is_prescribed()
            {
                block.set_soft_force(*wrench);
            }
        }
        let [weight, lasting] = match self.blocks.iter().find_map(Block::soft_weights) {
            Some(weights) => weights,
            None => return,
        };
        self.add_across(Response::Velocity, weight);
        self.add_across(Response::Acceleration, lasting);
    }

    /// Adds what a wrench on a link does to others of its multibody.
    pub(super) fn push_across(&mut self, of: Response, from: usize, wrench: [f64; 3]) {
        for block in &mut self.blocks {
            block.push_across(of, from, wrench);
        }
    }

    /// Adds what the gathered wrenches do to other links of the multibodies that they act on, times a scale.
    pub(super) fn add_across(&mut self, of: Response, scale: f64) {
        for block in &mut self.blocks {
            block.add_across(of, &self.wrenches, scale);
        }
    }
}
