//! The end of an explicit step: internal forces, velocities, energies, impulses and the state to commit.

use super::flex_block::FlexBlock;
use crate::body::{FlexState, Frame};
use crate::fe::material::Rayleigh;
use crate::fe::model::MassMatrix;
use crate::math::{Vec2, add_node_vec, node_vec, perp, set_node_vec};

impl FlexBlock {
    /// Measures the internal forces at the end of the step, and from them the elastic energy and the velocities.
    pub(super) fn finish_explicitly(&mut self) {
        let (lag, dt) = (self.lag(), self.step.dt);
        let stiffness = self.model.stiffness();
        stiffness.multiply(&self.displacement, &mut self.scratch);
        let explicit = &mut self.explicit;
        let mut twice = 0.0;
        for (dof, &elastic) in self.scratch.iter().enumerate() {
            twice += self.displacement[dof] * elastic;
            explicit.internal[dof] = (1.0 + lag) * elastic - lag * explicit.elastic[dof];
            explicit.elastic[dof] = elastic;
            self.rate[dof] = (self.displacement[dof] - explicit.start_displacement[dof]) / dt;
        }
        self.end_elastic = 0.5 * twice;
        // Before the end takes the place of the beginning.
        let early = dt - self.step.weights.b1;
        for (velocity, acceleration) in self.velocity.iter_mut().zip(&explicit.acceleration) {
            *velocity += early * acceleration;
        }
        self.accelerate(false);
        self.end_velocities();
        let explicit = &mut self.explicit;
        explicit.late_start.copy_from_slice(&explicit.late_force);
        explicit.is_known = true;
        explicit.is_new = false;
    }

    /// Adds the end's acceleration and the impulses of contacts; `velocity` holds the rest.
    fn end_velocities(&mut self) {
        let (dt, b1) = (self.step.dt, self.step.weights.b1);
        let alpha = self.model.rayleigh().mass;
        let explicit = &mut self.explicit;
        let MassMatrix::Lumped(mass) = self.model.mass() else {
            return;
        };
        for (dof, velocity) in self.velocity.iter_mut().enumerate() {
            let mass = mass[dof / 2];
            if mass <= 0.0 || self.is_fixed[dof] {
                *velocity = (self.position[dof] - self.start_position[dof]) / dt;
                continue;
            }
            let kick = 0.5 * dt / mass * self.contact_force[dof];
            let smooth = explicit.acceleration[dof] - alpha * kick;
            *velocity = (*velocity + b1 * smooth + 2.0 * kick) / (1.0 + b1 * alpha);
            explicit.acceleration[dof] -= alpha * (*velocity + kick);
            explicit.kick[dof] = kick;
        }
        self.frame.velocity =
            self.arms
                .centre(self.kind, &self.velocity, self.start_frame.velocity);
    }

    /// Writes the velocities that the gathered impulses give (m/s): those at massless nodes reach the masses
    /// through the stiffness, as forces there do.
    pub fn respond_to_surface_impulse(&mut self) {
        if !self.impulses[0].is_used {
            return;
        }
        self.scratch.fill(0.0);
        self.relax_impulse();
        let stiffness = self.model.stiffness();
        stiffness.multiply(&self.scratch, &mut self.local);
        let twist = self.frame_correction(&self.local);
        let MassMatrix::Lumped(mass) = self.model.mass() else {
            return;
        };
        let impulses = &mut self.impulses[0];
        for (node, &mass) in mass.iter().enumerate() {
            let own = node_vec(&impulses.nodal, node) - self.turn * node_vec(&self.local, node);
            let arm = self.turn * node_vec(&self.arms.reference, node);
            let change = if mass > 0.0 {
                own / mass + twist * perp(arm)
            } else {
                Vec2::zeros()
            };
            set_node_vec(&mut impulses.response, node, change);
        }
        for &dof in &self.fixed_dofs {
            impulses.response[dof] = 0.0;
        }
    }

    /// Writes what the impulses at massless nodes would displace those, as forces, over `scratch`.
    fn relax_impulse(&mut self) {
        let (surface, back) = (&mut self.explicit.surface, self.turn.transpose());
        for (slot, &node) in surface.nodes.iter().enumerate() {
            let mut impulse = back * node_vec(&self.impulses[0].nodal, node);
            for axis in 0..2 {
                if self.is_fixed[2 * node + axis] {
                    impulse[axis] = 0.0;
                }
            }
            set_node_vec(&mut surface.local, slot, impulse);
        }
        if surface.nodes.is_empty() {
            return;
        }
        self.factor.solve_in_place(&mut surface.local);
        self.n_solves += 1;
        for (slot, &node) in surface.nodes.iter().enumerate() {
            set_node_vec(&mut self.scratch, node, node_vec(&surface.local, slot));
        }
    }

    /// Adds that response to the end velocity.
    pub fn add_surface_response(&mut self, scale: f64) {
        if !self.impulses[0].is_used {
            return;
        }
        for (velocity, response) in self.velocity.iter_mut().zip(&self.impulses[0].response) {
            *velocity += scale * response;
        }
        if self.kind == Frame::Free {
            self.frame.velocity += scale * self.impulses[0].total / self.arms.mass;
        }
    }

    /// Whether the material damps.
    pub fn is_damped(&self) -> bool {
        let Rayleigh { mass, stiffness } = self.model.rayleigh();
        mass > 0.0 || stiffness > 0.0
    }

    /// `dt²/8 a·M a` at the beginning and at the end of the step (J).
    pub(super) fn swing(&self) -> [f64; 2] {
        self.explicit.swing
    }

    /// Smooth acceleration of a node at the end of the step (m/s²).
    pub(super) fn explicit_acceleration(&self, node: usize) -> Vec2 {
        node_vec(&self.explicit.acceleration, node)
    }

    /// Adds a contact force at a node (N). In an explicit step a force on a mass is an impulse at the forward increment;
    /// if `is_late`, that of a quasi-static contact, it accelerates the mass from the end of the step on.
    pub fn add_stage_force(&mut self, node: usize, force: Vec2, lever: Vec2, is_late: bool) {
        if is_late && !self.is_massless(node) {
            add_node_vec(&mut self.explicit.late_force, node, force);
            self.explicit.has_late_force = true;
        } else {
            self.add_contact_force(node, force, lever);
        }
    }

    /// Clears the forces of the iterate on masses by quasi-static contacts.
    pub(super) fn clear_late_force(&mut self) {
        if self.explicit.has_late_force {
            self.explicit.late_force.fill(0.0);
            self.explicit.has_late_force = false;
        }
    }

    /// Writes the end of the step over the committed state.
    pub(super) fn commit_explicitly(&self, state: &mut FlexState) {
        state.kinetic_energy = self.kinetic_energy();
        state.elastic_energy = self.end_elastic;
        state.position.copy_from_slice(&self.position);
        state.velocity.copy_from_slice(&self.velocity);
        state.displacement.copy_from_slice(&self.displacement);
        state.frame = self.frame;
        state.torque = 0.0;
        state.loads.last.force.clear();
        let back = self.turn.transpose();
        for node in 0..self.model.n_nodes() {
            let acceleration = back * node_vec(&self.explicit.acceleration, node);
            set_node_vec(&mut state.acceleration, node, acceleration);
        }
        let (shift, spin_rate) = self.arms.split(self.kind, &mut state.acceleration);
        state.frame.acceleration = self.turn * shift;
        state.frame.spin_rate = spin_rate;
        state.split_velocity(&self.arms, self.kind);
    }
}
