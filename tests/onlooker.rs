//! The judge of the other tests sees what it is to see: overlaps of known depth, and energies of known size.

mod common;

use common::*;

/// A square of one metre with its lower left corner at the origin, and a body of this shape and place beside or in it.
fn square_and(shape: ColliderBuilder) -> Scene {
    let mut scene = Scene::in_free_space(1e-6);
    scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(elastic(1e6, 1000.0, 0.0)),
    );
    scene.fixed(shape);
    scene
}

/// Depth of the square's surface in a collider, and of the collider in it (m).
fn depth(shape: ColliderBuilder) -> f64 {
    let scene = square_and(shape);
    let (_, body) = scene.bodies.iter().next().expect("the square is there");
    let surface = body.collider_handle();
    let mut others = scene.world.colliders.iter();
    let (_, other) = others
        .find(|(handle, _)| *handle != surface)
        .expect("the other is there");
    Figure::of(other).depth_of_outline(&Outline::of(body))
}

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-6, "{value}, not {expected}");
}

#[test]
fn overlaps_have_their_depth_and_what_is_apart_has_none() {
    let at = |shape: ColliderBuilder, x: f64, y: f64| depth(shape.translation(vec2(x, y)));
    let cuboid = || ColliderBuilder::cuboid(0.3, 0.2);
    // On the upper face: just apart, and 5 cm deep, with corners between nodes; turned by an eighth, on its corner.
    assert_near(at(cuboid(), 0.4, 1.2001), 0.0);
    assert_near(at(cuboid(), 0.4, 1.15), 0.05);
    let square = || ColliderBuilder::cuboid(0.2, 0.2).rotation(real(std::f64::consts::FRAC_PI_4));
    assert_near(at(square(), 0.4, 0.97 + 0.08f64.sqrt()), 0.03);
    // The block's corner in the face of a large cuboid, and a ball that dips between two nodes.
    assert_near(at(ColliderBuilder::cuboid(2.0, 0.5), 1.0, -0.48), 0.02);
    let ball = || ColliderBuilder::ball(0.1);
    assert_near(at(ball(), 0.4, 1.09), 0.01);
    assert_near(at(ball(), 0.4, 1.2), 0.0);
    // A whole ball within it, 0.3 m from the nearest edge.
    assert_near(at(ball(), 0.5, 0.7), 0.4);
}

#[test]
fn the_ground_is_below_its_segments() {
    let line = |points: &[[f64; 2]]| {
        let points = points.iter().map(|&[x, y]| vec2(x, y)).collect();
        depth(ColliderBuilder::polyline(points, None))
    };
    assert_near(line(&[[-1.0, -0.01], [0.3, -0.01], [2.0, -0.01]]), 0.0);
    assert_near(line(&[[-1.0, 0.02], [0.3, 0.02], [2.0, 0.02]]), 0.02);
    // A peak that reaches up between two nodes, and one that runs the other way.
    assert_near(line(&[[-1.0, -1.0], [0.4, 0.04], [2.0, -1.0]]), 0.04);
    assert_near(line(&[[2.0, -1.0], [0.4, 0.04], [-1.0, -1.0]]), 0.04);
    let heights = ColliderBuilder::heightfield(vec![0.03; 5], vec2(4.0, 1.0));
    assert_near(depth(heights), 0.03);
}

#[test]
fn energy_and_momentum_are_those_of_the_textbook() {
    let mut scene = Scene::new(1e-6);
    scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
            .material(elastic(1e6, 1000.0, 0.0))
            .linvel([3.0, 0.0]),
    );
    let shape = ColliderBuilder::cuboid(0.5, 0.5).density(10.0);
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(5.0, 2.0))
        .linvel(vec2(0.0, 2.0))
        .angvel(6.0);
    scene.rigid(body, shape);
    // 1,000 kg at 0.5 m; 10 kg at 2 m with an inertia of 10 / 6 kg m². Redistributed mass keeps what moves as a whole.
    let expected = 4500.0 + 1000.0 * G * 0.5 + 20.0 + 30.0 + 10.0 * G * 2.0;
    let energy = energy_of(&scene);
    assert!(
        (energy / expected - 1.0).abs() < 1e-6,
        "{energy}, not {expected}"
    );
    let [x, y] = momentum_of(&scene);
    assert_near(x, 3000.0);
    assert!((y - 20.0).abs() < 1e-5);
    let (_, square) = scene.bodies.iter().next().expect("it is there");
    assert_near(thickness_of(square), 0.5);
}
