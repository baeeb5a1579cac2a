//! Bad input gives a typed error that names the culprit and the cure and changes nothing; the world goes on after it.

mod common;

use common::{elastic, motion_of, sick_flexible};
use foil2d::body::{BuildError, FlexBodyError};
use foil2d::fe::material::MaterialError;
use foil2d::fe::mesh::MeshError;
use foil2d::fe::model::ModelError;
use foil2d::integrator::IntegratorError;
use foil2d::pipeline::StepError;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn rubber() -> LinearElastic {
    elastic(1e6, 1000.0, 2e-3)
}

fn square() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [3, 3]).material(rubber())
}

/// A square of this size (m).
fn square_of(size: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([size, size], [3, 3]).material(rubber())
}

/// Builds nodes and cells of one kind into a body.
fn raw<const N: usize>(
    nodes: &[[f64; 2]],
    kind: CellKind,
    cells: &[[usize; N]],
) -> FlexBodyBuilder {
    FlexBodyBuilder::cells(nodes.to_vec(), kind, cells).material(rubber())
}

/// A world with a floor, a rigid box on it and a flexible block beside it.
struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
    block: FlexBodyHandle,
    crate_body: RigidBodyHandle,
}

impl Scene {
    fn new() -> Self {
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(20.0, 0.5).translation(Vector::new(0.0, -0.5));
        world.insert_collider(floor, None);
        let (crate_body, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.5, 1.26))
                .can_sleep(false),
            ColliderBuilder::cuboid(0.25, 0.25).density(200.0),
        );
        let mut flex_bodies = FlexBodySet::new();
        let block = flex_bodies
            .insert(square().translation([0.0, 0.001]), &mut world)
            .expect("a sound body");
        Self {
            world,
            flex_bodies,
            flex: FlexPipeline::new(),
            block,
            crate_body,
        }
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.flex
            .step(&mut self.world, &mut self.flex_bodies)
            .map(|_| ())
    }

    fn counts(&self) -> [usize; 3] {
        [
            self.world.bodies.len(),
            self.world.colliders.len(),
            self.flex_bodies.len(),
        ]
    }

    /// All that a failed call must leave alone, as bits. A body's first accelerations are no motion of its own: the
    /// step that starts it finds them from the loads.
    fn state(&self) -> Vec<u64> {
        let mut state = Vec::new();
        for (_, body) in self.flex_bodies.iter() {
            let motion = body.state();
            for values in [
                &motion.position,
                &motion.velocity,
                &motion.displacement,
                &motion.rate,
            ] {
                state.extend(values.iter().map(|x| x.to_bits()));
            }
        }
        for (_, body) in self.world.rigid_bodies() {
            state.extend(motion_of(body).map(f64::to_bits));
            state.push(u64::from(body.locked_axes().bits()));
        }
        state
    }

    /// The motion of the block as bits.
    fn block_state(&self) -> Vec<u64> {
        let motion = self.flex_bodies[self.block].state();
        let all = motion.position.iter().chain(&motion.velocity);
        all.map(|x| x.to_bits()).collect()
    }

    fn reinstate(&mut self) {
        let world = &mut self.world;
        self.flex_bodies
            .reinstate(self.block, &mut world.bodies, &mut world.colliders)
            .expect("a handle of this set");
    }

    #[track_caller]
    fn assert_flexible_state_is_finite(&self) {
        assert_eq!(sick_flexible(&self.flex_bodies), None);
    }

    /// Steps for a second without an error and finds the block resting on the floor.
    #[track_caller]
    fn assert_goes_on(&mut self) {
        for _ in 0..60 {
            self.step().expect("the world goes on");
        }
        self.assert_flexible_state_is_finite();
        let body = &self.flex_bodies[self.block];
        let y = body.centre_of_mass()[1];
        assert!((y - 0.5).abs() < 0.05, "the block is at {y} m");
    }
}

/// Holds that a body is refused with `expected`, in words that hold all of `said`, and that nothing changed.
#[track_caller]
fn assert_refused(builder: FlexBodyBuilder, expected: impl Fn(&BuildError) -> bool, said: &[&str]) {
    let mut scene = Scene::new();
    let (counts, state) = (scene.counts(), scene.state());
    let error = scene
        .flex_bodies
        .insert(builder, &mut scene.world)
        .expect_err("this body must be refused");
    assert!(expected(&error), "{error:?}");
    let message = error.to_string();
    for word in said {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
    assert_eq!(counts, scene.counts(), "{message}");
    assert_eq!(state, scene.state(), "{message}");
}

/// Holds that a call on a body fails with `expected` and changes nothing.
#[track_caller]
fn assert_setter_refuses(
    call: impl Fn(&mut FlexBody) -> Result<(), FlexBodyError>,
    expected: impl Fn(&FlexBodyError) -> bool,
    said: &[&str],
) {
    let mut scene = Scene::new();
    let state = scene.state();
    let before = format!("{:?}", scene.flex_bodies[scene.block]);
    let error = call(&mut scene.flex_bodies[scene.block]).expect_err("this call must be refused");
    assert!(expected(&error), "{error:?}");
    let message = error.to_string();
    for word in said {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
    assert_eq!(before, format!("{:?}", scene.flex_bodies[scene.block]));
    assert_eq!(state, scene.state());
    scene.assert_goes_on();
}

const UNIT: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

#[test]
fn cells_without_area_clockwise_or_folded_are_refused_by_number() {
    let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    assert_refused(
        raw(&line, CellKind::Tri3, &[[0, 1, 2]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::DegenerateCell { cell: 0, .. })
            )
        },
        &["cell 0", "reshape"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Quad4, &[[0, 3, 2, 1]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::InvertedCell { cell: 0, .. })
            )
        },
        &["cell 0", "counter-clockwise"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Tri3, &[[0, 1, 2], [0, 3, 2]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::InvertedCell { cell: 1, .. })
            )
        },
        &["cell 1", "counter-clockwise"],
    );
    let dart = [[0.0, 0.0], [1.0, 0.0], [0.3, 0.3], [0.0, 1.0]];
    assert_refused(
        raw(&dart, CellKind::Quad4, &[[0, 1, 2, 3]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::FoldedCell { node: 2, .. })
            )
        },
        &["cell 0", "node 2", "convex"],
    );
    // A bow tie has no area at all when it is symmetric.
    assert_refused(
        raw(&UNIT, CellKind::Quad4, &[[0, 1, 3, 2]]),
        |error| matches!(error, BuildError::Mesh(_)),
        &["cell 0"],
    );
}

