//! The user's hooks: what they say of flexible and claimed pairs counts, and what they see is the user's world.

use crate::support::*;
use foil2d::integrator::Beta2;
use foil2d::kkt::{ConstraintFunction, ContactMethod};
use foil2d::pipeline::Quality;
use std::sync::atomic::{AtomicUsize, Ordering};

const MODIFY: ActiveHooks = ActiveHooks::MODIFY_SOLVER_CONTACTS;

/// Friction and restitution for all contacts.
struct Material(Real, Real);

impl PhysicsHooks for Material {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        if let Some(rigid) = context.rigid_mut() {
            *rigid.friction = self.0;
            *rigid.restitution = self.1;
        }
    }
}

/// Speed left of 2 m/s after half a second on the ground, for a flexible block and a rigid box on a flexible one.
fn slide(friction: f64) -> [f64; 2] {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let moving = scene.flexible(block().active_hooks(MODIFY).linvel([2.0, 0.0]));
    let slab = FlexBodyBuilder::rectangle([6.0, 0.3], [24, 2])
        .material(elastic(1e9, 1000.0, 1e-3))
        .pin_where(|[_, y]| y == 0.0, Pin::both());
    scene.flexible(slab.translation([10.0, 0.0]));
    let at = RigidBodyBuilder::dynamic()
        .translation(vec2(11.0, 0.4))
        .linvel(vec2(2.0, 0.0));
    let shape = ColliderBuilder::cuboid(0.2, 0.1).active_hooks(MODIFY);
    let (sliding, _) = scene.rigid(at, shape);
    let (hooks, listener) = (Material(real(friction), 0.0), Listener::default());
    for _ in 0..30 {
        scene.hear_with(&hooks, &listener);
    }
    let rigid = f64::from(scene.world.bodies[sliding].linvel().x);
    [scene.body(moving).linvel()[0], rigid]
}

#[test]
fn friction_set_by_the_hook_brakes_by_coulombs_law() {
    for friction in [0.0, 0.1, 0.3] {
        let expected = 2.0 - friction * G * 0.5;
        for speed in slide(friction) {
            // The blocks settle while they slide; the law holds for the sum of the forces, to the ringing of the step's end.
            assert!(
                (speed - expected).abs() < 0.02,
                "{speed} m/s for {friction}, not {expected}"
            );
        }
    }
}

#[test]
fn restitution_set_by_the_hook_makes_a_claimed_box_bounce() {
    let rebound = |restitution: f64| {
        let mut scene = Scene::new(DT);
        scene.flexible(
            block()
                .pin_where(|_| true, Pin::both())
                .translation([0.0, -1.0]),
        );
        let at = RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.0));
        let (ball, _) = scene.rigid(at, ColliderBuilder::ball(0.2).active_hooks(MODIFY));
        let (hooks, listener) = (Material(0.5, real(restitution)), Listener::default());
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..120 {
            scene.hear_with(&hooks, &listener);
            highest = highest.max(f64::from(scene.world.bodies[ball].linvel().y));
        }
        highest
    };
    let impact = (2.0 * G * 0.8).sqrt();
    for restitution in [0.0, 0.5, 0.8] {
        let speed = rebound(restitution);
        // To first order in the step: g dt of 0.16 m/s.
        assert!(
            (speed - restitution * impact).abs() < 0.17,
            "{speed} m/s for {restitution}"
        );
    }
}

/// Lets nothing touch the collider it names.
struct Ghost(ColliderHandle);

impl PhysicsHooks for Ghost {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let is_ghost = [context.collider1, context.collider2].contains(&self.0);
        if let (true, Some(rigid)) = (is_ghost, context.rigid_mut()) {
            rigid.solver_contacts.clear();
        }
    }
}

#[test]
fn contacts_that_the_hook_removes_are_neither_solved_nor_heard() {
    let mut scene = Scene::new(DT);
    let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(vec2(0.0, -0.5));
    let floor = scene.fixed(floor.active_hooks(MODIFY));
    let falling = scene.flexible(block().translation([0.0, 0.3]));
    let listener = Listener::default();
    for _ in 0..60 {
        let heard = scene.hear_with(&Ghost(floor), &listener);
        assert!(heard.collisions.is_empty() && heard.forces.is_empty());
    }
    let fell = 0.8 - scene.body(falling).centre_of_mass()[1];
    assert!((fell - 0.5 * G).abs() < 1e-5, "{fell} m");
}

/// Turns every normal by an angle.
struct Tilt(Real);

impl PhysicsHooks for Tilt {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        if let Some(rigid) = context.rigid_mut() {
            *rigid.normal = Rotation::new(self.0) * *rigid.normal;
        }
    }
}

