//! The constraint function method of ADINA beside Lagrange multipliers.

mod common;

use common::*;
use foil2d::kkt::EpsilonError;

fn functions_of(functions: ConstraintFunction) -> ContactMethod {
    ContactMethod::ConstraintFunction(functions)
}

fn with_epsilons(normal: f64, tangential: f64) -> ConstraintFunction {
    ConstraintFunction::new(normal, tangential).expect("both are small")
}

fn scene_with(method: ContactMethod, dt: f64) -> Scene {
    let mut scene = Scene::new(dt);
    scene.flex = scene.flex.with_contact_method(method);
    scene
}

fn block(n: usize) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 0.5], [2 * n, n])
        .small_strain()
        .material(elastic(1e6, 1000.0, 2e-3))
}

/// A block that has come to rest weighs what it weighs, whatever the mesh and the step, in some three iterations.
#[test]
fn a_resting_block_gives_its_weight() {
    for (n, dt) in [(2, 1.0 / 60.0), (4, 1.0 / 60.0), (4, 1.0 / 500.0)] {
        let mut scene = scene_with(functions_of(ConstraintFunction::default()), dt);
        scene.ground(0.5);
        let body = scene.flexible(block(n).translation([0.0, 1e-3]));
        let n_steps = (4.0 / dt) as usize;
        let mut sum = 0;
        for _ in 0..n_steps {
            scene.step();
            sum += scene.report().n_newton();
            assert_eq!(scene.report().n_failed(), 0);
        }
        let weight = G * scene.body(body).mass();
        let force = scene.body(body).total_contact_force()[1];
        // What is left of the vibration after four seconds.
        assert!((force / weight - 1.0).abs() < 1e-6, "{force} of {weight}");
        assert!(sum < 3 * n_steps, "{sum} iterations in {n_steps} steps");
    }
}

/// A rigid box on a flexible block: four rows that one body cannot tell apart share its weight.
#[test]
fn a_rigid_box_on_a_block_presses_with_its_weight() {
    let mut scene = scene_with(functions_of(ConstraintFunction::default()), 1.0 / 120.0);
    let ground = scene.ground(0.5);
    let body = scene.flexible(block(4));
    let (rigid, top) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(0.5, 0.601)),
        ColliderBuilder::cuboid(0.2, 0.1)
            .density(1000.0)
            .friction(0.5),
    );
    let mut failed = 0;
    for _ in 0..480 {
        scene.step();
        failed += scene.report().n_failed();
    }
    let weight = G * scene.mass(rigid);
    let total = weight + G * scene.body(body).mass();
    // Vibrations that are left, and the box in rapier's precision.
    let on_box = scene.force_on_collider(top)[1] / weight;
    let on_ground = -scene.force_on_collider(ground)[1] / total;
    assert!((on_box - 1.0).abs() < 1e-4, "{on_box}");
    assert!((on_ground - 1.0).abs() < 1e-4, "{on_ground}");
    assert_eq!(failed, 0);
}

/// Where a block is after an eighth of a second in which it lands askew and slides.
fn landed(method: ContactMethod) -> Vec<[f64; 2]> {
    let mut scene = scene_with(method, 1.0 / 240.0);
    scene.ground(0.3);
    let body = scene.flexible(
        block(3)
            .translation([0.0, 0.2])
            .rotation(0.3)
            .linvel([1.5, -1.0]),
    );
    for _ in 0..30 {
        scene.step();
        assert_eq!(scene.report().n_failed(), 0);
    }
    let body = scene.body(body);
    (0..body.n_nodes())
        .map(|node| body.position(node))
        .collect()
}

#[test]
fn small_epsilons_give_the_motion_of_lagrange_multipliers() {
    let exact = landed(ContactMethod::Lagrange);
    let off = |normal, tangential| {
        let found = landed(functions_of(with_epsilons(normal, tangential)));
        let pairs = found.iter().zip(&exact);
        pairs.fold(0.0f64, |worst, (a, b)| {
            worst.max((a[0] - b[0]).hypot(a[1] - b[1]))
        })
    };
    // 5.1e-5, 5.1e-7 and 1.7e-10 m when this was written: of the order of the greater epsilon, then of the iterations'
    // tolerance summed over the steps.
    let [wide, narrow, least] = [off(1e-4, 1e-1), off(1e-6, 1e-3), off(1e-12, 1e-9)];
    assert!(wide < 2e-4 && wide > 1e-6, "{wide}");
    assert!(narrow < 0.05 * wide, "{narrow} after {wide}");
    assert!(least < 1e-8, "{least}");
}

