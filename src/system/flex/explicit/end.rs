//! The end of an explicit step: internal forces, velocities, energies, impulses and the state to commit.

use super::{Explicit, frame_correction, lag};
use crate::body::FlexState;
use crate::fe::model::MassMatrix;
use crate::math::{Vec2, add_node_vec, node_vec, perp, set_node_vec};
use crate::system::flex::shape::Shape;
use crate::system::flex::shared::Shared;

impl Explicit {
    /// Measures the internal forces at the end of the step, and from them the elastic energy and the velocities.
    pub fn finish(&mut self, shared: &mut Shared) {
        let (lag, dt) = (lag(shared), shared.step.dt);
        let stiffness = shared.shape.model.stiffness();
        stiffness.multiply(&shared.now.displacement, &mut shared.scratch);
        let mut twice = 0.0;
        for (dof, &elastic) in shared.scratch.iter().enumerate() {
            twice += shared.now.displacement[dof] * elastic;
            self.internal[dof] = (1.0 + lag) * elastic - lag * self.elastic[dof];
            self.elastic[dof] = elastic;
            shared.now.rate[dof] =
                (shared.now.displacement[dof] - self.start_displacement[dof]) / dt;
        }
        shared.energy.elastic = 0.5 * twice;
        // Before the end takes the place of the beginning.
        let early = dt - shared.step.weights.b1;
        for (velocity, acceleration) in shared.now.velocity.iter_mut().zip(&self.acceleration) {
            *velocity += early * acceleration;
        }
        self.accelerate(shared, false);
        self.end_velocities(shared);
        self.late_start.copy_from_slice(&self.late_force);
        self.is_known = true;
        self.is_new = false;
    }

    /// Adds the end's acceleration and the impulses of contacts; `velocity` holds the rest.
    fn end_velocities(&mut self, shared: &mut Shared) {
        let (dt, b1) = (shared.step.dt, shared.step.weights.b1);
        let alpha = shared.shape.model.rayleigh().mass;
        let MassMatrix::Lumped(mass) = shared.shape.model.mass() else {
            return;
        };
        for (dof, velocity) in shared.now.velocity.iter_mut().enumerate() {
            let mass = mass[dof / 2];
            if mass <= 0.0 || shared.shape.is_fixed[dof] {
                *velocity = (shared.now.position[dof] - shared.start.position[dof]) / dt;
                continue;
            }
            let kick = 0.5 * dt / mass * shared.contact.nodal[dof];
            let smooth = self.acceleration[dof] - alpha * kick;
            *velocity = (*velocity + b1 * smooth + 2.0 * kick) / (1.0 + b1 * alpha);
            self.acceleration[dof] -= alpha * (*velocity + kick);
            self.kick[dof] = kick;
        }
        let Shape { arms, kind, .. } = &shared.shape;
        let near = shared.start.frame.velocity;
        shared.now.frame.velocity = arms.centre(*kind, &shared.now.velocity, near);
    }

    /// Writes the velocities that the gathered impulses give (m/s): those at massless nodes reach the masses
    /// through the stiffness, as forces there do.
    pub fn respond(&mut self, shared: &mut Shared) {
        if !shared.impulses.velocity.is_used {
            return;
        }
        shared.scratch.fill(0.0);
        self.relax_impulse(shared);
        let stiffness = shared.shape.model.stiffness();
        stiffness.multiply(&shared.scratch, &mut shared.local);
        let twist = frame_correction(shared, &shared.local);
        let MassMatrix::Lumped(mass) = shared.shape.model.mass() else {
            return;
        };
        let impulses = &mut shared.impulses.velocity;
        for (node, &mass) in mass.iter().enumerate() {
            let own =
                node_vec(&impulses.nodal, node) - shared.now.turn * node_vec(&shared.local, node);
            let arm = shared.now.turn * node_vec(&shared.shape.arms.reference, node);
            let change = if mass > 0.0 {
                own / mass + twist * perp(arm)
            } else {
                Vec2::zeros()
            };
            set_node_vec(&mut impulses.response, node, change);
        }
        for &dof in &shared.shape.fixed_dofs {
            impulses.response[dof] = 0.0;
        }
    }

    /// Writes what the impulses at massless nodes would displace those, as forces, over `scratch`.
    fn relax_impulse(&mut self, shared: &mut Shared) {
        let (surface, back) = (&mut self.surface, shared.now.turn.transpose());
        for (slot, &node) in surface.nodes.iter().enumerate() {
            let mut impulse = back * node_vec(&shared.impulses.velocity.nodal, node);
            for axis in 0..2 {
                if shared.shape.is_fixed[2 * node + axis] {
                    impulse[axis] = 0.0;
                }
            }
            set_node_vec(&mut surface.local, slot, impulse);
        }
        if surface.nodes.is_empty() {
            return;
        }
        shared.answer.solve(&mut surface.local);
        for (slot, &node) in surface.nodes.iter().enumerate() {
            set_node_vec(&mut shared.scratch, node, node_vec(&surface.local, slot));
        }
    }

    /// Adds the force of a quasi-static contact on a mass (N): it accelerates the mass from the end of the step on.
    pub fn add_late_force(&mut self, node: usize, force: Vec2) {
        add_node_vec(&mut self.late_force, node, force);
        self.has_late_force = true;
    }

    /// Clears the forces of the iterate on masses by quasi-static contacts.
    pub fn clear_late_force(&mut self) {
        if self.has_late_force {
            self.late_force.fill(0.0);
            self.has_late_force = false;
        }
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, shared: &Shared, state: &mut FlexState) {
        state.kinetic_energy = shared.kinetic_energy();
        state.elastic_energy = shared.energy.elastic;
        state.position.copy_from_slice(&shared.now.position);
        state.velocity.copy_from_slice(&shared.now.velocity);
        state.displacement.copy_from_slice(&shared.now.displacement);
        state.frame = shared.now.frame;
        state.torque = 0.0;
        state.loads.last.force.clear();
        let back = shared.now.turn.transpose();
        for node in 0..shared.shape.model.n_nodes() {
            let acceleration = back * node_vec(&self.acceleration, node);
            set_node_vec(&mut state.acceleration, node, acceleration);
        }
        let (shift, spin_rate) = shared
            .shape
            .arms
            .split(shared.shape.kind, &mut state.acceleration);
        state.frame.acceleration = shared.now.turn * shift;
        state.frame.spin_rate = spin_rate;
        state.split_velocity(&shared.shape.arms, shared.shape.kind);
    }
}
