//! Bodies that leave the boxes they were looked for in: what they meet there is seen, and steps are solved again only for that.

mod common;

use common::*;

/// A body that is thrown at something within one step, by a force that no velocity foretells, was not looked for there.
#[test]
fn what_a_sudden_force_throws_beyond_where_it_was_looked_for_is_seen() {
    for thrown in [0.5, 2.0] {
        let dt = 1.0 / 60.0;
        let mut scene = Scene::in_free_space(dt);
        scene.ground(0.5);
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
                .material(elastic(1e8, 1000.0, 1e-3))
                .translation([0.0, 0.45 * thrown]),
        );
        scene.step();
        let body = scene.bodies.get_mut(block).expect("it is there");
        // Free, it would move by `thrown` in the step.
        let force = -thrown / (0.25 * dt * dt) * body.mass() / body.n_nodes() as f64;
        for node in 0..body.n_nodes() {
            body.set_nodal_force(node, [0.0, force])
                .expect("the node is there");
        }
        let report = scene.try_step().expect("nothing is wrong with it");
        let quality = report.quality();
        let lowest = scene.body(block).positions().chunks_exact(2);
        let lowest = lowest.map(|at| at[1]).fold(f64::INFINITY, f64::min);
        assert!(
            lowest > -1e-9,
            "thrown by {thrown} m: at {lowest} m, {quality:?}"
        );
    }
}

/// A block of .4 m that a sudden force throws down.
struct Throw {
    scene: Scene,
    block: FlexBodyHandle,
}

impl Throw {
    /// With its lower side at a height (m).
    fn new(mut scene: Scene, height: f64) -> Self {
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
                .material(elastic(1e8, 1000.0, 1e-3))
                .translation([0.0, height]),
        );
        Self { scene, block }
    }

    /// Takes a step in which it would move by `way` to twice that, if it were free (m); returns where its lowest node ends (m), and how often
    /// the step was solved.
    fn down(&mut self, way: f64) -> (f64, usize) {
        let (scene, dt) = (&mut self.scene, 1.0 / 60.0);
        scene.step();
        let body = scene.bodies.get_mut(self.block).expect("it is there");
        let force = -way / (0.25 * dt * dt) * body.mass() / body.n_nodes() as f64;
        for node in 0..body.n_nodes() {
            body.set_nodal_force(node, [0.0, force])
                .expect("the node is there");
        }
        let n_solves = scene
            .try_step()
            .expect("nothing is wrong with it")
            .n_solves();
        let heights = scene.body(self.block).positions().chunks_exact(2);
        let lowest = heights.map(|at| at[1]).fold(f64::INFINITY, f64::min);
        (lowest, n_solves)
    }
}

/// It falls past walls, and its box is left all the same; that of a half-space is everywhere, and that of a line around what it goes around.
#[test]
fn what_is_thrown_at_nothing_is_not_solved_again() {
    let bend = [[-1.0, 5.0], [-1.0, -6.0], [5.0, -6.0]].map(|[x, y]| vec2(x, y));
    let wall = SharedShape::halfspace(vec2(1.0, 0.0));
    for (name, collider) in [
        (
            "box",
            ColliderBuilder::cuboid(0.1, 5.0).translation(vec2(2.0, 0.0)),
        ),
        (
            "half-space",
            ColliderBuilder::new(wall).translation(vec2(-1.0, 0.0)),
        ),
        ("chain", ColliderBuilder::polyline(bend.to_vec(), None)),
    ] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        scene.fixed(collider);
        let mut throw = Throw::new(scene, 0.0);
        let (lowest, n_solves) = throw.down(2.0);
        assert!(lowest < -1.0, "{name}: thrown to {lowest} m");
        assert_eq!(n_solves, 1, "{name}");
    }
}

/// What is near enough to be a neighbour from the beginning is kept away from all of it, however far the block is thrown.
#[test]
fn what_is_thrown_at_a_neighbour_is_not_solved_again() {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    scene.fixed(ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5)));
    let mut throw = Throw::new(scene, 0.02);
    let (lowest, n_solves) = throw.down(2.0);
    assert!(lowest > -1e-9, "thrown to {lowest} m");
    assert_eq!(n_solves, 1);
}

