//! Queries see the deformed surface right after a step, and a hit can be told in terms of the mesh.

mod common;

use common::*;
use foil2d::fe::mesh::CellKind;
use foil2d::pipeline::Participant;

/// A beam held at its ends that sags under its weight by centimetres.
fn sagging() -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    let beam = FlexBodyBuilder::rectangle([4.0, 0.2], [32, 2])
        .material(elastic(1e8, 1000.0, 1e-2))
        .pin_where(|[x, _]| x == 0.0 || x == 4.0, Pin::both())
        .translation([-2.0, 1.0]);
    let beam = scene.flexible(beam);
    (scene, beam)
}

/// The top of the beam at some place: between the nodes of its upper row.
fn top(body: &FlexBody, x: f64) -> f64 {
    let row = 2 * 33..3 * 33;
    let nodes: Vec<[f64; 2]> = row.map(|node| body.position(node)).collect();
    let pair = nodes
        .windows(2)
        .find(|pair| pair[0][0] <= x && x <= pair[1][0]);
    let [[x0, y0], [x1, y1]] = pair.map(|pair| [pair[0], pair[1]]).expect("over the beam");
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}

#[test]
fn all_queries_see_the_deformed_surface_right_after_the_step() {
    let (mut scene, beam) = sagging();
    let tolerance = by_precision(2e-5, 1e-9);
    let filter = QueryFilter::default;
    for step in 0..40 {
        scene.step();
        let body = scene.body(beam);
        let surface = body.collider_handle();
        for x in [-1.3, -0.1, 0.77] {
            let y = top(body, x);
            let ray = Ray::new(vec2(x, 6.0), vec2(0.0, -1.0));
            let (hit, far) = scene
                .world
                .cast_ray(&ray, 10.0, true, filter())
                .expect("a hit");
            assert_eq!(hit, surface, "step {step}");
            assert!(
                (6.0 - f64::from(far) - y).abs() < tolerance,
                "step {step}: ray"
            );
            // A small ball falls on it, a little above the centre line's slope.
            let ball = foil2d::rapier::parry::shape::Ball::new(real(0.001));
            let from = Pose::from_translation(vec2(x, 6.0));
            let options =
                foil2d::rapier::parry::query::ShapeCastOptions::with_max_time_of_impact(10.0);
            let cast = scene
                .world
                .cast_shape(&from, vec2(0.0, -1.0), &ball, options, filter());
            let (hit, cast) = cast.expect("a hit");
            assert_eq!(hit, surface);
            let landed = 6.0 - f64::from(cast.time_of_impact) - 0.001;
            assert!(
                (landed - y).abs() < 1e-4,
                "step {step}: cast {landed} on {y}"
            );
            let near = vec2(x, y + 0.05);
            let (hit, projected) = scene
                .world
                .project_point(near, 1.0, true, filter())
                .expect("a hit");
            assert_eq!(hit, surface);
            let distance = f64::from((projected.point - near).length());
            assert!(
                distance < 0.05 + tolerance && distance > 0.049,
                "step {step}: {distance}"
            );
            let touches = |dy: f64| {
                let shape = foil2d::rapier::parry::shape::Ball::new(real(0.01));
                let at = Pose::from_translation(vec2(x, y + dy));
                let mut found = scene.world.intersect_shape(at, &shape, filter());
                found.any(|(handle, ..)| handle == surface)
            };
            assert!(
                touches(0.009) && !touches(0.011),
                "step {step}: intersection"
            );
        }
    }
    assert!(top(scene.body(beam), 0.0) < 1.19, "it sags");
}

