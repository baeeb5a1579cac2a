//! Falling bodies pass light gates: fixed sensors that feel a flexible block, and a flexible sheet that is a sensor itself.
//!
//! ```text
//!   +-----+      o          block and ball fall from rest
//!   |     |
//!   +-----+
//!   - - - - - -             gate 0, a fixed sensor
//!   - - - - - -             gate 1 ...
//!   ~~~~~~~~~~~             the sheet: a flexible body that touches nothing
//! ```
//!
//! A gate reports when the block's lower face reaches it and when its upper face has left. The times are those of free fall to
//! a step, so `g` follows from them by least squares; sensors push nothing, so the ball lands where it would.

#[path = "support/cli.rs"]
pub mod cli;
#[path = "support/doctor.rs"]
mod doctor;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use std::sync::mpsc::channel;

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
const N_GATES: usize = 12;
/// Distance of the gates, the first as far below the block (m).
const SPACING: f64 = 0.5;
const END: f64 = 1.8;

/// What the gates told.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Outcome {
    /// When the block reached each gate (s).
    pub reached_s: Vec<f64>,
    /// When it had left each gate (s).
    pub left_s: Vec<f64>,
    /// Acceleration of gravity from these times (m/s²).
    pub g: f64,
    /// `g / 9.81 - 1` (-).
    pub g_error: f64,
    /// Starts and stops at the flexible sheet: block and ball.
    pub sheet_events: [usize; 2],
    /// Force events of any kind.
    pub n_forces: usize,
    /// How far the block is from where free fall takes it (m).
    pub deviation_m: f64,
}

/// Drops a block and a ball through all gates.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = DT as Real;
    let gates: Vec<ColliderHandle> = (0..N_GATES)
        .map(|gate| {
            let y = -SPACING * (gate + 1) as f64;
            let beam =
                ColliderBuilder::segment(Vector::new(-2.0, y as Real), Vector::new(2.0, y as Real));
            world.insert_collider(beam.sensor(true), None)
        })
        .collect();
    let mut flex_bodies = FlexBodySet::new();
    let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let block = FlexBodyBuilder::rectangle([1.0, 0.4], [5, 2])
        .material(rubber)
        .active_events(ActiveEvents::all())
        .translation([-1.5, 0.0]);
    let block = flex_bodies.insert(block, &mut world)?;
    let sheet = FlexBodyBuilder::rectangle([6.0, 0.1], [30, 1])
        .material(rubber)
        .pin_where(|[x, _]| x == 0.0 || x == 6.0, Pin::both())
        .gravity_scale(0.0)
        .sensor(true)
        .translation([-3.0, -7.0]);
    let sheet = flex_bodies.insert(sheet, &mut world)?;
    let sheet = flex_bodies[sheet].collider_handle();
    let ball = RigidBodyBuilder::dynamic().translation(Vector::new(1.0, 0.5));
    let shape = ColliderBuilder::ball(0.2).active_events(ActiveEvents::all());
    world.insert(ball, shape);

    let (send_collision, collisions) = channel();
    let (send_force, forces) = channel();
    let (send_tear, _tears) = channel();
    let events = ChannelEventCollector::new(send_collision, send_force, send_tear);
    let mut pipeline = FlexPipeline::new();
    doctor::require_sound(&world, &flex_bodies, &pipeline)?;
    let mut outcome = Outcome::default();
    let surface = flex_bodies[block].collider_handle();
    let start = flex_bodies[block].centre_of_mass()[1];
    let n_steps = options.n_steps((END / DT).round() as usize);
    let mut recorder = options.recorder("Light gates");
    for step in 0..n_steps {
        pipeline.step_with_events(&mut world, &mut flex_bodies, &(), &events)?;
        // Rapier looks at the beginning of a step.
        let time = step as f64 * DT;
        recorder.record(time + DT, &world, &flex_bodies, &pipeline)?;
        for event in collisions.try_iter() {
            let pair = [event.collider1(), event.collider2()];
            if pair.contains(&sheet) {
                outcome.sheet_events[usize::from(event.stopped())] += 1;
            } else if pair.contains(&surface) && pair.iter().any(|one| gates.contains(one)) {
                let times = if event.started() {
                    &mut outcome.reached_s
                } else {
                    &mut outcome.left_s
                };
                times.push(time);
            }
        }
    }
    recorder.write()?;
    outcome.n_forces = forces.try_iter().count();
    let time = n_steps as f64 * DT;
    let fallen = start - flex_bodies[block].centre_of_mass()[1];
    outcome.deviation_m = (fallen - 0.5 * G * time * time).abs();
    outcome.g = acceleration(&outcome);
    outcome.g_error = outcome.g / G - 1.0;
    Ok(outcome)
}

/// Least squares of `s = g t²/2` over all times, each half a step earlier than it was noticed on average.
fn acceleration(outcome: &Outcome) -> f64 {
    let way = |gate: usize| SPACING * (gate + 1) as f64;
    let reached = outcome.reached_s.iter().enumerate();
    let left = outcome.left_s.iter().enumerate();
    let reached = reached.map(|(gate, &time)| (way(gate), time));
    let left = left.map(|(gate, &time)| (way(gate) + 0.4, time));
    let (mut up, mut down) = (0.0, 0.0);
    for (way, time) in reached.chain(left) {
        let half_square = 0.5 * (time - 0.5 * DT).powi(2);
        up += way * half_square;
        down += half_square * half_square;
    }
    if down > 0.0 { up / down } else { G }
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let outcome = run(&options)?;
    println!("gate   reached      left");
    for (gate, reached) in outcome.reached_s.iter().enumerate() {
        let left = outcome.left_s.get(gate).copied().unwrap_or(f64::NAN);
        println!("{gate:>4}   {reached:.4} s   {left:.4} s");
    }
    let [starts, stops] = outcome.sheet_events;
    println!(
        "g = {:.4} m/s^2 ({:+.2} %)",
        outcome.g,
        100.0 * outcome.g_error
    );
    println!("the flexible sheet told of {starts} starts and {stops} stops");
    println!(
        "{} force events; {:.1e} m from free fall",
        outcome.n_forces, outcome.deviation_m
    );
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
