//! Joints that take hold of what moves otherwise, and what they hold when it is struck: bodies that are stiff and damped answer as rigid ones do.

use crate::common::{Scene, elastic, is_solved, real, vec2};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

const SPEED: f64 = 2.7;

/// Young's modulus (Pa) and Rayleigh damping (s): from what a step resolves to what it does not.
const MATERIALS: [[f64; 2]; 6] = [
    [1e7, 5e-3],
    [1e8, 1e-2],
    [1e9, 0.0],
    [1e9, 1e-3],
    [1e11, 1e-4],
    [1e11, 1e-2],
];

/// A plate of 0.4 × 0.4 m and 12.8 kg.
fn plate([young, damping]: [f64; 2], bottom: f64, is_small: bool) -> FlexBodyBuilder {
    let plate = FlexBodyBuilder::rectangle([0.4, 0.4], [6, 6])
        .translation([-0.2, bottom])
        .thickness(0.1)
        .material(elastic(young, 800.0, damping));
    if is_small {
        plate.small_strain()
    } else {
        plate
    }
}

fn attach(scene: &mut Scene, attachment: AttachmentBuilder) {
    let attached = scene.bodies.attach(attachment, &scene.world.bodies);
    attached.expect("nodes and bodies exist");
}

/// Kinetic and elastic energy of everything (J).
fn energy(scene: &Scene) -> f64 {
    let flexible = scene.bodies.iter().map(|(_, body)| {
        let energy = body.energy();
        energy.kinetic + energy.elastic
    });
    let rigid = scene
        .world
        .bodies
        .iter()
        .filter(|(_, body)| body.is_dynamic() && body.mass() > 0.0);
    let rigid = rigid.map(|(_, body)| f64::from(body.kinetic_energy()));
    flexible.sum::<f64>() + rigid.sum::<f64>()
}

/// Steps for a second; returns the highest energy on the way, and that of the end (J).
fn run(scene: &mut Scene, rate: f64, context: &str) -> [f64; 2] {
    let mut most = 0.0f64;
    for _ in 0..rate as usize {
        assert!(is_solved(scene.step()), "{context}");
        most = most.max(energy(scene));
    }
    [most, energy(scene)]
}

/// One of two plates meets the other one by a pin: half of its energy is what both have together, and nothing more comes from damping.
#[test]
fn a_pin_between_plates_of_different_speeds_takes_energy_and_gives_none() {
    for is_small in [true, false] {
        for material in MATERIALS {
            for rate in [60.0, 240.0] {
                let mut scene = Scene::in_free_space(1.0 / rate);
                let still = scene.flexible(plate(material, 0.25, is_small));
                let moving = plate(material, 0.66, is_small).linvel([0.0, -SPEED]);
                let moving = scene.flexible(moving);
                attach(
                    &mut scene,
                    AttachmentBuilder::pin(still).node(45).to_flexible(moving),
                );
                let brought = energy(&scene);
                let context = format!("small {is_small}, {material:?}, 1/{rate}");
                let [most, end] = run(&mut scene, rate, &context);
                assert!(most <= brought, "{context}: {most} of {brought} J");
                assert!(
                    (end / brought - 0.5).abs() < 0.02,
                    "{context}: {end} of {brought} J"
                );
            }
        }
    }
}

/// Two rigid bodies of masses and inertias that meet at a hinge with a velocity of the second: what both have then (J).
fn hinged(masses: [[f64; 2]; 2], arms: [[f64; 2]; 2], velocity: [f64; 2]) -> f64 {
    let mobility =
        |[m, i]: [f64; 2], [x, y]: [f64; 2]| [1.0 / m + y * y / i, -x * y / i, 1.0 / m + x * x / i];
    let [a, b] = [0, 1].map(|k| mobility(masses[k], arms[k]));
    let [xx, xy, yy] = std::array::from_fn(|k| a[k] + b[k]);
    let [vx, vy] = velocity;
    let determinant = xx * yy - xy * xy;
    let impulse = [
        (yy * vx - xy * vy) / determinant,
        (xx * vy - xy * vx) / determinant,
    ];
    let taken = 0.5 * (impulse[0] * vx + impulse[1] * vy);
    0.5 * masses[1][0] * (vx * vx + vy * vy) - taken
}

/// A stiff plate that is pinned to a ball beside its centre moves on with it as a rigid one would, at a step of a sixtieth, too, which does not resolve
/// anything of it.
#[test]
fn a_stiff_plate_moves_on_with_what_it_is_pinned_to() {
    let rigid = hinged(
        [[12.8, 12.8 * 0.32 / 12.0], [27.0, 0.5 * 27.0 * 0.01]],
        [[0.0, 0.2], [-0.05, -0.3]],
        [-0.5, -SPEED],
    );
    for is_small in [true, false] {
        for young in [1e9, 2e11] {
            for (rate, most_off) in [(60.0, 1e-2), (240.0, 2e-3)] {
                let mut scene = Scene::in_free_space(1.0 / rate);
                let body = scene.flexible(plate([young, 1e-5], 0.25, is_small));
                let (ball, _) = scene.rigid(
                    RigidBodyBuilder::dynamic()
                        .translation(vec2(0.05, 0.95))
                        .linvel(vec2(-0.5, -SPEED)),
                    ColliderBuilder::ball(0.1).mass(27.0),
                );
                attach(
                    &mut scene,
                    AttachmentBuilder::pin(body).node(45).to_rigid_body(ball),
                );
                let context = format!("small {is_small}, E {young:e}, 1/{rate}");
                let [_, end] = run(&mut scene, rate, &context);
                let off = (end / rigid - 1.0).abs();
                assert!(off < most_off, "{context}: {end} J, a rigid one {rigid} J");
            }
        }
    }
}

/// A plate that is welded to a ball below it, or pinned there, lands on it: the ground has all of the momentum within the step, and nothing comes back.
#[test]
fn what_is_held_by_a_body_that_lands_is_stopped_with_it() {
    for material in MATERIALS {
        for is_weld in [true, false] {
            let mut scene = Scene::in_free_space(1.0 / 60.0);
            scene.fixed(ColliderBuilder::cuboid(2.0, 0.1).translation(vec2(0.0, -0.1)));
            let body = plate(material, 0.25, true).linvel([0.0, -SPEED]);
            let body = scene.flexible(body);
            let (ball, _) = scene.rigid(
                RigidBodyBuilder::dynamic()
                    .translation(vec2(0.0, 0.13))
                    .linvel(vec2(0.0, -SPEED)),
                ColliderBuilder::ball(0.1).mass(real(27.0)),
            );
            let attachment = if is_weld {
                AttachmentBuilder::weld(body).nodes([2, 3, 4])
            } else {
                AttachmentBuilder::pin(body).node(3)
            };
            attach(&mut scene, attachment.to_rigid_body(ball));
            let brought = energy(&scene);
            let report = scene.step();
            let force: f64 = report.contacts().iter().map(|one| one.normal_force).sum();
            let context = format!("{material:?}, weld {is_weld}");
            let stopped = 39.8 * SPEED * 60.0;
            assert!(
                (force / stopped - 1.0).abs() < 0.05,
                "{context}: {force} of {stopped} N"
            );
            let after = energy(&scene);
            let [most, _] = run(&mut scene, 60.0, &context);
            let gained = (most - after) / brought;
            assert!(
                gained < 1e-2,
                "{context}: {after} J, then {most} of {brought} J"
            );
        }
    }
}
