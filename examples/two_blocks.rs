//! Two flexible bodies in contact with each other: friction between stacked blocks, and bars that swap velocities.
//!
//! ```text
//!      +---------+                                v0 -->            <-- v0
//!      |  7 x 5  | --> pull                  +-------------+    +-------------+
//!   +--+---------+--+                        |   20 x 1    |    |   20 x 1    |
//!   |    10 x 5     |   E = 10 MPa, mu = 0.4  +-------------+    +-------------+
//!  =+===============+=                          steel, 254 mm, square section
//! ```
//!
//! The meshes of the blocks do not match. The upper one is first pulled with half of what friction holds, then with one
//! and a half times that: it stays, then slides with `(1.5 - 1) mu g`.
//!
//! The bars meet head-on in free space, at ±5.136 m/s (benchmark B3): the force rises at once to `rho c v0 A`, stays there
//! while the waves run up and down the bars, and the bars part with their velocities exchanged.

#[path = "support/cli.rs"]
pub mod cli;
#[path = "support/doctor.rs"]
mod doctor;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::pipeline::{Participant, StepError};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;

const GRAVITY: f64 = 9.81;
const FRICTION: f64 = 0.4;

/// The headline numbers.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outcome {
    pub stack: Stack,
    pub collision: Collision,
}

/// What the stacked blocks showed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Stack {
    /// Resultant of the contact pressure under the upper block over its weight (-).
    pub upper_force_over_weight: f64,
    /// Resultant under the lower block over the weight of both (-).
    pub lower_force_over_weight: f64,
    /// Pulled with `mu m g / 2`: friction force over the pull (-), and speed of the upper block (m/s).
    pub stick_force_over_pull: f64,
    pub stick_speed_m_per_s: f64,
    /// Pulled with `3 mu m g / 2`: friction force over `mu m g`, and acceleration over `mu g / 2` (-).
    pub slip_force_over_limit: f64,
    pub slip_acceleration_ratio: f64,
    /// Deepest overlap in any step (m).
    pub max_penetration_m: f64,
}

/// What the colliding bars showed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Collision {
    /// Velocities of the left and the right bar afterwards, over `v0`; exactly -1 and 1 (-).
    pub velocity_ratios: [f64; 2],
    /// First and last contact (s); exactly 49.46 and 148.39 µs.
    pub touch_s: f64,
    pub part_s: f64,
    /// Mean force over the middle half of the contact (N); exactly 133.45 kN.
    pub plateau_n: f64,
    /// Largest momentum in any step over that of one bar (-).
    pub momentum_error: f64,
    /// Largest `|E / E0 - 1|` in any step (-).
    pub energy_error: f64,
    /// Deepest overlap in any step (m).
    pub max_penetration_m: f64,
}

/// Stacks the blocks, pulls the upper one, and lets the bars collide.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    Ok(Outcome {
        stack: stack(options)?,
        collision: collision(options)?,
    })
}

/// A world with its flexible bodies, of which two matter.
struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    pipeline: FlexPipeline,
    bodies: [FlexBodyHandle; 2],
    max_penetration: f64,
}

impl Scene {
    fn new(
        gravity: f64,
        dt: f64,
        integrator: Beta2,
        builders: [FlexBodyBuilder; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -gravity as Real);
        world.integration_parameters.dt = dt as Real;
        let mut flex_bodies = FlexBodySet::new();
        let [first, second] = builders;
        let bodies = [
            flex_bodies.insert(first, &mut world)?,
            flex_bodies.insert(second, &mut world)?,
        ];
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new().with_integrator(integrator),
            bodies,
            max_penetration: 0.0,
        })
    }

    fn step(&mut self) -> Result<(), StepError> {
        let report = self.pipeline.step(&mut self.world, &mut self.flex_bodies)?;
        self.max_penetration = self.max_penetration.max(report.gap_violation());
        Ok(())
    }

    fn body(&self, which: usize) -> &FlexBody {
        &self.flex_bodies[self.bodies[which]]
    }

    /// Contact force on a body in the last step (N).
    fn force_on(&self, which: usize) -> [f64; 2] {
        let report = self.pipeline.report();
        report.force_on(Participant::Flex(self.bodies[which]))
    }
}

