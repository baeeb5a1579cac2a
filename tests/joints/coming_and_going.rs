//! Joints that come, go, are switched off, or lead to bodies that do.

use crate::common::*;
use crate::support::*;
use foil2d::pipeline::StepError;

#[test]
fn joints_can_be_removed_disabled_and_lose_their_bodies_between_steps() {
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let first = free_body(&mut scene, [0.5, 0.0], 1.0, 0.1);
    let second = free_body(&mut scene, [1.5, 0.0], 1.0, 0.1);
    let third = free_body(&mut scene, [2.5, 0.0], 1.0, 0.1);
    join(&mut scene, anchor, first, hinge([0.0, 0.0], [-0.5, 0.0]));
    let middle = join(&mut scene, first, second, hinge([0.5, 0.0], [-0.5, 0.0]));
    let outer = join(&mut scene, second, third, hinge([0.5, 0.0], [-0.5, 0.0]));
    scene.steps(30);
    assert_eq!(scene.report().n_claimed(), 4);
    assert_eq!(scene.report().joints().len(), 3);
    // Switched off, the outer body is rapier's again, and falls with rapier's own step.
    let joint = scene
        .world
        .impulse_joints
        .get_mut(outer, true)
        .expect("it lives");
    joint.data.set_enabled(false);
    let before = f64::from(scene.world.bodies[third].linvel().y);
    scene.steps(30);
    assert_eq!(scene.report().n_claimed(), 3);
    let fallen = f64::from(scene.world.bodies[third].linvel().y) - before;
    assert!((fallen + 30.0 * DT * G).abs() < 1e-3 * G, "{fallen}");
    // Switched on again where it no longer fits, it closes within some steps and throws nothing away.
    let joint = scene
        .world
        .impulse_joints
        .get_mut(outer, true)
        .expect("it lives");
    joint.data.set_enabled(true);
    scene.steps(60);
    let joint = scene.world.impulse_joints.get(outer).expect("it lives");
    assert!(gap(&scene, joint) < 1e-5, "open by {}", gap(&scene, joint));
    let speed = f64::from(scene.world.bodies[third].linvel().length());
    assert!(speed < 20.0, "flung at {speed} m/s");
    // A body goes, and its joints with it.
    scene.world.remove_body(second);
    scene.steps(5);
    assert!(scene.world.impulse_joints.get(middle).is_none());
    assert_eq!(scene.report().joints().len(), 1);
}

#[test]
fn a_joint_to_a_carrier_is_refused_and_nothing_moves() {
    let mut scene = Scene::new(DT);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.25, 0.25], [1, 1])
            .material(LinearElastic::plane_stress(1e6, 0.3).density(100.0)),
    );
    let ball = free_body(&mut scene, [1.0, 0.0], 1.0, 0.1);
    let carrier = scene.body(block).rigid_body_handle();
    let joint = join(&mut scene, carrier, ball, hinge([0.25, 0.0], [-0.75, 0.0]));
    let before = scene.body(block).position(0);
    assert_eq!(
        scene.try_step().expect_err("it is refused"),
        StepError::CarrierJoint(joint)
    );
    assert_eq!(scene.body(block).position(0), before);
    scene.world.impulse_joints.remove(joint, true);
    scene.steps(10);
}

#[test]
fn a_joint_with_numbers_that_are_not_finite_is_refused_by_name() {
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let ball = free_body(&mut scene, [1.0, 0.0], 1.0, 0.1);
    let joint = join(&mut scene, anchor, ball, hinge([0.0, 0.0], [-1.0, 0.0]));
    scene.steps(3);
    let data = scene
        .world
        .impulse_joints
        .get_mut(joint, true)
        .expect("it lives");
    data.data.local_frame2.translation.x = foil2d::rapier::math::Real::NAN;
    let refused = scene.try_step().map(|_| ());
    // Rapier may take a body with such a joint out of the world first.
    assert!(
        refused == Err(StepError::Joint(joint)) || refused.is_ok(),
        "{refused:?}"
    );
}

#[test]
fn joints_that_contradict_each_other_are_averaged() {
    // One ball on two hinges 0.1 m apart: it stays in the middle and nothing is flung.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let ball = free_body(&mut scene, [0.0, 0.0], 1.0, 0.1);
    join(&mut scene, anchor, ball, hinge([-0.05, 0.0], [0.0, 0.0]));
    join(&mut scene, anchor, ball, hinge([0.05, 0.0], [0.0, 0.0]));
    for _ in 0..240 {
        scene.try_step().expect("it can be taken");
    }
    let [x, y] = position(&scene, ball);
    assert!(x.abs() < 1e-3 && y.abs() < 1e-3, "{x} {y}");
}