#[test]
fn orphan_nodes_and_indices_out_of_range_are_refused_by_number() {
    let five = [UNIT[0], UNIT[1], UNIT[2], UNIT[3], [5.0, 5.0]];
    assert_refused(
        raw(&five, CellKind::Quad4, &[[0, 1, 2, 3]]),
        |error| matches!(error, BuildError::Mesh(MeshError::OrphanNode { node: 4 })),
        &["node 4", "remove it"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Quad4, &[[0, 1, 2, 9]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::NodeOutOfRange { node: 9, .. })
            )
        },
        &["cell 0", "node 9", "4 nodes"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Tri3, &[[0, 1, usize::MAX]]),
        |error| matches!(error, BuildError::Mesh(MeshError::NodeOutOfRange { .. })),
        &["cell 0", "from zero"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Tri3, &[[0, 1, 1]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::RepeatedNode { node: 1, .. })
            )
        },
        &["cell 0", "node 1", "once"],
    );
    assert_refused(
        raw(&UNIT, CellKind::Quad4, &[[0, 1, 2]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::WrongNodeCount { found: 3, .. })
            )
        },
        &["cell 0", "needs 4 nodes"],
    );
    assert_refused(
        raw::<3>(&[], CellKind::Tri3, &[]),
        |error| matches!(error, BuildError::Mesh(MeshError::NoNodes)),
        &["no nodes"],
    );
    assert_refused(
        raw::<3>(&UNIT, CellKind::Tri3, &[]),
        |error| matches!(error, BuildError::Mesh(MeshError::NoCells)),
        &["no cells"],
    );
}

