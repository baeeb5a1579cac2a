//! How the surface of a body meets others.

use super::error::{FlexBodyError, check_held};
use super::flex_body::FlexBody;
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

impl FlexBody {
    /// Sets how the surface meets others, from the next step on.
    ///
    /// Rapier's collider is given what differs from the settings before; what the user has set on the collider itself stays.
    ///
    /// # Errors
    /// If a coefficient or the skin is negative, or no finite number that rapier's precision holds; nothing is then changed.
    pub fn set_contact_settings(&mut self, settings: ContactSettings) -> Result<(), FlexBodyError> {
        let numbers = [
            settings.friction,
            settings.restitution,
            settings.contact_skin,
        ];
        check_held("the contact settings", &numbers)?;
        if let Some(&value) = numbers.iter().find(|&&value| value < 0.0) {
            return Err(FlexBodyError::Negative(value));
        }
        if settings.contact_force_event_threshold.is_nan() {
            return Err(FlexBodyError::NotFinite("the contact settings"));
        }
        self.change_contact(|contact| *contact = settings);
        Ok(())
    }

    /// Sets which colliders the body meets, from the next step on.
    pub fn set_collision_groups(&mut self, groups: InteractionGroups) {
        self.change_contact(|contact| contact.collision_groups = groups);
    }

    /// Sets which of the colliders it meets the body pushes, from the next step on.
    pub fn set_solver_groups(&mut self, groups: InteractionGroups) {
        self.change_contact(|contact| contact.solver_groups = groups);
    }

    /// Sets which types of rigid bodies the body meets, from the next step on.
    pub fn set_active_collision_types(&mut self, types: ActiveCollisionTypes) {
        self.change_contact(|contact| contact.active_collision_types = types);
    }

    /// Sets which of the user's hooks are asked about the body, from the next step on.
    pub fn set_active_hooks(&mut self, hooks: ActiveHooks) {
        self.change_contact(|contact| contact.active_hooks = hooks);
    }

    /// Sets which events are reported, from the next step on.
    pub fn set_active_events(&mut self, events: ActiveEvents) {
        self.change_contact(|contact| contact.active_events = events);
    }

    /// Makes the body a sensor, which touches nothing, or a solid one again, from the next step on.
    pub fn set_sensor(&mut self, is_sensor: bool) {
        self.change_contact(|contact| contact.is_sensor = is_sensor);
    }

    /// Changes settings; what rapier's collider must be told wakes the body.
    fn change_contact(&mut self, change: impl FnOnce(&mut ContactSettings)) {
        change(&mut self.contact);
        self.is_disturbed |= self.contact != self.carrier_contact;
    }

    /// The settings that rapier's collider was given last and those it should have, if they differ.
    pub(crate) fn take_new_contact(&mut self) -> Option<[ContactSettings; 2]> {
        let given = std::mem::replace(&mut self.carrier_contact, self.contact);
        (given != self.contact).then_some([given, self.contact])
    }

    /// Takes over solver groups that were set on rapier's collider.
    pub(crate) fn adopt_solver_groups(&mut self, groups: InteractionGroups) {
        self.contact.solver_groups = groups;
        self.carrier_contact.solver_groups = groups;
    }
}
