//! Where a step by Beta-2 ends: what it answers to contacts there, its velocities, ways back to its beginning, and the state to commit.

use super::SmallStrain;
use super::solve::{AT_REST, largest_displacement};
use crate::body::{FlexState, Frame, FrameMotion};
use crate::fe::model::MassMatrix;
use crate::integrator::Weights;
use crate::math::{Mat2, Vec2, cos, node_vec, perp, rotation, set_node_vec};
use crate::system::flex::impulse::Gathered;
use crate::system::flex::pins::note_hinge_push;
use crate::system::flex::shared::Shared;
use crate::system::rigid_way::RigidWay;
use crate::system::step::Response;

impl SmallStrain {
    /// Makes [`SmallStrain::compliance`] known from `node`.
    pub fn prepare(&mut self, shared: &mut Shared, node: usize) {
        let is_fixed = &shared.shape.is_fixed;
        self.following.prepare(node, is_fixed);
        shared.answer.prepare(node, is_fixed);
    }

    /// See [`Block::compliance`](crate::system::Block::compliance).
    ///
    /// `A⁻¹` turns the body by the reference arms; the angle follows the levers of the forces instead, as the balance of
    /// angular momentum does. Between stiff contacts the difference would be amplified by `(ω dt)²`.
    pub fn compliance(
        &self,
        shared: &Shared,
        (at, at_lever): (usize, Vec2),
        (from, from_lever): (usize, Vec2),
        of: Response,
    ) -> Mat2 {
        let mut local = shared.answer.compliance.get(at, from);
        if of == Response::Position
            && let Some(more) = self.following.beyond_answer(shared, at, from)
        {
            local += more;
        }
        if shared.shape.kind == Frame::Fixed {
            return local;
        }
        let world = shared.now.turn * local * shared.now.turn.transpose();
        let [by_levers, by_arms] = turning(shared, of);
        let [at_arm, from_arm] = [at, from].map(|node| shared.turn_arm(node));
        world + by_levers * perp(at_lever) * perp(from_lever).transpose()
            - by_arms * at_arm * from_arm.transpose()
    }

    /// What the springs between surface and masses give of it, see [`Following::spring_compliance`](super::following::Following::spring_compliance).
    pub fn spring_compliance(&self, shared: &Shared, at: usize, from: usize) -> Mat2 {
        self.following.spring_compliance(shared, at, from)
    }

    /// How a node moves under the couples of forces beyond what `A⁻¹` answers to these: see [`Self::compliance`].
    pub fn turned(
        shared: &Shared,
        (node, lever): (usize, Vec2),
        couples: [f64; 2],
        of: Response,
    ) -> Vec2 {
        if shared.shape.kind == Frame::Fixed {
            return Vec2::zeros();
        }
        let [by_levers, by_arms] = turning(shared, of);
        by_levers * couples[0] * perp(lever) - by_arms * couples[1] * shared.turn_arm(node)
    }

    /// Share of its size by which a turn of the frame that [`solve`](Self::solve) has found changes the places that it found (-).
    ///
    /// Forces have turned against the displacements, as far as these reach, and the spin has changed with the turn by `2 δθ/dt`: what it
    /// presses outwards by answers within `dt²/4 · 2 ω 2δθ/dt · r = dt ω δθ r`, with Coriolis' forces by less than four times that. What stretches the
    /// body turns it back.
    pub fn turning_share(shared: &Shared) -> f64 {
        let turn = shared.step.dt * shared.now.frame.spin.abs();
        if turn <= AT_REST {
            return 1.0;
        }
        let levers = turned_back(shared);
        (largest_displacement(shared) / shared.shape.size + 2.0 * turn + levers).min(1.0)
    }

    /// Adds a multiple of an acceleration's response; the centre's is `mean` (m/s²).
    pub fn add_acceleration(&mut self, gathered: &Gathered, mean: Vec2, scale: f64) {
        self.torque += scale * gathered.moment;
        self.shift += mean;
        for (sum, response) in self.increment.iter_mut().zip(&gathered.response) {
            *sum += scale * response;
        }
    }

    /// Puts the iterate back to the beginning of the step.
    pub fn restart(&mut self, shared: &mut Shared) {
        let dt = shared.step.dt;
        let half = 0.5 * dt * dt;
        for (dof, acceleration) in shared.start.acceleration.iter().enumerate() {
            let rate = self.rate_q[dof] - dt * acceleration;
            shared.now.rate[dof] = rate;
            shared.now.displacement[dof] =
                self.displacement_q[dof] - dt * rate - half * acceleration;
        }
        let now = &mut shared.now;
        let placed: [&mut [f64]; 2] = [&mut now.displacement, &mut now.rate];
        self.following.restart(&self.displacement_q, placed);
        shared.now.frame = self.frame_q;
        shared.now.inertia = shared.shape.arms.polar;
        self.solved_angle = None;
        shared.contact.clear();
        shared.now.place(&shared.shape);
    }

