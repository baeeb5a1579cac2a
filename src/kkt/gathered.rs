//! Multipliers of rows as impulses on the blocks, and what these answer.

use super::island::Island;
use crate::constraint::contact::Kinematics;
use crate::math::{Vec2, cross};
use crate::system::{Block, FlexBlock, Grip, Point, Response};

/// Begins to gather wrenches anew.
pub(super) fn clear_wrenches(island: &mut Island) {
    island.wrenches.clear();
    island.wrenches.resize(island.blocks.len(), [0.0; 3]);
}

/// Gathers the current row multipliers as impulses on the flexible blocks, and as wrenches on the rigid ones.
pub(super) fn gather_rows(island: &mut Island, of: Response) {
    clear_wrenches(island);
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let value = island.problem.multipliers[row];
        if value == 0.0 {
            continue;
        }
        let kinematics = &island.contacts[direction.contact].kinematics;
        let mut force = [0.0; 2];
        force[direction.axis] = value;
        spread(
            &mut island.blocks,
            kinematics,
            force,
            Some(&mut island.wrenches),
            |block, node, impulse, lever| block.gather_impulse(of, node, impulse, lever),
        );
    }
    island.joints.gather(
        &island.problem,
        (&mut island.blocks, &mut island.wrenches),
        of,
    );
}

pub(super) fn clear_impulses(island: &mut Island) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.clear_impulses();
        }
    }
}

/// Finds what the flexible blocks answer to the gathered impulses.
pub(super) fn respond(island: &mut Island) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.respond();
        }
    }
}

/// Adds a multiple of the gathered wrenches' effect to the rigid blocks.
pub(super) fn add_to_rigid(island: &mut Island, of: Response, scale: f64) {
    for (block, wrench) in island.blocks.iter_mut().zip(&island.wrenches) {
        if let Block::Rigid(block) = block {
            let wrench = wrench.map(|value| scale * value);
            match of {
                Response::Acceleration => block.add_smooth_acceleration(wrench),
                _ => block.add_impulse(wrench),
            }
        }
    }
}

/// Adds a multiple of the responses to the flexible blocks.
pub(super) fn add_to_flexible(island: &mut Island, of: Response, scale: f64) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.add_response(of, scale);
        }
    }
}

pub(super) fn set_soft_forces(island: &mut Island) {
    for (block, wrench) in island.blocks.iter_mut().zip(&island.wrenches) {
        if let Block::Rigid(block) = block
            && !block.is_prescribed()
        {
            block.set_soft_force(*wrench);
        }
    }
}

/// Accumulates `Gᵀ f` on the blocks: node forces through `on_node`, wrenches of rigid blocks in `wrenches`.
pub(super) fn spread(
    blocks: &mut [Block],
    kinematics: &Kinematics,
    force: [f64; 2],
    mut wrenches: Option<&mut [[f64; 3]]>,
    mut on_node: impl FnMut(&mut FlexBlock, usize, Vec2, Vec2),
) {
    let total = force[0] * kinematics.normal + force[1] * kinematics.tangent();
    for attachment in kinematics.attachments() {
        let share = attachment.weight * total;
        let Grip { point, lever } = attachment.grip;
        match (&mut blocks[attachment.block], point) {
            (Block::Flex(block), Point::Node(node)) => on_node(block, node, share, lever),
            (Block::Rigid(_), Point::Arm(_)) => {
                if let Some(wrenches) = &mut wrenches {
                    let wrench = [share.x, share.y, cross(lever, share)];
                    for (sum, value) in wrenches[attachment.block].iter_mut().zip(wrench) {
                        *sum += value;
                    }
                }
            }
            _ => {}
        }
    }
}
