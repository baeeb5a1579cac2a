//! Impacts of bodies with stiffness damping, through surfaces with and without mass.

mod common;

use common::*;

/// A ball of 100 kg dropped by 0.5 m on the middle of a steel beam on two supports: largest elastic energy (J) and height of the
/// rebound (m).
fn drop_on_beam(cells: usize, beta: f64, rate: f64) -> [f64; 2] {
    let mut scene = Scene::new(1.0 / rate);
    let beam = FlexBodyBuilder::rectangle([4.0, 0.2], [40, cells])
        .material(elastic(2.1e11, 7800.0, beta))
        .thickness(0.1)
        .pin_where(
            |[x, y]| !(1e-9..=4.0 - 1e-9).contains(&x) && y < 1e-9,
            Pin::both(),
        );
    scene.flexible(beam);
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(2.0, 0.8)),
        ColliderBuilder::ball(real(0.1)).mass(real(100.0)),
    );
    let (mut elastic, mut rebound, mut has_touched) = (0.0f64, f64::NEG_INFINITY, false);
    for _ in 0..rate as usize {
        let report = scene.step();
        elastic = elastic.max(report.energy().elastic);
        has_touched |= !report.contacts().is_empty();
        let [_, height] = place_of(&scene.world.bodies[ball]);
        if has_touched && velocity_of(&scene.world.bodies[ball])[1] > 0.0 {
            rebound = rebound.max(height - 0.3);
        }
    }
    [elastic, rebound]
}

#[test]
#[ignore = "open: stiffness damping of surfaces without mass stores 81 J instead of 71 J with 8 cells"]
fn a_damped_beam_throws_a_ball_back_alike_with_any_number_of_cells_through_its_thickness() {
    for beta in [1e-4, 1e-3] {
        let [elastic, rebound] = drop_on_beam(1, beta, 60.0);
        for cells in [2, 4, 8] {
            let [own, height] = drop_on_beam(cells, beta, 60.0);
            // Finer meshes are softer under the ball.
            assert!(
                (own / elastic - 1.0).abs() < 0.1,
                "{beta}, {cells} cells: {own} of {elastic} J"
            );
            assert!(
                (height / rebound - 1.0).abs() < 0.12,
                "{beta}, {cells} cells: {height} of {rebound} m"
            );
        }
    }
}

#[test]
#[ignore = "open: stiffness damping of surfaces without mass stores up to thousands of times what a stiff body brings"]
fn a_damped_body_stores_no_more_than_it_brings_whatever_its_stiffness_damping_mesh_and_step() {
    let mut findings = Findings::default();
    let shapes = [
        ("square", FlexBodyBuilder::rectangle([0.5, 0.5], [10, 10])),
        (
            "coarse square",
            FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4]),
        ),
        ("bar", FlexBodyBuilder::rectangle([0.12, 1.5], [2, 19])),
        ("thin bar", FlexBodyBuilder::rectangle([0.12, 1.5], [1, 19])),
    ];
    for (name, shape) in shapes {
        for (young, density) in [
            (1e6, 1000.0),
            (1e8, 1000.0),
            (1e10, 1000.0),
            (2.1e11, 7800.0),
        ] {
            for beta in [1e-5, 1e-3, 1e-1] {
                for dt in [1.0 / 60.0, 1.0 / 240.0] {
                    let mut scene = Scene::new(dt);
                    scene.ground(0.5);
                    let body = shape
                        .clone()
                        .material(elastic(young, density, beta))
                        .translation([0.0, 0.05]);
                    let body = scene.flexible(body);
                    let weight = scene.body(body).mass() * G;
                    let start = scene.body(body).centre_of_mass()[1] - 0.05;
                    let mut most = 0.0f64;
                    for _ in 0..(0.6 / dt) as usize {
                        scene.step();
                        let body = scene.body(body);
                        let energy = body.energy();
                        let height = body.centre_of_mass()[1] - start;
                        most = most.max((energy.kinetic + energy.elastic) / weight + height);
                    }
                    findings.check(most <= 0.05 * 1.01, || {
                        format!(
                            "{name}, E {young:e}, beta {beta:e}, dt {dt}: {} times",
                            most / 0.05
                        )
                    });
                }
            }
        }
    }
    findings.report();
}
