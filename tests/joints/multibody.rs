//! Links of multibody joints: they feel flexible bodies, and rapier moves them.

use crate::common::*;

/// Two hinged bars of 2 kg that rest in free space.
fn bars(scene: &mut Scene) -> [RigidBodyHandle; 2] {
    let bars = [0.0, 1.0].map(|x| {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(x, 0.0))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.45), real(0.1)).density(real(2.0 / 0.18));
        scene.world.insert(body, shape).0
    });
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.5, 0.0))
        .local_anchor2(vec2(-0.5, 0.0));
    let joints = &mut scene.world.multibody_joints;
    joints.insert(bars[0], bars[1], hinge, true);
    bars
}

fn block(
    scene: &mut Scene,
    stiffness: f64,
    density: f64,
    at: [f64; 2],
    v: [f64; 2],
) -> FlexBodyHandle {
    scene.flexible(
        FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3])
            .material(
                LinearElastic::plane_stress(stiffness, 0.3)
                    .density(density)
                    .rayleigh(1e-4),
            )
            .translation(at)
            .linvel(v),
    )
}

/// Velocity and spin of a link's centre as its joints move: rapier's copy in the body lags by a substep.
fn velocity(scene: &Scene, link: RigidBodyHandle) -> [f64; 3] {
    let joints = &scene.world.multibody_joints;
    let id = joints.rigid_body_link(link).expect("it is a link");
    let multibody = joints.get_multibody(id.multibody).expect("it is there");
    let (jacobian, rates) = (
        multibody.body_jacobian(id.id),
        multibody.generalized_velocity(),
    );
    [0, 1, 2].map(|axis| {
        let terms = jacobian.row(axis).into_iter().zip(rates.iter());
        terms.map(|(j, v)| f64::from(*j) * f64::from(*v)).sum()
    })
}

fn momentum(scene: &Scene, bars: &[RigidBodyHandle], block: FlexBodyHandle) -> [f64; 4] {
    let body = scene.body(block);
    let m = body.mass();
    let [x, y] = body.linvel();
    let mut p = [m * x, m * y, 0.0, 0.0];
    for &bar in bars {
        let b = &scene.world.bodies[bar];
        let c = b.center_of_mass();
        let [vx, vy, w] = velocity(scene, bar);
        let mass = f64::from(b.mass());
        let i = f64::from(b.mass_properties().local_mprops.principal_inertia());
        p[0] += mass * vx;
        p[1] += mass * vy;
        p[2] += i * w + mass * (f64::from(c.x) * vy - f64::from(c.y) * vx);
        p[3] += 0.5 * mass * (vx * vx + vy * vy) + 0.5 * i * w * w;
    }
    p
}

#[test]
fn explore() {
    for (at, v) in [([1.5, -0.15], [-1.0, 0.0]), ([0.9, 0.15], [0.0, -1.0])] {
        for (stiffness, density) in [(1e5, 100.0), (1e6, 100.0), (1e8, 100.0), (1e6, 10000.0)] {
            for dt in [1.0 / 60.0, 1.0 / 120.0, 1.0 / 480.0] {
                let mut scene = Scene::in_free_space(dt);
                let bars = bars(&mut scene);
                let block = block(&mut scene, stiffness, density, at, v);
                let first = {
                    let m = scene.body(block).mass();
                    [m * v[0], m * v[1], 0.0, 0.0]
                };
                let (mut most, mut linear, mut gap, mut late, mut n) =
                    (0.0f64, 0.0f64, 0.0f64, 0.0, 0);
                for _ in 0..(1.0 / dt) as usize {
                    let report = scene.step();
                    n += usize::from(!report.contacts().is_empty());
                    gap = report.contacts().iter().fold(gap, |a, c| a.min(c.gap));
                    let p = momentum(&scene, &bars, block);
                    linear = linear.max((p[0] - first[0]).abs().max((p[1] - first[1]).abs()));
                    late = (p[0] - first[0]).abs().max((p[1] - first[1]).abs());
                    most = most.max((p[2] - first[2]).abs());
                }
                let p = momentum(&scene, &bars, block);
                let m = scene.body(block).mass();
                println!(
                    "{at:?} E {stiffness} rho {density} 1/dt {:.0}: n {n} gap {gap:.2e} linear max {:.2e} end {:.2e} bars L {:.4} bars p [{:.3} {:.3}] T {:.4} v block {:?}",
                    1.0 / dt,
                    linear / m,
                    late / m,
                    p[2],
                    p[0],
                    p[1],
                    p[3],
                    scene.body(block).linvel()
                );
            }
        }
    }
}

