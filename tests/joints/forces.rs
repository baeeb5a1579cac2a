//! Forces of joints: motors, limits, ropes, springs, chains.

use crate::common::*;
use crate::support::*;
use foil2d::pipeline::{Held, JointReport};

fn report(scene: &Scene, joint: ImpulseJointHandle) -> JointReport {
    let reports = scene.report().joints().iter();
    let mut found = reports.filter(|report| report.joint == Held::Joint(joint));
    *found.next().expect("the joint is claimed")
}

/// An arm of 1 kg whose centre is 0.5 m from its hinge, with the turn held by `hold`.
fn held_arm(
    world: &mut PhysicsWorld,
    anchor: RigidBodyHandle,
    hold: fn(RevoluteJointBuilder) -> RevoluteJointBuilder,
) -> ImpulseJointHandle {
    let arm = world.insert_body(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.5, 0.0))
            .can_sleep(false)
            .angular_damping(4.0)
            .additional_mass_properties(MassProperties::new(vec2(0.0, 0.0), 1.0, real(0.1))),
    );
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-0.5, 0.0));
    world.impulse_joints.insert(anchor, arm, hold(hinge), true)
}

#[test]
fn torques_of_motors_and_limits_are_those_of_rapier_with_many_iterations() {
    type Hold = fn(RevoluteJointBuilder) -> RevoluteJointBuilder;
    let cases: [(&str, Hold); 3] = [
        ("motor by force", |hinge| {
            hinge
                .motor_model(MotorModel::ForceBased)
                .motor_position(0.4, 50.0, 10.0)
        }),
        ("motor by acceleration", |hinge| {
            hinge.motor_position(0.4, 200.0, 20.0)
        }),
        ("limit", |hinge| hinge.limits([-0.3, 1.0])),
    ];
    for (name, hold) in cases {
        let mut scene = Scene::new(DT);
        let anchor = claimed_anchor(&mut scene);
        let ours = held_arm(&mut scene.world, anchor, hold);
        scene.steps(1200);
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = real(DT);
        world.integration_parameters.num_solver_iterations = 100;
        world.gravity = vec2(0.0, -G);
        let anchor = world.insert_body(RigidBodyBuilder::fixed());
        let theirs = held_arm(&mut world, anchor, hold);
        for _ in 0..1200 {
            world.step();
        }
        // The impulses of rapier's joints are those of one substep.
        let torque = |joint: &ImpulseJoint, n: usize| {
            let (motor, limit) = (&joint.data.motors[2], &joint.data.limits[2]);
            f64::from(motor.impulse + limit.impulse) * n as f64 / DT
        };
        let n = scene.world.integration_parameters.num_solver_iterations;
        let joint = |world: &PhysicsWorld, handle| {
            world.impulse_joints.get(handle).cloned().expect("it lives")
        };
        let (own, other) = (
            torque(&joint(&scene.world, ours), n),
            torque(&joint(&world, theirs), 100),
        );
        let weight = G * 0.5;
        println!("{name}: {own} {other} {:?}", report(&scene, ours));
        assert!((own / other - 1.0).abs() < 1e-2, "{name}: {own} {other}");
        assert!(
            own.abs() > 0.7 * weight && own.abs() < 1.01 * weight,
            "{name}: {own}"
        );
        // What is written to rapier is what is reported; the hinge carries the weight.
        let told = report(&scene, ours);
        assert!((told.force[1] / G - 1.0).abs() < by_precision(1e-4, 1e-6));
        let pinned = joint(&scene.world, ours).impulses[1];
        let pinned = -f64::from(pinned) * n as f64 / DT;
        assert!((pinned / told.force[1] - 1.0).abs() < 1e-5, "{pinned}");
    }
}

