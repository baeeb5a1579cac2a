//! Bodies at and beyond the range of small strains: what they do there is what linear theory says, and the report tells of it.

mod common;

use common::*;
use std::f64::consts::PI;

const LENGTH: f64 = 4.0;
const WIDTH: f64 = 0.04;

fn strip(young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([LENGTH, WIDTH], [80, 1])
        .small_strain()
        .material(LinearElastic::plane_stress(young, 0.0).density(1000.0))
        .thickness(WIDTH)
}

/// Largest change of the area of a cell, relative.
fn area_change(body: &FlexBody) -> f64 {
    let area = |corners: &[usize], at: &dyn Fn(usize) -> [f64; 2]| -> f64 {
        (0..corners.len())
            .map(|i| {
                let (from, to) = (at(corners[i]), at(corners[(i + 1) % corners.len()]));
                0.5 * (from[0] * to[1] - to[0] * from[1])
            })
            .sum()
    };
    let cells = body.mesh().cells().map(|cell| {
        let rest = area(cell.corners(), &|node| body.mesh().nodes()[node]);
        (area(cell.corners(), &|node| body.position(node)) / rest - 1.0).abs()
    });
    cells.fold(0.0, f64::max)
}

/// ```text
///   o===============o   hinged at both ends, let go under its own weight:
///    `-.._______.-´    w(t) = Σ 4 g / (n π ω_n²) (1 - cos ω_n t) sin(n π / 2), n odd, ω_n = (n π / L)² sqrt(E I / m)
/// ```
///
/// A body of small strains is that beam, however far it falls: pins do no work, and energy is kept. It is not the string that a real strip
/// would be, and says so.
#[test]
fn a_strip_between_two_pins_is_a_linear_beam_and_tells_when_that_is_wrong() {
    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    let young = 1e7;
    let strip = scene.flexible(strip(young));
    for x in [0.0, LENGTH] {
        let pin = AttachmentBuilder::pin(strip).where_(move |[at, _]| (at - x).abs() < 1e-9);
        let bodies = &scene.world.bodies;
        scene
            .bodies
            .attach(pin.to_world(), bodies)
            .expect("it is there");
    }
    let nodes = scene.body(strip).mesh().nodes().iter();
    let middle = nodes
        .enumerate()
        .position(|(_, at)| (at[0] - 0.5 * LENGTH).abs() < 1e-6 && at[1] < 1e-9)
        .expect("a node in the middle");
    let per_mass = young * WIDTH.powi(2) / 12.0 / 1000.0;
    let sag = |time: f64| -> f64 {
        let modes = [(1.0, 1.0), (3.0, -1.0), (5.0, 1.0)].map(|(n, sign): (f64, f64)| {
            let omega = (n * PI / LENGTH).powi(2) * per_mass.sqrt();
            sign * 4.0 * G / (n * PI * omega * omega) * (1.0 - (omega * time).cos())
        });
        modes.iter().sum()
    };
    let start = energy_of(&scene);
    let mut told_at = None;
    for step in 1..=180 {
        scene.step();
        let time = f64::from(step) / 60.0;
        let (found, expected) = (-scene.body(strip).position(middle)[1], sag(time));
        // The first step begins with half of gravity's velocity; shear and the first modes' rotary inertia are 1e-4.
        assert!(
            (found - expected).abs() < 0.01 * expected + 0.01,
            "{found:.3} m after {time:.2} s, {expected:.3} m by theory"
        );
        let gained = energy_of(&scene) - start;
        assert!(
            gained.abs() < 1e-3 * scene.body(strip).mass() * G * expected,
            "{gained:.3e} J gained at {expected:.3} m"
        );
        let is_told = scene
            .report()
            .overbent()
            .iter()
            .any(|bent| bent.body == strip);
        if is_told && told_at.is_none() {
            told_at = Some((step, found));
        }
        assert_eq!(is_told, told_at.is_some(), "it hangs lower and lower");
    }
    let (_, told_at) = told_at.expect("a strip 37 m down is told of");
    // An end that has turned by φ leaves out 1 - cos φ; it sags by some φ L / π.
    let expected = 0.02f64.sqrt() * LENGTH / PI;
    assert!(
        told_at < 2.0 * expected,
        "told of at {told_at:.3} m, due at {expected:.3} m"
    );
}