/// A table top of `mass` on a vertical rail with a spring.
fn table(scene: &mut Scene, mass: f64, stiffness: f64) -> RigidBodyHandle {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let top = RigidBodyBuilder::dynamic().can_sleep(false);
    let shape = ColliderBuilder::cuboid(real(0.5), real(0.05)).density(real(mass / 0.1));
    let top = scene.world.insert(top, shape).0;
    let rail = PrismaticJointBuilder::new(vec2(0.0, 1.0));
    let joints = &mut scene.world.multibody_joints;
    let handle = joints.insert(base, top, rail, true).expect("a joint");
    let (multibody, id) = joints.get_mut(handle).expect("it is there");
    multibody
        .link_mut(id)
        .expect("a link")
        .joint
        .set_spring(0, real(stiffness), 0.0);
    multibody.damping_mut()[0] = real(2.0 * 0.5 * (stiffness * mass).sqrt());
    top
}

#[test]
fn explore_table() {
    for (mass, density, stiffness) in [
        (1.0, 1111.1, 1e5),
        (100.0, 11.111, 1e5),
        (1.0, 11.11, 1e3),
        (1.0, 1111.1, 1e7),
    ] {
        for e in [1e6, 1e8] {
            let mut scene = Scene::new(1.0 / 60.0);
            let top = table(&mut scene, mass, stiffness);
            let block = block(&mut scene, e, density, [-0.15, 0.06], [0.0, 0.0]);
            let rest = (mass + scene.body(block).mass()) * G / stiffness;
            let mut gap = 0.0f64;
            for step in 0..600 {
                let report = scene.step();
                gap = report.contacts().iter().fold(gap, |a, c| a.min(c.gap));
                if [1, 3, 10, 30, 100, 300, 599].contains(&step) {
                    let y = f64::from(scene.world.bodies[top].translation().y);
                    println!(
                        "{mass} {density} {stiffness} E {e} step {step}: y {:.5} rest {:.5} force {:.4} block v {:.2e} gap {gap:.2e}",
                        y,
                        -rest,
                        scene.body(block).total_contact_force()[1] / (G * scene.body(block).mass()),
                        scene.body(block).linvel()[1]
                    );
                }
            }
        }
    }
}

#[test]
fn explore_ground() {
    for density in [1.0, 100.0, 10000.0] {
        for dt in [1.0 / 60.0, 1.0 / 240.0] {
            let mut scene = Scene::new(dt);
            scene.ground(0.5);
            let bars = bars(&mut scene);
            for &bar in &bars {
                let at = scene.world.bodies[bar].translation() + vec2(0.0, 0.1);
                scene.world.bodies[bar].set_translation(at, true);
            }
            for _ in 0..60 {
                scene.world.step();
            }
            let block = block(&mut scene, 1e6, density, [0.35, 0.21], [0.0, 0.0]);
            let mut gap = 0.0f64;
            let n = (3.0 / dt) as usize;
            for step in 0..n {
                let report = scene.step();
                gap = report.contacts().iter().fold(gap, |a, c| a.min(c.gap));
                if step % (n / 6) == 0 || step == n - 1 || step < 6 {
                    let y = f64::from(scene.world.bodies[bars[0]].translation().y);
                    println!(
                        "{density} step {step}: y {:.5} force {:.4} block v {:.2e} low {:.5} gap {gap:.2e}",
                        y,
                        scene.body(block).total_contact_force()[1] / (G * scene.body(block).mass()),
                        scene.body(block).linvel()[1],
                        scene
                            .body(block)
                            .positions()
                            .chunks(2)
                            .fold(9.0f64, |a, c| a.min(c[1]))
                    );
                }
            }
        }
    }
}

#[test]
fn zoom_ground() {
    for k in 0..2 {
        let dt = 1.0 / 60.0;
        let mut scene = Scene::new(dt);
        scene.ground(0.5);
        let bars = bars(&mut scene);
        for &bar in &bars {
            let at = scene.world.bodies[bar].translation() + vec2(0.0, 0.1);
            scene.world.bodies[bar].set_translation(at, true);
        }
        for _ in 0..60 {
            scene.world.step();
        }
        let block = if k == 0 {
            Some(block(&mut scene, 1e6, 100.0, [0.35, 0.201], [0.0, 0.0]))
        } else {
            for (&bar, s) in bars.iter().zip([1.0, -1.0]) {
                scene.world.bodies[bar].add_force(vec2(0.0, -9.0 * G / 2.0), true);
                scene.world.bodies[bar].add_torque(real(-9.0 * G / 2.0 * s * 0.4), true);
            }
            None
        };
        for step in 0..170 {
            let report = scene.step();
            if step % 10 == 0 || step > 140 {
                let f: Vec<String> = report
                    .contacts()
                    .iter()
                    .map(|c| {
                        format!(
                            "{:.3} {:.3}@{:.4},{:.4} g{:.1e}",
                            c.normal_force, c.tangential_force, c.position[0], c.position[1], c.gap
                        )
                    })
                    .collect();
                let b: Vec<String> = bars
                    .iter()
                    .map(|&b| {
                        let b = &scene.world.bodies[b];
                        format!(
                            "{:.5},{:.5},{:.5}",
                            b.translation().x,
                            b.translation().y,
                            b.rotation().angle()
                        )
                    })
                    .collect();
                println!(
                    "{step}: {b:?} {f:?} {:?}",
                    block.map(|b| scene.body(b).linvel())
                );
            }
        }
    }
}
