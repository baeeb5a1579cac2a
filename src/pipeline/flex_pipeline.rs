//! The pipeline: settings and buffers, no state of its own but the memory of contacts and claimed bodies.

use super::clock::Clock;
use super::error::StepError;
use super::joint_accounts::drop_orphans;
use super::report::StepReport;
use super::settings::FlexParameters;
use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::constraint::contact::ContactMemory;
use crate::coupling::{
    Claims, EventBook, Gatherer, HookGate, JointImpulse, Landing, LinkBook, Masters, RapierSets,
    Trespassers, WorldChange, hand_back, land, rests, stop_if_asleep, sync_settings,
    wake_disturbed, write_impulses, write_surface,
};
use crate::kkt::Island;
use crate::rapier::prelude::*;

/// Steps a rapier world together with its flexible bodies.
///
/// Holds [parameters](FlexParameters) and buffers; use one pipeline for one world.
///
/// ```
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
/// let mut world = PhysicsWorld::new();
/// world.insert_collider(ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
/// let mut flex_bodies = FlexBodySet::new();
/// let block = flex_bodies.insert(
///     FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
///         .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0).rayleigh(2e-3))
///         .translation([0.0, 0.01]),
///     &mut world,
/// )?;
/// let mut flex = FlexPipeline::new();
/// for _ in 0..240 {
///     flex.step(&mut world, &mut flex_bodies)?;
/// }
/// let weight = 9.81 * flex_bodies[block].mass();
/// assert!((flex_bodies[block].total_contact_force()[1] / weight - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FlexPipeline {
    /// How steps are taken; may be changed between any two of them.
    pub parameters: FlexParameters,
    pub(super) claims: Claims,
    pub(super) gatherer: Gatherer,
    pub(super) masters: Masters,
    pub(super) links: LinkBook,
    pub(super) memory: ContactMemory,
    pub(super) island: Island,
    pub(super) landings: Vec<Landing>,
    pub(super) reserves: Vec<(u32, f64)>,
    pub(super) joint_impulses: Vec<JointImpulse>,
    /// Components with flexible bodies, and whether some of these are of large strain.
    pub(super) components: Vec<(usize, bool)>,
    pub(super) events: EventBook,
    pub(super) report: StepReport,
    /// What nobody has claimed and rapier's own step has left in a flexible body.
    pub(super) trespassers: Trespassers,
    /// Bodies taken out of the world in this step.
    pub(super) sick: Vec<FlexBodyHandle>,
}

impl Default for FlexPipeline {
    fn default() -> Self {
        Self::new()
    }
}

impl FlexPipeline {
    /// A pipeline with `Beta2::damped(0.9)` and stabilized impacts.
    pub fn new() -> Self {
        Self {
            parameters: FlexParameters::default(),
            claims: Claims::default(),
            gatherer: Gatherer::default(),
            masters: Masters::default(),
            links: LinkBook::default(),
            memory: ContactMemory::default(),
            island: Island::default(),
            landings: Vec::new(),
            reserves: Vec::new(),
            joint_impulses: Vec::new(),
            components: Vec::new(),
            events: EventBook::default(),
            report: StepReport::default(),
            trespassers: Trespassers::default(),
            sick: Vec::new(),
        }
    }