/// Boxes tell nothing of a half-space, which is everywhere: it is no neighbour for that.
#[test]
fn what_is_thrown_at_something_is_solved_again() {
    let dt = 1.0 / 60.0;
    let line = vec![vec2(-5.0, 0.0), vec2(0.0, 0.0), vec2(5.0, 0.0)];
    let sleeper = RigidBodyBuilder::dynamic().sleeping(true);
    let lift = |centre: f64| vec2(0.0, centre);
    for (name, collider, body) in [
        (
            "half-space",
            ColliderBuilder::new(SharedShape::halfspace(vec2(0.0, 1.0))),
            None,
        ),
        ("chain", ColliderBuilder::polyline(line, None), None),
        (
            "box that sleeps",
            ColliderBuilder::cuboid(5.0, 0.5),
            Some(sleeper),
        ),
        (
            "box on its way up",
            ColliderBuilder::cuboid(0.5, 0.5).density(1e5),
            Some(RigidBodyBuilder::kinematic_velocity_based().linvel(lift(0.1))),
        ),
    ] {
        let mut scene = Scene::in_free_space(dt);
        match body {
            Some(body) => {
                scene.world.insert(body.translation(lift(-0.5)), collider);
            }
            None => {
                scene.fixed(collider);
            }
        }
        let mut throw = Throw::new(scene, 0.7);
        let (lowest, n_solves) = throw.down(2.0);
        assert!(n_solves > 1, "{name}: solved once, lowest at {lowest} m");
        let report = throw.scene.report();
        let is_met = !report.contacts().is_empty();
        assert!(is_solved(report) && is_met, "{name}: lowest at {lowest} m");
    }
}

/// A flexible body that sleeps takes no part in a step, and is woken by what is thrown at it.
#[test]
fn what_is_thrown_at_a_sleeping_body_wakes_it_within_the_step() {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let sleeper = scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.4], [10, 2])
            .material(elastic(1e8, 1000.0, 1e-3))
            .translation([-0.8, -0.4]),
    );
    let carrier = scene.body(sleeper).rigid_body_handle();
    let falls_asleep = (0..300).any(|_| {
        scene.step();
        scene.world.bodies[carrier].is_sleeping()
    });
    assert!(falls_asleep, "it is at rest");
    let mut throw = Throw::new(scene, 0.7);
    let (lowest, n_solves) = throw.down(2.0);
    assert!(n_solves > 1, "solved once, lowest at {lowest} m");
    let report = throw.scene.report();
    let is_met = !report.contacts().is_empty();
    assert!(is_solved(report) && is_met, "lowest at {lowest} m");
    assert_eq!(report.n_asleep(), 0);
}

/// A heavy box falls on a soft block between two light boxes and two walls.
fn crush(seed: u64) -> Scene {
    let mut dice = Dice(seed);
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    scene.ground(0.5);
    for side in [-1.0, 1.0] {
        let wall = ColliderBuilder::cuboid(0.1, 5.0);
        scene.fixed(wall.translation(vec2(side * dice.between(1.5, 2.5), 4.0)));
    }
    let young = 10f64.powf(dice.between(5.0, 6.5));
    scene.flexible(
        FlexBodyBuilder::rectangle([0.6, 0.6], [4, 4])
            .material(elastic(young, 1000.0, 1e-3))
            .friction(0.5)
            .translation([-0.3, 0.01]),
    );
    for side in [-1.0, 1.0] {
        let at = vec2(side * dice.between(0.5, 0.8), 0.2);
        let light = ColliderBuilder::cuboid(0.15, 0.15).density(100.0);
        scene.rigid(RigidBodyBuilder::dynamic().translation(at), light);
    }
    let weight = RigidBodyBuilder::dynamic()
        .translation(vec2(dice.between(-0.2, 0.2), 1.0))
        .rotation(real(dice.between(-0.3, 0.3)))
        .linvel(vec2(0.0, -dice.between(5.0, 20.0)));
    scene.rigid(weight, ColliderBuilder::cuboid(0.4, 0.2).density(10_000.0));
    scene
}

#[test]
fn steps_that_are_cut_are_seldom_solved_again() {
    let (mut n_cut, mut n_again) = (0, 0);
    for seed in 0..40 {
        let mut scene = crush(seed);
        for _ in 0..30 {
            let report = scene.try_step().expect("nothing is wrong with it");
            if report.n_parts() > 2 {
                n_cut += 1;
                n_again += usize::from(report.n_solves() > 1);
            }
        }
    }
    // Without the look ahead it is a third of them.
    assert!(n_cut > 100, "{n_cut} steps cut");
    assert!(20 * n_again <= n_cut, "{n_again} of {n_cut} solved again");
}

