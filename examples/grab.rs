//! A mouse spring: a soft block is picked up by its nearest node, held, carried round and dropped.
//!
//! ```text
//!          cursor x
//!                  \  spring, 4000 N/m
//!            +------o
//!            |      |   0.5 x 0.5 m, 50 kg
//!            +------+
//!     ---------------------- floor
//! ```
//!
//! The spring is an attachment to the world whose target follows the cursor. While the block hangs still the spring pulls with its
//! weight, so the node hangs `m g / k` below the cursor.

#[path = "support/cli.rs"]
pub mod cli;
#[path = "support/doctor.rs"]
mod doctor;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;

const SIZE: f64 = 0.5;
const STIFFNESS: f64 = 4000.0;
const DAMPING: f64 = 400.0;
const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 60.0;
/// Steps of lifting, holding, carrying and falling.
const LIFT: usize = 120;
const HOLD: usize = 480;
const CARRY: usize = 120;
const FALL: usize = 240;

/// Headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// Force of the spring over the weight while the block hangs still (-).
    pub force_over_weight: f64,
    /// How far the node hangs below the cursor, over `m g / k` (-).
    pub stretch_ratio: f64,
    /// Force of the floor over the weight after the block has been dropped (-).
    pub floor_over_weight: f64,
    /// Height of the block's centre after that (m).
    pub rest_height_m: f64,
}

/// Picks the block up, holds it, carries it half round a circle and drops it.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = DT as Real;
    world.gravity = Vector::new(0.0, -GRAVITY as Real);
    let floor = ColliderBuilder::cuboid(10.0, 0.5).translation(Vector::new(0.0, -0.5));
    world.insert_collider(floor, None);
    let mut flex_bodies = FlexBodySet::new();
    let block = flex_bodies.insert(
        FlexBodyBuilder::rectangle([SIZE, SIZE], [6, 6])
            .material(
                LinearElastic::plane_stress(2e5, 0.3)
                    .density(200.0)
                    .rayleigh(2e-2),
            )
            .friction(0.5),
        &mut world,
    )?;
    let weight = GRAVITY * flex_bodies[block].mass();
    let mut flex = FlexPipeline::new();
    doctor::require_sound(&world, &flex_bodies, &flex)?;
    let cursor = [0.45, 0.52];
    let node = nearest_node(&flex_bodies[block], cursor);
    let spring = AttachmentBuilder::spring_damper(block, STIFFNESS, DAMPING)
        .node(node)
        .rest_length(0.0)
        .at_point(cursor)
        .to_world();
    let spring = flex_bodies.attach(spring, &world.bodies)?;
    let mut outcome = Outcome::default();
    let n_steps = options.n_steps(LIFT + HOLD + CARRY + FALL);
    let mut recorder = options.recorder("A block is grabbed, carried and dropped");
    for step in 0..n_steps {
        if step < LIFT + HOLD + CARRY {
            let offset = cursor_at(step + 1);
            flex_bodies
                .attachment_mut(spring)?
                .set_target(offset, 0.0)?;
        } else if step == LIFT + HOLD + CARRY {
            flex_bodies.detach(spring)?;
        }
        flex.step(&mut world, &mut flex_bodies)?;
        recorder.record((step + 1) as f64 * DT, &world, &flex_bodies, &flex)?;
        if step + 1 == LIFT + HOLD {
            let [x, y] = flex_bodies.attachment(spring)?.force();
            outcome.force_over_weight = x.hypot(y) / weight;
            let below = cursor[1] + cursor_at(step + 1)[1] - flex_bodies[block].position(node)[1];
            outcome.stretch_ratio = below * STIFFNESS / weight;
        }
    }
    recorder.write()?;
    let block = &flex_bodies[block];
    outcome.floor_over_weight = block.total_contact_force()[1] / weight;
    outcome.rest_height_m = block.centre_of_mass()[1];
    Ok(outcome)
}

/// Where the cursor has gone to: up by 1 m, still, and half round a circle of 0.5 m.
fn cursor_at(step: usize) -> [f64; 2] {
    let ramp = |from: usize, length: usize| {
        let t = (step.saturating_sub(from) as f64 / length as f64).min(1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let turn = std::f64::consts::PI * ramp(LIFT + HOLD, CARRY);
    [0.5 * (turn.cos() - 1.0), ramp(0, LIFT) + 0.5 * turn.sin()]
}

/// The node of the boundary nearest to a point.
fn nearest_node(body: &FlexBody, [x, y]: [f64; 2]) -> usize {
    let distance = |node: usize| {
        let [at_x, at_y] = body.position(node);
        (at_x - x).hypot(at_y - y)
    };
    let nodes = body.mesh().boundary().nodes();
    nodes.iter().copied().fold(nodes[0], |best, node| {
        if distance(node) < distance(best) {
            node
        } else {
            best
        }
    })
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let outcome = run(&options)?;
    println!("held: spring / weight   {:.6}", outcome.force_over_weight);
    println!("      stretch k / m g   {:.6}", outcome.stretch_ratio);
    println!("dropped: floor / weight {:.6}", outcome.floor_over_weight);
    println!("         centre at      {:.4} m", outcome.rest_height_m);
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