    /// The report of the last step.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// Steps the world by its own `dt`.
    ///
    /// # Errors
    /// [`StepError`]; bodies are then as they were before the step.
    pub fn step(
        &mut self,
        world: &mut PhysicsWorld,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<&StepReport, StepError> {
        self.step_with_events(world, flex_bodies, &(), &())
    }

    /// [`FlexPipeline::step`] with the user's hooks and event handler.
    ///
    /// Of flexible bodies, and of rigid ones solved with them, the handler hears after the step: a collision starts in the
    /// step in which it presses, or when rapier sees it coming, and forces are those that acted (normal ones in
    /// [`ContactForceEvent::total_force`](crate::rapier::geometry::ContactForceEvent), as in rapier).
    ///
    /// `modify_solver_contacts` is shown every such contact as a manifold of one point. It may change friction, restitution, normal and
    /// distance, or clear the contact; `tangent_velocity` is not looked at. Pairs of two rigid bodies it sees in rapier's manifolds
    /// as well, and the carrier of a flexible body is a rigid body with all axes locked.
    ///
    /// # Errors
    /// As [`FlexPipeline::step`].
    pub fn step_with_events(
        &mut self,
        world: &mut PhysicsWorld,
        flex_bodies: &mut FlexBodySet,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) -> Result<&StepReport, StepError> {
        self.step_sets(RapierSets::of_world(world, hooks, events), flex_bodies)
    }

    /// [`FlexPipeline::step`] for programs that keep rapier's sets apart, with the arguments of
    /// `PhysicsPipeline::step` in their order.
    ///
    /// # Errors
    /// As [`FlexPipeline::step`].
    #[expect(clippy::too_many_arguments, reason = "they are rapier's")]
    pub fn step_split(
        &mut self,
        flex_bodies: &mut FlexBodySet,
        physics_pipeline: &mut PhysicsPipeline,
        gravity: Vector,
        integration_parameters: &IntegrationParameters,
        islands: &mut IslandManager,
        broad_phase: &mut BroadPhaseBvh,
        narrow_phase: &mut NarrowPhase,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        impulse_joints: &mut ImpulseJointSet,
        multibody_joints: &mut MultibodyJointSet,
        soft_bodies: &mut SoftBodySet,
        ccd_solver: &mut CCDSolver,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) -> Result<&StepReport, StepError> {
        let sets = RapierSets {
            physics_pipeline,
            gravity,
            integration_parameters,
            islands,
            broad_phase,
            narrow_phase,
            bodies,
            colliders,
            impulse_joints,
            multibody_joints,
            soft_bodies,
            ccd_solver,
            hooks,
            events,
        };
        self.step_sets(sets, flex_bodies)
    }

    /// [`FlexPipeline::step_split`] with the arguments as one value.
    ///
    /// # Errors
    /// As [`FlexPipeline::step`].
    pub fn step_sets(
        &mut self,
        mut sets: RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<&StepReport, StepError> {
        self.step_without_the_sick(&mut sets, flex_bodies)?;
        Ok(&self.report)
    }

    /// One try of a step.
    pub(super) fn try_step(
        &mut self,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<(), StepError> {
        self.report.clear();
        let (user, hooks) = (sets.events, sets.hooks);
        if flex_bodies.is_empty() {
            if self.events.is_empty() {
                sets.step();
            } else {
                sets.step_through(hooks, &self.events.gate(user, None));
                self.events.tell(sets);
            }
            return Ok(());
        }
        let mut clock = Clock::start();
        let dissipated = self.report.energy.dissipated;
        let step = self.check(sets)?;
        drop_orphans(sets, flex_bodies);
        let change = self.claims.look_for_changes(sets, flex_bodies);
        self.check_colliders(sets)?;
        let is_quiet = step.dt > 0.0 && change == WorldChange::None;
        if is_quiet && self.claims.is_all_asleep(sets, flex_bodies) {
            self.step_asleep(sets, flex_bodies.len());
            return Ok(());
        }
        self.check_bodies(step.dt, sets, flex_bodies)?;
        self.claims.note_world(sets);
        sync_settings(flex_bodies, sets.colliders);
        wake_disturbed(sets, flex_bodies, change == WorldChange::Everywhere);
        let is_changed = change == WorldChange::Somewhere;
        if is_changed {
            self.wake_for_changes(sets, flex_bodies);
        }
        self.claims.look_ahead(sets, flex_bodies);
        self.report.n_asleep = self.claims.flex.asleep().len();
        if let Some(joint) = self.claims.flex.joint_to_carrier(sets) {
            return Err(StepError::CarrierJoint(joint));
        }
        let is_detected = step.dt == 0.0 || is_changed || self.claims.needs_detection(sets);
        clock.lap(&mut self.report.times.claim);
        self.report.is_detected = is_detected;
        if is_detected {
            if !is_changed {
                self.detect(sets);
                self.report.note_quarantine(sets);
            }
            clock.lap(&mut self.report.times.rapier);
            if step.dt == 0.0 {
                // The tree may be out to be optimized: a detection step without changes puts it back for queries.
                self.detect(sets);
                self.events.tell_detected(sets);
                return Ok(());
            }
            self.claims.sweep(sets);
        }
        self.claims.walk(sets);
        self.gatherer.retain(sets, flex_bodies);
        self.note_newcomers(sets, flex_bodies);
        clock.lap(&mut self.report.times.claim);
        if let Err(error) = self.solve_and_look(step, sets, flex_bodies, &mut clock) {
            let is_detected = self.report.is_detected;
            self.undo(flex_bodies, dissipated);
            if is_detected {
                // As above.
                self.detect(sets);
            }
            return Err(error);
        }
        self.keep_awake(sets, flex_bodies);
        hand_back(&mut self.landings, sets);
        self.links.lend(step, &self.claims, sets);
        clock.lap(&mut self.report.times.hand_back);
        let gate = self.hook_gate(hooks, true);
        sets.step_through(&gate, &self.events.gate(user, Some(&self.claims)));
        self.report.note_quarantine(sets);
        clock.lap(&mut self.report.times.rapier);
        self.wake_moving(sets, flex_bodies);
        land(&self.landings, self.leads(step), sets, &mut self.masters);
        self.links.take_back(sets);
        write_impulses(&self.joint_impulses, sets);
        self.commit_attachments(flex_bodies);
        self.commit(sets, flex_bodies);
        self.note_overbent(flex_bodies);
        self.note_trespassers(sets, flex_bodies);
        self.events.tell(sets);
        clock.lap(&mut self.report.times.hand_back);
        Ok(())
    }

    /// Rapier's step without length: what it stops is not told before the full step confirms it.
    pub(super) fn detect(&self, sets: &mut RapierSets<'_>) {
        let gate = self.hook_gate(sets.hooks, false);
        sets.detect_through(&gate, &self.events.gate(sets.events, None));
    }

    pub(super) fn hook_gate<'a>(
        &'a self,
        user: &'a dyn PhysicsHooks,
        is_full: bool,
    ) -> HookGate<'a> {
        HookGate {
            user,
            book: &self.gatherer.hooks,
            claims: &self.claims,
            links: &self.links,
            is_full,
        }
    }

    /// Makes the solved motions the committed ones and writes the surfaces.
    fn commit(&mut self, sets: &mut RapierSets<'_>, flex_bodies: &mut FlexBodySet) {
        if !self.claims.flex.asleep().is_empty() {
            self.keep_sleepers(sets);
        }
        self.memory.turn_over();
        self.gatherer.turn_over(true);
        for &(index, reserve) in &self.reserves {
            let Some(body) = flex_bodies.at_index_mut(index) else {
                continue;
            };
            body.set_energy_reserve(reserve);
            if let Some(block) = self.gatherer.block(index) {
                block.commit(body.state_mut());
                block.write_contact_force(body.contact_force_mut());
                let under_way = &self.gatherer.under_way;
                under_way.average(index, body.contact_force_mut());
                block.write_reactions(body.reaction_mut());
            }
            let is_still = rests(body, sets);
            write_surface(
                body,
                is_still,
                sets.colliders,
                sets.broad_phase,
                sets.integration_parameters,
            );
            stop_if_asleep(body, sets.bodies);
            body.greet();
        }
    }
}
