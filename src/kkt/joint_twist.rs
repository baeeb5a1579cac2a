//! Geometric stiffness of hinged bodies: forces `F` that pull at levers `r` resist turning by `Σ r·F`.
//!
//! RATTLE treats it explicitly, which is stable while `K = dt² Σ r·F / I <= 4`. Links of a chain under tension are beyond that: a
//! link of length `l` zigzags against its neighbours at `√(T l / I)`. Where `K > 1`, the force of the position stage acts at levers
//! that are turned by the share `s = 1 - 1/K` of the step's own turn; then `K (1 - s) = 1`, stable for any `K`, and what the step
//! does not resolve is damped. The stiffness is that of the last step's forces, so that the problem stays linear.

use super::island::{Island, SolveSettings};
use super::joint_rows::ActiveJoint;
use crate::constraint::joint::{JointLaw, unit_wrench};
use crate::system::Block;

/// `dt² Σ r·F / I` up to which turning is resolved.
const RESOLVED: f64 = 1.0;

impl Island {
    /// Finds the stiffness that the last step's forces give against turning, and gives the blocks their share of it.
    pub(super) fn stiffen_turns(&mut self, settings: &SolveSettings) {
        self.stiffen_by(settings, |tie| tie.row.last_multiplier());
    }

    /// The same from the forces of this iterate, where those of the last step were far off, as in an impact.
    pub(super) fn restiffen_turns(&mut self, settings: &SolveSettings) {
        self.relax_turns();
        self.stiffen_by(settings, |tie| tie.multiplier);
    }

    fn stiffen_by(&mut self, settings: &SolveSettings, multiplier: impl Fn(&ActiveJoint) -> f64) {
        self.twists.clear();
        self.twists.resize(self.blocks.len(), 0.0);
        let scale = 2.0 * settings.b0 / (settings.dt * settings.dt);
        let mut first = 0;
        while first < self.ties.len() {
            let owner = self.ties[first].row.key.owner;
            let rest = self.ties[first..].iter();
            let last = first + rest.take_while(|tie| tie.row.key.owner == owner).count();
            // What holds the turn itself needs no more.
            let is_hinge = !self.ties[first..last].iter().any(|tie| {
                tie.row.measure.is_turn() && matches!(tie.row.law, JointLaw::Rigid { .. })
            });
            for tie in self.ties[first..last]
                .iter()
                .filter(|tie| is_hinge && tie.is_hard)
            {
                let force = scale * multiplier(tie);
                for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
                    let [x, y, _] = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
                    self.twists[grip.block] += force * (grip.lever.x * x + grip.lever.y * y);
                }
            }
            first = last;
        }
        for (block, twist) in self.blocks.iter_mut().zip(&self.twists) {
            if let Block::Rigid(block) = block {
                let ratio = settings.dt * settings.dt * twist * block.turning_mobility();
                if ratio > RESOLVED {
                    // The force of the position stage is `scale` times its multiplier.
                    let stiffness = (1.0 - RESOLVED / ratio) * twist / scale;
                    block.stiffen(stiffness, settings.b0);
                }
            }
        }
    }

    /// Takes the stiffness back; what torque it made (N m) is noted.
    pub(super) fn relax_turns(&mut self) {
        for (block, twist) in self.blocks.iter_mut().zip(&mut self.twists) {
            *twist = match block {
                Block::Rigid(block) => block.relax(),
                Block::Flex(_) => 0.0,
            };
        }
    }

    /// Gives the velocities that go with the torques of the stiffness.
    pub(super) fn kick_turns(&mut self, settings: &SolveSettings) {
        for (block, torque) in self.blocks.iter_mut().zip(&self.twists) {
            if let Block::Rigid(block) = block
                && *torque != 0.0
            {
                block.add_impulse([0.0, 0.0, settings.b0 / settings.dt * torque]);
            }
        }
    }
}
