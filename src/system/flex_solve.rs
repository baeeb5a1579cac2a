//! The solves of a step: free motion, response to contact forces, and what the increments make of them.
//!
//! The increments are one local vector `δ = δ_t + δ_θ J X + δ_u`, for which (C.5) reads, with `C = α M + β K` and
//! `s = b0 + β b1`,
//!
//! ```text
//! A (δ + w) = Rᵀ(f + Gᵀp) - M (a_q + h + α v_q) + (1 + α b1) M w,      w = (u_q + β u̇_q) / s,
//! ```
//!
//! `a_q` the accelerations before the increment, `h` the centripetal and Coriolis terms: the stiffness need never be
//! multiplied.
//!
//! Nodes without mass of a damped body have no rates of their own to carry them on: their rows hold only `w`, with `u_q` where they were
//! and `u̇_q = 0`, and where they are is found from what they follow; see `flex_surface`.

use super::flex_block::FlexBlock;
use super::step::Response;
use crate::body::Frame;
use crate::integrator::Weights;
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};

/// Turn in a step (rad) up to which the inertial terms of the displacements are no matter for the iterations.
const AT_REST: f64 = 1e-6;

/// Turn (rad, of the part that matters) since the last whole solve up to which its frame still counts as the same.
const SAME_ANGLE: f64 = 1e-11;

impl FlexBlock {
    /// Solves for the end of the step under the contact forces given, in the frame and with the inertial terms of the
    /// current iterate.
    ///
    /// Returns how far the frame's angle moved (rad), or that part of it that matters: a frame that hardly spins turns only
    /// the displacements.
    pub fn solve(&mut self) -> f64 {
        if self.is_explicit() {
            self.solve_explicitly();
            return 0.0;
        }
        if self.is_large() {
            return self.solve_large();
        }
        if self.may_add() {
            self.solve_difference();
        } else {
            self.solve_anew();
        }
        if self.has_contact_force || self.has_solved_force {
            self.solved_force.copy_from_slice(&self.contact_force);
            self.has_solved_force = self.has_contact_force;
        }
        self.correct()
    }

    /// Whether only contact forces have changed since the last solve.
    fn may_add(&self) -> bool {
        let Some(angle) = self.solved_angle else {
            return false;
        };
        let is_at_rest = self.step.dt * self.frame.spin.abs() <= AT_REST;
        let turned = (self.frame.angle - angle).abs() * (self.reach() / self.size).min(1.0);
        self.kind == Frame::Fixed || is_at_rest && turned <= SAME_ANGLE
    }

    /// Adds the response to the change of the contact forces: a right-hand side that is zero inside the body.
    fn solve_difference(&mut self) {
        let back = self.turn.transpose();
        for node in 0..self.model.n_nodes() {
            let change = node_vec(&self.contact_force, node) - node_vec(&self.solved_force, node);
            set_node_vec(&mut self.local, node, back * change);
        }
        for &dof in &self.fixed_dofs {
            self.local[dof] = 0.0;
        }
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        for (increment, solved) in self.increment.iter_mut().zip(&self.local) {
            *increment += solved;
        }
    }

    fn solve_anew(&mut self) {
        self.solved_angle = Some(self.frame.angle);
        let rayleigh = self.model.rayleigh();
        let Weights { b0, b1 } = self.step.weights;
        let (s, alpha) = (b0 + rayleigh.stiffness * b1, rayleigh.mass);
        let (per_s, kept) = (s.recip(), 1.0 + alpha * b1);
        // Slices of one length, so that the loop runs in vectors.
        let n = self.n_dofs();
        let (u, v) = (&self.displacement_q[..n], &self.rate_q[..n]);
        let start = &self.start_acceleration[..n];
        let (increment, scratch) = (&mut self.increment[..n], &mut self.scratch[..n]);
        for dof in 0..n {
            let star = (u[dof] + rayleigh.stiffness * v[dof]) * per_s;
            increment[dof] = -star;
            // Accelerations before the increment, less what the stiffness would give back.
            scratch[dof] = start[dof] + alpha * v[dof] - kept * star;
        }
        self.load_forces(alpha);
        self.model
            .mass()
            .multiply_add(-1.0, &self.scratch, &mut self.local);
        self.add_prescribed(s);
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        for (increment, solved) in self.increment.iter_mut().zip(&self.local) {
            *increment += solved;
        }
    }

