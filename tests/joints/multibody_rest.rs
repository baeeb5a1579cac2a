//! Flexible bodies that lie on links of multibodies: forces at rest, light links under heavy bodies, and the motion of the same thing
//! built of impulse joints.

use crate::common::*;

/// A table top of this mass on a vertical rail with a spring, damped to half its critical damping.
fn table(
    scene: &mut Scene,
    at: f64,
    half_width: f64,
    mass: f64,
    stiffness: f64,
) -> RigidBodyHandle {
    let base = RigidBodyBuilder::fixed().translation(vec2(at, 0.0));
    let base = scene.world.insert_body(base);
    let top = RigidBodyBuilder::dynamic()
        .translation(vec2(at, 0.0))
        .can_sleep(false);
    let shape = ColliderBuilder::cuboid(real(half_width), real(0.05));
    let top = scene
        .world
        .insert(top, shape.density(real(mass / (0.2 * half_width))))
        .0;
    let rail = PrismaticJointBuilder::new(vec2(0.0, 1.0));
    let joints = &mut scene.world.multibody_joints;
    let handle = joints.insert(base, top, rail, true).expect("a joint");
    let (multibody, id) = joints.get_mut(handle).expect("it is there");
    let link = multibody.link_mut(id).expect("it is there");
    link.joint.set_spring(0, real(stiffness), 0.0);
    let rail = link.assembly_id();
    multibody.damping_mut()[rail] = real((stiffness * mass).sqrt());
    top
}

/// A block of 0.3 m with its lower left corner here.
fn block(scene: &mut Scene, mass: f64, stiffness: f64, at: [f64; 2]) -> FlexBodyHandle {
    scene.flexible(
        FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3])
            .material(
                LinearElastic::plane_stress(stiffness, 0.3)
                    .density(mass / 0.09)
                    .rayleigh(1e-3),
            )
            .translation(at)
            .friction(0.5),
    )
}

fn height(scene: &Scene, body: RigidBodyHandle) -> f64 {
    f64::from(scene.world.bodies[body].translation().y)
}

#[test]
fn a_block_set_on_a_table_rests_with_its_weight_whatever_weighs_more() {
    for (ours, theirs) in [(100.0, 1.0), (1.0, 1.0), (1.0, 100.0)] {
        for (spring, stiffness) in [(1e5, 1e6), (1e5, 1e8), (1e7, 1e6)] {
            let mut scene = Scene::new(1.0 / 60.0);
            let top = table(&mut scene, 0.0, 0.5, theirs, spring);
            let block = block(&mut scene, ours, stiffness, [-0.15, 0.06]);
            scene.steps(600);
            let carried = scene.body(block).total_contact_force()[1] / (G * ours);
            let rest = -(ours + theirs) * G / spring;
            // The spring knows heights to a rounding of rapier's.
            let missed = (height(&scene, top) - rest).abs();
            let case = format!("{ours} kg on {theirs} kg, spring {spring}, E {stiffness}");
            assert!(
                (carried - 1.0).abs() < 1e-4,
                "{case}: {carried} of the weight"
            );
            assert!(
                missed < 1e-3 * rest.abs() + 2e-7,
                "{case}: {missed} of {rest} m"
            );
        }
    }
}

#[test]
fn a_block_across_two_tables_leaves_half_its_weight_on_each() {
    for mass in [1.0, 100.0] {
        let mut scene = Scene::new(1.0 / 60.0);
        let tables = [-0.11, 0.11].map(|at| table(&mut scene, at, 0.1, 2.0, 1e5));
        let block = block(&mut scene, mass, 1e6, [-0.15, 0.051]);
        scene.steps(600);
        let rest = -(0.5 * mass + 2.0) * G / 1e5;
        for table in tables {
            let missed = (height(&scene, table) - rest).abs();
            assert!(
                missed < 1e-3 * rest.abs(),
                "{mass} kg: {missed} of {rest} m"
            );
        }
        let carried = scene.body(block).total_contact_force()[1] / (G * mass);
        assert!((carried - 1.0).abs() < 1e-4, "{carried} of the weight");
    }
}