#[test]
fn a_boundary_that_crosses_itself_is_refused_with_the_place() {
    // A strip of six quadrilaterals bent into a ring whose last cell lies over its first.
    let mut nodes = Vec::new();
    for station in 0..=6 {
        let angle = 1.15 * f64::from(station);
        for radius in [1.0, 2.0] {
            nodes.push([radius * angle.cos(), radius * angle.sin()]);
        }
    }
    let cells: Vec<[usize; 4]> = (0..6)
        .map(|cell| [2 * cell, 2 * cell + 1, 2 * cell + 3, 2 * cell + 2])
        .collect();
    let strip = FlexBodyBuilder::cells(nodes, CellKind::Quad4, &cells).material(rubber());
    assert_refused(
        strip,
        |error| matches!(error, BuildError::Mesh(_)),
        &["boundary", "move"],
    );
    let eight = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert_refused(
        FlexBodyBuilder::polygon(&eight, &[], 0.2).material(rubber()),
        |error| matches!(error, BuildError::Mesh(MeshError::OutlineCrossing { .. })),
        &["ring 0", "simple"],
    );
    let hole = vec![[3.0, 3.0], [3.0, 4.0], [4.0, 4.0]];
    assert_refused(
        FlexBodyBuilder::polygon(&UNIT, &[hole], 0.2).material(rubber()),
        |error| matches!(error, BuildError::Mesh(MeshError::HoleOutside { .. })),
        &["hole", "inside"],
    );
    // Two squares that share a corner hang together in a point; two that share nothing are two bodies.
    let seven = [
        UNIT[0],
        UNIT[1],
        UNIT[2],
        UNIT[3],
        [2.0, 1.0],
        [2.0, 2.0],
        [1.0, 2.0],
    ];
    assert_refused(
        raw(&seven, CellKind::Quad4, &[[0, 1, 2, 3], [2, 4, 5, 6]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::TouchingLoops { node: 2 })
            )
        },
        &["node 2"],
    );
    let apart = [
        UNIT[0],
        UNIT[1],
        UNIT[2],
        [5.0, 0.0],
        [6.0, 0.0],
        [6.0, 1.0],
    ];
    assert_refused(
        raw(&apart, CellKind::Tri3, &[[0, 1, 2], [3, 4, 5]]),
        |error| {
            matches!(
                error,
                BuildError::Mesh(MeshError::Disconnected { n_pieces: 2, .. })
            )
        },
        &["2 pieces", "body"],
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused_wherever_a_builder_takes_one() {
    type Set = fn(f64) -> FlexBodyBuilder;
    let setters: [(&str, Set); 21] = [
        ("translation", |x| square().translation([x, 0.0])),
        ("translation", |x| square().translation([0.0, x])),
        ("rotation", |x| square().rotation(x)),
        ("linvel", |x| square().linvel([x, 0.0])),
        ("linvel", |x| square().linvel([0.0, x])),
        ("angvel", |x| square().angvel(x)),
        ("body_force", |x| square().body_force([x, 0.0])),
        ("body_force", |x| square().body_force([0.0, x])),
        ("gravity_scale", |x| square().gravity_scale(x)),
        ("friction", |x| square().friction(x)),
        ("restitution", |x| square().restitution(x)),
        ("thickness", |x| square().thickness(x)),
        ("nodal_force", |x| square().nodal_force(3, [x, 0.0])),
        ("nodal_force", |x| square().nodal_force(3, [0.0, x])),
        ("velocities", |x| square().velocities(vec![[0.0, x]; 16])),
        ("Young", |x| {
            square().material(LinearElastic::plane_stress(x, 0.3).density(1.0))
        }),
        ("Poisson", |x| {
            square().material(LinearElastic::plane_stress(1e6, x).density(1.0))
        }),
        ("density", |x| square().material(rubber().density(x))),
        ("damping", |x| square().material(rubber().rayleigh(x))),
        ("damping", |x| square().material(rubber().rayleigh_mass(x))),
        ("node 2", |x| {
            let mut nodes = UNIT;
            nodes[2][1] = x;
            raw(&nodes, CellKind::Quad4, &[[0, 1, 2, 3]])
        }),
    ];
    for (culprit, set) in setters {
        for bad in BAD {
            assert_refused(set(bad), |_| true, &[culprit]);
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_the_mesh_generators() {
    type Make = fn(f64) -> FlexBodyBuilder;
    let generators: [Make; 8] = [
        |x| FlexBodyBuilder::rectangle([x, 1.0], [2, 2]),
        |x| FlexBodyBuilder::rectangle([1.0, x], [2, 2]),
        |x| FlexBodyBuilder::disc(x, 0.1),
        |x| FlexBodyBuilder::disc(1.0, x),
        |x| FlexBodyBuilder::annulus(x, 1.0, 0.1),
        |x| FlexBodyBuilder::annulus(0.5, x, 0.1),
        |x| FlexBodyBuilder::polygon(&[[0.0, 0.0], [x, 0.0], [0.0, 1.0]], &[], 0.1),
        |x| FlexBodyBuilder::polygon(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[], x),
    ];
    for make in generators {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0] {
            // A mirrored or flat triangle is a clockwise or crossing outline and may be put right.
            let builder = make(bad).material(rubber());
            let is_sound = builder.clone().build().is_ok();
            if is_sound && bad == -1.0 {
                continue;
            }
            assert_refused(builder, |error| matches!(error, BuildError::Mesh(_)), &[]);
        }
    }
    for divisions in [[0, 2], [2, 0]] {
        assert_refused(
            FlexBodyBuilder::rectangle([1.0, 1.0], divisions).material(rubber()),
            |error| matches!(error, BuildError::Mesh(_)),
            &["must be"],
        );
    }
}

#[test]
fn numbers_that_rapier_cannot_hold_are_refused() {
    // 1e300 is a finite f64 and an infinite f32; in the f64 build rapier's own boxes overflow when they are measured. Bodies that were
    // taken with such velocities overflowed in their first step, and rapier's islands with them.
    let far: [(&str, FlexBodyBuilder); 14] = [
        ("translation", square().translation([1e300, 0.0])),
        ("translation", square().translation([0.0, -1e300])),
        ("rotation", square().rotation(1e300)),
        ("linvel", square().linvel([1e100, 0.0])),
        ("linvel", square().linvel([0.0, 1e20])),
        ("angvel", square().angvel(1e100)),
        // A number that can be held, and velocities of nodes that cannot.
        ("velocity of a node", square_of(100.0).angvel(1e18)),
        (
            "velocity of a node",
            square().velocities(vec![[1e20, 0.0]; 16]),
        ),
        ("body_force", square().body_force([1e100, 0.0])),
        ("gravity_scale", square().gravity_scale(-1e100)),
        ("skin", square().contact_skin(1e300)),
        (
            "threshold",
            square().contact_force_event_threshold(f64::NAN),
        ),
        ("friction", square().friction(1e300)),
        ("restitution", square().restitution(1e300)),
    ];
    for (culprit, builder) in far {
        assert_refused(builder, |_| true, &[culprit]);
    }
}

#[test]
fn material_parameters_out_of_range_are_refused_with_the_range() {
    for young in [0.0, -2e11] {
        assert_refused(
            square().material(LinearElastic::plane_stress(young, 0.3).density(1.0)),
            |error| matches!(error, BuildError::Material(MaterialError::Young { .. })),
            &["Young's modulus", "positive"],
        );
    }
    for nu in [0.5, 0.7, -1.0] {
        assert_refused(
            square().material(LinearElastic::plane_strain(1e6, nu).density(1.0)),
            |error| {
                matches!(
                    error,
                    BuildError::Material(MaterialError::PoissonPlaneStrain { .. })
                )
            },
            &["Poisson's ratio", "below 0.5"],
        );
    }
    assert_refused(
        square().material(LinearElastic::plane_stress(1e6, 0.6).density(1.0)),
        |error| {
            matches!(
                error,
                BuildError::Material(MaterialError::PoissonPlaneStress { .. })
            )
        },
        &["Poisson's ratio", "up to 0.5"],
    );
    for density in [0.0, -1.0] {
        assert_refused(
            square().material(LinearElastic::plane_stress(1e6, 0.3).density(density)),
            |error| matches!(error, BuildError::Material(MaterialError::Density { .. })),
            &["density", "positive"],
        );
    }
    assert_refused(
        square().material(rubber().rayleigh(-1e-3)),
        |error| {
            matches!(
                error,
                BuildError::Material(MaterialError::DampingStiffness { .. })
            )
        },
        &["damping", "zero or a positive"],
    );
    for thickness in [0.0, -0.1] {
        assert_refused(
            square().thickness(thickness),
            |error| matches!(error, BuildError::Model(ModelError::Thickness(_))),
            &["thickness", "positive"],
        );
    }
    for (name, builder) in [
        ("friction", square().friction(-0.1)),
        ("restitution", square().restitution(-0.1)),
    ] {
        let is_number = |error: &BuildError| matches!(error, BuildError::Number { .. });
        assert_refused(builder, is_number, &[name, "positive"]);
    }
    assert_refused(
        FlexBodyBuilder::rectangle([1.0, 1.0], [2, 2]),
        |error| matches!(error, BuildError::NoMaterial),
        &["no material", ".material("],
    );
}

#[test]
fn settings_that_name_a_missing_node_are_refused_by_number() {
    let is_node = |error: &BuildError| matches!(error, BuildError::Node { node: 16, .. });
    assert_refused(
        square().nodal_force(16, [1.0, 0.0]),
        is_node,
        &["nodal_force", "node 16", "below 16"],
    );
    assert_refused(
        square().pin(16, Pin::both()),
        is_node,
        &["pin", "node 16", "below 16"],
    );
    assert_refused(
        square().contact_inertia(ContactInertia::RedistributedAt(vec![0, 16])),
        is_node,
        &["contact_inertia", "node 16", "below 16"],
    );
    assert_refused(
        square().velocities(vec![[0.0; 2]; 15]),
        |error| matches!(error, BuildError::Length { found: 15, .. }),
        &["velocities", "15", "16 nodes", "one per node"],
    );
}

#[test]
fn pins_that_leave_a_rotation_are_refused_with_both_cures() {
    // Bodies of large strain may turn about their pins.
    let bound = || square().small_strain();
    // Nodes of the square count from its lower left corner, four to a row.
    let on_one_vertical = bound().pin(0, Pin::y()).pin(4, Pin::y());
    let on_one_horizontal = bound().pin(0, Pin::x()).pin(1, Pin::x());
    let guide_and_roller = bound().pin(0, Pin::x()).pin(0, Pin::default());
    let crossing = bound().pin(0, Pin::x()).pin(15, Pin::y());
    for builder in [
        on_one_vertical,
        on_one_horizontal,
        guide_and_roller,
        crossing,
    ] {
        assert_refused(
            builder,
            |error| matches!(error, BuildError::RotatingPins),
            &["rotate", "hinge", "holds the rotation"],
        );
    }
    // Far from the origin the same pins leave the same rotation.
    assert_refused(
        bound()
            .translation([1e4, 1e4])
            .pin(0, Pin::y())
            .pin(4, Pin::y()),
        |error| matches!(error, BuildError::RotatingPins),
        &[],
    );
}

#[test]
fn small_bodies_far_from_the_origin_may_be_pinned() {
    // Two supports 1 mm apart hold the rotation wherever the body is.
    let bar = FlexBodyBuilder::rectangle([1e-3, 1e-3], [2, 2])
        .material(rubber())
        .translation([1e7, 0.0])
        .pin(0, Pin::both())
        .pin(2, Pin::y());
    assert!(bar.build().is_ok());
}

#[test]
fn integrator_parameters_out_of_range_are_refused_with_the_range() {
    for beta0 in BAD.into_iter().chain([0.0, -0.1, 2.1]) {
        let error = Beta2::new(beta0, 0.5).expect_err("beta0 is out of range");
        assert!(matches!(
            error,
            IntegratorError::Parameter { name: "beta0", .. }
        ));
        assert!(error.to_string().contains("(0, 2]"), "{error}");
    }
    for beta1 in BAD.into_iter().chain([0.49, -0.5, 1.6]) {
        let error = Beta2::new(0.5, beta1).expect_err("beta1 is out of range");
        assert!(matches!(
            error,
            IntegratorError::Parameter { name: "beta1", .. }
        ));
        assert!(error.to_string().contains("[1/2, 3/2]"), "{error}");
    }
    for rho in BAD.into_iter().chain([-0.1, 1.1]) {
        let error = Beta2::damped(rho).expect_err("rho is out of range");
        assert!(error.to_string().contains("[0, 1]"), "{error}");
    }
}

#[test]
fn an_integrator_unstable_for_the_mesh_is_refused_by_body_and_a_shorter_step_goes_on() {
    let mut scene = Scene::new();
    let stiff = square()
        .small_strain()
        .translation([5.0, 3.0])
        .contact_inertia(ContactInertia::Kept);
    let stiff = scene
        .flex_bodies
        .insert(stiff, &mut scene.world)
        .expect("a sound body");
    let (crate_body, block) = (scene.crate_body, scene.block);
    scene
        .flex_bodies
        .remove(block, &mut scene.world)
        .expect("the body is there");
    scene.world.remove_body(crate_body);
    scene.flex = FlexPipeline::new().with_integrator(Beta2::linear_acceleration());
    let state = scene.state();
    let error = scene.step().expect_err("the step is too long");
    let StepError::Integrator {
        body,
        source: IntegratorError::Unstable { dt, critical, .. },
    } = error
    else {
        panic!("{error:?}");
    };
    assert!(body == stiff && critical < dt);
    let message = error.to_string();
    for word in ["shorten the step", "critical step", "flexible body"] {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
    assert_eq!(state, scene.state());
    // Within the limit it flies as it should: after 100 short steps it has fallen g t²/2.
    scene.world.integration_parameters.dt = (0.5 * critical) as Real;
    for _ in 0..100 {
        scene.step().expect("the step is short enough");
    }
    let t = 100.0 * f64::from(scene.world.integration_parameters.dt);
    let fallen = 3.5 - scene.flex_bodies[stiff].centre_of_mass()[1];
    assert!((fallen - 0.5 * 9.81 * t * t).abs() < 1e-6, "{fallen} m");
}

/// What no step could compute is refused by the builder, which names it: sizes beyond rapier's precision, and mass or stiffness
/// that overflow or vanish.
#[test]
fn bodies_too_large_too_heavy_or_too_soft_to_compute_are_refused() {
    let square = |side: f64| FlexBodyBuilder::rectangle([side, side], [2, 2]);
    let plain = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    for side in [1e19, 1e30] {
        let error = square(side).material(plain).build().expect_err("too large");
        assert!(matches!(error, BuildError::Place { .. }), "{error:?}");
        assert!(
            error.to_string().contains("make the body smaller"),
            "{error}"
        );
    }
    let cases = [
        ("mass", square(1.0).material(plain.density(1e300))),
        ("mass", square(1.0).material(plain.density(1e-200))),
        ("mass", square(1e-10).material(plain).thickness(1e-30)),
        (
            "stiffness",
            square(1.0).material(LinearElastic::plane_stress(1e200, 0.3).density(1.0)),
        ),
        (
            "stiffness",
            square(1.0).material(LinearElastic::plane_stress(1e-200, 0.3).density(1.0)),
        ),
    ];
    for (expected, builder) in cases {
        let error = builder.build().expect_err("out of range");
        let found = match &error {
            BuildError::OutOfRange { name, .. } => *name,
            _ => "",
        };
        assert_eq!(found, expected, "{error:?}");
        assert!(error.to_string().contains("choose units"), "{error}");
    }
    for side in [1e-6, 1e6] {
        square(side).material(plain).build().expect("ordinary");
    }
}

#[test]
fn step_lengths_that_are_negative_or_not_finite_are_refused() {
    for dt in BAD.into_iter().chain([-1.0 / 60.0, -1e-9]) {
        let mut scene = Scene::new();
        scene.step().expect("a sound step");
        let state = scene.state();
        let dt_before = scene.world.integration_parameters.dt;
        scene.world.integration_parameters.dt = dt as Real;
        let error = scene.step().expect_err("the step length is bad");
        assert!(matches!(error, StepError::StepLength(_)), "{error:?}");
        assert!(error.to_string().contains("zero or a positive"), "{error}");
        assert_eq!(state, scene.state());
        scene.world.integration_parameters.dt = dt_before;
        scene.assert_goes_on();
    }
}

#[test]
fn the_shortest_step_that_the_message_names_is_taken() {
    // Single precision holds 1e-8 as 9.99999994e-9.
    let mut scene = Scene::new();
    scene.world.integration_parameters.dt = 1e-8;
    scene.step().expect("the shortest step");
}

#[test]
fn step_lengths_beyond_reason_never_panic_and_never_leave_numbers_that_are_not_finite() {
    for dt in [
        1e-30, 1e-12, 1e-9, 1.1e-8, 1e-7, 1e-3, 10.0, 1e3, 1e6, 1e18, 1e30, 1e38,
    ] {
        let mut scene = Scene::new();
        for _ in 0..5 {
            scene.step().expect("a sound step");
        }
        let (state, dt_before) = (scene.state(), scene.world.integration_parameters.dt);
        scene.world.integration_parameters.dt = dt as Real;
        let mut is_refused = false;
        for _ in 0..3 {
            let outcome = scene.step();
            is_refused = matches!(outcome, Err(StepError::StepLength(_)));
            scene.assert_flexible_state_is_finite();
        }
        scene.world.integration_parameters.dt = dt_before;
        if is_refused {
            assert_eq!(state, scene.state(), "dt = {dt:e}");
        }
        for step in 0..30 {
            let outcome = scene.step();
            // A step of seconds lets bodies fall through floors, to wherever they then are.
            let may_be_lost = dt > 1.0 && !is_refused;
            assert!(
                may_be_lost || outcome.is_ok(),
                "dt = {dt:e}, step {step} after it: {outcome:?}"
            );
            scene.assert_flexible_state_is_finite();
        }
    }
}

#[test]
fn setters_refuse_missing_nodes_and_numbers_that_are_not_finite() {
    let is_node = |error: &FlexBodyError| matches!(error, FlexBodyError::Node { node: 16, .. });
    let is_bad = |error: &FlexBodyError| matches!(error, FlexBodyError::NotFinite(_));
    assert_setter_refuses(
        |body| body.set_nodal_force(16, [0.0; 2]),
        is_node,
        &["node 16", "below 16"],
    );
    assert_setter_refuses(
        |body| body.set_pin_displacement(16, [0.0; 2]),
        is_node,
        &["node 16", "below 16"],
    );
    assert_setter_refuses(
        |body| body.set_pin_displacement(3, [0.0; 2]),
        |error| matches!(error, FlexBodyError::NotPinned(3)),
        &["node 3", "pin it"],
    );
    for bad in BAD {
        assert_setter_refuses(
            |body| body.set_nodal_force(3, [0.0, bad]),
            is_bad,
            &["force"],
        );
        assert_setter_refuses(
            |body| body.set_body_force([bad, 0.0]),
            is_bad,
            &["body force"],
        );
        assert_setter_refuses(
            |body| body.set_gravity_scale(bad),
            is_bad,
            &["gravity scale"],
        );
        assert_setter_refuses(
            |body| {
                let mut velocities = vec![0.0; 32];
                velocities[31] = bad;
                body.set_velocities(&velocities)
            },
            is_bad,
            &["velocities"],
        );
    }
    for n in [0, 16, 31, 33, 64] {
        assert_setter_refuses(
            |body| body.set_velocities(&vec![0.0; n]),
            |_| true,
            &["velocities", &n.to_string(), "16 nodes"],
        );
    }
}

#[test]
fn a_prescribed_displacement_that_is_not_finite_is_refused() {
    let mut scene = Scene::new();
    let pinned = square()
        .translation([5.0, 3.0])
        .pin_where(|[_, y]| y == 0.0, Pin::both());
    let pinned = scene
        .flex_bodies
        .insert(pinned, &mut scene.world)
        .expect("a sound body");
    for bad in BAD {
        let outcome = scene.flex_bodies[pinned].set_pin_displacement(0, [bad, 0.0]);
        assert!(matches!(outcome, Err(FlexBodyError::NotFinite(_))));
    }
    scene.assert_goes_on();
}

#[test]
fn stale_and_foreign_handles_are_told_apart_and_change_nothing() {
    let mut scene = Scene::new();
    let mut other = Scene::new();
    let stale = scene
        .flex_bodies
        .insert(square().translation([5.0, 3.0]), &mut scene.world)
        .expect("a sound body");
    scene
        .flex_bodies
        .remove(stale, &mut scene.world)
        .expect("the body is there");
    // Its slot is used again; the old handle stays stale.
    let successor = scene
        .flex_bodies
        .insert(square().translation([5.0, 3.0]), &mut scene.world)
        .expect("a sound body");
    assert_ne!(stale, successor);
    let (counts, state) = (scene.counts(), scene.state());
    let cases = [
        (stale, FlexBodyError::Stale(stale), "drop the handle"),
        (
            other.block,
            FlexBodyError::Foreign(other.block),
            "the set that returned it",
        ),
        (
            FlexBodyHandle::default(),
            FlexBodyError::Foreign(FlexBodyHandle::invalid()),
            "never filled in",
        ),
    ];
    for (handle, expected, cure) in cases {
        assert!(expected.to_string().contains(cure), "{expected}");
        assert_eq!(scene.flex_bodies.try_get(handle).err(), Some(expected));
        assert_eq!(scene.flex_bodies.try_get_mut(handle).err(), Some(expected));
        assert!(scene.flex_bodies.get(handle).is_none());
        assert!(scene.flex_bodies.get_mut(handle).is_none());
        let removed = scene.flex_bodies.remove(handle, &mut scene.world);
        assert_eq!(removed.err(), Some(expected));
        assert_eq!(scene.flex_bodies.forget(handle).err(), Some(expected));
    }
    assert_eq!((counts, state), (scene.counts(), scene.state()));
    scene.assert_goes_on();
    other.assert_goes_on();
}

#[test]
fn a_body_whose_carrier_the_user_removed_stops_the_step_until_it_is_forgotten() {
    let mut scene = Scene::new();
    for _ in 0..10 {
        scene.step().expect("a sound step");
    }
    let carrier = scene.flex_bodies[scene.block].rigid_body_handle();
    scene.world.remove_body(carrier);
    let (counts, state) = (scene.counts(), scene.state());
    let error = scene.step().expect_err("the carrier is gone");
    let no_carrier = FlexBodyError::NoCarrier(scene.block);
    assert_eq!(error, StepError::Body(no_carrier));
    assert!(error.to_string().contains("remove the body from its set"));
    let removed = scene.flex_bodies.remove(scene.block, &mut scene.world);
    assert_eq!(removed.err(), Some(no_carrier));
    assert_eq!((counts, state), (scene.counts(), scene.state()));
    scene
        .flex_bodies
        .forget(scene.block)
        .expect("the set still holds it");
    scene.step().expect("the world goes on");
    scene.block = scene
        .flex_bodies
        .insert(square().translation([3.0, 0.001]), &mut scene.world)
        .expect("a sound body");
    scene.assert_goes_on();
}

/// A carrier never moves: what is meant for the body is told where it goes.
#[test]
fn a_carrier_that_was_given_a_velocity_is_refused_at_once() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let carrier = scene.flex_bodies[scene.block].rigid_body_handle();
    for motion in [(Vector::new(1.0, 0.0), 0.0), (Vector::ZERO, -2.0)] {
        scene.world.bodies[carrier].set_linvel(motion.0, true);
        scene.world.bodies[carrier].set_angvel(motion.1, true);
        let state = scene.state();
        let error = scene.step().expect_err("the carrier is driven");
        let driven = FlexBodyError::CarrierDriven(scene.block);
        assert_eq!(error, StepError::Body(driven));
        assert!(error.to_string().contains("FlexBody::set_linvel"));
        assert_eq!(state, scene.state());
    }
    scene.world.bodies[carrier].set_angvel(0.0, true);
    scene.step().expect("the world goes on");
    scene.assert_goes_on();
}

/// Nor is it of another type, pushed by forces, or shared with other colliders.
#[test]
fn a_carrier_that_was_changed_is_refused_at_once() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let carrier = scene.flex_bodies[scene.block].rigid_body_handle();
    let check = |scene: &mut Scene, expected: FlexBodyError| {
        let state = scene.state();
        let error = scene.step().expect_err("the carrier is another");
        assert_eq!(error, StepError::Body(expected));
        assert_eq!(state, scene.state());
    };
    let (driven, changed) = (
        FlexBodyError::CarrierDriven(scene.block),
        FlexBodyError::CarrierChanged(scene.block),
    );
    scene.world.bodies[carrier].add_force(Vector::new(5.0, 0.0), true);
    check(&mut scene, driven);
    scene.world.bodies[carrier].reset_forces(true);
    for kind in [
        RigidBodyType::Fixed,
        RigidBodyType::KinematicPositionBased,
        RigidBodyType::KinematicVelocityBased,
    ] {
        scene.world.bodies[carrier].set_body_type(kind, true);
        check(&mut scene, changed);
    }
    scene.world.bodies[carrier].set_body_type(RigidBodyType::Dynamic, true);
    let world = &mut scene.world;
    let ball = ColliderBuilder::ball(0.1);
    let ball = world
        .colliders
        .insert_with_parent(ball, carrier, &mut world.bodies);
    check(&mut scene, changed);
    scene.world.remove_collider(ball);
    scene.step().expect("the world goes on");
    scene.assert_goes_on();
}

#[test]
fn a_body_whose_surface_the_user_removed_stops_the_step() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let surface = scene.flex_bodies[scene.block].collider_handle();
    scene.world.remove_collider(surface);
    let state = scene.state();
    let error = scene.step().expect_err("the surface is gone");
    assert_eq!(
        error,
        StepError::Body(FlexBodyError::NoCarrier(scene.block))
    );
    assert_eq!(state, scene.state());
}

#[test]
fn a_world_that_is_not_the_bodys_own_is_refused_even_if_its_handles_look_alike() {
    // Both worlds were filled in the same order, so that the carriers have equal handles.
    let mut scene = Scene::new();
    let mut other = PhysicsWorld::new();
    for x in [0.0, 3.0, 6.0] {
        other.insert(
            RigidBodyBuilder::dynamic().translation(Vector::new(x, 5.0)),
            ColliderBuilder::ball(0.5),
        );
    }
    let carrier = scene.flex_bodies[scene.block].rigid_body_handle();
    assert!(other.bodies.contains(carrier), "the handles look alike");
    let (state, n_bodies) = (scene.state(), other.bodies.len());
    let outcome = scene
        .flex
        .step(&mut other, &mut scene.flex_bodies)
        .map(|_| ());
    assert_eq!(
        outcome,
        Err(StepError::Body(FlexBodyError::NoCarrier(scene.block)))
    );
    let removed = scene.flex_bodies.remove(scene.block, &mut other);
    assert_eq!(removed.err(), Some(FlexBodyError::NoCarrier(scene.block)));
    assert_eq!((state, n_bodies), (scene.state(), other.bodies.len()));
    scene.assert_goes_on();
}

#[test]
fn a_shape_the_user_put_in_place_of_the_surface_is_refused() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let surface = scene.flex_bodies[scene.block].collider_handle();
    let collider = scene
        .world
        .colliders
        .get_mut(surface)
        .expect("the surface is there");
    collider.set_shape(SharedShape::ball(0.5));
    let error = scene.step().expect_err("the surface is a ball");
    assert_eq!(
        error,
        StepError::Body(FlexBodyError::NoCarrier(scene.block))
    );
}