    /// Writes applied and contact forces, in the frame, over `local`.
    fn load_forces(&mut self, alpha: f64) {
        if self.kind != Frame::Fixed {
            self.add_frame_inertia(alpha);
        } else if self.has_contact_force {
            let forces = self.force.iter().zip(&self.contact_force);
            for (local, (applied, contact)) in self.local.iter_mut().zip(forces) {
                *local = applied + contact;
            }
        } else {
            self.local.copy_from_slice(&self.force);
        }
    }

    /// Turns the forces into the frame and adds its accelerations, `h` included, to the scratch vector.
    pub(super) fn add_frame_inertia(&mut self, alpha: f64) {
        let back = self.turn.transpose();
        let frame = &self.frame;
        let shift = back * (self.frame_q.acceleration + alpha * self.frame_q.velocity);
        let turn = alpha * self.frame_q.spin;
        // α J u, with the mean turn of the iterate, beyond what δ_θ J X holds.
        let swing = frame.spin_rate + alpha * frame.spin;
        let squared = frame.spin * frame.spin;
        for node in 0..self.model.n_nodes() {
            let reference = node_vec(&self.arms.reference, node);
            let mut inertial = shift + turn * perp(reference) - squared * reference;
            let u = node_vec(&self.displacement, node);
            inertial +=
                swing * perp(u) - squared * u + 2.0 * frame.spin * perp(node_vec(&self.rate, node));
            add_node_vec(&mut self.scratch, node, inertial);
            let force = node_vec(&self.force, node) + node_vec(&self.contact_force, node);
            set_node_vec(&mut self.local, node, back * force);
        }
    }

    /// Puts the known values of the pinned dofs into the right-hand side.
    pub(super) fn add_prescribed(&mut self, s: f64) {
        let b0 = self.step.weights.b0;
        for slot in 0..self.fixed_dofs.len() {
            let dof = self.fixed_dofs[slot];
            // A hinge is the centre of its frame: its displacement there is zero.
            let target = if self.kind == Frame::Fixed {
                self.prescribed[dof]
            } else {
                0.0
            };
            let reach = if self.is_following(dof) {
                self.following_reach()
            } else {
                b0
            };
            let increment = (target - self.displacement_q[dof]) / reach;
            let known = increment - self.increment[dof];
            self.local[dof] = known;
            if known != 0.0 {
                self.move_to_right_hand_side(dof, s * known);
            }
        }
    }

    /// Subtracts the stiffness column of one pinned dof from the rows of its free neighbours.
    pub(super) fn move_to_right_hand_side(&mut self, dof: usize, scaled: f64) {
        let stiffness = self.model.stiffness();
        let (node, axis) = (dof / 2, dof % 2);
        for (&neighbour, block) in stiffness
            .neighbours(node)
            .iter()
            .zip(stiffness.row_blocks(node))
        {
            for other in 0..2 {
                let row = 2 * neighbour as usize + other;
                if !self.is_fixed[row] {
                    // The matrix is symmetric: the column of the pinned dof is its row.
                    self.local[row] -= block[2 * axis + other] * scaled;
                }
            }
        }
    }

    /// Clears the contact forces of the iterate.
    pub fn clear_contact_force(&mut self) {
        self.clear_late_force();
        if self.has_contact_force {
            self.contact_force.fill(0.0);
            self.has_contact_force = false;
        }
        self.contact_total = Vec2::zeros();
        self.contact_moment = 0.0;
    }

    /// Adds a contact force at a node (N) that acts at a lever from the centre (m).
    pub fn add_contact_force(&mut self, node: usize, force: Vec2, lever: Vec2) {
        add_node_vec(&mut self.contact_force, node, force);
        self.has_contact_force = true;
        self.contact_total += force;
        self.contact_moment += cross(lever, force);
    }

    /// Applies the increments of the iterate; see [`FlexBlock::solve`].
    fn correct(&mut self) -> f64 {
        if self.kind == Frame::Fixed {
            self.advance_displacements();
            self.place();
            return 0.0;
        }
        let (_, turn) = self.arms.split(self.kind, &mut self.increment);
        let angle = self.frame.angle;
        self.advance(turn);
        self.balance_angular_momentum();
        let turned = (self.frame.angle - angle).abs();
        if self.step.dt * self.frame.spin.abs() > AT_REST {
            return turned;
        }
        turned * (self.reach() / self.size).min(1.0)
    }

