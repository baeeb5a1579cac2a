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
    /// By block, the sums of what forces pull along levers: of those that velocities feel, and of all (N m/rad).
    pulls: Vec<[f64; 2]>,
    /// Torques that velocities do not feel, by block (N m).
    unfelt: Vec<f64>,
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
        for tie in of_hinges(ties) {
            let force = scale * multiplier(tie);
            let own = &grips[tie.row.grips.0..tie.row.grips.1];
            let is_given = |grip: &JointGrip| matches!(&blocks[grip.block], Block::Rigid(block) if block.is_prescribed());
            let holds = matches!(tie.row.law, JointLaw::Rigid { .. });
            let stays = holds && own.iter().any(is_given);
            for grip in own {
                let ([_, _, couple], pull) = pull_of(tie, grip);
                self.twists[grip.block] += force * pull;
                if stays && !tie.row.measure.is_turn() {
                    self.arms[grip.block] += couple * couple;
                }
            }
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

    /// Leaves of every torque the share that goes with the forces that velocities feel; returns whether it took anything.
    pub fn leave_felt(&mut self, (ties, grips): (&[ActiveJoint], &[JointGrip])) -> bool {
        if self.twists.iter().all(|torque| *torque == 0.0) {
            return false;
        }
        self.pulls.clear();
        self.pulls.resize(self.twists.len(), [0.0; 2]);
        for tie in of_hinges(ties) {
            for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
                let (_, pull) = pull_of(tie, grip);
                let [felt, all] = &mut self.pulls[grip.block];
                *felt += tie.felt() * pull;
                *all += tie.multiplier * pull;
            }
        }
        self.unfelt.clear();
        for (torque, &[felt, all]) in self.twists.iter_mut().zip(&self.pulls) {
            let share = match felt == all {
                true => 1.0,
                false if all > 0.0 => (felt / all).clamp(0.0, 1.0),
                false => 0.0,
            };
            self.unfelt.push((1.0 - share) * *torque);
            *torque *= share;
        }
        self.unfelt.iter().any(|torque| *torque != 0.0)
    }

    /// Torques that velocities do not feel, by block (N m).
    pub fn unfelt(&self) -> &[f64] {
        &self.unfelt
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

/// The rows of rigid bodies of joints that let these turn: what holds the turn itself needs no more.
fn of_hinges(ties: &[ActiveJoint]) -> impl Iterator<Item = &ActiveJoint> {
    let joints = ties.chunk_by(|one, next| one.row.key.owner == next.row.key.owner);
    let holds_turn = |tie: &ActiveJoint| {
        tie.row.measure.is_turn() && matches!(tie.row.law, JointLaw::Rigid { .. })
    };
    let hinges = joints.filter(move |rows| !rows.iter().any(holds_turn));
    hinges.flatten().filter(|tie| tie.is_hard)
}

/// Wrench of a row's unit multiplier on the block of a grip, and how far along its lever it pulls (m).
fn pull_of(tie: &ActiveJoint, grip: &JointGrip) -> ([f64; 3], f64) {
    let wrench = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
    (wrench, grip.lever.x * wrench[0] + grip.lever.y * wrench[1])
}
