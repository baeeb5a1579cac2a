//! What a flexible block tells about its motion: positions, velocities, energy, momentum, and the state it commits.

use super::flex_block::FlexBlock;
use crate::body::{FlexState, Frame};
use crate::fe::model::{MassMatrix, Model};
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec, sum_over};

/// Energy of one motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Elastic energy (J).
    pub elastic: f64,
}

/// Momentum of one motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum (N s).
    pub linear: Vec2,
    /// Angular momentum about the origin (N m s).
    pub angular: f64,
    /// First moment of mass, `Σ m x` (kg m).
    pub first_moment: Vec2,
}

impl FlexBlock {
    /// Position of a node at the beginning of the step (m).
    pub fn start_position(&self, node: usize) -> Vec2 {
        node_vec(&self.start_position, node)
    }

    /// Where the velocity and acceleration of a node would take it (m).
    pub fn drift(&self, node: usize) -> Vec2 {
        let dt = self.step.dt;
        let own = rotation(self.start_frame.angle) * node_vec(&self.start_acceleration, node);
        let acceleration = self.start_frame.acceleration + own;
        let start = node_vec(&self.start_position, node);
        start + dt * node_vec(&self.start_velocity, node) + 0.5 * dt * dt * acceleration
    }

    /// Velocity at a node at the beginning of the step (m/s): that of the mass around a massless one, turned on to where it is.
    pub fn start_velocity(&self, node: usize) -> Vec2 {
        if let Some(large) = &self.large {
            return node_vec(&large.start_resolved, node);
        }
        let spin = self.start_frame.spin;
        self.turned_on(node, spin, [&self.start_position, &self.start_velocity])
    }

    /// Position of a node at the current iterate (m).
    pub fn position(&self, node: usize) -> Vec2 {
        node_vec(&self.position, node)
    }

    /// Velocity at a node at the current iterate (m/s): that of the mass around a massless one, whose own is a remainder
    /// without inertia, turned on to where the node is.
    pub fn velocity(&self, node: usize) -> Vec2 {
        if let Some(large) = &self.large {
            return node_vec(&large.resolved, node);
        }
        self.turned_on(node, self.frame.spin, [&self.position, &self.velocity])
    }

    /// Spin of the frame at the iterate (rad/s).
    pub fn spin(&self) -> f64 {
        self.frame.spin
    }

    /// Velocity at a node with mass; the mean of those that carry a massless node's mass, and the spin times the lever from them to it.
    fn turned_on(&self, node: usize, spin: f64, [position, velocity]: [&[f64]; 2]) -> Vec2 {
        let support = self.carried(node, |node| node_vec(position, node));
        let offset = node_vec(position, node) - support;
        self.carried(node, |node| node_vec(velocity, node)) + spin * perp(offset)
    }

