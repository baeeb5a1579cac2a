//! Quarantine: a body whose motion is not finite leaves the world, as in rapier, and the rest of it goes on.
//!
//! Its carrier and surface are disabled, so nothing meets it and no query sees it; its attachments hold nothing. Its motion stays what
//! the last sound step left.

use super::sets::RapierSets;
use crate::body::{FlexBody, FlexBodyError, FlexBodyHandle, FlexBodySet};
use crate::rapier::prelude::*;

impl FlexBodySet {
    /// Puts a quarantined body back into the world, where and as fast as it was: what made it sick has to be mended before, or
    /// the next step takes it out again. Does nothing to a body that is well.
    ///
    /// Its attachments hold again at once: where what they hold it to has moved away, the next step pulls the body there, however far that
    /// is. Detach them first.
    ///
    /// # Errors
    /// If the handle is stale or foreign.
    pub fn reinstate(
        &mut self,
        handle: FlexBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Result<(), FlexBodyError> {
        let body = self.try_get_mut(handle)?;
        if body.is_quarantined() {
            body.set_quarantined(false);
            let (carrier, surface) = (body.rigid_body_handle(), body.collider_handle());
            enable(true, carrier, surface, bodies, colliders);
        }
        Ok(())
    }
}

/// Whether a body takes no part: it is quarantined, or the user has disabled its carrier, which stops it where it is as rapier's own bodies.
pub(crate) fn is_out(body: &FlexBody, bodies: &RigidBodySet) -> bool {
    let carrier = bodies.get(body.rigid_body_handle());
    body.is_quarantined() || carrier.is_some_and(|carrier| !carrier.is_enabled())
}

/// Takes a body out of the world.
pub(crate) fn quarantine(
    handle: FlexBodyHandle,
    sets: &mut RapierSets<'_>,
    flex_bodies: &mut FlexBodySet,
) {
    let Some(body) = flex_bodies.get_mut(handle) else {
        return;
    };
    body.set_quarantined(true);
    let (carrier, surface) = (body.rigid_body_handle(), body.collider_handle());
    enable(false, carrier, surface, sets.bodies, sets.colliders);
}

/// Quarantines the bodies whose carriers were given what is no number, and puts these right: rapier never sees it.
pub(crate) fn quarantine_carriers(
    sets: &mut RapierSets<'_>,
    flex_bodies: &mut FlexBodySet,
    sick: &mut Vec<FlexBodyHandle>,
) {
    let first = sick.len();
    for (handle, body) in flex_bodies.iter() {
        let Some(carrier) = sets.bodies.get(body.rigid_body_handle()) else {
            continue;
        };
        let (at, turn) = (carrier.translation(), carrier.rotation());
        let (velocity, spin) = (carrier.linvel(), carrier.angvel());
        let all = [at.x, at.y, turn.re, turn.im, velocity.x, velocity.y, spin];
        if !all.into_iter().all(|x| x.is_finite()) {
            sick.push(handle);
        }
    }
    for &handle in &sick[first..] {
        quarantine(handle, sets, flex_bodies);
        let carrier = flex_bodies.get(handle).map(|body| body.rigid_body_handle());
        if let Some(carrier) = carrier.and_then(|carrier| sets.bodies.get_mut(carrier)) {
            carrier.set_position(Pose::IDENTITY, false);
            carrier.set_linvel(Vector::ZERO, false);
            carrier.set_angvel(0.0, false);
        }
    }
}

/// Disables the joints of disabled bodies that hold nothing else that moves, as rapier does with those that a body has when it is disabled: it
/// panics where one is put to bodies that have been disabled before. They are enabled again with a body.
pub(crate) fn disable_joints_of_disabled(sets: &mut RapierSets<'_>) {
    let bodies = &*sets.bodies;
    let is_idle = |joint: &ImpulseJoint| {
        let ends = [joint.body1(), joint.body2()].map(|end| bodies.get(end));
        let is_disabled = |body: &RigidBody| !body.is_enabled();
        let mut ends = ends.into_iter().flatten();
        ends.clone().any(is_disabled) && ends.all(|body| is_disabled(body) || body.is_fixed())
    };
    let joints = sets.impulse_joints.iter();
    let idle: Vec<ImpulseJointHandle> = joints
        .filter(|(_, joint)| joint.data.is_enabled() && is_idle(joint))
        .map(|(handle, _)| handle)
        .collect();
    for handle in idle {
        if let Some(joint) = sets.impulse_joints.get_mut(handle, false) {
            joint.data.enabled = JointEnabled::DisabledByAttachedBody;
        }
    }
}

fn enable(
    is_enabled: bool,
    carrier: RigidBodyHandle,
    surface: ColliderHandle,
    bodies: &mut RigidBodySet,
    colliders: &mut ColliderSet,
) {
    if let Some(carrier) = bodies.get_mut(carrier) {
        carrier.set_enabled(is_enabled);
    }
    if let Some(surface) = colliders.get_mut(surface) {
        surface.set_enabled(is_enabled);
    }
}
