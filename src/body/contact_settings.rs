//! How the surface of a body meets others.

use crate::rapier::prelude::{ActiveEvents, CoefficientCombineRule, InteractionGroups};

/// How a body's surface meets others; the names and meanings are rapier's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Coulomb's coefficient μ (-).
    pub friction: f64,
    /// How friction coefficients combine.
    pub friction_combine_rule: CoefficientCombineRule,
    /// Newton's coefficient of restitution (-).
    pub restitution: f64,
    /// How coefficients of restitution combine.
    pub restitution_combine_rule: CoefficientCombineRule,
    /// Which colliders the body meets.
    pub collision_groups: InteractionGroups,
    /// Which events rapier reports.
    pub active_events: ActiveEvents,
}

impl Default for ContactSettings {
    fn default() -> Self {
        Self {
            friction: 0.5,
            friction_combine_rule: CoefficientCombineRule::default(),
            restitution: 0.0,
            restitution_combine_rule: CoefficientCombineRule::default(),
            collision_groups: InteractionGroups::all(),
            active_events: ActiveEvents::empty(),
        }
    }
}
