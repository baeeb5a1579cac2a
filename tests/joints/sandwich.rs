//! A box between two others that are hinged to each other at a place inside it: what turns the two presses it from both sides.

use crate::common::*;

/// Towers of soft blocks and boxes, a heavy one on top, lean until they fall. The hinge holds with forces that do no work: rows that turn far in a step
/// would, and energy was gained in single parts of a step.
#[test]
fn a_tower_with_a_hinge_across_a_box_falls_without_gaining_energy() {
    let heavy = [800.0, 1890.0, 3000.0];
    let scenes = heavy
        .map(|heavy| [3e4, 1e5, 1e6].map(|soft| [10.0, 37.0].map(|light| (heavy, light, soft))));
    for (heavy, light, soft) in scenes.into_iter().flatten().flatten() {
        let lean = 0.1;
        let mut scene = Scene::new(1.0 / 60.0);
        scene.fixed(ColliderBuilder::cuboid(real(10.0), real(0.5)).translation(vec2(0.0, -0.5)));
        let half = 0.17;
        for k in 0..2 {
            let block = FlexBodyBuilder::rectangle([2.0 * half, 0.34], [3, 3]);
            let block = block.material(elastic(soft, 900.0, 1e-2)).friction(0.6);
            scene.flexible(block.translation([lean * f64::from(k) - half, 0.35 * f64::from(k)]));
        }
        let boxes: Vec<_> = [light, 300.0, heavy]
            .into_iter()
            .zip(0..)
            .map(|(mass, k)| {
                let place = vec2(lean * f64::from(k + 2), 0.7 + 0.345 * f64::from(k) + half);
                let body = RigidBodyBuilder::dynamic().translation(place);
                let shape = ColliderBuilder::cuboid(real(half), real(half)).friction(0.6);
                scene.rigid(body, shape.mass(real(mass))).0
            })
            .collect();
        let at = vec2(3.0 * lean, 0.7 + 0.345 + half);
        let [one, other] = [0, 2].map(|k| at - scene.world.bodies[boxes[k]].translation());
        let hinge = RevoluteJointBuilder::new().local_anchor1(one);
        let hinge = hinge.local_anchor2(other);
        scene.world.insert_impulse_joint(boxes[0], boxes[2], hinge);
        let began = energy_of(&scene);
        let (mut before, mut were_claimed) = (began, false);
        for step in 0..150 {
            scene.try_step().expect("the input is right");
            let energy = energy_of(&scene);
            let name = || format!("{heavy} kg over {light} kg on {soft} Pa, step {step}");
            assert!(energy < 1.01 * began, "{}: {energy} of {began} J", name());
            // What rapier solves alone is not ours.
            let are_claimed = scene.report().n_claimed() == boxes.len();
            if are_claimed && were_claimed {
                let rise = (energy - before) / began;
                assert!(rise < 0.02, "{}: {rise} of {began} J", name());
            }
            (before, were_claimed) = (energy, are_claimed);
        }
        assert!(before < 0.9 * began, "it has fallen: {began} to {before} J");
    }
}
