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
//! and `u̇_q = 0`, and where they are is found from what they follow; see `following`.

//!
//! The angle obeys the balance of angular momentum instead of its row of (C.5), which is exact for finite displacements too.

use super::SmallStrain;
use super::end::{back, turned_back};
use crate::body::Frame;
use crate::integrator::Weights;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, rounding, set_node_vec};
use crate::system::flex::following::Following;
use crate::system::flex::shared::Shared;

/// Turn in a step (rad) up to which the inertial terms of the displacements are no matter for the iterations.
pub(super) const AT_REST: f64 = rounding::SINGLE;

/// Turn (rad, of the part that matters) since the last whole solve up to which its frame still counts as the same.
const SAME_ANGLE: f64 = rounding::SOLVED;

impl SmallStrain {
    /// Solves for the end of the step under the contact forces given, in the frame and with the inertial terms of the
    /// current iterate.
    ///
    /// Returns how far the frame's angle moved (rad), or that part of it that matters: a frame that hardly spins turns only
    /// the displacements.
    pub fn solve(&mut self, shared: &mut Shared) -> f64 {
        if self.may_add(shared) {
            self.solve_difference(shared);
        } else {
            self.solve_anew(shared);
        }
        if shared.contact.is_used || self.has_solved_force {
            self.solved_force.copy_from_slice(&shared.contact.nodal);
            self.has_solved_force = shared.contact.is_used;
        }
        self.correct(shared)
    }

    /// Whether only contact forces have changed since the last solve.
    fn may_add(&self, shared: &Shared) -> bool {
        let Some(angle) = self.solved_angle else {
            return false;
        };
        let is_at_rest = shared.step.dt * shared.now.frame.spin.abs() <= AT_REST;
        let turned = (shared.now.frame.angle - angle).abs()
            * (largest_displacement(shared) / shared.shape.size).min(1.0);
        shared.shape.kind == Frame::Fixed || is_at_rest && turned <= SAME_ANGLE
    }

    /// Adds the response to the change of the contact forces: a right-hand side that is zero inside the body.
    fn solve_difference(&mut self, shared: &mut Shared) {
        let back = shared.now.turn.transpose();
        for node in 0..shared.shape.model.n_nodes() {
            let change = node_vec(&shared.contact.nodal, node) - node_vec(&self.solved_force, node);
            set_node_vec(&mut shared.local, node, back * change);
        }
        shared.shape.clear_fixed(&mut shared.local);
        shared.answer.solve(&mut shared.local);
        for (increment, solved) in self.increment.iter_mut().zip(&shared.local) {
            *increment += solved;
        }
    }

    fn solve_anew(&mut self, shared: &mut Shared) {
        self.solved_angle = Some(shared.now.frame.angle);
        let rayleigh = shared.shape.model.rayleigh();
        let Weights { b0, b1 } = shared.step.weights;
        let (s, alpha) = (b0 + rayleigh.stiffness * b1, rayleigh.mass);
        let (per_s, kept) = (s.recip(), 1.0 + alpha * b1);
        // Slices of one length, so that the loop runs in vectors.
        let n = shared.shape.n_dofs();
        let (u, v) = (&self.displacement_q[..n], &self.rate_q[..n]);
        let start = &shared.start.acceleration[..n];
        let (increment, scratch) = (&mut self.increment[..n], &mut shared.scratch[..n]);
        for dof in 0..n {
            let star = (u[dof] + rayleigh.stiffness * v[dof]) * per_s;
            increment[dof] = -star;
            // Accelerations before the increment, less what the stiffness would give back.
            scratch[dof] = start[dof] + alpha * v[dof] - kept * star;
        }
        self.load_forces(shared, alpha);
        shared
            .shape
            .model
            .mass()
            .multiply_add(-1.0, &shared.scratch, &mut shared.local);
        self.add_prescribed(shared, s);
        shared.answer.solve(&mut shared.local);
        for (increment, solved) in self.increment.iter_mut().zip(&shared.local) {
            *increment += solved;
        }
    }

