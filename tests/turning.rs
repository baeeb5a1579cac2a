//! Rigid bodies that turn fast do not end up inside what they land on: with `dt = 1/60` s and 40 rad/s a box turns by 0.67 rad
//! in a step, so that other corners come down than those that faced the ground when the step began.

mod common;

use common::*;

/// Overlap that rounding and the tolerance of the position stage may leave (m): positions are solved to 1e-11 m, rapier's `f32`
/// poses are known to 1e-7 m and their angles to 1e-7 rad; a missed corner costs millimetres.
const OVERLAP: f64 = 2e-5;

/// Half a side of the turning boxes (m).
const HALF: f64 = 0.1;

/// Corners of a box in the world (m), counter-clockwise.
fn corners(scene: &Scene, body: RigidBodyHandle, half: [f64; 2]) -> Vec<[f64; 2]> {
    let pose = scene.world.bodies[body].position();
    let (c, s) = (f64::from(pose.rotation.re), f64::from(pose.rotation.im));
    let (x, y) = (f64::from(pose.translation.x), f64::from(pose.translation.y));
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[u, v]| [u * half[0], v * half[1]])
        .map(|[u, v]| [x + c * u - s * v, y + s * u + c * v])
        .to_vec()
}

/// Separation of two convex polygons (m), negative if they overlap: the largest over the normals of all faces.
fn separation(one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let along_faces = |faces: &[[f64; 2]], points: &[[f64; 2]]| {
        let ends = faces.iter().zip(faces.iter().cycle().skip(1));
        ends.map(|(a, b)| {
            let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
            let length = ex.hypot(ey);
            let heights = points
                .iter()
                .map(|p| (ey * (p[0] - a[0]) - ex * (p[1] - a[1])) / length);
            heights.fold(f64::INFINITY, f64::min)
        })
        .fold(f64::NEG_INFINITY, f64::max)
    };
    along_faces(one, other).max(along_faces(other, one))
}

fn turning_box(
    scene: &mut Scene,
    at: [f64; 2],
    angle: f64,
    velocity: [f64; 2],
    spin: f64,
) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(at[0], at[1]))
        .rotation(real(angle))
        .linvel(vec2(velocity[0], velocity[1]))
        .angvel(real(spin));
    let shape = ColliderBuilder::cuboid(real(HALF), real(HALF)).density(1000.0);
    scene.rigid(body, shape).0
}

#[test]
fn a_turning_box_does_not_end_up_inside_the_plank_it_lands_on() {
    let mut findings = Findings::default();
    for case in 0..20 {
        let spin = 1.0 + 2.0 * f64::from(case);
        let mut scene = Scene::new(1.0 / 60.0);
        scene.flexible(
            FlexBodyBuilder::rectangle([6.0, 0.3], [60, 3])
                .material(elastic(1e10, 2000.0, 1e-4))
                .pin_where(|[_, y]| y == 0.0, Pin::both())
                .translation([-3.0, 0.0]),
        );
        let plank = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.4));
        let shape = ColliderBuilder::cuboid(2.5, 0.1).density(1e5);
        let (plank, _) = scene.rigid(plank, shape);
        let turning = turning_box(&mut scene, [0.0, 1.1], 0.0, [0.0, 0.0], spin);
        let mut deepest = 0.0f64;
        for _ in 0..40 {
            scene.step();
            let apart = separation(
                &corners(&scene, turning, [HALF; 2]),
                &corners(&scene, plank, [2.5, 0.1]),
            );
            deepest = deepest.max(-apart);
        }
        findings.check(deepest < OVERLAP, || {
            format!("{spin} rad/s: {deepest:.2e} m inside the plank")
        });
    }
    findings.report();
}

#[test]
fn two_turning_boxes_that_meet_in_free_space_do_not_end_up_inside_each_other() {
    let mut findings = Findings::default();
    for case in 0..20 {
        let spin = 2.0 * f64::from(case);
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        // Whatever is within the box of a flexible ring is solved with it.
        scene.flexible(
            FlexBodyBuilder::annulus(3.0, 3.3, 0.3)
                .material(LinearElastic::plane_stress(1e8, 0.3).density(1000.0)),
        );
        let one = turning_box(&mut scene, [-0.3, 0.02], 0.0, [1.0, 0.0], spin);
        let other = turning_box(&mut scene, [0.3, -0.03], 0.4, [-1.0, 0.0], -0.8 * spin);
        let mut deepest = 0.0f64;
        for _ in 0..40 {
            scene.step();
            let boxes = [one, other].map(|body| corners(&scene, body, [HALF; 2]));
            deepest = deepest.max(-separation(&boxes[0], &boxes[1]));
        }
        findings.check(deepest < OVERLAP, || {
            format!("{spin} rad/s: {deepest:.2e} m inside each other")
        });
    }
    findings.report();
}

