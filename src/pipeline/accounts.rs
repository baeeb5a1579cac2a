//! The books of a step: what solved islands are entered into, before anything is committed.

use super::clock::Clock;
use super::entries::{ContactReport, JointReport};
use super::names::Names;
use super::outcome::Outcome;
use super::quality::{Quality, Unsolved};
use super::report::StepReport;
use super::solved::{Entry, SolvedPart};
use crate::coupling::{EventBook, Memory};
use crate::math::{Vec2, cross, from_rapier};
use crate::system::Block;

/// What the islands of a step are entered into.
pub(super) struct Books<'a> {
    pub memory: &'a mut Memory,
    pub events: &'a mut EventBook,
    pub outcome: &'a mut Outcome,
    pub report: &'a mut StepReport,
    pub clock: &'a mut Clock,
}

impl Books<'_> {
    /// Begins with an island.
    pub fn open(&self) -> Entry {
        Entry::begin([
            self.report.contacts.len(),
            self.report.joints.len(),
            self.outcome.joint_impulses.len(),
        ])
    }

    /// Enters a part of the step of an island.
    pub fn enter(&mut self, part: &SolvedPart<'_>, names: Names<'_, '_>, entry: &mut Entry) {
        for contact in &part.island.contacts {
            if let Some(point) = part.pressed(contact, names) {
                self.events.note(point, names.sets);
            }
        }
        entry.is_unfinished |= part.summary.quality() == Quality::Unfinished;
        self.outcome.enter(part, entry);
        self.report.enter(part, names, entry);
        entry.n_parts += 1;
    }
}

impl StepReport {
    fn enter(&mut self, part: &SolvedPart<'_>, names: Names<'_, '_>, entry: &mut Entry) {
        let (n_contacts, n_joints) = (self.contacts.len(), self.joints.len());
        self.add_contacts(part, names);
        self.joints.extend(JointReport::all_of(part, names));
        if part.span.is_first() {
            let crossed = part.seats.crossed().iter();
            let bodies = crossed.filter_map(|&index| names.flex_bodies.at_index(index));
            self.self_crossing.extend(bodies.map(|(handle, _)| handle));
        } else {
            self.join_contacts(entry.first_contact, n_contacts);
            self.join_joints(entry.first_joint, n_joints);
        }
        let summary = part.summary;
        if let Some(unsolved) = Unsolved::of_part(part, names) {
            match std::mem::replace(&mut entry.is_told, true) {
                true => self.tell_again(unsolved),
                false => self.tell(unsolved),
            }
        }
        let counts = entry.count([summary.has_failed, summary.is_substituted]);
        self.gap_violation = self.gap_violation.max(summary.gap_violation);
        self.slip_violation = self.slip_violation.max(summary.slip_violation);
        self.joint_violation = self.joint_violation.max(summary.joint_violation);
        self.solver_residual = self.solver_residual.max(summary.residual);
        self.n_newton = self.n_newton.max(summary.n_newton);
        self.n_failed += counts[0];
        self.n_substituted += counts[1];
        self.n_pivots += summary.n_pivots;
        self.n_jammed += usize::from(summary.is_jammed);
        self.energy_limited += summary.limited;
        let gain: f64 =
            summary.end_energy.iter().sum::<f64>() - summary.start_energy.iter().sum::<f64>();
        let flowed = part.island.flow_energy();
        self.energy.flowed += flowed;
        self.energy.dissipated += summary.work + summary.stopped - gain + flowed;
        if part.span.is_last() {
            self.energy.kinetic += summary.end_energy[0] + summary.pending;
            self.energy.elastic += summary.end_energy[1] - flowed;
            self.energy.swing += summary.swing;
            let gravity = from_rapier(names.sets.gravity);
            self.add_momentum(part, gravity, names);
        }
    }

