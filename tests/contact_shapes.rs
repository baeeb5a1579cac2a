//! Every shape of rapier as ground under a flexible block, and as a body on a flexible slab.

mod common;

use common::*;
use foil2d::pipeline::Participant;

/// Overlap that rounding of rapier's poses explains, and none of ours (m).
fn gap_tolerance() -> f64 {
    by_precision(1e-6, 2e-9)
}

/// All shapes that can offer a level top at height zero from -3 to 3 m, with their names.
fn grounds() -> Vec<(&'static str, ColliderBuilder)> {
    let p = vec2;
    let trapezoid = |top: f64| [p(-3.0, top), p(3.0, top), p(2.0, -1.0), p(-2.0, -1.0)];
    let peaks = (-3..=3).map(|k| p(f64::from(k) + 0.03, 0.0)).collect();
    let corners = vec![p(-3.0, 0.0), p(0.1, 0.0), p(3.0, 0.0), p(0.1, -1.0)];
    let parts = vec![
        (
            Pose::from_translation(p(-1.4, -0.5)),
            SharedShape::cuboid(1.5, 0.5),
        ),
        (
            Pose::from_translation(p(1.6, -0.3)),
            SharedShape::round_cuboid(1.4, 0.2, 0.1),
        ),
    ];
    let at = |builder: ColliderBuilder, y: f64| builder.translation(p(0.0, y));
    let hull = ColliderBuilder::convex_hull(&trapezoid(0.0));
    let round_hull = ColliderBuilder::round_convex_hull(&trapezoid(-0.1), 0.1);
    let mesh = ColliderBuilder::trimesh(corners, vec![[0, 3, 1], [1, 3, 2]]);
    let triangle = ColliderBuilder::triangle(p(-3.0, 0.0), p(0.0, -2.0), p(3.0, 0.0));
    let round_triangle =
        ColliderBuilder::round_triangle(p(-3.0, -0.1), p(0.0, -2.0), p(3.0, -0.1), 0.1);
    let half_space = ColliderBuilder::new(SharedShape::halfspace(p(0.0, 1.0)));
    vec![
        ("cuboid", at(ColliderBuilder::cuboid(3.0, 0.5), -0.5)),
        (
            "round cuboid",
            at(ColliderBuilder::round_cuboid(3.0, 0.4, 0.1), -0.5),
        ),
        ("capsule", at(ColliderBuilder::capsule_x(3.0, 0.3), -0.3)),
        ("triangle", triangle),
        ("round triangle", round_triangle),
        (
            "segment",
            ColliderBuilder::segment(p(-3.0, 0.0), p(3.0, 0.0)),
        ),
        ("convex polygon", hull.expect("a hull")),
        ("round convex polygon", round_hull.expect("a hull")),
        ("half-space", half_space),
        ("polyline", ColliderBuilder::polyline(peaks, None)),
        ("triangle mesh", mesh.expect("a mesh")),
        (
            "height field",
            ColliderBuilder::heightfield(vec![0.0; 4], p(6.0, 1.0)),
        ),
        ("compound", ColliderBuilder::compound(parts)),
    ]
}

/// A unit block whose squeezing mode, `ω = π/2 sqrt(E / ρ)`, has a damping ratio of 0.3.
fn block() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).material(elastic(1e7, 1000.0, 3.8e-3))
}

#[test]
fn a_flexible_block_dropped_on_every_shape_comes_to_rest() {
    let mut findings = Findings::default();
    for rate in [60.0, 240.0] {
        for (name, ground) in grounds() {
            let mut scene = Scene::new(1.0 / rate);
            let ground = scene.fixed(ground);
            let block = scene.flexible(block().translation([-0.45, 0.05]));
            let mut gap = 0.0f64;
            for _ in 0..(3.0 * rate) as usize {
                gap = gap.max(scene.step().gap_violation());
            }
            let weight = scene.body(block).mass() * G;
            let [fx, fy] = scene.force_on_flexible(block);
            let error = (fx / weight).abs().max((fy / weight - 1.0).abs());
            findings.check(error < 1e-3, || {
                format!("{name}, dt 1/{rate}: force off by {error:e}")
            });
            findings.check(gap <= gap_tolerance(), || {
                format!("{name}, dt 1/{rate}: overlap of {gap:e} m")
            });
            // The ground pushes up, whichever of both sides is the contactor.
            let tilt = scene.report().contacts().iter().map(|contact| {
                let is_ground = contact.contactor == Participant::Rigid(ground);
                let sign = if is_ground { -1.0 } else { 1.0 };
                (sign * contact.normal[1] - 1.0).abs()
            });
            let tilt = tilt.fold(0.0, f64::max);
            findings.check(tilt < 1e-6, || {
                format!("{name}, dt 1/{rate}: normal off by {tilt:e}")
            });
        }
    }
    findings.report();
}

