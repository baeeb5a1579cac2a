//! The doctor names each of some prepared mistakes, nothing else in their scenes, and nothing in scenes that are sound.

mod common;

use common::*;
use foil2d::doctor::{Course, Finding, examine};
use foil2d::fe::mesh::generate;
use foil2d::pipeline::{FlexParameters, InsertionNote, Participant};

fn findings(scene: &Scene) -> Vec<Finding> {
    examine(&scene.world, &scene.bodies, &scene.flex.parameters)
}

/// The one finding in a scene with one body, whose words name the body and have a cure after a colon.
fn only(builder: FlexBodyBuilder) -> Finding {
    let mut scene = Scene::new(1.0 / 60.0);
    let body = scene.flexible(builder);
    only_of(&scene, body)
}

fn only_of(scene: &Scene, body: FlexBodyHandle) -> Finding {
    let found = findings(scene);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].body(), body);
    let words = found[0].to_string();
    let is_told =
        words.contains(&format!("{body:?}")) && (words.contains(": ") || words.contains(';'));
    assert!(is_told, "{words}");
    found[0]
}

fn rubber() -> LinearElastic {
    elastic(1e6, 1000.0, 1e-3)
}

fn triangles(size: [f64; 2], divisions: [usize; 2]) -> FlexBodyBuilder {
    let mesh = generate::rectangle(size, divisions, CellKind::Tri3).expect("a mesh");
    FlexBodyBuilder::mesh(mesh)
}

