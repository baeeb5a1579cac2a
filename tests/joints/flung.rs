//! Bodies that spin by radians a step into a weld: such steps are cut.

use crate::common::*;

/// Longest side of the plate (m).
const SIZE: f64 = 1.0;

/// A plate in free space, welded to the world by its left edge, that spins by so much in a step (rad). It stops within the step if
/// the weld is to hold, over radians of which no row of the weld points where it did.
fn spinning_plate(turn: f64, dt: f64, is_large: bool) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::in_free_space(dt);
    // At 300 rad/s waves of strain have to be faster than 10 m/s, if there is to be anything left of the plate.
    let young = if is_large { 1e8 } else { 1e5 };
    let plate = FlexBodyBuilder::rectangle([SIZE, 0.5], [4, 2])
        .material(elastic(young, 1000.0, 1e-3))
        .angvel(turn / dt);
    let plate = scene.flexible(match is_large {
        true => plate,
        false => plate.small_strain(),
    });
    let weld = AttachmentBuilder::weld(plate).where_(|[x, _]| x < 1e-9);
    scene
        .bodies
        .attach(weld.to_world(), &scene.world.bodies)
        .expect("the description is right");
    (scene, plate)
}

/// Farthest that a welded node has moved (m).
fn torn(scene: &Scene, plate: FlexBodyHandle) -> f64 {
    let body = scene.body(plate);
    let nodes = body.mesh().nodes().iter().enumerate();
    let welded = nodes.filter(|(_, at)| at[0] < 1e-9);
    welded.fold(0.0, |most, (node, _)| {
        let [x, y] = body.displacement(node);
        most.max(x.hypot(y))
    })
}

#[test]
fn a_weld_holds_whatever_spins_into_it_and_gives_it_no_energy() {
    let mut findings = Findings::default();
    let mut n_unsolved = 0;
    for (rate, is_large) in [(30.0, false), (60.0, false), (30.0, true), (60.0, true)] {
        for quarter in 1..=20 {
            let turn = 0.25 * f64::from(quarter);
            let (mut scene, plate) = spinning_plate(turn, 1.0 / rate, is_large);
            let start = scene.body(plate).energy().kinetic;
            for index in 0..20 {
                let report = scene.try_step().expect("no step is refused");
                let (energy, is_solved) = (report.energy().total(), is_solved(report));
                let torn = torn(&scene, plate);
                let context = || format!("large: {is_large}, {turn} rad, 1/{rate} s, step {index}");
                n_unsolved += usize::from(!is_solved);
                findings.check(energy <= 1.01 * start, || {
                    format!("{}: {energy} J of {start}", context())
                });
                // What passes may leave in the end, 1e5 times rounding, and what a step that is stopped does.
                let most = if is_solved { 2e-6 } else { 1e-3 };
                findings.check(torn < most, || format!("{}: torn by {torn} m", context()));
            }
        }
    }
    // A plate of small strain that is stopped out of several radians a step is crushed: single parts of that have no end that is found.
    findings.check(n_unsolved <= 2, || format!("{n_unsolved} steps not solved"));
    findings.report();
}

#[test]
fn what_a_weld_stops_within_half_a_radian_a_step_loses_energy_and_needs_no_way_out() {
    for (rate, is_large) in [30.0, 60.0, 240.0]
        .map(|rate| [(rate, false), (rate, true)])
        .concat()
    {
        let (mut scene, plate) = spinning_plate(0.25, 1.0 / rate, is_large);
        let start = scene.body(plate).energy().kinetic;
        for index in 0..60 {
            // `Scene::step` fails if a step is linearised or held.
            let energy = scene.step().energy().total();
            assert!(
                energy <= start * (1.0 + 1e-6),
                "1/{rate} s, step {index}: {energy} J of {start}"
            );
        }
    }
}
