//! Elastic bodies fall on a rigid floor of the rapier world and rebound, at three step lengths.
//!
//! ```text
//!   block 2 x 10 m        bar 0.1 x 10 m, guided
//!     +-----+                  ||
//!     |     |                  ||      v0 = 0.1 m/s, no gravity
//!     |     | v0               || v0   E = 900 Pa, rho = 1 kg/m^3, nu = 0: c = 30 m/s
//!     |     |                  ||
//!     +-----+                  ||
//!   ===========            ==========
//! ```
//!
//! In both, one plane wave runs up, is reflected at the free end and lifts the body off when it is back: contact lasts
//! `2 L / c` with a pressure of `rho c v0`, and the body leaves unstrained with `v0`. Without gravity the answer is exact
//! and the energy is only kinetic and elastic. The block is an ordinary body; the bar is one element thick, cannot move
//! sideways, and gives up the inertia of its end nodes only.
//!
//! The gap of the benchmark closes exactly at the end of a step. A gap that closes within one costs energy, most of all
//! half-way; the example shows that loss too. It falls with the step, and nothing is ever gained.

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

const LENGTH: f64 = 10.0;
const YOUNG: f64 = 900.0;
const DENSITY: f64 = 1.0;
const WAVE_SPEED: f64 = 30.0;
const SPEED: f64 = 0.1;
/// The lower face touches the floor after half a second, a whole number of steps.
const TOUCH: f64 = 0.5;
const CONTACT_TIME: f64 = 2.0 * LENGTH / WAVE_SPEED;
const END: f64 = 1.5;

/// What one impact showed.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Impact {
    /// Deepest overlap (m).
    pub penetration_m: f64,
    /// Largest gain and largest loss of energy over all steps, `E / E0 - 1` (-).
    pub energy_gain: f64,
    pub energy_loss: f64,
    /// The larger of the two in magnitude (-).
    pub energy_error: f64,
    /// Speed of the centre of mass after the impact over that before (-).
    pub rebound: f64,
    /// From the first to the last step in contact, against `2 L / c` (-).
    pub contact_time_error: f64,
    /// Sum of the contact forces times the step, against the change of momentum (-).
    pub impulse_error: f64,
}

/// The block, and the bar, at one step length (s).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outcome {
    pub dt: f64,
    #[serde(flatten)]
    pub block: Impact,
    pub bar: Impact,
    /// The bar, with a gap that closes half-way through a step.
    pub bar_mid_step: Impact,
}

/// Drops block and bar with steps of 1/60, 1/240 and 1/1000 s.
pub fn run(options: &Options) -> Result<Vec<Outcome>, Box<dyn Error>> {
    [60.0, 240.0, 1000.0]
        .map(|rate| {
            let dt = 1.0 / rate;
            Ok(Outcome {
                dt,
                block: impact(block(), dt, 0.0, options)?,
                bar: impact(bar(), dt, 0.0, options)?,
                bar_mid_step: impact(bar(), dt, 0.5, options)?,
            })
        })
        .into_iter()
        .collect()
}

/// A block of square cells, whose whole boundary is without inertia: the default.
pub fn block() -> FlexBodyBuilder {
    falling(FlexBodyBuilder::rectangle([2.0, LENGTH], [30, 150]).small_strain())
}

/// The impacting bar: 100 cells, one thick, guided.
pub fn bar() -> FlexBodyBuilder {
    falling(FlexBodyBuilder::rectangle([0.1, LENGTH], [1, 100]).small_strain())
        .contact_inertia(ContactInertia::RedistributedAt(vec![0, 1]))
        .pin_where(|_| true, Pin::x())
}

fn falling(builder: FlexBodyBuilder) -> FlexBodyBuilder {
    builder
        .material(LinearElastic::plane_stress(YOUNG, 0.0).density(DENSITY))
        .linvel([0.0, -SPEED])
}

/// Lets a body fall on a fixed floor; the gap closes `phase` of a step later than at the end of one.
pub fn impact(
    builder: FlexBodyBuilder,
    dt: f64,
    phase: f64,
    options: &Options,
) -> Result<Impact, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = dt as Real;
    let floor = ColliderBuilder::cuboid(20.0, 1.0).translation(Vector::new(0.0, -1.0));
    world.insert_collider(floor, None);
    let mut flex_bodies = FlexBodySet::new();
    let gap = SPEED * (TOUCH + phase * dt);
    let body = flex_bodies.insert(builder.translation([0.0, gap]), &mut world)?;
    let mut pipeline = FlexPipeline::new().with_integrator(Beta2::trapezoidal());

    doctor::require_sound(&world, &flex_bodies, &pipeline)?;
    let at_start = flex_bodies[body].energy().kinetic;
    let momentum = flex_bodies[body].momentum()[1];
    let mut impact = Impact::default();
    let (mut first, mut last, mut impulse) = (None, 0, 0.0);
    for step in 0..options.n_steps((END / dt).round() as usize) {
        let report = pipeline.step(&mut world, &mut flex_bodies)?;
        let change = (report.energy().kinetic + report.energy().elastic) / at_start - 1.0;
        impact.energy_gain = impact.energy_gain.max(change);
        impact.energy_loss = impact.energy_loss.max(-change);
        impact.penetration_m = impact.penetration_m.max(report.gap_violation());
        let force = flex_bodies[body].total_contact_force()[1];
        if force > 0.0 {
            first.get_or_insert(step);
            last = step;
            // The step that was taken, in rapier's precision.
            impulse += force * f64::from(world.integration_parameters.dt);
        }
    }
    if let Some(first) = first {
        let change = flex_bodies[body].momentum()[1] - momentum;
        impact.contact_time_error = (last - first + 1) as f64 * dt / CONTACT_TIME - 1.0;
        impact.impulse_error = impulse / change - 1.0;
    }
    impact.energy_error = impact.energy_gain.max(impact.energy_loss);
    impact.rebound = flex_bodies[body].linvel()[1] / SPEED;
    Ok(impact)
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    options.refuse_replay()?;
    let outcomes = run(&options)?;
    println!("                   dt     overlap  energy: gain     loss   rebound  contact time");
    for outcome in &outcomes {
        let impacts = [
            ("block", &outcome.block),
            ("bar", &outcome.bar),
            ("bar, mid-step", &outcome.bar_mid_step),
        ];
        for (name, impact) in impacts {
            println!(
                "{name:<13} 1/{:<4.0} s   {:.0e} m       {:.0e}    {:.0e}    {:.4}       {:+.2} %",
                1.0 / outcome.dt,
                impact.penetration_m,
                impact.energy_gain,
                impact.energy_loss,
                impact.rebound,
                100.0 * impact.contact_time_error,
            );
        }
    }
    if options.json {
        print_json(&outcomes);
    }
    Ok(())
}