#[test]
fn a_normal_turned_by_the_hook_pushes_aside() {
    // Flat ground that acts as an incline of 0.2 rad: without friction the block slides down it.
    let angle = 0.2;
    let mut scene = Scene::new(DT);
    let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(vec2(0.0, -0.5));
    scene.fixed(floor.friction(0.0).active_hooks(MODIFY));
    let body = scene.flexible(block().friction(0.0));
    let listener = Listener::default();
    for _ in 0..60 {
        scene.hear_with(&Tilt(real(angle)), &listener);
    }
    let [vx, vy] = scene.body(body).linvel();
    let speed = G * angle.sin();
    // It settles into its sag meanwhile: a millimetre in its period of some steps.
    let along = -vx * angle.cos() - vy * angle.sin();
    assert!(
        (along / speed - 1.0).abs() < 0.02,
        "{along} m/s, not {speed}"
    );
}

/// A platform that holds what comes from above.
struct OneWay(ColliderHandle);

impl PhysicsHooks for OneWay {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let up = if context.collider1 == self.0 {
            vec2(0.0, 1.0)
        } else if context.collider2 == self.0 {
            vec2(0.0, -1.0)
        } else {
            return;
        };
        context.update_as_oneway_platform(up, 0.4);
    }
}

#[test]
fn one_way_platforms_let_bodies_up_and_hold_them_when_they_come_down() {
    let mut scene = Scene::new(DT);
    let platform = ColliderBuilder::cuboid(20.0, 0.05).active_hooks(MODIFY);
    let platform = scene.fixed(platform.translation(vec2(0.0, 2.0)));
    // A flexible block thrown up through it; one dropped on it; one that is too slow to pass and falls back.
    let thrown = scene.flexible(block().translation([0.0, 0.5]).linvel([0.0, 9.0]));
    let dropped = scene.flexible(block().translation([3.0, 2.5]));
    let slow = scene.flexible(block().translation([6.0, 0.5]).linvel([0.0, 3.0]));
    // Two whose heads pass, and not their feet: the one by half, the other by a tenth of its height.
    let half = [(9.0, 5.0), (-4.0, 5.3)].map(|(x, speed)| {
        let jumps = block().translation([x, 0.5]).linvel([0.0, speed]);
        scene.flexible(jumps)
    });
    let (hooks, listener) = (OneWay(platform), Listener::default());
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..240 {
        scene.hear_with(&hooks, &listener);
        highest = highest.max(scene.body(thrown).centre_of_mass()[1]);
    }
    let y = |handle| scene.body(handle).centre_of_mass()[1];
    // v²/2g above where it was thrown, as if nothing were there.
    assert!(
        (highest - 1.0 - 81.0 / (2.0 * G)).abs() < 0.02,
        "{highest} m"
    );
    assert!((y(thrown) - 2.55).abs() < 0.02, "{} m", y(thrown));
    assert!((y(dropped) - 2.55).abs() < 0.02, "{} m", y(dropped));
    for below in [slow, half[0], half[1]] {
        assert!(y(below) < -10.0, "{} m", y(below));
    }
}

#[test]
fn one_way_platforms_hold_claimed_boxes_too() {
    let mut scene = Scene::new(DT);
    // The platform is a rigid body that lies on two flexible blocks.
    scene.ground(0.5);
    for x in [-2.0, 1.0] {
        scene.flexible(block().translation([x, 0.0]));
    }
    let at = RigidBodyBuilder::dynamic().translation(vec2(0.0, 1.1));
    let shape = ColliderBuilder::cuboid(2.5, 0.05)
        .density(500.0)
        .active_hooks(MODIFY);
    let (_, platform) = scene.rigid(at, shape);
    let at = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 0.3))
        .linvel(vec2(0.0, 7.0));
    let (ball, _) = scene.rigid(at, ColliderBuilder::ball(0.2).density(50.0));
    // Blocks below the platform must carry it: they come from below, so only the ball goes by the rule.
    let ball_shape = scene.world.bodies[ball].colliders()[0];
    struct Only(OneWay, ColliderHandle);
    impl PhysicsHooks for Only {
        fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
            if [context.collider1, context.collider2].contains(&self.1) {
                self.0.modify_solver_contacts(context);
            }
        }
    }
    let hooks = Only(OneWay(platform), ball_shape);
    let listener = Listener::default();
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..240 {
        scene.hear_with(&hooks, &listener);
        highest = highest.max(f64::from(scene.world.bodies[ball].translation().y));
    }
    let y = f64::from(scene.world.bodies[ball].translation().y);
    assert!(highest > 2.0, "it passes: {highest} m");
    assert!((y - 1.3).abs() < 0.02, "it rests on the platform: {y} m");
}

/// A one-way platform that looks whether the points it is shown are as far apart as it is told, and how often there are two.
struct Watched(OneWay, AtomicUsize);

