//! A world with flexible bodies, and what the physics tests measure in it.

#![allow(
    dead_code,
    unused_imports,
    reason = "every test binary uses its own part of this module"
)]

mod figures;
mod ground;
mod motion;
mod onlooker;
mod parts;
mod recorder;

pub use figures::*;
use foil2d::pipeline::{Participant, Quality, StepError};
pub use foil2d::prelude::*;
use foil2d::rapier::math::Real;
pub use foil2d::rapier::prelude::*;
pub use ground::*;
pub use motion::*;
pub use onlooker::*;
pub use parts::*;
pub use recorder::*;

/// Gravity of all scenes that have one (m/s²): near 9.81, and exact in both of rapier's precisions.
pub const G: f64 = 9.8125;

/// Rapier's vector of two numbers.
pub fn vec2(x: f64, y: f64) -> Vector {
    Vector::new(x as Real, y as Real)
}

/// A number in rapier's precision.
pub fn real(value: f64) -> Real {
    value as Real
}

/// Whether every island of a step was solved: none was cut short, linearised or left where it was.
pub fn is_solved(report: &StepReport) -> bool {
    report.quality() == Quality::Solved
}

/// A tolerance that differs where rapier's own poses limit the result.
pub fn by_precision(single: f64, double: f64) -> f64 {
    if cfg!(feature = "f64") {
        double
    } else {
        single
    }
}

/// An empty world with gravity `[0, -G]`, stepped by `dt` (s).
pub fn empty_world(dt: f64) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = real(dt);
    world.gravity = vec2(0.0, -G);
    world
}

/// A cuboid whose upper face is `y = 0`, with this friction (-).
pub fn floor(friction: f64) -> ColliderBuilder {
    ColliderBuilder::cuboid(50.0, 0.5)
        .translation(vec2(0.0, -0.5))
        .friction(real(friction))
}

/// A world, its flexible bodies and their pipeline.
pub struct Scene {
    pub world: PhysicsWorld,
    pub bodies: FlexBodySet,
    pub flex: FlexPipeline,
}

impl Scene {
    /// An empty world with gravity `[0, -G]`, stepped by `dt` (s).
    pub fn new(dt: f64) -> Self {
        Self {
            world: empty_world(dt),
            bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
        }
    }

    /// Without gravity.
    pub fn in_free_space(dt: f64) -> Self {
        let mut scene = Self::new(dt);
        scene.world.gravity = vec2(0.0, 0.0);
        scene
    }

    pub fn with_gravity(mut self, x: f64, y: f64) -> Self {
        self.world.gravity = vec2(x, y);
        self
    }

    pub fn with_integrator(mut self, integrator: Beta2) -> Self {
        self.flex = self.flex.with_integrator(integrator);
        self
    }

    /// A fixed cuboid whose upper face is `y = 0`, with this friction (-).
    pub fn ground(&mut self, friction: f64) -> ColliderHandle {
        self.fixed(floor(friction))
    }

    pub fn fixed(&mut self, collider: ColliderBuilder) -> ColliderHandle {
        self.world.insert_collider(collider, None)
    }

    /// A dynamic rigid body of one collider, never asleep.
    pub fn rigid(
        &mut self,
        body: RigidBodyBuilder,
        collider: ColliderBuilder,
    ) -> (RigidBodyHandle, ColliderHandle) {
        self.world.insert(body.can_sleep(false), collider)
    }

    pub fn flexible(&mut self, builder: FlexBodyBuilder) -> FlexBodyHandle {
        self.bodies
            .insert(builder, &mut self.world)
            .expect("the description is right")
    }

    pub fn try_step(&mut self) -> Result<&StepReport, StepError> {
        self.flex.step(&mut self.world, &mut self.bodies)
    }

    pub fn step(&mut self) -> &StepReport {
        let report = self
            .flex
            .step(&mut self.world, &mut self.bodies)
            .expect("the step can be taken");
        // The last ways out are for bodies jammed into each other: an ordinary scene that needs them is wrong.
        assert!(is_solved(report), "a step was not solved");
        self.flex.report()
    }

    pub fn steps(&mut self, n: usize) {
        for _ in 0..n {
            self.step();
        }
    }

    pub fn dt(&self) -> f64 {
        f64::from(self.world.integration_parameters.dt)
    }

    pub fn report(&self) -> &StepReport {
        self.flex.report()
    }

    pub fn body(&self, handle: FlexBodyHandle) -> &FlexBody {
        &self.bodies[handle]
    }

    /// Contact force on a collider in the last step (N).
    pub fn force_on_collider(&self, collider: ColliderHandle) -> [f64; 2] {
        self.report().force_on(Participant::Rigid(collider))
    }

    /// Contact force on a flexible body in the last step (N).
    pub fn force_on_flexible(&self, body: FlexBodyHandle) -> [f64; 2] {
        self.report().force_on(Participant::Flex(body))
    }

    /// Mass of a rigid body (kg).
    pub fn mass(&self, body: RigidBodyHandle) -> f64 {
        f64::from(self.world.bodies[body].mass())
    }
}

/// Slope of `ln(error)` over `ln(step)` by least squares.
pub fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let n = steps.len() as f64;
    let points = || {
        steps
            .iter()
            .zip(errors)
            .map(|(step, error)| (step.ln(), error.ln()))
    };
    let (sx, sy) = points().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (over, under) = points().fold((0.0, 0.0), |(a, b), (x, y)| {
        (a + (x - sx) * (y - sy), b + (x - sx) * (x - sx))
    });
    over / under
}

/// Numbers in [0, 1) that look random and are the same on every machine (SplitMix64).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.roll() * choices.len() as f64) as usize]
    }
}

/// Gathers every case of a sweep that is wrong, so that one run tells them all.
#[derive(Default)]
pub struct Findings(Vec<String>);

impl Findings {
    /// Notes what is wrong unless `holds`.
    pub fn check(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.0.push(what());
        }
    }

    /// Fails with the list.
    pub fn report(self) {
        assert!(
            self.0.is_empty(),
            "{} wrong:\n{}",
            self.0.len(),
            self.0.join("\n")
        );
    }
}
