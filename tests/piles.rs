//! Piles: what is laid on them and lifted off leaves them as they were, and what is poured comes to rest.

mod common;

use common::*;

const DT: f64 = 1.0 / 60.0;

/// Side of a box (m).
const SIDE: f64 = 0.3;

fn add_box(scene: &mut Scene, [x, y]: [f64; 2], turn: f64) -> RigidBodyHandle {
    scene
        .rigid(
            RigidBodyBuilder::dynamic()
                .translation(vec2(x, y))
                .rotation(real(turn)),
            ColliderBuilder::cuboid(real(0.5 * SIDE), real(0.5 * SIDE))
                .density(500.0)
                .friction(0.5),
        )
        .0
}

fn soft_block(young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([SIDE, SIDE], [4, 4])
        .material(elastic(young, 500.0, 5e-3))
        .friction(0.5)
}

/// Fastest of some bodies (m/s).
fn fastest(scene: &Scene, boxes: &[RigidBodyHandle]) -> f64 {
    let speeds = boxes.iter().map(|&body| {
        let [x, y] = velocity_of(&scene.world.bodies[body]);
        x.hypot(y)
    });
    speeds.fold(0.0, f64::max)
}

/// Rows of boxes side by side, so far apart in height (m).
fn rows(scene: &mut Scene, [n_columns, n_rows]: [usize; 2], gap: f64) -> Vec<RigidBodyHandle> {
    scene.ground(0.5);
    let places = (0..n_rows).flat_map(|row| (0..n_columns).map(move |column| [column, row]));
    let places = places.map(|[column, row]| {
        let (x, y) = (0.31 * column as f64, (SIDE + gap) * row as f64);
        [x, y + 0.5 * SIDE]
    });
    places.map(|at| add_box(scene, at, 0.0)).collect()
}

/// The fastest of such boxes if rapier alone is given them just touching (m/s): what it does with a pile that it has not stacked.
fn settling(size: [usize; 2]) -> f64 {
    let mut scene = Scene::new(DT);
    let boxes = rows(&mut scene, size, 0.0);
    let speeds = (0..60).map(|_| {
        scene.try_step().expect("rapier steps alone");
        fastest(&scene, &boxes)
    });
    speeds.fold(0.0, f64::max)
}

/// Lays a soft block on rows of boxes that rapier has brought to rest, and lifts it off again.
fn claim_and_release(findings: &mut Findings, size: [usize; 2]) {
    let [n_columns, n_rows] = size;
    let mut scene = Scene::new(DT);
    let boxes = rows(&mut scene, size, 1e-3);
    let name = format!("{n_rows} rows of {n_columns}");
    for _ in 0..180 {
        scene.try_step().expect("rapier steps alone");
    }
    let places: Vec<_> = boxes
        .iter()
        .map(|&body| place_of(&scene.world.bodies[body]))
        .collect();
    let first = energy_of(&scene);
    let restless = fastest(&scene, &boxes);
    let top = places.iter().map(|at| at[1]).fold(0.0, f64::max) + 0.5 * SIDE;
    let column = 0.31 * (n_columns / 2) as f64;
    let block = scene.flexible(soft_block(1e6).translation([column - 0.5 * SIDE, top + 1e-3]));
    let mut laid = Onlooker::default();
    let ([mut while_laid, mut at_rest], mut step) = ([0.0f64; 2], 0);
    laid.watch(&mut scene, 120, |scene| {
        let now = fastest(scene, &boxes);
        while_laid = while_laid.max(now);
        step += 1;
        if step > 90 {
            at_rest = at_rest.max(now);
        }
    });
    laid.check(findings, &format!("{name}, laid on"));
    scene
        .bodies
        .remove(block, &mut scene.world)
        .expect("the block is there");
    let mut released = Onlooker::default();
    let mut while_released = 0.0f64;
    released.watch(&mut scene, 60, |scene| {
        while_released = while_released.max(fastest(scene, &boxes));
    });
    released.check(findings, &format!("{name}, lifted off"));
    let moved = boxes.iter().zip(&places).map(|(&body, before)| {
        let [x, y] = place_of(&scene.world.bodies[body]);
        (x - before[0]).hypot(y - before[1])
    });
    let moved = moved.fold(0.0, f64::max);
    let gained = energy_of(&scene) - first;
    println!(
        "{name}: before {restless:.1e}, laid on {while_laid:.1e}, at rest {at_rest:.1e}, lifted off {while_released:.1e} m/s, \
         moved {moved:.1e} m, gained {gained:.2e} J, {:.1} pivots a step",
        laid.mean_pivots_from(60)
    );
    // 0.06 m/s is a hop of 0.18 mm. Released, they are rapier's again, and may do what they do when they are put there touching.
    let released = settling(size);
    println!("{name}: rapier alone settles at {released:.1e} m/s");
    let both = [
        ("laid on", while_laid, 0.06),
        ("lifted off", while_released, (1.2 * released).max(0.05)),
    ];
    for (when, speed, bound) in both {
        findings.check(speed < bound + restless, || {
            format!("{name}, {when}: a box moves at {speed:.2e} m/s")
        });
    }
    findings.check(at_rest < 0.01 + restless, || {
        format!("{name}: a box shakes at {at_rest:.2e} m/s under the block")
    });
    // Boxes that rest on each other under rapier overlap by up to 2 % of their size a row, which may fade.
    let parting = 0.02 * SIDE * n_rows as f64;
    findings.check(moved < parting, || {
        format!("{name}: a box has moved {moved:.2e} m")
    });
    let weight = 500.0 * SIDE * SIDE * G * boxes.len() as f64;
    findings.check(gained < 0.5 * weight * parting, || {
        format!("{name}: {gained:.2e} J gained")
    });
}