#[test]
fn numbers_that_are_not_finite_in_a_rigid_body_never_reach_a_flexible_one() {
    type Spoil = fn(&mut PhysicsWorld, RigidBodyHandle, Real);
    let spoils: [(&str, Spoil); 7] = [
        ("linvel", |world, body, bad| {
            world.bodies[body].set_linvel(Vector::new(bad, 0.0), true);
        }),
        ("angvel", |world, body, bad| {
            world.bodies[body].set_angvel(bad, true);
        }),
        ("translation", |world, body, bad| {
            world.bodies[body].set_translation(Vector::new(0.5, bad), true);
        }),
        ("force", |world, body, bad| {
            world.bodies[body].add_force(Vector::new(0.0, bad), true);
        }),
        ("torque", |world, body, bad| {
            world.bodies[body].add_torque(bad, true);
        }),
        ("shape", |world, body, bad| {
            let collider = world.bodies[body].colliders()[0];
            world.colliders[collider].set_shape(SharedShape::ball(bad));
        }),
        ("friction", |world, body, bad| {
            let collider = world.bodies[body].colliders()[0];
            world.colliders[collider].set_friction(bad);
        }),
    ];
    for (name, spoil) in spoils {
        for bad in [Real::NAN, Real::INFINITY] {
            let mut scene = Scene::new();
            for _ in 0..60 {
                scene.step().expect("a box on a block");
            }
            assert!(
                scene.flex.report().n_claimed() == 1,
                "the box is on the block"
            );
            spoil(&mut scene.world, scene.crate_body, bad);
            for step in 0..20 {
                let outcome = scene.step();
                if step == 0 {
                    println!("{name} = {bad}: {outcome:?}");
                }
                scene.assert_flexible_state_is_finite();
            }
            // Whatever happened, taking the culprit out lets the world go on.
            scene.world.remove_body(scene.crate_body);
            scene.assert_goes_on();
        }
    }
}

