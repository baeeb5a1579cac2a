//! A rapier world with its flexible bodies, as the cases use it.

use foil2d::body::BuildError;
use foil2d::pipeline::{Participant, StepError};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// Acceleration of free fall (m/s²).
pub const G: f64 = 9.81;

/// A vector in rapier's precision.
pub fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x as Real, y as Real)
}

pub struct Scene {
    pub world: PhysicsWorld,
    pub bodies: FlexBodySet,
    pub flex: FlexPipeline,
}

impl Scene {
    /// An empty world without gravity, stepped by `dt` (s).
    pub fn new(dt: f64, integrator: Beta2) -> Self {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = dt as Real;
        world.gravity = Vector::ZERO;
        Self {
            world,
            bodies: FlexBodySet::new(),
            flex: FlexPipeline::new().with_integrator(integrator),
        }
    }

    pub fn with_gravity(mut self, x: f64, y: f64) -> Self {
        self.world.gravity = vector(x, y);
        self
    }

    pub fn with_impact(mut self, impact: ImpactTreatment) -> Self {
        self.flex = self.flex.with_impact(impact);
        self
    }

    pub fn with_contact(mut self, contact: ContactMethod) -> Self {
        self.flex = self.flex.with_contact_method(contact);
        self
    }

    /// A fixed cuboid whose upper face is `y = 0`, with this friction (-).
    pub fn ground(&mut self, friction: f64) -> ColliderHandle {
        let ground = ColliderBuilder::cuboid(50.0, 0.5)
            .translation(vector(0.0, -0.5))
            .friction(friction as Real);
        self.world.insert_collider(ground, None)
    }

    pub fn add(&mut self, builder: FlexBodyBuilder) -> Result<FlexBodyHandle, BuildError> {
        self.bodies.insert(builder, &mut self.world)
    }

    pub fn step(&mut self) -> Result<&StepReport, StepError> {
        self.flex.step(&mut self.world, &mut self.bodies)
    }

    pub fn steps(&mut self, n: usize) -> Result<(), StepError> {
        for _ in 0..n {
            self.step()?;
        }
        Ok(())
    }

    /// The step that is taken (s), in rapier's precision.
    pub fn dt(&self) -> f64 {
        f64::from(self.world.integration_parameters.dt)
    }

    pub fn body(&self, handle: FlexBodyHandle) -> &FlexBody {
        &self.bodies[handle]
    }

    /// Contact force on a flexible body in the last step (N).
    pub fn force_on(&self, body: FlexBodyHandle) -> [f64; 2] {
        self.flex.report().force_on(Participant::Flex(body))
    }

    /// Contact force on a collider in the last step (N).
    pub fn force_on_collider(&self, collider: ColliderHandle) -> [f64; 2] {
        self.flex.report().force_on(Participant::Rigid(collider))
    }
}

/// Node of a body nearest to a place of its mesh (m).
pub fn node_at(body: &FlexBody, [x, y]: [f64; 2]) -> usize {
    let nodes = body.mesh().nodes();
    let distance = |node: &usize| (nodes[*node][0] - x).hypot(nodes[*node][1] - y);
    (0..nodes.len())
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}