#[test]
fn a_sliver_is_named() {
    let nodes = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.01]];
    let cells = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let body = FlexBodyBuilder::cells(nodes, CellKind::Tri3, &cells).material(rubber());
    match only(body) {
        Finding::Sliver { angle, .. } => {
            assert!((angle - 0.01_f64.atan2(0.5).to_degrees()).abs() < 1e-9);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn triangles_that_lock_are_named() {
    let locking = LinearElastic::plane_strain(1e6, 0.49).density(1000.0);
    match only(triangles([1.0, 1.0], [4, 4]).material(locking)) {
        // 1/(1 - 2 ν).
        Finding::Locking { ratio, .. } => assert!((ratio - 50.0).abs() < 1e-9),
        other => panic!("{other}"),
    }
    // In plane stress, and of other cells, nothing locks.
    let mut scene = Scene::new(1.0 / 60.0);
    let free = LinearElastic::plane_stress(1e6, 0.49).density(1000.0);
    scene.flexible(triangles([1.0, 1.0], [4, 4]).material(free));
    scene.flexible(
        FlexBodyBuilder::disc(0.5, 0.2)
            .material(locking)
            .translation([5.0, 0.0]),
    );
    assert_eq!(findings(&scene), []);
}

#[test]
fn a_slender_body_of_few_triangles_is_named() {
    match only(triangles([3.0, 0.3], [20, 2]).material(rubber())) {
        Finding::FewCells {
            across,
            slenderness,
            ..
        } => {
            assert_eq!(across, 2);
            assert!((slenderness - 0.5 * 6.6 * 6.6 / 1.8).abs() < 1e-9);
        }
        other => panic!("{other}"),
    }
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(triangles([3.0, 0.3], [60, 6]).material(rubber()));
    assert_eq!(findings(&scene), []);
}

#[test]
fn damping_beyond_the_critical_is_named_with_its_ratio() {
    let beam = || FlexBodyBuilder::rectangle([1.0, 0.1], [20, 2]);
    // A free beam of Euler and Bernoulli, within what shear and the mesh take off.
    let expected = 22.3733 * 0.1 * (1e6_f64 / 1000.0 / 12.0).sqrt();
    match only(beam().material(elastic(1e6, 1000.0, 0.8))) {
        Finding::Overdamped {
            frequency,
            ratio,
            time,
            ..
        } => {
            assert!((time - 0.8).abs() < 1e-6, "all stiffness damping: {time} s");
            assert!((frequency / expected - 1.0).abs() < 0.06, "{frequency}");
            assert!((ratio - 0.5 * 0.8 * frequency).abs() < 1e-6);
        }
        other => panic!("{other}"),
    }
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(beam().material(elastic(1e6, 1000.0, 0.3)));
    assert_eq!(findings(&scene), []);
}

#[test]
fn a_body_that_its_weight_crushes_is_named() {
    // Young's modulus in megapascals.
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(elastic(10.0, 1000.0, 0.0));
    match only(block) {
        Finding::Crushed { ratio, .. } => {
            let expected = 1000.0 * G * 1.0 / (10.0 / 2.6);
            assert!((ratio / expected - 1.0).abs() < 1e-5);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn a_body_of_small_strain_that_sags_far_is_named() {
    let strip = || {
        FlexBodyBuilder::rectangle([1.0, 0.05], [20, 1])
            .material(rubber())
            .pin_where(|[x, _]| x == 0.0, Pin::both())
    };
    match only(strip().small_strain()) {
        Finding::Sagging { sag, size, .. } => {
            // The lowest frequency of a cantilever, 3.516 √(EI/ρA) / L².
            let frequency = 3.516 * 0.05 * (1e6_f64 / 1000.0 / 12.0).sqrt();
            assert!((sag / (G / frequency.powi(2)) - 1.0).abs() < 0.05);
            assert_eq!(size, 1.0);
        }
        other => panic!("{other}"),
    }
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(strip());
    assert_eq!(findings(&scene), []);
}

#[test]
fn an_explicit_step_too_long_is_named_before_it_is_refused() {
    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::central_difference());
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
        .material(rubber())
        .small_strain();
    let block = scene.flexible(block);
    match only_of(&scene, block) {
        Finding::Unstable { critical, dt, .. } => {
            assert!(critical < dt && (dt - 1.0 / 60.0).abs() < 1e-8);
            assert!(scene.try_step().is_err());
            scene.world.integration_parameters.dt = (0.9 * critical) as _;
            assert_eq!(findings(&scene), []);
            assert!(scene.try_step().is_ok());
        }
        other => panic!("{other}"),
    }
}

#[test]
fn a_body_that_is_shot_far_in_a_step_is_named() {
    let block = FlexBodyBuilder::rectangle([0.5, 0.25], [4, 2]).material(rubber());
    match only(block.linvel([60.0, 0.0])) {
        Finding::Fast { sizes, .. } => assert!((sizes - 2.0).abs() < 1e-6),
        other => panic!("{other}"),
    }
}

/// A body that is held everywhere has no vibrations to be looked at, and nothing is wrong with it.
#[test]
fn a_body_that_is_held_everywhere_is_sound() {
    let mut scene = Scene::new(1.0 / 60.0);
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [2, 2]).material(rubber());
    scene.flexible(block.pin_where(|_| true, Pin::both()));
    assert_eq!(findings(&scene), []);
}

#[test]
fn a_body_far_from_the_origin_is_named() {
    let far = by_precision(4e3, 2e12);
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]).material(rubber());
    match only(block.translation([far, 0.0])) {
        Finding::FarAway { distance, edge, .. } => {
            assert!((distance / far - 1.0).abs() < 1e-3 && (edge - 0.1).abs() < 1e-9);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn a_density_in_other_units_is_named() {
    // Grams per cubic metre.
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(elastic(2e11, 7.8e6, 0.0));
    match only(block) {
        Finding::Density { density, .. } => assert_eq!(density, 7.8e6),
        other => panic!("{other}"),
    }
}

#[test]
fn pins_that_choose_nothing_are_named() {
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
        .material(rubber())
        .pin_where(|[x, _]| x == -1.0, Pin::both());
    match only(block) {
        Finding::Insertion(InsertionNote::NothingPinned { n_calls, .. }) => assert_eq!(n_calls, 1),
        other => panic!("{other}"),
    }
}

#[test]
fn bodies_in_each_other_are_named() {
    let block = || FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber());
    let mut scene = Scene::new(1.0 / 60.0);
    let one = scene.flexible(block());
    let other = scene.flexible(block().translation([0.9, 0.3]));
    match only_of(&scene, one) {
        Finding::Insertion(InsertionNote::Overlap { with, .. }) => {
            assert_eq!(with, Participant::Flex(other))
        }
        finding => panic!("{finding}"),
    }
    // Flush they are beside each other.
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(block());
    scene.flexible(block().translation([1.0, 0.0]));
    assert_eq!(findings(&scene), []);

    let mut scene = Scene::new(1.0 / 60.0);
    let block_in_floor = scene.flexible(block().translation([0.0, -0.1]));
    let floor = scene.ground(0.5);
    match only_of(&scene, block_in_floor) {
        Finding::Insertion(InsertionNote::Overlap { with, .. }) => {
            assert_eq!(with, Participant::Rigid(floor))
        }
        finding => panic!("{finding}"),
    }
    // What it does not meet, it may lie in.
    let mut settings = *scene.body(block_in_floor).contact_settings();
    settings.solver_groups = InteractionGroups::none();
    let body = scene.bodies.get_mut(block_in_floor).expect("it is there");
    body.set_contact_settings(settings).expect("settings");
    assert_eq!(findings(&scene), []);
}

#[test]
fn masses_too_far_apart_are_named() {
    let mut scene = Scene::new(1.0 / 60.0);
    let block = FlexBodyBuilder::rectangle([0.1, 0.1], [2, 2]).material(rubber());
    let block = scene.flexible(block.thickness(0.01));
    let ship = RigidBodyBuilder::dynamic().translation(vec2(0.0, 9.0));
    let hull = ColliderBuilder::cuboid(2.0, 2.0).density(1e6);
    scene.world.insert(ship, hull);
    match only_of(&scene, block) {
        Finding::MassRatio { ratio, .. } => assert!((ratio / 1.6e8 - 1.0).abs() < 1e-3),
        other => panic!("{other}"),
    }
}

#[test]
fn the_parameters_and_empty_worlds_have_nothing() {
    let scene = Scene::new(1.0 / 60.0);
    assert_eq!(findings(&scene), []);
    let found = examine(&scene.world, &scene.bodies, &FlexParameters::default());
    assert_eq!(found, []);
}

#[test]
fn a_run_is_told_as_it_was() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let strip = FlexBodyBuilder::rectangle([1.0, 0.05], [20, 1])
        .material(rubber())
        .small_strain()
        .pin_where(|[x, _]| x == 0.0, Pin::both())
        .translation([0.0, 3.0]);
    let strip = scene.flexible(strip);
    let roller = FlexBodyBuilder::disc(0.2, 0.1)
        .material(rubber())
        .angvel(3.0);
    let roller = scene.flexible(roller.translation([5.0, 2.0]));
    let mut course = Course::default();
    let mut largest: f64 = 0.0;
    for _ in 0..60 {
        scene.step();
        course.watch(scene.flex.report(), &scene.bodies);
        let bent = scene.flex.report().overbent().iter();
        largest = bent.fold(largest, |most, bent| most.max(bent.neglected_strain));
    }
    let told = course.report();
    assert_eq!(told.n_steps, 60);
    assert_eq!(told.neglected_strain, Some((strip, largest)));
    assert!(largest > 0.01, "{largest}");
    let (turned, angle) = told.turn.expect("something turned");
    assert_eq!(turned, roller);
    assert!(angle > 1.0, "{angle} rad");
    assert_eq!((told.n_cut, told.n_unfinished), (0, 0));
    assert!(!told.has_gained(), "{} J", told.gained);
    let words = told.to_string();
    assert!(
        words.contains("60 steps") && words.contains("small_strain"),
        "{words}"
    );
}

/// What lies still, and what an explicit step swings by, gains nothing.
#[test]
fn rounding_and_swings_are_no_gain() {
    let mut still = Scene::new(1.0 / 60.0);
    still.ground(0.0);
    still.flexible(block_of(1e7).translation([0.0, 0.0]).can_sleep(false));
    let mut swinging = Scene::in_free_space(4e-3).with_integrator(Beta2::central_difference());
    swinging.flex.parameters.insists = true;
    swinging.flexible(
        block_of(1e6)
            .linvel([1.0, 0.0])
            .small_strain()
            .pin_where(|[x, _]| x < 1e-9, Pin::both()),
    );
    for mut scene in [still, swinging] {
        let mut course = Course::default();
        for _ in 0..300 {
            scene.step();
            course.watch(scene.flex.report(), &scene.bodies);
        }
        assert!(!course.report().has_gained(), "{}", course.report());
    }
}

fn block_of(modulus: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([0.5, 0.5], [2, 2]).material(elastic(modulus, 1000.0, 0.0))
}

/// Nothing is gained by what a spring gives back; by a method that adds energy it is, and told: in free space all that there is above what
/// there has been.
#[test]
fn energy_that_no_load_brought_is_told() {
    let mut hung = Scene::new(1.0 / 240.0);
    let block = hung.flexible(block_of(1e7));
    let spring = AttachmentBuilder::spring_damper(block, 1e4, 0.0)
        .where_(|[_, y]| y > 0.49)
        .rest_length(0.5)
        .to_world()
        .at_point([0.25, 1.0]);
    let attached = hung.bodies.attach(spring, &hung.world.bodies);
    attached.expect("it hangs");
    let mut course = Course::default();
    for _ in 0..240 {
        hung.step();
        course.watch(hung.flex.report(), &hung.bodies);
    }
    assert!(!course.report().has_gained(), "{}", course.report());

    let (cells, length) = (40, 4.0);
    let dt = 0.9 * length / f64::from(cells) / 30.0;
    let mut scene = Scene::in_free_space(dt).with_integrator(Beta2::trapezoidal());
    scene.flex = scene.flex.with_impact(ImpactTreatment::Plain);
    scene.ground(0.0);
    scene.flexible(
        FlexBodyBuilder::rectangle([0.1, length], [1, cells as usize])
            .small_strain()
            .material(LinearElastic::plane_stress(900.0, 0.0).density(1.0))
            .contact_inertia(ContactInertia::Kept)
            .pin_where(|_| true, Pin::x())
            .friction(0.0)
            .linvel([0.0, -0.1])
            .translation([0.0, 0.05]),
    );
    let (mut course, mut least, mut gained) = (Course::default(), f64::INFINITY, 0.0_f64);
    for _ in 0..300 {
        scene.step();
        let report = scene.flex.report();
        course.watch(report, &scene.bodies);
        least = least.min(report.energy().total());
        gained = gained.max(report.energy().total() - least);
    }
    let told = course.report();
    assert!(told.has_gained(), "{told}");
    assert!((told.gained / gained - 1.0).abs() < 1e-6, "{told}");
    assert!(told.to_string().contains("no load brought"), "{told}");
}

/// Flexible bodies meet no voxels: what would rest on them in rapier alone falls through, and is told.
#[test]
fn shapes_that_are_not_met_are_named() {
    let mut scene = Scene::new(1.0 / 60.0);
    let block = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4]).material(rubber());
    let block = scene.flexible(block.translation([0.0, 2.0]));
    let cells: Vec<IVector> = (-4..4).map(|x| IVector::new(x, 0)).collect();
    let voxels = ColliderBuilder::voxels(vec2(1.0, 1.0), &cells);
    let ground = scene.world.insert_collider(voxels, None);
    match only_of(&scene, block) {
        Finding::NotMet { with, .. } => assert_eq!(with, Participant::Rigid(ground)),
        other => panic!("{other}"),
    }
}
