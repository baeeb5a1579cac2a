//! Rigid bodies that are put into others which leave them no room.

use crate::common::{Dice, G, Scene, elastic, real, vec2};
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A bin with its inner walls this far from the middle, and a soft block over what is in it.
fn bin(half_width: f64, block: [f64; 2], height: f64) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    let ground = ColliderBuilder::cuboid(10.0, 0.5).translation(vec2(0.0, -0.5));
    scene.fixed(ground.friction(0.5));
    for side in [-1.0, 1.0] {
        let wall = ColliderBuilder::cuboid(0.5, 0.6);
        let place = vec2(side * (half_width + 0.5), 0.6);
        scene.fixed(wall.translation(place).friction(0.5));
    }
    let cells = block.map(|side| (side / 0.1).round() as usize);
    let body = FlexBodyBuilder::rectangle(block, cells).material(elastic(1e6, 1000.0, 1e-2));
    let handle = scene.flexible(body.translation([-0.5 * block[0], height]));
    (scene, handle)
}

/// Neither the overlap nor a tilt leaves a way out: the box stays where it is, and carries what lies on it.
#[test]
fn a_box_that_is_wedged_between_two_walls_rests_there() {
    let cases = [
        (0.001, 0.0),
        (0.02, 0.0),
        (0.005, 0.02),
        (0.002, 0.05),
        (0.01, 0.1),
        (0.005, 0.3),
        (0.003, 0.03),
        (0.003, 0.04),
        (0.008, 0.01),
        (0.015, 0.05),
        (0.004, 0.2),
        (0.001, 0.1),
        (0.01, -0.03),
        (0.006, 0.02),
        (0.007, 0.03),
        (0.004, 0.015),
        (0.009, 0.01),
        (0.012, 0.04),
    ];
    for (overlap, tilt) in cases {
        let (mut scene, block) = bin(0.2 - overlap, [0.3, 0.2], 0.47);
        let wedged = RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.2))
            .rotation(real(tilt));
        let shape = ColliderBuilder::cuboid(0.2, 0.2).density(500.0);
        let (wedged, _) = scene.world.insert(wedged, shape.friction(0.5));
        let name = format!("{overlap} m, {tilt} rad");
        let mut n_passes = 0;
        for step in 0..120 {
            scene.step();
            assert_eq!(scene.report().quality(), Quality::Solved, "{name}, {step}");
            n_passes += scene.report().n_newton();
            assert_eq!(scene.report().n_jammed(), 0, "{name}, {step}");
            let body = &scene.world.bodies[wedged];
            let (place, speed) = (body.translation(), body.linvel().length());
            assert!(
                place.x.abs() < 0.02 && (0.19..0.23).contains(&place.y),
                "{name}, {step}: {place:?}"
            );
            assert!(step < 60 || speed < 0.05, "{name}, {step}: {speed} m/s");
        }
        // Two to four a step, 507 in the case of .01 m and .1 rad.
        assert!(n_passes < 120 * 5, "{name}: {n_passes} passes");
        let top = f64::from(scene.world.bodies[wedged].translation().y) + 0.2;
        let carried = scene.body(block).total_contact_force()[1];
        let weight = 0.3 * 0.2 * 1000.0 * G;
        assert!(
            (carried / weight - 1.0).abs() < 1e-3,
            "{name}: carries {carried} N of {weight} N"
        );
        let height = scene.body(block).centre_of_mass()[1] - top;
        assert!((0.09..0.15).contains(&height), "{name}: {height} m over it");
    }
}

/// Boxes of .34 m, turned at random, 6 cm nearer to each other than they are wide.
#[test]
fn a_crowd_that_is_put_into_itself_comes_apart() {
    for seed in 0..6 {
        let (mut scene, _) = bin(0.5, [0.8, 0.2], 1.3);
        let mut random = Dice(seed);
        let boxes: Vec<_> = (0..9)
            .map(|k| {
                let [column, row] = [k % 3, k / 3].map(f64::from);
                let x = 0.33 * (column - 1.0) + random.between(0.0, 0.02);
                let place = vec2(x, 0.17 + 0.33 * row);
                let body = RigidBodyBuilder::dynamic().translation(place);
                let shape = ColliderBuilder::cuboid(0.17, 0.17).density(500.0);
                let body = body.rotation(real(random.between(-0.3, 0.3)));
                scene.world.insert(body, shape.friction(0.5)).0
            })
            .collect();
        for step in 0..90 {
            scene.step();
            let quality = scene.report().quality();
            assert_eq!(quality, Quality::Solved, "crowd {seed}, step {step}");
            for &body in &boxes {
                let body = &scene.world.bodies[body];
                let (place, speed) = (body.translation(), body.linvel().length());
                assert!(
                    place.x.abs() < 0.5 && (0.1..2.0).contains(&place.y) && speed < 5.0,
                    "crowd {seed}, step {step}: {place:?} at {speed} m/s"
                );
            }
        }
    }
}

