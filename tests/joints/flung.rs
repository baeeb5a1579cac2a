//! Steps of joints that no iteration solves are taken linearised, and held if they would fling.

use crate::common::*;

/// Longest side of the plate (m).
const SIZE: f64 = 1.0;

/// A plate in free space, welded to the world by its left edge, that spins by so much in a step (rad). It stops within the step if
/// the weld is to hold, over radians of which no row of the weld points where it did.
fn spinning_plate(turn: f64, dt: f64) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::in_free_space(dt);
    let plate = FlexBodyBuilder::rectangle([SIZE, 0.5], [4, 2])
        .material(elastic(1e5, 1000.0, 1e-3))
        .angvel(turn / dt);
    let plate = scene.flexible(plate);
    let weld = AttachmentBuilder::weld(plate).where_(|[x, _]| x < 1e-9);
    scene
        .bodies
        .attach(weld.to_world(), &scene.world.bodies)
        .expect("the description is right");
    (scene, plate)
}

/// Largest component of a node's velocity (m/s).
fn fastest(scene: &Scene, plate: FlexBodyHandle) -> f64 {
    let velocities = scene.body(plate).velocities().iter();
    velocities.fold(0.0, |most, v| most.max(v.abs()))
}

/// A step that may be linearised or held: how often it was.
fn step(scene: &mut Scene) -> [usize; 2] {
    let report = scene.try_step().expect("no step is refused");
    [report.n_linearized(), report.n_held()]
}

#[test]
fn a_linearised_step_of_a_weld_never_ends_faster_than_it_began_and_than_across_the_body() {
    let mut findings = Findings::default();
    let (mut n_passed, mut n_held) = (0, 0);
    for rate in [30.0, 60.0] {
        for quarter in 1..=24 {
            let turn = 0.25 * f64::from(quarter);
            let (mut scene, plate) = spinning_plate(turn, 1.0 / rate);
            for index in 0..20 {
                let before = fastest(&scene, plate);
                let start = scene.body(plate).positions().to_vec();
                let [linearized, held] = step(&mut scene);
                if linearized == 0 {
                    continue;
                }
                n_passed += 1 - held;
                n_held += held;
                let after = fastest(&scene, plate);
                let context = || format!("{turn} rad, 1/{rate} s, step {index}");
                // The law itself: no tolerance.
                findings.check(after <= before.max(SIZE * rate), || {
                    format!("{}: {before} to {after} m/s", context())
                });
                let end = scene.body(plate).positions().iter().zip(&start);
                let moved = end.fold(0.0f64, |most, (end, start)| most.max((end - start).abs()));
                // Where it was, to the rounding of the frame; at rest, exactly.
                findings.check(held == 0 || (moved < 1e-12 && after == 0.0), || {
                    format!("{}: held, moves {moved:e} m to {after} m/s", context())
                });
            }
        }
    }
    println!("{n_passed} linearised steps taken, {n_held} held");
    assert!(
        n_passed > 0 && n_held > 0,
        "{n_passed} taken, {n_held} held"
    );
    findings.report();
}

#[test]
fn a_plate_whose_weld_cannot_be_solved_stands_still_once_it_is_held() {
    let (mut scene, plate) = spinning_plate(1.75, 1.0 / 30.0);
    assert_eq!(step(&mut scene), [1, 1]);
    assert_eq!(fastest(&scene, plate), 0.0);
    // Nothing is left that would fling it: the weld holds what stands where it stood.
    for _ in 0..30 {
        assert_eq!(step(&mut scene), [0, 0]);
    }
    assert!(fastest(&scene, plate) < 1e-9, "{}", fastest(&scene, plate));
}

#[test]
fn what_a_weld_stops_within_half_a_radian_a_step_loses_energy_and_needs_no_way_out() {
    for rate in [30.0, 60.0, 240.0] {
        let (mut scene, plate) = spinning_plate(0.25, 1.0 / rate);
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
