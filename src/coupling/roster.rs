//! The roster: flexible bodies that take part in a step, with the boxes in which they are looked for, and those that sleep.

use super::places::{loosened, order_of_boxes, swept_surface};
use super::quarantine::is_out;
use super::sets::RapierSets;
use super::sleep::Sleeper;
use crate::body::{FlexBody, FlexBodySet, FlexState};
use crate::constraint::contact::Owner;
use crate::math::{HashMap, HashSet, from_rapier};
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::Aabb;
use crate::rapier::prelude::*;
use std::ops::Index;

/// A flexible body taking part in the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClaimedFlex {
    /// Slot in the set.
    pub index: u32,
    /// Its surface in rapier.
    pub collider: ColliderHandle,
    /// Box of its surface over the step.
    pub swept: Aabb,
    /// How far its fastest node goes in the step (m).
    pub travel: Real,
    /// Size of a boundary segment (m).
    pub edge: f64,
    /// How far gravity takes it in the step (m), from the velocity that it has.
    pub fall: f64,
    /// By how much the box is larger than where its velocity takes it (m).
    pub slack: Real,
    /// Whether it has stayed where it is since the step before, at least.
    pub rests: bool,
    /// What it pushes; its surface in rapier pushes nothing.
    pub solver_groups: InteractionGroups,
}

impl ClaimedFlex {
    fn new(index: u32, body: &FlexBody, sets: &RapierSets<'_>) -> Self {
        let dt = f64::from(sets.integration_parameters.dt);
        let edge = body.mesh().boundary().mean_segment_length();
        let (swept, travel) = swept_surface(body, dt);
        let fall = from_rapier(sets.gravity).norm() * body.gravity_scale().abs() * dt * dt;
        let skin = body.contact_settings().contact_skin;
        let recoil = recoil(body.state(), body.mass()) * dt;
        let edge = edge + 2.0 * recoil;
        let slack = (0.5 * edge + fall + skin) as Real;
        Self {
            index,
            collider: body.collider_handle(),
            swept: loosened(swept, slack),
            travel: travel + recoil as Real,
            edge,
            fall,
            slack,
            rests: body.time_still() > 0.0,
            solver_groups: body.contact_settings().solver_groups,
        }
    }

    /// How far around where its velocity takes it the body may get in the step (m).
    pub fn reach(&self) -> f64 {
        self.edge + self.fall + f64::from(self.travel)
    }
}

/// The flexible bodies of a step. Those that take part are in the order of their places, each in a slot.
#[derive(Debug, Default)]
pub(crate) struct Roster {
    awake: Vec<ClaimedFlex>,
    slot_of: HashMap<ColliderHandle, usize>,
    /// In the order of their slots in the set.
    asleep: Vec<Sleeper>,
    sleeping_surfaces: HashSet<ColliderHandle>,
}

impl Roster {
    /// Lists the flexible bodies where the step begins.
    pub fn list(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.awake.clear();
        self.slot_of.clear();
        self.asleep.clear();
        self.sleeping_surfaces.clear();
        for (handle, body) in flex_bodies
            .iter()
            .filter(|(_, body)| !is_out(body, sets.bodies))
        {
            let index = handle.into_raw_parts().0;
            if let Some(sleeper) = Sleeper::new(index, body, sets) {
                self.sleeping_surfaces.insert(sleeper.collider);
                self.asleep.push(sleeper);
            } else {
                self.awake.push(ClaimedFlex::new(index, body, sets));
            }
        }
        // The order of insertion is not physics.
        self.awake.sort_unstable_by(|one, other| {
            order_of_boxes(&one.swept, &other.swept).then(one.index.cmp(&other.index))
        });
        for (slot, flex) in self.awake.iter().enumerate() {
            self.slot_of.insert(flex.collider, slot);
        }
    }

    /// Grows the boxes of all that take part (m).
    pub fn grow(&mut self, by: Real) {
        for flex in &mut self.awake {
            flex.swept = loosened(flex.swept, by);
            flex.travel += by;
        }
    }

