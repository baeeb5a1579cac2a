//! What a flexible block tells about its motion: positions, velocities, energy, momentum, reactions.

use super::block::{FlexBlock, Method};
use super::iterate::{Balance, Momentum};
use super::pins;
use crate::body::{Frame, FrameMotion};
use crate::math::{Vec2, add_node_vec, node_vec, perp, rotation, set_node_vec, sum_over};
use crate::system::common_motion::Hold;
use crate::system::moments::Moments;
use crate::system::pin_rates::RigidRates;

impl FlexBlock {
    /// What the frame turns about, at the iterate (m).
    pub fn centre(&self) -> Vec2 {
        self.shared.now.frame.centre
    }

    /// Centre of mass at the beginning of the step, if the body moves freely (m).
    pub fn start_centre(&self) -> Option<Vec2> {
        (self.shared.shape.kind == Frame::Free).then_some(self.shared.start.frame.centre)
    }

    /// Position of a node at the beginning of the step (m).
    pub fn start_position(&self, node: usize) -> Vec2 {
        node_vec(&self.shared.start.position, node)
    }

    /// All positions at the beginning of the step, interleaved (m).
    pub fn start_positions(&self) -> &[f64] {
        &self.shared.start.position
    }

    /// The frame at the beginning of the step.
    pub fn start_frame(&self) -> &FrameMotion {
        &self.shared.start.frame
    }

    /// Where the velocity and acceleration of a node would take it (m).
    pub fn drift(&self, node: usize) -> Vec2 {
        self.shared.start.drift(node, self.shared.step.dt)
    }

    /// Velocity at a node at the beginning of the step (m/s): that of the mass around a massless one, turned on to where it is.
    pub fn start_velocity(&self, node: usize) -> Vec2 {
        if let Some(large) = self.large_strain() {
            return node_vec(&large.start_resolved, node);
        }
        let (shape, start) = (&self.shared.shape, &self.shared.start);
        let motion = [&start.position[..], &start.velocity];
        shape.turned_on(node, start.frame.spin, motion)
    }

    /// That velocity without the one of the frame turned by as much as the frame since (m/s).
    pub fn approaching_velocity(&self, node: usize) -> Vec2 {
        let (start, now) = (&self.shared.start.frame, &self.shared.now.frame);
        let turn = match self.is_large() {
            // Its frame has no angle.
            true => 0.5 * self.shared.step.dt * (start.spin + now.spin),
            false => now.angle - start.angle,
        };
        start.velocity + rotation(turn) * (self.start_velocity(node) - start.velocity)
    }

    /// Position of a node at the current iterate (m).
    pub fn position(&self, node: usize) -> Vec2 {
        node_vec(&self.shared.now.position, node)
    }

    /// Velocity at a node at the current iterate (m/s): that of the mass around a massless one, whose own is a remainder
    /// without inertia, turned on to where the node is.
    pub fn velocity(&self, node: usize) -> Vec2 {
        if let Some(large) = self.large_strain() {
            return node_vec(&large.resolved, node);
        }
        let (shape, now) = (&self.shared.shape, &self.shared.now);
        let motion = [&now.position[..], &now.velocity];
        shape.turned_on(node, now.frame.spin, motion)
    }

    /// Spin of the frame at the iterate (rad/s).
    pub fn spin(&self) -> f64 {
        self.shared.now.frame.spin
    }

    /// Angle of the frame at the iterate (rad).
    pub fn angle(&self) -> f64 {
        self.shared.now.frame.angle
    }

    /// All positions of the current iterate, interleaved (m).
    pub fn positions(&self) -> &[f64] {
        &self.shared.now.position
    }

    /// All velocities of the current iterate, interleaved (m/s).
    pub fn velocities(&self) -> &[f64] {
        &self.shared.now.velocity
    }

    /// Acceleration of a node at the end of the step, linear in the increments, of small strain with this `share` of its vibration (m/s²).
    pub fn end_acceleration(&self, node: usize, share: f64) -> Vec2 {
        match &self.method {
            Method::Small(small) => small.end_acceleration(&self.shared, node, share),
            Method::Explicit(explicit) => node_vec(&explicit.acceleration, node),
            Method::Large(large) => node_vec(&large.acceleration, node),
        }
    }

    /// `dt²/8 a·M a` of an explicit block at the beginning and at the end of the step, zero of others (J).
    pub fn swing(&self) -> [f64; 2] {
        match &self.method {
            Method::Explicit(explicit) => explicit.swing,
            _ => [0.0; 2],
        }
    }

    /// Writes the contact forces of the iterate, interleaved (N).
    pub fn write_contact_force(&self, forces: &mut [f64]) {
        forces.copy_from_slice(&self.shared.contact.nodal);
    }

