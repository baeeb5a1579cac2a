//! Accounts of a solved island: what it wants to commit, and what the report says of it.

use super::flex_pipeline::FlexPipeline;
use super::report::{ContactReport, Participant};
use crate::body::FlexBodySet;
use crate::constraint::contact::{Owner, Remembered};
use crate::coupling::{Landing, PressedPoint, RapierSets, Span, keep_awake, wake_moving};
use crate::kkt::{ActiveContact, IslandSummary};
use crate::linalg::complementarity::Status;
use crate::math::{Vec2, cross, from_rapier};
use crate::system::{Block, Step};

impl FlexPipeline {
    /// Notes what the solved island wants to commit and to report.
    pub(super) fn note(
        &mut self,
        (step, span): (Step, Span),
        summary: &IslandSummary,
        reserve: f64,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        let [first_contact, first_joint, first_impulse] = self.gatherer.under_way.firsts;
        let owns = [self.report.contacts.len(), self.report.joints.len()];
        for slot in 0..self.island.contacts.len() {
            let contact = &self.island.contacts[slot];
            let key = self.island.candidates[contact.candidate].key;
            let state = Remembered {
                normal: contact.multiplier[0],
                tangent: contact.multiplier[1],
                lasting: contact.lasting(),
                feature: contact.kinematics.feature,
            };
            let memory = if span.is_last() {
                &mut self.memory
            } else {
                &mut self.gatherer.under_way.contacts
            };
            memory.remember(key, state);
            if contact.is_closed() {
                let report = self.contact_report(contact, (step, span), sets, flex_bodies);
                self.report_residuals(slot);
                self.report.contacts.extend(report);
            }
            self.note_pressed(slot, (step, span), sets, flex_bodies);
        }
        self.note_joints((step, span), first_impulse, flex_bodies);
        if span.is_first() {
            let crossed = self.gatherer.crossed.iter();
            let crossed = crossed.filter_map(|&index| flex_bodies.at_index(index));
            let handles = crossed.map(|(handle, _)| handle);
            self.report.self_crossing.extend(handles);
        }
        if !span.is_first() {
            self.report.join_contacts(first_contact, owns[0]);
            self.report.join_joints(first_joint, owns[1]);
        }
        self.note_quality(summary, sets, flex_bodies);
        let counts = self.gatherer.under_way.count([
            summary.has_failed,
            summary.is_substituted,
            summary.is_linearized,
            summary.is_held,
        ]);
        let report = &mut self.report;
        report.gap_violation = report.gap_violation.max(summary.gap_violation);
        report.slip_violation = report.slip_violation.max(summary.slip_violation);
        report.solver_residual = report.solver_residual.max(summary.residual);
        report.n_newton = report.n_newton.max(summary.n_newton);
        report.n_failed += counts[0];
        report.n_substituted += counts[1];
        report.n_linearized += counts[2];
        report.n_held += counts[3];
        report.n_pivots += summary.n_pivots;
        report.energy_limited += summary.limited;
        let gain: f64 =
            summary.end_energy.iter().sum::<f64>() - summary.start_energy.iter().sum::<f64>();
        report.energy.dissipated += summary.work - gain;
        if span.is_last() {
            self.note_end(summary, reserve, sets, flex_bodies);
        }
    }

    /// Notes where and how fast the island's members end the step.
    fn note_end(
        &mut self,
        summary: &IslandSummary,
        reserve: f64,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        for &(block, handle) in &self.gatherer.bodies {
            if let Block::Rigid(block) = &self.island.blocks[block] {
                self.landings.push(Landing::new(handle, block));
            }
        }
        self.links.note(&self.gatherer.links, &self.island);
        let n_flex = self.island.flex_index.iter().flatten().count().max(1);
        for &index in self.island.flex_index.iter().flatten() {
            self.reserves.push((index, reserve / n_flex as f64));
        }
        let energy = &mut self.report.energy;
        energy.kinetic += summary.end_energy[0] + summary.pending;
        energy.elastic += summary.end_energy[1];
        energy.swing += summary.swing;
        self.report_momentum(from_rapier(sets.gravity), flex_bodies);
    }

    /// Keeps what contacts of sleepers will be asked for when they wake, and what the report says of them.
    pub(super) fn keep_sleepers(&mut self, sets: &RapierSets<'_>) {
        let claims = &self.claims;
        let sleeps = |owner| claims.sleeps(sets, owner);
        self.gatherer.keep(sleeps);
        self.memory
            .keep(|key| sleeps(key.contactor) || sleeps(key.target));
        self.report.keep_contacts(|participant| {
            sleeps(match participant {
                Participant::Flex(body) => Owner::Flex(body.into_raw_parts().0),
                Participant::Rigid(collider) => Owner::Collider(collider.into_raw_parts().0),
            })
        });
    }

