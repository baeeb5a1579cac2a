//! Flexible bodies that turn about what they touch the ground with.

mod common;

use common::*;

/// A stiff square that falls on one of its corners and stays there by friction: velocity of the corner after the impact, as the whole body
/// moves, and what a rigid square would spin by (m/s, rad/s).
fn corner_after_impact(cells: usize, rate: f64) -> ([f64; 2], [f64; 2]) {
    let (side, tilt, speed) = (0.5, 0.3, 2.0);
    let mut scene = Scene::in_free_space(1.0 / rate);
    scene.ground(5.0);
    let square = FlexBodyBuilder::rectangle([side, side], [cells, cells])
        .material(elastic(1e11, 1000.0, 0.0))
        .friction(5.0)
        .rotation(tilt)
        .linvel([0.0, -speed])
        .translation([0.0, 0.01]);
    let square = scene.flexible(square);
    while scene.step().contacts().is_empty() {}
    let body = scene.body(square);
    let (centre, velocity) = (body.centre_of_mass(), body.linvel());
    let spin = body.state().frame.spin;
    let [x, y] = body.position(0);
    let corner = [
        velocity[0] - spin * (y - centre[1]),
        velocity[1] + spin * (x - centre[0]),
    ];
    let squared = 0.5 * side * side;
    let lever = squared.sqrt() * (std::f64::consts::FRAC_PI_4 + tilt).cos();
    (
        corner,
        [spin, -speed * lever / (side * side / 6.0 + squared)],
    )
}

#[test]
fn a_square_that_falls_on_its_corner_turns_about_that_corner() {
    for cells in [8, 12, 16] {
        let (corner, [spin, rigid]) = corner_after_impact(cells, 480.0);
        // A pivot one cell inside would leave the corner 0.06 to 0.12 m/s.
        let speed = corner[0].hypot(corner[1]);
        assert!(
            speed < 0.01,
            "{cells} cells: the corner moves by {speed} m/s"
        );
        // The step of the impact turns it by 1e-3 rad before or after.
        assert!(
            (spin / rigid - 1.0).abs() < 0.02,
            "{cells} cells: {spin} of {rigid} rad/s"
        );
    }
}

/// A coarse disc of small strain rolls on a flat floor: which of its nodes touch changes with every step or two, and energy swings with that by more
/// than a step can take back. What it owes is paid by what it loses, and by nothing that drives it.
#[test]
fn a_soft_disc_does_not_roll_faster_by_itself() {
    for young in [1e5, 3e5] {
        let (radius, speed) = (0.22, 0.3);
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        let soft = elastic(young, 1000.0, 2e-3);
        let disc = FlexBodyBuilder::disc(radius, 0.09)
            .material(soft)
            .small_strain()
            .friction(0.5)
            .translation([0.0, radius])
            .linvel([speed, 0.0])
            .angvel(-speed / radius);
        let disc = scene.flexible(disc);
        // What it brings, and what it falls by as it is pressed flat.
        let began = scene.body(disc).energy().kinetic;
        let mass = scene.body(disc).mass();
        scene.steps(600);
        let ends = scene.body(disc).energy().kinetic;
        assert!(
            ends < began,
            "E {young:.0e}: {began} J, {ends} J in the end"
        );
        let sunk = radius - scene.body(disc).centre_of_mass()[1];
        let dissipated = scene.report().energy().dissipated;
        let most = began + mass * 9.81 * sunk;
        assert!(
            (0.0..=most).contains(&dissipated),
            "E {young:.0e}: {dissipated} J of {most} are heat"
        );
    }
}
