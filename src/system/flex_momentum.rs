//! Momentum of a flexible block: loads that come and go bring all of it whatever the steps, and the angle obeys the balance of angular momentum
//! instead of its row of (C.5), which is exact for finite displacements too.

use super::flex_block::FlexBlock;
use super::flex_motion::spread_accelerations;
use crate::body::{Frame, FrameMotion, KnownLoads};
use crate::integrator::Weights;
use crate::math::{Vec2, cross, node_vec, rotation, set_node_vec};

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

    /// Lets loads that jump bring all their momentum, whatever the steps are long.
    ///
    /// A step of length `h` brings `(1 - β1) h f` of the load `f` before it and `β1 h f'` of its own: of a jump `Δf` less than its time by
    /// `(1 - β1) h Δf`, and more by as much when it is gone, if that step is as long. All jumps are to be late by the length `l` of the first one after
    /// nothing was: the acceleration at the beginning of the step has jumped by `(1 - l/h) κ A⁻¹ Δf` for that, `κ = 1 + α b1`, by its part of
    /// `M⁻¹ Δf` where the step resolves it, rigid motion above all, and by nothing where it does not, which would swing.
    pub(super) fn take_up_load(&mut self, known: &KnownLoads) {
        let (last, length) = (&known.last, self.step.dt);
        if last.force.len() != self.loads.own.force.len() || *last == self.loads.own {
            return;
        }
        if *last == known.base {
            self.loads.lag = length;
        }
        let late = self.loads.lag / length;
        let share = 1.0 - late;
        let mean = (1.0 - self.step.weights.b1 / length) * late;
        let turn = self.start_frame.angle;
        let (back, centre) = (rotation(-turn), self.start_frame.centre);
        let (mut force, mut torque) = (Vec2::zeros(), 0.0);
        self.loads.late.resize(self.force.len(), 0.0);
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            let own = node_vec(&self.loads.own.force, node) - node_vec(&last.force, node);
            let whole: Vec2 = own + *mass * (self.loads.own.gravity - last.gravity);
            set_node_vec(&mut self.loads.late, node, -mean * whole);
            let jump = share * whole;
            force += jump;
            torque += cross(node_vec(&self.start_position, node) - centre, jump);
            set_node_vec(&mut self.local, node, back * jump);
        }
        if share == 0.0 {
            return;
        }
        for &dof in &self.fixed_dofs {
            self.local[dof] = 0.0;
        }
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        let kept = 1.0 + self.model.rayleigh().mass * self.step.weights.b1;
        self.local.iter_mut().for_each(|value| *value *= kept);
        spread_accelerations(&self.model, &self.is_fixed, &mut self.local);
        self.arms.split(self.kind, &mut self.local);
        for (start, jump) in self.start_acceleration.iter_mut().zip(&self.local) {
            *start += jump;
        }
        if self.kind == Frame::Free {
            self.start_frame.acceleration += force / self.arms.mass;
        }
        if self.kind != Frame::Fixed {
            self.start_torque += torque;
        }
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
