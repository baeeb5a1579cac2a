//! What the report says of overlaps, against overlaps measured in the world that the step left.

mod common;

use common::*;
use foil2d::pipeline::Participant;

/// Positions that rapier holds in `f32` differ from the flexible stage's by their rounding (m).
const ROUNDING: f64 = 2e-6;

/// How deep a flexible body and a collider are in each other (m): its boundary nodes in the shape, and the corners in its outline.
fn overlap(scene: &Scene, body: &FlexBody, collider: ColliderHandle) -> f64 {
    let collider = &scene.world.colliders[collider];
    let pose = collider.position();
    let nodes = body.mesh().boundary().nodes().iter();
    let of_nodes = nodes.map(|&node| {
        let [x, y] = body.position(node);
        let found = collider.shape().project_point(pose, vec2(x, y), false);
        let depth = f64::from((found.point - vec2(x, y)).length());
        if found.is_inside { depth } else { 0.0 }
    });
    let (corners, radius) = match (collider.shape().as_cuboid(), collider.shape().as_capsule()) {
        (Some(cuboid), _) => {
            let [x, y] = [cuboid.half_extents.x, cuboid.half_extents.y];
            let corners = [[x, y], [-x, y], [-x, -y], [x, -y]];
            (corners.map(|[x, y]| pose * Vector::new(x, y)).to_vec(), 0.0)
        }
        (_, Some(capsule)) => {
            let ends = [capsule.segment.a, capsule.segment.b];
            (
                ends.map(|end| pose * end).to_vec(),
                f64::from(capsule.radius),
            )
        }
        _ => (Vec::new(), 0.0),
    };
    let of_corners = corners.into_iter().map(|corner| {
        let [x, y] = [f64::from(corner.x), f64::from(corner.y)];
        radius - from_outline(body, [x, y])
    });
    of_nodes.chain(of_corners).fold(0.0, f64::max)
}

/// Steps a scene; whatever the way out, the report tells the overlap, and steps that were solved leave none. Returns how many were not.
fn watch(scene: &mut Scene, seconds: f64, pairs: &[(FlexBodyHandle, ColliderHandle)]) -> usize {
    let n_steps = (seconds / scene.dt()).round() as usize;
    let mut n_other = 0;
    for step in 0..n_steps {
        let report = scene.try_step().expect("the step can be taken");
        let told = report.gap_violation();
        let is_solved = report.n_cut() + report.n_unfinished() == 0;
        n_other += usize::from(!is_solved);
        for &(flexible, collider) in pairs {
            let there = overlap(scene, scene.body(flexible), collider);
            assert!(
                there <= told + ROUNDING,
                "step {step}: {there:e} m, {told:e} told"
            );
            assert!(!is_solved || there <= 1e-5, "step {step}: {there:e} m");
        }
    }
    n_other
}

fn slab(scene: &mut Scene, young: f64) -> FlexBodyHandle {
    scene.flexible(
        FlexBodyBuilder::rectangle([4.0, 0.5], [32, 4])
            .material(elastic(young, 1000.0, 1e-4))
            .translation([-2.0, -0.5])
            .friction(0.5)
            .pin_where(|[_, y]| y < 1e-9, Pin::both()),
    )
}

#[test]
fn what_spins_down_on_a_slab_is_never_deeper_in_it_than_the_report_says() {
    let shapes = [
        (ColliderBuilder::cuboid(0.3, 0.1), 16.5),
        (ColliderBuilder::capsule_x(0.2, 0.1), 16.5),
        (ColliderBuilder::capsule_x(0.2, 0.1), -28.5),
    ];
    let (mut n_other, mut n_runs) = (0, 0);
    for young in [1e6, 1e7, 1e9] {
        for (shape, spin) in &shapes {
            for rate in [60.0, 240.0] {
                let mut scene = Scene::new(1.0 / rate);
                let slab = slab(&mut scene, young);
                let (_, collider) = scene.rigid(
                    RigidBodyBuilder::dynamic()
                        .translation(vec2(0.0, 0.6))
                        .angvel(real(*spin)),
                    shape.clone().density(1000.0).friction(0.5),
                );
                n_other += watch(&mut scene, 1.5, &[(slab, collider)]);
                n_runs += 1;
            }
        }
    }
    // Bodies that turn by half a radian in a step may ask for a way out once.
    assert!(n_other <= n_runs / 3, "{n_other} steps of {n_runs} runs");
}