/// Two hinged bars of 2 kg that lie on the ground.
fn bars_on_the_ground(scene: &mut Scene) -> [RigidBodyHandle; 2] {
    scene.ground(0.5);
    let bars = [0.0, 1.0].map(|x| {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(x, 0.1))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.45), real(0.1)).density(real(2.0 / 0.18));
        scene.world.insert(body, shape).0
    });
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.5, 0.0))
        .local_anchor2(vec2(-0.5, 0.0));
    let joints = &mut scene.world.multibody_joints;
    joints.insert(bars[0], bars[1], hinge, true);
    (0..60).for_each(|_| scene.world.step());
    bars
}

#[test]
fn a_block_lies_still_across_two_links_that_rapier_keeps_on_the_ground() {
    for rate in [60.0, 240.0] {
        let mut scene = Scene::new(1.0 / rate);
        bars_on_the_ground(&mut scene);
        let block = block(&mut scene, 9.0, 1e6, [0.35, 0.21]);
        scene.steps((3.0 * rate) as usize);
        let body = scene.body(block);
        let carried = body.total_contact_force()[1] / (G * body.mass());
        assert!(
            (carried - 1.0).abs() < 1e-3,
            "{rate} Hz: {carried} of the weight"
        );
        let [x, y] = body.linvel();
        assert!(x.hypot(y) < 1e-4, "{rate} Hz: {x} {y} m/s");
    }
}

/// A lever of 2 kg and 1 m, hinged at its left end to the world.
fn lever(scene: &mut Scene, is_link: bool) -> RigidBodyHandle {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.5, 0.0))
        .can_sleep(false);
    let shape = ColliderBuilder::cuboid(real(0.5), real(0.05));
    let lever = scene
        .world
        .insert(body, shape.density(20.0).friction(0.5))
        .0;
    let hinge = RevoluteJointBuilder::new()
        .local_anchor2(vec2(-0.5, 0.0))
        .contacts_enabled(false);
    if is_link {
        let joints = &mut scene.world.multibody_joints;
        let handle = joints.insert(base, lever, hinge, true).expect("a joint");
        let (multibody, _) = joints.get_mut(handle).expect("it is there");
        multibody.damping_mut().fill(0.0);
    } else {
        scene.world.impulse_joints.insert(base, lever, hinge, true);
    }
    lever
}

/// Angle of the lever after 0.3 s under a block that lies on it or is pinned to it.
fn fallen(rate: f64, mass: f64, is_pinned: bool, is_link: bool) -> f64 {
    let mut scene = Scene::new(1.0 / rate);
    let lever = lever(&mut scene, is_link);
    let block = block(&mut scene, mass, 1e6, [0.2, 0.05]);
    if is_pinned {
        let pin = AttachmentBuilder::pin(block).where_(|[x, y]| x < 0.01 && y < 0.01);
        let attached = scene
            .bodies
            .attach(pin.to_rigid_body(lever), &scene.world.bodies);
        attached.expect("the description is right");
    }
    scene.steps((0.3 * rate).round() as usize);
    f64::from(scene.world.bodies[lever].rotation().angle())
}

#[test]
fn a_link_falls_with_a_block_as_the_same_body_on_an_impulse_joint() {
    for (mass, is_pinned) in [(0.9, false), (90.0, false), (0.9, true), (90.0, true)] {
        for rate in [120.0, 240.0, 480.0, 960.0] {
            let [ours, theirs] = [true, false].map(|link| fallen(rate, mass, is_pinned, link));
            let error = (ours - theirs).abs();
            assert!(
                error < by_precision(1e-6, 1e-10),
                "{mass} kg, pinned: {is_pinned}, {rate} Hz: {error} rad"
            );
        }
    }
}