#[test]
fn a_closed_frame_of_welds_hangs_still() {
    // Four bars welded into a square: nine dofs too few for twelve rows of welds, and one more to hang it by.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let places = [[0.0, -0.0], [0.5, -0.5], [0.0, -1.0], [-0.5, -0.5]];
    let bars = places.map(|at| free_body(&mut scene, at, 1.0, 0.1));
    for i in 0..4 {
        let (a, b) = (places[i], places[(i + 1) % 4]);
        let half = [0.5 * (b[0] - a[0]), 0.5 * (b[1] - a[1])];
        let weld = FixedJointBuilder::new()
            .local_anchor1(vec2(half[0], half[1]))
            .local_anchor2(vec2(-half[0], -half[1]));
        join(&mut scene, bars[i], bars[(i + 1) % 4], weld);
    }
    join(&mut scene, anchor, bars[0], hinge([0.0, 0.0], [0.0, 0.0]));
    scene.steps(600);
    for (bar, at) in bars.iter().zip(places) {
        let [x, y] = position(&scene, *bar);
        // The weight of all opens the hinge by 1e-5 of its fall in a step, that of some the welds by less.
        let opened = 1e-5 * 0.5 * G * DT * DT;
        let missed = (x - at[0]).hypot(y - at[1]);
        assert!(missed < by_precision(1e-5, 3.0 * opened), "{x} {y}");
    }
    let hung = scene
        .report()
        .joints()
        .iter()
        .map(|joint| joint.force[1])
        .fold(0.0, f64::max);
    assert!(
        (hung / (4.0 * G) - 1.0).abs() < by_precision(1e-4, 1e-9),
        "{hung}"
    );
}

#[test]
fn the_order_of_insertion_changes_no_bit() {
    let run = |order: [usize; 3]| {
        let mut scene = Scene::new(DT);
        let anchor = claimed_anchor(&mut scene);
        let mut bodies = [RigidBodyHandle::invalid(); 3];
        for &i in &order {
            bodies[i] = free_body(&mut scene, [0.5 + i as f64, 0.1 * i as f64], 1.0, 0.1);
        }
        let joints = [
            (anchor, bodies[0], hinge([0.0, 0.0], [-0.5, 0.0])),
            (bodies[0], bodies[1], hinge([0.5, 0.05], [-0.5, -0.05])),
            (bodies[1], bodies[2], hinge([0.5, 0.05], [-0.5, -0.05])),
        ];
        for &i in &order {
            let (one, other, joint) = joints[i];
            join(&mut scene, one, other, joint);
        }
        scene.steps(240);
        bodies.map(|body| position(&scene, body))
    };
    let first = run([0, 1, 2]);
    for order in [[2, 1, 0], [1, 2, 0]] {
        assert_eq!(run(order), first);
    }
}

#[test]
fn a_body_on_a_multibody_link_moves_with_it() {
    // A link of a multibody stays rapier's: its joint to a claimed body is held at the link's prescribed motion.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let link = free_body(&mut scene, [0.5, 0.0], 5.0, 0.5);
    scene
        .world
        .multibody_joints
        .insert(base, link, hinge([0.0, 0.0], [-0.5, 0.0]), true);
    let ball = free_body(&mut scene, [1.0, -0.5], 0.1, 0.01);
    join(&mut scene, link, ball, hinge([0.5, 0.0], [0.0, 0.5]));
    let tie = SpringJointBuilder::new(1.0, 1.0, 0.0);
    join(&mut scene, anchor, ball, tie);
    for _ in 0..240 {
        scene.step();
        let joints = scene.world.impulse_joints.iter();
        let hinged = joints
            .map(|(_, joint)| joint)
            .find(|joint| joint.body1() == link);
        let open = hinged.map_or(0.0, |joint| gap(&scene, joint));
        // One step of the link's acceleration, g dt²/2 and more: it is met where it was foreseen.
        assert!(open < 5e-3, "open by {open}");
    }
}

#[test]
fn a_sleeper_that_hangs_on_a_body_without_colliders_falls_when_that_is_removed() {
    let mut scene = Scene::new(DT);
    let hook = scene.world.insert_body(RigidBodyBuilder::fixed());
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.25, 0.25], [2, 2]).material(elastic(1e7, 1000.0, 2e-2)),
    );
    let weld = AttachmentBuilder::weld(block).where_(|[_, y]| y > 0.24);
    let weld = weld.to_rigid_body(hook);
    let weld = scene
        .bodies
        .attach(weld, &scene.world.bodies)
        .expect("the description is right");
    scene.steps(240);
    let carrier = scene.body(block).rigid_body_handle();
    scene.world.bodies[carrier].sleep();
    scene.steps(2);
    assert_eq!(scene.report().n_asleep(), 1, "it sleeps");
    scene.world.remove_body(hook);
    scene.steps(30);
    assert!(scene.bodies.attachment(weld).is_err());
    let fallen = scene.body(block).linvel()[1] / (30.0 * DT * G);
    // Free fall, from the first step or the second: one in thirty. What rings keeps the momentum.
    assert!((fallen + 1.0).abs() < 0.05, "{fallen}");
}
