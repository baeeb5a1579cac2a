//! Energy of a rigid body, and the work of what acts on it.

use super::{RigidBlock, RigidMotion};

impl RigidBlock {
    /// Work of an impulse that acted over the step, at the mean velocity (J).
    pub fn work_of(&self, impulse: [f64; 3]) -> f64 {
        let start = [
            self.start.velocity.x,
            self.start.velocity.y,
            self.start.spin,
        ];
        let means = start
            .iter()
            .zip(self.rates())
            .map(|(v, end)| 0.5 * (v + end));
        means.zip(impulse).map(|(v, p)| v * p).sum()
    }

    /// Work of the applied forces over the step (J).
    pub fn applied_work(&self) -> f64 {
        let moved = self.current.centre - self.start.centre;
        self.force[0] * moved.x
            + self.force[1] * moved.y
            + self.force[2] * (self.current.angle - self.start.angle)
    }

    /// Kinetic energy that the applied forces would give in the step to the body at rest (J).
    pub fn load_energy(&self) -> f64 {
        let terms = self.force.iter().zip(&self.mass);
        let moving = terms.filter(|(_, mass)| **mass > 0.0);
        moving
            .map(|(force, mass)| 0.5 * (self.dt * force).powi(2) / mass)
            .sum()
    }

    /// See [`super::Block::swing`].
    pub(super) fn swing(&self) -> [f64; 2] {
        [&self.smooth_start, &self.smooth_end].map(|acceleration| {
            let terms = self.mass.iter().zip(acceleration);
            let squared: f64 = terms.map(|(mass, a)| mass * a * a).sum();
            0.125 * self.dt * self.dt * squared
        })
    }

    /// Kinetic energy of a motion of this body (J).
    pub fn kinetic_energy(&self, motion: &RigidMotion) -> f64 {
        0.5 * (self.mass[0] * motion.velocity.x * motion.velocity.x
            + self.mass[1] * motion.velocity.y * motion.velocity.y
            + self.mass[2] * motion.spin * motion.spin)
    }
}
