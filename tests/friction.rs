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
        .material(
            LinearElastic::plane_stress(young, 0.3)
                .density(1000.0)
                .rayleigh(1e-3),
        )
        .friction(mu)
}

#[test]
fn a_block_slides_down_a_steep_incline() {
    for (young, dt) in [(1e6, 1.0/60.0), (1e8, 1.0 / 60.0), (1e8, 1.0 / 240.0), (2e11, 1.0/60.0), (2e11, 1.0/1000.0)] {
        for (angle, mu) in [(0.5, 0.3), (0.3, 0.0), (0.6, 0.65)] {
            let mut scene = incline(angle, dt, mu);
            let body = scene.flexible(block(young, mu).translation([-45.0, 0.0]));
            let start = scene.body(body).centre_of_mass()[0];
            let (mut cone, mut gap, mut lift) = (0.0f64, 0.0f64, 0.0f64);
            let n = (2.0 / dt).round() as usize;
            for _ in 0..n {
                let r = scene.step();
                cone = cone.max(r.cone_residual());
                gap = gap.max(r.gap_violation());
                let v = scene.body(body).linvel()[1];
                lift = lift.max(v);
            }
            let t = n as f64 * dt;
            let exact = 0.5 * G * (angle.sin() - mu * angle.cos()) * t * t;
            let s = scene.body(body).centre_of_mass()[0] - start;
            println!("E {young:.0e} dt {dt:.4} a {angle} mu {mu}: s {s:.5} exact {exact:.5} error {:.1e} cone {cone:.1e} gap {gap:.1e} lift {lift:.1e} angle {:.1e}", s / exact - 1.0, scene.body(body).angle());
        }
    }
}

#[test]
fn a_block_sticks_on_a_gentle_incline() {
    for (young, dt, n) in [(1e6, 1.0/60.0, 10_000), (1e8, 1.0 / 60.0, 10_000), (2e11, 1.0/60.0, 10_000), (2e11, 1.0/1000.0, 10_000)] {
        let (angle, mu) = (0.4f64, 0.5);
        let mut scene = incline(angle, dt, mu);
        let body = scene.flexible(block(young, mu));
        scene.steps(600);
        let start = scene.body(body).centre_of_mass();
        let mut cone = 0.0f64;
        for _ in 0..n { cone = cone.max(scene.step().cone_residual()); }
        let end = scene.body(body).centre_of_mass();
        let ratio = -scene.force_on_flexible(body)[0] / scene.force_on_flexible(body)[1];
        println!("E {young:.0e} dt {dt:.4}: creep {:.2e} {:.2e} cone {cone:.1e} drag ratio {ratio:.6} tan {:.6}", end[0] - start[0], end[1] - start[1], angle.tan());
    }
}

#[test]
fn a_sliding_block_stops_after_the_right_way() {
    for (young, dt) in [(1e6, 1.0/60.0), (1e8, 1.0 / 60.0), (1e8, 1.0 / 240.0), (2e11, 1.0/60.0), (2e11, 1.0/1000.0)] {
        let (mu, speed) = (0.4, 3.0);
        let mut scene = Scene::new(dt);
        scene.ground(mu);
        let body = scene.flexible(block(young, mu).linvel([speed, 0.0]));
        let start = scene.body(body).centre_of_mass()[0];
        let mut stopped = 0.0;
        let mut cone = 0.0f64;
        for k in 0..(1.5 / dt) as usize {
            cone = cone.max(scene.step().cone_residual());
            if scene.body(body).linvel()[0] > 1e-3 { stopped = (k + 1) as f64 * dt; }
        }
        let way = scene.body(body).centre_of_mass()[0] - start;
        println!("E {young:.0e} dt {dt:.4}: way {way:.5} exact {:.5} error {:.1e}; time {stopped:.4} exact {:.4}; v {:?} cone {cone:.1e}", speed * speed / 2.0 / mu / G, way * 2.0 * mu * G / speed / speed - 1.0, speed / mu / G, scene.body(body).linvel());
    }
}

