//! Attachments that contradict each other: a compromise is found between them, and told of; the rest of the body moves as it should.

use crate::common::{Scene, elastic, is_solved, vec2};
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A strip hangs from a weld to the world; a driven body that the same nodes are welded to moves away by 5 mm. No place of the nodes agrees with both.
#[test]
fn a_strip_that_is_welded_to_two_places_hangs_between_them_and_swings() {
    for young in [1e6, 1e8] {
        let mut scene = Scene::new(1.0 / 60.0);
        let strip = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 2])
            .material(elastic(young, 500.0, 1e-3))
            .translation([0.0, 2.0]);
        let strip = scene.flexible(strip);
        let driven = RigidBodyBuilder::kinematic_position_based().translation(vec2(-1.0, 2.05));
        let driven = scene.rigid(driven, ColliderBuilder::ball(0.05)).0;
        let at_end = |[x, _]: [f64; 2]| x < 1e-9;
        let weld = || AttachmentBuilder::weld(strip).where_(at_end);
        for weld in [weld().to_world(), weld().to_rigid_body(driven)] {
            let attached = scene.bodies.attach(weld, &scene.world.bodies);
            attached.expect("nodes and bodies exist");
        }
        let tip = |scene: &Scene| {
            let body = scene.body(strip);
            let last = body.n_nodes() - 1;
            (body.position(last), body.velocities()[2 * last + 1])
        };
        for step in 0..30 {
            let report = scene.try_step().expect("the step can be taken");
            assert!(is_solved(report), "E {young:e}, step {step}");
            assert_eq!(report.joint_violation(), 0.0);
        }
        let away = Pose::new(vec2(-1.005, 2.05), 0.0);
        scene.world.bodies[driven].set_next_kinematic_position(away);
        let mut fastest = 0.0f64;
        for step in 0..120 {
            let report = scene.try_step().expect("the step can be taken");
            let (quality, left) = (report.quality(), report.joint_violation());
            let name = format!("E {young:e}, step {step}: {quality:?}, {left:e} m");
            assert!(quality < Quality::Unfinished, "{name}");
            if step > 10 {
                // What the step began with is no reason to cut it.
                assert_eq!(report.n_parts(), 1, "{name}");
                assert_eq!(quality, Quality::Cut, "{name}");
                // The middle is nearest to both, and asks for a third of what is missing within the step.
                assert!(left > 5e-4 && left < 3e-3, "{name}");
                fastest = fastest.max(tip(&scene).1.abs());
            }
        }
        let start = scene.body(strip).positions()[0];
        assert!((start + 2.5e-3).abs() < 2e-4, "E {young:e}: at {start} m");
        let (at, _) = tip(&scene);
        let sag = 2.1 - at[1];
        println!("E {young:e}: tip at {at:?}, fastest {fastest:e} m/s");
        assert!(fastest > 0.0 && sag > 0.0, "E {young:e}: {at:?}");
    }
}