#[test]
fn a_flexible_plate_on_two_balls_shares_its_weight() {
    let mut scene = Scene::new(1.0 / 60.0);
    let balls =
        [0.0, 1.0].map(|x| scene.fixed(ColliderBuilder::ball(0.3).translation(vec2(x, -0.3))));
    let plate = scene.flexible(
        FlexBodyBuilder::rectangle([1.5, 0.5], [15, 5])
            .translation([-0.25, 0.05])
            .material(elastic(1e7, 1000.0, 1e-2)),
    );
    let mut gap = 0.0f64;
    for _ in 0..300 {
        gap = gap.max(scene.step().gap_violation());
    }
    assert!(gap <= gap_tolerance(), "overlap of {gap:e} m");
    let half = 0.5 * scene.body(plate).mass() * G;
    for ball in balls {
        let [_, fy] = scene.force_on_collider(ball);
        assert!(
            (-fy / half - 1.0).abs() < 1e-3,
            "a ball carries {fy} N, not {half} N"
        );
    }
}

/// Bodies that stand by themselves with their lowest points at height `-foot`, with their names.
fn bodies() -> Vec<(&'static str, ColliderBuilder, f64)> {
    let p = vec2;
    let pentagon = [p(-0.22, 0.0), p(0.22, 0.0), p(0.4, 0.3), p(-0.4, 0.3)];
    let parts = vec![
        (
            Pose::from_translation(p(-0.3, 0.1)),
            SharedShape::cuboid(0.12, 0.1),
        ),
        (Pose::from_translation(p(0.3, 0.1)), SharedShape::ball(0.1)),
        (
            Pose::from_translation(p(0.0, 0.25)),
            SharedShape::cuboid(0.4, 0.05),
        ),
    ];
    let [a, b, c] = [p(-0.33, 0.0), p(0.33, 0.0), p(0.0, 0.4)];
    let hull = ColliderBuilder::convex_hull(&pentagon);
    let round_hull = ColliderBuilder::round_convex_hull(&pentagon, 0.05);
    vec![
        ("ball", ColliderBuilder::ball(0.2), 0.2),
        ("cuboid", ColliderBuilder::cuboid(0.27, 0.2), 0.2),
        (
            "round cuboid",
            ColliderBuilder::round_cuboid(0.22, 0.15, 0.05),
            0.2,
        ),
        ("capsule", ColliderBuilder::capsule_x(0.27, 0.1), 0.1),
        ("triangle", ColliderBuilder::triangle(a, b, c), 0.0),
        (
            "round triangle",
            ColliderBuilder::round_triangle(a, b, c, 0.05),
            0.05,
        ),
        ("convex polygon", hull.expect("a hull"), 0.0),
        ("round convex polygon", round_hull.expect("a hull"), 0.05),
        ("compound", ColliderBuilder::compound(parts), 0.0),
    ]
}

#[test]
fn every_shape_dropped_on_a_flexible_slab_comes_to_rest() {
    let mut findings = Findings::default();
    for (young, rate) in [(1e7, 60.0), (1e7, 240.0), (2e11, 60.0)] {
        // On a node of the slab's surface, and between two.
        for x in [1.5, 1.437] {
            for (name, collider, foot) in bodies() {
                let mut scene = Scene::new(1.0 / rate);
                let slab = scene.flexible(
                    FlexBodyBuilder::rectangle([3.0, 0.5], [30, 5])
                        .material(
                            LinearElastic::plane_stress(young, 0.3)
                                .density(1000.0)
                                .rayleigh(1e-2 * (1e7 / young).sqrt()),
                        )
                        .pin_where(|[_, y]| y == 0.0, Pin::both()),
                );
                // The ball would roll to and fro in its own hollow for long.
                let damping = if name == "ball" { 5.0 } else { 0.0 };
                let (body, collider) = scene.rigid(
                    RigidBodyBuilder::dynamic()
                        .translation(vec2(x, 0.52 + foot))
                        .angular_damping(damping),
                    collider.density(1000.0),
                );
                let mut gap = 0.0f64;
                for _ in 0..(3.0 * rate) as usize {
                    gap = gap.max(scene.step().gap_violation());
                }
                let case = format!("{name} at {x}, E {young:e}, dt 1/{rate}");
                let weight = scene.mass(body) * G;
                let [fx, fy] = scene.force_on_collider(collider);
                let error = (fx / weight).abs().max((fy / weight - 1.0).abs());
                findings.check(error < 1e-3, || format!("{case}: force off by {error:e}"));
                findings.check(gap <= gap_tolerance(), || {
                    format!("{case}: overlap of {gap:e} m")
                });
                // Every contact pushes the body up and the slab down.
                let rises = scene.report().contacts().iter().all(|contact| {
                    let is_body = contact.contactor == Participant::Rigid(collider);
                    let sign = if is_body { 1.0 } else { -1.0 };
                    sign * contact.normal[1] > 0.9
                });
                findings.check(rises, || format!("{case}: a normal does not point up"));
                let opposite = scene.force_on_flexible(slab)[1] + fy;
                findings.check(opposite.abs() < 1e-9 * weight, || {
                    format!("{case}: action and reaction differ by {opposite:e} N")
                });
            }
        }
    }
    findings.report();
}

