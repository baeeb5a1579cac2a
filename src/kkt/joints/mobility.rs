//! How rows of joints move under unit multipliers.

use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::math::Vec2;
use crate::system::{Block, Response};

/// `G A⁻¹ Gᵀ` of one row (1/kg).
pub(super) fn own_mobility(
    blocks: &[Block],
    (grips, direction, is_turn): (&[JointGrip], Vec2, bool),
) -> f64 {
    let mut sum = 0.0;
    for at in grips {
        for from in grips.iter().filter(|from| from.block == at.block) {
            sum += pair_mobility(
                blocks,
                (at, direction, is_turn),
                (from, direction, is_turn),
                Response::Position,
            );
        }
    }
    sum
}

/// How a grip of one row moves by a unit multiplier at a grip of another, on the same block (1/kg).
pub(super) fn pair_mobility(
    blocks: &[Block],
    (at, along, turns): (&JointGrip, Vec2, bool),
    (from, push, is_turned): (&JointGrip, Vec2, bool),
    of: Response,
) -> f64 {
    match &blocks[at.block] {
        Block::Rigid(block) => block.mobility_between(
            unit_wrench(at, along, turns),
            unit_wrench(from, push, is_turned),
        ),
        Block::Flex(_) => {
            let compliance = blocks[at.block].compliance(at.grip(), from.grip(), of);
            at.weight * from.weight * along.dot(&(compliance * push))
        }
    }
}
