//! Hinged rigid bodies: period, energy, closure.

use crate::common::*;
use crate::support::*;

/// Period of a pendulum that swings by `amplitude`, from that of small swings, by the arithmetic-geometric mean.
fn period_at(amplitude: f64, small: f64) -> f64 {
    let (mut a, mut g) = (1.0f64, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    small / a
}

#[test]
fn a_compound_pendulum_has_its_exact_period_and_keeps_its_swing() {
    // A rod of 1 m hinged at its end, released at 60 degrees.
    //   T0 = 2π √(2L/3g); T by the arithmetic-geometric mean.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let amplitude = std::f64::consts::FRAC_PI_3;
    let [sin, cos] = [amplitude.sin(), amplitude.cos()];
    let rod = free_body(&mut scene, [0.5 * sin, -0.5 * cos], 1.0, 1.0 / 12.0);
    scene.world.bodies[rod].set_rotation(Rotation::new(real(amplitude)), true);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(0.0, 0.5));
    join(&mut scene, anchor, rod, hinge);
    let exact = period_at(amplitude, std::f64::consts::TAU * (2.0 / (3.0 * G)).sqrt());
    let (mut crossings, mut last, mut time) = (Vec::new(), amplitude, 0.0);
    let mut largest = 0.0f64;
    while crossings.len() < 41 {
        scene.step();
        time += DT;
        let now = angle(&scene, rod);
        if now < 0.0 && last >= 0.0 {
            crossings.push(time - DT * now / (now - last));
        }
        if crossings.len() > 39 {
            largest = largest.max(now.abs());
        }
        last = now;
        assert!(time < 100.0, "it no longer swings");
    }
    let period = (crossings[40] - crossings[0]) / 40.0;
    println!(
        "period {period} exact {exact} error {:e} swing {largest} of {amplitude}",
        period / exact - 1.0
    );
    assert!((period / exact - 1.0).abs() < 1e-4);
    assert!((largest / amplitude - 1.0).abs() < 1e-3);
}

#[test]
fn a_four_bar_linkage_stays_closed_and_keeps_its_energy() {
    // Crank 0.5 m, coupler 1.5 m and rocker 1 m on a base of 1.6 m: three bars, four hinges, one degree of freedom.
    //      B ___________ C
    //     /             /
    //    A             D
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let (a, d) = ([0.0, 0.0], [1.6, 0.0]);
    let b = [0.0, 0.5];
    // C is 1.5 m from B and 1 m from D.
    let (dx, dy): (f64, f64) = (d[0] - b[0], d[1] - b[1]);
    let base = dx.hypot(dy);
    let along: f64 = (1.5 * 1.5 - 1.0 + base * base) / (2.0 * base);
    let above = f64::sqrt(1.5 * 1.5 - along * along);
    let c = [
        b[0] + (along * dx - above * dy) / base,
        b[1] + (along * dy + above * dx) / base,
    ];
    let ends = [(a, b), (b, c), (c, d)];
    let bars = ends.map(|(from, to)| bar(&mut scene, from, to));
    let lengths = ends.map(|(from, to)| (to[0] - from[0]).hypot(to[1] - from[1]));
    join(
        &mut scene,
        anchor,
        bars[0],
        hinge(a, [-0.5 * lengths[0], 0.0]),
    );
    join(
        &mut scene,
        bars[0],
        bars[1],
        hinge([0.5 * lengths[0], 0.0], [-0.5 * lengths[1], 0.0]),
    );
    join(
        &mut scene,
        bars[1],
        bars[2],
        hinge([0.5 * lengths[1], 0.0], [-0.5 * lengths[2], 0.0]),
    );
    join(
        &mut scene,
        bars[2],
        anchor,
        hinge([0.5 * lengths[2], 0.0], d),
    );
    // Between two bodies the local frames are rapier's numbers: compare what they say.
    let mut open = 0.0f64;
    let energy = |scene: &Scene| -> f64 {
        bars.iter()
            .map(|&bar| {
                let body = &scene.world.bodies[bar];
                f64::from(body.kinetic_energy()) + scene.mass(bar) * G * position(scene, bar)[1]
            })
            .sum()
    };
    scene.step();
    let start = energy(&scene);
    let (mut low, mut high) = (start, start);
    for _ in 0..1200 {
        scene.step();
        for (_, joint) in scene.world.impulse_joints.iter() {
            open = open.max(gap(&scene, joint));
        }
        let now = energy(&scene);
        (low, high) = (low.min(now), high.max(now));
    }
    println!("open by {open:e}; energy {start} in [{low}, {high}]");
    // Rapier's own poses in f32 hold 1e-7 of the coordinates; forces of some times the weight open joints by 1e-5 of the fall in a step each.
    let opened = 10.0 * 1e-5 * 0.5 * G * scene.dt().powi(2);
    assert!(open < by_precision(2e-6, opened));
    // RATTLE's energy swings by (ω dt)² of the kinetic energy, some 5 J, and does not drift: ω of the crank is 10 rad/s.
    assert!(high - low < 0.1, "energy moved by {}", high - low);
}