#[test]
fn heavy_boxes_flush_with_the_edges_of_light_flexible_ones_are_solved_at_any_step() {
    for rate in [30.0, 60.0, 120.0] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.5);
        let mut pairs = Vec::new();
        let mut height = 0.0;
        for level in 0..2 {
            let flexible = scene.flexible(
                FlexBodyBuilder::rectangle([0.5, 0.2], [6, 3])
                    .material(elastic(1e9, 100.0, 1e-4))
                    .translation([-0.25, height]),
            );
            // A hundred times as heavy as what carries it, and as wide: corners lie on corners.
            let (_, collider) = scene.rigid(
                RigidBodyBuilder::dynamic().translation(vec2(0.0, height + 0.3)),
                ColliderBuilder::cuboid(0.25, 0.1).density(if level == 1 { 1e4 } else { 100.0 }),
            );
            pairs.push((flexible, collider));
            height += 0.4;
        }
        assert_eq!(
            watch(&mut scene, 1.5, &pairs),
            0,
            "steps with a way out at 1/{rate} s"
        );
    }
}

/// A block of cells of this size (m), a metre wide.
fn block(cell: f64, height: f64) -> FlexBodyBuilder {
    let divisions = [1.0, 0.5].map(|side| (side / cell) as usize);
    FlexBodyBuilder::rectangle([1.0, 0.5], divisions)
        .material(elastic(1e7, 1000.0, 5e-3))
        .translation([-0.5, height])
        .friction(0.5)
}

/// Heights of the lowest and of the highest node (m).
fn heights(body: &FlexBody) -> [f64; 2] {
    let heights = (0..body.n_nodes()).map(|node| body.position(node)[1]);
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
        [low.min(y), high.max(y)]
    })
}

/// What is shown between things that rest on each other: the offset that is documented above what has no thickness, and nothing above what
/// has an inside, flexible bodies among them.
#[test]
fn a_block_at_rest_shows_its_contact_offset_and_nothing_else() {
    let line = ColliderBuilder::polyline(vec![vec2(-5.0, 0.0), vec2(5.0, 0.0)], None);
    let field = ColliderBuilder::heightfield(vec![0.0; 5], vec2(10.0, 1.0));
    let solid = ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5));
    let space = ColliderBuilder::new(SharedShape::halfspace(vec2(0.0, 1.0)));
    let floors = [
        ("line", line, 1.0),
        ("field", field, 1.0),
        ("solid", solid, 0.0),
        ("space", space, 0.0),
    ];
    for (name, floor, share) in floors {
        for cell in [0.25, 0.0625] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.fixed(floor.clone().friction(0.5));
            let body = scene.flexible(block(cell, 0.02));
            scene.steps(120);
            let offset = scene.body(body).contact_offset();
            assert!((offset - 0.01 * cell).abs() < 1e-6 * cell, "{offset} m");
            let [low, _] = heights(scene.body(body));
            let error = low - share * offset;
            assert!(
                error.abs() < 1e-6 * offset,
                "{low} m above a {name}, offset {offset} m"
            );
        }
    }
    for cells in [[0.25, 0.0625], [0.0625, 0.25]] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        let [lower, upper] =
            [(cells[0], 0.01), (cells[1], 0.53)].map(|(cell, at)| scene.flexible(block(cell, at)));
        scene.steps(180);
        let offsets = [lower, upper].map(|body| scene.body(body).contact_offset());
        let mut gap = f64::INFINITY;
        for [one, other] in [[lower, upper], [upper, lower]] {
            let outline = scene.body(one);
            let nodes = scene.body(other).mesh().boundary().nodes().iter();
            gap = nodes
                .map(|&node| from_outline(outline, scene.body(other).position(node)))
                .fold(gap, f64::min);
        }
        // Corners that lie on corners touch to the second order in how far the two surfaces are turned against each other.
        assert!(
            gap.abs() < 1e-3 * offsets[0].min(offsets[1]),
            "{gap} m, offsets {offsets:?}"
        );
    }
}

