//! The pipeline: settings and buffers, no state of its own but the memory of contacts and claimed bodies.

use super::error::StepError;
use super::islands::Solver;
use super::outcome::Outcome;
use super::report::StepReport;
use super::settings::FlexParameters;
use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::coupling::{Claims, EventBook, Lent, Memory, PutTogether, RapierSets, Trespassers};
use crate::integrator::Beta2;
use crate::kkt::{ContactMethod, ImpactTreatment};
use crate::linalg::complementarity::Method;
use crate::rapier::prelude::*;

/// Steps a rapier world together with its flexible bodies.
///
/// Holds [parameters](FlexParameters) and what the last step knows of its contacts. Keep one pipeline for one world for as long as that lives: a new one in every
/// step does not know the forces that bodies of small strain lie on, and holds them up by wrong ones.
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
    pub(super) solver: Solver,
    pub(super) memory: Memory,
    pub(super) events: EventBook,
    pub(super) outcome: Outcome,
    pub(super) report: StepReport,
    pub(super) lent: Lent,
    pub(super) trespassers: Trespassers,
    pub(super) put_together: PutTogether,
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
            solver: Solver::default(),
            memory: Memory::default(),
            events: EventBook::default(),
            outcome: Outcome::default(),
            report: StepReport::default(),
            lent: Lent::default(),
            trespassers: Trespassers::default(),
            put_together: PutTogether::default(),
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
    /// `modify_solver_contacts` is shown every such contact as a manifold: its point, and after it that of the flexible body which is farthest
    /// behind the same face, if another one is. Of a collider of several parts each point shows the nearest. It may change friction, restitution, and normal and distance of the first, give it a tangent velocity,
    /// or clear it. `user_data` lasts as long as the contact, and begins with that of a neighbour. Pairs of two rigid bodies it sees in rapier's manifolds
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

    /// Chooses the member of the Beta-2 family.
    ///
    /// An explicit one (`β0 = 0`, [`Beta2::central_difference`]) needs a lumped mass; contact forces then are multipliers at
    /// the forward increment, and the [treatment of impacts](Self::with_impact) does not matter. Steps longer than the
    /// critical one of a body are refused, see [`Self::insisting`].
    pub fn with_integrator(mut self, integrator: Beta2) -> Self {
        self.parameters.integrator = integrator;
        self
    }

    /// Chooses what is done on impact.
    pub fn with_impact(mut self, impact: ImpactTreatment) -> Self {
        self.parameters.impact = impact;
        self
    }

    /// Chooses how the laws of contact are enforced: by Lagrange multipliers, or for comparison by the constraint functions of
    /// ADINA. Steps in which the latter fail are counted, see [`StepReport::n_failed`](super::StepReport::n_failed).
    pub fn with_contact_method(mut self, method: ContactMethod) -> Self {
        self.parameters.contact_method = method;
        self
    }

    /// Chooses the solver of the contact problems: the active set, a direct method, by default;
    /// [`Method::GaussSeidel`] for the modified Gauss–Seidel method of Carpenter, Taylor and Katona.
    pub fn with_contact_solver(mut self, method: Method) -> Self {
        self.parameters.contact_solver = method;
        self
    }

    /// Takes steps longer than the critical one of a conditionally stable integrator instead of refusing them.
    ///
    /// The critical step of a body is that of a safe bound, so a step a little longer may be stable; one much longer makes the highest
    /// frequencies grow until numbers are no longer finite. The same goes for rigid bodies that are light on the surface of an
    /// explicit body.
    pub fn insisting(mut self) -> Self {
        self.parameters.insists = true;
        self
    }

    /// Refuses steps that are not [solved](super::Quality::Solved), with [`StepError::Unsolved`](super::StepError::Unsolved), instead of
    /// taking them and telling of it in the report.
    pub fn refusing_unsolved(mut self) -> Self {
        self.parameters.refuses_unsolved = true;
        self
    }

    /// Approach velocity (m/s, times the world's `length_unit`) below which restitution is ignored, so that resting contacts do not bounce.
    pub fn with_restitution_threshold(mut self, threshold: f64) -> Self {
        self.parameters.restitution_threshold = threshold;
        self
    }

    /// The integrator.
    pub fn integrator(&self) -> Beta2 {
        self.parameters.integrator
    }
}
