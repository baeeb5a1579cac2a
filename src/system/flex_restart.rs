//! Ways back to the beginning of a step whose iterations have failed.

use super::flex_block::FlexBlock;
use super::rigid_way::RigidWay;
use crate::body::{FlexState, Frame};
use crate::math::{Vec2, is_held, node_vec, perp, set_node_vec};

impl FlexBlock {
    /// Puts the iterate back to the beginning of the step.
    pub fn restart(&mut self) {
        if self.is_explicit() {
            self.restart_explicitly();
            return;
        }
        if self.is_large() {
            self.restart_large();
            return;
        }
        let dt = self.step.dt;
        let half = 0.5 * dt * dt;
        for (dof, acceleration) in self.start_acceleration.iter().enumerate() {
            let rate = self.rate_q[dof] - dt * acceleration;
            self.rate[dof] = rate;
            self.displacement[dof] = self.displacement_q[dof] - dt * rate - half * acceleration;
        }
        self.restart_following();
        self.frame = self.frame_q;
        self.inertia = self.arms.polar;
        self.solved_angle = None;
        self.clear_contact_force();
        self.place();
    }

    fn restart_following(&mut self) {
        for &dof in &self.following_dofs {
            (self.displacement[dof], self.rate[dof]) = (self.displacement_q[dof], 0.0);
        }
    }

    /// Nodes that follow have no history but where they are.
    pub(super) fn predict_following(&mut self, state: &FlexState) {
        for &dof in &self.following_dofs {
            self.displacement_q[dof] = state.displacement[dof];
            self.rate_q[dof] = 0.0;
        }
        if let Some(surface) = &mut self.surface {
            surface.begin(&self.model, &state.displacement, self.step.dt);
        }
    }

    /// Ends the step where it began, without velocities.
    pub fn hold(&mut self) {
        if self.is_explicit() {
            self.hold_explicitly();
            return;
        }
        if self.is_large() {
            self.move_large_on(Vec2::zeros(), 0.0);
            return;
        }
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

    /// Ends the step where it began, moving as a rigid body with this velocity of its centre (m/s) and spin (rad/s); implicit steps only.
    pub fn move_on(&mut self, velocity: Vec2, spin: f64) {
        if self.is_large() {
            self.move_large_on(velocity, spin);
            return;
        }
        self.hold();
        (self.frame.velocity, self.frame.spin) = (velocity, spin);
        if self.kind == Frame::Fixed {
            for node in 0..self.model.n_nodes() {
                let arm = node_vec(&self.position, node) - self.frame.centre;
                set_node_vec(&mut self.rate, node, velocity + spin * perp(arm));
            }
        }
        self.place();
    }

    /// Ends the step as a rigid motion leads it, undeformed further; free bodies in implicit steps only.
    pub fn carry_on(&mut self, way: &RigidWay) {
        if self.is_large() {
            self.carry_large_on(way);
            return;
        }
        self.hold();
        self.frame.centre = way.end(self.start_frame.centre);
        self.frame.angle = self.start_frame.angle + way.turn;
        self.frame.velocity = way.velocity_at(self.frame.centre);
        self.frame.spin = way.spin;
        self.shift += way.acceleration;
        self.place();
    }

    /// Sum of the forces of the loads on a free body (N).
    pub fn resultant(&self) -> Vec2 {
        self.force_total
    }

    /// Whether some dofs are pinned.
    pub fn is_pinned(&self) -> bool {
        self.is_fixed.iter().any(|fixed| *fixed)
    }

    /// Mass (kg) and polar inertia about the centre, at rest (kg m²).
    pub fn inertia(&self) -> (f64, f64) {
        (self.arms.mass, self.arms.polar)
    }

    /// Whether the loads alone would send the body beyond what can be held: that is no matter of contact. What acts on pins moves nothing.
    pub fn is_overloaded(&self) -> bool {
        let loads = self.force.iter().zip(&self.is_fixed);
        let most = loads.fold(0.0f64, |most, (force, &is_fixed)| {
            if is_fixed {
                most
            } else {
                most.max(force.abs())
            }
        });
        !is_held(self.step.dt * most / self.arms.mass)
    }

    /// Kinetic energy that the loads would give in the step to the whole body at rest, if nothing held it (J).
    pub fn load_energy(&self) -> f64 {
        let nodes = self
            .force
            .chunks_exact(2)
            .chain(self.loads.late.chunks_exact(2));
        let total: Vec2 = nodes.map(|force| Vec2::new(force[0], force[1])).sum();
        0.5 * (self.step.dt * total).norm_squared() / self.arms.mass
    }

    /// Mass of the body (kg).
    pub fn mass(&self) -> f64 {
        self.arms.mass
    }
}
