//! Coulomb friction: slopes, stops, creep and rolling.

mod common;

use common::*;

/// Gravity turned by `angle`, so that the ground `y = 0` is an incline falling towards +x.
fn incline(angle: f64, dt: f64, mu: f64) -> Scene {
    let mut scene = Scene::new(dt).with_gravity(G * angle.sin(), -G * angle.cos());
    scene.ground(mu);
    scene
}

fn block(young: f64, mu: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 0.5], [8, 8])
        .material(elastic(young, 1000.0, 1e-3))
        .friction(mu)
}

/// Steps `n` times; returns the largest excess over the friction cone and the largest overlap.
fn watch(scene: &mut Scene, n: usize) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    for _ in 0..n {
        let report = scene.step();
        worst[0] = worst[0].max(report.cone_residual());
        worst[1] = worst[1].max(report.gap_violation());
    }
    worst
}

fn assert_lawful([cone, gap]: [f64; 2]) {
    assert!(cone <= 1e-9, "friction exceeds its cone by {cone:e}");
    let tolerance = by_precision(1e-6, 1e-9);
    assert!(gap <= tolerance, "the bodies overlap by {gap:e} m");
}

#[test]
fn a_block_slides_down_a_steep_incline_as_a_point_mass_does() {
    // B17: s = ½ g (sin α - μ cos α) t².
    let cases = [
        (1e6, 60.0),
        (1e8, 60.0),
        (1e8, 240.0),
        (2e11, 60.0),
        (2e11, 1000.0),
    ];
    for (young, rate) in cases {
        for (angle, mu) in [(0.5f64, 0.3), (0.3, 0.0)] {
            let mut scene = incline(angle, 1.0 / rate, mu);
            let body = scene.flexible(block(young, mu).translation([-45.0, 0.0]));
            let start = scene.body(body).centre_of_mass()[0];
            let lawful = watch(&mut scene, (2.0 * rate) as usize);
            assert_lawful(lawful);
            let t = 2.0;
            let exact = 0.5 * G * (angle.sin() - mu * angle.cos()) * t * t;
            let way = scene.body(body).centre_of_mass()[0] - start;
            // The unstrained start presses with twice the weight in its first step: one step of friction too much. The
            // softest block sways by its squeeze of 5 mm besides.
            let allowed = mu * G * scene.dt() * t + if young < 1e7 { 1e-2 } else { 1e-4 };
            assert!(
                (way - exact).abs() < allowed,
                "E {young:e}, dt 1/{rate}, μ {mu}: slides {way} m, not {exact} m"
            );
        }
    }
}

#[test]
fn a_block_on_a_gentle_incline_sticks_without_creep() {
    let (angle, mu) = (0.4f64, 0.5);
    for (young, rate) in [(1e6, 60.0), (1e8, 60.0), (2e11, 60.0), (2e11, 1000.0)] {
        let mut scene = incline(angle, 1.0 / rate, mu);
        let body = scene.flexible(block(young, mu));
        scene.steps(3000);
        let start = scene.body(body).centre_of_mass();
        assert_lawful(watch(&mut scene, 10_000));
        let end = scene.body(body).centre_of_mass();
        // What is left of the soft block's settling, and round-off of 10,000 steps.
        let creep = (end[0] - start[0]).hypot(end[1] - start[1]);
        assert!(
            creep < 1e-8,
            "E {young:e}, dt 1/{rate}: creeps by {creep:e} m"
        );
        let [fx, fy] = scene.force_on_flexible(body);
        let slope = -fx / fy / angle.tan();
        assert!(
            (slope - 1.0).abs() < 1e-3,
            "E {young:e}, dt 1/{rate}: the force is off by {slope}"
        );
    }
}

