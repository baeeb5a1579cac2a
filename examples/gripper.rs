//! Two rubber fingers on motorised slides grip a rigid part and lift it.
//!
//! ```text
//!            hand (kinematic)
//!        ----+-----------+----     slides: prismatic joints, motors of bounded force F
//!        jaw [|=       =|] jaw     fingers welded to the jaws
//!             |= +---+ =|
//!             |= | m | =|          part of 2 kg
//!                +---+
//!     --------------------------   floor
//! ```
//!
//! A motor that has closed pushes with its largest force, so each finger grips with `F`. Friction can lift `2 mu F`; the part is
//! heavier by its acceleration, and held while `m (g + a) <= 2 mu F`.

#[path = "support/cli.rs"]
pub mod cli;
#[path = "support/doctor.rs"]
mod doctor;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::pipeline::Participant;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;

const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 120.0;
/// Largest force of each motor (N).
const FORCE: f64 = 40.0;
const FRICTION: f64 = 0.6;
const MASS: f64 = 2.0;
const SPEED: f64 = 0.2;
/// Steps of closing, lifting and holding.
const CLOSE: usize = 60;
const LIFT: usize = 120;
const HOLD: usize = 240;

/// Headline numbers, while the part is held still above the floor.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// Normal force of the left and of the right finger over the motor's largest force (-).
    pub grip_ratios: [f64; 2],
    /// Friction of both fingers over the part's weight (-).
    pub lift_over_weight: f64,
    /// The same over what friction could carry, `2 mu F` (-).
    pub used_friction: f64,
    /// How far the part has risen over how far the hand has (-).
    pub rise_ratio: f64,
}

/// Grips, lifts and holds.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = DT as Real;
    world.gravity = Vector::new(0.0, -GRAVITY as Real);
    let floor = ColliderBuilder::cuboid(1.0, 0.1).translation(Vector::new(0.0, -0.1));
    world.insert_collider(floor, None);
    let mut flex_bodies = FlexBodySet::new();
    let at = |x: f64, y: f64| Vector::new(x as Real, y as Real);
    let (part, part_collider) = world.insert(
        RigidBodyBuilder::dynamic().translation(at(0.0, 0.05)),
        ColliderBuilder::cuboid(0.05, 0.05)
            .mass(MASS as Real)
            .friction(FRICTION as Real),
    );
    let hand = RigidBodyBuilder::kinematic_velocity_based().translation(at(0.0, 0.3));
    let hand = world.insert_body(hand);
    for side in [-1.0, 1.0] {
        add_finger(side, hand, &mut world, &mut flex_bodies)?;
    }
    let mut flex = FlexPipeline::new();
    doctor::require_sound(&world, &flex_bodies, &flex)?;
    let mut recorder = options.recorder("Two flexible fingers lift a part");
    for step in 0..options.n_steps(CLOSE + LIFT + HOLD) {
        let rises = (CLOSE..CLOSE + LIFT).contains(&step);
        let speed = if rises { SPEED } else { 0.0 };
        world.bodies[hand].set_linvel(at(0.0, speed), true);
        flex.step(&mut world, &mut flex_bodies)?;
        recorder.record((step + 1) as f64 * DT, &world, &flex_bodies, &flex)?;
    }
    recorder.write()?;
    let mut outcome = Outcome::default();
    let mut lift = 0.0;
    for contact in flex.report().contacts() {
        let part_is =
            [contact.contactor, contact.target].map(|one| one == Participant::Rigid(part_collider));
        if part_is == [false, false] {
            continue;
        }
        let finger = usize::from(contact.position[0] > 0.0);
        outcome.grip_ratios[finger] += contact.normal_force / FORCE;
        // The tangent is a quarter turn from the normal, which points at the contactor.
        let upward =
            contact.normal_force * contact.normal[1] + contact.tangential_force * contact.normal[0];
        lift += if part_is[0] { upward } else { -upward };
    }
    outcome.lift_over_weight = lift / (MASS * GRAVITY);
    outcome.used_friction = lift / (2.0 * FRICTION * FORCE);
    let risen = f64::from(world.bodies[part].translation().y) - 0.05;
    let raised = f64::from(world.bodies[hand].translation().y) - 0.3;
    outcome.rise_ratio = if raised > 0.0 { risen / raised } else { 0.0 };
    Ok(outcome)
}

/// A jaw that slides on the hand and the finger welded to it, on one side of the part.
fn add_finger(
    side: f64,
    hand: RigidBodyHandle,
    world: &mut PhysicsWorld,
    flex_bodies: &mut FlexBodySet,
) -> Result<(), Box<dyn Error>> {
    let at = |x: f64, y: f64| Vector::new(x as Real, y as Real);
    let jaw = world.insert_body(
        RigidBodyBuilder::dynamic()
            .translation(at(side * 0.1, 0.07))
            .additional_mass_properties(MassProperties::new(at(0.0, 0.0), 0.5, 0.001)),
    );
    let slide = PrismaticJointBuilder::new(at(1.0, 0.0))
        .local_anchor1(at(side * 0.1, -0.23))
        .motor_velocity((-side * SPEED) as Real, 1e4)
        .motor_max_force(FORCE as Real);
    world.impulse_joints.insert(hand, jaw, slide, true);
    let inner = if side < 0.0 { -0.085 } else { 0.055 };
    let finger = flex_bodies.insert(
        FlexBodyBuilder::rectangle([0.03, 0.1], [4, 12])
            .material(
                LinearElastic::plane_stress(5e5, 0.4)
                    .density(1000.0)
                    .rayleigh(5e-3),
            )
            .friction(FRICTION)
            .translation([inner, 0.02]),
        world,
    )?;
    let back = if side < 0.0 { 0.0 } else { 0.03 };
    let weld = AttachmentBuilder::weld(finger)
        .where_(move |[x, _]| (x - back).abs() < 1e-9)
        .to_rigid_body(jaw);
    flex_bodies.attach(weld, &world.bodies)?;
    Ok(())
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let outcome = run(&options)?;
    let [left, right] = outcome.grip_ratios;
    println!("grip / motor force      {left:.6} left, {right:.6} right");
    println!("friction / weight       {:.6}", outcome.lift_over_weight);
    println!("friction / limit        {:.4}", outcome.used_friction);
    println!("part rises with hand by {:.4}", outcome.rise_ratio);
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
