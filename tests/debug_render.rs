//! Flexible bodies as lines of rapier's debug renderer.

use foil2d::fe::mesh::{CellKind, Mesh, generate};
use foil2d::pipeline::FlexDebugRender;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// Keeps what is drawn, and draws nothing of one collider.
#[derive(Default)]
struct Recorder {
    lines: Vec<(ColliderHandle, Vector, Vector, DebugColor)>,
    hidden: Option<ColliderHandle>,
}

impl DebugRenderBackend for Recorder {
    fn filter_object(&self, object: DebugRenderObject) -> bool {
        collider_of(object) != self.hidden
    }

    fn draw_line(&mut self, object: DebugRenderObject, a: Vector, b: Vector, color: DebugColor) {
        let collider = collider_of(object).expect("lines belong to colliders");
        self.lines.push((collider, a, b, color));
    }
}

fn collider_of(object: DebugRenderObject) -> Option<ColliderHandle> {
    match object {
        DebugRenderObject::Collider(handle, _) => Some(handle),
        _ => None,
    }
}

fn beam(kind: CellKind) -> FlexBodyBuilder {
    let mesh = generate::rectangle([1.0, 0.1], [10, 2], kind).expect("a mesh");
    FlexBodyBuilder::mesh(mesh)
        .material(
            LinearElastic::plane_stress(1e8, 0.3)
                .density(1000.0)
                .rayleigh(1e-2),
        )
        .can_sleep(false)
}

/// A clamped beam that bends under its weight, and a block that rests on the ground.
struct Scene {
    world: PhysicsWorld,
    bodies: FlexBodySet,
    pipeline: FlexPipeline,
    clamped: FlexBodyHandle,
    block: FlexBodyHandle,
}

fn settled() -> Scene {
    let mut world = PhysicsWorld::new();
    world.insert_collider(
        ColliderBuilder::cuboid(20.0, 0.5).translation(Vector::new(0.0, -0.5)),
        None,
    );
    let mut bodies = FlexBodySet::new();
    let clamped = beam(CellKind::Quad4)
        .translation([0.0, 3.0])
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let clamped = bodies.insert(clamped, &mut world).expect("a beam");
    let block = beam(CellKind::Tri6).translation([5.0, 0.0]);
    let block = bodies.insert(block, &mut world).expect("a block");
    let mut pipeline = FlexPipeline::new();
    for _ in 0..300 {
        pipeline.step(&mut world, &mut bodies).expect("a step");
    }
    Scene {
        world,
        bodies,
        pipeline,
        clamped,
        block,
    }
}

fn drawn(scene: &Scene, drawing: &FlexDebugRender, hidden: Option<ColliderHandle>) -> Recorder {
    let mut recorder = Recorder {
        hidden,
        ..Recorder::default()
    };
    drawing
        .render(
            &mut recorder,
            &scene.bodies,
            scene.pipeline.report(),
            &scene.world.colliders,
        )
        .expect("stresses");
    recorder
}

#[test]
fn every_edge_is_drawn_once_where_its_nodes_are() {
    let scene = settled();
    let meshes = FlexDebugRender {
        draws_contact_forces: false,
        ..FlexDebugRender::default()
    };
    let lines = drawn(&scene, &meshes, None).lines;
    for (handle, n_edges) in [
        (scene.clamped, 10 * 3 + 2 * 11),
        // Two triangles a quadrilateral, edges in two pieces.
        (scene.block, 2 * (10 * 3 + 2 * 11 + 20)),
    ] {
        let body = &scene.bodies[handle];
        let own: Vec<_> = lines
            .iter()
            .filter(|line| line.0 == body.collider_handle())
            .collect();
        assert_eq!(own.len(), n_edges);
        let expected: Vec<_> = body.mesh().edges();
        for (line, [a, b]) in own.iter().zip(expected) {
            let at = |node| {
                let [x, y] = body.position(node);
                Vector::new(x as f32 as _, y as f32 as _)
            };
            // f32 worlds round; f64 ones are asked for the same here.
            assert!((line.1 - at(a)).length() < 1e-6 && (line.2 - at(b)).length() < 1e-6);
        }
    }
}

#[test]
fn the_root_of_a_cantilever_has_the_loaded_colour_and_its_tip_the_slack_one() {
    let scene = settled();
    let drawing = FlexDebugRender {
        draws_contact_forces: false,
        ..FlexDebugRender::default()
    };
    let surface = scene.bodies[scene.clamped].collider_handle();
    let lines = drawn(&scene, &drawing, None).lines;
    let lines: Vec<_> = lines.iter().filter(|line| line.0 == surface).collect();
    let hue = |line: &&(ColliderHandle, Vector, Vector, DebugColor)| line.3[0];
    let hottest = lines
        .iter()
        .min_by(|a, b| hue(a).total_cmp(&hue(b)))
        .expect("lines");
    let coldest = lines
        .iter()
        .max_by(|a, b| hue(a).total_cmp(&hue(b)))
        .expect("lines");
    assert!(hottest.1.x < 0.11, "the root is loaded most");
    assert!(coldest.1.x > 0.89, "the tip is loaded least");
    assert!(
        hue(hottest) < 0.25 * drawing.slack_color[0] && hue(coldest) > 0.9 * drawing.slack_color[0]
    );
    let slack = FlexDebugRender {
        draws_stresses: false,
        ..drawing
    };
    let lines = drawn(&scene, &slack, None).lines;
    assert!(lines.iter().all(|line| line.3 == slack.slack_color));
}

#[test]
fn arrows_point_where_forces_act_and_add_up_to_the_weight() {
    let scene = settled();
    let scale = 1e-4;
    let drawing = FlexDebugRender {
        draws_meshes: false,
        metres_per_newton: Some(scale),
        ..FlexDebugRender::default()
    };
    let lines = drawn(&scene, &drawing, None).lines;
    let n_contacts = scene.pipeline.report().contacts().len();
    assert!(n_contacts > 0);
    assert_eq!(lines.len(), 3 * n_contacts, "a shaft and two barbs each");
    let shafts = lines.iter().step_by(3);
    let lifted: f64 = shafts
        .map(|line| f64::from(line.2.y - line.1.y) / scale)
        .sum();
    let weight = scene.bodies[scene.block].mass() * 9.81;
    // Shafts of centimetres end at coordinates of metres, in f32: some 1e-5.
    assert!((lifted / weight - 1.0).abs() < 1e-3, "{lifted} {weight}");
    assert!(
        lines.iter().all(|line| line.2.y.abs() < 1e-5),
        "they end on the ground"
    );
}

#[test]
fn what_the_backend_filters_is_not_drawn() {
    let scene = settled();
    let hidden = scene.bodies[scene.block].collider_handle();
    let lines = drawn(&scene, &FlexDebugRender::default(), Some(hidden)).lines;
    assert!(!lines.is_empty() && lines.iter().all(|line| line.0 != hidden));
}

#[test]
fn a_mesh_lists_every_edge_once() {
    let nodes = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mesh = Mesh::from_cells(nodes, CellKind::Tri3, &[[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    assert_eq!(mesh.edges(), [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]);
}
