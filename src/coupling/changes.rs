//! What has been changed since rapier's last step, by the flags with which rapier knows it itself.
//!
//! Every write through rapier's sets marks what it touches. Rapier's lists of what is marked are not for others to read, so
//! the marks themselves are looked at, and at nothing else of what is not marked. What is neither marked nor awake is where rapier's tree has it, so
//! that it need not be asked.

use super::joint_changes::KnownJoints;
use super::places::{loosened, placed_on, swept_box};
use super::roster::Roster;
use super::sets::RapierSets;
use super::sleep::reaches;
use crate::body::FlexBodySet;
use crate::rapier::data::HasModifiedFlag;
use crate::rapier::math::Vector;
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

/// What is marked, and what shows that something is gone.
#[derive(Debug, Default)]
pub(super) struct Changes {
    /// Marked bodies, those that the last step itself has written to included.
    bodies: Vec<RigidBodyHandle>,
    /// Marked colliders and those of marked bodies; some twice.
    colliders: Vec<ColliderHandle>,
    /// Those that the user has inserted, moved or altered since rapier's last step; some twice.
    altered: Vec<ColliderHandle>,
    /// What the next step is compared with: the number of colliders, and gravity.
    noted: (usize, Vector),
    /// And the joints.
    pub joints: KnownJoints,
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
    /// Gathers what is marked: since rapier's last step or, after a detection step, which has taken all changes over, since that.
    pub fn gather(&mut self, sets: &RapierSets<'_>) {
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

    /// Colliders that are marked, or whose body is; some twice.
    pub fn colliders(&self) -> &[ColliderHandle] {
        &self.colliders
    }

    /// Whether the user has inserted, moved or altered a collider since rapier's last step.
    pub fn has_altered(&self, collider: ColliderHandle) -> bool {
        self.altered.contains(&collider)
    }

    /// Gathers what was changed since rapier's last step, and says whether it may concern what sleeps. Where nothing sleeps, nothing
    /// does.
    pub fn look(
        &mut self,
        sets: &RapierSets<'_>,
        flex: &Roster,
        flex_bodies: &FlexBodySet,
    ) -> WorldChange {
        self.gather(sets);
        let (n_colliders, gravity) = self.noted;
        let is_counted = n_colliders == sets.colliders.len();
        let is_weighed = gravity == sets.gravity;
        self.altered.clear();
        let changed = self.colliders.iter().copied();
        self.altered
            .extend(changed.filter(|&handle| is_altered(sets, flex, handle)));
        let change = if !is_weighed {
            WorldChange::Everywhere
        } else if !is_counted || !self.altered.is_empty() {
            WorldChange::Somewhere
        } else if self.joints.have_changed(sets) {
            return WorldChange::Somewhere;
        } else {
            return WorldChange::None;
        };
        let mut all = flex_bodies.iter();
        if all.any(|(_, body)| body.is_sleeping(sets.bodies)) {
            change
        } else {
            WorldChange::None
        }
    }

    /// Notes what the next step is to be compared with.
    pub fn note_world(&mut self, sets: &RapierSets<'_>) {
        self.noted = (sets.colliders.len(), sets.gravity);
        self.joints.note(sets);
    }

    /// Wakes sleepers beside which something was put or altered.
    pub fn wake_beside(&self, sets: &mut RapierSets<'_>, flex: &Roster, flex_bodies: &FlexBodySet) {
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
                    let near = loosened(swept_box(sets, other), margin);
                    near.intersects(&own)
                        && is_altered(sets, flex, handle)
                        && reaches(sets, surface, &near)
                })
            };
            if body.is_sleeping(sets.bodies) && self.colliders.iter().any(meets) {
                sets.islands
                    .wake_up(sets.bodies, body.rigid_body_handle(), true);
            }
        }
    }

    /// Colliders whose place rapier's tree need not know: those of bodies that are awake, and whatever was changed; some twice.
    pub fn unsettled<'a>(
        &'a self,
        sets: &'a RapierSets<'_>,
    ) -> impl Iterator<Item = (ColliderHandle, &'a Collider)> + 'a {
        let awake = sets.islands.active_bodies();
        let of_awake = awake.filter_map(|handle| sets.bodies.get(handle));
        let handles = of_awake.flat_map(|body| body.colliders().iter());
        let handles = handles.chain(&self.colliders);
        handles.filter_map(|&handle| Some((handle, sets.colliders.get(handle)?)))
    }

    /// Whether no rigid body moves or was set moving, and nobody has written to a surface.
    pub fn leave_at_rest(&self, sets: &RapierSets<'_>, flex: &Roster) -> bool {
        let rests = |handle: RigidBodyHandle| {
            let body = sets.bodies.get(handle);
            body.is_none_or(|body| body.is_fixed() || body.is_sleeping() || !body.is_enabled())
        };
        let mut changed = self.colliders.iter();
        sets.islands.active_bodies().all(rests)
            && self.bodies.iter().copied().all(rests)
            && !changed.any(|&handle| flex.is_surface(handle))
    }
}

/// What a snapshot writes: what the next step is compared with.
#[cfg(feature = "serde-serialize")]
impl Changes {
    /// The number of colliders and gravity.
    pub fn noted(&self) -> (usize, Vector) {
        self.noted
    }

    /// Changes of a world that had so many colliders, gravity, and these joints.
    pub fn since(n_colliders: usize, gravity: Vector, joints: KnownJoints) -> Self {
        Self {
            noted: (n_colliders, gravity),
            joints,
            ..Self::default()
        }
    }
}

/// Whether a collider is another than after the last step. Marks alone do not say so: rapier marks bodies that it wakes, and the
/// last step has written the surfaces of flexible bodies and the velocities of claimed ones.
fn is_altered(sets: &RapierSets<'_>, flex: &Roster, handle: ColliderHandle) -> bool {
    let Some(collider) = sets.colliders.get(handle) else {
        return false;
    };
    let body = collider.parent().and_then(|parent| sets.bodies.get(parent));
    if flex.is_surface(handle) {
        // It took part in the last step.
        return body.is_some_and(|body| !body.is_enabled());
    }
    collider.has_modified_flag()
        || body.is_some_and(|body| {
            *collider.position() != placed_on(body, collider)
                || (collider.is_enabled() && !body.is_enabled())
        })
}
