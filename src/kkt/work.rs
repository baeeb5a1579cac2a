//! Energies of blocks, and the work that is done on them.

use super::active_contact::ActiveContact;
use super::joints::{ActiveJoint, add_wrench};
use super::settings::SolveSettings;
use crate::constraint::contact::Candidate;
use crate::constraint::joint::{JointGrip, JointLaw, When, unit_wrench};
use crate::math::{Vec2, perp};
use crate::system::{Balance, Block, FlexBlock, RigidBlock, RigidMotion};

/// What a flexible body has kept of its forces on a driven block from the step before.
#[derive(Clone, Copy, Debug)]
pub struct KeptOn {
    /// Its block.
    pub by: usize,
    /// The block that it acts on.
    pub on: usize,
    /// Force and torque (N, N, N m).
    pub wrench: [f64; 3],
}

/// Grips of joints as the last iterate was found, and at the end of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorkGrips<'a> {
    pub start: &'a [JointGrip],
    pub end: &'a [JointGrip],
}

/// Kinetic and elastic energy at the beginning of the step (J).
pub(super) fn start_energy<'a>(blocks: impl IntoIterator<Item = &'a Block>) -> [f64; 2] {
    sum_energy(blocks, FlexBlock::start_balance, RigidBlock::start)
}

/// Kinetic and elastic energy at its end (J).
pub(super) fn end_energy<'a>(blocks: impl IntoIterator<Item = &'a Block>) -> [f64; 2] {
    sum_energy(blocks, FlexBlock::end_balance, RigidBlock::current)
}

fn sum_energy<'a>(
    blocks: impl IntoIterator<Item = &'a Block>,
    balance: impl Fn(&FlexBlock) -> Balance,
    motion: impl Fn(&RigidBlock) -> &RigidMotion,
) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for block in blocks {
        match block {
            Block::Flex(block) => {
                let balance = balance(block);
                sum[0] += balance.kinetic;
                sum[1] += balance.elastic;
            }
            Block::Rigid(block) => sum[0] += block.kinetic_energy(motion(block)),
        }
    }
    sum
}

/// What plastic flow dissipates in the step, which is in the elastic energy of its end (J).
pub(super) fn flow_energy(blocks: &[Block]) -> f64 {
    let flows = blocks.iter().map(|block| match block {
        Block::Flex(block) => block.flow_energy(),
        Block::Rigid(_) => 0.0,
    });
    flows.sum()
}

/// Work of applied forces (J).
pub(super) fn applied_work<'a>(blocks: impl IntoIterator<Item = &'a Block>) -> f64 {
    let works = blocks.into_iter().map(|block| match block {
        Block::Flex(block) => block.applied_work(),
        Block::Rigid(block) => block.applied_work(),
    });
    works.sum()
}

/// Kinetic energy that the loads would give to the blocks at rest if nothing held them, and what energies are not known by (J).
pub(super) fn load_energy<'a>(blocks: impl IntoIterator<Item = &'a Block>) -> f64 {
    let energies = blocks.into_iter().map(|block| match block {
        Block::Flex(block) => block.load_energy() + block.rounding_energy(),
        Block::Rigid(block) => block.load_energy(),
    });
    energies.sum()
}

