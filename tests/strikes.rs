//! What is struck into a flexible body by something that nobody has claimed: the flexible stage foresees it, and what it cannot foresee is told.

mod common;

use common::*;
use foil2d::pipeline::{Participant, Quality};

/// Upper face of the plank (m).
const FACE: f64 = 0.2;

/// A plank of two metres without gravity, on which nothing lies.
fn plank(is_large: bool) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let body = FlexBodyBuilder::rectangle([2.0, FACE], [20, 2])
        .material(elastic(1e7, 1000.0, 0.0))
        .translation([-1.0, 0.0])
        .pin_where(|[x, _]| !(0.01..1.99).contains(&x), Pin::both());
    let handle = scene.flexible(match is_large {
        true => body.large_strain(),
        false => body.small_strain(),
    });
    (scene, handle)
}

/// Depth of any of these colliders in the plank (m).
fn depth(scene: &Scene, plank: FlexBodyHandle, colliders: &[ColliderHandle]) -> f64 {
    let outline = Outline::of(scene.body(plank));
    let of = |handle: &ColliderHandle| {
        Figure::of(&scene.world.colliders[*handle]).depth_of_outline(&outline)
    };
    colliders.iter().map(of).fold(0.0, f64::max)
}

/// A ball of 100 kg at 10 m/s strikes a box of 1 kg that is at rest this far above the plank (m), and touches `n_between` others of its kind
/// before it; returns the deepest overlap of 30 steps.
fn deepest_of_blow(above: f64, n_between: usize, sleeps: bool, is_large: bool) -> f64 {
    let (mut scene, plank) = plank(is_large);
    let mut colliders = Vec::new();
    let box_of = |place: f64| {
        let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, place));
        let body = body.can_sleep(sleeps).sleeping(sleeps);
        (body, ColliderBuilder::cuboid(0.1, 0.1).density(25.0))
    };
    let mut place = FACE + above + 0.1;
    for _ in 0..=n_between {
        let (body, shape) = box_of(place);
        colliders.push(scene.world.insert(body, shape).1);
        place += 0.2;
    }
    let radius = 0.1;
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, place - 0.1 + radius + 5e-4))
        .linvel(vec2(0.0, -10.0));
    let shape = ColliderBuilder::ball(real(radius))
        .mass(100.0)
        .restitution(0.9);
    colliders.push(scene.rigid(ball, shape).1);
    let mut deepest = 0.0f64;
    for step in 0..30 {
        scene.try_step().expect("the step can be taken");
        let depth = depth(&scene, plank, &colliders);
        assert!(
            depth <= 1.1 * scene.report().gap_violation() + 1e-3,
            "step {step}: {depth} m of which {} m are told",
            scene.report().gap_violation()
        );
        deepest = deepest.max(depth);
    }
    deepest
}

/// The box has no velocity of its own, so nothing but the ball foretells where it goes: it flies 0.3 m in the step of the blow.
#[test]
fn what_rests_above_a_plank_is_not_struck_into_it() {
    for above in [0.02, 0.1, 0.2] {
        for n_between in [0, 2] {
            // The corners of the box are right over nodes, which a plank that bends moves along it.
            for (is_large, bound) in [(false, 1e-5), (true, 1e-4)] {
                let deepest = deepest_of_blow(above, n_between, false, is_large);
                assert!(
                    deepest < bound,
                    "{above} m above, {n_between} between, large {is_large}: {deepest} m"
                );
            }
        }
    }
}

/// As above, and all that is struck sleeps.
#[test]
fn what_sleeps_above_a_plank_is_not_struck_into_it() {
    let deepest = deepest_of_blow(0.1, 1, true, true);
    assert!(deepest < 1e-5, "{deepest} m");
}

/// A force of the user's drives a body that is at rest by 0.3 m in a step.
#[test]
fn what_a_force_drives_is_met_in_the_same_step() {
    let (mut scene, plank) = plank(true);
    let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, FACE + 0.3));
    let (body, collider) = scene.rigid(body, ColliderBuilder::cuboid(0.1, 0.1).density(25.0));
    scene.try_step().expect("the step can be taken");
    scene.world.bodies[body].add_force(vec2(0.0, -1800.0), true);
    scene.try_step().expect("the step can be taken");
    let depth = depth(&scene, plank, &[collider]);
    assert!(depth < 1e-5, "{depth} m");
}

/// Rapier wakes a box that a ball strikes within its own step, and lets it fall into a block that still sleeps.
#[test]
fn what_is_struck_awake_does_not_fall_into_the_sleeper_under_it() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.5, 0.25], [6, 3])
            .material(elastic(1e7, 1000.0, 1e-3))
            .translation([-0.25, 0.01]),
    );
    let rest = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.4));
    let shape = ColliderBuilder::cuboid(0.2, 0.1).density(500.0);
    let (rest, on_it) = scene.world.insert(rest, shape);
    let sleeps = |scene: &Scene| {
        let carrier = scene.body(block).rigid_body_handle();
        let both = [carrier, rest].map(|body| &scene.world.bodies[body]);
        both.iter().all(|body| body.is_sleeping())
    };
    for _ in 0..300 {
        scene.step();
    }
    assert!(sleeps(&scene), "it does not sleep");
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 1.2))
        .linvel(vec2(0.0, -1.0));
    let shape = ColliderBuilder::ball(0.05).density(500.0);
    scene.world.insert(ball, shape);
    for _ in 0..60 {
        scene.step();
        let depth = depth(&scene, block, &[on_it]);
        assert!(depth < 1e-5, "{depth} m");
    }
}

/// The motor of a joint gives a body that is at rest all of its speed in one step of rapier's: nobody foresees it, and the report tells of it.
#[test]
fn what_a_motor_flings_into_a_plank_is_told() {
    let (mut scene, plank) = plank(true);
    let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, FACE + 0.4));
    let (body, collider) = scene.rigid(body, ColliderBuilder::cuboid(0.1, 0.1).density(25.0));
    let anchor = scene.world.insert_body(RigidBodyBuilder::fixed());
    let motor = PrismaticJointBuilder::new(vec2(0.0, 1.0))
        .local_anchor1(vec2(0.0, FACE + 0.4))
        .motor_velocity(-20.0, 1e6);
    scene.world.impulse_joints.insert(anchor, body, motor, true);
    let mut is_told = false;
    for _ in 0..4 {
        let report = scene.try_step().expect("the step can be taken").clone();
        let deepest = depth(&scene, plank, &[collider]);
        if deepest > 1e-3 {
            let told = report.gap_violation();
            assert!(
                (told / deepest - 1.0).abs() < 0.1,
                "{deepest} m, told {told}"
            );
            is_told = report.unsolved().iter().any(|one| {
                one.quality == Quality::Unfinished
                    && one.bodies.contains(&Participant::Flex(plank))
                    && one.bodies.contains(&Participant::Rigid(collider))
            });
            break;
        }
    }
    assert!(is_told);
}
