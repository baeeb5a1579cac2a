//! The energy stage: contact may store energy and give it back; what it would add is taken from the velocities.
//!
//! With `E` the kinetic and elastic energy and `W` the work of applied forces and of prescribed motion, the step may end
//! with `E' <= E + W + reserve`. The reserve is what contact has taken since it began, as far as that is the swing of the integrator about
//! the energy and no more: the rest is heat of dampers and impacts, which gives nothing back. Beyond that the end velocity is
//! changed along the response to the contact forces, which leaves momentum alone.
//!
//! With joints the reserve is all that was taken, unless forces act wholly within their step: they swing in the stored accelerations by more
//! than that, and velocities that are changed against it make it grow.

use super::delassus::RowDirection;
use super::island::{Island, SolveSettings};
use super::joint_rows::{ActiveJoint, add_wrench};
use super::summary::IslandSummary;
use crate::constraint::joint::unit_wrench;
use crate::math::{Vec2, rounding};
use crate::system::{Balance, Block, FlexBlock, Response, RigidBlock, RigidMotion};

impl Island {
    pub(super) fn start_energy(&mut self) -> [f64; 2] {
        self.sum_energy(FlexBlock::start_balance, RigidBlock::start)
    }

    pub(super) fn end_energy(&mut self) -> [f64; 2] {
        self.sum_energy(FlexBlock::end_balance, RigidBlock::current)
    }

