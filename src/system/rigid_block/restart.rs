//! Taking a rigid block back within its step, and ending the step elsewhere than forces lead.

use super::RigidBlock;
use crate::math::Vec2;
use crate::system::{RigidMotion, RigidWay};

impl RigidBlock {
    /// Puts the iterate back to the beginning of the step.
    pub fn restart(&mut self) {
        self.current = self.start;
    }

    /// Forgets what contact did to the acceleration at the end.
    pub fn forget_contact(&mut self) {
        self.smooth_end = self.smooth_free;
    }

    /// Along which of its dofs forces move the body.
    pub fn moves_along(&self) -> [bool; 3] {
        self.inverse_effective.map(|inverse| inverse > 0.0)
    }

    /// Diagonal of `A` (kg, kg, kg m²), one along dofs that do not move.
    pub fn effective_mass(&self) -> [f64; 3] {
        self.inverse_effective
            .map(|inverse| if inverse > 0.0 { 1.0 / inverse } else { 1.0 })
    }

    /// Puts the body where the step could go, with the velocity that its forces lead to.
    pub fn stop_at(&mut self, centre: Vec2, angle: f64) {
        self.current.centre = centre;
        self.current.angle = angle;
    }

    /// Gives the body a velocity (m/s) and a spin (rad/s) where it is.
    pub fn move_on(&mut self, velocity: Vec2, spin: f64) {
        (self.current.velocity, self.current.spin) = (velocity, spin);
        self.free = self.current;
    }

    /// Ends the step as a rigid motion leads it.
    pub fn carry_on(&mut self, way: &RigidWay) {
        self.hold();
        self.current.centre = way.end(self.start.centre);
        self.current.angle = self.start.angle + way.turn;
        self.move_on(way.velocity_at(self.current.centre), way.spin);
        self.forget_contact();
    }

    /// Ends the step where it began, without velocities, unless the motion is given.
    pub fn hold(&mut self) {
        if !self.is_prescribed() {
            self.current = RigidMotion {
                velocity: Vec2::zeros(),
                spin: 0.0,
                ..self.start
            };
            self.free = self.current;
            self.smooth_end = [0.0; 3];
        }
    }
}