/// How far a block moves in a second on an incline of 30 degrees (m), and its acceleration (m/s²).
fn slide(friction: f64, epsilon: f64) -> [f64; 2] {
    let angle = 30f64.to_radians();
    let mut scene = scene_with(functions_of(with_epsilons(1e-12, epsilon)), 1.0 / 60.0)
        .with_gravity(G * angle.sin(), -G * angle.cos());
    scene.ground(friction);
    let body = scene.flexible(block(2).friction(friction));
    scene.steps(90);
    let (place, speed) = (
        scene.body(body).centre_of_mass()[0],
        scene.body(body).linvel()[0],
    );
    scene.steps(60);
    let body = scene.body(body);
    [body.centre_of_mass()[0] - place, body.linvel()[0] - speed]
}

#[test]
fn a_block_on_an_incline_slides_as_coulomb_says_or_creeps_by_epsilon() {
    let angle = 30f64.to_radians();
    let [_, acceleration] = slide(0.3, 1e-9);
    let exact = G * (angle.sin() - 0.3 * angle.cos());
    // The block still rocks a little on its soft foot.
    assert!((acceleration / exact - 1.0).abs() < 1e-3, "{acceleration}");
    let [wide, narrow] = [slide(0.8, 1e-2)[0], slide(0.8, 1e-9)[0]];
    // 60 steps of eps_T tan(pi tau/2), of the millimetre that the block would slide in a step, where tau is 0.72 on the whole.
    assert!(wide > 1e-4, "eps_T = 1e-2 creeps: {wide}");
    assert!(narrow < 1e-3 * wide, "eps_T = 1e-9 does not: {narrow}");
}

#[test]
fn failures_are_counted_and_solved_by_lagrange_multipliers() {
    let hurried = ConstraintFunction::default().with_max_iterations(1);
    let rest = |method| {
        let mut scene = scene_with(method, 1.0 / 60.0);
        scene.ground(0.5);
        let body = scene.flexible(block(2));
        scene.step();
        let counts = [scene.report().n_failed(), scene.report().n_substituted()];
        (scene.body(body).position(0), counts)
    };
    let (exact, none) = rest(ContactMethod::Lagrange);
    let (found, counts) = rest(functions_of(hurried));
    assert_eq!((none, counts), ([0, 0], [1, 1]));
    // That one is led along its feasible path.
    let off = (0..2).map(|axis| (found[axis] - exact[axis]).abs());
    assert!(
        off.fold(0.0, f64::max) < 1e-15,
        "the step is that of Lagrange multipliers"
    );
}

/// The scale of a problem is its own: a world in millimetres and grams takes the same iterations.
#[test]
fn iterations_do_not_depend_on_units() {
    let drop = |length: f64, mass: f64| {
        let method = functions_of(ConstraintFunction::default());
        let mut scene = scene_with(method, 1.0 / 240.0).with_gravity(0.0, -G * length);
        scene.ground(0.3);
        // Pa = kg/(m s²), and the thickness is a length too.
        let young = 1e6 * mass / length;
        let density = 1000.0 * mass / length.powi(3);
        let block = FlexBodyBuilder::rectangle([length, 0.5 * length], [6, 3])
            .small_strain()
            .thickness(length)
            .material(LinearElastic::plane_stress(young, 0.3).density(density))
            .rotation(0.2)
            .translation([0.0, 0.02 * length]);
        scene.flexible(block);
        (0..60).map(|_| scene.step().n_newton()).sum::<usize>()
    };
    let [metres, others] = [drop(1.0, 1.0), drop(16.0, 1024.0)];
    // Rounding to rapier's precision, and its own prediction distance in metres, may cost one here or there.
    assert!(metres.abs_diff(others) <= 6, "{metres} and {others}");
}

#[test]
fn an_epsilon_that_is_no_small_number_is_refused() {
    for value in [0.0, -1e-12, 2.0, f64::NAN] {
        let refused =
            ConstraintFunction::new(value, 1e-3).map_err(|EpsilonError { name, .. }| name);
        assert_eq!(refused, Err("eps_N"));
        assert!(ConstraintFunction::new(1e-12, value).is_err());
    }
}