#[test]
fn a_sliding_block_stops_after_v_squared_over_2_mu_g() {
    let (mu, speed) = (0.4, 3.0);
    for (young, rate) in [
        (1e6, 60.0),
        (1e8, 60.0),
        (1e8, 240.0),
        (2e11, 60.0),
        (2e11, 1000.0),
    ] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(mu);
        let body = scene.flexible(block(young, mu).linvel([speed, 0.0]));
        let start = scene.body(body).centre_of_mass()[0];
        assert_lawful(watch(&mut scene, (1.5 * rate) as usize));
        let way = scene.body(body).centre_of_mass()[0] - start;
        let exact = speed * speed / 2.0 / mu / G;
        // A soft block sways, and stops with its sway; a stiff one is a point mass but for rapier's rounding.
        let allowed = if young < 1e7 { 1e-2 } else { 1e-4 } * exact;
        assert!(
            (way - exact).abs() < allowed,
            "E {young:e}, dt 1/{rate}: {way} m, not {exact} m"
        );
        // The time v0 / μ g is over, and what is left is the soft block's sway.
        let [vx, vy] = scene.body(body).linvel();
        let rest = if young < 1e7 { 2e-2 } else { 1e-3 };
        assert!(
            vx.hypot(vy) < rest,
            "E {young:e}, dt 1/{rate}: still moves at {vx}, {vy} m/s"
        );
    }
}

#[test]
fn a_rigid_box_slides_and_stops_on_a_flexible_beam() {
    for rate in [60.0, 240.0] {
        let (mu, speed) = (0.4, 2.0);
        let mut scene = Scene::new(1.0 / rate);
        scene.flexible(
            FlexBodyBuilder::rectangle([4.0, 0.2], [40, 4])
                .material(elastic(1e10, 1000.0, 1e-3))
                .friction(mu)
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        );
        let (body, _) = scene.rigid(
            RigidBodyBuilder::dynamic()
                .translation(vec2(1.0, 0.3))
                .linvel(vec2(speed, 0.0)),
            ColliderBuilder::cuboid(0.2, 0.1)
                .density(500.0)
                .friction(real(mu)),
        );
        assert_lawful(watch(&mut scene, (1.5 * rate) as usize));
        let body = &scene.world.bodies[body];
        let way = f64::from(body.translation().x) - 1.0;
        let exact = speed * speed / 2.0 / mu / G;
        // Within the step in which it stops it brakes to its end.
        let last = 0.25 * mu * G / (rate * rate);
        assert!(
            (way - exact).abs() < 1e-5 * exact + last,
            "dt 1/{rate}: {way} m, not {exact} m"
        );
        assert!(
            body.linvel().length() < 1e-4,
            "dt 1/{rate}: still moves at {:?}",
            body.linvel()
        );
    }
}

#[test]
fn a_disc_rolls_down_a_flexible_slab() {
    // B18: a = 2/3 g sin α while μ >= tan α / 3, else it slips at g (sin α - μ cos α). The error is first order: the start.
    for rate in [60.0, 240.0, 1000.0] {
        for (angle, mu) in [(0.3f64, 0.5), (0.3, 0.05)] {
            let mut scene = Scene::new(1.0 / rate).with_gravity(G * angle.sin(), -G * angle.cos());
            scene.flexible(
                FlexBodyBuilder::rectangle([10.0, 0.5], [100, 3])
                    .material(elastic(2e11, 7800.0, 1e-3))
                    .friction(mu)
                    .pin_where(|[_, y]| y == 0.0, Pin::both()),
            );
            let (ball, _) = scene.rigid(
                RigidBodyBuilder::dynamic().translation(vec2(1.0, 0.8)),
                ColliderBuilder::ball(0.3)
                    .density(1000.0)
                    .friction(real(mu)),
            );
            assert_lawful(watch(&mut scene, (1.5 * rate) as usize));
            let rolls = mu >= angle.tan() / 3.0;
            let acceleration = if rolls {
                2.0 / 3.0 * G * angle.sin()
            } else {
                G * (angle.sin() - mu * angle.cos())
            };
            let exact = 0.5 * acceleration * 1.5 * 1.5;
            let ball = &scene.world.bodies[ball];
            let way = f64::from(ball.translation().x) - 1.0;
            let error = (way / exact - 1.0).abs();
            assert!(
                error < 0.2 / rate,
                "dt 1/{rate}, μ {mu}: rolls {way} m, not {exact} m"
            );
            if rolls {
                let slip = f64::from(ball.linvel().x + real(0.3) * ball.angvel());
                assert!(slip.abs() < 1e-4, "dt 1/{rate}: slips at {slip} m/s");
            }
        }
    }
}