/// A stiff, damped bar of large strain that is pinned at the middle of its end swings from horizontal: what damps its vibrations does not brake its turning.
#[test]
fn damping_does_not_brake_a_bar_that_swings_on_its_pin() {
    let (length, height) = (1.0, 0.1);
    let mut scene = Scene::new(1.0 / 60.0);
    let at_hinge = |[x, y]: [f64; 2]| x == 0.0 && (y - 0.5 * height).abs() < 1e-9;
    let bar = FlexBodyBuilder::rectangle([length, height], [10, 2])
        .material(elastic(1e9, 1000.0, 1e-2))
        .large_strain()
        .pin_where(at_hinge, Pin::both())
        .can_sleep(false);
    let bar = scene.flexible(bar);
    let weight = 9.81 * scene.body(bar).mass();
    let energy = |scene: &Scene| {
        let body = scene.body(bar);
        let own = body.energy();
        own.kinetic + own.elastic + weight * body.centre_of_mass()[1]
    };
    let began = energy(&scene);
    for second in 1..=10 {
        scene.steps(60);
        let change = (energy(&scene) - began) / (0.5 * weight * length);
        assert!(
            (-2e-3..1e-5).contains(&change),
            "{change} of its energy after {second} s"
        );
    }
}

/// A bar of large strain is welded to a hub that turns on a joint, far from gravity. A weld has more in it than what it carries: forces of its nodes
/// that hold each other. They turn the hub as much as they turn the bar back where they act at the same places of it.
#[test]
fn a_weld_to_a_hub_neither_drives_nor_brakes_it() {
    let (length, height, spin) = (1.0, 0.05, 3.0);
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let bar = FlexBodyBuilder::rectangle([length, height], [12, 2])
        .material(elastic(1e9, 1000.0, 0.0))
        .large_strain()
        .translation([0.0, -0.5 * height])
        .linvel([0.0, 0.5 * spin * length])
        .angvel(spin);
    let bar = scene.flexible(bar);
    let inertia = MassProperties::new(vec2(0.0, 0.0), 0.1, 1e-3);
    let hub = RigidBodyBuilder::dynamic()
        .angvel(real(spin))
        .additional_mass_properties(inertia);
    let hub = scene.world.insert_body(hub);
    let ground = scene.world.insert_body(RigidBodyBuilder::fixed());
    let axle = RevoluteJointBuilder::new();
    scene.world.insert_impulse_joint(ground, hub, axle);
    let weld = AttachmentBuilder::weld(bar)
        .where_(|[x, _]| x == 0.0)
        .to_rigid_body(hub);
    let weld = scene.bodies.attach(weld, &scene.world.bodies);
    weld.expect("the hub is there");
    let energy = |scene: &Scene| {
        let own = scene.body(bar).energy();
        own.kinetic + own.elastic + kinetic_of(&scene.world.bodies[hub])
    };
    let began = energy(&scene);
    scene.step();
    let turned = scene.report().angular_momentum();
    for second in 1..=10 {
        scene.steps(60);
        let gained = energy(&scene) / began - 1.0;
        let driven = scene.report().angular_momentum() / turned - 1.0;
        // The hub's own pose is in rapier's precision.
        assert!(
            gained.abs() < 1e-4 && driven.abs() < 1e-4,
            "{second} s: energy by {gained:.1e}, angular momentum by {driven:.1e}"
        );
    }
}

