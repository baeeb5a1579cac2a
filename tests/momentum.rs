//! Momentum: flexible and rigid bodies that collide in free space keep what they have together.

mod common;

use common::*;

/// Momentum and angular momentum about the origin of every body of a scene, flexible and rigid.
fn momentum(scene: &Scene) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (_, body) in scene.bodies.iter() {
        let [x, y] = body.momentum();
        sum[0] += x;
        sum[1] += y;
        sum[2] += body.angular_momentum([0.0, 0.0]);
    }
    for (handle, body) in scene.world.bodies.iter() {
        if scene.bodies.iter().any(|(_, flex)| flex.rigid_body_handle() == handle) {
            continue;
        }
        let mass = f64::from(body.mass());
        let inertia = 1.0 / f64::from(body.mass_properties().effective_world_inv_inertia);
        let (x, v) = (body.center_of_mass(), body.linvel());
        let (vx, vy) = (f64::from(v.x), f64::from(v.y));
        sum[0] += mass * vx;
        sum[1] += mass * vy;
        sum[2] += mass * (f64::from(x.x) * vy - f64::from(x.y) * vx) + inertia * f64::from(body.angvel());
    }
    sum
}

#[derive(Clone, Copy, Debug)]
enum Partners {
    FlexFlex,
    FlexBox,
    FlexBall,
    Chain,
}

/// Two or three bodies on oblique courses, with friction and spin.
fn collide(partners: Partners, dt: f64, young: f64, mu: f64, kept: bool) -> Scene {
    let mut scene = Scene::in_free_space(dt);
    let inertia = if kept { ContactInertia::Kept } else { ContactInertia::Redistributed };
    let block = || {
        FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
            .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
            .contact_inertia(inertia.clone())
            .friction(mu)
    };
    scene.flexible(block().rotation(0.3).linvel([1.0, 0.2]).angvel(0.5));
    let rigid = |at: [f64; 2], v: [f64; 2], angle: f64, spin: f64| {
        RigidBodyBuilder::dynamic()
            .translation(vec2(at[0], at[1]))
            .rotation(real(angle))
            .linvel(vec2(v[0], v[1]))
            .angvel(real(spin))
    };
    let cuboid = || ColliderBuilder::cuboid(0.5, 0.4).density(1500.0).friction(real(mu));
    match partners {
        Partners::FlexFlex => {
            scene.flexible(block().rotation(-0.2).translation([1.5, 0.5]).linvel([-1.0, 0.1]).angvel(-0.3));
        }
        Partners::FlexBox => {
            scene.rigid(rigid([2.0, 1.0], [-1.0, 0.0], 0.4, -0.7), cuboid());
        }
        Partners::FlexBall => {
            scene.rigid(rigid([1.8, 1.1], [-1.0, 0.0], 0.0, 3.0), ColliderBuilder::ball(0.5).density(800.0).friction(real(mu)));
        }
        Partners::Chain => {
            scene.rigid(rigid([1.7, 0.8], [0.0, 0.0], 0.1, 0.0), cuboid());
            scene.rigid(rigid([2.9, 1.1], [-0.5, 0.0], -0.2, 0.4), cuboid());
        }
    }
    scene
}

/// Largest errors of momentum, relative, and of angular momentum, relative to the sum of the bodies' own.
fn errors(partners: Partners, dt: f64, young: f64, mu: f64, kept: bool) -> ([f64; 2], usize, f64) {
    let mut scene = collide(partners, dt, young, mu, kept);
    let start = momentum(&scene);
    let scale: f64 = 1000.0;
    let (mut linear, mut angular) = (0.0f64, 0.0f64);
    let mut touched = 0;
    let mut worst = 0.0f64;
    for _ in 0..(1.5 / dt) as usize {
        scene.step();
        let now = momentum(&scene);
        touched += usize::from(!scene.report().contacts().is_empty());
        linear = linear.max((now[0] - start[0]).hypot(now[1] - start[1]) / scale);
        angular = angular.max((now[2] - start[2]).abs() / scale);
        worst = worst.max(scene.report().cone_residual());
    }
    ([linear, angular], touched, worst)
}

#[test]
fn probe() {
    for kept in [false, true] {
        for partners in [Partners::FlexFlex, Partners::FlexBox, Partners::FlexBall, Partners::Chain] {
            for young in [1e6, 1e9] {
                for mu in [0.0, 0.5] {
                    for n in [60.0, 120.0, 240.0, 480.0, 960.0] {
                        let (e, touched, cone) = errors(partners, 1.0 / n, young, mu, kept);
                        println!("kept {kept} {partners:?} E {young:.0e} mu {mu} 1/{n}: linear {:.1e} angular {:.1e} touched {touched} cone {cone:.1e}", e[0], e[1]);
                    }
                }
            }
        }
    }
}
#[test]
fn trace() {
    for (p, young, mu, n) in [(Partners::FlexBall, 1e6, 0.5, 240.0), (Partners::FlexBox, 1e6, 0.0, 240.0), (Partners::FlexFlex, 1e9, 0.5, 240.0),  (Partners::FlexFlex, 1e6, 0.0, 240.0)] {
        println!("{p:?}");
        let mut scene = collide(p, 1.0 / n, young, mu, false);
        let mut last = momentum(&scene);
        for k in 0..(1.5 * n) as usize {
            scene.step();
            let now = momentum(&scene);
            let jump = (now[0] - last[0]).hypot(now[1] - last[1]) / 1000.0;
            let ang = (now[2] - last[2]).abs() / 1000.0;
            if jump > 3e-7 || ang > 1e-4 {
                let r = scene.report();
                println!("{k}: jump {jump:.1e} ang {ang:.1e} newton {} limited {:.1e} res {:.1e} gap {:.1e}", r.n_newton(), r.energy_limited(), r.solver_residual(), r.gap_violation());
                for c in r.contacts() { println!("     {:?} {:?} gap {:.1e} f {:.1} {:.1} sticks {} {:?}", c.position, c.normal, c.gap, c.normal_force, c.tangential_force, c.sticks, matches!(c.contactor, foil2d::pipeline::Participant::Flex(_))); }
            }
            last = now;
        }
    }
}
#[test]
fn trace2() {
        let n = 240.0;
        let mut scene = collide(Partners::FlexFlex, 1.0 / n, 1e9, 0.5, false);
        for k in 0..70 {
            scene.step();
            if k < 63 { continue; }
            for (_, b) in scene.bodies.iter() {
                print!("{k}: p {:?} acc {:?} spin {:.6} torque {:.3e}; ", b.momentum(), b.state().frame.acceleration, b.state().frame.spin, b.state().torque);
            }
            println!("contacts {}", scene.report().contacts().len());
        }
}