/// Two bodies welded to each other, longer together than the bin is wide.
#[test]
fn a_weld_holds_what_is_wedged() {
    let (mut scene, _) = bin(0.39, [0.3, 0.2], 0.6);
    let pair = [-0.2, 0.2].map(|x| {
        let body = RigidBodyBuilder::dynamic().translation(vec2(x, 0.2));
        let shape = ColliderBuilder::cuboid(0.2, 0.15).density(500.0);
        scene.world.insert(body, shape.friction(0.5)).0
    });
    let weld = FixedJointBuilder::new()
        .local_anchor1(vec2(0.2, 0.0))
        .local_anchor2(vec2(-0.2, 0.0));
    scene.world.insert_impulse_joint(pair[0], pair[1], weld);
    // Alone rapier leaves the weld open a little, and it opens no farther; that it cannot close is told.
    let (mut n_passes, mut n_claimed, mut worst) = (0, 0, f64::INFINITY);
    for step in 0..120 {
        scene.try_step().expect("the input is right");
        let told = scene.report().joint_violation();
        let unfinished = scene.report().quality() == Quality::Unfinished;
        assert!(!unfinished && told < 1e-3, "step {step}: {told} m");
        let [one, other] = pair.map(|body| scene.world.bodies[body].translation());
        let apart = f64::from((other - one).length()) - 0.4;
        if scene.report().n_claimed() > 0 {
            n_passes += scene.report().n_newton();
            n_claimed += 1;
            assert!(apart.abs() <= worst + 1e-5, "step {step}: {apart} m apart");
            worst = apart.abs();
        }
    }
    assert!(
        n_claimed > 10 && worst < 1e-3,
        "{n_claimed}: {worst} m apart"
    );
    assert!(n_passes < 8 * n_claimed, "{n_passes} passes");
}

/// Boxes that overlap by a quarter of what they are wide, changed at random between fixed, kinematic and dynamic, and switched off and on: kinematic ones go on
/// as fast as they were, and press others into what is fixed. What cannot get out is pressed, not thrown.
#[test]
fn what_is_changed_into_something_else_among_others_throws_nothing() {
    let types = [
        RigidBodyType::Fixed,
        RigidBodyType::KinematicVelocityBased,
        RigidBodyType::Dynamic,
    ];
    let mut n_jammed = 0;
    for seed in 0..24 {
        let mut random = Dice(seed);
        let mut pick = |n: usize| (random.between(0.0, 1.0) * n as f64) as usize % n;
        let mut scene = Scene::new(1.0 / 60.0);
        let ground = ColliderBuilder::cuboid(10.0, 0.5).translation(vec2(0.0, -0.5));
        scene.fixed(ground.friction(0.5));
        let held = RigidBodyBuilder::dynamic().translation(vec2(1000.0, 0.0));
        let held = held.locked_axes(LockedAxes::all()).additional_mass(1.0);
        let held = scene.world.insert_body(held);
        let block = FlexBodyBuilder::rectangle([0.2, 0.2], [2, 2]);
        let block = block.material(elastic(1e6, 1000.0, 1e-2));
        let block = scene.flexible(block.translation([999.9, 0.5]));
        let weld = AttachmentBuilder::weld(block).where_(|[_, y]| y < 1e-9);
        (scene
            .bodies
            .attach(weld.to_rigid_body(held), &scene.world.bodies))
        .expect("the block has nodes there");
        let boxes: Vec<_> = (0..6)
            .map(|k| {
                let [column, row] = [k % 3, k / 3].map(f64::from);
                let body = RigidBodyBuilder::dynamic();
                let body = body.translation(vec2(0.31 * column, 0.3 + 0.5 * row));
                let shape = ColliderBuilder::cuboid(0.2, 0.2).density(1000.0);
                let (body, _) = scene.world.insert(body, shape);
                // A joint that holds nothing makes all of them part of what is solved.
                let nothing = GenericJointBuilder::new(JointAxesMask::empty());
                scene.world.insert_impulse_joint(held, body, nothing);
                body
            })
            .collect();
        for round in 0..60 {
            let body = &mut scene.world.bodies[boxes[pick(6)]];
            if round % 2 == 0 {
                body.set_body_type(types[pick(3)], true);
            } else {
                body.set_enabled(!body.is_enabled());
            }
            for _ in 0..2 {
                scene.try_step().expect("the input is right");
                n_jammed += scene.report().n_jammed();
                for &body in &boxes {
                    let speed = scene.world.bodies[body].linvel().length();
                    assert!(speed < 10.0, "seed {seed}, round {round}: {speed} m/s");
                }
            }
        }
    }
    assert!(n_jammed > 0, "none of them jams");
}

/// Steel that lands and rests: nothing is driven, and its surface without mass moves by more than its kinetic energy tells.
#[test]
fn what_lands_and_rests_is_not_jammed() {
    for n in [1, 5] {
        for height in [0.0, 0.3] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            for k in 0..n {
                let plate = FlexBodyBuilder::rectangle([0.4, 0.2], [8, 4])
                    .material(elastic(2.1e11, 7800.0, 1e-4))
                    .translation([0.0, height + 0.2 * f64::from(k)])
                    .friction(0.5)
                    .small_strain();
                scene.flexible(plate.can_sleep(false));
            }
            for step in 0..240 {
                scene.step();
                let jammed = scene.report().n_jammed();
                assert_eq!(jammed, 0, "{n} from {height} m, step {step}");
            }
        }
    }
}
