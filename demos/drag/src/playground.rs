//! The world that is played with.

use crate::mouse::Held;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;

/// A world of flexible and rigid bodies, and what the mouse holds of it.
pub struct Playground {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub held: Option<Held>,
}

impl Playground {
    /// A springboard, a soft block, a ring and boxes in a tray.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let mut playground = Self {
            world: PhysicsWorld::new(),
            flex_bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
            held: None,
        };
        for (half, at) in [
            ([6.0, 0.5], [0.0, -0.5]),
            ([0.5, 4.0], [-6.5, 3.0]),
            ([0.5, 4.0], [6.5, 3.0]),
        ] {
            let wall = ColliderBuilder::cuboid(half[0], half[1]);
            let wall = wall.translation(Vector::new(at[0], at[1])).friction(0.6);
            playground.world.insert_collider(wall, None);
        }
        let wood = LinearElastic::plane_stress(1e9, 0.3)
            .density(600.0)
            .rayleigh(2e-3);
        let jelly = LinearElastic::plane_strain(1e5, 0.4)
            .density(500.0)
            .rayleigh(1e-2);
        let rubber = LinearElastic::plane_strain(4e5, 0.4)
            .density(900.0)
            .rayleigh(5e-3);
        let board = FlexBodyBuilder::rectangle([3.5, 0.12], [35, 2])
            .material(wood)
            .translation([-6.0, 2.0])
            .pin_where(|[x, _]| x < 1e-9, Pin::both());
        let block = FlexBodyBuilder::rectangle([1.2, 1.2], [8, 8])
            .material(jelly)
            .translation([0.0, 0.1]);
        let ring = FlexBodyBuilder::annulus(0.45, 0.7, 0.12)
            .material(rubber)
            .translation([3.0, 0.8]);
        for body in [board, block, ring] {
            let body = body.friction(0.6);
            playground.flex_bodies.insert(body, &mut playground.world)?;
        }
        for [x, y] in [[-3.2, 3.0], [-3.0, 3.8], [0.6, 2.4], [4.6, 0.4], [4.7, 1.2]] {
            let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, y));
            let body = playground.world.insert_body(body);
            let collider = ColliderBuilder::cuboid(0.3, 0.3)
                .density(300.0)
                .friction(0.6);
            playground.world.insert_collider(collider, Some(body));
        }
        Ok(playground)
    }

    /// Length of a step (s).
    pub fn dt(&self) -> f64 {
        f64::from(self.world.integration_parameters.dt)
    }

    /// Takes one step.
    pub fn step(&mut self) -> Result<(), Box<dyn Error>> {
        self.flex.step(&mut self.world, &mut self.flex_bodies)?;
        Ok(())
    }

    /// What the last step was like, in a line.
    pub fn summary(&self) -> String {
        let report = self.flex.report();
        let energy = report.energy();
        let n_contacts = report.contacts().len();
        format!(
            "{n_contacts} contacts, {:.2} J in motion, {:.2} J stored",
            energy.kinetic, energy.elastic
        )
    }
}