/// Work of applied forces on the blocks that count, and of the forces of driven bodies, prescribed ones and belts, at the contacts that count (J).
///
/// Impulses count that the step has given, times the mean velocity of the driven bodies. Seen from a body that moves evenly that is what the
/// kinetic energy changes by, so that all that is said of the rest is the same from there.
pub(super) fn actual_work<'a>(
    blocks: &[Block],
    (own, counts): (impl Iterator<Item = &'a Block>, impl Fn(usize) -> bool),
    contacts: impl Iterator<Item = (&'a ActiveContact, &'a Candidate)>,
    kept_on: &[KeptOn],
    settings: &SolveSettings,
) -> f64 {
    let mut work = applied_work(own);
    // What the step before has left acts on, also of contacts that have opened or are elsewhere now.
    for &KeptOn { on, wrench, .. } in kept_on.iter().filter(|kept| counts(kept.by)) {
        if let Block::Rigid(block) = &blocks[on] {
            let along = wrench.iter().zip(block.led());
            let power: f64 = along.map(|(w, x)| w * x).sum();
            work -= settings.late() / settings.dt * power;
        }
    }
    for (contact, candidate) in contacts {
        let kinematics = &contact.kinematics;
        let along = |[n, t]: [f64; 2]| n * kinematics.normal + t * kinematics.tangent();
        let (impulse, at_end) = (along(contact.given(settings)), along(contact.impulse));
        // What the step before has left of the friction on a belt acts on as well.
        let kept = match contact.is_hard {
            true => 0.0,
            false => settings.late() * contact.remembered.lasting[1],
        };
        let tangent = kinematics.tangent();
        let carried = candidate.law.carried.dot(&tangent);
        work += (impulse.dot(&tangent) + kept) * carried / settings.dt;
        for a in kinematics.attachments() {
            if let Block::Rigid(block) = &blocks[a.block]
                && block.is_led()
            {
                // What the velocity stage adds acts at the end.
                let late = led_by(block, a.grip.lever);
                let midway = led_by(block, a.grip.lever - contact.since_midway);
                let power = (impulse - at_end).dot(&midway) + at_end.dot(&late);
                work -= a.weight * power / settings.dt;
            }
        }
    }
    work
}

/// How far what no force of the island moves brings a lever (m), see [`RigidBlock::led`].
fn led_by(block: &RigidBlock, lever: Vec2) -> Vec2 {
    let [x, y, turn] = block.led();
    Vec2::new(x, y) + turn * perp(lever)
}

/// Work of joints on what is not driven from outside (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct JointWork {
    /// All of it: nothing but for motors, springs and driven bodies, and for what turning rows leave.
    pub all: f64,
    /// What is done by joints that do none: bilateral rows between rigid bodies that are held at rest, and what limits give. The force of the
    /// step's beginning works on the velocities of the end, that of the end on those of the beginning.
    pub idle: f64,
    /// What rows of rigid bodies that hold, or limit, have taken out of the motion: less work than driven bodies have done through them.
    pub stopped: f64,
}

/// Sums up the work of the joint rows over the step, from their grips at its beginning and at its end.
///
/// - `weights`: the length of the step, and the Beta-2 weight `b1` (s).
pub(super) fn joint_work(
    blocks: &[Block],
    ties: &[ActiveJoint],
    grips: WorkGrips<'_>,
    weights: [f64; 2],
) -> JointWork {
    let is_driven =
        |grip: &JointGrip| matches!(&blocks[grip.block], Block::Rigid(block) if block.is_led());
    let mut sum = JointWork::default();
    for tie in ties {
        let work = work_of(blocks, tie, grips, weights);
        sum.all += work;
        let own = &grips.start[tie.row.grips.0..tie.row.grips.1];
        let holds = matches!(tie.row.law, JointLaw::Rigid { .. } | JointLaw::Limit { .. });
        if tie.is_hard && holds {
            sum.stopped -= work + driven_work(blocks, tie, grips, weights[0]);
        }
        if tie.is_hard && !tie.moves_apart() && !own.iter().any(is_driven) {
            sum.idle += match tie.row.law {
                JointLaw::Rigid { rate: 0.0, .. } => work,
                JointLaw::Limit { .. } => work.max(0.0),
                _ => 0.0,
            };
        }
    }
    sum
}

