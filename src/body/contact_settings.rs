//! How the surface of a body meets others.

use crate::rapier::prelude::{
    ActiveCollisionTypes, ActiveEvents, ActiveHooks, CoefficientCombineRule, InteractionGroups,
};

/// How a body's surface meets others; the names and meanings are rapier's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
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
    /// Which of those it pushes; the others are only reported.
    pub solver_groups: InteractionGroups,
    /// Which types of rigid bodies it meets; a flexible body counts as a dynamic one.
    pub active_collision_types: ActiveCollisionTypes,
    /// Which of the user's hooks are asked.
    pub active_hooks: ActiveHooks,
    /// Which events rapier reports.
    pub active_events: ActiveEvents,
    /// Force above which a force event is reported (N).
    pub contact_force_event_threshold: f64,
    /// Distance at which the surface touches (m), added to that of the other collider.
    pub contact_skin: f64,
    /// Whether the body only reports what crosses its surface, and touches nothing.
    pub is_sensor: bool,
}

impl Default for ContactSettings {
    fn default() -> Self {
        Self {
            friction: 0.5,
            friction_combine_rule: CoefficientCombineRule::default(),
            restitution: 0.0,
            restitution_combine_rule: CoefficientCombineRule::default(),
            collision_groups: InteractionGroups::all(),
            solver_groups: InteractionGroups::all(),
            active_collision_types: ActiveCollisionTypes::default(),
            active_hooks: ActiveHooks::empty(),
            active_events: ActiveEvents::empty(),
            contact_force_event_threshold: 0.0,
            contact_skin: 0.0,
            is_sensor: false,
        }
    }
}