#[test]
fn a_block_laid_on_a_resting_pile_and_lifted_off_again_leaves_it_alone() {
    let mut findings = Findings::default();
    for size in [[5, 2], [1, 10], [10, 3], [10, 6]] {
        claim_and_release(&mut findings, size);
    }
    findings.report();
}

#[test]
fn boxes_poured_on_a_plank_come_to_rest_on_it() {
    let mut findings = Findings::default();
    for n in [10, 20] {
        // Not on the feasible path: there 177 of 240 steps are not solved with 20 boxes, and one is thrown at 16 m/s.
        let mut scene = Scene::new(DT);
        for x in [-1.15, 1.15] {
            scene.fixed(ColliderBuilder::cuboid(0.1, 3.0).translation(vec2(x, 3.0)));
            scene.fixed(ColliderBuilder::cuboid(0.15, 0.2).translation(vec2(0.85 * x, -0.4)));
        }
        let plank = scene.flexible(
            FlexBodyBuilder::rectangle([2.08, 0.2], [26, 3])
                .material(elastic(2e9, 1000.0, 2e-3))
                .friction(0.5)
                .translation([-1.04, -0.2]),
        );
        for k in 0..n {
            let [column, row] = [k % 5, k / 5].map(|i| i as f64);
            let at = [-0.8 + 0.4 * column, 0.4 + 0.5 * row];
            add_box(&mut scene, at, 0.37 * k as f64);
        }
        let name = format!("{n} boxes");
        let boxes = free_bodies(&scene);
        let mass = n as f64 * 500.0 * SIDE * SIDE;
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 240, |_| ());
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, mass * G * 0.4);
        let speed = fastest(&scene, &boxes);
        println!(
            "{name}: ends at {speed:.1e} m/s, {:.1} pivots a step",
            onlooker.mean_pivots_from(180)
        );
        // They fall for half a second and tumble for one; walls carry part of the weight, so only the plank's own balance is known.
        findings.check(speed < 0.05, || {
            format!("{name}: a box moves at {speed:.2e} m/s after 4 s")
        });
        let body = scene.body(plank);
        let lifted = body.total_contact_force()[1] / (body.mass() * G);
        findings.check(
            (lifted - 1.0).abs() < 0.01 * (1.0 + mass / body.mass()),
            || format!("{name}: supports and boxes lift {lifted:.4} of the plank's weight"),
        );
    }
    findings.report();
}

