//! Blocks that belong together, as one rigid body.

use crate::math::{Vec2, cross};
use crate::system::{Moments, RigidRates};

/// Mass and momentum of a group, and the motion of what holds it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Group {
    pub mass: f64,
    moment: Vec2,
    momentum: Vec2,
    /// Polar inertia and angular momentum about its centre (kg m², kg m²/s).
    polar: f64,
    angular: f64,
    /// The motion of a member that nothing moves.
    pub anchor: Option<RigidRates>,
}

impl Group {
    /// Adds the mass and the momentum of a member; those of all come before what they have about their centre.
    pub fn add(&mut self, own: &Moments) {
        self.mass += own.mass;
        self.moment += own.mass * own.centre;
        self.momentum += own.mass * own.velocity;
    }

    /// Adds what a member has about the centre of the group.
    pub fn add_turning(&mut self, own: &Moments) {
        let arm = own.centre - self.centre();
        self.polar += own.inertia + own.mass * arm.norm_squared();
        self.angular += own.spin_momentum + own.mass * cross(arm, own.velocity);
    }

    /// Centre of mass (m).
    pub fn centre(&self) -> Vec2 {
        self.moment / self.mass
    }

    /// Inertia about that (kg m²).
    pub fn polar(&self) -> f64 {
        self.polar
    }

    /// Adds the momentum that loads bring (N s).
    pub fn push(&mut self, impulse: Vec2) {
        self.momentum += impulse;
    }

    /// The motion of one rigid body with the momentum of the group, or that of what holds it.
    pub fn motion(&self) -> RigidRates {
        let spin = match self.polar > 0.0 {
            true => self.angular / self.polar,
            false => 0.0,
        };
        self.anchor.unwrap_or_else(|| RigidRates {
            about: self.centre(),
            velocity: self.momentum / self.mass,
            spin,
        })
    }
}
