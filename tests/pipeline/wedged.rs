//! Rigid bodies that stand in each other and cannot part: between walls that are nearer to each other than a box is wide.

use crate::common::{G, Scene, elastic, real, vec2};
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A box of .4 m turned by `turn` (rad) on a floor, between two walls that stand in it by `overlap` (m) each, and a soft block that falls on it.
fn wedged(overlap: f64, turn: f64) -> (Scene, RigidBodyHandle, FlexBodyHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    for side in [-1.0, 1.0] {
        let wall = ColliderBuilder::cuboid(0.5, 0.3);
        let at = vec2(side * (0.7 - overlap), 0.3);
        scene.fixed(wall.translation(at).friction(0.5));
    }
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 0.2))
        .rotation(real(turn));
    let shape = ColliderBuilder::cuboid(0.2, 0.2)
        .density(500.0)
        .friction(0.5);
    let (body, _) = scene.world.insert(body, shape);
    let block = FlexBodyBuilder::rectangle([0.3, 0.2], [4, 3]);
    let block = scene.flexible(
        block
            .material(elastic(1e6, 1000.0, 1e-2))
            .translation([-0.15, 0.45]),
    );
    (scene, body, block)
}

/// Nothing can part them: the box stays where it is held and bears the block, solved in few passes, by forces of the size of weights.
#[test]
fn what_is_wedged_between_walls_stays_and_costs_little() {
    for (overlap, turn) in [
        (0.002, 0.0),
        (0.005, 0.0),
        (0.02, 0.0),
        (0.004, 0.02),
        (0.01, 0.05),
    ] {
        let (mut scene, body, block) = wedged(overlap, turn);
        let what = format!("overlap {overlap}, turned by {turn}");
        let mut began = None;
        for step in 0..180 {
            scene.step();
            let report = scene.report();
            assert_eq!(report.quality(), Quality::Solved, "{what}, step {step}");
            assert!(
                report.n_newton() <= 15,
                "{what}, step {step}: {} passes",
                report.n_newton()
            );
            // rapier shares the overlaps out until the block is near
            let place = scene.world.bodies[body].translation();
            if !report.contacts().is_empty() {
                let from = *began.get_or_insert(place);
                assert!((place - from).length() < 2e-3, "{what}, step {step}");
            }
        }
        let weight = scene.body(block).mass() * G;
        let borne = scene.body(block).total_contact_force()[1];
        assert!((borne / weight - 1.0).abs() < 1e-3, "{what}: {borne} N");
        let [x, y] = scene.body(block).centre_of_mass();
        assert!(x.abs() < 0.02 && (0.48..0.52).contains(&y), "{what}");
    }
}