#[test]
fn a_hit_is_told_by_body_segment_weights_and_node() {
    let (mut scene, beam) = sagging();
    let other = scene.flexible(
        FlexBodyBuilder::disc(0.4, 0.1)
            .material(LinearElastic::plane_stress(1e6, 0.3).density(100.0))
            .translation([5.0, 1.0]),
    );
    scene.steps(20);
    let body = scene.body(beam);
    for share in [0.1, 0.25, 0.6, 0.9] {
        // Between two nodes of the upper row.
        let [a, b] = [body.position(80), body.position(81)];
        let at: [f64; 2] = std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]));
        let ray = Ray::new(vec2(at[0], 6.0), vec2(0.0, -1.0));
        let hit = scene
            .world
            .cast_ray(&ray, 10.0, true, QueryFilter::default());
        let (collider, far) = hit.expect("a hit");
        let point = ray.point_at(far);
        let point = [f64::from(point.x), f64::from(point.y)];
        let (handle, pick) = scene.bodies.pick(collider, point).expect("a flexible body");
        assert_eq!(handle, beam);
        let mut nodes = pick.nodes;
        nodes.sort_unstable();
        assert_eq!(nodes, [80, 81]);
        assert_eq!(body.mesh().boundary().segments()[pick.segment], pick.nodes);
        assert_eq!(pick.node, if share < 0.5 { 80 } else { 81 });
        let of_second = pick.weights[pick
            .nodes
            .iter()
            .position(|&node| node == 81)
            .expect("one of both")];
        let tolerance = by_precision(1e-4, 1e-9);
        assert!(
            (of_second - share).abs() < tolerance,
            "{of_second} not {share}"
        );
        assert!((pick.weights[0] + pick.weights[1] - 1.0).abs() < 1e-15);
        assert!(pick.distance < tolerance);
        let error = (pick.position[0] - at[0]).hypot(pick.position[1] - at[1]);
        assert!(error < tolerance, "{error} m");
    }
    assert_eq!(
        scene
            .bodies
            .of_collider(scene.body(other).collider_handle()),
        Some(other)
    );
    let floor = scene.ground(0.5);
    assert!(scene.bodies.pick(floor, [0.0, 0.0]).is_none());
    let [x, y] = scene.body(other).centre_of_mass();
    assert!(
        scene.body(other).contains([x + 0.39, y]) && !scene.body(other).contains([x + 0.41, y])
    );
    let outside = scene.body(other).pick([x + 1.0, y]);
    assert!(
        (outside.distance - 0.6).abs() < 0.02,
        "{}",
        outside.distance
    );
}

/// A block that does not bulge presses the floor evenly: by its weight over its width, at a corner the mean of two sides of which one is free.
#[test]
fn the_pressure_of_contact_is_the_force_over_the_surface() {
    for (is_large, turn) in [(true, 0.0), (false, 0.0), (true, 0.5), (false, 0.5)] {
        let mut scene = Scene::new(1.0 / 60.0);
        let (sin, cos) = f64::sin_cos(turn);
        scene.world.gravity = vec2(G * sin, -G * cos);
        let plane = ColliderBuilder::new(SharedShape::halfspace(vec2(-sin, cos))).friction(0.0);
        let floor = scene.world.insert_collider(plane, None);
        let material = LinearElastic::plane_stress(1e7, 0.0)
            .density(1000.0)
            .rayleigh(2e-2);
        let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
            .material(material)
            .thickness(0.2)
            .friction(0.0)
            .rotation(turn)
            .translation([-2e-4 * sin, 2e-4 * cos]);
        let block = match is_large {
            true => block.large_strain(),
            false => block.small_strain(),
        };
        let block = scene.flexible(block);
        for _ in 0..180 {
            scene.step();
        }
        let report = scene.step().clone();
        let body = scene.body(block);
        let even = 1000.0 * G;
        for (node, expected) in [(0, 0.5), (1, 1.0), (2, 1.0), (3, 1.0), (4, 0.5)] {
            let found = body.contact_pressure(node) / even;
            assert!(
                (found / expected - 1.0).abs() < 5e-3,
                "node {node}: {found} of the even pressure, large {is_large}, turned {turn}"
            );
        }
        // In the middle, and on top.
        assert_eq!([12, 22].map(|node| body.contact_pressure(node)), [0.0; 2]);
        let own: Vec<_> = report.contacts_of(Participant::Flex(block)).collect();
        assert_eq!(
            own.len(),
            report.contacts_of(Participant::Rigid(floor)).count()
        );
        assert!(own.len() >= 5, "{} contacts", own.len());
        let normal: f64 = own.iter().map(|contact| contact.normal_force).sum();
        assert!((normal / (200.0 * G) - 1.0).abs() < 1e-3, "{normal} N");
    }
}