    /// Writes applied and contact forces, in the frame, over `local`.
    fn load_forces(&self, shared: &mut Shared, alpha: f64) {
        if shared.shape.kind != Frame::Fixed {
            self.add_frame_inertia(shared, alpha);
        } else if shared.contact.is_used {
            let forces = shared.loads.force.iter().zip(&shared.contact.nodal);
            for (local, (applied, contact)) in shared.local.iter_mut().zip(forces) {
                *local = applied + contact;
            }
        } else {
            shared.local.copy_from_slice(&shared.loads.force);
        }
    }

    /// Turns the forces into the frame and adds its accelerations, `h` included, to the scratch vector.
    fn add_frame_inertia(&self, shared: &mut Shared, alpha: f64) {
        let back = shared.now.turn.transpose();
        let frame = &shared.now.frame;
        let shift = back * (self.frame_q.acceleration + alpha * self.frame_q.velocity);
        let turn = alpha * self.frame_q.spin;
        // α J u, with the mean turn of the iterate, beyond what δ_θ J X holds.
        let swing = frame.spin_rate + alpha * frame.spin;
        let squared = frame.spin * frame.spin;
        for node in 0..shared.shape.model.n_nodes() {
            let reference = node_vec(&shared.shape.arms.reference, node);
            let mut inertial = shift + turn * perp(reference) - squared * reference;
            let u = node_vec(&shared.now.displacement, node);
            inertial += swing * perp(u) - squared * u
                + 2.0 * frame.spin * perp(node_vec(&shared.now.rate, node));
            add_node_vec(&mut shared.scratch, node, inertial);
            let force = node_vec(&shared.loads.force, node) + node_vec(&shared.contact.nodal, node);
            set_node_vec(&mut shared.local, node, back * force);
        }
    }

    /// Puts the known values of the pinned dofs into the right-hand side.
    fn add_prescribed(&self, shared: &mut Shared, s: f64) {
        let b0 = shared.step.weights.b0;
        let damping = shared.shape.model.rayleigh().stiffness;
        let reach_of_following = Following::reach(&shared.step, damping);
        for slot in 0..shared.shape.fixed_dofs.len() {
            let dof = shared.shape.fixed_dofs[slot];
            // A hinge is the centre of its frame: its displacement there is zero.
            let target = if shared.shape.kind == Frame::Fixed {
                shared.loads.prescribed[dof]
            } else {
                0.0
            };
            let reach = if self.following.has(dof) {
                reach_of_following
            } else {
                b0
            };
            let increment = (target - self.displacement_q[dof]) / reach;
            let known = increment - self.increment[dof];
            shared.local[dof] = known;
            if known != 0.0 {
                move_to_right_hand_side(shared, dof, s * known);
            }
        }
    }

    /// Applies the increments of the iterate; see [`Self::solve`].
    fn correct(&mut self, shared: &mut Shared) -> f64 {
        if shared.shape.kind == Frame::Fixed {
            self.advance_displacements(shared);
            shared.now.place(&shared.shape);
            return 0.0;
        }
        let (_, turn) = shared
            .shape
            .arms
            .split(shared.shape.kind, &mut self.increment);
        let (angle, back) = (shared.now.frame.angle, back(shared));
        self.advance(shared, turn);
        self.balance_angular_momentum(shared, (angle, back));
        let turned = (shared.now.frame.angle - angle).abs();
        if shared.step.dt * shared.now.frame.spin.abs() > AT_REST {
            return turned;
        }
        let share = largest_displacement(shared) / shared.shape.size + turned_back(shared);
        turned * share.min(1.0)
    }

    /// Applies the increments to displacements and rates in the frame.
    fn advance_displacements(&mut self, shared: &mut Shared) {
        let Weights { b0, b1 } = shared.step.weights;
        let n = shared.shape.n_dofs();
        let (u, v) = (&self.displacement_q[..n], &self.rate_q[..n]);
        let (displacement, rate) = (&mut shared.now.displacement[..n], &mut shared.now.rate[..n]);
        for (dof, increment) in self.increment[..n].iter().enumerate() {
            displacement[dof] = u[dof] + b0 * increment;
            rate[dof] = v[dof] + b1 * increment;
        }
        self.following
            .advance(shared, &self.displacement_q, &self.increment);
    }