const LOWER: usize = 0;
const UPPER: usize = 1;

fn stack(options: &Options) -> Result<Stack, Box<dyn Error>> {
    let dt = 1.0 / 240.0;
    let material = LinearElastic::plane_stress(1e7, 0.3)
        .density(1000.0)
        .rayleigh(5e-3);
    let lower = FlexBodyBuilder::rectangle([1.0, 0.5], [10, 5]).translation([-0.5, 0.0]);
    let upper = FlexBodyBuilder::rectangle([0.6, 0.4], [7, 5]).translation([-0.33, 0.5]);
    let blocks = [lower, upper].map(|block| block.material(material).friction(FRICTION));
    let mut scene = Scene::new(GRAVITY, dt, Beta2::damped(0.9)?, blocks)?;
    let floor = ColliderBuilder::cuboid(5.0, 0.5)
        .translation(Vector::new(0.0, -0.5))
        .friction(FRICTION as Real);
    scene.world.insert_collider(floor, None);

    doctor::require_sound(&scene.world, &scene.flex_bodies, &scene.pipeline)?;
    for _ in 0..options.n_steps(720) {
        scene.step()?;
    }
    let [lower_weight, upper_weight] = [LOWER, UPPER].map(|i| GRAVITY * scene.body(i).mass());
    let on_upper = scene.force_on(UPPER)[1];
    let on_lower = scene.force_on(LOWER)[1];

    // Friction holds at most mu g per mass of the upper block.
    let limit = FRICTION * GRAVITY;
    let pull = |scene: &mut Scene, acceleration: f64| {
        scene.flex_bodies[scene.bodies[UPPER]].set_body_force([acceleration, 0.0])
    };
    pull(&mut scene, 0.5 * limit)?;
    for _ in 0..options.n_steps(480) {
        scene.step()?;
    }
    let stick_force = -scene.force_on(UPPER)[0];
    let stick_speed_m_per_s = scene.body(UPPER).linvel()[0].abs();

    pull(&mut scene, 1.5 * limit)?;
    for _ in 0..options.n_steps(24) {
        scene.step()?;
    }
    let speed = scene.body(UPPER).linvel()[0];
    let n_measured = options.n_steps(48);
    let mut slip_force = 0.0;
    for _ in 0..n_measured {
        scene.step()?;
        slip_force -= scene.force_on(UPPER)[0] / n_measured as f64;
    }
    let gained = scene.body(UPPER).linvel()[0] - speed;
    Ok(Stack {
        upper_force_over_weight: on_upper / upper_weight,
        // The sum on the lower block is what the floor gives less what the upper block takes.
        lower_force_over_weight: (on_lower + on_upper) / (lower_weight + upper_weight),
        stick_force_over_pull: stick_force / (0.5 * FRICTION * upper_weight),
        stick_speed_m_per_s,
        slip_force_over_limit: slip_force / (FRICTION * upper_weight),
        slip_acceleration_ratio: gained / (n_measured as f64 * dt) / (0.5 * limit),
        max_penetration_m: scene.max_penetration,
    })
}

const BAR_LENGTH: f64 = 0.254;
const BAR_SIDE: f64 = 0.0254;
const BAR_SPEED: f64 = 5.13588;
const BAR_GAP: f64 = 0.508e-3;

