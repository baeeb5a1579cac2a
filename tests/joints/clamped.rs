//! What a weld clamps between two rigid places.

use crate::common::*;

/// A box lies on another one that a block is welded to, which lies on both: the weld and the contacts of the box between contradict each other by what
/// they overlap, as much as rapier rounds, however long the step is. None is taken in parts for that.
#[test]
fn what_contradicts_itself_by_rounding_is_not_cut_for_it() {
    for overlap in [3e-8, 1e-7] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        let soft = FlexBodyBuilder::rectangle([0.51, 0.38], [4, 3])
            .material(elastic(3e5, 600.0, 0.0))
            .translation([-0.255, 0.0]);
        scene.flexible(soft);
        let mut stone = |y: f64, half: f64| {
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, y));
            let shape = ColliderBuilder::cuboid(0.255, real(half)).density(2000.0);
            scene.world.insert(body, shape).0
        };
        let below = stone(0.38 + 0.153, 0.153);
        stone(0.38 + 0.306 + 0.217 - overlap, 0.217);
        let stiff = FlexBodyBuilder::rectangle([0.51, 0.39], [4, 4])
            .material(elastic(6e7, 800.0, 2e-4))
            .translation([-0.255, 0.38 + 0.306 + 0.434 - 2.0 * overlap]);
        let stiff = scene.flexible(stiff);
        let nodes = scene.body(stiff).mesh().nodes();
        let left = (0..nodes.len()).filter(|&node| nodes[node][0] == 0.0);
        let weld = AttachmentBuilder::weld(stiff).nodes(left.take(3).collect::<Vec<_>>());
        let weld = weld.to_rigid_body(below);
        let attached = scene.bodies.attach(weld, &scene.world.bodies);
        attached.expect("the description is right");
        for step in 0..60 {
            let report = scene.step();
            assert!(is_solved(report), "step {step}, {overlap} m");
            assert_eq!(report.n_parts(), 1, "step {step}, {overlap} m");
        }
    }
}
