//! Every kind of joint beside rapier alone with small steps: the same motion.

use crate::common::*;
use crate::support::*;

/// Rapier's step (s), 33 times shorter than ours: its error is of the first order.
const FINE: f64 = 1.0 / 4000.0;

/// Time compared (s).
const TIME: f64 = 1.0;

type Build = fn(&mut PhysicsWorld, RigidBodyHandle) -> Vec<RigidBodyHandle>;

/// A locked body at the origin, as [`claimed_anchor`], without anything flexible.
fn plain_world(dt: f64) -> (PhysicsWorld, RigidBodyHandle) {
    let mut world = empty_world(dt);
    world.integration_parameters.num_solver_iterations = 8;
    let anchor = world.insert_body(locked_body());
    (world, anchor)
}

fn places(world: &PhysicsWorld, bodies: &[RigidBodyHandle]) -> Vec<[f64; 3]> {
    let place = |&body: &RigidBodyHandle| {
        let body = &world.bodies[body];
        let [x, y] = place_of(body);
        [x, y, turn_of(body)]
    };
    bodies.iter().map(place).collect()
}

/// Largest difference of places over the time, relative to the largest motion.
fn difference(build: Build) -> f64 {
    let (mut world, anchor) = plain_world(FINE);
    let theirs = build(&mut world, anchor);
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let ours = build(&mut scene.world, anchor);
    let start = places(&world, &theirs);
    let (mut worst, mut moved) = (0.0f64, 0.0f64);
    let steps = (TIME / DT).round() as usize;
    let mut taken = 0;
    for step in 1..=steps {
        scene.step();
        while (taken as f64 + 0.5) * FINE < step as f64 * DT {
            world.step();
            taken += 1;
        }
        let late = step as f64 * DT - taken as f64 * FINE;
        let (a, b) = (places(&scene.world, &ours), places(&world, &theirs));
        for ((one, other), (start, &body)) in a.iter().zip(&b).zip(start.iter().zip(&theirs)) {
            let body = &world.bodies[body];
            let rates = [body.linvel().x, body.linvel().y, body.angvel()].map(f64::from);
            for axis in 0..3 {
                let there = other[axis] + late * rates[axis];
                let mut off = one[axis] - there;
                if axis == 2 {
                    off -= std::f64::consts::TAU * (off / std::f64::consts::TAU).round();
                }
                worst = worst.max(off.abs());
                moved = moved.max((one[axis] - start[axis]).abs());
            }
        }
    }
    worst / moved
}

fn joined(
    world: &mut PhysicsWorld,
    one: RigidBodyHandle,
    other: RigidBodyHandle,
    joint: impl Into<GenericJoint>,
) {
    world.impulse_joints.insert(one, other, joint, true);
}

/// An arm of 1 kg that begins level, on this joint.
fn an_arm(
    world: &mut PhysicsWorld,
    anchor: RigidBodyHandle,
    joint: RevoluteJointBuilder,
) -> Vec<RigidBodyHandle> {
    let arm = add_free_body(world, [0.5, 0.0], 1.0, 0.1);
    joined(world, anchor, arm, joint);
    vec![arm]
}

fn double_pendulum(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let first = add_free_body(world, [0.5, 0.0], 1.0, 0.1);
    let second = add_free_body(world, [1.5, 0.0], 2.0, 0.2);
    joined(world, anchor, first, hinge([0.0, 0.0], [-0.5, 0.0]));
    joined(world, first, second, hinge([0.5, 0.0], [-0.5, 0.0]));
    vec![first, second]
}

fn welded_pair(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let first = add_free_body(world, [0.5, 0.0], 1.0, 0.1);
    let second = add_free_body(world, [1.0, 0.5], 2.0, 0.2);
    joined(world, anchor, first, hinge([0.0, 0.0], [-0.5, 0.0]));
    joined(
        world,
        first,
        second,
        FixedJointBuilder::new()
            .local_anchor1(vec2(0.5, 0.0))
            .local_anchor2(vec2(0.0, -0.5)),
    );
    vec![first, second]
}

fn slider_on_pendulum(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let first = add_free_body(world, [0.5, 0.0], 2.0, 0.4);
    let bead = add_free_body(world, [0.2, 0.0], 1.0, 0.1);
    joined(world, anchor, first, hinge([0.0, 0.0], [-0.5, 0.0]));
    joined(
        world,
        first,
        bead,
        PrismaticJointBuilder::new(vec2(1.0, 0.0)).local_anchor1(vec2(-0.3, 0.0)),
    );
    vec![first, bead]
}