/// The end of a clamped beam under an end load turns by `P L² / 2 E I`, and leaves out half the square of that.
#[test]
fn what_a_bent_beam_leaves_out_is_half_the_square_of_its_turn() {
    let (young, length, width) = (1e7, 1.0, 0.05);
    for (turn, is_told) in [(0.05, false), (0.2, true)] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let force = turn * 2.0 * young * width.powi(3) / 12.0 / (length * length);
        let beam = scene.flexible(
            FlexBodyBuilder::rectangle([length, width], [40, 4])
                .small_strain()
                .material(
                    LinearElastic::plane_stress(young, 0.0)
                        .density(1000.0)
                        .rayleigh(5e-2),
                )
                .pin_where(|[x, _]| x < 1e-9, Pin::both()),
        );
        let nodes = scene.body(beam).mesh().nodes();
        let end: Vec<usize> = (0..nodes.len())
            .filter(|&node| nodes[node][0] > length - 1e-9)
            .collect();
        for &node in &end {
            let share = force / end.len() as f64;
            scene.bodies[beam]
                .set_nodal_force(node, [0.0, -share])
                .expect("the force is a number");
        }
        scene.steps(600);
        let found = scene.body(beam).neglected_strain();
        let expected = 0.5 * turn * turn;
        // Shear bends the end's cells by a few parts in a hundred.
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{found:.3e} left out, {expected:.3e} by theory"
        );
        assert_eq!(!scene.report().overbent().is_empty(), is_told);
    }
}

/// A rope of one body is none: what its cells grow by is what is told.
#[test]
fn a_swinging_strip_tells_before_its_cells_grow() {
    let mut scene = Scene::new(1.0 / 60.0);
    let rope = scene.flexible(strip(1e7));
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(LENGTH + 0.2, 0.5 * WIDTH)),
        ColliderBuilder::ball(0.2).mass(5.0),
    );
    let pin = AttachmentBuilder::pin(rope).where_(|[x, _]| x < 1e-9);
    let bodies = &scene.world.bodies;
    scene
        .bodies
        .attach(pin.to_world(), bodies)
        .expect("it is there");
    let pin = AttachmentBuilder::pin(rope).where_(|[x, _]| x > LENGTH - 1e-9);
    let pin = pin.to_rigid_body(ball);
    scene.bodies.attach(pin, bodies).expect("both are there");
    let mut most = 0.0f64;
    for step in 0..180 {
        scene.step();
        let change = area_change(scene.body(rope));
        most = most.max(change);
        let is_told = !scene.report().overbent().is_empty();
        // An area grows by what is left out along both of its sides.
        assert!(
            change < 0.03 || is_told,
            "step {step}: a cell has changed by {change:.3} of its area"
        );
    }
    assert!(most > 1.0, "the rope is as far out of range as it was");
}

#[test]
fn a_stiff_body_that_turns_round_and_round_is_not_told_of() {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let plate = scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4])
            .small_strain()
            .material(elastic(1e9, 1000.0, 0.0))
            .angvel(5.0),
    );
    for _ in 0..120 {
        scene.step();
        assert!(scene.report().overbent().is_empty());
    }
    assert!(scene.body(plate).neglected_strain() < 1e-6);
}

/// Members with `β1 = 1` are as the ones beside them: only `β0 = β1 = 1` lets stored accelerations cancel out.
#[test]
fn results_are_continuous_in_the_parameters_of_the_integrator_where_a_whole_multiplier_acts_in_its_step()
 {
    let lands = |beta1: f64| {
        let member = Beta2::new(1.3, beta1).expect("a stable member");
        let mut scene = Scene::new(1.0 / 240.0).with_integrator(member);
        scene.ground(0.5);
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([0.6, 0.4], [4, 3])
                .small_strain()
                .material(elastic(1e6, 1000.0, 1e-3))
                .linvel([0.5, -1.0])
                .translation([0.0, 0.01]),
        );
        let shape = ColliderBuilder::cuboid(0.1, 0.1).density(500.0);
        let lying = RigidBodyBuilder::dynamic().translation(vec2(0.3, 0.515));
        scene.rigid(lying, shape);
        for _ in 0..40 {
            scene.try_step().expect("nothing is wrong with it");
        }
        scene.body(block).positions().to_vec()
    };
    let [one, beside] = [1.0, 1.0 - 1e-9].map(lands);
    let pairs = one.iter().zip(&beside);
    let apart = pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-6, "{apart:e} m apart");
}

/// Gravity along a wall that a plate is clamped to: its weight at half of its height, whatever the mesh. One row of nodes inside cannot carry the
/// mass of a surface without it so that the centre stays where it is.
#[test]
fn a_clamped_plate_weighs_at_its_centre_on_any_mesh() {
    for (sides, cells) in [
        ([2.0, 0.2], [12, 2]),
        ([1.0, 1.0], [2, 2]),
        ([2.0, 0.2], [12, 3]),
    ] {
        let mut scene = Scene::in_free_space(1.0 / 60.0).with_gravity(G, 0.0);
        let plate = FlexBodyBuilder::rectangle(sides, cells)
            .small_strain()
            .material(elastic(1e9, 1000.0, 5e-3))
            .pin_where(|[_, y]| y < 1e-9, Pin::both());
        let plate = scene.flexible(plate);
        scene.steps(600);
        let body = scene.body(plate);
        let moment = body.reaction_moment([0.5 * sides[0], 0.0]);
        let expected = body.mass() * G * 0.5 * sides[1];
        let error = moment.abs() / expected - 1.0;
        assert!(error.abs() < 1e-3, "{sides:?} m, {cells:?}: {error}");
    }
}