/// Largest distance between the lower face of a block and the table that it rides on, over half a second (m).
fn miss(rate: f64, mass: f64) -> f64 {
    let mut scene = Scene::new(1.0 / rate);
    let top = table(&mut scene, 0.0, 0.5, 2.0, 2000.0);
    let block = block(&mut scene, mass, 1e6, [-0.15, 0.05]);
    let mut worst = 0.0f64;
    for step in 0..(0.5 * rate) as usize {
        scene.step();
        let heights = scene.body(block).positions().chunks(2).map(|at| at[1]);
        let low = heights.fold(f64::INFINITY, f64::min);
        if step > 2 {
            worst = worst.max((low - height(&scene, top) - 0.05).abs());
        }
    }
    worst
}

#[test]
fn what_lies_on_a_link_keeps_touching_it() {
    for mass in [0.5, 4.0, 50.0] {
        for rate in [120.0, 240.0, 480.0] {
            let missed = miss(rate, mass);
            // To rapier's rounding of both places.
            let rounding = by_precision(5e-7, 1e-9);
            assert!(missed < rounding, "{mass} kg at {rate} Hz: {missed} m");
        }
    }
}

#[test]
fn a_block_and_the_link_it_lies_on_sleep_and_wake_where_they_were() {
    let mut scene = Scene::new(1.0 / 60.0);
    let top = table(&mut scene, 0.0, 0.5, 2.0, 1e5);
    let activation = scene.world.bodies[top].activation_mut();
    *activation = RigidBodyActivation::default();
    let block = block(&mut scene, 9.0, 1e6, [-0.15, 0.051]);
    scene.steps(900);
    assert_eq!(scene.report().n_asleep(), 1, "the block sleeps");
    assert!(scene.world.bodies[top].is_sleeping(), "the link sleeps");
    let before = height(&scene, top);
    scene.world.bodies[top].wake_up(true);
    let mut worst = 0.0f64;
    for _ in 0..60 {
        scene.step();
        worst = worst.max((height(&scene, top) - before).abs());
    }
    // What is found again is a balance of forces to 1e-9 of the weight: no rounding of rapier's is ever passed.
    assert!(worst < 1e-7, "{worst} m");
    let body = scene.body(block);
    let carried = body.total_contact_force()[1] / (G * body.mass());
    assert!((carried - 1.0).abs() < 1e-6, "{carried} of the weight");
}

/// A chain of ten hinged links of 1.8 kg that lie on the ground, the first hinged to the world.
fn chain_on_the_ground(scene: &mut Scene) {
    scene.ground(0.5);
    let base = RigidBodyBuilder::fixed().translation(vec2(-0.1, 0.06));
    let mut last = (scene.world.insert_body(base), 0.0);
    for link in 0..10 {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(0.2 * f64::from(link), 0.06))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(0.09, 0.05).density(100.0);
        let link = scene.world.insert(body, shape).0;
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(last.1, 0.0))
            .local_anchor2(vec2(-0.1, 0.0))
            .contacts_enabled(false);
        let joints = &mut scene.world.multibody_joints;
        joints.insert(last.0, link, hinge, true);
        last = (link, 0.1);
    }
}

#[test]
fn a_plank_is_carried_by_eight_links_at_once() {
    let mut scene = Scene::new(1.0 / 60.0);
    chain_on_the_ground(&mut scene);
    let plank = scene.flexible(
        FlexBodyBuilder::rectangle([1.4, 0.1], [14, 1])
            .material(
                LinearElastic::plane_stress(1e6, 0.3)
                    .density(2.0 / 0.14)
                    .rayleigh(1e-3),
            )
            .translation([0.3, 0.13])
            .friction(0.5),
    );
    scene.steps(300);
    let body = scene.body(plank);
    let carried = body.total_contact_force()[1] / (G * body.mass());
    assert!((carried - 1.0).abs() < 1e-3, "{carried} of the weight");
    let [x, y] = body.linvel();
    assert!(x.hypot(y) < 1e-5, "{x} {y} m/s");
}