#[test]
fn a_rigid_box_slides_and_stops_on_a_flexible_beam() {
    for dt in [1.0 / 60.0, 1.0 / 240.0] {
        let (mu, speed) = (0.4, 2.0);
        let mut scene = Scene::new(dt);
        scene.flexible(
            FlexBodyBuilder::rectangle([4.0, 0.2], [40, 4])
                .material(LinearElastic::plane_stress(1e10, 0.3).density(1000.0).rayleigh(1e-3))
                .friction(mu)
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        );
        let (body, _) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(1.0, 0.3)).linvel(vec2(speed, 0.0)),
            ColliderBuilder::cuboid(0.2, 0.1).density(500.0).friction(real(mu)),
        );
        let mut cone = 0.0f64;
        for _ in 0..(1.5 / dt) as usize { cone = cone.max(scene.step().cone_residual()); }
        let way = f64::from(scene.world.bodies[body].translation().x) - 1.0;
        println!("dt {dt:.4}: way {way:.5} exact {:.5} error {:.1e} v {:?} cone {cone:.1e}", speed * speed / 2.0 / mu / G, way * 2.0 * mu * G / speed / speed - 1.0, scene.world.bodies[body].linvel());
    }
}

#[test]
fn a_disc_rolls_down_a_flexible_slab() {
    // B18: a = 2/3 g sin α while μ >= tan α / 3, else g (sin α - μ cos α).
    for dt in [1.0 / 60.0, 1.0 / 240.0, 1.0/1000.0] {
        for (angle, mu) in [(0.3f64, 0.5), (0.3, 0.05)] {
            let mut scene = Scene::new(dt).with_gravity(G * angle.sin(), -G * angle.cos());
            scene.flexible(
                FlexBodyBuilder::rectangle([10.0, 0.5], [100, 3])
                    .material(LinearElastic::plane_stress(2e11, 0.3).density(7800.0).rayleigh(1e-3))
                    .friction(mu)
                    .pin_where(|[_, y]| y == 0.0, Pin::both()),
            );
            let (ball, _) = scene.rigid(
                RigidBodyBuilder::dynamic().translation(vec2(1.0, 0.8)),
                ColliderBuilder::ball(0.3).density(1000.0).friction(real(mu)),
            );
            let n = (1.5 / dt).round() as usize;
            let mut cone = 0.0f64;
            for _ in 0..n { cone = cone.max(scene.step().cone_residual()); }
            let t = n as f64 * dt;
            let a = if mu >= angle.tan() / 3.0 { 2.0 / 3.0 * G * angle.sin() } else { G * (angle.sin() - mu * angle.cos()) };
            let s = f64::from(scene.world.bodies[ball].translation().x) - 1.0;
            let v = scene.world.bodies[ball].linvel();
            println!("dt {dt:.4} mu {mu}: s {s:.5} exact {:.5} error {:.1e} v/(wR) {:.5} y {:.6} cone {cone:.1e}", 0.5*a*t*t, s / (0.5 * a * t * t) - 1.0, -v.x / (0.3 * scene.world.bodies[ball].angvel()), scene.world.bodies[ball].translation().y);
        }
    }
}
#[test]
fn trace() {
    for (young, mu, angle, beta) in [(2e11, 0.5, 0.0, 1e-3), (2e11, 0.0, 0.0, 1e-3), (2e11, 1000.0, 0.4, 1e-3), (2e11, 0.5, 0.4, 0.0), (2e11, 1000.0, 0.4, 0.0), (2e11, 0.5, 0.4, 1e-3)] {
        let dt = 1.0 / 60.0;
        let mut scene = incline(angle, dt, mu);
        let body = scene.flexible(FlexBodyBuilder::rectangle([1.0, 0.5], [8, 8])
        .material(
            LinearElastic::plane_stress(young, 0.3)
                .density(1000.0)
                .rayleigh(beta),
        )
        .friction(mu));
        println!("E {young:e} mu {mu} angle {angle} beta {beta}");
        for k in 0..1000 {
            scene.step();
            let r = scene.report();
            if k < 3 || k % 25 == 0 && k < 300 || k % 200 == 0 {
            let f = scene.force_on_flexible(body);
            let n: Vec<String> = r.contacts().iter().map(|c| format!("{:.0}/{:.0}{}", c.normal_force, c.tangential_force, if c.sticks {""} else {"*"})).collect();
            println!("{k}: f {:.3} {:.3} v {:.1e} {:.1e} kin {:.2e} el {:.2e} spin {:.1e} newton {} {}", f[0]/4905.0, f[1]/4905.0, scene.body(body).linvel()[0], scene.body(body).linvel()[1], r.energy().kinetic, r.energy().elastic, scene.body(body).state().frame.spin, r.n_newton(), n.join(" "));
            }
        }
    }
}