fn slider_with_limits(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let bead = add_free_body(world, [0.0, 0.0], 1.0, 0.1);
    joined(
        world,
        anchor,
        bead,
        PrismaticJointBuilder::new(vec2(0.6, -0.8)).limits([-1.0, 1.5]),
    );
    vec![bead]
}

fn hinge_with_limits(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let joint = hinge([0.0, 0.0], [-0.5, 0.0]).limits([-0.8, 0.5]);
    an_arm(world, anchor, joint)
}

fn pin_in_slot(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let slider = add_free_body(world, [0.3, -0.4], 1.0, 0.1);
    joined(
        world,
        anchor,
        slider,
        PinSlotJointBuilder::new(vec2(0.8, -0.6)).local_anchor2(vec2(-0.3, 0.4)),
    );
    vec![slider]
}

fn guided_turn(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    // Only the turn is locked: a generic mask.
    let first = add_free_body(world, [0.5, 0.0], 1.0, 0.1);
    let second = add_free_body(world, [1.0, 0.0], 1.0, 0.1);
    joined(world, anchor, first, hinge([0.0, 0.2], [-0.5, 0.2]));
    joined(
        world,
        first,
        second,
        GenericJointBuilder::new(JointAxesMask::ANG_X),
    );
    vec![first, second]
}

fn rope(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    // Slack at first: it falls 0.39 m before the rope is taut.
    let ball = add_free_body(world, [0.6, 0.0], 1.0, 0.1);
    joined(world, anchor, ball, RopeJointBuilder::new(0.7));
    vec![ball]
}

fn spring(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let ball = add_free_body(world, [0.6, 0.0], 1.0, 0.1);
    joined(world, anchor, ball, SpringJointBuilder::new(0.5, 80.0, 0.5));
    vec![ball]
}

fn velocity_motor(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let joint = hinge([0.0, 0.0], [-0.5, 0.0])
        .motor_model(MotorModel::ForceBased)
        .motor_velocity(4.0, 6.0);
    an_arm(world, anchor, joint)
}

fn bounded_motor(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let joint = hinge([0.0, 0.0], [-0.5, 0.0])
        .motor_velocity(4.0, 100.0)
        .motor_max_force(7.0);
    an_arm(world, anchor, joint)
}

fn position_motor(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let joint = hinge([0.0, 0.0], [-0.5, 0.0]).motor_position(1.0, 60.0, 4.0);
    an_arm(world, anchor, joint)
}

fn servo_slider(world: &mut PhysicsWorld, anchor: RigidBodyHandle) -> Vec<RigidBodyHandle> {
    let bead = add_free_body(world, [0.0, 0.0], 2.0, 0.1);
    joined(
        world,
        anchor,
        bead,
        PrismaticJointBuilder::new(vec2(0.6, 0.8))
            .motor_model(MotorModel::ForceBased)
            .set_motor(0.5, 0.2, 100.0, 8.0),
    );
    vec![bead]
}

const CASES: [(&str, Build, f64); 13] = [
    // Tolerances: the error of rapier at its small step, of the first order, and ours of the second, as measured with half of each
    // step; three times that.
    ("double pendulum", double_pendulum, 1e-2),
    ("welded pair", welded_pair, 1e-2),
    ("slider on a pendulum", slider_on_pendulum, 1e-2),
    ("slider with limits", slider_with_limits, 1e-2),
    ("hinge with limits", hinge_with_limits, 1e-2),
    ("pin in a slot", pin_in_slot, 1e-2),
    ("guided turn", guided_turn, 1e-2),
    ("rope", rope, 1e-2),
    ("spring", spring, 1e-2),
    ("velocity motor", velocity_motor, 1e-2),
    ("bounded motor", bounded_motor, 1e-2),
    ("position motor", position_motor, 1e-2),
    ("servo slider", servo_slider, 1e-2),
];

#[test]
fn every_kind_of_joint_moves_as_with_rapier_alone() {
    let mut findings = Findings::default();
    for (name, build, tolerance) in CASES {
        let off = difference(build);
        println!("{name}: {off:.2e}");
        findings.check(off < tolerance, || format!("{name}: {off:e}"));
    }
    findings.report();
}
