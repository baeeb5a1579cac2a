//! What a flexible block tells about its motion: positions, velocities, energy, momentum, and the state it commits.

use super::flex_block::{FlexBlock, spread_accelerations};
use crate::body::{FlexState, Frame};
use crate::fe::model::MassMatrix;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};

/// Energy and momentum of one motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Elastic energy (J).
    pub elastic: f64,
}

impl FlexBlock {
    /// Position of a node at the beginning of the step (m).
    pub fn start_position(&self, node: usize) -> Vec2 {
        node_vec(&self.start.position, node)
    }

    /// Velocity of a node at the beginning of the step (m/s).
    pub fn start_velocity(&self, node: usize) -> Vec2 {
        node_vec(&self.start.velocity, node)
    }

    /// Position of a node at the current iterate (m).
    pub fn position(&self, node: usize) -> Vec2 {
        node_vec(&self.position, node)
    }

    /// Velocity of a node at the current iterate (m/s).
    pub fn velocity(&self, node: usize) -> Vec2 {
        node_vec(&self.velocity, node)
    }

    /// Predicted position `q0` of a node (m).
    pub fn predicted_position(&self, node: usize) -> Vec2 {
        node_vec(&self.q0, node)
    }

    /// All positions of the current iterate, interleaved (m).
    pub fn positions(&self) -> &[f64] {
        &self.position
    }

    /// All velocities of the current iterate, interleaved (m/s).
    pub fn velocities(&self) -> &[f64] {
        &self.velocity
    }

    /// Whether a node carries no mass.
    pub fn is_massless(&self, node: usize) -> bool {
        self.model.is_massless(node)
    }

    /// Displacement of a node from the current iterate to the end of the step without contact (m).
    pub fn free_offset(&self, node: usize) -> Vec2 {
        let turn = rotation(self.angle);
        let swing = self.frame_spin_rate * perp(node_vec(&self.arms.reference, node));
        let increment = turn * (node_vec(&self.free_increment, node) + swing);
        node_vec(&self.q0, node) + self.step.weights.b0 * increment - node_vec(&self.position, node)
    }

    /// Acceleration of a node at the end of the step (m/s²).
    pub fn end_acceleration(&self, node: usize) -> Vec2 {
        node_vec(&self.start.acceleration, node) + node_vec(&self.increment, node)
    }

    /// Applied force at a node, gravity included (N).
    pub fn applied_force(&self, node: usize) -> Vec2 {
        node_vec(&self.force, node)
    }

    /// Takes a contact force on a node with mass out of the stored acceleration and velocity: its impulse is applied
    /// at velocity level instead.
    pub fn drop_hard_force(&mut self, node: usize, force: Vec2) {
        let mass = self.arms.node_mass[node];
        if mass > 0.0 && !self.is_fixed[2 * node] && !self.is_fixed[2 * node + 1] {
            add_node_vec(&mut self.increment, node, -force / mass);
            add_node_vec(&mut self.velocity, node, -self.step.weights.b1 * force / mass);
        }
    }

    /// Clears the impulses gathered for [`FlexBlock::apply_impulse`].
    pub fn clear_impulse(&mut self) {
        self.impulse.fill(0.0);
    }

    /// Gathers an impulse at a node (N s).
    pub fn gather_impulse(&mut self, node: usize, impulse: Vec2) {
        add_node_vec(&mut self.impulse, node, impulse);
    }

    /// Adds `scale` times the response to the gathered impulses to the velocities of the nodes with mass.
    pub fn scale_velocity_response(&mut self, scale: f64, response: &[f64]) {
        for (v, r) in self.velocity.iter_mut().zip(response) {
            *v += scale * r;
        }
    }

    /// Mobility of the whole body moving rigidly, `n·M⁻¹·n` at a node (1/kg); zero when its pins hold it.
    pub fn rigid_mobility(&self, node: usize, direction: Vec2) -> f64 {
        let centre = self.arms.centre(self.frame, &self.position);
        let lever = cross(node_vec(&self.position, node) - centre, direction);
        match self.frame {
            Frame::Fixed => 0.0,
            Frame::Hinged(_) => lever * lever / self.polar_inertia(centre),
            Frame::Free => 1.0 / self.arms.mass + lever * lever / self.polar_inertia(centre),
        }
    }

    fn polar_inertia(&self, centre: Vec2) -> f64 {
        let masses = self.arms.node_mass.iter().enumerate();
        masses.map(|(node, mass)| mass * (node_vec(&self.position, node) - centre).norm_squared()).sum()
    }

