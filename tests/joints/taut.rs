//! Chains that are as long as what they hang between is apart, or a little shorter.

use crate::common::*;
use foil2d::pipeline::Quality;

/// Planks from one post to the other, and half their length (m).
const N: usize = 8;
const HALF: f64 = 0.15;

/// Planks between posts that are farther apart than these are long, by `short` (m); a soft block and a ball over them.
fn bridge(short: f64) -> (Scene, Vec<RigidBodyHandle>, f64) {
    let mut scene = Scene::new(1.0 / 60.0);
    let end = HALF * N as f64 + 0.5 * short;
    let posts = [-end, end].map(|x| RigidBodyBuilder::fixed().translation(vec2(x, 1.0)));
    let [left, right] = posts.map(|post| scene.world.insert_body(post));
    let mut bodies = vec![left];
    for k in 0..N {
        let x = HALF * (2.0 * k as f64 + 1.0 - N as f64);
        let plank = RigidBodyBuilder::dynamic().translation(vec2(x, 1.0));
        let shape = ColliderBuilder::cuboid(real(0.14), real(0.03)).density(700.0);
        bodies.push(scene.world.insert(plank, shape.friction(0.6)).0);
    }
    bodies.push(right);
    for k in 0..=N {
        let [one, other] = anchors(k);
        let hinge = RevoluteJointBuilder::new().contacts_enabled(false);
        let hinge = hinge.local_anchor1(one).local_anchor2(other);
        scene
            .world
            .insert_impulse_joint(bodies[k], bodies[k + 1], hinge);
    }
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]).material(elastic(3e5, 1000.0, 1e-2));
    scene.flexible(block.friction(0.6).translation([-0.3, 1.2]));
    let ball = RigidBodyBuilder::dynamic().translation(vec2(0.4, 1.5));
    scene
        .world
        .insert(ball, ColliderBuilder::ball(0.15).density(800.0));
    (scene, bodies, end)
}

/// Where the `k`-th hinge is on the two bodies it joins.
fn anchors(k: usize) -> [Vector; 2] {
    [(k > 0, HALF), (k < N, -HALF)].map(|(is_plank, x)| vec2(if is_plank { x } else { 0.0 }, 0.0))
}

/// How far the ends at every hinge are apart, together (m).
fn openings(scene: &Scene, bodies: &[RigidBodyHandle]) -> f64 {
    let hinges = (0..=N).map(|k| {
        let [one, other] = anchors(k);
        let place = |body: usize, anchor| {
            let body = &scene.world.bodies[bodies[body]];
            body.position().transform_point(anchor)
        };
        f64::from((place(k, one) - place(k + 1, other)).length())
    });
    hinges.sum()
}

/// What could hold such a bridge straight are forces without bound: it sags by some hundredths of its length, or opens where it is too short, and is told so.
#[test]
fn a_bridge_that_is_just_too_short_hangs() {
    for short in [-0.01, -1e-3, -1e-4, 0.0, 1e-4, 1e-3, 0.01, 0.05] {
        let (mut scene, bodies, end) = bridge(short);
        let before = energy_of(&scene);
        let (mut n_passes, mut told) = (0, 0.0f64);
        for step in 0..300 {
            scene.try_step().expect("the input is right");
            let report = scene.report();
            let quality = report.quality();
            assert_ne!(quality, Quality::Unfinished, "{short} m, {step}");
            n_passes += report.n_newton();
            if step >= 240 {
                told = told.max(report.joint_violation());
            }
            let energy = energy_of(&scene);
            assert!(
                energy < 1.01 * before,
                "{short} m, {step}: {energy} J of {before}"
            );
        }
        assert!(n_passes < 300 * 8, "{short} m: {n_passes} passes");
        let middle = f64::from(scene.world.bodies[bodies[N / 2]].translation().y);
        let open = openings(&scene, &bodies);
        // A taut string with all its load in the middle would be there.
        let sag = ((HALF * N as f64 + 0.5 * open).powi(2) - end * end).max(0.0);
        println!("{short} m: {middle} m high, {open} m open, told {told} m");
        assert!(
            1.0 - middle < sag.sqrt() + 0.01 && middle < 1.0,
            "{short} m: {middle}"
        );
        assert!(
            open >= short && open < short.max(0.0) + 2e-3,
            "{short} m: {open} m open"
        );
        if short < -5e-4 {
            assert!(open < 1e-4 && told == 0.0, "{short} m: {open}, told {told}");
        }
        if short >= 1e-3 {
            assert!(told > short / N as f64 * 0.5, "{short} m: told {told} m");
        }
    }
}