    /// Applies the increments of a frame that moves; `increment` holds `δ_u`.
    ///
    /// The centre follows the balance of momentum, which (C.5) holds too, but to the rounding of stiff elastic forces.
    fn advance(&mut self, shared: &mut Shared, turn: f64) {
        let Weights { b0, b1 } = shared.step.weights;
        self.advance_displacements(shared);
        let shift = match shared.shape.kind {
            Frame::Free => {
                let alpha = shared.shape.model.rayleigh().mass;
                let drag = self.frame_q.acceleration + alpha * self.frame_q.velocity;
                let force = shared.loads.total + shared.contact.total;
                (force / shared.shape.arms.mass - drag) / (1.0 + alpha * b1)
            }
            _ => Vec2::zeros(),
        };
        self.shift = shift;
        let before = &self.frame_q;
        shared.now.frame.centre = before.centre + b0 * shift;
        shared.now.frame.velocity = before.velocity + b1 * shift;
        shared.now.frame.acceleration = before.acceleration + shift;
        shared.now.frame.angle = before.angle + 0.5 * shared.step.dt * b1 * turn;
        shared.now.frame.spin = before.spin + b1 * turn;
        shared.now.frame.spin_rate = b1 * turn / shared.step.dt;
    }

    /// Corrects the turn so that angular momentum grows by the impulse of the torques.
    ///
    /// Levers of contact forces are those of the iterate before, at the angle `seen`: where they stretch the body they are taken to turn on with
    /// it, and [`back`], or iterates of what is taut would swing ever farther. It makes no difference in the end, where the angle stays.
    fn balance_angular_momentum(&mut self, shared: &mut Shared, (seen, back): (f64, f64)) {
        let mut torque = shared.contact.moment;
        if shared.shape.kind != Frame::Free || shared.loads.uniform.is_none() {
            shared.now.place(&shared.shape);
            for node in 0..shared.shape.model.n_nodes() {
                let arm = node_vec(&shared.now.position, node) - shared.now.frame.centre;
                torque += cross(arm, node_vec(&shared.loads.force, node));
            }
        }
        let momentum = shared.shape.angular_momentum_of(
            &shared.now.frame,
            &shared.now.displacement,
            &shared.now.rate,
        );
        torque -= shared.shape.model.rayleigh().mass * momentum;
        if let Frame::Hinged(_) = shared.shape.kind {
            torque -= hinge_torque(shared);
        }
        let Weights { b1, .. } = shared.step.weights;
        torque -= back * (shared.now.frame.angle - seen);
        let impulse = (shared.step.dt - b1) * shared.start.torque + b1 * torque;
        let missing = shared.start.momentum + impulse - momentum;
        let damped = 1.0 + shared.shape.model.rayleigh().mass * b1;
        shared.now.inertia = shared.shape.inertia_of(&shared.now.displacement);
        let half = 0.5 * shared.step.dt;
        let change = missing / (shared.now.inertia * damped + half * b1 * back);
        self.torque = torque - half * change * back;
        shared.now.frame.spin += change;
        shared.now.frame.angle += half * change;
        shared.now.frame.spin_rate += change / shared.step.dt;
        shared.now.place(&shared.shape);
    }
}

/// Subtracts the stiffness column of one pinned dof from the rows of its free neighbours.
fn move_to_right_hand_side(shared: &mut Shared, dof: usize, scaled: f64) {
    let stiffness = shared.shape.model.stiffness();
    let (node, axis) = (dof / 2, dof % 2);
    for (&neighbour, block) in stiffness
        .neighbours(node)
        .iter()
        .zip(stiffness.row_blocks(node))
    {
        for other in 0..2 {
            let row = 2 * neighbour as usize + other;
            if !shared.shape.is_fixed[row] {
                // The matrix is symmetric: the column of the pinned dof is its row.
                shared.local[row] -= block[2 * axis + other] * scaled;
            }
        }
    }
}

/// Torque of the frame's own acceleration when the hinge is moved.
fn hinge_torque(shared: &Shared) -> f64 {
    let acceleration = shared.now.frame.acceleration;
    let masses = shared.shape.arms.node_mass.iter().enumerate();
    masses
        .map(|(node, mass)| {
            mass * cross(
                node_vec(&shared.now.position, node) - shared.now.frame.centre,
                acceleration,
            )
        })
        .sum()
}

/// Largest displacement in the frame (m).
pub(super) fn largest_displacement(shared: &Shared) -> f64 {
    let all = shared.now.displacement.iter();
    all.fold(0.0f64, |reach, u| reach.max(u.abs()))
}
