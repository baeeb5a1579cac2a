//! By how much the forces of joints stretch flexible blocks.

use super::ActiveJoint;
use crate::constraint::joint::JointGrip;
use crate::math::Vec2;
use crate::system::Block;

/// Tells every flexible block what its joints take from the moment of their forces when it turns by a radian: those of one joint together, in the
/// middle of where they act. What they hold against each other turns with the body that they are joined to.
pub(super) fn tell_stretch(ties: &[ActiveJoint], grips: &[JointGrip], blocks: &mut [Block]) {
    for joint in ties.chunk_by(|one, other| pair_of(one, grips) == pair_of(other, grips)) {
        let [first, last] = pair_of(&joint[0], grips);
        let n_blocks = if first == last { 1 } else { 2 };
        for &own in &[first, last][..n_blocks] {
            if let Block::Flex(block) = &mut blocks[own] {
                block.stretch_by(stretch_of(own, joint, grips));
            }
        }
    }
}

/// The first and the last block of a row.
fn pair_of(tie: &ActiveJoint, grips: &[JointGrip]) -> [usize; 2] {
    let (first, last) = tie.row.grips;
    let blocks = grips[first..last].iter().map(|grip| grip.block);
    [blocks.clone().min(), blocks.max()].map(Option::unwrap_or_default)
}

/// What a block is stretched by (N m): the sum of the forces on it of some rows, along the middle of their levers.
fn stretch_of(block: usize, ties: &[ActiveJoint], grips: &[JointGrip]) -> f64 {
    let (mut force, mut lever, mut weight) = (Vec2::zeros(), Vec2::zeros(), 0.0);
    for tie in ties.iter().filter(|tie| !tie.row.measure.is_turn()) {
        for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
            if grip.block == block {
                force += tie.multiplier * grip.weight * tie.direction;
                lever += grip.weight.abs() * grip.lever;
                weight += grip.weight.abs();
            }
        }
    }
    if weight > 0.0 {
        force.dot(&lever) / weight
    } else {
        0.0
    }
}