/// Distance of a point from the surface of a participant of a contact (m).
fn from_surface(scene: &Scene, participant: Participant, point: [f64; 2]) -> f64 {
    match participant {
        Participant::Flex(body) => from_outline(scene.body(body), point).abs(),
        Participant::Rigid(collider) => {
            let collider = &scene.world.colliders[collider];
            let [x, y] = point;
            let found = (collider.shape()).project_point(collider.position(), vec2(x, y), false);
            f64::from((found.point - vec2(x, y)).length())
        }
    }
}

/// On a lift that goes up at 3 m/s, sideways and turns, where everything moves by decimetres in a few steps: the place of a contact is that where the step
/// ends, on the surfaces of both.
#[test]
fn contacts_are_where_the_surfaces_are() {
    for is_large in [false, true] {
        let mut scene = Scene::new(1.0 / 60.0);
        let velocity = [1.0, 3.0];
        let lift = RigidBodyBuilder::kinematic_velocity_based()
            .translation(vec2(0.0, -0.5))
            .linvel(vec2(velocity[0], velocity[1]))
            .angvel(0.3);
        scene.rigid(lift, ColliderBuilder::cuboid(5.0, 0.5).friction(0.5));
        let mut flexible = |body: FlexBodyBuilder| {
            let body = body
                .material(elastic(1e6, 1000.0, 1e-3))
                .friction(0.3)
                .linvel(velocity);
            scene.flexible(match is_large {
                true => body.large_strain(),
                false => body.small_strain(),
            });
        };
        flexible(FlexBodyBuilder::rectangle([0.6, 0.2], [12, 4]).translation([-0.3, 0.0]));
        flexible(FlexBodyBuilder::disc(0.15, 0.05).translation([1.0, 0.2]));
        flexible(FlexBodyBuilder::rectangle([0.2, 0.2], [4, 4]).translation([-0.1, 0.25]));
        let mut rigid = |shape: ColliderBuilder, at: [f64; 2], spin: f64| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vec2(at[0], at[1]))
                .linvel(vec2(velocity[0], velocity[1]))
                .angvel(real(spin));
            scene.rigid(body, shape.density(500.0));
        };
        rigid(ColliderBuilder::ball(0.1), [0.0, 0.6], 0.0);
        rigid(ColliderBuilder::cuboid(0.08, 0.08), [0.2, 0.35], 3.0);
        rigid(ColliderBuilder::capsule_x(0.08, 0.05), [0.9, 0.6], -8.0);
        rigid(ColliderBuilder::ball(0.1), [-1.0, 0.3], -8.0);
        let (mut n_contacts, mut n_in_parts) = (0, 0);
        for step in 0..120 {
            let report = scene.step();
            // What has opened in an earlier part of a step is told where it was.
            if report.n_parts() > 1 {
                n_in_parts += 1;
                continue;
            }
            let contacts = report.contacts().to_vec();
            for contact in &contacts {
                // Surfaces are a hundredth of an edge apart, or overlap by as much as is told.
                let most = 1e-3 + contact.gap.abs();
                for participant in [contact.contactor, contact.target] {
                    let off = from_surface(&scene, participant, contact.position);
                    assert!(
                        off < most,
                        "step {step}: {off:.1e} m from {participant:?}, {contact:?}"
                    );
                }
            }
            n_contacts += contacts.len();
        }
        assert!(n_contacts > 1000, "{n_contacts} contacts");
        assert!(n_in_parts < 12, "{n_in_parts} steps in parts");
    }
}