    /// Kinetic and elastic energy of all blocks (J).
    fn sum_energy(
        &mut self,
        balance: impl Fn(&FlexBlock) -> Balance,
        motion: impl Fn(&RigidBlock) -> &RigidMotion,
    ) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for block in &mut self.blocks {
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
    pub fn flow_energy(&self) -> f64 {
        let flows = self.blocks.iter().map(|block| match block {
            Block::Flex(block) => block.flow_energy(),
            Block::Rigid(_) => 0.0,
        });
        flows.sum()
    }

    /// Work of applied forces (J).
    pub(super) fn applied_work(&self) -> f64 {
        let works = self.blocks.iter().map(|block| match block {
            Block::Flex(block) => block.applied_work(),
            Block::Rigid(block) => block.applied_work(),
        });
        works.sum()
    }

    /// Kinetic energy that the loads would give to the blocks at rest if nothing held them, and what energies are not known by (J).
    pub(super) fn load_energy(&self) -> f64 {
        let energies = self.blocks.iter().map(|block| match block {
            Block::Flex(block) => block.load_energy() + block.rounding_energy(),
            Block::Rigid(block) => block.load_energy(),
        });
        energies.sum()
    }

    /// Work of applied forces and of the contact forces of driven bodies, prescribed ones and links of multibodies (J).
    pub(super) fn actual_work(&self, settings: &SolveSettings) -> f64 {
        let mut work = self.applied_work();
        for contact in &self.contacts {
            let [normal, tangent] = contact.force(settings.dt);
            let kinematics = &contact.kinematics;
            let force = normal * kinematics.normal + tangent * kinematics.tangent();
            for a in kinematics.attachments() {
                let block = &self.blocks[a.block];
                if matches!(block, Block::Rigid(block) if block.is_driven()) {
                    let moved = block.position(a.grip.point) - block.start_position(a.grip.point);
                    work -= a.weight * force.dot(&moved);
                }
            }
        }
        work
    }

    /// Work of the joints on what is not driven from outside (J): nothing but for motors, springs and driven bodies.
    pub(super) fn joint_work(&self, settings: &SolveSettings) -> f64 {
        let mut work = 0.0;
        for tie in &self.ties {
            if tie.closing != 0.0 {
                // Ends that are drawn together move against each other: work is what the driven ones do.
                work -= self.driven_work(tie, settings.dt);
                continue;
            }
            let is_turn = tie.row.measure.is_turn();
            let (first, last) = tie.row.grips;
            for at in first..last {
                let grip = &self.joint_grips[at];
                match &self.blocks[grip.block] {
                    Block::Rigid(block) if block.is_driven() => {}
                    Block::Rigid(block) if tie.is_hard => {
                        let mut impulse = [0.0; 3];
                        let kept = unit_wrench(grip, tie.direction, is_turn);
                        let end = unit_wrench(&self.end_grips[at], tie.end, is_turn);
                        add_wrench(&mut impulse, tie.kick, kept);
                        add_wrench(&mut impulse, tie.impulse, end);
                        work += block.work_of(impulse);
                    }
                    block => {
                        let moved = block.position(grip.point) - block.start_position(grip.point);
                        let force = tie.force(settings.dt) * tie.row.sign;
                        work += force * grip.weight * tie.direction.dot(&moved);
                    }
                }
            }
        }
        work
    }

    /// What a joint's mean force does on driven bodies that it holds (J).
    fn driven_work(&self, tie: &ActiveJoint, dt: f64) -> f64 {
        let (first, last) = tie.row.grips;
        let force = tie.force(dt) * tie.row.sign;
        let driven = self.joint_grips[first..last].iter().filter(
            |grip| matches!(&self.blocks[grip.block], Block::Rigid(block) if block.is_driven()),
        );
        let works = driven.map(|grip| {
            let block = &self.blocks[grip.block];
            let moved = block.position(grip.point) - block.start_position(grip.point);
            force * grip.weight * tie.direction.dot(&moved)
        });
        works.sum()
    }

    /// Work done on the island by applied forces and, at most, by moving driven bodies (J).
    pub(super) fn external_work(&self) -> f64 {
        let mut work = self.applied_work();
        for contact in &self.contacts {
            let driven: Vec2 = contact
                .kinematics
                .attachments()
                .iter()
                .filter(
                    |a| matches!(&self.blocks[a.block], Block::Rigid(block) if block.is_driven()),
                )
                .map(|a| {
                    let block = &self.blocks[a.block];
                    block.position(a.grip.point) - block.start_position(a.grip.point)
                })
                .sum();
            let force = contact.multiplier[0].max(contact.remembered.normal);
            let drag = contact.multiplier[1]
                .abs()
                .max(contact.remembered.tangent.abs());
            work += driven.norm() * (force + drag);
        }
        work
    }

    /// Keeps contact, and turning frames, from adding energy.
    ///
    /// `reserve` is what contact has taken since it began and may give back (J); a debt is kept until it is paid.
    pub(super) fn limit_energy(
        &mut self,
        settings: &SolveSettings,
        allowance: f64,
        reserve: &mut f64,
        summary: &mut IslandSummary,
    ) {
        let touches = self
            .contacts
            .iter()
            .any(|contact| contact.multiplier[0] > 0.0 || contact.remembered.normal > 0.0);
        let [kinetic, elastic] = summary.end_energy;
        let swings = self.has_swinging_joints(settings.is_within);
        let kept = match (touches, swings) {
            (false, false) => 0.0,
            (false, true) => kinetic + elastic,
            (true, false) => SWING * (kinetic + elastic),
            (true, true) => f64::INFINITY,
        };
        *reserve = reserve.min(kept);
        let gain =
            kinetic + elastic - summary.start_energy[0] - summary.start_energy[1] - allowance;
        *reserve -= gain;
        let band = if touches { ROUND_OFF } else { SWING };
        // What is there by mistake is no measure of it.
        let had = summary.start_energy[0] + summary.start_energy[1] + allowance.abs();
        let debt = -*reserve - band * (kinetic + elastic).min(had);
        // At rest under load there are only rounding errors to take.
        let is_still = kinetic <= ROUND_OFF * elastic;
        if debt <= 0.0 || is_still {
            return;
        }
        let mut taken = if touches {
            self.remove_along_contacts(debt, settings)
        } else {
            0.0
        };
        if taken < debt {
            taken += self.remove_vibration(debt - taken);
        }
        if taken < debt && swings {
            summary.calmed = self.remove_relative_motion(debt - taken);
            taken += summary.calmed;
        }
        summary.limited = taken;
        summary.end_energy[0] -= taken;
        *reserve += taken;
    }

    /// Changes the end velocity along the response to the contact forces until `excess` (J) is gone, or as far as that
    /// direction carries energy; returns what was removed.
    fn remove_along_contacts(&mut self, excess: f64, settings: &SolveSettings) -> f64 {
        self.rows.clear();
        self.multipliers.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let force = contact.multiplier[0].max(contact.remembered.normal);
            if force > 0.0 && !contact.is_hard {
                self.rows.push(RowDirection {
                    contact: index,
                    direction: contact.kinematics.normal,
                });
                self.multipliers.push(force * settings.dt);
            }
        }
        if self.rows.is_empty() {
            return 0.0;
        }
        // Along what contacts and joints together allow.
        if self.hold_joints(settings).is_err() {
            return 0.0;
        }
        self.clear_impulses();
        self.gather_rows(Response::Velocity);
        self.respond();
        // Kinetic energy along v' + s z is a parabola in s; three samples give it exactly.
        let before = self.kinetic_energy();
        let after = self.add_responses(1.0);
        let mirrored = self.add_responses(-2.0);
        let curvature = 0.5 * (after + mirrored) - before;
        let slope = 0.5 * (after - mirrored);
        // What presses against something that does not give way moves nothing, however often it is taken: it is taken no more often than would
        // undo it and bring all that moves to rest.
        let pressed: f64 = self.multipliers[..self.rows.len()].iter().sum();
        let most = 1.0 + self.momentum_at_most() / pressed;
        let step = step_of_parabola(curvature, slope, excess)
            .min(most)
            .max(-most);
        for (row, impulse) in self.rows.iter().zip(&self.multipliers) {
            self.contacts[row.contact].impulse[0] += step * impulse;
        }
        let of_joints = &self.multipliers[self.rows.len()..];
        for (&row, impulse) in self.joint_rows.iter().zip(of_joints) {
            self.ties[row].impulse += step * impulse;
        }
        self.add_responses(1.0 + step);
        // What has flown away has slid since its row was measured: the levers of its force have a couple.
        self.balance_angular_momentum();
        before - self.kinetic_energy()
    }