/// A straight chain of `n` planks of 0.3 m and 13 kg between two posts, as links or on impulse joints; the planks.
fn straight(scene: &mut Scene, n: usize, are_links: bool) -> Vec<RigidBodyHandle> {
    let end = HALF * n as f64;
    let posts = [-end, end].map(|x| RigidBodyBuilder::fixed().translation(vec2(x, 1.0)));
    let [left, right] = posts.map(|post| scene.world.insert_body(post));
    let mut last = left;
    let mut planks = Vec::new();
    let hinge = |from: f64, to: f64| {
        RevoluteJointBuilder::new()
            .contacts_enabled(false)
            .local_anchor1(vec2(from, 0.0))
            .local_anchor2(vec2(to, 0.0))
    };
    for k in 0..n {
        let x = HALF * (2.0 * k as f64 + 1.0) - end;
        let plank = RigidBodyBuilder::dynamic().translation(vec2(x, 1.0));
        let shape = ColliderBuilder::cuboid(0.13, 0.05).mass(13.0).friction(0.6);
        let plank = scene.rigid(plank, shape).0;
        let joint = hinge(if k > 0 { HALF } else { 0.0 }, -HALF);
        if are_links {
            let joints = &mut scene.world.multibody_joints;
            joints.insert(last, plank, joint, true).expect("a joint");
        } else {
            scene.world.impulse_joints.insert(last, plank, joint, true);
        }
        planks.push(plank);
        last = plank;
    }
    let joints = &mut scene.world.impulse_joints;
    joints.insert(last, right, hinge(HALF, 0.0), true);
    planks
}

/// Posts that draw a chain out pull its hinges open by forces without bound: what is open is told.
#[test]
fn a_chain_that_is_drawn_apart_is_told_open() {
    let mut findings = Findings::default();
    for is_small in [false, true] {
        for rate in [60.0, 240.0] {
            let mut scene = Scene::new(1.0 / rate);
            let planks = straight(&mut scene, 5, false);
            pad_on(&mut scene, planks[2], [0.0, 1.0], is_small);
            let joints = &scene.world.impulse_joints;
            let last = joints.iter().find(|(_, joint)| joint.body1() == planks[4]);
            let right = last.map(|(_, joint)| joint.body2()).expect("a post");
            let post = &mut scene.world.bodies[right];
            post.set_body_type(RigidBodyType::KinematicVelocityBased, true);
            post.set_linvel(vec2(0.02, 0.0), true);
            for _ in 0..(0.5 * rate) as usize {
                scene.try_step().expect("the input is right");
            }
            let world = &scene.world;
            let open = world.impulse_joints.iter().map(|(_, joint)| {
                let [one, other] = [joint.body1(), joint.body2()].map(|body| &world.bodies[body]);
                let one = one.position() * joint.data.local_anchor1();
                let other = other.position() * joint.data.local_anchor2();
                f64::from((one - other).length())
            });
            let open: Vec<f64> = open.collect();
            let (most, all) = (
                open.iter().copied().fold(0.0, f64::max),
                open.iter().sum::<f64>(),
            );
            let report = scene.report();
            let (told, quality) = (report.joint_violation(), report.quality());
            let is_told = quality != Quality::Solved && (told - most).abs() < 0.02 * most;
            findings.check(is_told && (all - 0.01).abs() < 2e-4, || {
                format!("small {is_small}, {rate} Hz: {quality:?}, told {told}, open {open:?}")
            });
        }
    }
    findings.report();
}

