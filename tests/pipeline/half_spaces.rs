//! Rigid bodies that rapier has let into half-spaces.

use crate::common::{Scene, elastic, vec2};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A ball that rapier has let into a half-space beyond its centre comes out again, also while a flexible body that falls on it makes it ours.
#[test]
fn what_is_in_a_half_space_beyond_its_centre_comes_out() {
    for depth in [0.01, 0.1, 0.3] {
        let mut scene = Scene::new(1.0 / 60.0);
        let ground = SharedShape::halfspace(vec2(0.0, 1.0));
        scene.fixed(ColliderBuilder::new(ground).friction(0.5));
        let ball = RigidBodyBuilder::dynamic().translation(vec2(0.0, -depth));
        let shape = ColliderBuilder::ball(0.2).density(500.0).friction(0.5);
        let (ball, _) = scene.world.insert(ball, shape);
        let block = FlexBodyBuilder::rectangle([0.6, 0.2], [6, 2]);
        let block = block.material(elastic(1e6, 1000.0, 1e-2));
        scene.flexible(block.translation([-0.3, 0.2 - depth + 0.01]));
        let mut height = -depth;
        let mut n_claimed = 0;
        for step in 0..240 {
            scene.step();
            n_claimed += scene.report().n_claimed();
            let before = std::mem::replace(
                &mut height,
                f64::from(scene.world.bodies[ball].translation().y),
            );
            assert!(
                height > before.min(0.0) - 2e-3,
                "from {depth} m deep, step {step}: sinks to {height} m"
            );
        }
        assert!(
            n_claimed > 0 && height > 0.19,
            "from {depth} m deep: {height} m"
        );
    }
}