    /// Energy at the beginning of the step.
    pub fn start_balance(&mut self) -> Balance {
        let kinetic = 0.5 * self.model.mass().inner(&self.start.velocity, &self.start.velocity);
        let position = std::mem::take(&mut self.start.position);
        let elastic = self.elastic_energy(&position, self.start.angle);
        self.start.position = position;
        Balance { kinetic, elastic }
    }

    /// Energy of the current iterate.
    pub fn end_balance(&mut self) -> Balance {
        let kinetic = 0.5 * self.model.mass().inner(&self.velocity, &self.velocity);
        let position = std::mem::take(&mut self.position);
        let elastic = self.elastic_energy(&position, self.angle);
        self.position = position;
        Balance { kinetic, elastic }
    }

    fn elastic_energy(&mut self, position: &[f64], angle: f64) -> f64 {
        let centre = self.arms.centre(self.frame, position);
        let turn = rotation(-angle);
        for node in 0..self.model.n_nodes() {
            let u = turn * (node_vec(position, node) - centre) - node_vec(&self.arms.reference, node);
            set_node_vec(&mut self.local, node, u);
        }
        self.model.elastic_energy(&self.local)
    }

    /// Linear momentum (N s) and first moment of mass `Σ m x` (kg m).
    pub fn momentum(&self) -> (Vec2, Vec2) {
        let (mut momentum, mut moment) = (Vec2::zeros(), Vec2::zeros());
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            momentum += *mass * node_vec(&self.velocity, node);
            moment += *mass * node_vec(&self.position, node);
        }
        (momentum, moment)
    }

    /// Angular momentum about a point (N m s).
    pub fn angular_momentum(&self, about: Vec2) -> f64 {
        self.model.mass().moment(about, &self.position, &self.velocity)
    }

    /// Writes the support forces of all pinned nodes, interleaved (N).
    pub fn write_reactions(&self, reactions: &mut [f64]) {
        for node in 0..self.model.n_nodes() {
            set_node_vec(reactions, node, self.reaction(node));
        }
    }

    /// Work of the applied forces over the step, `Σ f·(x' - x)` (J).
    pub fn applied_work(&self) -> f64 {
        let moved = self.position.iter().zip(&self.start.position);
        moved.zip(&self.force).map(|((end, start), force)| force * (end - start)).sum()
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, state: &mut FlexState) {
        state.position.copy_from_slice(&self.position);
        state.velocity.copy_from_slice(&self.velocity);
        for ((end, start), increment) in
            state.acceleration.iter_mut().zip(&self.start.acceleration).zip(&self.increment)
        {
            *end = start + increment;
        }
        for (dof, &is_fixed) in self.is_fixed.iter().enumerate() {
            if is_fixed {
                state.velocity[dof] = (self.position[dof] - self.start.position[dof]) / self.step.dt;
                state.acceleration[dof] = 0.0;
            }
        }
        spread_accelerations(&self.model, &self.is_fixed, &mut state.acceleration);
        state.angle = self.angle;
    }

    /// Reaction at a pinned node, the force the pin exerts on the body (N).
    pub fn reaction(&self, node: usize) -> Vec2 {
        if !(self.is_fixed[2 * node] || self.is_fixed[2 * node + 1]) {
            return Vec2::zeros();
        }
        let rayleigh = self.model.rayleigh();
        let turn = rotation(self.angle);
        let centre = self.arms.centre(self.frame, &self.position);
        let stiffness = self.model.stiffness();
        let mut force = Vec2::zeros();
        for (&other, block) in stiffness.neighbours(node).iter().zip(stiffness.row_blocks(node)) {
            let other = other as usize;
            let u = turn.transpose() * (node_vec(&self.position, other) - centre)
                - node_vec(&self.arms.reference, other)
                + rayleigh.stiffness * (turn.transpose() * node_vec(&self.velocity, other));
            force += Vec2::new(block[0] * u.x + block[1] * u.y, block[2] * u.x + block[3] * u.y);
        }
        let mut reaction = turn * force - node_vec(&self.force, node) - node_vec(&self.contact_force, node);
        if let MassMatrix::Lumped(mass) = self.model.mass() {
            reaction += mass[node] * rayleigh.mass * node_vec(&self.velocity, node);
        }
        for axis in 0..2 {
            if !self.is_fixed[2 * node + axis] {
                reaction[axis] = 0.0;
            }
        }
        reaction
    }
}
