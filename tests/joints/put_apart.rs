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

/// An arc of ten links between two posts, at rest, whose hinges are open by less than a millimetre each, as rapier leaves them: together they are open by a tenth
/// of a metre across where the chain is nearly straight. A soft block is near, and touches nothing.
#[test]
fn what_rapier_leaves_open_closes_without_a_bang() {
    const N: usize = 10;
    let mut findings = Findings::default();
    for (ratio, open) in [(0.99, 2e-4), (0.99, 5e-4), (0.99, 9e-4), (0.999, 5e-4)] {
        for rate in [60.0, 240.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            let (length, middle) = (0.9, 0.5 * (N - 1) as f64);
            let gap = ratio * length * N as f64;
            let slope = |turn: f64, k: usize| (k as f64 - middle) * turn;
            let span =
                |turn: f64| -> f64 { (0..N).map(|k| (length + open) * slope(turn, k).cos()).sum() };
            let (mut low, mut high) = (0.0, 0.2);
            for _ in 0..60 {
                let turn = 0.5 * (low + high);
                if span(turn) > gap {
                    low = turn;
                } else {
                    high = turn;
                }
            }
            let post = |x: f64| RigidBodyBuilder::fixed().translation(vec2(x, 0.0));
            let [first, last] = [-0.5 * gap, 0.5 * gap].map(|x| scene.world.insert_body(post(x)));
            let hinge = |from: f64, to: f64| {
                RevoluteJointBuilder::new()
                    .contacts_enabled(false)
                    .local_anchor1(vec2(from, 0.0))
                    .local_anchor2(vec2(to, 0.0))
            };
            let (mut place, mut before, mut lowest) = ([-0.5 * gap, 0.0], first, 0.0_f64);
            for k in 0..N {
                let (sin, cos) = slope(low, k).sin_cos();
                let half = 0.5 * (length + open);
                let at = [place[0] + half * cos, place[1] + half * sin];
                lowest = lowest.min(at[1]);
                place = [at[0] + half * cos, at[1] + half * sin];
                let link = RigidBodyBuilder::dynamic()
                    .translation(vec2(at[0], at[1]))
                    .rotation(real(slope(low, k)));
                let shape = ColliderBuilder::cuboid(real(0.43), real(0.05)).density(300.0);
                let link = scene.rigid(link, shape).0;
                let from = if k > 0 { 0.5 * length } else { 0.0 };
                let hinge = hinge(from, -0.5 * length);
                scene.world.insert_impulse_joint(before, link, hinge);
                before = link;
            }
            scene
                .world
                .insert_impulse_joint(before, last, hinge(0.5 * length, 0.0));
            let block = FlexBodyBuilder::rectangle([0.6, 0.3], [6, 3])
                .material(elastic(3e5, 1000.0, 1e-2))
                .translation([-0.3, lowest + 0.052]);
            scene.flexible(block.friction(0.0));
            let mut most = 0.0_f64;
            for _ in 0..20 {
                scene.try_step().expect("the input is right");
                most = most.max(scene.report().energy().kinetic);
            }
            findings.check(most < 5.0, || {
                format!("{ratio}, {open} m, {rate} Hz: {most} J")
            });
        }
    }
    findings.report();
}