#[test]
fn nine_soft_blocks_poured_into_a_bin_come_to_rest() {
    let mut findings = Findings::default();
    for young in [1e6, 1e7] {
        let mut scene = Scene::new(DT);
        scene.ground(0.5);
        for x in [-1.0, 1.0] {
            scene.fixed(ColliderBuilder::cuboid(0.1, 3.0).translation(vec2(x, 3.0)));
        }
        for k in 0..9 {
            let [column, row] = [k % 3, k / 3].map(f64::from);
            let at = [-0.75 + 0.55 * column + 0.05 * row, 0.2 + 0.6 * row];
            scene.flexible(
                FlexBodyBuilder::rectangle([0.4, 0.4], [6, 6])
                    .material(elastic(young, 500.0, 5e-3))
                    .friction(0.5)
                    .rotation(0.2 * row)
                    .translation(at),
            );
        }
        let name = format!("E {young:.0e}");
        let mass: f64 = scene.bodies.iter().map(|(_, body)| body.mass()).sum();
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 180, |_| ());
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, mass * G * 0.6);
        let [x, y] = momentum_of(&scene).map(|part| part / mass);
        let carried = scene
            .bodies
            .iter()
            .map(|(_, body)| body.total_contact_force()[1])
            .sum::<f64>()
            / (mass * G);
        println!(
            "{name}: ends at {:.1e} m/s, {carried:.4} of the weight, {:.1} pivots a step",
            x.hypot(y),
            onlooker.mean_pivots_from(120)
        );
        findings.check((carried - 1.0).abs() < 0.02, || {
            format!("{name}: the bin carries {carried:.4} of the weight")
        });
    }
    findings.report();
}

#[test]
fn a_crowd_that_collides_in_free_space_keeps_its_momentum() {
    let mut findings = Findings::default();
    for young in [1e6, 1e8] {
        let mut scene = Scene::in_free_space(DT);
        let middle = scene.flexible(soft_block(young).translation([-0.5 * SIDE, -0.5 * SIDE]));
        let mut scale = 0.0;
        for k in 0..12 {
            let angle = 0.52 * f64::from(k) + 0.1;
            let distance = 0.9 + 0.45 * f64::from(k % 3);
            let body = add_box(
                &mut scene,
                [distance * angle.cos(), distance * angle.sin()],
                angle,
            );
            let speed = 5.0 + f64::from(k % 2);
            let velocity = vec2(-speed * angle.cos(), -speed * angle.sin());
            scene.world.bodies[body].set_linvel(velocity, true);
            scale += scene.mass(body) * speed;
        }
        let name = format!("E {young:.0e}");
        let before = momentum_of(&scene);
        let first = energy_of(&scene);
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 60, |_| ());
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, first);
        let after = momentum_of(&scene);
        let lost = (after[0] - before[0]).hypot(after[1] - before[1]) / scale;
        println!(
            "{name}: lost {lost:.1e} of the momentum, block at {:?}",
            scene.body(middle).linvel()
        );
        // Sixty steps of rapier's rounding of velocities.
        findings.check(lost < by_precision(1e-5, 1e-10), || {
            format!("{name}: {lost:.1e} of the momentum is lost")
        });
    }
    findings.report();
}

/// Forces turn with the edges that they act along, and turn bodies by their levers. What the linear problem of a pass knows of that need not be
/// found by more passes.
#[test]
fn soft_blocks_that_settle_take_few_passes() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    for x in [-1.4, 1.4] {
        scene.fixed(ColliderBuilder::cuboid(0.1, 3.0).translation(vec2(x, 3.0)));
    }
    for k in 0..16 {
        let [column, row] = [k % 4, k / 4].map(f64::from);
        scene.flexible(
            FlexBodyBuilder::rectangle([0.4, 0.4], [6, 6])
                .small_strain()
                .material(elastic(1e6, 1000.0, 5e-3))
                .friction(0.5)
                .rotation(0.3 * (1.7 * f64::from(k)).sin())
                .translation([-1.2 + 0.6 * column, 0.2 + 0.6 * row]),
        );
    }
    scene.steps(120);
    let n_steps = 120;
    let n_passes: usize = (0..n_steps).map(|_| scene.step().n_newton()).sum();
    println!("{:.2} passes a step", n_passes as f64 / n_steps as f64);
    assert!(n_passes <= 5 * n_steps, "{n_passes} in {n_steps} steps");
}