    /// Ends the step where it began, without velocities.
    pub fn hold(&mut self, shared: &mut Shared) {
        self.restart(shared);
        let start = shared.start.frame;
        shared.now.frame = FrameMotion {
            centre: start.centre,
            angle: start.angle,
            ..Default::default()
        };
        shared.now.rate.fill(0.0);
        for (increment, acceleration) in self.increment.iter_mut().zip(&shared.start.acceleration) {
            *increment = -acceleration;
        }
        self.shift = -start.acceleration;
        self.torque = 0.0;
        shared.now.place(&shared.shape);
    }

    /// Ends the step where it began, moving as a rigid body with this velocity of its centre (m/s) and spin (rad/s).
    pub fn move_on(&mut self, shared: &mut Shared, velocity: Vec2, spin: f64) {
        self.hold(shared);
        (shared.now.frame.velocity, shared.now.frame.spin) = (velocity, spin);
        if shared.shape.kind == Frame::Fixed {
            for node in 0..shared.shape.model.n_nodes() {
                let arm = node_vec(&shared.now.position, node) - shared.now.frame.centre;
                set_node_vec(&mut shared.now.rate, node, velocity + spin * perp(arm));
            }
        }
        shared.now.place(&shared.shape);
    }

    /// Ends the step as a rigid motion leads it, undeformed further; free bodies only.
    pub fn carry_on(&mut self, shared: &mut Shared, way: &RigidWay) {
        self.hold(shared);
        shared.now.frame.centre = way.end(shared.start.frame.centre);
        shared.now.frame.angle = shared.start.frame.angle + way.turn;
        shared.now.frame.velocity = way.velocity_at(shared.now.frame.centre);
        shared.now.frame.spin = way.spin;
        self.shift += way.acceleration;
        shared.now.place(&shared.shape);
    }

    /// Puts the nodes where the step could go (m), with the velocities and accelerations that its forces lead to.
    pub fn stop_at(shared: &mut Shared, positions: &[f64]) {
        shared.now.position.copy_from_slice(positions);
        if shared.shape.kind == Frame::Fixed {
            let pairs = shared
                .now
                .position
                .iter()
                .zip(shared.shape.model.placed_positions());
            for (u, (x, rest)) in shared.now.displacement.iter_mut().zip(pairs) {
                *u = x - rest;
            }
            return;
        }
        let centre = shared.shape.arms.centre(
            shared.shape.kind,
            &shared.now.position,
            shared.now.frame.centre,
        );
        let angle = shared
            .shape
            .arms
            .angle(&shared.now.position, centre, shared.now.frame.angle);
        (shared.now.frame.centre, shared.now.frame.angle) = (centre, angle);
        shared.now.turn = rotation(angle);
        shared.now.displace(&shared.shape);
        shared.now.inertia = shared.shape.inertia_of(&shared.now.displacement);
    }

    /// World velocities of the last iterate: nothing asks for them before.
    pub fn place_velocities(&mut self, shared: &mut Shared) {
        self.following.follow_rates(shared);
        if shared.shape.kind == Frame::Fixed {
            shared.now.velocity.copy_from_slice(&shared.now.rate);
            return;
        }
        let (frame, turn) = (&shared.now.frame, shared.now.turn);
        for node in 0..shared.shape.model.n_nodes() {
            let arm = node_vec(&shared.shape.arms.reference, node)
                + node_vec(&shared.now.displacement, node);
            let own = node_vec(&shared.now.rate, node) + frame.spin * perp(arm);
            set_node_vec(&mut shared.now.velocity, node, frame.velocity + turn * own);
        }
        note_hinge_push(shared);
    }

    /// Acceleration of a node at the end of the step, linear in the increments, with so much of its vibration (m/s²).
    pub fn end_acceleration(&self, shared: &Shared, node: usize, share: f64) -> Vec2 {
        let own = shared.shape.carried(node, |node| {
            node_vec(&shared.start.acceleration, node) + node_vec(&self.increment, node)
        });
        if shared.shape.kind == Frame::Fixed {
            return own;
        }
        let arm = node_vec(&shared.now.position, node) - shared.now.frame.centre;
        let rigid = self.frame_acceleration(shared) + self.torque / shared.now.inertia * perp(arm);
        rigid + share * (shared.now.turn * own)
    }

    fn frame_acceleration(&self, shared: &Shared) -> Vec2 {
        match shared.shape.kind {
            Frame::Free => shared.start.frame.acceleration + self.shift,
            _ => shared.now.frame.acceleration,
        }
    }