/// A bar with its left end at `x`; `height` times thickness is the section of every bar.
fn bar(x: f64, height: f64, velocity: f64, contact_nodes: [usize; 2]) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([BAR_LENGTH, height], [20, 1])
        .material(LinearElastic::plane_stress(206.8e9, 0.0).density(7844.07))
        .thickness(BAR_SIDE * BAR_SIDE / height)
        // One cell thick: all nodes are on the boundary, and only those that meet may give up their inertia.
        .contact_inertia(ContactInertia::RedistributedAt(contact_nodes.to_vec()))
        .translation([x, -0.5 * height])
        .linvel([velocity, 0.0])
}

fn collision(options: &Options) -> Result<Collision, Box<dyn Error>> {
    let dt = 1e-6;
    // The right bar is 1 % taller and as much thinner, so that the left one's corners meet its face inside the corners.
    let x = 0.5 * BAR_GAP;
    let left = bar(-BAR_LENGTH - x, BAR_SIDE, BAR_SPEED, [20, 41]);
    let right = bar(x, 1.01 * BAR_SIDE, -BAR_SPEED, [0, 21]);
    let mut scene = Scene::new(0.0, dt, Beta2::trapezoidal(), [left, right])?;
    let total = |scene: &Scene| {
        let energies = [0, 1].map(|i| scene.body(i).energy());
        energies.iter().map(|e| e.kinetic + e.elastic).sum::<f64>()
    };
    let at_start = total(&scene);
    let one_bar = scene.body(0).mass() * BAR_SPEED;
    let mut forces = Vec::new();
    let (mut momentum_error, mut energy_error) = (0.0f64, 0.0f64);
    for _ in 0..options.n_steps(200) {
        scene.step()?;
        forces.push(scene.force_on(1)[0]);
        let [left, right] = [0, 1].map(|i| scene.body(i).momentum()[0]);
        momentum_error = momentum_error.max(((left + right) / one_bar).abs());
        energy_error = energy_error.max((total(&scene) / at_start - 1.0).abs());
    }
    let touch = forces.iter().position(|&force| force > 0.0).unwrap_or(0);
    let part = forces.iter().rposition(|&force| force > 0.0).unwrap_or(0);
    let quarter = (part - touch) / 4;
    let plateau = forces.get(touch + quarter..=part - quarter).unwrap_or(&[]);
    Ok(Collision {
        velocity_ratios: [0, 1].map(|i| scene.body(i).linvel()[0] / BAR_SPEED),
        touch_s: touch as f64 * dt,
        part_s: (part + 1) as f64 * dt,
        plateau_n: plateau.iter().sum::<f64>() / plateau.len() as f64,
        momentum_error,
        energy_error,
        max_penetration_m: scene.max_penetration,
    })
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    options.refuse_replay()?;
    let outcome = run(&options)?;
    let Outcome { stack, collision } = &outcome;
    println!("two blocks, non-matching meshes");
    println!(
        "  pressure resultant / weight: {:.6} between them, {:.6} on the floor",
        stack.upper_force_over_weight, stack.lower_force_over_weight
    );
    println!(
        "  pulled with half of mu m g: friction / pull {:.6}, speed {:.1e} m/s",
        stack.stick_force_over_pull, stack.stick_speed_m_per_s
    );
    println!(
        "  pulled with 1.5 mu m g: friction / mu m g {:.6}, acceleration / exact {:.6}",
        stack.slip_force_over_limit, stack.slip_acceleration_ratio
    );
    println!("  deepest overlap {:.0e} m", stack.max_penetration_m);
    println!("two steel bars, head-on");
    println!(
        "  contact from {:.1} to {:.1} us (exact 49.5 to 148.4), {:.2} kN (133.45)",
        1e6 * collision.touch_s,
        1e6 * collision.part_s,
        1e-3 * collision.plateau_n
    );
    let [left, right] = collision.velocity_ratios;
    println!("  velocities afterwards / v0: {left:+.4} and {right:+.4}");
    println!(
        "  momentum / that of one bar {:.0e}, energy within {:.0e}, deepest overlap {:.0e} m",
        collision.momentum_error, collision.energy_error, collision.max_penetration_m
    );
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
