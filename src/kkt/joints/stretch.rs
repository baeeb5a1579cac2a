//! By how much the forces of joints stretch flexible blocks.

use super::ActiveJoint;
use crate::constraint::joint::JointGrip;
use crate::math::Vec2;
use crate::system::Block;

/// Tells every flexible block what its joints take from the moment of their forces when it turns by a radian: the forces of each joint together, in
/// the middle of where they act. What these hold against each other turns with the body that they are joined to.
pub(super) fn tell_stretch(ties: &[ActiveJoint], grips: &[JointGrip], blocks: &mut [Block]) {
    for joint in ties.chunk_by(|one, other| one.row.key.owner == other.row.key.owner) {
        let (first, last) = joint[0].row.grips;
        let joined = grips[first..last].iter().map(|grip| grip.block);
        let ends = [joined.clone().min(), joined.max()].map(Option::unwrap_or_default);
        let n_blocks = if ends[0] == ends[1] { 1 } else { 2 };
        for &own in &ends[..n_blocks] {
            if let Block::Flex(block) = &mut blocks[own] {
                block.stretch_by(stretch_of(own, joint, grips));
            }
        }
    }
}

/// What a block is stretched by (N m): the sum of the forces of a joint's rows on it, along the middle of their levers.
fn stretch_of(block: usize, rows: &[ActiveJoint], grips: &[JointGrip]) -> f64 {
    let (mut force, mut lever, mut weight) = (Vec2::zeros(), Vec2::zeros(), 0.0);
    for tie in rows.iter().filter(|tie| !tie.row.measure.is_turn()) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kkt::calm::tests::join;
    use crate::kkt::island::Island;
    use crate::kkt::together::tests::rigid;
    use crate::path::samples::Random;

    /// Two nodes of one weld that pull at a body with 3 N and 5 N beside what they hold against each other, 1e9 N, stretch it by 8 N times the lever of their
    /// middle, and press the other body by as much along the same lever.
    #[test]
    fn what_a_joint_holds_against_itself_stretches_nothing() {
        let mut island = Island::default();
        for x in [0.0, 1.0] {
            let block = rigid(&mut Random::new(3), Vec2::new(x, 0.0)).0;
            island.blocks.push(block);
        }
        for (at, force) in [(0.4, 3.0 + 1e9), (0.6, 5.0 - 1e9)] {
            join(&mut island, [0, 1]);
            let (first, last) = island.joints.ties[island.joints.ties.len() - 1].row.grips;
            for grip in &mut island.joints.grips[first..last] {
                grip.lever = Vec2::new(at, 0.7);
            }
            if let Some(tie) = island.joints.ties.last_mut() {
                tie.multiplier = force;
            }
        }
        let stretches =
            [0, 1].map(|block| stretch_of(block, &island.joints.ties, &island.joints.grips));
        for (found, expected) in stretches.into_iter().zip([4.0, -4.0]) {
            assert!((found - expected).abs() < 1e-6, "{stretches:?}");
        }
    }
}
