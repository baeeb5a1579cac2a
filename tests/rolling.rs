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
