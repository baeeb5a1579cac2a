//! The energy stage: contact may store energy and give it back, but never adds any.
//!
//! With `E` the kinetic and elastic energy and `W` the work of applied forces and of prescribed motion, the step may end
//! with `E' <= E + W + reserve`; the reserve is what contact has taken since it began. Beyond that the end velocity is
//! changed along the response to the contact forces, which leaves momentum alone.

use super::delassus::RowDirection;
use super::island::{Island, IslandSummary, SolveSettings};
use crate::math::Vec2;
use crate::system::{Block, Response};

impl Island {
    pub(super) fn start_energy(&mut self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for block in &mut self.blocks {
            match block {
                Block::Flex(block) => {
                    let balance = block.start_balance();
                    sum[0] += balance.kinetic;
                    sum[1] += balance.elastic;
                }
                Block::Rigid(block) => sum[0] += block.kinetic_energy(block.start()),
            }
        }
        sum
    }

    pub(super) fn end_energy(&mut self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for block in &mut self.blocks {
            match block {
                Block::Flex(block) => {
                    let balance = block.end_balance();
                    sum[0] += balance.kinetic;
                    sum[1] += balance.elastic;
                }
                Block::Rigid(block) => sum[0] += block.kinetic_energy(block.current()),
            }
        }
        sum
    }

    /// Work of applied forces and of the contact forces of prescribed bodies (J).
    pub(super) fn actual_work(&self, settings: &SolveSettings) -> f64 {
        let mut work = 0.0;
        for block in &self.blocks {
            work += match block {
                Block::Flex(block) => block.applied_work(),
                Block::Rigid(block) => block.applied_work(),
            };
        }
        for contact in &self.contacts {
            let [normal, tangent] = contact.force(settings.dt);
            let kinematics = &contact.kinematics;
            let force = normal * kinematics.normal + tangent * kinematics.tangent();
            for a in kinematics.attachments() {
                let block = &self.blocks[a.block];
                if matches!(block, Block::Rigid(block) if block.is_prescribed()) {
                    let moved = block.position(a.grip) - block.start_position(a.grip);
                    work -= a.weight * force.dot(&moved);
                }
            }
        }
        work
    }

    /// Work done on the island by applied forces and, at most, by moving prescribed bodies (J).
    pub(super) fn external_work(&self) -> f64 {
        let mut work = 0.0;
        for block in &self.blocks {
            work += match block {
                Block::Flex(block) => block.applied_work(),
                Block::Rigid(block) => block.applied_work(),
            };
        }
        for contact in &self.contacts {
            let driven: Vec2 = contact
                .kinematics
                .attachments()
                .iter()
                .filter(|a| matches!(&self.blocks[a.block], Block::Rigid(block) if block.is_prescribed()))
                .map(|a| {
                    let block = &self.blocks[a.block];
                    block.position(a.grip) - block.start_position(a.grip)
                })
                .sum();
            let force = contact.multiplier[0].max(contact.remembered.normal);
            let drag = contact.multiplier[1].abs().max(contact.remembered.tangent.abs());
            work += driven.norm() * (force + drag);
        }
        work
    }

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
        if !touches {
            *reserve = 0.0;
            return;
        }
        let [kinetic, elastic] = summary.end_energy;
        let gain = kinetic + elastic - summary.start_energy[0] - summary.start_energy[1] - allowance;
        *reserve -= gain;
        let noise = 1e-12 * (kinetic + elastic + allowance.abs());
        if *reserve >= -noise {
            return;
        }
        let taken = self.remove_kinetic_energy(-*reserve, settings);
        summary.limited = taken;
        summary.end_energy[0] -= taken;
        *reserve = 0.0;
    }

    /// Changes the end velocity along the response to the contact forces until `excess` (J) is gone, or as far as that
    /// direction carries energy; returns what was removed.
    fn remove_kinetic_energy(&mut self, excess: f64, settings: &SolveSettings) -> f64 {
        self.rows.clear();
        self.multipliers.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let force = contact.multiplier[0].max(contact.remembered.normal);
            if force > 0.0 && !contact.is_hard {
                self.rows.push(RowDirection { contact: index, direction: contact.kinematics.normal });
                self.multipliers.push(force * settings.dt);
            }
        }
        if self.rows.is_empty() {
            return 0.0;
        }
        // Kinetic energy along v' + s z is a parabola in s; three samples give it exactly.
        let before = self.end_energy()[0];
        self.apply_rows(Response::Velocity, 1.0);
        let after = self.end_energy()[0];
        self.apply_rows(Response::Velocity, -2.0);
        let mirrored = self.end_energy()[0];
        let curvature = 0.5 * (after + mirrored) - before;
        let slope = 0.5 * (after - mirrored);
        let step = if curvature > 0.0 {
            let discriminant = slope * slope - 4.0 * curvature * excess;
            if discriminant > 0.0 {
                // The root nearer to zero of curvature s² + slope s + excess = 0.
                let root = discriminant.sqrt();
                if slope >= 0.0 { (-slope + root) / (2.0 * curvature) } else { (-slope - root) / (2.0 * curvature) }
            } else {
                -slope / (2.0 * curvature)
            }
        } else {
            0.0
        };
        self.apply_rows(Response::Velocity, 1.0 + step);
        let left = self.end_energy()[0];
        before - left
    }
}