/// Rapier panics where it grows a box by less than nothing, at whichever collider it looks at.
#[test]
fn margins_that_no_box_can_grow_by_are_refused_wherever_the_collider_is() {
    type Spoil = fn(&mut Collider, Real);
    let spoils: [(&str, Spoil); 2] = [
        ("skin", |collider, bad| collider.set_contact_skin(bad)),
        ("rounding", |collider, bad| {
            collider.set_shape(SharedShape::round_cuboid(0.2, 0.2, bad));
        }),
    ];
    for warm_up in [0, 10] {
        for (name, spoil) in spoils {
            for bad in [Real::NAN, Real::INFINITY, Real::NEG_INFINITY, -1.0, 1e30] {
                for at in [0.0, 1e3] {
                    let mut scene = Scene::new();
                    let stone = scene.world.insert_collider(
                        ColliderBuilder::cuboid(0.2, 0.2).translation(Vector::new(at, -0.5)),
                        None,
                    );
                    for _ in 0..warm_up {
                        scene.step().expect("a sound step");
                    }
                    let state = scene.state();
                    let kept = scene.world.colliders[stone].clone();
                    spoil(&mut scene.world.colliders[stone], bad);
                    for _ in 0..2 {
                        let error = scene.step().expect_err(name);
                        assert_eq!(error, StepError::Margin(stone), "{name} = {bad} at {at} m");
                    }
                    assert_eq!(state, scene.state(), "{name} = {bad} at {at} m");
                    let stone = &mut scene.world.colliders[stone];
                    stone.set_contact_skin(kept.contact_skin());
                    stone.set_shape(kept.shared_shape().clone());
                    scene.assert_goes_on();
                }
            }
        }
    }
}