/// A step in `n` parts is `n - 1` times found to need a cut, and tried no more often for that: not either where it is begun again with more of what
/// is around, for which one part may have been solved in vain.
#[test]
fn what_had_to_be_cut_is_not_tried_again() {
    let (mut n_cut, mut n_begun_again) = (0, 0);
    for seed in 0..20 {
        let mut scene = crush(seed);
        for _ in 0..30 {
            let report = scene.try_step().expect("nothing is wrong with it");
            if report.n_solves() > 1 || report.n_islands() != 1 {
                continue;
            }
            let least = 2 * report.n_parts() - 1;
            let tried = report.n_tried();
            assert!((least..=least + 1).contains(&tried), "{tried}, {least}");
            n_cut += usize::from(report.n_parts() > 2);
            n_begun_again += usize::from(report.n_parts() > 2 && report.is_detected());
        }
    }
    assert!(n_cut > 50 && n_begun_again > 10, "{n_cut} {n_begun_again}");
}

/// A bar that begins to turn beside a block, with nothing else that moves: it is met in the step in which it comes.
#[test]
fn what_turns_in_its_place_is_met_however_fast() {
    use Bar::*;
    for bar in [Velocity, Position, Free] {
        for turn in [0.1, 0.2, 0.5, 0.8] {
            for is_large in [true, false] {
                let mut scene = Scene::in_free_space(1.0 / 60.0);
                let kind = match bar {
                    Velocity => RigidBodyBuilder::kinematic_velocity_based(),
                    Position => RigidBodyBuilder::kinematic_position_based(),
                    Free => RigidBodyBuilder::dynamic(),
                };
                let shape = ColliderBuilder::cuboid(real(0.85), real(0.03)).mass(100.0);
                let (turning, _) = scene.rigid(kind, shape);
                let block = FlexBodyBuilder::rectangle([0.3, 0.3], [4, 4])
                    .material(
                        LinearElastic::plane_stress(1e6, 0.4)
                            .density(1000.0)
                            .rayleigh(1e-3),
                    )
                    .translation([0.4, 0.15]);
                scene.flexible(match is_large {
                    true => block.large_strain(),
                    false => block.small_strain(),
                });
                scene.steps(5);
                for step in 1..=10 {
                    let body = &mut scene.world.bodies[turning];
                    match bar {
                        Velocity => body.set_angvel(real(60.0 * turn), true),
                        Position => {
                            let angle = f64::from(step) * turn;
                            body.set_next_kinematic_rotation(Rotation::from_angle(real(angle)));
                        }
                        Free if step == 1 => body.set_angvel(real(60.0 * turn), true),
                        Free => {}
                    }
                    let told = scene
                        .try_step()
                        .expect("the step can be taken")
                        .gap_violation();
                    let deep = deepest_in_bar(&scene, turning);
                    let name = format!("{bar:?}, {turn} rad, large {is_large}, step {step}");
                    assert!(deep <= told.max(1e-4), "{name}: {deep} m, {told} m told");
                }
                let moved = scene.bodies.iter().any(|(_, body)| body.linvel()[1] > 0.1);
                assert!(moved, "{bar:?}, {turn} rad: never met");
            }
        }
    }
}

/// What turns a bar.
#[derive(Clone, Copy, Debug)]
enum Bar {
    Velocity,
    Position,
    Free,
}

/// How deep nodes of flexible bodies are in a bar of .85 m by .03 m in half (m).
fn deepest_in_bar(scene: &Scene, bar: RigidBodyHandle) -> f64 {
    let pose = *scene.world.bodies[bar].position();
    let nodes = scene.bodies.iter().flat_map(|(_, body)| {
        let nodes = 0..body.n_nodes();
        nodes.map(|node| body.position(node))
    });
    nodes
        .map(|[x, y]| {
            let local = pose.inverse_transform_point(vec2(x, y));
            let within = 0.85 - f64::from(local.x).abs();
            within.min(0.03 - f64::from(local.y).abs())
        })
        .fold(0.0, f64::max)
}