/// A block between a floor and its own top, which is pushed down evenly: whatever cells it has, and whatever their nodes stand for.
#[test]
fn an_even_pressure_is_met_at_corners_and_midsides_alike() {
    for kind in [
        CellKind::Tri3,
        CellKind::Quad4,
        CellKind::Tri6,
        CellKind::Quad8,
    ] {
        for is_large in [false, true] {
            let mut scene = Scene::in_free_space(1.0 / 120.0);
            scene.fixed(
                ColliderBuilder::cuboid(5.0, 0.5)
                    .translation(vec2(0.5, -0.5))
                    .friction(0.0),
            );
            let block = FlexBodyBuilder::rectangle_of([1.0, 0.5], [8, 4], kind)
                .material(
                    LinearElastic::plane_strain(1e6, 0.0)
                        .density(1000.0)
                        .rayleigh(3e-2),
                )
                .thickness(0.3)
                .friction(0.0)
                .pin_where(|[_, y]| y == 0.5, Pin::both());
            let block = scene.flexible(match is_large {
                true => block.large_strain(),
                false => block.small_strain(),
            });
            let nodes = scene.body(block).mesh().nodes().to_vec();
            for step in 1..=300 {
                let down = -0.005 * (f64::from(step) / 100.0).min(1.0);
                for (node, place) in nodes.iter().enumerate() {
                    if place[1] == 0.5 {
                        let body = &mut scene.bodies[block];
                        body.set_pin_displacement(node, [0.0, down]).expect("a pin");
                    }
                }
                scene.step();
            }
            let body = scene.body(block);
            let even = body.total_contact_force()[1] / 0.3;
            let below = |&(_, place): &(usize, &[f64; 2])| {
                place[1] == 0.0 && place[0] > 0.0 && place[0] < 1.0
            };
            let mut n_nodes = 0;
            for (node, place) in nodes.iter().enumerate().filter(below) {
                let found = body.contact_pressure(node) / even;
                assert!(
                    (found - 1.0).abs() < 1e-3,
                    "{kind:?} at {}: {found} of the even pressure, large {is_large}",
                    place[0]
                );
                n_nodes += 1;
            }
            assert!(n_nodes >= 7, "{n_nodes} nodes");
        }
    }
}

/// What was put elsewhere is found there before the next step, and no more where it was.
#[test]
fn queries_see_what_was_put_elsewhere_at_once() {
    let mut scene = Scene::new(1.0 / 60.0);
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [2, 2])
        .material(elastic(1e6, 1000.0, 1e-2))
        .translation([0.0, 3.0]);
    let block = scene.flexible(block);
    scene.step();
    let put = scene
        .bodies
        .set_position(block, [7.0, 5.0], 0.0, &mut scene.world);
    put.expect("it is there");
    let hit = |x: f64, y: f64| {
        let ray = Ray::new(vec2(x, y + 1.0), vec2(0.0, -1.0));
        let hit = (scene.world).cast_ray(&ray, 1.5, true, QueryFilter::default());
        hit.map(|(hit, far)| (hit, f64::from(far)))
    };
    let (found, far) = hit(7.0, 5.0).expect("the block");
    assert_eq!(found, scene.body(block).collider_handle());
    assert!((far - 0.8).abs() < 1e-5, "{far} m");
    assert_eq!(hit(0.2, 3.2), None);
    // What is out of the world is found nowhere.
    let scene = &mut scene;
    let out = scene.bodies.set_enabled(block, false, &mut scene.world);
    out.expect("it is there");
    let put = scene
        .bodies
        .set_position(block, [-7.0, 5.0], 0.0, &mut scene.world);
    put.expect("it is there");
    let ray = Ray::new(vec2(-7.0, 6.0), vec2(0.0, -1.0));
    let hit = (scene.world).cast_ray(&ray, 1.5, true, QueryFilter::default());
    assert_eq!(hit, None);
}