    /// Keeps the carriers of bodies that move awake.
    pub(super) fn keep_awake(&self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        for &(index, _) in &self.reserves {
            let block = self.gatherer.block(index);
            if let (Some(block), Some((handle, body))) = (block, flex_bodies.at_index(index)) {
                let is_attached = flex_bodies.is_attached(handle);
                keep_awake(body, block.velocities(), is_attached, sets);
            }
        }
    }

    /// Wakes carriers that rapier has put to sleep while their bodies move.
    pub(super) fn wake_moving(&self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        for &(index, _) in &self.reserves {
            let block = self.gatherer.block(index);
            if let (Some(block), Some((handle, body))) = (block, flex_bodies.at_index(index)) {
                let is_attached = flex_bodies.is_attached(handle);
                wake_moving(body, block.velocities(), is_attached, sets);
            }
        }
    }

    fn report_residuals(&mut self, slot: usize) {
        let contact = &self.island.contacts[slot];
        let law = self.island.candidates[contact.candidate].law;
        let report = &mut self.report;
        report.complementarity_residual = report
            .complementarity_residual
            .max(contact.kinematics.gap.abs());
        report.cone.note(contact.multiplier, law.friction);
    }

    /// Notes the force of a contact for events.
    fn note_pressed(
        &mut self,
        slot: usize,
        (step, span): (Step, Span),
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        let contact = &self.island.contacts[slot];
        let force = contact.force(step.dt).map(|force| span.share() * force);
        if !contact.is_closed() && force == [0.0; 2] {
            return;
        }
        let key = self.island.candidates[contact.candidate].key;
        // Rapier knows no events of a collider with itself.
        if key.contactor == key.target {
            return;
        }
        let collider = |owner| match owner {
            Owner::Flex(index) => flex_bodies
                .at_index(index)
                .map(|(_, body)| body.collider_handle()),
            Owner::Collider(index) => sets
                .colliders
                .get_unknown_gen(index)
                .map(|(_, handle)| handle),
        };
        if let (Some(contactor), Some(target)) = (collider(key.contactor), collider(key.target)) {
            let point = PressedPoint {
                contactor,
                target,
                position: contact.kinematics.position,
                normal: contact.kinematics.normal,
                gap: contact.gap(),
                force,
                is_closed: contact.is_closed(),
                was_above: false,
            };
            self.events.note(point, sets);
        }
    }

    /// What the user knows an owner as.
    pub(super) fn participant(
        owner: Owner,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) -> Option<Participant> {
        match owner {
            Owner::Flex(index) => flex_bodies
                .at_index(index)
                .map(|(handle, _)| Participant::Flex(handle)),
            Owner::Collider(index) => sets
                .colliders
                .get_unknown_gen(index)
                .map(|(_, handle)| Participant::Rigid(handle)),
        }
    }

    fn contact_report(
        &self,
        contact: &ActiveContact,
        (step, span): (Step, Span),
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) -> Option<ContactReport> {
        let key = self.island.candidates[contact.candidate].key;
        let participant = |owner| Self::participant(owner, sets, flex_bodies);
        let [normal_force, tangential_force] =
            contact.force(step.dt).map(|force| span.share() * force);
        Some(ContactReport {
            position: contact.kinematics.position.into(),
            normal: contact.kinematics.normal.into(),
            gap: contact.gap(),
            normal_force,
            tangential_force,
            sticks: contact.status[1] == Status::Stick,
            contactor: participant(key.contactor)?,
            target: participant(key.target)?,
        })
    }

    /// Adds the island's momentum and potential energy.
    fn report_momentum(&mut self, gravity: Vec2, flex_bodies: &FlexBodySet) {
        for (block, index) in self.island.blocks.iter().zip(&self.island.flex_index) {
            let report = &mut self.report;
            match (block, index) {
                (Block::Flex(block), Some(index)) => {
                    let scale = flex_bodies
                        .at_index(*index)
                        .map_or(1.0, |(_, body)| body.gravity_scale());
                    let momentum = block.momentum();
                    report.momentum[0] += momentum.linear.x;
                    report.momentum[1] += momentum.linear.y;
                    report.angular_momentum += momentum.angular;
                    report.energy.potential -= scale * gravity.dot(&momentum.first_moment);
                }
                (Block::Rigid(block), _) if !block.is_prescribed() => {
                    let [mass, mass_y, inertia] = block.mass();
                    let motion = block.current();
                    let momentum = Vec2::new(mass * motion.velocity.x, mass_y * motion.velocity.y);
                    report.momentum[0] += momentum.x;
                    report.momentum[1] += momentum.y;
                    report.angular_momentum +=
                        inertia * motion.spin + cross(motion.centre, momentum);
                    report.energy.potential -= mass.max(mass_y) * gravity.dot(&motion.centre);
                }
                _ => {}
            }
        }
    }
}
