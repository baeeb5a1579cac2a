//! Scenes to look at.

use foil2d::fe::material::Rayleigh;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;

/// A world, and where to look at it from.
pub struct Scene {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    /// Middle of the view (m), and pixels to a metre.
    pub centre: [f32; 2],
    pub zoom: f32,
}

impl Scene {
    /// A floor, and nothing on it.
    fn new(centre: [f32; 2], zoom: f32) -> Self {
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(12.0, 0.5).translation(Vector::new(0.0, -0.5));
        world.insert_collider(floor, None);
        Self {
            world,
            flex_bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
            centre,
            zoom,
        }
    }

    fn box_at(&mut self, x: f32, y: f32, half: f32, density: f32) -> RigidBodyHandle {
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, y));
        let body = self.world.insert_body(body);
        let collider = ColliderBuilder::cuboid(half, half).density(density);
        self.world.insert_collider(collider, Some(body));
        body
    }
}

/// Builds a scene.
type Build = fn() -> Result<Scene, Box<dyn Error>>;

/// All scenes by name.
pub const SCENES: [(&str, Build); 3] = [
    ("Springboard", springboard),
    ("Jelly", jelly),
    ("Hanging bridge", hanging_bridge),
];

/// A board that is clamped at its left end, and boxes that fall on it.
fn springboard() -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new([0.0, 2.0], 110.0);
    let board = FlexBodyBuilder::rectangle([4.0, 0.12], [40, 2])
        .material(
            LinearElastic::plane_stress(1e9, 0.3)
                .density(600.0)
                .rayleigh(2e-3),
        )
        .translation([-3.0, 1.5])
        .friction(0.6)
        .pin_where(|[x, _]| x < 1e-9, Pin::both());
    scene.flex_bodies.insert(board, &mut scene.world)?;
    for (k, y) in [3.0, 4.0, 5.0].into_iter().enumerate() {
        scene.box_at(0.2 + 0.2 * k as f32, y, 0.2, 300.0);
    }
    Ok(scene)
}

/// Soft blocks, rings and balls in a heap.
fn jelly() -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new([0.0, 2.0], 110.0);
    let soft = StableNeoHookean::plane_strain(2e5, 0.4);
    let damping = Rayleigh {
        stiffness: 5e-3,
        mass: 0.0,
    };
    let soft = HyperelasticSolid::new(soft)
        .with_density(800.0)
        .with_damping(damping);
    for (k, [x, y]) in [[-1.6, 0.6], [0.0, 0.6], [1.6, 0.6], [-0.8, 2.2], [0.8, 2.2]]
        .into_iter()
        .enumerate()
    {
        let mesh = match k % 3 {
            0 => generate::disc(0.6, 0.16, CellKind::Tri6)?,
            1 => generate::annulus(0.35, 0.6, 0.13, CellKind::Tri6)?,
            _ => generate::rectangle([1.0, 1.0], [6, 6], CellKind::Quad4)?,
        };
        let body = FlexBodyBuilder::mesh(mesh)
            .material(soft.clone())
            .translation([x, y])
            .friction(0.5);
        scene.flex_bodies.insert(body, &mut scene.world)?;
    }
    scene.box_at(0.0, 4.0, 0.3, 500.0);
    Ok(scene)
}

/// A soft deck between two piers, hung from pins, and balls that roll on it.
fn hanging_bridge() -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new([0.0, 2.0], 110.0);
    let deck = FlexBodyBuilder::rectangle([6.4, 0.1], [64, 1])
        .material(
            LinearElastic::plane_stress(2e7, 0.3)
                .density(300.0)
                .rayleigh(5e-3),
        )
        .translation([-3.2, 2.0])
        .friction(0.8);
    let deck = scene.flex_bodies.insert(deck, &mut scene.world)?;
    for (side, x) in [(-1.0_f32, 0.0), (1.0, 6.4)] {
        let pier = ColliderBuilder::cuboid(0.4, 0.95).translation(Vector::new(3.7 * side, 0.95));
        scene.world.insert_collider(pier, None);
        let pin = AttachmentBuilder::pin(deck)
            .where_(move |[at, _]| (at - x).abs() < 1e-9)
            .to_world();
        scene.flex_bodies.attach(pin, &scene.world.bodies)?;
    }
    for k in 0..5 {
        let ball = RigidBodyBuilder::dynamic().translation(Vector::new(-2.0 + k as f32, 3.0));
        let ball = scene.world.insert_body(ball);
        let collider = ColliderBuilder::ball(0.22).density(500.0).friction(0.8);
        scene.world.insert_collider(collider, Some(ball));
    }
    Ok(scene)
}