    /// Sum of the forces of the loads on a free body (N).
    pub fn resultant(&self) -> Vec2 {
        self.shared.loads.total
    }

    /// Whether the loads alone would send the body beyond what can be held: that is no matter of contact. What acts on pins moves nothing.
    pub fn is_overloaded(&self) -> bool {
        let shared = &self.shared;
        shared.loads.is_too_much(&shared.shape, shared.step.dt)
    }

    /// Kinetic energy that the loads would give in the step to the whole body at rest, if nothing held it (J).
    pub fn load_energy(&self) -> f64 {
        self.shared.loads.energy(self.shared.step.dt, self.mass())
    }

    /// Energy at the beginning of the step.
    pub fn start_balance(&self) -> Balance {
        let [kinetic, elastic] = self.shared.energy.start;
        Balance { kinetic, elastic }
    }

    /// What plastic flow dissipates in the step, as last measured (J).
    pub fn flow_energy(&self) -> f64 {
        self.shared.energy.flow
    }

    /// Energy of the current iterate; the elastic part as last measured, with what plastic flow dissipates in the step: the potential of the
    /// forces.
    pub fn end_balance(&self) -> Balance {
        Balance {
            kinetic: self.kinetic_energy(),
            elastic: self.shared.energy.elastic + self.shared.energy.flow,
        }
    }

    /// Kinetic energy of the current iterate (J).
    pub fn kinetic_energy(&self) -> f64 {
        self.shared.kinetic_energy()
    }

    /// Kinetic energy of the velocities that are not those of a rigid motion (J).
    pub fn vibration_energy(&mut self) -> f64 {
        let shared = &mut self.shared;
        shared.now.write_vibration(&shared.shape, &mut shared.local);
        0.5 * shared
            .shape
            .model
            .mass()
            .inner(&shared.local, &shared.local)
    }

    /// Multiplies the velocities that are not those of a rigid motion; momentum stays what it is.
    pub fn scale_vibration(&mut self, factor: f64) {
        let shared = &mut self.shared;
        shared.now.write_vibration(&shared.shape, &mut shared.local);
        for (v, own) in shared.now.velocity.iter_mut().zip(&shared.local) {
            *v -= (1.0 - factor) * own;
        }
    }

    /// Elastic energy that rounding of the positions may make and take (J): nothing for bodies of small strain, whose displacements are known.
    pub fn rounding_energy(&self) -> f64 {
        let large = self.large_strain();
        large.map_or(0.0, |large| large.rounding_energy(&self.shared))
    }

    /// Momentum of the current iterate, that of rotation about the origin.
    pub fn momentum(&self) -> Momentum {
        self.shared.now.momentum(&self.shared.shape)
    }

    /// Angular momentum about a point (N m s).
    pub fn angular_momentum(&self, about: Vec2) -> f64 {
        let shared = &self.shared;
        shared.now.angular_momentum(&shared.shape, about)
    }

    /// Writes the support forces of all pinned nodes, interleaved (N).
    pub fn write_reactions(&self, reactions: &mut [f64]) {
        let mut last = None;
        for node in self.shared.shape.fixed_dofs.iter().map(|dof| dof / 2) {
            // Both dofs of a node follow each other.
            if last.replace(node) != Some(node) {
                set_node_vec(reactions, node, self.reaction(node));
            }
        }
        if !self.shared.pin_push.is_empty() {
            for &dof in &self.shared.shape.fixed_dofs {
                reactions[dof] += self.shared.pin_push[dof];
            }
        }
    }

    /// Work of the applied forces over the step, `Σ f·(x' - x)`, of constant inner pressures, and of the pins that move, by the mean of their
    /// reactions (J).
    pub fn applied_work(&self) -> f64 {
        let arrays = [
            &self.shared.loads.force[..],
            &self.shared.now.position,
            &self.shared.start.position,
        ];
        let work = sum_over(arrays, |[force, end, start]| force * (end - start));
        let late = self.shared.loads.late.iter().enumerate();
        let late = late
            .map(|(dof, f)| f * (self.shared.now.position[dof] - self.shared.start.position[dof]));
        let pressure = self.large_strain().map_or(0.0, |large| {
            let model = large.model();
            model.pressure_work(&self.shared.start.position, &self.shared.now.position)
        });
        work + late.sum::<f64>() + self.pin_work() + pressure
    }

    fn pin_work(&self) -> f64 {
        match self.large_strain() {
            Some(large) => large.pin_work(&self.shared),
            None => pins::work(&self.shared),
        }
    }

    /// Reaction at a pinned node, the force the pin exerts on the body (N).
    pub fn reaction(&self, node: usize) -> Vec2 {
        match self.large_strain() {
            Some(large) => node_vec(large.reaction(), node),
            None => pins::reaction(&self.shared, node),
        }
    }

