//! Multibodies end where they were solved to be, whatever rapier's own step makes of them.

use crate::common::*;

/// A link of 0.4 x 0.08 m, `x` from the hinge to its middle (m).
fn link(scene: &mut Scene, [x, y]: [f64; 2]) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic().translation(vec2(x, y));
    let shape = ColliderBuilder::cuboid(0.2, 0.04).density(500.0);
    scene.rigid(body, shape).0
}

fn hinge(from: f64, to: f64) -> RevoluteJoint {
    RevoluteJointBuilder::new()
        .contacts_enabled(false)
        .local_anchor1(vec2(from, 0.0))
        .local_anchor2(vec2(to, 0.0))
        .build()
}

/// Joins without damping.
fn join(scene: &mut Scene, bodies: [RigidBodyHandle; 2], joint: impl Into<GenericJoint>) {
    let joints = &mut scene.world.multibody_joints;
    let handle = joints
        .insert(bodies[0], bodies[1], joint, true)
        .expect("a joint");
    let (multibody, _) = joints.get_mut(handle).expect("it is there");
    multibody.damping_mut().fill(0.0);
}

/// A pad on the upper face of a link.
fn pad_on(scene: &mut Scene, link: RigidBodyHandle, young: f64, linvel: [f64; 2]) {
    let at = scene.world.bodies[link].translation();
    let [x, y] = [f64::from(at.x), f64::from(at.y)];
    let pad = FlexBodyBuilder::rectangle([0.1, 0.06], [3, 2])
        .material(elastic(young, 200.0, 1e-3))
        .linvel(linvel)
        .translation([x - 0.05, y + 0.04]);
    let pad = scene.flexible(pad);
    let weld = AttachmentBuilder::weld(pad)
        .where_(|[_, y]| y < 1e-6)
        .to_rigid_body(link)
        .contacts_enabled(false);
    let attached = scene.bodies.attach(weld, &scene.world.bodies);
    attached.expect("the nodes below");
}

/// Rapier 0.36 moves a multibody twice in a step if its root is kinematic and awake.
#[test]
fn what_hangs_on_a_kinematic_root_swings_as_on_a_fixed_one() {
    let swing = |root: RigidBodyBuilder| {
        let mut scene = Scene::new(1.0 / 120.0);
        let root = scene.world.insert_body(root);
        let links = [0.2, 0.6].map(|x| link(&mut scene, [x, 0.0]));
        let hinges = [[0.0, -0.2], [0.2, -0.2]];
        for (bodies, [from, to]) in [[root, links[0]], links].into_iter().zip(hinges) {
            let joint = hinge(from, to);
            join(&mut scene, bodies, joint);
        }
        pad_on(&mut scene, links[1], 1e6, [0.0; 2]);
        let mut places = Vec::new();
        for _ in 0..120 {
            scene.step();
            places.push(scene.world.bodies[links[1]].translation());
        }
        places
    };
    let fixed = swing(RigidBodyBuilder::fixed());
    for root in [
        RigidBodyBuilder::kinematic_velocity_based(),
        RigidBodyBuilder::kinematic_position_based(),
    ] {
        for (step, (one, other)) in fixed.iter().zip(swing(root)).enumerate() {
            let apart = f64::from((one - other).length());
            assert!(
                apart < by_precision(2e-5, 1e-10),
                "{step}: {one:?}, {other:?}"
            );
        }
    }
}

/// Rapier's continuous collision detection stops bodies before what is fixed, and not their coordinates, which count in the next step.
#[test]
fn links_that_land_are_where_their_coordinates_are() {
    for (speed, rate) in [(3.0, 60.0), (8.0, 60.0), (8.0, 240.0)] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.5);
        let links = [0.0, 0.42].map(|x| link(&mut scene, [x, 0.5]));
        let joint = hinge(0.21, -0.21);
        join(&mut scene, links, joint);
        let joints = &mut scene.world.multibody_joints;
        let index = joints.rigid_body_link(links[0]).expect("a link").multibody;
        let multibody = joints
            .get_multibody_mut_internal(index)
            .expect("it is there");
        multibody.generalized_velocity_mut()[1] = real(-speed);
        for link in links {
            scene.world.bodies[link].set_linvel(vec2(0.0, -speed), true);
        }
        pad_on(&mut scene, links[0], 1e6, [0.0, -speed]);
        for step in 0..rate as usize {
            let report = scene.step();
            assert!(report.gap_violation() < 1e-5, "{speed} m/s, {step}");
            for link in links {
                let joints = &scene.world.multibody_joints;
                let id = joints.rigid_body_link(link).expect("a link");
                let multibody = joints.get_multibody(id.multibody).expect("it is there");
                let pose = multibody.link(id.id).expect("it is there").local_to_world();
                let body = &scene.world.bodies[link];
                let apart = f64::from((pose.translation - body.translation()).length());
                assert!(apart < 1e-6, "{speed} m/s, {step}: {apart} m");
                let lowest = f64::from(body.translation().y) - 0.04;
                assert!(lowest > -1e-5, "{speed} m/s, {step}: {lowest} m");
            }
        }
    }
}

/// The same of an arm on a fixed root that swings onto the ground.
#[test]
fn an_arm_that_swings_onto_the_ground_is_where_its_coordinate_is() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let root = RigidBodyBuilder::fixed().translation(vec2(-0.21, 0.3));
    let root = scene.world.insert_body(root);
    let arm = link(&mut scene, [0.0, 0.3]);
    let joint = hinge(0.0, -0.21);
    join(&mut scene, [root, arm], joint);
    pad_on(&mut scene, arm, 1e6, [0.0; 2]);
    let joints = &mut scene.world.multibody_joints;
    let index = joints.rigid_body_link(arm).expect("a link").multibody;
    let multibody = joints
        .get_multibody_mut_internal(index)
        .expect("it is there");
    multibody.forward_kinematics(&scene.world.bodies, true);
    multibody.generalized_velocity_mut()[0] = -30.0;
    for step in 0..60 {
        scene.step();
        let joints = &scene.world.multibody_joints;
        let id = joints.rigid_body_link(arm).expect("a link");
        let multibody = joints.get_multibody(id.multibody).expect("it is there");
        let pose = multibody.link(id.id).expect("it is there").local_to_world();
        let apart = pose.translation - scene.world.bodies[arm].translation();
        let apart = f64::from(apart.length());
        assert!(apart < 1e-6, "{step}: {apart} m");
    }
}

/// What a coordinate weighs was forgotten where a step is looked at again, and its motor held it fast.
#[test]
fn motors_that_count_by_what_they_move_do_so_in_steps_that_are_looked_at_again() {
    for young in [1e6, 1e9] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let root = scene.world.insert_body(RigidBodyBuilder::fixed());
        let arm = link(&mut scene, [0.21, 0.0]);
        let mut joint = hinge(0.0, -0.21);
        joint.set_motor_position(3.0, 50.0, 10.0);
        join(&mut scene, [root, arm], joint);
        pad_on(&mut scene, arm, young, [0.0; 2]);
        let mut most_solves = 0;
        for _ in 0..240 {
            most_solves = most_solves.max(scene.step().n_solves());
        }
        let angle = f64::from(scene.world.bodies[arm].rotation().angle());
        println!("{young:e} Pa: {angle} rad, {most_solves} solves");
        assert!((angle - 3.0).abs() < 0.01, "{young:e} Pa: {angle} rad");
    }
}
