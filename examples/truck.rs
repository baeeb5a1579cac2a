//! A truck with suspension and driven wheels crosses a flexible bridge deck.
//!
//! ```text
//!                  +-----------+
//!                  |  1000 kg  |         chassis
//!                  +--s-----s--+         s: slide of the wheel, spring and damper
//!                     O     O            driven wheels
//!   ====++---------------------------++====
//!       o      8 x 0.3 m deck        o
//! ```
//!
//! Each wheel hangs on one joint of rapier: locked along the chassis, sprung across it, turning freely under a velocity motor. Before the
//! truck sets off, each spring carries half of the chassis: it is pressed together by `m g / 2k`.

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

const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 120.0;
const CHASSIS: f64 = 1000.0;
const WHEEL: f64 = 40.0;
const RADIUS: f64 = 0.4;
const STIFFNESS: f64 = 6e4;
const DAMPING: f64 = 6e3;
const SPEED: f64 = 3.0;
const SPAN: f64 = 8.0;
/// Steps of standing and of driving.
const STAND: usize = 360;
const DRIVE: usize = 600;

/// Headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// Compression of the springs at rest over `m g / 2k`, rear and front (-).
    pub compression_ratios: [f64; 2],
    /// Speed at the end over that of the wheels' rims (-).
    pub speed_ratio: f64,
    /// Where the truck has got to (m); the deck ends at 8.
    pub reached_m: f64,
    /// Deepest sag of the deck's middle (m).
    pub deepest_sag_m: f64,
}

/// Lets the truck come to rest, and drives it across.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = DT as Real;
    world.gravity = Vector::new(0.0, -GRAVITY as Real);
    let mut flex_bodies = FlexBodySet::new();
    for (from, to) in [(-12.0, 0.0), (SPAN, SPAN + 40.0)] {
        let road = ColliderBuilder::cuboid(at_real(0.5 * (to - from)), 0.5)
            .translation(at(0.5 * (from + to), -0.5))
            .friction(1.0);
        world.insert_collider(road, None);
    }
    let deck = flex_bodies.insert(
        FlexBodyBuilder::rectangle([SPAN - 0.02, 0.3], [48, 3])
            .material(
                LinearElastic::plane_stress(2e9, 0.2)
                    .density(1000.0)
                    .rayleigh(2e-3),
            )
            .friction(1.0)
            .pin_where(
                |[x, y]| y == 0.0 && (x == 0.0 || x > SPAN - 0.03),
                Pin::both(),
            )
            .translation([0.01, -0.3]),
        &mut world,
    )?;
    let middle = middle_of(&flex_bodies[deck]);
    let (chassis, wheels) = add_truck(&mut world);
    // The near wheel stands on the deck, so that all of the truck is solved with it.
    let mut flex = FlexPipeline::new();
    doctor::require_sound(&world, &flex_bodies, &flex)?;
    let mut outcome = Outcome::default();
    let mut recorder = options.recorder("A truck on a flexible deck");
    for step in 0..options.n_steps(STAND + DRIVE) {
        if step == STAND {
            outcome.compression_ratios = wheels.map(|(wheel, _)| {
                // Along the chassis, which leans a little.
                let body = &world.bodies[chassis];
                let down = world.bodies[wheel].translation() - body.translation();
                let down = body.rotation().inverse() * down;
                let pressed = f64::from(down.y) + 0.7;
                pressed * 2.0 * STIFFNESS / (CHASSIS * GRAVITY)
            });
            for (_, joint) in wheels {
                set_off(&mut world, joint)?;
            }
        }
        flex.step(&mut world, &mut flex_bodies)?;
        recorder.record((step + 1) as f64 * DT, &world, &flex_bodies, &flex)?;
        let sag = -flex_bodies[deck].displacement(middle)[1];
        outcome.deepest_sag_m = outcome.deepest_sag_m.max(sag);
    }
    recorder.write()?;
    let body = &world.bodies[chassis];
    outcome.speed_ratio = f64::from(body.linvel().x) / SPEED;
    outcome.reached_m = f64::from(body.translation().x);
    Ok(outcome)
}

fn at(x: f64, y: f64) -> Vector {
    Vector::new(x as Real, y as Real)
}

fn at_real(x: f64) -> Real {
    x as Real
}

/// The node in the middle of the deck's upper side.
fn middle_of(deck: &FlexBody) -> usize {
    let distance = |node: usize| {
        let [x, y] = deck.position(node);
        (x - 0.5 * SPAN).hypot(y)
    };
    let nodes = deck.mesh().boundary().nodes();
    nodes.iter().copied().fold(nodes[0], |best, node| {
        if distance(node) < distance(best) {
            node
        } else {
            best
        }
    })
}

/// Chassis, and wheels with their joints, rear and front.
fn add_truck(
    world: &mut PhysicsWorld,
) -> (RigidBodyHandle, [(RigidBodyHandle, ImpulseJointHandle); 2]) {
    let height = RADIUS + 0.7;
    let centre = -0.9;
    let (chassis, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(at(centre, height))
            .can_sleep(false),
        ColliderBuilder::cuboid(1.8, 0.3).mass(at_real(CHASSIS)),
    );
    let wheels = [-1.2, 1.2].map(|x| {
        let (wheel, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(at(centre + x, RADIUS))
                .can_sleep(false),
            ColliderBuilder::ball(at_real(RADIUS))
                .mass(at_real(WHEEL))
                .friction(1.0),
        );
        let joint = GenericJointBuilder::new(JointAxesMask::LIN_X)
            .local_anchor1(at(x, -0.7))
            .motor_model(JointAxis::LinY, MotorModel::ForceBased)
            .motor_position(JointAxis::LinY, 0.0, at_real(STIFFNESS), at_real(DAMPING))
            .contacts_enabled(false)
            .build();
        let joint = world.impulse_joints.insert(chassis, wheel, joint, true);
        (wheel, joint)
    });
    (chassis, wheels)
}

/// Switches the motor of a wheel on.
fn set_off(world: &mut PhysicsWorld, joint: ImpulseJointHandle) -> Result<(), Box<dyn Error>> {
    let joint = world
        .impulse_joints
        .get_mut(joint, true)
        .ok_or("the wheel has its joint")?;
    // Forward is clockwise.
    let data = &mut joint.data;
    data.set_motor_velocity(JointAxis::AngX, at_real(-SPEED / RADIUS), 200.0)
        .set_motor_model(JointAxis::AngX, MotorModel::ForceBased)
        .set_motor_max_force(JointAxis::AngX, 800.0);
    Ok(())
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let outcome = run(&options)?;
    let [rear, front] = outcome.compression_ratios;
    println!("springs pressed, over m g / 2k   {rear:.5} rear, {front:.5} front");
    println!(
        "speed over rim speed             {:.4}",
        outcome.speed_ratio
    );
    println!(
        "reached                          {:.3} m",
        outcome.reached_m
    );
    println!(
        "deepest sag of the deck          {:.3} mm",
        1e3 * outcome.deepest_sag_m
    );
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
