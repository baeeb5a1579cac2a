//! Geometric stiffness of hinged bodies: forces `F` that pull at levers `r` resist turning by `Σ r·F`.
//!
//! RATTLE treats it explicitly, which is stable while `K = dt² Σ r·F / I <= 4`. Links of a chain under tension are beyond that: a
//! link of length `l` zigzags against its neighbours at `√(T l / I)`. Where `K > 1`, the force of the position stage acts at levers
//! that are turned by the share `s = 1 - 1/K` of the step's own turn; then `K (1 - s) = 1`, stable for any `K`, and what the step
//! does not resolve is damped. The stiffness is that of the last step's forces, so that the problem stays linear. What is hinged to a body whose
//! motion is given turns about that hinge, with the inertia that it has there.

use super::ActiveJoint;
use crate::constraint::joint::{JointGrip, JointLaw, unit_wrench};
use crate::kkt::settings::SolveSettings;
use crate::system::Block;

/// `dt² Σ r·F / I` up to which turning is resolved.
const RESOLVED: f64 = 1.0;

/// How blocks resist turning.
#[derive(Clone, Debug, Default)]
pub(super) struct Twists {
    /// Stiffness by the joints' forces, by block (N m/rad), then the torque that it made (N m).
    twists: Vec<f64>,
    /// Inertia per mass that a block has besides its own where rows hold it to what does not give way: how far its centre goes by its turn, squared
    /// and summed up over the rows (m²).
    arms: Vec<f64>,
}

impl Twists {
    /// Finds the stiffness that forces give against turning, and gives the blocks their share of it.
    pub fn stiffen(
        &mut self,
        blocks: &mut [Block],
        (ties, grips): (&[ActiveJoint], &[JointGrip]),
        settings: &SolveSettings,
        multiplier: impl Fn(&ActiveJoint) -> f64,
    ) {
        for values in [&mut self.twists, &mut self.arms] {
            values.clear();
            values.resize(blocks.len(), 0.0);
        }
        let scale = 2.0 * settings.b0 / (settings.dt * settings.dt);
        let mut first = 0;
        while first < ties.len() {
            let owner = ties[first].row.key.owner;
            let rest = ties[first..].iter();
            let last = first + rest.take_while(|tie| tie.row.key.owner == owner).count();
            // What holds the turn itself needs no more.
            let is_hinge = !ties[first..last].iter().any(|tie| {
                tie.row.measure.is_turn() && matches!(tie.row.law, JointLaw::Rigid { .. })
            });
            for tie in ties[first..last]
                .iter()
                .filter(|tie| is_hinge && tie.is_hard)
            {
                let force = scale * multiplier(tie);
                let own = &grips[tie.row.grips.0..tie.row.grips.1];
                let is_given = |grip: &JointGrip| matches!(&blocks[grip.block], Block::Rigid(block) if block.is_prescribed());
                let holds = matches!(tie.row.law, JointLaw::Rigid { .. });
                let stays = holds && own.iter().any(is_given);
                for grip in own {
                    let is_turn = tie.row.measure.is_turn();
                    let [x, y, couple] = unit_wrench(grip, tie.direction, is_turn);
                    self.twists[grip.block] += force * (grip.lever.x * x + grip.lever.y * y);
                    if stays && !is_turn {
                        self.arms[grip.block] += couple * couple;
                    }
                }
            }
            first = last;
        }
        for ((block, twist), arm) in blocks.iter_mut().zip(&self.twists).zip(&self.arms) {
            if let Block::Rigid(block) = block {
                let own = block.turning_mobility();
                let [x, y, _] = block.mass();
                let mobility = own / (1.0 + own * x.min(y) * arm);
                let ratio = settings.dt * settings.dt * twist * mobility;
                if ratio > RESOLVED {
                    // The force of the position stage is `scale` times its multiplier.
                    let stiffness = (1.0 - RESOLVED / ratio) * twist / scale;
                    block.stiffen(stiffness, settings.b0);
                }
            }
        }
    }

    /// Takes the stiffness back; what torque it made is noted.
    pub fn relax(&mut self, blocks: &mut [Block]) {
        for (block, twist) in blocks.iter_mut().zip(&mut self.twists) {
            *twist = match block {
                Block::Rigid(block) => block.relax(),
                Block::Flex(_) => 0.0,
            };
        }
    }

    /// Gives the velocities that go with the torques of the stiffness.
    pub fn kick(&self, blocks: &mut [Block], settings: &SolveSettings) {
        for (block, torque) in blocks.iter_mut().zip(&self.twists) {
            if let Block::Rigid(block) = block
                && *torque != 0.0
            {
                block.add_impulse([0.0, 0.0, settings.b0 / settings.dt * torque]);
            }
        }
    }
}