    fn add_contacts(&mut self, part: &SolvedPart<'_>, names: Names<'_, '_>) {
        for contact in &part.island.contacts {
            if !contact.is_closed() {
                self.opened.extend(part.opened(contact, names));
                continue;
            }
            let law = part.island.candidates[contact.candidate].law;
            self.complementarity_residual = self
                .complementarity_residual
                .max(contact.kinematics.gap.abs());
            self.cone.note(contact.multiplier, law.friction);
            self.contacts.extend(part.contact_report(contact, names));
        }
    }

    /// Adds what contacts pressed in earlier parts of the step, the contacts from the `first` on, to those of the last part, from `own` on:
    /// one that has opened since stays with what it gave.
    fn join_contacts(&mut self, first: usize, own: usize) {
        let earlier: Vec<ContactReport> = self.contacts.drain(first..own).collect();
        let n_own = self.contacts.len();
        for contact in earlier {
            let of_pair = |one: &&mut ContactReport| {
                (one.contactor, one.target) == (contact.contactor, contact.target)
            };
            let away = |one: &ContactReport| {
                let [x, y] = [0, 1].map(|axis| one.position[axis] - contact.position[axis]);
                x * x + y * y
            };
            let found = self.contacts[first..n_own].iter_mut();
            let nearest = found
                .filter(of_pair)
                .min_by(|one, other| away(one).total_cmp(&away(other)));
            let Some(nearest) = nearest else {
                self.contacts.push(contact);
                continue;
            };
            let force = contact.force();
            let [nx, ny] = nearest.normal;
            nearest.normal_force += force[0] * nx + force[1] * ny;
            nearest.tangential_force += force[1] * nx - force[0] * ny;
            for axis in 0..2 {
                nearest.midway[axis] += contact.midway[axis];
            }
        }
    }

    /// Adds the reactions of earlier parts of the step, from the `first` on, to those of the last part, from `own` on.
    fn join_joints(&mut self, first: usize, own: usize) {
        let earlier: Vec<JointReport> = self.joints.drain(first..own).collect();
        for before in earlier {
            let mut found = self.joints[first..].iter_mut();
            if let Some(now) = found.find(|now| now.joint == before.joint) {
                now.force[0] += before.force[0];
                now.force[1] += before.force[1];
                now.torque += before.torque;
            } else {
                self.joints.push(before);
            }
        }
    }

    /// Adds the island's momentum and potential energy.
    fn add_momentum(&mut self, part: &SolvedPart<'_>, gravity: Vec2, names: Names<'_, '_>) {
        let island = part.island;
        for &(block, handle) in part.seats.claimed() {
            if let (Block::Rigid(block), Some(body)) =
                (&island.blocks[block], names.sets.bodies.get(handle))
            {
                let [mass, mass_y, _] = block.mass();
                let weight = mass.max(mass_y) * f64::from(body.gravity_scale());
                self.energy.potential -= weight * gravity.dot(&block.current().centre);
            }
        }
        for (block, index) in island.blocks.iter().zip(&island.flex_index) {
            match (block, index) {
                (Block::Flex(block), Some(index)) => {
                    let scale = names
                        .flex_bodies
                        .at_index(*index)
                        .map_or(1.0, |(_, body)| body.gravity_scale());
                    let momentum = block.momentum();
                    self.momentum[0] += momentum.linear.x;
                    self.momentum[1] += momentum.linear.y;
                    self.angular_momentum += momentum.angular;
                    self.energy.potential -= scale * gravity.dot(&momentum.first_moment);
                }
                (Block::Rigid(block), _) if !block.is_prescribed() => {
                    let [mass, mass_y, inertia] = block.mass();
                    let motion = block.current();
                    let momentum = Vec2::new(mass * motion.velocity.x, mass_y * motion.velocity.y);
                    self.momentum[0] += momentum.x;
                    self.momentum[1] += momentum.y;
                    self.angular_momentum += inertia * motion.spin + cross(motion.centre, momentum);
                }
                _ => {}
            }
        }
    }
}