    /// Share of its size by which a turn of the frame that [`solve`](Self::solve) has found changes the places that it found (-).
    ///
    /// Forces have turned against the displacements, as far as these reach, and the spin has changed with the turn by `2 δθ/dt`: what it
    /// presses outwards by answers within `dt²/4 · 2 ω 2δθ/dt · r = dt ω δθ r`, with Coriolis' forces by less than four times that.
    pub fn turning_share(&self) -> f64 {
        let turn = self.step.dt * self.frame.spin.abs();
        if self.is_large() || turn <= AT_REST {
            return 1.0;
        }
        (self.reach() / self.size + 2.0 * turn).min(1.0)
    }

    /// Applies the increments to displacements and rates in the frame.
    fn advance_displacements(&mut self) {
        let Weights { b0, b1 } = self.step.weights;
        let n = self.n_dofs();
        let (u, v) = (&self.displacement_q[..n], &self.rate_q[..n]);
        let (displacement, rate) = (&mut self.displacement[..n], &mut self.rate[..n]);
        for (dof, increment) in self.increment[..n].iter().enumerate() {
            displacement[dof] = u[dof] + b0 * increment;
            rate[dof] = v[dof] + b1 * increment;
        }
        for &dof in &self.following_dofs {
            let moved = self.following_reach() * self.increment[dof];
            self.displacement[dof] = self.displacement_q[dof] + moved;
            self.rate[dof] = moved / self.step.dt;
        }
        self.follow_displacements();
    }

    /// Displacement per increment where a massless node moves as far as its row tells: `u + β (u - u_q)/dt = w` (s²).
    fn following_reach(&self) -> f64 {
        let Weights { b0, b1 } = self.step.weights;
        let damping = self.model.rayleigh().stiffness;
        (b0 + damping * b1) / (1.0 + damping / self.step.dt)
    }

    /// Largest displacement in the frame (m).
    fn reach(&self) -> f64 {
        let all = self.displacement.iter();
        all.fold(0.0f64, |reach, u| reach.max(u.abs()))
    }

    /// Applies the increments of a frame that moves; `increment` holds `δ_u`.
    ///
    /// The centre follows the balance of momentum, which (C.5) holds too, but to the rounding of stiff elastic forces.
    fn advance(&mut self, turn: f64) {
        let Weights { b0, b1 } = self.step.weights;
        self.advance_displacements();
        let shift = match self.kind {
            Frame::Free => {
                let alpha = self.model.rayleigh().mass;
                let drag = self.frame_q.acceleration + alpha * self.frame_q.velocity;
                let force = self.force_total + self.contact_total;
                (force / self.arms.mass - drag) / (1.0 + alpha * b1)
            }
            _ => Vec2::zeros(),
        };
        self.shift = shift;
        let before = &self.frame_q;
        self.frame.centre = before.centre + b0 * shift;
        self.frame.velocity = before.velocity + b1 * shift;
        self.frame.acceleration = before.acceleration + shift;
        self.frame.angle = before.angle + 0.5 * self.step.dt * b1 * turn;
        self.frame.spin = before.spin + b1 * turn;
        self.frame.spin_rate = b1 * turn / self.step.dt;
    }

    /// World positions of the iterate.
    pub(super) fn place(&mut self) {
        if self.kind == Frame::Fixed {
            for ((x, rest), u) in self
                .position
                .iter_mut()
                .zip(self.model.rest_positions())
                .zip(&self.displacement)
            {
                *x = rest + u;
            }
            return;
        }
        self.turn = rotation(self.frame.angle);
        let (frame, turn) = (&self.frame, self.turn);
        for node in 0..self.model.n_nodes() {
            let arm = node_vec(&self.arms.reference, node) + node_vec(&self.displacement, node);
            set_node_vec(&mut self.position, node, frame.centre + turn * arm);
        }
    }