#[test]
fn a_spring_joint_sags_by_its_load_and_swings_at_its_frequency() {
    // 2 kg on 200 N/m: sag 98 mm, ω = 10 rad/s. The spring hangs straight down.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let ball = free_body(&mut scene, [0.0, -1.0], 2.0, 0.1);
    let spring = join(
        &mut scene,
        anchor,
        ball,
        SpringJointBuilder::new(1.0, 200.0, 0.0),
    );
    let sag = 2.0 * G / 200.0;
    let (mut last, mut time, mut turns) = (0.0, 0.0, Vec::new());
    let mut low = 0.0f64;
    for _ in 0..2400 {
        scene.step();
        time += DT;
        let now = position(&scene, ball)[1] + 1.0 + sag;
        low = low.min(now - sag);
        if last > 0.0 && now <= 0.0 {
            turns.push(time - DT * now / (now - last));
        }
        last = now;
    }
    let period = (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64;
    let exact = std::f64::consts::TAU / 10.0;
    println!("period {period} of {exact}, low {low} of {}", -2.0 * sag);
    // The trapezoidal spring: (ω dt)²/12 = 5.8e-4 too slow; after 30 swings nothing is lost.
    assert!((period / exact - 1.0 - 5.8e-4).abs() < 1e-4);
    assert!((low / (-2.0 * sag) - 1.0).abs() < 2e-3);
    // With a damper it comes to rest, with the force of the weight.
    let joint = scene
        .world
        .impulse_joints
        .get_mut(spring, true)
        .expect("it lives");
    joint.data.motors[0].damping = 8.0;
    scene.steps(1800);
    let rest = position(&scene, ball)[1] + 1.0;
    assert!(
        (rest / -sag - 1.0).abs() < by_precision(1e-4, 1e-6),
        "{rest} {sag}"
    );
    assert!((report(&scene, spring).force[1] / (2.0 * G) - 1.0).abs() < 1e-4);
}

#[test]
fn a_rope_is_slack_until_it_is_taut_and_then_carries_weight_and_swing() {
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let ball = free_body(&mut scene, [0.6, 0.0], 2.0, 0.1);
    let rope = join(&mut scene, anchor, ball, RopeJointBuilder::new(1.0));
    let length = |scene: &Scene| {
        let [x, y] = position(scene, ball);
        x.hypot(y)
    };
    let mut was_slack = false;
    while length(&scene) < 0.99 {
        scene.step();
        let pull = report(&scene, rope).force;
        was_slack |= pull == [0.0; 2] && length(&scene) < 0.95;
    }
    assert!(was_slack, "a slack rope pulls");
    // Taut, it takes the radial velocity and the ball swings on a circle.
    scene.steps(20);
    let energy = |scene: &Scene| {
        let v = scene.world.bodies[ball].linvel();
        f64::from(v.length_squared()) + 2.0 * G * position(scene, ball)[1]
    };
    let start = energy(&scene);
    let mut most = 0.0f64;
    for _ in 0..600 {
        scene.step();
        let [x, y] = position(&scene, ball);
        // Three times its weight, at the lowest, opens it by 1e-5 of its fall in a step each.
        let opened = 4.0 * 1e-5 * 0.5 * G * scene.dt().powi(2);
        assert!(length(&scene) < 1.0 + by_precision(1e-6, opened));
        let pull = report(&scene, rope).force;
        let v2 = f64::from(scene.world.bodies[ball].linvel().length_squared());
        // m (v²/L - g·r/L), and the pull points to the anchor.
        let exact = 2.0 * (v2 - G * y);
        let off = pull[0].hypot(pull[1]) - exact;
        most = most.max(off.abs() / (2.0 * G));
        assert!(pull[0] * x + pull[1] * y < 0.0);
    }
    println!(
        "pull off by {most:e} m g, energy {start} -> {}",
        energy(&scene)
    );
    // The report is a mean over the step, half a step earlier: ω dt/2 of the change, ω = 3 rad/s.
    assert!(most < 0.05);
    assert!((energy(&scene) - start).abs() < 1e-2 * G);
}

#[test]
fn a_chain_bridge_of_100_links_carries_a_flexible_plank() {
    // 100 links of 0.2 m in a parabola between two fixed bodies, a plank of 2 m across the middle.
    let mut scene = Scene::new(DT);
    let mut ends = vec![[-9.0, 0.0]];
    for _ in 0..100 {
        let [x, _] = ends[ends.len() - 1];
        let height = |x: f64| 0.03 * (x * x - 81.0);
        let (mut low, mut high) = (x, x + 0.2);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (middle - x).hypot(height(middle) - height(x)) < 0.2 {
                low = middle;
            } else {
                high = middle;
            }
        }
        ends.push([low, height(low)]);
    }
    let link = |i: usize| {
        let [from, to] = [ends[i], ends[i + 1]];
        let angle = (to[1] - from[1]).atan2(to[0] - from[0]);
        let at = vec2(0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]));
        RigidBodyBuilder::dynamic()
            .translation(at)
            .rotation(real(angle))
            .linear_damping(real(2.0))
    };
    let links: Vec<RigidBodyHandle> = (0..100)
        .map(|i| {
            let shape = ColliderBuilder::cuboid(0.095, 0.02)
                .density(500.0)
                .friction(real(0.8));
            scene.rigid(link(i), shape).0
        })
        .collect();
    let hinge = |a: f64, b: f64| hinge([a, 0.0], [b, 0.0]).contacts_enabled(false);
    let supports = [ends[0], ends[100]].map(|at| {
        let body = RigidBodyBuilder::fixed().translation(vec2(at[0], at[1]));
        scene.world.insert_body(body)
    });
    let first = join(&mut scene, supports[0], links[0], hinge(0.0, -0.1));
    for pair in links.windows(2) {
        join(&mut scene, pair[0], pair[1], hinge(0.1, -0.1));
    }
    let last = join(&mut scene, supports[1], links[99], hinge(0.0, 0.1));
    let lowest = ends.iter().fold(
        [0.0f64; 2],
        |low, at| if at[1] < low[1] { *at } else { low },
    );
    let plank = scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.1], [20, 2])
            .material(elastic(1e8, 200.0, 1e-2))
            .translation([lowest[0] - 1.0, lowest[1] + 0.05])
            .friction(0.8),
    );
    let links_mass = |scene: &Scene| links.iter().map(|&body| scene.mass(body)).sum::<f64>();
    scene.steps(2400);
    assert_eq!(scene.report().n_claimed(), 100);
    let weight = G * (links_mass(&scene) + scene.body(plank).mass());
    let [left, right] = [report(&scene, first).force, report(&scene, last).force];
    println!(
        "{left:?} {right:?} of {weight}; {:?}",
        scene.body(plank).linvel()
    );
    assert!(((left[1] + right[1]) / weight - 1.0).abs() < 1e-3);
    assert!(
        ((left[0] + right[0]) / left[0]).abs() < 1e-3,
        "{left:?} {right:?}"
    );
    let mut open = 0.0f64;
    for (_, joint) in scene.world.impulse_joints.iter() {
        open = open.max(gap(&scene, joint));
    }
    assert!(open < by_precision(1e-5, 1e-8), "open by {open}");
}