/// Where all sleeps there is nothing to do, but rapier looks at what was written to.
#[test]
fn a_margin_set_on_the_surface_of_a_sleeper_is_refused() {
    let mut scene = Scene::new();
    scene.world.remove_body(scene.crate_body);
    for _ in 0..1200 {
        scene.step().expect("a sound step");
    }
    assert_eq!(scene.flex.report().n_asleep(), 1, "the block sleeps");
    let surface = scene.flex_bodies[scene.block].collider_handle();
    scene.world.colliders[surface].set_contact_skin(-1.0);
    for _ in 0..2 {
        let error = scene.step().expect_err("a negative skin");
        assert_eq!(error, StepError::Margin(surface));
    }
    scene.world.colliders[surface].set_contact_skin(0.0);
    scene.assert_flexible_state_is_finite();
    scene.step().expect("a sound step");
}

#[test]
fn margins_of_a_disabled_collider_stop_nothing() {
    let mut scene = Scene::new();
    let stone = ColliderBuilder::cuboid(0.2, 0.2).translation(Vector::new(5.0, -0.5));
    let stone = scene
        .world
        .insert_collider(stone.contact_skin(Real::NAN).enabled(false), None);
    scene.assert_goes_on();
    scene.world.colliders[stone].set_enabled(true);
    let error = scene.step().expect_err("the collider takes part now");
    assert_eq!(error, StepError::Margin(stone));
    scene.world.colliders[stone].set_contact_skin(0.0);
    scene.assert_goes_on();
}

