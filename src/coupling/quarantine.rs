//! Bodies that are out of the world, and whose motion waits as the last sound step left it: the user has disabled them, or they are quarantined
//! because they would move as no number can say, as in rapier, while the rest of the world goes on.
//!
//! Their carriers and surfaces are disabled, so nothing meets them and no query sees them; their attachments hold nothing.

use super::carrier::is_carried;
use super::sets::RapierSets;
use crate::body::{FlexBody, FlexBodyError, FlexBodyHandle, FlexBodySet};
use crate::rapier::prelude::*;

impl FlexBodySet {
    /// Takes a body out of the world, or puts it back, as rapier's `RigidBody::set_enabled` does: while it is out it stays where it is, deformed
    /// and as fast as it was, nothing meets it, no query sees it and its attachments hold nothing. The next step wakes what rested on it; a body
    /// that is put back wakes, and what it is put into is told, as for a body just inserted.
    ///
    /// What has been quarantined stays out until [`FlexBodySet::reinstate`] is called.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// use foil2d::rapier::prelude::*;
    /// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
    /// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    /// let block = flex_bodies.insert(FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber), &mut world)?;
    /// flex_bodies.set_enabled(block, false, &mut world)?;
    /// FlexPipeline::new().step(&mut world, &mut flex_bodies)?;
    /// assert_eq!(flex_bodies[block].linvel(), [0.0, 0.0], "it does not fall");
    /// assert!(!flex_bodies.is_enabled(block, &world.bodies)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the handle is stale or foreign, the body is quarantined, or the world does not hold its carrier. Nothing is then changed.
    pub fn set_enabled(
        &mut self,
        handle: FlexBodyHandle,
        is_enabled: bool,
        world: &mut PhysicsWorld,
    ) -> Result<(), FlexBodyError> {
        let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
        self.set_enabled_with_sets(handle, is_enabled, bodies, colliders)
    }

    /// [`FlexBodySet::set_enabled`] for programs that keep rapier's sets apart.
    ///
    /// # Errors
    /// As [`FlexBodySet::set_enabled`].
    pub fn set_enabled_with_sets(
        &mut self,
        handle: FlexBodyHandle,
        is_enabled: bool,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Result<(), FlexBodyError> {
        let body = self.try_get_mut(handle)?;
        if body.is_quarantined() {
            return Err(FlexBodyError::Quarantined(handle));
        }
        if !is_carried(body, bodies, colliders) {
            return Err(FlexBodyError::NoCarrier(handle));
        }
        if is_out(body, bodies) == is_enabled {
            let (carrier, surface) = (body.rigid_body_handle(), body.collider_handle());
            enable(is_enabled, carrier, surface, bodies, colliders);
        }
        Ok(())
    }

    /// Whether a body takes part in the world of these bodies: nobody has disabled it or its carrier, and it is not quarantined.
    ///
    /// # Errors
    /// If the handle is stale or foreign.
    pub fn is_enabled(
        &self,
        handle: FlexBodyHandle,
        bodies: &RigidBodySet,
    ) -> Result<bool, FlexBodyError> {
        Ok(!is_out(self.try_get(handle)?, bodies))
    }

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