    /// A value at a node with mass, or its mean over the nodes that carry a massless node's mass.
    fn carried(&self, node: usize, value: impl Fn(usize) -> Vec2) -> Vec2 {
        match self.model.support_of(node) {
            [] => value(node),
            support => {
                let sum: Vec2 = support.iter().map(|&massive| value(massive)).sum();
                sum / support.len() as f64
            }
        }
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

    /// Acceleration of a node at the end of the step, linear in the increments (m/s²).
    pub fn end_acceleration(&self, node: usize) -> Vec2 {
        if self.is_explicit() {
            return self.explicit_acceleration(node);
        }
        if let Some(large) = &self.large {
            return node_vec(&large.acceleration, node);
        }
        let own = self.carried(node, |node| {
            node_vec(&self.start_acceleration, node) + node_vec(&self.increment, node)
        });
        if self.kind == Frame::Fixed {
            return own;
        }
        let arm = node_vec(&self.position, node) - self.frame.centre;
        let rigid = self.frame_acceleration() + self.torque / self.inertia * perp(arm);
        rigid + self.turn * own
    }

    fn frame_acceleration(&self) -> Vec2 {
        match self.kind {
            Frame::Free => self.start_frame.acceleration + self.shift,
            _ => self.frame.acceleration,
        }
    }

    /// Writes the contact forces of the iterate, interleaved (N).
    pub fn write_contact_force(&self, forces: &mut [f64]) {
        forces.copy_from_slice(&self.contact_force);
    }

    /// Mobility of the whole body moving rigidly, `n·M⁻¹·n` at a node (1/kg); zero when its pins hold it.
    pub fn rigid_mobility(&self, node: usize, direction: Vec2) -> f64 {
        let centre = self.frame.centre;
        let lever = cross(node_vec(&self.position, node) - centre, direction);
        match self.kind {
            Frame::Fixed => 0.0,
            Frame::Hinged(_) => lever * lever / self.arms.polar,
            Frame::Free => 1.0 / self.arms.mass + lever * lever / self.arms.polar,
        }
    }

    pub(super) fn polar_inertia(&self, centre: Vec2) -> f64 {
        let masses = self.arms.node_mass.iter().enumerate();
        masses
            .map(|(node, mass)| mass * (node_vec(&self.position, node) - centre).norm_squared())
            .sum()
    }

    /// Energy at the beginning of the step.
    pub fn start_balance(&self) -> Balance {
        let [kinetic, elastic] = self.start_energy;
        Balance { kinetic, elastic }
    }

    /// Measures the elastic energy of the iterate, before anything but positions has been corrected.
    ///
    /// Where nothing else resists, `½ u·(f + Gᵀp - M (a + α v))` is what `½ u·K u` is, without the product.
    pub fn measure_elastic_energy(&mut self) {
        if self.is_explicit() {
            // One product gives this energy and the forces of the end.
            self.finish_explicitly();
            return;
        }
        if let Some(large) = &self.large {
            let flowed = large.deformation.flowed();
            let energy = large.model.energy_after(&self.position, flowed);
            (self.end_elastic, self.end_flow) = (energy.stored, energy.dissipated);
            return;
        }
        let rayleigh = self.model.rayleigh();
        let is_moved = self
            .fixed_dofs
            .iter()
            .any(|&dof| self.prescribed[dof] != 0.0);
        let is_direct = self.kind == Frame::Fixed && rayleigh.stiffness == 0.0 && !is_moved;
        self.end_elastic = match self.model.mass() {
            MassMatrix::Lumped(mass) if is_direct => {
                let n = self.n_dofs();
                let (start, increment) = (&self.start_acceleration[..n], &self.increment[..n]);
                let (velocity, u) = (&self.velocity[..n], &self.displacement[..n]);
                let (applied, contact) = (&self.force[..n], &self.contact_force[..n]);
                let mut twice = [0.0; 2];
                for (node, mass) in mass[..n / 2].iter().enumerate() {
                    for (axis, twice) in twice.iter_mut().enumerate() {
                        let dof = 2 * node + axis;
                        let acceleration =
                            start[dof] + increment[dof] + rayleigh.mass * velocity[dof];
                        let inner = applied[dof] + contact[dof] - mass * acceleration;
                        *twice += u[dof] * inner;
                    }
                }
                0.5 * (twice[0] + twice[1])
            }
            _ => self.model.elastic_energy(&self.displacement),
        };
    }

    /// What plastic flow dissipates in the step, as last measured (J).
    pub fn flow_energy(&self) -> f64 {
        self.end_flow
    }

    /// Energy of the current iterate; the elastic part as last measured, with what plastic flow dissipates in the step: the potential of the
    /// forces.
    pub fn end_balance(&self) -> Balance {
        Balance {
            kinetic: self.kinetic_energy(),
            elastic: self.end_elastic + self.end_flow,
        }
    }

    /// Kinetic energy of the current iterate (J).
    pub fn kinetic_energy(&self) -> f64 {
        0.5 * self.model.mass().inner(&self.velocity, &self.velocity)
    }

    /// Kinetic energy of the velocities that are not those of a rigid motion (J).
    pub fn vibration_energy(&mut self) -> f64 {
        self.split_rigid();
        0.5 * self.model.mass().inner(&self.local, &self.local)
    }

    /// Multiplies the velocities that are not those of a rigid motion; momentum stays what it is.
    pub fn scale_vibration(&mut self, factor: f64) {
        self.split_rigid();
        for (v, own) in self.velocity.iter_mut().zip(&self.local) {
            *v -= (1.0 - factor) * own;
        }
    }

    /// Writes the velocities less their rigid part, `Σ m v` and `Σ m (x - c) × v` removed, over `local`.
    fn split_rigid(&mut self) {
        self.local.copy_from_slice(&self.velocity);
        if self.kind == Frame::Fixed {
            return;
        }
        let centre = self
            .arms
            .centre(self.kind, &self.position, self.frame.centre);
        let drift = self
            .arms
            .centre(self.kind, &self.velocity, self.frame.velocity);
        let spin = self
            .model
            .mass()
            .moment(centre, &self.position, &self.velocity)
            - self.arms.mass * cross(self.mass_offset(centre), drift);
        let spin = spin / self.polar_inertia(centre);
        for node in 0..self.model.n_nodes() {
            let rigid = drift + spin * perp(node_vec(&self.position, node) - centre);
            add_node_vec(&mut self.local, node, -rigid);
        }
    }

    /// The mass centre from `centre` (m): zero for a free body.
    fn mass_offset(&self, centre: Vec2) -> Vec2 {
        self.arms.centre(Frame::Free, &self.position, centre) - centre
    }

    /// Momentum of the current iterate, that of rotation about the origin.
    pub fn momentum(&self) -> Momentum {
        let mut sums = Momentum::default();
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            let position = node_vec(&self.position, node);
            let momentum = *mass * node_vec(&self.velocity, node);
            sums.linear += momentum;
            sums.first_moment += *mass * position;
            sums.angular += cross(position, momentum);
        }
        if let MassMatrix::Consistent(_) = self.model.mass() {
            sums.angular = self.angular_momentum(Vec2::zeros());
        }
        sums
    }

