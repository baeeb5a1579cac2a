//! Angular momentum of a flexible block: the angle obeys its balance instead of its row of (C.5), which is exact for
//! finite displacements too.

use super::flex_block::FlexBlock;
use crate::body::{Frame, FrameMotion};
use crate::integrator::Weights;
use crate::math::{Vec2, cross, node_vec};

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
        if self.kind != Frame::Free || self.uniform.is_none() {
            self.place();
            for node in 0..self.model.n_nodes() {
                let arm = node_vec(&self.position, node) - self.frame.centre;
                torque += cross(arm, node_vec(&self.force, node));
            }
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
}