#[test]
fn a_table_held_by_a_motor_or_lying_on_its_stop_carries_a_block() {
    for (name, mass) in [
        ("motor", 1.0),
        ("motor", 50.0),
        ("stop", 1.0),
        ("stop", 50.0),
    ] {
        let mut scene = Scene::new(1.0 / 60.0);
        let base = scene.world.insert_body(RigidBodyBuilder::fixed());
        let top = RigidBodyBuilder::dynamic().can_sleep(false);
        let shape = ColliderBuilder::cuboid(0.5, 0.05).density(20.0);
        let top = scene.world.insert(top, shape).0;
        let rail = PrismaticJointBuilder::new(vec2(0.0, 1.0));
        let rail = if name == "motor" {
            rail.motor_model(MotorModel::ForceBased)
                .motor_position(0.0, 2e4, 4e2)
        } else {
            rail.limits([0.0, 1.0])
        };
        scene.world.multibody_joints.insert(base, top, rail, true);
        let block = block(&mut scene, mass, 1e6, [-0.15, 0.051]);
        scene.steps(600);
        let body = scene.body(block);
        let carried = body.total_contact_force()[1] / (G * body.mass());
        let sunk = -height(&scene, top);
        let rest = if name == "motor" {
            (mass + 2.0) * G / 2e4
        } else {
            0.0
        };
        assert!(
            (carried - 1.0).abs() < 1e-3,
            "{name}, {mass} kg: {carried} of the weight"
        );
        // To rounding of rapier's; measured 1e-11 m on the stop.
        assert!(
            (sunk - rest).abs() < 1e-3 * rest + 1e-6,
            "{name}, {mass} kg: {sunk} of {rest} m"
        );
    }
}

/// A block between two fingers of 1 kg on rails, which press with 200 N each: of one fixed hand, or of a hand each.
fn squeezed(is_one_hand: bool) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    let hands = [(); 2].map(|()| scene.world.insert_body(RigidBodyBuilder::fixed()));
    for (finger, side) in [-1.0, 1.0].into_iter().enumerate() {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(0.3 * side, 0.0))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.05), real(0.2)).density(25.0);
        let link = scene.world.insert(body, shape.friction(0.8)).0;
        let rail = PrismaticJointBuilder::new(vec2(1.0, 0.0)).local_anchor1(vec2(0.3 * side, 0.0));
        let hand = hands[if is_one_hand { 0 } else { finger }];
        let joints = &mut scene.world.multibody_joints;
        joints.insert(hand, link, rail, true);
        scene.world.bodies[link].add_force(vec2(-200.0 * side, 0.0), true);
    }
    let block = block(&mut scene, 4.5, 1e5, [-0.15, -0.15]);
    (scene, block)
}

#[test]
fn fingers_of_one_fixed_hand_press_as_if_each_had_a_hand_of_its_own() {
    // What is fixed hands nothing on.
    let (mut one, in_one) = squeezed(true);
    let (mut two, in_two) = squeezed(false);
    for step in 0..180 {
        one.step();
        two.step();
        let places = [one.body(in_one), two.body(in_two)].map(FlexBody::positions);
        let pairs = places[0].iter().zip(places[1]);
        let missed = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(missed < 1e-6, "step {step}: {missed} m");
    }
    let carried = one.body(in_one).total_contact_force()[1] / (G * 4.5);
    assert!((carried - 1.0).abs() < 1e-6, "{carried} of the weight");
}

#[test]
fn what_lies_on_a_link_of_negative_dominance_or_with_locked_axes_lies_still() {
    let changes: [fn(&mut RigidBody); 3] = [
        |link| link.set_dominance_group(-1),
        |link| link.set_locked_axes(LockedAxes::TRANSLATION_LOCKED, true),
        |link| link.set_locked_axes(LockedAxes::ROTATION_LOCKED, true),
    ];
    for (case, change) in changes.into_iter().enumerate() {
        let mut scene = Scene::new(1.0 / 60.0);
        let top = table(&mut scene, 0.0, 0.5, 2.0, 1e5);
        change(&mut scene.world.bodies[top]);
        let block = block(&mut scene, 9.0, 1e6, [-0.15, 0.051]);
        scene.steps(300);
        let body = scene.body(block);
        let carried = body.total_contact_force()[1] / (G * body.mass());
        assert!((carried - 1.0).abs() < 1e-4, "{case}: {carried}");
        let [x, y] = body.linvel();
        assert!(x.hypot(y) < 1e-5, "{case}: {x} {y} m/s");
    }
}