    /// Angular momentum about a point (N m s).
    pub fn angular_momentum(&self, about: Vec2) -> f64 {
        self.model
            .mass()
            .moment(about, &self.position, &self.velocity)
    }

    /// Writes the support forces of all pinned nodes, interleaved (N).
    pub fn write_reactions(&self, reactions: &mut [f64]) {
        let mut last = None;
        for node in self.fixed_dofs.iter().map(|dof| dof / 2) {
            // Both dofs of a node follow each other.
            if last.replace(node) != Some(node) {
                set_node_vec(reactions, node, self.reaction(node));
            }
        }
    }

    /// Work of the applied forces over the step, `Σ f·(x' - x)`, of constant inner pressures, and of the pins that move, by the mean of their
    /// reactions (J).
    pub fn applied_work(&self) -> f64 {
        let arrays = [&self.force[..], &self.position, &self.start_position];
        let work = sum_over(arrays, |[force, end, start]| force * (end - start));
        let late = self.loads.late.iter().enumerate();
        let late = late.map(|(dof, f)| f * (self.position[dof] - self.start_position[dof]));
        let pressure = self.large.as_ref().map_or(0.0, |large| {
            let model = &large.model;
            model.pressure_work(&self.start_position, &self.position)
        });
        work + late.sum::<f64>() + self.pin_work() + pressure
    }

