//! How the time of a step grows with the number of bodies: blocks that touch none of their like, boxes on a flexible slab, and a
//! soft block on a pile of rigid boxes beside that pile alone.
//!
//! ```text
//! cargo bench --bench growth
//! ```
//!
//! Scenes of one kind take their steps in turns, so that what disturbs the machine disturbs them alike. Told are the least times
//! of a step at rest, and their ratios.

use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::time::Instant;

/// Half a side of a box (m).
const HALF: f64 = 0.15;

struct Scene {
    name: String,
    world: PhysicsWorld,
    bodies: FlexBodySet,
    flex: FlexPipeline,
    times: Vec<f64>,
}

impl Scene {
    fn new(name: String) -> Self {
        Self {
            name,
            world: PhysicsWorld::new(),
            bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
            times: Vec::new(),
        }
    }

    fn ground(&mut self) {
        let floor = ColliderBuilder::cuboid(500.0, 0.5).translation(Vector::new(0.0, -0.5));
        self.world.insert_collider(floor.friction(0.5), None);
    }

    fn boxes(&mut self, n: usize, n_columns: usize, pitch: f64, left: f64) {
        for k in 0..n {
            let (column, row) = ((k % n_columns) as f64, (k / n_columns) as f64);
            let at = [left + pitch * column, 0.151 + 0.301 * row];
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::from(at.map(|x| x as Real)))
                .can_sleep(false);
            let shape = ColliderBuilder::cuboid(HALF as Real, HALF as Real);
            self.world.insert(body, shape.density(500.0).friction(0.5));
        }
    }

    fn step(&mut self) -> Result<(), Box<dyn Error>> {
        let begin = Instant::now();
        if self.bodies.is_empty() {
            self.world.step();
        } else {
            self.flex.step(&mut self.world, &mut self.bodies)?;
        }
        self.times.push(begin.elapsed().as_secs_f64());
        Ok(())
    }

    /// Least time of a step of the second half (s).
    fn rest(&self) -> f64 {
        let half = &self.times[self.times.len() / 2..];
        half.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

fn elastic(young: f64, density: f64) -> LinearElastic {
    LinearElastic::plane_stress(young, 0.3)
        .density(density)
        .rayleigh(2e-3)
}

/// So many separate soft blocks on a floor.
fn separate(n: usize) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new(format!("{n} separate soft blocks"));
    scene.ground();
    for i in 0..n {
        let block = FlexBodyBuilder::rectangle([0.4, 0.4], [3, 3])
            .small_strain()
            .material(elastic(1e6, 500.0))
            .can_sleep(false)
            .translation([i as f64 - 0.5 * n as f64, 0.0]);
        scene.bodies.insert(block, &mut scene.world)?;
    }
    Ok(scene)
}

/// So many boxes in twenty columns on a slab held at both ends.
fn slab(n: usize) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new(format!("{n} boxes on a flexible slab"));
    let slab = FlexBodyBuilder::rectangle([8.0, 0.4], [64, 4])
        .small_strain()
        .material(elastic(1e8, 1000.0))
        .translation([-4.0, -0.4])
        .pin_where(|[x, _]| (x - 4.0).abs() > 4.0 - 1e-9, Pin::both())
        .friction(0.5);
    scene.bodies.insert(slab, &mut scene.world)?;
    scene.boxes(n, 20, 0.36, -3.6);
    Ok(scene)
}

/// Sixty boxes in six rows on fixed ground, and a soft block that falls on them if it `has_block`.
fn pile(has_block: bool) -> Result<Scene, Box<dyn Error>> {
    let name = if has_block {
        "a soft block on a pile of 60 boxes"
    } else {
        "the pile alone, stepped by rapier"
    };
    let mut scene = Scene::new(name.to_owned());
    scene.ground();
    scene.boxes(60, 10, 0.31, -1.5);
    if has_block {
        let block = FlexBodyBuilder::rectangle([0.3, 0.3], [4, 4])
            .small_strain()
            .material(elastic(1e6, 500.0))
            .can_sleep(false)
            .translation([0.0, 0.302 * 6.0 + 0.3]);
        scene.bodies.insert(block, &mut scene.world)?;
    }
    Ok(scene)
}

fn run(mut scenes: Vec<Scene>, n_steps: usize) -> Result<(), Box<dyn Error>> {
    for _ in 0..n_steps {
        for scene in &mut scenes {
            scene.step()?;
        }
    }
    let first = scenes.first().map_or(f64::NAN, Scene::rest);
    for scene in &scenes {
        println!(
            "{}: {:.3} ms a step at rest, {:.1} times the first",
            scene.name,
            1e3 * scene.rest(),
            scene.rest() / first
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    let n_steps = |n| if is_measured { n } else { 2 };
    run(
        vec![separate(40)?, separate(160)?, separate(640)?],
        n_steps(120),
    )?;
    run(vec![slab(20)?, slab(40)?, slab(80)?], n_steps(120))?;
    run(vec![pile(false)?, pile(true)?], n_steps(200))
}