#[test]
fn a_moving_platform_carries_a_flexible_block() {
    for young in [1e6, 1e9] {
        let dt = 1.0 / 60.0;
        let mut scene = Scene::new(dt);
        let (platform, _) = scene.world.insert(
            RigidBodyBuilder::kinematic_velocity_based()
                .linvel(vec2(0.8, 0.0))
                .translation(vec2(0.0, -0.25)),
            ColliderBuilder::cuboid(2.0, 0.25).friction(0.6),
        );
        let omega = std::f64::consts::FRAC_PI_2 * (young / 1000.0f64).sqrt();
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
                .friction(0.6)
                .translation([-0.5, 0.0])
                .material(elastic(young, 1000.0, 0.6 / omega)),
        );
        // Friction brings the block to 0.8 m/s in 0.14 s; then the platform rises too.
        for velocity in [[0.8, 0.0], [0.8, 0.5]] {
            let [vx, vy] = velocity;
            scene.world.bodies[platform].set_linvel(vec2(vx, vy), true);
            scene.steps(240);
            let [bx, by] = scene.body(block).linvel();
            let error = (bx - vx).hypot(by - vy);
            assert!(
                error < 1e-4,
                "E {young:e}: the block is off by {error:e} m/s at {velocity:?}"
            );
            let weight = scene.body(block).mass() * G;
            let [fx, fy] = scene.force_on_flexible(block);
            let error = (fx / weight).hypot(fy / weight - 1.0);
            assert!(
                error < 1e-3,
                "E {young:e}: the force is off by {error:e} at {velocity:?}"
            );
            let gap = scene.report().gap_violation();
            assert!(gap <= gap_tolerance(), "E {young:e}: overlap of {gap:e} m");
        }
    }
}

#[test]
fn a_block_that_slides_off_a_table_leaves_its_edge_without_a_step_in_doubt() {
    // In one step the corner of the table comes in through the block's bottom by some tenths of a millimetre and out beside its end. Pushed
    // back by so little it would lie beside the block, where nothing pushes: no force would do, and the step would be linearised.
    for (rate, stiffness) in [
        (30.0, 3e5),
        (60.0, 1e6),
        (60.0, 3e6),
        (60.0, 1e7),
        (60.0, 3e7),
        (60.0, 1e8),
        (120.0, 3e7),
    ] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.4);
        let table = ColliderBuilder::cuboid(0.5, 0.25).translation(vec2(0.0, 0.25));
        scene.fixed(table.friction(real(0.1)));
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([0.4, 0.3], [4, 3])
                .material(elastic(stiffness, 100.0, 1e-3))
                .translation([-0.2, 0.501])
                .friction(0.1)
                .linvel([2.0, 0.0]),
        );
        for step in 0..(2.0 * rate) as usize {
            let overlap = scene.step().gap_violation();
            assert!(
                overlap < gap_tolerance(),
                "{rate} Hz, {stiffness} Pa, step {step}: {overlap} m"
            );
        }
        let positions = scene.body(block).positions();
        let least = positions
            .iter()
            .step_by(2)
            .fold(f64::INFINITY, |a, &b| a.min(b));
        assert!(
            least > 0.5,
            "{rate} Hz, {stiffness} Pa: it lies beside the table, at {least} m"
        );
    }
}
