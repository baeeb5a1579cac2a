//! Rapier's sets, borrowed together for one step.

use crate::rapier::prelude::*;

/// The arguments of `PhysicsPipeline::step`, the pipeline included.
pub struct RapierSets<'a> {
    /// Rapier's pipeline.
    pub physics_pipeline: &'a mut PhysicsPipeline,
    /// Gravity (m/s²).
    pub gravity: Vector,
    /// Rapier's parameters; their `dt` is the step.
    pub integration_parameters: &'a IntegrationParameters,
    /// Islands.
    pub islands: &'a mut IslandManager,
    /// Broad phase.
    pub broad_phase: &'a mut BroadPhaseBvh,
    /// Narrow phase.
    pub narrow_phase: &'a mut NarrowPhase,
    /// Rigid bodies.
    pub bodies: &'a mut RigidBodySet,
    /// Colliders.
    pub colliders: &'a mut ColliderSet,
    /// Impulse joints.
    pub impulse_joints: &'a mut ImpulseJointSet,
    /// Multibody joints.
    pub multibody_joints: &'a mut MultibodyJointSet,
    /// Rapier's own soft bodies.
    pub soft_bodies: &'a mut SoftBodySet,
    /// Continuous collision detection.
    pub ccd_solver: &'a mut CCDSolver,
    /// The user's hooks.
    pub hooks: &'a dyn PhysicsHooks,
    /// The user's event handler.
    pub events: &'a dyn EventHandler,
}

impl<'a> RapierSets<'a> {
    /// Borrows a whole world.
    pub fn of_world(
        world: &'a mut PhysicsWorld,
        hooks: &'a dyn PhysicsHooks,
        events: &'a dyn EventHandler,
    ) -> Self {
        Self {
            physics_pipeline: &mut world.physics_pipeline,
            gravity: world.gravity,
            integration_parameters: &world.integration_parameters,
            islands: &mut world.islands,
            broad_phase: &mut world.broad_phase,
            narrow_phase: &mut world.narrow_phase,
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &mut world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
            soft_bodies: &mut world.soft_bodies,
            ccd_solver: &mut world.ccd_solver,
            hooks,
            events,
        }
    }

    /// Rapier's own step.
    pub fn step(&mut self) {
        self.step_through(self.hooks, self.events);
    }

    /// Applies the user's changes and updates the contact graph, moving nothing.
    pub fn detect(&mut self) {
        self.detect_through(self.hooks, self.events);
    }

    /// Rapier's own step with other hooks and another handler than the user's.
    pub(crate) fn step_through(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        let parameters = *self.integration_parameters;
        self.step_with(&parameters, hooks, events);
    }

    /// [`RapierSets::detect`] with other hooks and another handler than the user's.
    pub(crate) fn detect_through(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        self.found_islands();
        let mut parameters = *self.integration_parameters;
        parameters.dt = 0.0;
        self.step_with(&parameters, hooks, events);
    }

    /// Lets rapier found its islands before the first step of a world if that has no length.
    ///
    /// Rapier 0.36 numbers its islands anew at the end of the first step that has one, and then reads what it noted under the old
    /// numbers: a body that is disabled or removed after a step without length, and before any other, leaves them out of range and
    /// rapier panics. A step of empty sets founds the islands while there is nothing to number.
    ///
    /// Rapier hears of impulse joints as if all were new: one that was restored from a snapshot knows of them only by founding its islands
    /// with them. Of multibodies and soft bodies it cannot be told again, and worlds that have any are left alone.
    fn found_islands(&mut self) {
        let mut all = self.bodies.iter();
        let is_new = self.islands.active_bodies().next().is_none()
            && !all.any(|(_, body)| body.is_sleeping());
        let has_other_links = self.multibody_joints.iter().next().is_some()
            || self.soft_bodies.iter().next().is_some();
        if is_new && !has_other_links {
            PhysicsPipeline::new().step(
                Vector::ZERO,
                &IntegrationParameters::default(),
                self.islands,
                &mut BroadPhaseBvh::new(),
                &mut NarrowPhase::new(),
                &mut RigidBodySet::new(),
                &mut ColliderSet::new(),
                &mut ImpulseJointSet::new(),
                &mut MultibodyJointSet::new(),
                &mut SoftBodySet::new(),
                &mut CCDSolver::new(),
                &(),
                &(),
            );
            let _all_told_anew = self.impulse_joints.iter_mut();
        }
    }

    fn step_with(
        &mut self,
        parameters: &IntegrationParameters,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) {
        self.physics_pipeline.step(
            self.gravity,
            parameters,
            self.islands,
            self.broad_phase,
            self.narrow_phase,
            self.bodies,
            self.colliders,
            self.impulse_joints,
            self.multibody_joints,
            self.soft_bodies,
            self.ccd_solver,
            hooks,
            events,
        );
    }
}
