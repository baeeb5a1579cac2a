//! Joints whose ends do not meet when they are made: they close, and nothing is flung by it.

use crate::common::*;

const GAP: f64 = 0.05;

/// What a bar is pinned to from afar.
#[derive(Clone, Copy, Debug)]
enum To {
    World,
    Box,
    Bar,
}

fn bar(young: f64, is_large: bool) -> FlexBodyBuilder {
    let bar = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 2])
        .material(LinearElastic::plane_stress(young, 0.3).density(1000.0));
    match is_large {
        true => bar.large_strain(),
        false => bar.small_strain(),
    }
}

/// A bar and what its left end is pinned to, which is a little away.
fn pinned(to: To, young: f64, is_large: bool, rate: f64) -> (Scene, AttachmentHandle) {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let own = scene.flexible(bar(young, is_large).translation([GAP, -0.05]));
    let pin = AttachmentBuilder::pin(own)
        .where_(|[x, y]| x < 1e-9 && (y - 0.05).abs() < 1e-9)
        .at_point([0.0, 0.0]);
    let pin = match to {
        To::World => pin.to_world(),
        To::Box => {
            let body = RigidBodyBuilder::dynamic().translation(vec2(-0.2, 0.0));
            let shape = ColliderBuilder::cuboid(real(0.2), real(0.05)).density(1000.0);
            let (body, _) = scene.rigid(body, shape);
            pin.to_rigid_body(body).at_point([0.2, 0.0])
        }
        To::Bar => {
            let other = scene.flexible(bar(young, is_large).translation([-1.0, -0.05]));
            pin.to_flexible(other)
        }
    };
    let pin = scene
        .bodies
        .attach(pin, &scene.world.bodies)
        .expect("a node and a place near it");
    (scene, pin)
}

/// Ends that are `d` apart would meet with the speed at which they close, `24 d` a second: with 72 J of 100 kg. They meet without.
#[test]
fn ends_that_were_put_apart_meet_at_rest() {
    for to in [To::World, To::Box, To::Bar] {
        for is_large in [false, true] {
            for (young, rate) in [(1e9, 60.0), (2e11, 60.0), (2e11, 240.0)] {
                let (mut scene, pin) = pinned(to, young, is_large, rate);
                let mut most = 0.0f64;
                for _ in 0..(0.5 * rate) as usize {
                    scene.step();
                    most = most.max(energy_of(&scene));
                }
                let name = format!("{to:?}, large {is_large}, E {young:e}, {rate} Hz");
                let flung = 0.5 * 100.0 * (24.0 * GAP).powi(2);
                println!("{name}: {most} J of {flung}");
                assert!(most < 0.03 * flung, "{name}: {most} J of {flung}");
                let held = scene.bodies.attachment(pin).expect("it is there");
                let end = scene.body(held.body()).position(held.nodes()[0]);
                if let To::World = to {
                    assert!(end[0].hypot(end[1]) < 1e-4, "{name}: {end:?}");
                }
                let momentum = momentum_of(&scene);
                if !matches!(to, To::World) {
                    assert!(
                        momentum[0].hypot(momentum[1]) < 1e-3,
                        "{name}: {momentum:?}"
                    );
                }
                assert!(scene.report().joint_violation() < 1e-3, "{name}");
            }
        }
    }
}

/// The last thing that takes energy from joined bodies: a chain of stiff bars that cracks like a whip has no more of it than gravity has brought.
#[test]
fn a_falling_chain_of_bars_of_small_strain_gains_no_energy() {
    for (young, n, gap) in [
        (2e11, 5, 0.02),
        (1e10, 5, 0.02),
        (2e11, 3, 0.0),
        (2e11, 5, 0.0),
    ] {
        let mut scene = Scene::new(1.0 / 60.0);
        let mut before = None;
        for place in 0..n {
            let x = f64::from(place) * (1.0 + gap);
            let own = FlexBodyBuilder::rectangle([1.0, 0.1], [8, 1])
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
                .small_strain()
                .collision_groups(InteractionGroups::none())
                .translation([x, 0.0]);
            let own = scene.flexible(own);
            let pin = AttachmentBuilder::pin(own).where_(|[x, _]| x < 1e-9);
            let pin = match before.replace(own) {
                None => pin.to_world(),
                Some(other) => pin.to_flexible(other),
            };
            scene
                .bodies
                .attach(pin, &scene.world.bodies)
                .expect("ends that are near each other");
        }
        let start = energy_of(&scene);
        let brought = f64::from(n) * 100.0 * G * 0.5 * f64::from(n);
        for step in 0..300 {
            scene.step();
            let gained = (energy_of(&scene) - start) / brought;
            assert!(
                gained < 0.01,
                "E {young:e}, {n} bars, {gap} m, step {step}: {gained}"
            );
        }
    }
}