    /// Measures the elastic energy of the iterate, before anything but positions has been corrected.
    ///
    /// Where nothing else resists, `½ u·(f + Gᵀp - M (a + α v))` is what `½ u·K u` is, without the product.
    pub fn measure_elastic_energy(&self, shared: &mut Shared) {
        let rayleigh = shared.shape.model.rayleigh();
        let is_moved = shared
            .shape
            .fixed_dofs
            .iter()
            .any(|&dof| shared.loads.prescribed[dof] != 0.0);
        let is_direct = shared.shape.kind == Frame::Fixed && rayleigh.stiffness == 0.0 && !is_moved;
        shared.energy.elastic = match shared.shape.model.mass() {
            MassMatrix::Lumped(mass) if is_direct => {
                let n = shared.shape.n_dofs();
                let (start, increment) = (&shared.start.acceleration[..n], &self.increment[..n]);
                let (velocity, u) = (&shared.now.velocity[..n], &shared.now.displacement[..n]);
                let (applied, contact) = (&shared.loads.force[..n], &shared.contact.nodal[..n]);
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
            _ => shared.shape.model.elastic_energy(&shared.now.displacement),
        };
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, shared: &Shared, state: &mut FlexState) {
        let kinetic_energy = shared.kinetic_energy();
        state.position.copy_from_slice(&shared.now.position);
        state.velocity.copy_from_slice(&shared.now.velocity);
        state.displacement.copy_from_slice(&shared.now.displacement);
        state.loads.last.clone_from(&shared.loads.own);
        state.loads.lag = shared.loads.lag;
        state.pin_push.clone_from(&shared.pin_push);
        state.frame = shared.now.frame;
        state.torque = match shared.shape.kind {
            // Nothing turns, and nobody asks.
            Frame::Fixed => 0.0,
            Frame::Free | Frame::Hinged(_) => self.torque,
        };
        state.elastic_energy = shared.energy.elastic;
        state.kinetic_energy = kinetic_energy;
        state.acceleration.copy_from_slice(&self.increment);
        for (end, start) in state
            .acceleration
            .iter_mut()
            .zip(&shared.start.acceleration)
        {
            *end += start;
        }
        // The sum, not the increment: what rounding leaves of a mean would add up.
        shared
            .shape
            .arms
            .split(shared.shape.kind, &mut state.acceleration);
        if shared.shape.kind == Frame::Free {
            // The increment may have changed since the frame was advanced: hard contacts, settled accelerations.
            state.frame.acceleration = self.frame_acceleration(shared);
        }
        for &dof in &shared.shape.fixed_dofs {
            state.acceleration[dof] = 0.0;
            if shared.shape.kind == Frame::Fixed {
                state.velocity[dof] =
                    (shared.now.position[dof] - shared.start.position[dof]) / shared.step.dt;
            }
        }
        settle_surface(shared, state);
        state.split_position(&shared.shape.arms, shared.shape.kind);
        state.split_velocity(&shared.shape.arms, shared.shape.kind);
        shared.shape.spread_accelerations(&mut state.acceleration);
    }
}

/// What turns a node beyond the answer of `A⁻¹`, per couple by the levers of forces and by their reference arms (1/(kg m²)).
///
/// Forces that stretch the body turn it back: their levers turn with it. That is as much of a position's answer as inertia is, `(ω dt)²` times as much
/// where they would swing it at `ω`.
fn turning(shared: &Shared, of: Response) -> [f64; 2] {
    let damped = 1.0 + shared.shape.model.rayleigh().mass * shared.step.weights.b1;
    let by_arms = 1.0 / (shared.shape.arms.polar * damped);
    // Beta-2 gives an angle `b0` per acceleration, the mean of two spins gives `dt b1 / 2`.
    let Weights { b0, b1 } = shared.step.weights;
    let mean = 0.5 * shared.step.dt * b1 / b0;
    let inertia = shared.now.inertia;
    let by_levers = match of {
        Response::Position => mean / (damped * inertia + mean * b0 * back(shared)),
        _ => inertia.recip(),
    };
    [by_levers, by_arms]
}

/// What a turn of the frame takes from the moment of the forces that stretch the body (N m): the less the farther the step turns it, and nothing from a
/// quarter turn on. What forces press is stiff by its own inertia.
pub(super) fn back(shared: &Shared) -> f64 {
    let turn = shared.now.frame.angle - shared.start.frame.angle;
    shared.contact.stretch.max(0.0) * cos(turn).max(0.0)
}

/// Share of a turn of the frame by which the forces that stretch the body turn it back within the step (-).
pub(super) fn turned_back(shared: &Shared) -> f64 {
    let [by_levers, _] = turning(shared, Response::Position);
    shared.step.weights.b0 * by_levers * back(shared)
}

/// Gives massless nodes in contact the velocity they moved with: the trapezoidal rule would let it alternate for ever
/// where a contact holds the position.
fn settle_surface(shared: &Shared, state: &mut FlexState) {
    if !shared.contact.is_used {
        return;
    }
    for (node, _) in shared.shape.model.massless_support() {
        if node_vec(&shared.contact.nodal, node) != Vec2::zeros() {
            let moved =
                node_vec(&shared.now.position, node) - node_vec(&shared.start.position, node);
            set_node_vec(&mut state.velocity, node, moved / shared.step.dt);
        }
    }
}
