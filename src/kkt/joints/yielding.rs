//! By how much joints between rigid bodies yield to their forces.
//!
//! A chain that is as long as what it hangs between is apart is held straight by forces without bound, and what it may sag by before they are there is
//! less than any step moves it by: passes ended in forces that pushed it up as well as down, or in none. So joints are stiff springs, and no stiffer:
//! a row yields by `s b0 / M`, an angle by `s b0 / J`, with `M` and `J` the mass and the inertia of all that is joined together and `b0` that of the
//! whole step, whatever part of it is solved. What hangs on a single joint opens it by `s` of the way that it would fall within the step.

use crate::constraint::joint::{JointGrip, JointLaw, JointRow};
use crate::kkt::group::Group;
use crate::kkt::settings::SolveSettings;
use crate::math::judged::Judged;
use crate::system::{Block, Moments};

/// Share of the way that all which is joined together would fall in a step, by which a joint that carries it opens (-).
///
/// Joints are meant to hold: of 1/60 s that is `1.4e-8` m. Straight bridges of 7 planks under a soft block (36 stiffnesses, steps and kinds of joints) are
/// solved in every step from a tenth of it to ten times as much; with a tenth a ball of 1.6 t that falls onto one of 160 kg gains a
/// twentieth of what was there, and with ten times as much most steps of that are told as left open (small strain, 1/60 s).
const JOINT_YIELDING: Judged = Judged::new("kkt::JOINT_YIELDING", 1e-5);

/// What is joined together.
#[derive(Debug, Default)]
pub(super) struct Yielding {
    /// Of every block the first one of those that it is joined with.
    leaders: Vec<usize>,
    /// All that a leader leads, as one body.
    groups: Vec<Group>,
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
        self.groups.clear();
        self.groups.resize(blocks.len(), Group::default());
        for (index, block) in blocks.iter().enumerate() {
            // Leaders come first, so theirs is known.
            self.leaders[index] = self.leaders[self.leaders[index]];
            if let Some(own) = moments_of(block) {
                self.groups[self.leaders[index]].add(&own);
            }
        }
        for (block, &leader) in blocks.iter().zip(&self.leaders) {
            if let Some(own) = moments_of(block) {
                self.groups[leader].add_turning(&own);
            }
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
        // What is driven from where the step begins would lag further behind in every one.
        if !holds(row) || matches!(row.law, JointLaw::Drive { .. }) {
            return 0.0;
        }
        let parts = settings.whole / settings.dt;
        let share = JOINT_YIELDING * settings.b0 * parts * parts;
        let mut held = grips.iter().map(|grip| grip.block);
        let first = held.find(|&block| mass_of(&blocks[block]) > 0.0);
        let group = first.map(|first| &self.groups[self.leaders[first]]);
        let weight = group.map(|group| match row.measure.is_turn() {
            true => group.polar(),
            false => group.mass,
        });
        // What only turns, or never does, has no other measure than its own.
        match weight.filter(|weight| *weight > 0.0) {
            Some(weight) => share / weight,
            None => share * mobility,
        }
    }
}

/// What a block that a step moves weighs, where it is.
fn moments_of(block: &Block) -> Option<Moments> {
    let mass = mass_of(block);
    (mass > 0.0).then(|| Moments {
        mass,
        ..block.start_moments()
    })
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
    use crate::constraint::joint::Measure;
    use crate::integrator::Beta2;
    use crate::kkt::calm::tests::join;
    use crate::kkt::closing::tests::SETTINGS;
    use crate::kkt::island::Island;
    use crate::math::{Vec2, judged::tests::with};
    use crate::system::{RigidBlock, RigidLoad, RigidMotion, Step};

    const DT: f64 = 0.02;

    /// Bodies of these masses in a row, a metre apart, each joined to the next: how far their weight opens the first joint if it carries all of it, over the way
    /// that they would fall in the step; and the same of an angle, a torque and how far that would turn them as one body.
    fn opened(masses: &[f64], n_parts: f64) -> [f64; 2] {
        let mut island = Island::default();
        let step = Step::new(&Beta2::default(), DT / n_parts);
        for &mass in masses {
            let load = RigidLoad {
                inverse_mass: [1.0 / mass, 1.0 / mass, 1.0],
                force: [0.0; 3],
                damping: [0.0; 3],
            };
            let motion = RigidMotion {
                centre: Vec2::new(island.blocks.len() as f64, 0.0),
                ..RigidMotion::default()
            };
            let body = RigidBlock::free(motion, None, &load, &step);
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
        let angle = JointRow {
            measure: Measure::Turn(0.0),
            ..rows[0]
        };
        let mass: f64 = masses.iter().sum();
        let places = || masses.iter().enumerate().map(|(i, m)| (i as f64, m));
        let centre = places().map(|(x, m)| x * m).sum::<f64>() / mass;
        let polar: f64 = places().map(|(x, m)| m * (x - centre).powi(2) + 1.0).sum();
        [(rows[0], mass), (angle, polar)].map(|(row, inertia)| {
            let own = (&grips[..2], 1.0 / masses[0]);
            let compliance = yielding.of(&row, &island.blocks, own, &settings);
            compliance * inertia / (0.5 * DT * DT)
        })
    }

    /// Whatever hangs on a joint opens it by the same share of the way that it would fall, in one part or in many, as long as the share is small.
    #[test]
    fn a_joint_opens_by_a_share_of_the_fall_of_what_it_carries() {
        for scale in [0.5, 1.0, 2.0] {
            for masses in [&[1.0, 1.0][..], &[1e-3, 1e3], &[2.0; 30]] {
                for n_parts in [1.0, 8.0] {
                    let scaled = Some(("kkt::JOINT_YIELDING", scale));
                    let (opened, _) = with(scaled, || opened(masses, n_parts));
                    for opened in opened {
                        let off = opened / (scale * 1e-5) - 1.0;
                        assert!(off.abs() < 1e-12, "{masses:?}, {n_parts} parts: {opened}");
                    }
                }
            }
        }
    }
}