    /// Adds a multiple of the responses to the velocities; returns the kinetic energy (J).
    fn add_responses(&mut self, scale: f64) -> f64 {
        self.add_to_rigid(Response::Velocity, scale);
        self.add_to_flexible(Response::Velocity, scale);
        self.kinetic_energy()
    }

    /// Scales down the vibration of the flexible blocks until `excess` (J) is gone; returns what was removed.
    fn remove_vibration(&mut self, excess: f64) -> f64 {
        let mut vibration = 0.0;
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                vibration += block.vibration_energy();
            }
        }
        if vibration <= 0.0 {
            return 0.0;
        }
        let before = self.kinetic_energy();
        let factor = (1.0 - excess / vibration).max(0.0).sqrt();
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.scale_vibration(factor);
            }
        }
        before - self.kinetic_energy()
    }

    /// Whether joints leave forces in stored accelerations, which swing from step to step.
    pub fn has_swinging_joints(&self, is_within: bool) -> bool {
        !self.ties.is_empty() && !is_within
    }

    /// The momentum of all blocks if each moved along one line with its kinetic energy (N s).
    fn momentum_at_most(&self) -> f64 {
        let momenta = self.blocks.iter().map(|block| {
            let (mass, energy) = match block {
                Block::Flex(block) => (block.mass(), block.kinetic_energy()),
                Block::Rigid(block) => {
                    let [x, y, _] = block.mass();
                    (x.max(y), block.kinetic_energy(block.current()))
                }
            };
            (2.0 * mass * energy).sqrt()
        });
        momenta.sum()
    }

    pub(super) fn kinetic_energy(&self) -> f64 {
        self.blocks
            .iter()
            .map(|block| match block {
                Block::Flex(block) => block.kinetic_energy(),
                Block::Rigid(block) => block.kinetic_energy(block.current()),
            })
            .sum()
    }
}

/// Energy error of one step by rounding, relative.
const ROUND_OFF: f64 = rounding::SUM;

/// Change of energy, relative, within which the integrator swings about it and gains nothing in the long run: of a body that turns freely,
/// and of what rests on each other and rocks.
const SWING: f64 = 1e-3;

/// The root nearer to zero of `curvature s² + slope s + excess = 0`, or the lowest point of the parabola.
fn step_of_parabola(curvature: f64, slope: f64, excess: f64) -> f64 {
    if curvature <= 0.0 {
        return 0.0;
    }
    let discriminant = slope * slope - 4.0 * curvature * excess;
    if discriminant <= 0.0 {
        return -slope / (2.0 * curvature);
    }
    let root = discriminant.sqrt().copysign(slope);
    (root - slope) / (2.0 * curvature)
}