impl PhysicsHooks for Watched {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        if let Some(shown) = context.rigid_mut() {
            for contact in shown.solver_contacts.iter() {
                let apart = (contact.anchor2 - contact.anchor1).dot(*shown.normal);
                assert!((apart - contact.dist).abs() < 1e-5, "{contact:?}");
            }
            let has_two = shown.solver_contacts.len() == 2;
            self.1.fetch_add(usize::from(has_two), Ordering::Relaxed);
        }
        self.0.modify_solver_contacts(context);
    }
}

/// A platform as thick as the block is high: some of its faces meet the block's head from inside, others its feet.
#[test]
fn thick_one_way_platforms_let_fall_what_does_not_come_above_them() {
    for small in [false, true] {
        let mut scene = Scene::new(DT);
        let platform = ColliderBuilder::cuboid(40.0, 0.5).active_hooks(MODIFY);
        let platform = scene.fixed(platform.translation(vec2(0.0, 2.0)));
        // How high their feet come, the lowest of them where they are aslant: others are above the platform then.
        let jumps = [
            (0.9, 0.0),
            (1.3, 0.0),
            (1.7, 0.0),
            (1.95, 0.0),
            (2.2, 0.0),
            (2.3, 0.3),
            (2.4, -0.3),
            (2.45, 0.2),
        ];
        let jumps = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| {
            let (feet, turn) = jumps[k];
            let jumps = block().translation([3.0 * k as f64 - 12.0, -1.0]);
            let jumps = jumps.rotation(turn);
            let handle = scene.flexible(if small { jumps.small_strain() } else { jumps });
            let body = scene.bodies.get_mut(handle).expect("it is there");
            let heights = body.positions().chunks_exact(2).map(|at| at[1]);
            let low = heights.fold(f64::INFINITY, f64::min);
            let speed = (2.0 * G * (feet - low)).sqrt();
            body.set_linvel([0.0, speed]).expect("a velocity");
            (feet, handle)
        });
        let hooks = Watched(OneWay(platform), AtomicUsize::new(0));
        let listener = Listener::default();
        let mut most = 0.0_f64;
        for _ in 0..480 {
            let before = scene.report().energy().dissipated;
            scene.hear_with(&hooks, &listener);
            most = most.max(before - scene.report().energy().dissipated);
        }
        assert!(most < 1.0, "{most} J gained, small {small}");
        assert!(hooks.1.into_inner() > 0, "no second point was shown");
        for (feet, handle) in jumps {
            assert!(scene.body(handle).centre_of_mass()[1] < -10.0, "{feet} m");
        }
    }
}

/// Counts what it is shown that is not the user's.
#[derive(Default)]
struct Witness {
    n_filtered: AtomicUsize,
    n_modified: AtomicUsize,
    n_locked: AtomicUsize,
}

impl Witness {
    fn look(
        &self,
        bodies: &RigidBodySet,
        handles: [Option<RigidBodyHandle>; 2],
        claimed: RigidBodyHandle,
    ) {
        for handle in handles.into_iter().flatten() {
            let is_locked = !bodies[handle].locked_axes().is_empty();
            if handle == claimed && is_locked {
                self.n_locked.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

struct Watching<'a>(&'a Witness, RigidBodyHandle);

impl PhysicsHooks for Watching<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        self.0.n_filtered.fetch_add(1, Ordering::Relaxed);
        self.0.look(
            context.bodies,
            [context.rigid_body1, context.rigid_body2],
            self.1,
        );
        Some(SolverFlags::default())
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        self.0.n_modified.fetch_add(1, Ordering::Relaxed);
        self.0.look(
            context.bodies,
            [context.rigid_body1, context.rigid_body2],
            self.1,
        );
    }
}

#[test]
fn hooks_never_see_claimed_bodies_locked() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    scene.flexible(block());
    let at = |x: f64, y: f64| RigidBodyBuilder::dynamic().translation(vec2(x, y));
    let shape = || {
        ColliderBuilder::cuboid(0.2, 0.2)
            .density(100.0)
            .active_hooks(ActiveHooks::all())
    };
    let (lower, _) = scene.rigid(at(0.5, 1.2), shape());
    scene.rigid(at(0.5, 1.6), shape());
    let (witness, listener) = (Witness::default(), Listener::default());
    for _ in 0..60 {
        scene.hear_with(&Watching(&witness, lower), &listener);
    }
    assert_eq!(scene.report().n_claimed(), 2);
    let [filtered, modified, locked] =
        [&witness.n_filtered, &witness.n_modified, &witness.n_locked]
            .map(|n| n.load(Ordering::Relaxed));
    assert!(filtered > 60 && modified > 60, "{filtered} and {modified}");
    assert_eq!(locked, 0);
}

