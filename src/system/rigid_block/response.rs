//! What a rigid block answers to forces and impulses.

use super::RigidBlock;
use crate::math::{Mat2, Vec2, perp};

impl RigidBlock {
    /// What a wrench does, `A⁻¹ f` (m/s², rad/s²).
    #[inline]
    pub(in crate::system) fn answer(&self, wrench: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.inverse_effective[i] * wrench[i])
    }

    /// See [`crate::system::Block::compliance`], for two levers.
    pub fn compliance(&self, at: Vec2, from: Vec2) -> Mat2 {
        mobility(&self.inverse_effective, at, from)
    }

    /// How the unit wrench `at` moves along under the unit wrench `from`, `G A⁻¹ Gᵀ` (1/kg).
    pub fn mobility_between(&self, at: [f64; 3], from: [f64; 3]) -> f64 {
        let terms = at.iter().zip(from).zip(&self.inverse_effective);
        terms.map(|((at, from), inverse)| at * inverse * from).sum()
    }

    /// Smooth acceleration at the end of the step, and what a wrench adds (m/s², rad/s²).
    pub fn acceleration_under(&self, wrench: [f64; 3]) -> [f64; 3] {
        let change = self.answer(wrench);
        std::array::from_fn(|i| self.smooth_end[i] + change[i])
    }

    /// Lets a torque `-k (θ' - θ)` act within the position stage: what pulls at levers resists turning.
    ///
    /// `mobility` is what the multipliers move positions by, over `A⁻¹` (s²).
    pub fn stiffen(&mut self, twist: f64, mobility: f64) {
        if self.is_prescribed() || self.inverse_effective[2] <= 0.0 {
            return;
        }
        self.twist = twist;
        self.untwisted = [self.free.angle, self.inverse_effective[2]];
        let share = 1.0 / (1.0 + mobility * twist * self.inverse_effective[2]);
        self.inverse_effective[2] *= share;
        self.free.angle = self.start.angle + share * (self.free.angle - self.start.angle);
    }

    /// Ends what [`RigidBlock::stiffen`] began; returns the torque that acted (N m).
    pub fn relax(&mut self) -> f64 {
        if self.twist == 0.0 {
            return 0.0;
        }
        let torque = -self.twist * (self.current.angle - self.start.angle);
        self.twist = 0.0;
        [self.free.angle, self.inverse_effective[2]] = self.untwisted;
        torque
    }

    /// Inverse inertia with damping (1/(kg m²)).
    pub fn turning_mobility(&self) -> f64 {
        self.inverse_effective[2]
    }

    /// Acceleration at the end of a lever under a wrench (m/s²).
    pub fn respond(&self, lever: Vec2, wrench: [f64; 3]) -> Vec2 {
        let [x, y, turn] = self.answer(wrench);
        Vec2::new(x, y) + turn * perp(lever)
    }

    /// Mobility of the body as if it were alone, `n·M⁻¹·n` at a lever (1/kg).
    pub fn rigid_mobility(&self, lever: Vec2, direction: Vec2) -> f64 {
        direction.dot(&(mobility(&self.inverse_mass, lever, lever) * direction))
    }
}

/// `I/m + (J r_a)(J r_b)ᵀ/I` for world levers `r_a`, `r_b`.
fn mobility(inverse: &[f64; 3], at: Vec2, from: Vec2) -> Mat2 {
    let (at, from) = (perp(at), perp(from));
    Mat2::new(inverse[0], 0.0, 0.0, inverse[1]) + inverse[2] * at * from.transpose()
}