    /// World velocities of the last iterate: nothing asks for them before.
    pub fn place_velocities(&mut self) {
        if self.is_explicit() {
            return;
        }
        if self.is_large() {
            // They have followed the positions.
            self.place_large_acceleration();
            return;
        }
        self.follow_rates();
        if self.kind == Frame::Fixed {
            self.velocity.copy_from_slice(&self.rate);
            return;
        }
        let (frame, turn) = (&self.frame, self.turn);
        for node in 0..self.model.n_nodes() {
            let arm = node_vec(&self.arms.reference, node) + node_vec(&self.displacement, node);
            let own = node_vec(&self.rate, node) + frame.spin * perp(arm);
            set_node_vec(&mut self.velocity, node, frame.velocity + turn * own);
        }
    }

    /// Makes [`super::Block::compliance`] known from `node`.
    pub fn prepare_compliance(&mut self, node: usize) {
        if self.is_explicit() {
            self.prepare_explicitly(node);
            return;
        }
        if let Some(surface) = &mut self.surface {
            surface.prepare(node, &self.is_fixed);
        }
        if self
            .compliance
            .prepare(node, &self.is_fixed, &mut self.factor)
        {
            self.n_solves += 2;
        }
    }

    /// See [`super::Block::compliance`].
    ///
    /// `A⁻¹` turns the body by the reference arms; the angle follows the levers of the forces instead, as the balance of
    /// angular momentum does. Between stiff contacts the difference would be amplified by `(ω dt)²`.
    pub fn compliance(
        &self,
        (at, at_lever): (usize, Vec2),
        (from, from_lever): (usize, Vec2),
        of: Response,
    ) -> Mat2 {
        if self.is_explicit() {
            return self.explicit_compliance(at, from, of);
        }
        if of == Response::ByMass {
            return self.mass_response(at, from);
        }
        let mut local = self.compliance.get(at, from);
        if self.is_large() {
            return local;
        }
        if let Some(surface) = self
            .surface
            .as_ref()
            .filter(|_| of == Response::Position && !self.following_dofs.is_empty())
        {
            // What `A⁻¹` has of it is damped by the weights of the masses.
            let Weights { b0, b1 } = self.step.weights;
            let damped = b0 + self.model.rayleigh().stiffness * b1;
            local +=
                (1.0 / (b0 * surface.slowness()) - 1.0 / damped) * surface.flexibility(at, from);
        }
        if self.kind == Frame::Fixed {
            return local;
        }
        let world = self.turn * local * self.turn.transpose();
        let [by_levers, by_arms] = self.turning(of);
        let [at_arm, from_arm] = [at, from].map(|node| self.turn_arm(node));
        world + by_levers * perp(at_lever) * perp(from_lever).transpose()
            - by_arms * at_arm * from_arm.transpose()
    }

    /// What turns a node beyond the answer of `A⁻¹`, per couple by the levers of forces and by their reference arms (1/(kg m²)).
    fn turning(&self, of: Response) -> [f64; 2] {
        let damped = 1.0 + self.model.rayleigh().mass * self.step.weights.b1;
        let by_arms = 1.0 / (self.arms.polar * damped);
        // Beta-2 gives an angle `b0` per acceleration, the mean of two spins gives `dt b1 / 2`.
        let Weights { b0, b1 } = self.step.weights;
        let mean = 0.5 * self.step.dt * b1 / b0;
        let share = match of {
            Response::Position => mean / damped,
            _ => 1.0,
        };
        [share / self.inertia, by_arms]
    }

    /// How a node moves as the body turns by the reference arms.
    fn turn_arm(&self, node: usize) -> Vec2 {
        perp(self.turn * node_vec(&self.arms.reference, node))
    }

    /// The couples of a force at a node: by its lever, and by the reference arm of the node (N m).
    pub fn couples(&self, (node, lever): (usize, Vec2), force: Vec2) -> [f64; 2] {
        [cross(lever, force), self.turn_arm(node).dot(&force)]
    }

    /// How a node moves under the couples of forces beyond what `A⁻¹` answers to these: see [`FlexBlock::compliance`].
    pub fn turned(&self, (node, lever): (usize, Vec2), couples: [f64; 2], of: Response) -> Vec2 {
        if self.is_large() || self.is_explicit() || self.kind == Frame::Fixed {
            return Vec2::zeros();
        }
        let [by_levers, by_arms] = self.turning(of);
        by_levers * couples[0] * perp(lever) - by_arms * couples[1] * self.turn_arm(node)
    }
}
