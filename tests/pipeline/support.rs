//! Scenes and materials that the tests share.

pub use crate::common::{Recorder, elastic, motion_bits, vec2};
pub use foil2d::body::BuildError;
pub use foil2d::pipeline::StepError;
pub use foil2d::prelude::*;
pub use foil2d::rapier::math::Real;
pub use foil2d::rapier::prelude::*;
use std::error::Error;

pub type Outcome = Result<(), Box<dyn Error>>;

pub const GRAVITY: f64 = 9.81;

/// Relative rounding of rapier's numbers.
pub const REAL_EPSILON: f64 = Real::EPSILON as f64;

pub fn rubber() -> LinearElastic {
    elastic(1e6, 1000.0, 2e-2)
}

/// A square of 1 m and 1000 kg.
pub fn square() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber())
}

/// A beam of 4 m from `x = -2 m`, held at both lower corners, its top at `y = 1.3 m`.
pub fn beam() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([4.0, 0.3], [24, 2])
        .material(elastic(1e9, 1000.0, 1e-2))
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
        .translation([-2.0, 1.0])
}

#[derive(Default)]
pub struct Scene {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
}

impl Scene {
    pub fn with_floor() -> Self {
        let mut scene = Self::default();
        let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(vec2(0.0, -0.5));
        scene.world.insert_collider(floor, None);
        scene
    }

    pub fn without_gravity() -> Self {
        let mut scene = Self::default();
        scene.world.gravity = Vector::ZERO;
        scene
    }

    pub fn insert(&mut self, builder: FlexBodyBuilder) -> Result<FlexBodyHandle, BuildError> {
        self.flex_bodies.insert(builder, &mut self.world)
    }

    pub fn insert_box(&mut self, half: f64, at: [f64; 2], density: f64) -> RigidBodyHandle {
        let body = RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1]));
        let shape = ColliderBuilder::cuboid(half as Real, half as Real).density(density as Real);
        self.world.insert(body, shape).0
    }

    pub fn step(&mut self) -> Result<&StepReport, StepError> {
        self.flex.step(&mut self.world, &mut self.flex_bodies)
    }

    pub fn steps(&mut self, n: usize) -> Result<(), StepError> {
        for _ in 0..n {
            self.step()?;
        }
        Ok(())
    }

    pub fn dt(&self) -> f64 {
        f64::from(self.world.integration_parameters.dt)
    }

    pub fn set_dt(&mut self, dt: f64) {
        self.world.integration_parameters.dt = dt as Real;
    }

    pub fn height(&self, handle: RigidBodyHandle) -> f64 {
        f64::from(self.world.bodies[handle].translation().y)
    }

    /// All bits of the motion of all bodies.
    pub fn bits(&self) -> Vec<u64> {
        motion_bits(&self.world, &self.flex_bodies)
    }

    /// What a ray straight down from `y = 20 m` hits, and at which height.
    pub fn look_down(&self, x: f64) -> Option<(ColliderHandle, f64)> {
        let ray = Ray::new(vec2(x, 20.0), vec2(0.0, -1.0));
        let hit = self
            .world
            .cast_ray(&ray, 100.0, true, QueryFilter::default())?;
        Some((hit.0, 20.0 - f64::from(hit.1)))
    }
}

/// Whether numbers are others, but for a tolerance.
pub fn is_near(found: &[f64], expected: &[f64], tolerance: f64) -> bool {
    let mut pairs = found.iter().zip(expected);
    found.len() == expected.len() && pairs.all(|(a, b)| (a - b).abs() <= tolerance)
}