    /// How many flexible bodies take part.
    pub fn len(&self) -> usize {
        self.awake.len()
    }

    /// Those that take part.
    pub fn iter(&self) -> std::slice::Iter<'_, ClaimedFlex> {
        self.awake.iter()
    }

    /// Those that sleep.
    pub fn asleep(&self) -> &[Sleeper] {
        &self.asleep
    }

    /// The slot of the body whose surface a collider is, if it takes part.
    pub fn slot_of(&self, collider: ColliderHandle) -> Option<usize> {
        self.slot_of.get(&collider).copied()
    }

    /// Whether a collider is the surface of a flexible body, awake or not.
    pub fn is_surface(&self, collider: ColliderHandle) -> bool {
        self.slot_of.contains_key(&collider) || self.is_sleeping_surface(collider)
    }

    /// Whether a collider is the surface of a flexible body that sleeps.
    pub fn is_sleeping_surface(&self, collider: ColliderHandle) -> bool {
        self.sleeping_surfaces.contains(&collider)
    }

    /// Whether an owner's body sleeps.
    pub fn sleeps(&self, sets: &RapierSets<'_>, owner: Owner) -> bool {
        match owner {
            Owner::Flex(index) => {
                let found = self
                    .asleep
                    .binary_search_by_key(&index, |sleeper| sleeper.index);
                found.is_ok()
            }
            Owner::Collider(index) => {
                let collider = sets.colliders.get_unknown_gen(index);
                let parent = collider.and_then(|(collider, _)| collider.parent());
                let body = parent.and_then(|parent| sets.bodies.get(parent));
                body.is_some_and(RigidBody::is_sleeping)
            }
        }
    }

    /// A joint of the user's to the carrier of a body that takes part, if there is one.
    pub fn joint_to_carrier(&self, sets: &RapierSets<'_>) -> Option<ImpulseJointHandle> {
        if sets.impulse_joints.is_empty() {
            return None;
        }
        let carriers = self.awake.iter().filter_map(|flex| {
            let collider = sets.colliders.get(flex.collider)?;
            collider.parent()
        });
        let mut joints =
            carriers.flat_map(|carrier| sets.impulse_joints.attached_enabled_joints(carrier));
        joints.next().map(|(_, _, handle, _)| handle)
    }
}

/// What a snapshot writes: which colliders are surfaces is asked of in a step without a claim.
#[cfg(feature = "serde-serialize")]
impl Roster {
    /// The surfaces of bodies that take part, with their slots.
    pub fn slots(&self) -> &HashMap<ColliderHandle, usize> {
        &self.slot_of
    }

    /// A roster of which no more is known than whose surfaces there were.
    pub fn remembered(slots: Vec<(ColliderHandle, usize)>, asleep: Vec<Sleeper>) -> Self {
        Self {
            slot_of: slots.into_iter().collect(),
            sleeping_surfaces: asleep.iter().map(|sleeper| sleeper.collider).collect(),
            asleep,
            ..Self::default()
        }
    }
}

impl Index<usize> for Roster {
    type Output = ClaimedFlex;

    fn index(&self, slot: usize) -> &ClaimedFlex {
        &self.awake[slot]
    }
}

impl<'a> IntoIterator for &'a Roster {
    type Item = &'a ClaimedFlex;
    type IntoIter = std::slice::Iter<'a, ClaimedFlex>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Speed (m/s) that a body held for a step, or woken, may have by the end of the next: neither its velocity nor its acceleration
/// tells of the energy that it stores.
fn recoil(state: &FlexState, mass: f64) -> f64 {
    let is_stopped = state.kinetic_energy == 0.0 && state.frame.acceleration.norm_squared() == 0.0;
    if is_stopped {
        (2.0 * state.elastic_energy.max(0.0) / mass).sqrt()
    } else {
        0.0
    }
}
