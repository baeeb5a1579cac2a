//! Chains of stiff bars: their welds hold many nodes, which move next to nothing against each other however far they move together.

use crate::common::*;

/// Four bars whose ends are welded to boxes, hinged to each other, that fly apart, freely. What errors of a thousandth of a millimetre in
/// their welds are worth, 1e12 Pa times their squares, is seen in the energy: single steps had gained three times all there was.
#[test]
fn bars_that_nothing_bends_keep_the_energy_of_their_chain() {
    for (young, spins) in [
        (1e11, [4.4, 2.9, 5.1, 3.8]),
        (1e12, [4.4, 2.9, 5.1, 3.8]),
        (1e12, [2.0, -4.0, 5.0, 1.0]),
    ] {
        let (length, thickness, half, apart) = (0.6, 0.1, 0.1, 0.2);
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let mut last = None;
        for (place, spin) in spins.into_iter().enumerate() {
            let begin = (length + 4.0 * half + apart) * place as f64;
            let middle = begin + 2.0 * half + 0.5 * length;
            let knuckles = [begin + half, begin + 3.0 * half + length].map(|x| {
                let body = RigidBodyBuilder::dynamic()
                    .can_sleep(false)
                    .translation(vec2(x, 0.0))
                    .linvel(vec2(0.0, spin * (x - middle)))
                    .angvel(real(spin));
                let shape = ColliderBuilder::cuboid(real(half), real(half));
                scene.rigid(body, shape.density(500.0)).0
            });
            let bar = FlexBodyBuilder::rectangle([length, thickness], [6, 2])
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
                .small_strain()
                .translation([begin + 2.0 * half, -0.5 * thickness])
                .linvel([0.0, -0.5 * spin * length])
                .angvel(spin);
            let bar = scene.flexible(bar);
            for (end, knuckle) in [0.0, length].into_iter().zip(knuckles) {
                let weld = AttachmentBuilder::weld(bar)
                    .where_(move |[x, _]| (x - end).abs() < 1e-6)
                    .to_rigid_body(knuckle);
                scene
                    .bodies
                    .attach(weld, &scene.world.bodies)
                    .expect("a weld of an end");
            }
            if let Some(last) = last {
                let arm = half + 0.5 * apart;
                let hinge = hinge([arm, 0.0], [-arm, 0.0]);
                scene
                    .world
                    .insert_impulse_joint(last, knuckles[0], hinge.build());
            }
            last = Some(knuckles[1]);
        }
        // The first steps make velocities fit the hinges.
        scene.step();
        scene.step();
        let start = energy_of(&scene);
        for step in 2..200 {
            scene.step();
            let now = energy_of(&scene) / start;
            assert!(
                now < 1.0 + 2e-3,
                "{young:e} Pa, step {step}: {now} of the energy"
            );
        }
    }
}
