//! The constraint function method of ADINA beside Lagrange multipliers.

mod common;

use common::*;
use foil2d::kkt::{ConstraintFunction, ContactMethod};

/// A scene whose contacts obey the constraint functions.
fn scene_with(functions: ConstraintFunction, dt: f64) -> Scene {
    let mut scene = Scene::new(dt);
    scene.flex = scene
        .flex
        .with_contact_method(ContactMethod::ConstraintFunction(functions));
    scene
}

fn block(n: usize) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 0.5], [2 * n, n]).material(
        LinearElastic::plane_stress(1e6, 0.3)
            .density(1000.0)
            .rayleigh(2e-3),
    )
}

/// A block that has come to rest weighs what it weighs, whatever the mesh and the step.
#[test]
fn a_resting_block_gives_its_weight() {
    for (n, dt) in [(2, 1.0 / 60.0), (4, 1.0 / 60.0), (4, 1.0 / 500.0)] {
        let mut scene = scene_with(ConstraintFunction::default(), dt);
        scene.ground(0.5);
        let body = scene.flexible(block(n).translation([0.0, 1e-3]));
        let (mut most, mut sum) = (0, 0);
        let n_steps = (4.0 / dt) as usize;
        for _ in 0..n_steps {
            scene.step();
            most = most.max(scene.report().n_newton());
            sum += scene.report().n_newton();
            assert_eq!(scene.report().n_failed(), 0);
        }
        let weight = G * scene.body(body).mass();
        let force = scene.body(body).total_contact_force()[1];
        println!(
            "n {n}, dt {dt}: {force} of {weight}, most {most}, mean {}",
            sum as f64 / n_steps as f64
        );
        assert!((force / weight - 1.0).abs() < 1e-6, "{force} of {weight}");
    }
}

/// Where a body ends after sliding and rolling about for a second.
fn motion(method: ContactMethod) -> (Vec<[f64; 2]>, usize, usize) {
    let mut scene = Scene::new(1.0 / 240.0);
    scene.flex = scene.flex.with_contact_method(method);
    scene.ground(0.3);
    let body = scene.flexible(
        block(3)
            .translation([0.0, 0.2])
            .rotation(0.3)
            .linvel([1.5, -1.0]),
    );
    let (mut most, mut failed) = (0, 0);
    for _ in 0..std::env::var("N").map_or(240, |n| n.parse().unwrap()) {
        scene.step();
        most = most.max(scene.report().n_newton());
        failed += scene.report().n_failed();
    }
    let body = scene.body(body);
    let n = body.mesh().nodes().len();
    (
        (0..n).map(|node| body.position(node)).collect(),
        most,
        failed,
    )
}

#[test]
fn small_epsilons_give_the_motion_of_lagrange_multipliers() {
    let (exact, most, _) = motion(ContactMethod::Lagrange);
    println!("Lagrange: {most}");
    for (n, t) in [
        (1e-4, 1e-1),
        (1e-6, 1e-3),
        (1e-9, 1e-4),
        (1e-12, 1e-6),
        (1e-12, 1e-9),
        (1e-15, 1e-9),
    ] {
        for functions in [
            ConstraintFunction::new(n, t).unwrap(),
            ConstraintFunction::new(n, t).unwrap().without_line_search(),
        ] {
            let (found, most, failed) = motion(ContactMethod::ConstraintFunction(functions));
            let error = found.iter().zip(&exact).fold(0.0f64, |worst, (a, b)| {
                worst.max((a[0] - b[0]).hypot(a[1] - b[1]))
            });
            println!("{n:e} {t:e}: off by {error:e}, iterations {most}, failed {failed}");
        }
    }
}

#[test]
fn a_block_on_an_incline_creeps_by_epsilon_and_slides_as_coulomb_says() {
    for (friction, t) in [(0.8, 1e-3), (0.8, 1e-6), (0.8, 1e-9), (0.3, 1e-6)] {
        let functions = ConstraintFunction::new(1e-12, t).unwrap();
        let angle = 30f64.to_radians();
        let mut scene =
            scene_with(functions, 1.0 / 60.0).with_gravity(G * angle.sin(), -G * angle.cos());
        scene.ground(friction);
        let body = scene.flexible(block(2).friction(friction));
        for _ in 0..30 {
            scene.step();
        }
        let start = scene.body(body).centre_of_mass()[0];
        let v0 = scene.body(body).linvel()[0];
        let mut most = 0;
        for _ in 0..60 {
            scene.step();
            most = most.max(scene.report().n_newton());
            assert_eq!(scene.report().n_failed(), 0);
        }
        let moved = scene.body(body).centre_of_mass()[0] - start;
        let a = scene.body(body).linvel()[0] - v0;
        println!(
            "mu {friction} eps {t:e}: moved {moved:e}, acceleration {a}, expected {}; iterations {most}",
            G * (angle.sin() - friction * angle.cos())
        );
    }
}

#[test]
fn failures_are_counted_and_solved_by_lagrange_multipliers() {
    let hurried = ConstraintFunction::default().with_max_iterations(1);
    let mut scene = scene_with(hurried, 1.0 / 60.0);
    scene.ground(0.5);
    scene.flexible(block(2));
    scene.step();
    let report = scene.report();
    assert_eq!((report.n_failed(), report.n_substituted()), (1, 1));
}
