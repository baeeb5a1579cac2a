//! The last thing that energy is taken from where joints hold bodies together: all motion beyond the one that they have in common.
//!
//! Velocities that a joint allows it allows at every multiple, and about every common rigid motion. So what moves relative to that of the
//! whole group, `v - c`, may be scaled down without opening a joint, and without a change of momentum or angular momentum where nothing holds the
//! group; where a joint or a pin holds it, `c` is the motion of that. No joined motion with the momentum of the group has less energy than `c`.

use super::island::Island;
use super::joint_rows::ActiveJoint;
use crate::math::{Vec2, cross};
use crate::system::{CommonMotion, Hold};

/// The motion that a group has in common.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    mass: f64,
    moment: Vec2,
    momentum: Vec2,
    /// Polar inertia and angular momentum about its centre (kg m², kg m²/s).
    polar: f64,
    angular: f64,
    anchor: Option<CommonMotion>,
    is_joined: bool,
    /// Whether something in it moves as it must, or by laws of its own.
    is_led: bool,
}

impl Group {
    fn motion(&self) -> CommonMotion {
        let spin = match self.polar > 0.0 {
            true => self.angular / self.polar,
            false => 0.0,
        };
        self.anchor.unwrap_or(CommonMotion {
            about: self.moment / self.mass,
            velocity: self.momentum / self.mass,
            spin,
        })
    }

    fn can_be_calmed(&self) -> bool {
        self.is_joined && !self.is_led && self.mass > 0.0
    }
}

impl Island {
    /// Scales down the motion of joined blocks relative to what they have in common until `excess` (J) is gone; returns what was removed.
    pub(super) fn remove_relative_motion(&mut self, excess: f64) -> f64 {
        let leaders = self.groups_of(|block| !block.is_prescribed());
        let groups = self.common_motions(&leaders);
        // Kinetic energy is `common + cross s + relative s²` of the scale `s`.
        let (mut now, mut common, mut relative) = (0.0, 0.0, 0.0);
        for (block, &leader) in self.blocks.iter_mut().zip(&leaders) {
            if groups[leader].can_be_calmed() && !block.is_prescribed() {
                let [whole, shared, own] = block.energies_about(&groups[leader].motion());
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
        let off = cross * cross - 4.0 * relative * (common - now + excess);
        let scale = match off > 0.0 {
            true => ((off.sqrt() - cross) / (2.0 * relative)).clamp(least, 1.0),
            false => least,
        };
        for (block, &leader) in self.blocks.iter_mut().zip(&leaders) {
            if groups[leader].can_be_calmed() && !block.is_prescribed() {
                block.scale_about(&groups[leader].motion(), scale);
            }
        }
        now - common - cross * scale - relative * scale * scale
    }

    fn common_motions(&self, leaders: &[usize]) -> Vec<Group> {
        let mut groups = vec![Group::default(); self.blocks.len()];
        let members = || {
            self.blocks
                .iter()
                .zip(leaders)
                .filter(|(block, _)| !block.is_prescribed())
        };
        for (block, &leader) in members() {
            let (group, own) = (&mut groups[leader], block.end_moments());
            group.mass += own.mass;
            group.moment += own.mass * own.centre;
            group.momentum += own.mass * own.velocity;
            match block.hold() {
                Hold::Free => {}
                Hold::Held => group.anchor = Some(CommonMotion::default()),
                Hold::Led => group.is_led = true,
            }
        }
        for (block, &leader) in members() {
            let (group, own) = (&mut groups[leader], block.end_moments());
            let arm = own.centre - group.moment / group.mass;
            group.polar += own.inertia + own.mass * arm.norm_squared();
            group.angular += own.spin_momentum + own.mass * cross(arm, own.velocity);
        }
        for tie in &self.ties {
            let prescribed = self
                .blocks_of(tie)
                .find(|&block| self.blocks[block].is_prescribed());
            let anchor = prescribed.map(|block| self.blocks[block].frame_motion());
            for block in self
                .blocks_of(tie)
                .filter(|&block| !self.blocks[block].is_prescribed())
            {
                let group = &mut groups[leaders[block]];
                group.is_joined = true;
                match (group.anchor, anchor) {
                    (None, Some(_)) => group.anchor = anchor,
                    (Some(one), Some(other)) => group.is_led |= !one.is_same(&other),
                    (_, None) => {}
                }
            }
        }
        groups
    }

    fn blocks_of(&self, tie: &ActiveJoint) -> impl Iterator<Item = usize> {
        let (first, last) = tie.row.grips;
        self.joint_grips[first..last].iter().map(|grip| grip.block)
    }
}
