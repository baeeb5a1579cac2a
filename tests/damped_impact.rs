//! Impacts of bodies with stiffness damping, through surfaces with and without mass.

mod common;

use common::*;
use foil2d::fe::material::Rayleigh;

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

/// What holds a body that is hit.
#[derive(Clone, Copy, Debug)]
enum Hold {
    /// Pins at its left end.
    Clamp,
    /// A pin at its lower left corner.
    Hinge,
    /// A weld of its left end to the world.
    Weld,
}

/// A ball that meets a body with damping, without gravity: how much more energy there was at most than the ball brought (-).
fn hit(
    ([width, height], cells): ([f64; 2], [usize; 2]),
    hold: Hold,
    dice: &mut Dice,
    (integrator, rate): (Beta2, f64),
    balls: &[f64],
) -> (f64, String) {
    let young = dice.pick(&[1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 2.1e11]);
    let stiffness = dice.pick(&[1e-5, 1e-4, 1e-3, 1e-2, 1e-1]);
    let mass = dice.pick(&[0.0, 1.0, 10.0]);
    let (ball, speed) = (dice.pick(balls), dice.pick(&[0.3, 1.0]));
    let at = dice.between(0.2, 1.0) * width;
    let is_led = dice.roll() < 0.5;
    let mut scene = Scene::in_free_space(1.0 / rate).with_integrator(integrator);
    scene.flex.parameters.feasible_path = is_led;
    let body = FlexBodyBuilder::rectangle([width, height], cells)
        .material(elastic(young, 1000.0, stiffness).damping(Rayleigh { mass, stiffness }));
    let body = match hold {
        Hold::Clamp => body.pin_where(|[x, _]| x < 1e-9, Pin::both()),
        Hold::Hinge => body.pin_where(|[x, y]| x < 1e-9 && y < 1e-9, Pin::both()),
        Hold::Weld => body,
    };
    let body = scene.flexible(body);
    if matches!(hold, Hold::Weld) {
        let weld = AttachmentBuilder::weld(body).where_(|[x, _]| x < 1e-9);
        let attached = scene.bodies.attach(weld.to_world(), &scene.world.bodies);
        attached.expect("the description is right");
    }
    scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(at, height + 0.1 + 0.05 * speed))
            .linvel(vec2(0.0, -speed)),
        ColliderBuilder::ball(real(0.1)).mass(real(ball)),
    );
    let brought = 0.5 * ball * speed * speed;
    let start = energy_of(&scene);
    let mut most = 0.0f64;
    for _ in 0..(0.5 * rate) as usize {
        let is_taken = scene.try_step().is_ok();
        assert!(is_taken, "no step is refused");
        most = most.max((energy_of(&scene) - start) / brought);
    }
    let name = format!(
        "{cells:?} cells, {hold:?}, E {young:e}, alpha {mass}, beta {stiffness:e}, 1/{rate} s, beta0 {:.2}, {ball} kg, {speed} m/s, led {is_led}",
        integrator.beta0()
    );
    (most, name)
}

/// The end of the lightest of the bodies moves like 22 kg in its first mode.
fn check_hits(holds: &[Hold], integrators: &[Beta2], balls: &[f64]) {
    let mut findings = Findings::default();
    let bodies = [
        ([0.5, 0.5], [10, 10]),
        ([0.5, 0.5], [4, 4]),
        ([1.5, 0.12], [19, 2]),
        ([1.5, 0.12], [19, 1]),
        ([1.5, 0.06], [30, 3]),
    ];
    let mut dice = Dice(1);
    for &hold in holds {
        for &integrator in integrators {
            for rate in [30.0, 60.0, 240.0] {
                for body in bodies {
                    for _ in 0..8 {
                        let (gain, name) = hit(body, hold, &mut dice, (integrator, rate), balls);
                        findings.check(gain < 0.01, || format!("{name}: {gain:.2e} gained"));
                    }
                }
            }
        }
    }
    findings.report();
}

fn integrators() -> [Beta2; 3] {
    let strongly_damped = Beta2::damped(0.0).expect("0 is in range");
    [Beta2::default(), Beta2::trapezoidal(), strongly_damped]
}

#[test]
fn a_ball_that_meets_a_heavier_damped_body_on_pins_leaves_no_more_energy_than_it_brought() {
    check_hits(&[Hold::Clamp, Hold::Hinge], &integrators(), &[1.0, 10.0]);
}

#[test]
fn a_ball_that_meets_a_heavier_damped_body_in_a_weld_leaves_no_more_energy_than_it_brought() {
    check_hits(&[Hold::Weld; 4], &integrators(), &[1.0, 10.0]);
}

#[test]
fn a_ball_that_meets_a_lighter_damped_body_leaves_no_more_energy_than_it_brought() {
    let holds = [Hold::Clamp, Hold::Hinge, Hold::Weld];
    check_hits(&holds, &integrators()[..2], &[30.0, 1000.0]);
}