/// Drops a spinning block of 0.2 m from 0.4 m; returns its largest energy over the one it began with, and how far the impulses of
/// the contact forces are from its momentum and weight, over `m g t`.
fn drop_spinning(young: f64, spin: f64, rate: f64) -> [f64; 2] {
    let (mu, seconds) = (0.5, 3.0);
    let mut scene = Scene::new(1.0 / rate);
    scene.ground(mu);
    let material = elastic(young, 1000.0, 1e-4);
    let body = scene.flexible(
        FlexBodyBuilder::rectangle([0.2, 0.2], [8, 8])
            .material(material)
            .friction(mu)
            .translation([-0.1, 0.4])
            .angvel(spin),
    );
    let n = (seconds * rate) as usize;
    let (mut highest, mut first) = (0.0f64, 0.0);
    let mut impulse = [0.0; 2];
    for step in 0..n {
        let total = scene.step().energy().total();
        first = if step == 0 { total } else { first };
        highest = highest.max(total / first);
        let force = scene.body(body).total_contact_force();
        impulse = [0, 1].map(|axis| impulse[axis] + force[axis] * scene.dt());
    }
    let body = scene.body(body);
    let [vx, vy] = body.linvel();
    let weight = body.mass() * G;
    // The end of the last force acts in the step to come.
    let late = (1.0 - Beta2::default().beta1()) * scene.dt() * weight;
    let y = impulse[1] - body.mass() * vy - weight * n as f64 * scene.dt();
    let x = impulse[0] - body.mass() * vx;
    let open = x.hypot(y).min(x.hypot(y - late));
    [highest, open / (weight * seconds)]
}

#[test]
fn friction_of_an_impact_acts_once_and_the_contact_forces_account_for_it() {
    let mut findings = Findings::default();
    for (young, spins) in [
        (1e7, [0.0, 5.0, 11.0, 30.0]),
        (1e9, [3.0, 21.0, 22.0, 26.0]),
    ] {
        for rate in [60.0, 240.0] {
            for spin in spins {
                let [energy, open] = drop_spinning(young, spin, rate);
                let case = format!("E {young:e}, {spin} rad/s, dt 1/{rate}");
                // An impact much shorter than the step may put some into a coarse vibration before it is taken back.
                let most = if rate < 100.0 { 1.2 } else { 1.0 + 1e-9 };
                findings.check(energy <= most, || format!("{case}: energy {energy}"));
                findings.check(open < 1e-4, || format!("{case}: impulse off by {open:e}"));
            }
        }
    }
    findings.report();
}

/// A spinning disc, or a capsule, and one that rests meet head-on in what is solved with a flexible body, and rub until they roll on each other: friction
/// acts where they touch, on the surfaces of both.
#[test]
fn rigid_bodies_that_rub_on_each_other_turn_each_other_alike() {
    let radius = 0.1;
    let ball = || ColliderBuilder::ball(real(radius));
    // Rounded, and as wide and as high as the ball, so that it touches at the same place.
    let rounded = || ColliderBuilder::capsule_y(0.0, real(radius));
    let shapes = [(ball(), ball()), (rounded(), ball()), (ball(), rounded())];
    for (one, other) in shapes {
        let mut scene = Scene::in_free_space(1.0 / 240.0);
        // Whatever is within the box of a flexible ring is solved with it.
        scene.flexible(FlexBodyBuilder::annulus(3.0, 3.3, 0.3).material(elastic(1e8, 1000.0, 0.0)));
        let spin = 5.0;
        let mut put = |shape: ColliderBuilder, side: f64, spin: f64| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vec2(0.15 * side, 0.0))
                .linvel(vec2(-side, 0.0))
                .angvel(real(spin));
            scene.rigid(body, shape.density(100.0).friction(10.0)).0
        };
        let bodies = [put(one, -1.0, spin), put(other, 1.0, 0.0)];
        scene.steps(60);
        let [first, second] = bodies.map(|body| {
            let body = &scene.world.bodies[body];
            [f64::from(body.linvel().y), f64::from(body.angvel())]
        });
        // No slip: `v₁ + r ω₁ = v₂ - r ω₂`, and the impulse `J` that does it gives each `J/m` and `r J/I = 2 J/(m r)`, one way: `J/m = r ω/6`.
        let exact = [
            [-radius * spin / 6.0, 2.0 / 3.0 * spin],
            [radius * spin / 6.0, -spin / 3.0],
        ];
        for (found, exact) in [first, second].iter().zip(exact) {
            let off = [0, 1].map(|i| (found[i] - exact[i]).abs());
            assert!(
                off[0] < 1e-3 * radius * spin && off[1] < 1e-3 * spin,
                "{found:?} for {exact:?}"
            );
        }
    }
}
