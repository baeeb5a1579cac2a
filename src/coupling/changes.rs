//! What has been changed since rapier's last step, by the flags with which rapier knows it itself.
//!
//! Every write through rapier's sets marks what it touches. Rapier's lists of what is marked are not for others to read, so
//! the marks themselves are looked at, and at nothing else of what is not marked. What is neither marked nor awake is where rapier's tree has it, so
//! that it need not be asked.

use super::claim::Claims;
use super::places::{loosened, placed_on, swept_box, travel_of};
use super::sets::RapierSets;
use super::sleep::{is_asleep, reaches};
use crate::body::FlexBodySet;
use crate::rapier::data::HasModifiedFlag;
use crate::rapier::math::{Real, Vector};
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

/// What is marked, and what shows that something is gone.
#[derive(Debug, Default)]
pub(super) struct Changes {
    /// Marked bodies, those that the last step itself has written to included.
    pub bodies: Vec<RigidBodyHandle>,
    /// Marked colliders and those of marked bodies; some twice.
    pub colliders: Vec<ColliderHandle>,
    /// Those of them that are no surfaces, for as long as the claim looks for what is near.
    pub strangers: Vec<ColliderHandle>,
    pub n_colliders: usize,
    pub gravity: Vector,
}

/// What may end the rest of a flexible body that sleeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WorldChange {
    /// Nothing.
    None,
    /// Something has come, gone, been moved or altered somewhere: rapier knows whom it touches.
    Somewhere,
    /// Gravity, which acts on all.
    Everywhere,
}

impl Changes {
    fn gather(&mut self, sets: &RapierSets<'_>) {
        self.bodies.clear();
        self.colliders.clear();
        for (handle, collider) in sets.colliders.iter() {
            if collider.has_modified_flag() {
                self.colliders.push(handle);
            }
        }
        for (handle, body) in sets.bodies.iter() {
            if body.has_modified_flag() {
                self.bodies.push(handle);
                self.colliders.extend_from_slice(body.colliders());
            }
        }
    }
}

impl Claims {
    /// Colliders that were marked since rapier's last step, or whose body was; some twice.
    pub fn marked_colliders(&self) -> &[ColliderHandle] {
        &self.changes.colliders
    }

    /// Gathers what was changed since rapier's last step, and says whether it may concern what sleeps. Where nothing sleeps, nothing
    /// does.
    pub fn look_for_changes(
        &mut self,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) -> WorldChange {
        self.changes.gather(sets);
        let is_counted = self.changes.n_colliders == sets.colliders.len();
        let is_weighed = self.changes.gravity == sets.gravity;
        let mut changed = self.changes.colliders.iter();
        let change = if !is_weighed {
            WorldChange::Everywhere
        } else if !is_counted || changed.any(|&handle| self.is_altered(sets, handle)) {
            WorldChange::Somewhere
        } else {
            return WorldChange::None;
        };
        let mut all = flex_bodies.iter();
        if all.any(|(_, body)| is_asleep(body, sets.bodies)) {
            change
        } else {
            WorldChange::None
        }
    }

    /// Notes what the next step is to be compared with.
    pub fn note_world(&mut self, sets: &RapierSets<'_>) {
        self.changes.n_colliders = sets.colliders.len();
        self.changes.gravity = sets.gravity;
    }

    /// [`Claims::look_for_changes`] after a detection step, which has taken all changes over.
    pub fn note_changes_taken_over(&mut self, sets: &RapierSets<'_>) {
        self.changes.gather(sets);
    }

    /// Whether a collider is another than after the last step. Marks alone do not say so: rapier marks bodies that it wakes, and the
    /// last step has written the surfaces of flexible bodies and the velocities of claimed ones.
    fn is_altered(&self, sets: &RapierSets<'_>, handle: ColliderHandle) -> bool {
        let Some(collider) = sets.colliders.get(handle) else {
            return false;
        };
        if self.is_surface(handle) {
            return false;
        }
        let body = collider.parent().and_then(|parent| sets.bodies.get(parent));
        collider.has_modified_flag()
            || body.is_some_and(|body| {
                *collider.position() != placed_on(body, collider)
                    || (collider.is_enabled() && !body.is_enabled())
            })
    }

    /// Wakes sleepers beside which something was put or altered.
    pub fn wake_beside_changes(&self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let dt = sets.integration_parameters.dt;
        let margin = sets.integration_parameters.prediction_distance();
        for (_, body) in flex_bodies.iter() {
            let surface = body.collider_handle();
            let Some(collider) = sets.colliders.get(surface) else {
                continue;
            };
            let own = collider.compute_aabb();
            let meets = |&handle: &ColliderHandle| {
                let other = sets.colliders.get(handle);
                let other = other.filter(|other| !other.is_sensor());
                other.is_some_and(|other| {
                    let near = loosened(swept_box(sets.bodies, other, dt), margin);
                    near.intersects(&own)
                        && self.is_altered(sets, handle)
                        && reaches(sets, surface, &near)
                })
            };
            if is_asleep(body, sets.bodies) && self.changes.colliders.iter().any(meets) {
                sets.islands
                    .wake_up(sets.bodies, body.rigid_body_handle(), true);
            }
        }
    }

    /// Colliders whose place rapier's tree need not know: those of bodies that are awake, and whatever was changed; some twice.
    pub(super) fn unsettled<'a>(
        &'a self,
        sets: &'a RapierSets<'_>,
    ) -> impl Iterator<Item = (ColliderHandle, &'a Collider)> + 'a {
        let awake = sets.islands.active_bodies();
        let of_awake = awake.filter_map(|handle| sets.bodies.get(handle));
        let handles = of_awake.flat_map(|body| body.colliders().iter());
        let handles = handles.chain(&self.changes.colliders);
        handles.filter_map(|&handle| Some((handle, sets.colliders.get(handle)?)))
    }

    /// Whether no rigid body moves or was set moving, and nobody has written to a surface.
    pub(super) fn rests_all_rigid(&self, sets: &RapierSets<'_>) -> bool {
        let rests = |handle: RigidBodyHandle| {
            let body = sets.bodies.get(handle);
            body.is_none_or(|body| body.is_fixed() || body.is_sleeping() || !body.is_enabled())
        };
        let mut changed = self.changes.colliders.iter();
        sets.islands.active_bodies().all(rests)
            && self.changes.bodies.iter().copied().all(rests)
            && !changed.any(|&handle| self.is_surface(handle))
    }

    /// How far the fastest body that is awake goes in the step (m), after the detection step.
    pub(super) fn farthest_travel(&self, sets: &RapierSets<'_>) -> Real {
        let dt = sets.integration_parameters.dt;
        let awake = sets.islands.active_bodies();
        awake
            .filter_map(|handle| sets.bodies.get(handle))
            .filter(|body| !body.is_fixed() && !body.is_sleeping())
            .map(|body| travel_of(body, dt))
            .chain(self.flex.iter().map(|flex| flex.travel))
            .fold(0.0, Real::max)
    }
}
