//! The last thing that energy is taken from where joints hold bodies together: all motion beyond the one that they have in common.
//!
//! Velocities that a joint allows it allows at every multiple, and about every common rigid motion. So what moves relative to that of the
//! whole group, `v - c`, may be scaled down without opening a joint, and without a change of momentum or angular momentum where nothing holds the
//! group; where a joint or a pin holds it, `c` is the motion of that. No joined motion with the momentum of the group has less energy than `c`.

use super::group::Group;
use super::joints::ActiveJoint;
use crate::constraint::joint::JointGrip;
use crate::system::{Block, Hold, RigidRates};

/// A group, and whether it can be calmed.
#[derive(Clone, Copy, Debug, Default)]
struct Calmed {
    group: Group,
    is_joined: bool,
    /// Whether something in it moves as it must, or by laws of its own.
    is_led: bool,
}

impl Calmed {
    fn can_be_calmed(&self) -> bool {
        self.is_joined && !self.is_led && self.group.mass > 0.0
    }
}

/// Rows of joints and what they hold on to.
pub(super) type Joints<'a> = (&'a [ActiveJoint], &'a [JointGrip]);

/// Scales down the motion of joined blocks relative to what they have in common until `excess` (J) is gone; returns what was removed.
///
/// - `leaders`: for each block the first one of its group.
pub(super) fn remove_relative_motion(
    blocks: &mut [Block],
    joints: Joints<'_>,
    leaders: &[usize],
    excess: f64,
) -> f64 {
    let groups = common_motions(blocks, joints, leaders);
    // Kinetic energy is `common + cross s + relative s²` of the scale `s`.
    let (mut now, mut common, mut relative) = (0.0, 0.0, 0.0);
    for (block, &leader) in blocks.iter_mut().zip(leaders) {
        if groups[leader].can_be_calmed() && !block.is_prescribed() {
            let [whole, shared, own] = block.energies_about(&groups[leader].group.motion());
            now += whole;
            common += shared;
            relative += own;
        }
    }
    if relative <= 0.0 {
        return 0.0;
    }
    let cross = now - common - relative;
    let least = (-0.5 * cross / relative).clamp(0.0, 1.0);
    if least >= 1.0 {
        // Nearer to a motion that is driven they would be faster.
        return 0.0;
    }
    let off = cross * cross - 4.0 * relative * (common - now + excess);
    let scale = match off > 0.0 {
        true => ((off.sqrt() - cross) / (2.0 * relative)).clamp(least, 1.0),
        false => least,
    };
    for (block, &leader) in blocks.iter_mut().zip(leaders) {
        if groups[leader].can_be_calmed() && !block.is_prescribed() {
            block.scale_about(&groups[leader].group.motion(), scale);
        }
    }
    now - common - cross * scale - relative * scale * scale
}

fn common_motions(blocks: &[Block], joints: Joints<'_>, leaders: &[usize]) -> Vec<Calmed> {
    let mut groups = vec![Calmed::default(); blocks.len()];
    let members = || {
        blocks
            .iter()
            .zip(leaders)
            .filter(|(block, _)| !block.is_prescribed())
    };
    for (block, &leader) in members() {
        let calmed = &mut groups[leader];
        calmed.group.add(&block.end_moments());
        match block.hold() {
            Hold::Free => {}
            Hold::Held => calmed.group.anchor = Some(RigidRates::default()),
            Hold::Led => calmed.is_led = true,
        }
    }
    for (block, &leader) in members() {
        groups[leader].group.add_turning(&block.end_moments());
    }
    for tie in joints.0 {
        let prescribed = blocks_of(tie, joints.1).find(|&block| blocks[block].is_prescribed());
        let anchor = prescribed.map(|block| blocks[block].frame_motion());
        for block in blocks_of(tie, joints.1).filter(|&block| !blocks[block].is_prescribed()) {
            let calmed = &mut groups[leaders[block]];
            calmed.is_joined = true;
            match (calmed.group.anchor, anchor) {
                (None, Some(_)) => calmed.group.anchor = anchor,
                (Some(one), Some(other)) => calmed.is_led |= !one.is_same(&other),
                (_, None) => {}
            }
        }
    }
    groups
}

fn blocks_of(tie: &ActiveJoint, grips: &[JointGrip]) -> impl Iterator<Item = usize> {
    let (first, last) = tie.row.grips;
    grips[first..last].iter().map(|grip| grip.block)
}

#[cfg(test)]
pub(super) mod tests;