/// What makes a chain ours, and weighs next to nothing, on a plank.
fn pad_on(scene: &mut Scene, plank: RigidBodyHandle, [x, y]: [f64; 2], is_small: bool) {
    let pad = FlexBodyBuilder::rectangle([0.05, 0.05], [1, 1])
        .material(elastic(1e6, 1.0, 1e-2))
        .collision_groups(InteractionGroups::none())
        .translation([x - 0.025, y]);
    let pad = if is_small { pad.small_strain() } else { pad };
    let pad = scene.flexible(pad);
    let weld = AttachmentBuilder::weld(pad).where_(|_| true);
    let attached = scene
        .bodies
        .attach(weld.to_rigid_body(plank), &scene.world.bodies);
    attached.expect("all nodes of the pad");
}

/// Nothing holds a straight chain but forces without bound, and what it may sag by is less than any step moves it by. Half of such steps were
/// unfinished, and some gave many times the energy that was there.
#[test]
fn straight_bridges_carry_what_falls_onto_them() {
    let mut findings = Findings::default();
    for n in [3, 7, 10] {
        for young in [1e5, 1e7] {
            for is_small in [false, true] {
                for (rate, are_links) in [(60.0, false), (240.0, true), (60.0, true)] {
                    let mut scene = Scene::new(1.0 / rate);
                    let planks = straight(&mut scene, n, are_links);
                    let block = FlexBodyBuilder::rectangle([0.4, 0.3], [4, 3])
                        .material(elastic(young, 500.0, 1e-3))
                        .friction(0.6)
                        .translation([-0.2, 1.06]);
                    let block = if is_small {
                        block.small_strain()
                    } else {
                        block
                    };
                    scene.flexible(block);
                    let before = energy_of(&scene);
                    let (mut most, mut n_unsolved) = (0.0f64, 0);
                    for _ in 0..rate as usize {
                        let report = scene.try_step().expect("the input is right");
                        n_unsolved += usize::from(report.quality() != Quality::Solved);
                        most = most.max(energy_of(&scene));
                    }
                    let sag = 1.0 - f64::from(scene.world.bodies[planks[n / 2]].translation().y);
                    let is_right = n_unsolved == 0 && most < 1.001 * before && sag < 0.02;
                    findings.check(is_right, || {
                        format!(
                            "{n} planks, {young:e} Pa, small {is_small}, {rate} Hz, links {are_links}: {n_unsolved} steps unsolved, {most} J of {before}, sags by {sag}"
                        )
                    });
                }
            }
        }
    }
    findings.report();
}

/// Hinges open by `T c`, with `c = s dt² / 2 M` and `s = 1e-5`, so that planks of length `l` stand aslant where `T³ = l (m g)² n (n - 1) / 24 c`: the moments
/// about each hinge give slopes of `m g ((n + 1) / 2 - i) / T`, and their squares over two are what is open.
#[test]
fn a_straight_chain_sags_by_what_its_joints_yield() {
    for (n, dt, is_small) in [
        (4, 1.0 / 60.0, false),
        (4, 1.0 / 60.0, true),
        (10, 1.0 / 60.0, false),
        (10, 1.0 / 240.0, true),
    ] {
        let mut scene = Scene::new(dt);
        let planks = straight(&mut scene, n, false);
        let x = HALF * (2 - n % 2) as f64;
        pad_on(&mut scene, planks[n / 2], [x, 1.0], is_small);
        for &plank in &planks {
            scene.world.bodies[plank].set_linear_damping(5.0);
        }
        for _ in 0..(4.0 / dt) as usize {
            scene.step();
        }
        let (mass, count) = (13.0, n as f64);
        let compliance = 1e-5 * dt * dt / (2.0 * mass * count);
        let length = 2.0 * HALF;
        let cube = length * (mass * G).powi(2) * count * (count - 1.0) / (24.0 * compliance);
        let tension = cube.cbrt();
        let slopes = (1..=n / 2).map(|i| mass * G * ((count + 1.0) / 2.0 - i as f64) / tension);
        let expected = length * slopes.sum::<f64>();
        let body = &scene.world.bodies[planks[n / 2]];
        let end = body.position().transform_point(vec2(-HALF, 0.0));
        let sag = 1.0 - f64::from(end.y);
        println!("{n} planks, {dt} s: {sag} m, {expected} m");
        let tolerance = by_precision(0.05, 0.01);
        assert!(
            (sag - expected).abs() < tolerance * expected,
            "{n} planks, {dt} s: {sag} m, not {expected}"
        );
    }
}