/// Work of a joint row on what is not driven from outside (J).
fn work_of(blocks: &[Block], tie: &ActiveJoint, grips: WorkGrips<'_>, [dt, b1]: [f64; 2]) -> f64 {
    if tie.moves_apart() {
        // Ends that are drawn together, or left apart, move against each other: work is what the driven ones do.
        return -driven_work(blocks, tie, grips, dt);
    }
    let is_turn = tie.row.measure.is_turn();
    let (first, last) = tie.row.grips;
    // The part of the last step's force that acts on in this one, for the part of this one's that acts in the next.
    let late = if tie.is_hard {
        Vec2::zeros()
    } else {
        let own = &grips.start[first..last];
        let began = tie.row.sign * tie.row.measure.direction(blocks, own, When::Start);
        let [before, after] = [tie.row.last_lasting(), tie.lasting()];
        (1.0 - b1 / dt) * (before * began - after * tie.direction)
    };
    let works = (first..last).map(|at| {
        let grip = &grips.start[at];
        match &blocks[grip.block] {
            Block::Rigid(block) if block.is_prescribed() => 0.0,
            Block::Rigid(block) if tie.is_hard => {
                let mut impulse = [0.0; 3];
                let kept = unit_wrench(grip, tie.direction, is_turn);
                let end = unit_wrench(&grips.end[at], tie.end, is_turn);
                add_wrench(&mut impulse, tie.kick, kept);
                add_wrench(&mut impulse, tie.impulse, end);
                let moves = block.moves_along();
                block.work_of([0, 1, 2].map(|axis| if moves[axis] { impulse[axis] } else { 0.0 }))
            }
            block => {
                let led = match block {
                    Block::Rigid(block) => led_by(block, grip.lever),
                    Block::Flex(_) => Vec2::zeros(),
                };
                let moved = block.position(grip.point) - block.start_position(grip.point) - led;
                let acts = tie.force(dt) * tie.row.sign * tie.direction + late;
                grip.weight * acts.dot(&moved)
            }
        }
    });
    works.sum()
}

/// What a joint's mean force does on driven bodies that it holds (J).
fn driven_work(blocks: &[Block], tie: &ActiveJoint, grips: WorkGrips<'_>, dt: f64) -> f64 {
    let is_turn = tie.row.measure.is_turn();
    let impulses = match tie.is_hard {
        true => [tie.kick, tie.impulse],
        false => [dt * tie.row.sign * tie.force(dt), 0.0],
    };
    let (first, last) = tie.row.grips;
    let works = (first..last).map(|at| match &blocks[grips.start[at].block] {
        Block::Rigid(block) if block.is_led() => {
            let mut impulse = [0.0; 3];
            let kept = unit_wrench(&grips.start[at], tie.direction, is_turn);
            add_wrench(&mut impulse, impulses[0], kept);
            if let Some(grip) = grips.end.get(at) {
                add_wrench(
                    &mut impulse,
                    impulses[1],
                    unit_wrench(grip, tie.end, is_turn),
                );
            }
            impulse.iter().zip(block.led()).map(|(p, x)| p * x).sum()
        }
        _ => 0.0,
    });
    works.sum::<f64>() / dt
}

/// What wrenches of impulses on driven bodies do on what these meet (J).
pub(super) fn work_of_driven(blocks: &[Block], wrenches: &[[f64; 3]], dt: f64) -> f64 {
    let works = blocks
        .iter()
        .zip(wrenches)
        .map(|(block, wrench)| match block {
            Block::Rigid(block) if block.is_led() => {
                let moved = block.led();
                wrench.iter().zip(moved).map(|(w, x)| w * x).sum::<f64>()
            }
            _ => 0.0,
        });
    -works.sum::<f64>() / dt
}

/// The momentum of these blocks if each moved along one line with its kinetic energy (N s).
pub(super) fn momentum_at_most<'a>(blocks: impl Iterator<Item = &'a Block>) -> f64 {
    let momenta = blocks.map(|block| {
        let (mass, energy) = mass_and_energy(block);
        (2.0 * mass * energy).sqrt()
    });
    momenta.sum()
}

/// What has to be moved of a block at the most (kg), and its kinetic energy (J).
pub(super) fn mass_and_energy(block: &Block) -> (f64, f64) {
    match block {
        Block::Flex(block) => (block.mass(), block.kinetic_energy()),
        Block::Rigid(block) => {
            let [x, y, _] = block.mass();
            (x.max(y), block.kinetic_energy(block.current()))
        }
    }
}

pub(super) fn kinetic_energy(blocks: &[Block]) -> f64 {
    blocks
        .iter()
        .map(|block| match block {
            Block::Flex(block) => block.kinetic_energy(),
            Block::Rigid(block) => block.kinetic_energy(block.current()),
        })
        .sum()
}

#[cfg(test)]
mod tests;