    fn pin_work(&self) -> f64 {
        if let Some(large) = &self.large {
            return self.large_pin_work(large);
        }
        let mut work = self.jump_work;
        for &dof in &self.fixed_dofs {
            let moved = self.position[dof] - self.start_position[dof];
            if moved != 0.0 {
                let end = self.reaction(dof / 2)[dof % 2];
                work += 0.5 * (self.start_reaction[dof] + end) * moved;
            }
        }
        work
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, state: &mut FlexState) {
        if self.is_explicit() {
            self.commit_explicitly(state);
            return;
        }
        if let Some(large) = &self.large {
            self.commit_large(large, state);
            return;
        }
        let kinetic_energy = self.kinetic_energy();
        state.position.copy_from_slice(&self.position);
        state.velocity.copy_from_slice(&self.velocity);
        state.displacement.copy_from_slice(&self.displacement);
        state.loads.last.clone_from(&self.loads.own);
        state.loads.lag = self.loads.lag;
        state.frame = self.frame;
        state.torque = match self.kind {
            // Nothing turns, and nobody asks.
            Frame::Fixed => 0.0,
            Frame::Free | Frame::Hinged(_) => self.torque,
        };
        state.elastic_energy = self.end_elastic;
        state.kinetic_energy = kinetic_energy;
        state.acceleration.copy_from_slice(&self.increment);
        for (end, start) in state.acceleration.iter_mut().zip(&self.start_acceleration) {
            *end += start;
        }
        // The sum, not the increment: what rounding leaves of a mean would add up.
        self.arms.split(self.kind, &mut state.acceleration);
        if self.kind == Frame::Free {
            // The increment may have changed since the frame was advanced: hard contacts, settled accelerations.
            state.frame.acceleration = self.frame_acceleration();
        }
        for &dof in &self.fixed_dofs {
            state.acceleration[dof] = 0.0;
            if self.kind == Frame::Fixed {
                state.velocity[dof] =
                    (self.position[dof] - self.start_position[dof]) / self.step.dt;
            }
        }
        self.settle_surface(state);
        state.split_position(&self.arms, self.kind);
        state.split_velocity(&self.arms, self.kind);
        spread_accelerations(&self.model, &self.is_fixed, &mut state.acceleration);
    }

    /// Gives massless nodes in contact the velocity they moved with: the trapezoidal rule would let it alternate for ever
    /// where a contact holds the position.
    fn settle_surface(&self, state: &mut FlexState) {
        if !self.has_contact_force {
            return;
        }
        for (node, _) in self.model.massless_support() {
            if node_vec(&self.contact_force, node) != Vec2::zeros() {
                let moved = node_vec(&self.position, node) - node_vec(&self.start_position, node);
                set_node_vec(&mut state.velocity, node, moved / self.step.dt);
            }
        }
    }

    /// Reaction at a pinned node, the force the pin exerts on the body (N).
    pub fn reaction(&self, node: usize) -> Vec2 {
        if !(self.is_fixed[2 * node] || self.is_fixed[2 * node + 1]) {
            return Vec2::zeros();
        }
        if let Some(large) = &self.large {
            return node_vec(&large.reaction, node);
        }
        let rayleigh = self.model.rayleigh();
        let stiffness = self.model.stiffness();
        let mut force = Vec2::zeros();
        for (&other, block) in stiffness
            .neighbours(node)
            .iter()
            .zip(stiffness.row_blocks(node))
        {
            let other = other as usize;
            let u = node_vec(&self.displacement, other)
                + rayleigh.stiffness * node_vec(&self.rate, other);
            force += Vec2::new(
                block[0] * u.x + block[1] * u.y,
                block[2] * u.x + block[3] * u.y,
            );
        }
        let turn = self.turn;
        let mut reaction =
            turn * force - node_vec(&self.force, node) - node_vec(&self.contact_force, node);
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

/// Gives massless nodes the mean acceleration of the nodes that carry their mass: their own is a remainder without
/// inertia that the trapezoidal rule would amplify.
pub(super) fn spread_accelerations(model: &Model, is_fixed: &[bool], acceleration: &mut [f64]) {
    for (node, support) in model.massless_support() {
        if support.is_empty() {
            continue;
        }
        let sum: Vec2 = support
            .iter()
            .map(|&massive| node_vec(acceleration, massive))
            .sum();
        let mean = sum / support.len() as f64;
        let old = node_vec(acceleration, node);
        let kept = |axis: usize| {
            if is_fixed[2 * node + axis] {
                old[axis]
            } else {
                mean[axis]
            }
        };
        set_node_vec(acceleration, node, Vec2::new(kept(0), kept(1)));
    }
}