/// A bar of 1 kg/m between two points, its axis along the body's x.
fn bar(scene: &mut Scene, from: [f64; 2], to: [f64; 2]) -> RigidBodyHandle {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    let at = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
    let body = free_body(scene, at, length, length.powi(3) / 12.0);
    scene.world.bodies[body].set_rotation(Rotation::new(real(dy.atan2(dx))), true);
    body
}

#[test]
fn free_bodies_joined_together_keep_momentum_and_angular_momentum() {
    let mut scene = Scene::in_free_space(DT);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.5, 0.5], [2, 2])
            .material(LinearElastic::plane_stress(1e6, 0.3).density(100.0))
            .linvel([0.4, -0.1]),
    );
    let handles: Vec<RigidBodyHandle> = (0..4)
        .map(|i| {
            let (body, _) = scene.rigid(
                RigidBodyBuilder::dynamic()
                    .translation(vec2(1.0 + i as f64, 0.1 * i as f64))
                    .linvel(vec2(-0.5 + 0.2 * i as f64, 0.3 - 0.1 * i as f64))
                    .angvel(real(1.0)),
                ColliderBuilder::cuboid(0.25, 0.2).density(50.0),
            );
            body
        })
        .collect();
    for (pair, slope) in handles.windows(2).zip([0.05, 0.05, 0.05]) {
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(0.5, slope))
            .local_anchor2(vec2(-0.5, -slope))
            .contacts_enabled(false);
        join(&mut scene, pair[0], pair[1], hinge);
    }
    let total = |scene: &Scene| {
        let mut sum = [0.0; 3];
        let (momentum, spin) = (scene.report().momentum(), scene.report().angular_momentum());
        sum[0] += momentum[0];
        sum[1] += momentum[1];
        sum[2] += spin;
        sum
    };
    // The block runs into the first of them.
    while scene.step().n_claimed() < 4 {}
    let start = total(&scene);
    let (mut worst, mut n_steps) = ([0.0f64; 3], 0);
    for _ in 0..600 {
        scene.step();
        if scene.report().n_claimed() < 4 {
            break;
        }
        n_steps += 1;
        let now = total(&scene);
        for axis in 0..3 {
            worst[axis] = worst[axis].max((now[axis] - start[axis]).abs());
        }
    }
    println!(
        "{start:?} {worst:?} {n_steps} {:?}",
        scene.body(block).velocities()[0]
    );
    assert!(n_steps > 50, "they part too soon to tell");
    let size = start.iter().fold(0.0f64, |size, p| size.max(p.abs()));
    // Momentum is exact to rounding; in f32 worlds velocities are handed through rapier's precision while nothing touches.
    assert!(
        worst
            .iter()
            .all(|off| *off < by_precision(1e-5, 1e-10) * size)
    );
}