/// A belt that stands still and moves what lies on it along, to the right where it is the first collider of a contact.
struct Belt {
    belt: ColliderHandle,
    velocity: f64,
}

impl PhysicsHooks for Belt {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let sign = match self.belt {
            belt if belt == context.collider1 => 1.0,
            belt if belt == context.collider2 => -1.0,
            _ => return,
        };
        if let ModifiableContacts::Rigid(manifold) = &mut context.contacts {
            for contact in manifold.solver_contacts.iter_mut() {
                contact.tangent_velocity = vec2(sign * self.velocity, 0.0);
            }
        }
    }
}

/// What lies on a belt, and what steps it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lies {
    /// A rigid box that rapier alone steps.
    Alone,
    /// The same beside a flexible block that lies on the belt too.
    Beside,
    Small,
    Large,
    /// Of small strain, by central differences.
    Explicit,
    /// Of small strain, by constraint functions.
    Functions,
}

/// Horizontal velocity of what lies on the belt after some steps, what has been dissipated, and whether all steps were solved.
fn on_a_belt(lies: Lies, time: f64) -> (f64, f64, bool) {
    let dt = match lies {
        Lies::Explicit => 1e-4,
        _ => 1.0 / 60.0,
    };
    let mut scene = Scene::new(dt);
    let functions = ConstraintFunction::new(1e-4, 1e-3).expect("sound epsilons");
    scene.flex = match lies {
        Lies::Explicit => FlexPipeline::new().with_integrator(Beta2::central_difference()),
        Lies::Functions => {
            FlexPipeline::new().with_contact_method(ContactMethod::ConstraintFunction(functions))
        }
        _ => FlexPipeline::new(),
    };
    let belt = ColliderBuilder::cuboid(50.0, 0.5)
        .translation(vec2(0.0, -0.5))
        .friction(0.5)
        .active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
    let belt = scene.world.insert_collider(belt, None);
    let block = |x: f64| {
        FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
            .material(elastic(1e7, 1000.0, 1e-3))
            .friction(0.5)
            .translation([x, 0.0])
    };
    let flexible = match lies {
        Lies::Alone => None,
        Lies::Beside => Some(scene.flexible(block(0.2).small_strain())),
        Lies::Large => Some(scene.flexible(block(-0.2).large_strain())),
        _ => Some(scene.flexible(block(-0.2).small_strain())),
    };
    let rigid = matches!(lies, Lies::Alone | Lies::Beside).then(|| {
        let cube = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.2));
        let shape = ColliderBuilder::cuboid(0.2, 0.2).friction(0.5);
        scene.rigid(cube, shape.density(1000.0)).0
    });
    let hooks = Belt {
        belt,
        velocity: 2.0,
    };
    let mut is_solved = true;
    for _ in 0..(time / dt).round() as usize {
        let (world, bodies) = (&mut scene.world, &mut scene.bodies);
        let report = scene.flex.step_with_events(world, bodies, &hooks, &());
        is_solved &= report.expect("a step").quality() == Quality::Solved;
    }
    let velocity = match (rigid, flexible) {
        (Some(cube), _) => f64::from(scene.world.bodies[cube].linvel().x),
        (_, Some(block)) => scene.body(block).linvel()[0],
        _ => f64::NAN,
    };
    let dissipated = scene.report().energy().dissipated;
    (velocity, dissipated, is_solved)
}

/// Rapier's belt, the tangent velocity of its contacts: what lies on it slides at first, speeds up by `μ g`, and goes along then, as with rapier alone; the belt
/// does twice the work that is left as motion.
#[test]
fn a_belt_takes_along_what_lies_on_it() {
    for lies in [
        Lies::Alone,
        Lies::Beside,
        Lies::Small,
        Lies::Large,
        Lies::Explicit,
        Lies::Functions,
    ] {
        let (velocity, _, _) = on_a_belt(lies, 0.2);
        let expected = 0.2 * 0.5 * 9.81;
        // The first step of a block finds where it lies.
        let off = velocity - expected;
        assert!(off.abs() < 0.1, "{lies:?}, on the way: {velocity} m/s");
        let (velocity, dissipated, is_solved) = on_a_belt(lies, 1.5);
        assert!((velocity - 2.0).abs() < 0.05, "{lies:?}: {velocity} m/s");
        assert!(is_solved, "{lies:?}");
        let mass = match lies {
            // Rapier keeps no books.
            Lies::Alone => continue,
            Lies::Beside => 320.0,
            _ => 160.0,
        };
        let expected = 0.5 * mass * 2.0 * 2.0;
        let off = dissipated - expected;
        assert!(off.abs() < 0.1 * expected, "{lies:?}: {dissipated} J");
    }
}