    /// Whether the body follows forces, as its pins tell.
    pub(in crate::system) fn pinned_hold(&self) -> Hold {
        let shared = &self.shared;
        let fixed_dofs = &shared.shape.fixed_dofs;
        let is_moved = |dof: &usize| shared.now.position[*dof] != shared.start.position[*dof];
        if self.is_explicit() || fixed_dofs.iter().any(is_moved) {
            return Hold::Led;
        }
        match fixed_dofs.is_empty() {
            true => Hold::Free,
            false => Hold::Held,
        }
    }

    /// Whether the motion of the frame is that of a free body.
    pub(in crate::system) fn is_free(&self) -> bool {
        self.shared.shape.kind == Frame::Free
    }

    /// Kinetic energies of the motion at the end of the step, of the common part of it, and of the rest alone (J).
    pub(in crate::system) fn energies_about(&mut self, common: &RigidRates) -> [f64; 3] {
        let shared = &mut self.shared;
        let (mass, now, room) = (shared.shape.model.mass(), &shared.now, &mut shared.local);
        let whole = 0.5 * mass.inner(&now.velocity, &now.velocity);
        common.write_at(&now.position, room);
        let part = 0.5 * mass.inner(room, room);
        for (own, velocity) in room.iter_mut().zip(&now.velocity) {
            *own = velocity - *own;
        }
        [whole, part, 0.5 * mass.inner(room, room)]
    }

    /// Multiplies what the body does beyond a common motion.
    pub(in crate::system) fn scale_about(&mut self, common: &RigidRates, scale: f64) {
        let less = scale - 1.0;
        for node in 0..self.shared.shape.model.n_nodes() {
            let now = &self.shared.now;
            let place = node_vec(&now.position, node);
            let change = less * (node_vec(&now.velocity, node) - common.at(place));
            self.add_velocity(node, change);
        }
        if self.is_free() {
            let frame = &mut self.shared.now.frame;
            frame.velocity += less * (frame.velocity - common.at(frame.centre));
        }
    }

    /// The motion of its frame at the end of the step.
    pub(in crate::system) fn frame_motion(&self) -> RigidRates {
        let frame = &self.shared.now.frame;
        RigidRates {
            about: frame.centre,
            velocity: frame.velocity,
            spin: frame.spin,
        }
    }

    /// The acceleration that applied forces give a free body everywhere alike (m/s²); `None` if something holds, damps or turns it.
    pub(in crate::system) fn uniform_acceleration(&self) -> Option<Vec2> {
        let is_free = self.is_free() && self.shared.shape.model.rayleigh().mass == 0.0;
        self.shared.loads.uniform.filter(|_| is_free)
    }

    /// The acceleration that applied forces give a free body as a whole, zero for others (m/s²).
    pub(in crate::system) fn drive(&self) -> Vec2 {
        if self.is_free() {
            self.shared.loads.total / self.shared.shape.arms.mass
        } else {
            Vec2::zeros()
        }
    }

    /// Moments of a free body at the beginning of the step.
    pub(in crate::system) fn start_moments(&self) -> Moments {
        let (arms, start) = (&self.shared.shape.arms, &self.shared.start);
        Moments {
            mass: arms.mass,
            centre: start.frame.centre,
            velocity: start.frame.velocity,
            spin_momentum: start.momentum,
            inertia: arms.polar,
        }
    }

    /// Moments of a free body at the end of the step.
    pub(in crate::system) fn end_moments(&self) -> Moments {
        let (shape, now) = (&self.shared.shape, &self.shared.now);
        Moments {
            mass: shape.arms.mass,
            centre: now.frame.centre,
            velocity: now.frame.velocity,
            spin_momentum: now.angular_momentum(shape, now.frame.centre),
            inertia: match self.is_large() {
                true => now.inertia,
                false => shape.inertia_of(&now.displacement),
            },
        }
    }

    /// Adds a rigid motion about the centre to the end velocity (m/s, rad/s).
    pub(in crate::system) fn add_rigid_velocity(&mut self, velocity: Vec2, spin: f64) {
        let centre = self.shared.now.frame.centre;
        self.shared.now.frame.velocity += velocity;
        for node in 0..self.shared.shape.model.n_nodes() {
            let arm = node_vec(&self.shared.now.position, node) - centre;
            self.add_velocity(node, velocity + spin * perp(arm));
        }
    }

    fn add_velocity(&mut self, node: usize, change: Vec2) {
        add_node_vec(&mut self.shared.now.velocity, node, change);
        if let Method::Large(large) = &mut self.method {
            add_node_vec(&mut large.resolved, node, change);
        }
    }
}
