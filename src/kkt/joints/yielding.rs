//! By how much joints between rigid bodies yield to their forces.
//!
//! A chain that is as long as what it hangs between is apart is held straight by forces without bound, and what it may sag by before they are there is
//! less than any step moves it by: passes ended in forces that pushed it up as well as down, or in none. So joints are as stiff as steel is, and no
//! stiffer: a row yields like a spring of `M / (s b0)`, with `M` all that is joined together and `b0` that of the whole step, whatever part of it
//! is solved. What hangs on a single joint opens it by `s` of the way that it would fall within the step.

use crate::constraint::joint::{JointGrip, JointLaw, JointRow};
use crate::kkt::settings::SolveSettings;
use crate::math::judged::Judged;
use crate::system::Block;

/// Share of the way that all which is joined together would fall in a step, by which a joint that carries it opens (-).
///
/// Joints are meant to hold: of 1/60 s that is `1.4e-8` m. Straight bridges of 7 planks under a soft block (36 stiffnesses, steps and kinds of joints) are
/// solved in every step from a tenth of it to ten times as much; with a tenth a ball of 1.6 t on one of 160 kg threw that up, by a twentieth of
/// what it had brought, and with ten times as much half of its steps are told as left open.
const JOINT_YIELDING: Judged = Judged::new("kkt::JOINT_YIELDING", 1e-5);

/// What is joined together, by the masses of the blocks.
#[derive(Debug, Default)]
pub(super) struct Yielding {
    /// A block that it is joined with, of every block: itself, or one before it.
    leaders: Vec<usize>,
    /// Mass of all that a leader leads (kg).
    masses: Vec<f64>,
}

impl Yielding {
    /// Finds what is joined together.
    pub fn find(&mut self, rows: &[JointRow], grips: &[JointGrip], blocks: &[Block]) {
        self.leaders.clear();
        self.leaders.extend(0..blocks.len());
        for row in rows.iter().filter(|row| holds(row)) {
            let own = grips[row.grips.0..row.grips.1].iter();
            let mut free = own.filter(|grip| mass_of(&blocks[grip.block]) > 0.0);
            let Some(first) = free.next() else {
                continue;
            };
            for other in free {
                let [one, other] = [first, other].map(|grip| self.leader_of(grip.block));
                let (low, high) = (one.min(other), one.max(other));
                self.leaders[high] = low;
            }
        }
        self.masses.clear();
        self.masses.resize(blocks.len(), 0.0);
        for (index, block) in blocks.iter().enumerate() {
            let leader = self.leader_of(index);
            self.masses[leader] += mass_of(block);
        }
    }

    fn leader_of(&self, mut block: usize) -> usize {
        while self.leaders[block] != block {
            block = self.leaders[block];
        }
        block
    }

    /// How far a unit multiplier lets a row between rigid bodies yield (m/N or rad/(N m)).
    ///
    /// - `mobility`: of the row (1/kg or 1/(kg m²)).
    pub fn of(
        &self,
        row: &JointRow,
        blocks: &[Block],
        (grips, mobility): (&[JointGrip], f64),
        settings: &SolveSettings,
    ) -> f64 {
        if !holds(row) {
            return 0.0;
        }
        let parts = settings.whole / settings.dt;
        let share = JOINT_YIELDING * settings.b0 * parts * parts;
        let free = |grip: &&JointGrip| mass_of(&blocks[grip.block]) > 0.0;
        let Some(first) = grips.iter().find(free) else {
            return share * mobility;
        };
        let all = self.masses[self.leader_of(first.block)];
        if !row.measure.is_turn() {
            return share / all;
        }
        // An angle weighs as much more than its own bodies as all does.
        let inverse = |grip: &JointGrip| 1.0 / mass_of(&blocks[grip.block]);
        let inverse: f64 = grips.iter().filter(free).map(inverse).sum();
        share * mobility / (inverse * all)
    }
}

/// Mass of what a step moves (kg): zero of what is driven, or only turns.
fn mass_of(block: &Block) -> f64 {
    match block {
        Block::Rigid(block) => block.mass()[0].max(block.mass()[1]),
        Block::Flex(block) => block.mass(),
    }
}

/// Whether nothing bounds the force of a row.
fn holds(row: &JointRow) -> bool {
    match row.law {
        JointLaw::Rigid { .. } | JointLaw::Limit { .. } => true,
        JointLaw::Drive { most, .. } => most.is_infinite(),
        JointLaw::Spring(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Beta2;
    use crate::kkt::calm::tests::join;
    use crate::kkt::closing::tests::SETTINGS;
    use crate::kkt::island::Island;
    use crate::math::judged::tests::with;
    use crate::system::{RigidBlock, RigidLoad, RigidMotion, Step};

    const DT: f64 = 0.02;

    /// An island of bodies of these masses, each joined to the next, and how far what hangs on the first of them opens its joint under its weight, over the
    /// way that it would fall in the step.
    fn opened(masses: &[f64], n_parts: f64) -> f64 {
        let mut island = Island::default();
        let step = Step::new(&Beta2::default(), DT / n_parts);
        for &mass in masses {
            let load = RigidLoad {
                inverse_mass: [1.0 / mass, 1.0 / mass, 1.0],
                force: [0.0; 3],
                damping: [0.0; 3],
            };
            let body = RigidBlock::free(RigidMotion::default(), None, &load, &step);
            island.blocks.push(Block::Rigid(body));
        }
        for first in 1..masses.len() {
            join(&mut island, [first - 1, first]);
        }
        let rows: Vec<JointRow> = island.joints.ties.iter().map(|tie| tie.row).collect();
        let grips = &island.joints.grips;
        let mut yielding = Yielding::default();
        yielding.find(&rows, grips, &island.blocks);
        let dt = DT / n_parts;
        let settings = SolveSettings {
            dt,
            whole: DT,
            b0: 0.5 * dt * dt,
            ..SETTINGS
        };
        let own = (&grips[..2], 1.0 / masses[0]);
        let compliance = yielding.of(&rows[0], &island.blocks, own, &settings);
        let weight = masses.iter().sum::<f64>() * 9.81;
        compliance * weight / (0.5 * 9.81 * DT * DT)
    }

    /// Whatever hangs on a joint opens it by the same share of the way that it would fall, in one part or in many, as long as the share is small.
    #[test]
    fn a_joint_opens_by_a_share_of_the_fall_of_what_it_carries() {
        for scale in [0.5, 1.0, 2.0] {
            for masses in [&[1.0, 1.0][..], &[1e-3, 1e3], &[2.0; 30]] {
                for n_parts in [1.0, 8.0] {
                    let scaled = Some(("kkt::JOINT_YIELDING", scale));
                    let (opened, _) = with(scaled, || opened(masses, n_parts));
                    let expected = scale * 1e-5;
                    assert!(
                        (opened - expected).abs() < 1e-12 * expected.max(1.0),
                        "{masses:?}, {n_parts} parts: {opened}"
                    );
                }
            }
        }
    }
}