/// What lies in a body is measured, and told, step after step; what has no end is not.
#[test]
fn a_shape_without_an_end_given_to_what_lies_in_a_body_stops_nothing() {
    for warm_up in [0, 1, 5] {
        let mut scene = Scene::new();
        let at = Vector::new;
        let place = RigidBodyBuilder::kinematic_velocity_based().translation(at(0.5, 0.5));
        let (_, stone) = scene.world.insert(place, ColliderBuilder::cuboid(0.2, 0.2));
        for _ in 0..warm_up {
            scene.step().expect("a sound step");
        }
        let (corner, end) = (at(0.0, 0.3), at(0.3, Real::INFINITY));
        let endless = SharedShape::triangle(at(0.0, 0.0), end, corner);
        scene.world.colliders[stone].set_shape(endless);
        for _ in 0..3 {
            match scene.step() {
                Ok(()) => {}
                Err(StepError::Shape { collider, .. }) => assert_eq!(collider, stone),
                Err(error) => panic!("{error}"),
            }
            scene.assert_flexible_state_is_finite();
        }
    }
}

/// Rapier steps such shapes, or takes them out, so long as nothing of ours has to measure a distance to them.
#[test]
fn shapes_that_no_body_can_have_are_refused_by_name_where_they_are_met() {
    let nan = Real::NAN;
    let at = Vector::new;
    let shapes: [(&str, SharedShape); 10] = [
        ("normal", SharedShape::halfspace(at(0.0, 0.0))),
        ("normal", SharedShape::halfspace(at(nan, 1.0))),
        ("radius", SharedShape::ball(-1.0)),
        ("radius", SharedShape::capsule_x(0.5, -0.1)),
        ("radius", SharedShape::capsule_x(0.5, nan)),
        ("vertex", SharedShape::segment(at(nan, 0.0), at(1.0, 0.0))),
        (
            "vertex",
            SharedShape::triangle(at(0.0, 0.0), at(nan, 0.0), at(0.0, 1.0)),
        ),
        (
            "vertex",
            SharedShape::triangle(at(0.0, 0.0), at(0.3, Real::INFINITY), at(0.0, 0.3)),
        ),
        (
            "vertex",
            SharedShape::polyline(vec![at(-1.0, 0.0), at(nan, 0.1), at(1.0, 0.0)], None),
        ),
        ("half extent", SharedShape::cuboid(-0.5, 0.5)),
    ];
    for (index, (fault, shape)) in shapes.into_iter().enumerate() {
        for warm_up in [0, 10] {
            for is_crate in [false, true] {
                let mut scene = Scene::new();
                let stone = if is_crate {
                    scene.world.bodies[scene.crate_body].colliders()[0]
                } else {
                    let stone = ColliderBuilder::cuboid(0.1, 0.1).translation(at(0.5, 0.0));
                    scene.world.insert_collider(stone, None)
                };
                for _ in 0..warm_up {
                    scene.step().expect("a sound step");
                }
                let case = format!("{fault} of shape {index} after {warm_up} steps");
                let state = scene.state();
                let kept = scene.world.colliders[stone].shared_shape().clone();
                scene.world.colliders[stone].set_shape(shape.clone());
                for _ in 0..2 {
                    match scene.step() {
                        // Where rapier finds no box that is near, it meets nothing.
                        Ok(()) => {}
                        Err(error) => {
                            assert!(
                                matches!(error, StepError::Shape { collider, .. } if collider == stone),
                                "{case}: {error}"
                            );
                            let said = error.to_string();
                            assert!(said.contains(fault), "{case}: {said}");
                            assert_eq!(state, scene.state(), "{case}");
                        }
                    }
                }
                scene.assert_flexible_state_is_finite();
                scene.world.colliders[stone].set_shape(kept);
                scene.world.colliders[stone].set_enabled(true);
                scene.assert_flexible_state_is_finite();
            }
        }
    }
    // At least what has a place is met, and told of.
    for shape in [
        SharedShape::halfspace(at(0.0, 0.0)),
        SharedShape::capsule_x(0.5, -0.1),
    ] {
        let mut scene = Scene::new();
        let stone = ColliderBuilder::new(shape).translation(at(0.5, 0.0));
        let stone = scene.world.insert_collider(stone, None);
        let error = scene.step().expect_err("the shape is met");
        assert!(
            matches!(error, StepError::Shape { collider, .. } if collider == stone),
            "{error}"
        );
        scene.world.remove_collider(stone);
        scene.assert_goes_on();
    }
}

#[test]
fn a_prediction_distance_that_no_box_can_grow_by_is_refused_and_leaves_no_trace() {
    type Set = fn(&mut IntegrationParameters, Real);
    let parameters: [(&str, Set); 2] = [
        ("length unit", |all, value| all.length_unit = value),
        ("normalised distance", |all, value| {
            all.normalized_prediction_distance = value;
        }),
    ];
    for (name, set) in parameters {
        for bad in [
            Real::NAN,
            Real::INFINITY,
            Real::NEG_INFINITY,
            -1.0,
            Real::MAX,
        ] {
            for warm_up in [0, 1, 30] {
                let (mut scene, mut never) = (Scene::new(), Scene::new());
                for _ in 0..warm_up {
                    scene.step().expect("a sound step");
                    never.step().expect("a sound step");
                }
                let state = scene.state();
                let sound = scene.world.integration_parameters;
                set(&mut scene.world.integration_parameters, bad);
                let told = f64::from(scene.world.integration_parameters.prediction_distance());
                for _ in 0..2 {
                    let error = scene.step().expect_err("the boxes cannot grow");
                    // The number itself, of which NaN is not equal to itself.
                    let StepError::Prediction(distance) = error else {
                        panic!("{name} {bad}: {error}");
                    };
                    assert!(
                        distance.to_bits() == told.to_bits(),
                        "{distance}, not {told}"
                    );
                    let said = error.to_string();
                    assert!(said.contains("normalized_prediction_distance"), "{said}");
                    assert_eq!(state, scene.state(), "{name} {bad}");
                }
                scene.world.integration_parameters = sound;
                for _ in 0..30 {
                    scene.step().expect("the world goes on");
                    never.step().expect("the world goes on");
                    assert_eq!(scene.state(), never.state(), "{name} {bad}");
                }
                scene.assert_goes_on();
            }
        }
    }
}

#[test]
fn boxes_that_grow_by_nothing_still_collide() {
    let mut scene = Scene::new();
    scene
        .world
        .integration_parameters
        .normalized_prediction_distance = 0.0;
    scene.assert_goes_on();
}

