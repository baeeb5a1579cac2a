//! Ways back to the beginning of a step whose iterations have failed.

use super::flex_block::FlexBlock;
use crate::math::is_held;

impl FlexBlock {
    /// Puts the iterate back to the beginning of the step.
    pub fn restart(&mut self) {
        let dt = self.step.dt;
        let half = 0.5 * dt * dt;
        for (dof, acceleration) in self.start_acceleration.iter().enumerate() {
            let rate = self.rate_q[dof] - dt * acceleration;
            self.rate[dof] = rate;
            self.displacement[dof] = self.displacement_q[dof] - dt * rate - half * acceleration;
        }
        self.frame = self.frame_q;
        self.inertia = self.arms.polar;
        self.clear_contact_force();
        self.place();
    }

    /// Goes back to the beginning and drops what makes the step non-linear: the inertial terms of the displacement in a
    /// turning frame, and the balance of angular momentum in favour of the row; and with them the stored second rates,
    /// which is where unresolved vibrations live.
    ///
    /// Such a step is first order and stable; it is taken where Newton's iterations do not converge.
    pub fn linearize(&mut self) {
        let dt = self.step.dt;
        let half = 0.5 * dt * dt;
        for dof in 0..self.start_acceleration.len() {
            let acceleration = std::mem::take(&mut self.start_acceleration[dof]);
            self.rate_q[dof] -= dt * acceleration;
            self.displacement_q[dof] -= half * acceleration;
        }
        self.restart();
        self.is_linear = true;
    }

    /// Ends the step where it began, without velocities.
    pub fn hold(&mut self) {
        self.restart();
        let start = self.start_frame;
        self.frame = crate::body::FrameMotion {
            centre: start.centre,
            angle: start.angle,
            ..Default::default()
        };
        self.rate.fill(0.0);
        for (increment, acceleration) in self.increment.iter_mut().zip(&self.start_acceleration) {
            *increment = -acceleration;
        }
        self.shift = -start.acceleration;
        self.torque = 0.0;
        self.place();
    }

    /// Whether the loads alone would send the body beyond what can be held: that is no matter of contact.
    pub fn is_overloaded(&self) -> bool {
        let most = self
            .force
            .iter()
            .fold(0.0f64, |most, force| most.max(force.abs()));
        !is_held(self.step.dt * most / self.arms.mass)
    }

    /// Largest velocity component of a node at the beginning and at the end (m/s).
    pub fn fastest(&self) -> [f64; 2] {
        let largest = |velocity: &[f64]| velocity.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        [largest(&self.start_velocity), largest(&self.velocity)]
    }

    /// How far a node has moved beyond what its own velocity would have done, relative to the body (-).
    pub fn excess_motion(&self) -> f64 {
        let dt = self.step.dt;
        let (mut moved, mut drift) = (0.0f64, 0.0f64);
        for (dof, end) in self.position.iter().enumerate() {
            if !end.is_finite() {
                return f64::INFINITY;
            }
            moved = moved.max((end - self.start_position[dof]).abs());
            drift = drift.max((dt * self.start_velocity[dof]).abs());
        }
        (moved - drift) / self.extent
    }
}
