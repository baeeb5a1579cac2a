//! Angular momentum of a flexible block: the angle obeys its balance instead of its row of (C.5), which is exact for
//! finite displacements too; and impulses at velocity level.

use super::flex_block::{FlexBlock, Response};
use crate::body::{Frame, FrameMotion};
use crate::integrator::Weights;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, set_node_vec};

impl FlexBlock {
    /// `I(u) ω + Σ m u × u̇` (N m s).
    pub(super) fn angular_momentum_of(&self, frame: &FrameMotion, u: &[f64], rate: &[f64]) -> f64 {
        self.inertia_of(u) * frame.spin + self.model.mass().moment(Vec2::zeros(), u, rate)
    }

    /// `I(u) = Σ m (X + u)²` (kg m²).
    pub(super) fn inertia_of(&self, u: &[f64]) -> f64 {
        let linear: f64 = self
            .arms
            .mass_moment
            .iter()
            .zip(u)
            .map(|(moment, u)| moment * u)
            .sum();
        self.arms.polar + 2.0 * linear + self.model.mass().inner(u, u)
    }

    /// Corrects the turn so that angular momentum grows by the impulse of the torques.
    pub(super) fn balance_angular_momentum(&mut self) {
        let mut torque = self.contact_moment;
        for node in 0..self.model.n_nodes() {
            let arm = node_vec(&self.position, node) - self.frame.centre;
            torque += cross(arm, node_vec(&self.force, node));
        }
        let momentum = self.angular_momentum_of(&self.frame, &self.displacement, &self.rate);
        torque -= self.model.rayleigh().mass * momentum;
        if let Frame::Hinged(_) = self.kind {
            torque -= self.hinge_inertia();
        }
        self.torque = torque;
        let Weights { b1, .. } = self.step.weights;
        let impulse = (self.step.dt - b1) * self.start_torque + b1 * torque;
        let missing = self.start_momentum + impulse - momentum;
        let damped = 1.0 + self.model.rayleigh().mass * b1;
        self.inertia = self.inertia_of(&self.displacement);
        let change = missing / (self.inertia * damped);
        self.frame.spin += change;
        self.frame.angle += 0.5 * self.step.dt * change;
        self.frame.spin_rate += change / self.step.dt;
        self.place();
    }

    /// Torque of the frame's own acceleration when the hinge is moved.
    pub(super) fn hinge_inertia(&self) -> f64 {
        let acceleration = self.frame.acceleration;
        let masses = self.arms.node_mass.iter().enumerate();
        masses
            .map(|(node, mass)| {
                mass * cross(
                    node_vec(&self.position, node) - self.frame.centre,
                    acceleration,
                )
            })
            .sum()
    }

    /// Clears the impulses gathered for [`FlexBlock::apply_impulse`].
    pub fn clear_impulse(&mut self) {
        if self.has_impulse {
            self.impulse.fill(0.0);
            self.has_impulse = false;
        }
        self.impulse_total = Vec2::zeros();
        self.impulse_moment = 0.0;
    }

    /// Whether impulses have been gathered.
    pub fn has_impulse(&self) -> bool {
        self.has_impulse
    }

    /// Gathers an impulse at a node (N s) that acts at a lever from the centre (m).
    pub fn gather_impulse(&mut self, node: usize, impulse: Vec2, lever: Vec2) {
        add_node_vec(&mut self.impulse, node, impulse);
        self.has_impulse = true;
        self.impulse_total += impulse;
        self.impulse_moment += cross(lever, impulse);
    }

    /// Adds the response to the gathered impulses to the end velocity (N s), or to the end acceleration (N).
    pub fn apply_impulse(&mut self, to: Response) {
        if !self.has_impulse {
            return;
        }
        self.respond_to_impulse();
        match to {
            Response::Acceleration => self.add_to_acceleration(1.0),
            Response::Velocity | Response::Position => self.add_to_velocity(1.0),
        }
    }

    fn add_to_acceleration(&mut self, scale: f64) {
        self.torque += scale * self.impulse_moment;
        self.shift += scale * self.mean_response();
        for (sum, response) in self.increment.iter_mut().zip(&self.local) {
            *sum += scale * response;
        }
    }

    fn add_to_velocity(&mut self, scale: f64) {
        let turn = scale * self.turn;
        for node in 0..self.model.n_nodes() {
            let response = turn * node_vec(&self.local, node);
            add_node_vec(&mut self.velocity, node, response);
        }
        if self.kind != Frame::Fixed {
            self.balance_impulse(scale);
        }
    }

    /// Change of the centre's velocity that the gathered impulses make (m/s).
    fn mean_response(&self) -> Vec2 {
        let damped = 1.0 + self.model.rayleigh().mass * self.step.weights.b1;
        self.impulse_total / (self.arms.mass * damped)
    }

    /// Moves and turns the velocities so that momentum and angular momentum gain exactly what the impulses give.
    fn balance_impulse(&mut self, scale: f64) {
        let centre = self.frame.centre;
        let wanted = scale * self.impulse_moment;
        let turn = scale * self.turn;
        for node in 0..self.model.n_nodes() {
            let response = turn * node_vec(&self.local, node);
            set_node_vec(&mut self.scratch, node, response);
        }
        let gained = self
            .model
            .mass()
            .moment(centre, &self.position, &self.scratch);
        let spin = (wanted - gained) / self.inertia;
        let drift = match self.kind {
            Frame::Free => {
                let zero = Vec2::zeros();
                scale * self.mean_response() - self.arms.centre(self.kind, &self.scratch, zero)
            }
            _ => Vec2::zeros(),
        };
        for node in 0..self.model.n_nodes() {
            let swing = spin * perp(node_vec(&self.position, node) - centre);
            add_node_vec(&mut self.velocity, node, drift + swing);
        }
        if self.kind == Frame::Free {
            self.frame.velocity += scale * self.mean_response();
        }
    }
}