/// A bar of small strain flies around on a spring from a hub that turns on a joint, in and out. What the spring gives and takes is no error of the joint:
/// taken for one, it was taken out of the turning.
#[test]
fn a_spring_on_a_hub_does_not_brake_what_flies_around_on_it() {
    let (length, height, spin) = (0.6, 0.05, 3.0);
    let mut scene = Scene::in_free_space(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    let inertia = MassProperties::new(vec2(0.0, 0.0), 5.0, 0.5);
    let hub = RigidBodyBuilder::dynamic()
        .angvel(real(spin))
        .additional_mass_properties(inertia);
    let hub = scene.world.insert_body(hub);
    let ground = scene.world.insert_body(RigidBodyBuilder::fixed());
    scene
        .world
        .insert_impulse_joint(ground, hub, RevoluteJointBuilder::new());
    let bar = FlexBodyBuilder::rectangle([length, height], [8, 2])
        .material(elastic(1e9, 1000.0, 0.0))
        .small_strain()
        .translation([0.3, -0.5 * height])
        .linvel([0.0, spin * (0.3 + 0.5 * length)])
        .angvel(spin);
    let bar = scene.flexible(bar);
    let at_end = move |[x, y]: [f64; 2]| x == 0.0 && (y - 0.5 * height).abs() < 1e-9;
    let spring = AttachmentBuilder::spring_damper(bar, 2000.0, 0.0)
        .where_(at_end)
        .at_point([0.25, 0.0])
        .to_rigid_body(hub);
    let spring = scene.bodies.attach(spring, &scene.world.bodies);
    spring.expect("the hub is there");
    scene.step();
    let began = scene.report().angular_momentum();
    let brought = scene.body(bar).energy().kinetic;
    let mut farthest = 0.0f64;
    for second in 1..=5 {
        for _ in 0..60 {
            scene.step();
            let [x, y] = scene.body(bar).centre_of_mass();
            farthest = farthest.max(x.hypot(y));
        }
        let left = scene.report().angular_momentum() / began;
        assert!(
            (left - 1.0).abs() < 2e-3,
            "{left} of its angular momentum after {second} s"
        );
    }
    assert!(farthest > 0.7, "it swings out to {farthest} m");
    // What the spring does is reckoned with the force that acts.
    let lost = scene.report().energy().dissipated;
    assert!(
        lost.abs() < 5e-3 * brought,
        "{lost} J of {brought} J went somewhere"
    );
}

/// A block of large strain flies past the anchor of its spring, which turns by far within a step there: the force that acts over the step does the work
/// that the spring stores, `(|d'| - |d|)` times its mean force. Along the mean of both ends alone it was a hundredth off.
#[test]
fn a_spring_gives_back_what_it_stores_however_far_it_turns() {
    let (side, stiffness, reach) = (0.2, 400.0, 0.5);
    let length = 0.1;
    // Past the anchor by some millimetres, and around it.
    for across in [0.02, 0.05, 0.5] {
        let mut scene = Scene::in_free_space(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
        let at_middle = move |[x, y]: [f64; 2]| (x - 0.5 * side).abs() < 1e-9 && y == 0.0;
        let mass = 1000.0 * side * side;
        let speed = reach * (stiffness / mass).sqrt();
        let block = FlexBodyBuilder::rectangle([side, side], [2, 2])
            .material(elastic(1e7, 1000.0, 0.0))
            .large_strain()
            .translation([reach - 0.5 * side, 0.0])
            .linvel([0.0, across * speed]);
        let block = scene.flexible(block);
        let node = {
            let body = scene.body(block);
            let nodes = body.mesh().nodes().iter();
            nodes.copied().position(at_middle).expect("it is there")
        };
        let spring = AttachmentBuilder::spring_damper(block, stiffness, 0.0)
            .node(node)
            .at_point([0.0, 0.0])
            .rest_length(length)
            .to_world();
        let spring = scene.bodies.attach(spring, &scene.world.bodies);
        spring.expect("the node is there");
        let energy = |scene: &Scene| {
            let body = scene.body(block);
            let [x, y] = body.position(node);
            let own = body.energy();
            own.kinetic + own.elastic + 0.5 * stiffness * (x.hypot(y) - length).powi(2)
        };
        let began = energy(&scene);
        let mut sides = [false; 2];
        for step in 0..600 {
            scene.step();
            sides[usize::from(scene.body(block).position(node)[0] > 0.0)] = true;
            let change = energy(&scene) / began - 1.0;
            assert!(
                change.abs() < 1e-7,
                "{across}, step {step}: energy by {change:.1e}"
            );
        }
        assert_eq!(sides, [true; 2], "it swings through");
    }
}