#[test]
fn gravity_that_is_not_finite_is_refused_and_leaves_no_trace() {
    for warm_up in [0, 10] {
        for bad in [Real::NAN, Real::INFINITY] {
            let mut scene = Scene::new();
            for _ in 0..warm_up {
                scene.step().expect("a sound step");
            }
            let state = scene.state();
            let gravity = scene.world.gravity;
            scene.world.gravity = Vector::new(0.0, bad);
            for _ in 0..2 {
                let outcome = scene.step();
                assert!(outcome.is_err(), "gravity {bad} after {warm_up} steps");
                scene.assert_flexible_state_is_finite();
            }
            assert_eq!(state, scene.state(), "gravity {bad} after {warm_up} steps");
            scene.world.gravity = gravity;
            scene.assert_goes_on();
        }
    }
}

#[test]
fn a_body_under_loads_beyond_all_measure_leaves_the_world_until_it_is_mended() {
    for warm_up in [0, 10] {
        let mut scene = Scene::new();
        for _ in 0..warm_up {
            scene.step().expect("a sound step");
        }
        let state = scene.block_state();
        let body = &mut scene.flex_bodies[scene.block];
        body.set_nodal_force(5, [f64::MAX, f64::MAX])
            .expect("a finite force");
        scene.step().expect("the world goes on without the block");
        let report = scene.flex.report();
        assert_eq!(report.quarantined_flex_bodies(), [scene.block]);
        scene.step().expect("and goes on");
        assert!(scene.flex.report().quarantined_flex_bodies().is_empty());
        assert!(scene.flex_bodies[scene.block].is_quarantined());
        assert_eq!(state, scene.block_state(), "after {warm_up} steps");
        let body = &mut scene.flex_bodies[scene.block];
        body.set_nodal_force(5, [0.0; 2]).expect("a finite force");
        scene.reinstate();
        scene.assert_goes_on();
    }
}

#[test]
fn a_failed_step_leaves_rapiers_queries_working() {
    let mut scene = Scene::new();
    for _ in 0..10 {
        scene.step().expect("a sound step");
    }
    // A change that rapier must take over, in the very step that fails.
    let newcomer = RigidBodyBuilder::dynamic().translation(Vector::new(8.0, 4.0));
    let (_, ball) = scene.world.insert(newcomer, ColliderBuilder::ball(0.5));
    scene.world.bodies[scene.crate_body].add_force(Vector::new(0.0, Real::NAN), true);
    scene
        .step()
        .expect_err("the box on the block is pushed by no number");
    let down = |x: Real| Ray::new(Vector::new(x, 9.0), Vector::new(0.0, -1.0));
    let hit = |scene: &Scene, x: Real| {
        let filter = QueryFilter::default();
        scene
            .world
            .cast_ray(&down(x), 20.0, true, filter)
            .map(|(handle, _)| handle)
    };
    let surface = scene.flex_bodies[scene.block].collider_handle();
    assert_eq!(hit(&scene, 0.1), Some(surface), "the block is still there");
    let found = hit(&scene, 8.0);
    assert!(found.is_some(), "the floor or the newcomer");
    scene.world.bodies[scene.crate_body].reset_forces(true);
    scene.step().expect("the world goes on");
    assert_eq!(hit(&scene, 8.0), Some(ball));
    scene.assert_goes_on();
}

#[test]
fn a_carrier_the_user_moved_is_refused_until_it_is_put_back() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let carrier = scene.flex_bodies[scene.block].rigid_body_handle();
    scene.world.bodies[carrier].set_translation(Vector::new(0.0, 1.0), true);
    let state = scene.state();
    let error = scene
        .step()
        .expect_err("the surface is not where the body is");
    assert_eq!(
        error,
        StepError::Body(FlexBodyError::NoCarrier(scene.block))
    );
    assert_eq!(state, scene.state());
    scene.world.bodies[carrier].set_translation(Vector::ZERO, true);
    scene.assert_goes_on();
}

#[test]
fn a_rigid_body_with_a_force_that_is_not_finite_is_named_and_everything_waits_for_its_cure() {
    let mut scene = Scene::new();
    for _ in 0..60 {
        scene.step().expect("a box on a block");
    }
    let state = scene.state();
    let crate_body = scene.crate_body;
    scene.world.bodies[crate_body].add_force(Vector::new(0.0, Real::NAN), true);
    for _ in 0..2 {
        let error = scene.step().expect_err("the box is pushed by no number");
        assert_eq!(error, StepError::RigidBody(crate_body));
        assert!(error.to_string().contains("reset its forces"), "{error}");
        assert_eq!(state, scene.state());
    }
    scene.world.bodies[crate_body].reset_forces(true);
    scene.assert_goes_on();
}

#[test]
fn a_rigid_body_that_rapier_disables_is_reported() {
    let mut scene = Scene::new();
    scene.step().expect("a sound step");
    let crate_body = scene.crate_body;
    scene.world.bodies[crate_body].set_linvel(Vector::new(Real::NAN, 0.0), true);
    scene.step().expect("rapier takes the box out");
    assert_eq!(scene.flex.report().quarantined_bodies(), [crate_body]);
    scene.step().expect("a sound step");
    assert!(scene.flex.report().quarantined_bodies().is_empty());
}

#[test]
fn numbers_beyond_all_measure_set_on_a_body_can_be_taken_back() {
    type Set = fn(&mut FlexBody, f64) -> Result<(), FlexBodyError>;
    let setters: [(&str, Set); 3] = [
        ("body force", |body, x| body.set_body_force([0.0, x])),
        ("gravity scale", |body, x| {
            body.set_gravity_scale(if x == 0.0 { 1.0 } else { x })
        }),
        ("velocities", |body, x| {
            let velocities = vec![x; 2 * body.n_nodes()];
            body.set_velocities(&velocities)
        }),
    ];
    for (name, set) in setters {
        for warm_up in [0, 10] {
            for huge in [1e60, 1e200, f64::MAX] {
                let mut scene = Scene::new();
                for _ in 0..warm_up {
                    scene.step().expect("a sound step");
                }
                let block = scene.block;
                let rigid = scene.world.bodies[scene.crate_body].position().translation;
                // Refused by the setter, by the step, or so large that the step's result is.
                let outcome = set(&mut scene.flex_bodies[block], huge).map_err(StepError::from);
                let state = scene.block_state();
                let is_refused = outcome.is_err();
                if is_refused {
                    let now = scene.world.bodies[scene.crate_body].position().translation;
                    assert_eq!(rigid, now, "{name} = {huge:e}");
                } else {
                    scene.step().expect("the world goes on without the block");
                }
                let is_out = scene.flex_bodies[block].is_quarantined();
                assert!(
                    is_refused != is_out,
                    "{name} = {huge:e} after {warm_up} steps"
                );
                assert_eq!(state, scene.block_state(), "{name} = {huge:e}");
                set(&mut scene.flex_bodies[block], 0.0).expect("a sound number");
                scene.reinstate();
                scene.assert_goes_on();
            }
        }
    }
}
