//! What rapier's users set on rigid bodies holds while a flexible body claims them: beside rapier alone, or a closed form.

mod common;

use common::*;
use foil2d::pipeline::Quality;

const DT: f64 = 1.0 / 240.0;

/// A slab of 20 × 0.4 m whose upper face is `y = 0`, held everywhere: flexible to the solver, rigid to the eye.
fn slab() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([20.0, 0.4], [80, 2])
        .material(LinearElastic::plane_stress(1e9, 0.3).density(1000.0))
        .pin_where(|_| true, Pin::both())
        .translation([-10.0, -0.4])
}

/// The same scene twice: on the flexible slab, and on a fixed cuboid with rapier alone.
struct Twins {
    claimed: Scene,
    alone: Scene,
}

impl Twins {
    fn new() -> Self {
        let (mut claimed, mut alone) = (Scene::new(DT), Scene::new(DT));
        claimed.flexible(slab());
        let floor = ColliderBuilder::cuboid(10.0, 0.2).translation(vec2(0.0, -0.2));
        alone.fixed(floor);
        Self { claimed, alone }
    }

    /// A body in both; handles agree because the slab's carrier comes last in neither.
    fn add(&mut self, body: RigidBodyBuilder, collider: ColliderBuilder) -> [RigidBodyHandle; 2] {
        let body = body.can_sleep(false);
        [
            self.claimed.world.insert(body.clone(), collider.clone()).0,
            self.alone.world.insert(body, collider).0,
        ]
    }

    fn each(&mut self, [claimed, alone]: [RigidBodyHandle; 2], change: impl Fn(&mut RigidBody)) {
        change(&mut self.claimed.world.bodies[claimed]);
        change(&mut self.alone.world.bodies[alone]);
    }

    fn steps(&mut self, n: usize) {
        for _ in 0..n {
            self.claimed.step();
            self.alone.world.step();
        }
    }

    fn of(&self, [claimed, alone]: [RigidBodyHandle; 2]) -> [&RigidBody; 2] {
        [
            &self.claimed.world.bodies[claimed],
            &self.alone.world.bodies[alone],
        ]
    }

    /// How far apart the two are: position (m), angle (rad), velocity (m/s), spin (rad/s).
    fn apart(&self, handles: [RigidBodyHandle; 2]) -> [f64; 4] {
        let [a, b] = self.of(handles);
        [
            f64::from((a.translation() - b.translation()).length()),
            f64::from((a.rotation().angle() - b.rotation().angle()).abs()),
            f64::from((a.linvel() - b.linvel()).length()),
            f64::from((a.angvel() - b.angvel()).abs()),
        ]
    }

    fn assert_close(&self, handles: [RigidBodyHandle; 2], tolerance: [f64; 4], context: &str) {
        let apart = self.apart(handles);
        let [a, b] = self.of(handles);
        let is_close = apart
            .iter()
            .zip(tolerance)
            .all(|(apart, most)| *apart <= most);
        assert!(
            is_close,
            "{context}: apart by {apart:?}; {} {} {} and {} {} {}",
            a.translation(),
            a.linvel(),
            a.angvel(),
            b.translation(),
            b.linvel(),
            b.angvel()
        );
    }
}

fn at(x: f64, y: f64) -> RigidBodyBuilder {
    RigidBodyBuilder::dynamic().translation(vec2(x, y))
}

fn crate_of(density: f64) -> ColliderBuilder {
    ColliderBuilder::cuboid(0.25, 0.25)
        .density(real(density))
        .friction(0.5)
}

/// Rapier's contacts give by a millimetre and its steps are of first order: what both agree to after a second.
const ALIKE: [f64; 4] = [0.02, 0.02, 0.05, 0.1];

#[test]
fn locked_axes_hold_what_they_lock_and_nothing_else() {
    let mut twins = Twins::new();
    let spun = || at(-4.0, 0.25).linvel(vec2(1.0, 0.0));
    let no_turn = twins.add(
        spun().locked_axes(LockedAxes::ROTATION_LOCKED),
        crate_of(500.0),
    );
    let no_x = twins.add(
        at(0.0, 0.6).locked_axes(LockedAxes::TRANSLATION_LOCKED_X),
        crate_of(500.0),
    );
    let no_y = twins.add(
        at(4.0, 0.25)
            .locked_axes(LockedAxes::TRANSLATION_LOCKED_Y)
            .linvel(vec2(1.0, 0.0)),
        crate_of(500.0),
    );
    for handles in [no_turn, no_x, no_y] {
        // Off the centre: it would turn what may turn.
        twins.each(handles, |body| {
            let above = body.translation() + vec2(0.0, 0.2);
            body.apply_impulse_at_point(vec2(60.0, 0.0), above, true);
        });
    }
    twins.steps(60);
    assert!(twins.claimed.report().n_claimed() >= 2);
    let [claimed, _] = twins.of(no_turn);
    assert!(claimed.rotation().angle().abs() < 1e-6);
    twins.assert_close(no_turn, ALIKE, "rotation locked");
    let [claimed, _] = twins.of(no_x);
    assert_eq!(claimed.translation().x, 0.0);
    let [claimed, _] = twins.of(no_y);
    assert!((claimed.translation().y - 0.25).abs() < 1e-6);
    assert_eq!(claimed.locked_axes(), LockedAxes::TRANSLATION_LOCKED_Y);
}

#[test]
fn gravity_scale_damping_forces_and_torques_act_as_they_say() {
    let mut scene = Scene::new(DT);
    let slab = scene.flexible(slab().friction(0.0));
    let light = scene
        .rigid(at(-6.0, 0.25).gravity_scale(0.25), crate_of(400.0))
        .0;
    let damped = scene
        .rigid(
            at(-2.0, 0.25).linvel(vec2(2.0, 0.0)).linear_damping(1.5),
            crate_of(400.0).friction(0.0),
        )
        .0;
    let pushed = scene.rigid(at(2.0, 0.25), crate_of(400.0).friction(0.0)).0;
    scene.world.bodies[pushed].add_force(vec2(200.0, -300.0), true);
    // On a corner of no friction, a ball: its spin obeys its own torque and damping.
    let turned = scene
        .rigid(
            at(6.0, 0.25).angular_damping(2.0),
            ColliderBuilder::ball(0.25)
                .density(real(400.0))
                .friction(0.0),
        )
        .0;
    scene.world.bodies[turned].add_torque(10.0, true);
    scene.steps(240);
    assert_eq!(scene.report().n_claimed(), 4);
    let (mass, ball) = (100.0, scene.mass(turned));
    let t = 240.0 * DT;
    let vx = |handle: RigidBodyHandle| f64::from(scene.world.bodies[handle].linvel().x);
    // dv/dt = -c v, to the (β1 - ½) c² dt of the integrator, 5e-4.
    let expected = 2.0 * (-1.5 * t).exp();
    assert!(
        (vx(damped) / expected - 1.0).abs() < 6e-4,
        "{} not {expected}",
        vx(damped)
    );
    assert!(
        (vx(pushed) - 200.0 / mass * t).abs() < 1e-4,
        "{}",
        vx(pushed)
    );
    let inertia = 0.5 * ball * 0.25 * 0.25;
    let expected = 10.0 / (2.0 * inertia) * (1.0 - (-2.0 * t).exp());
    let spin = f64::from(scene.world.bodies[turned].angvel());
    assert!(
        (spin / expected - 1.0).abs() < 1e-3,
        "{spin} not {expected}"
    );
    // All weights and the force arrive in the slab.
    let weight = G * (0.25 * mass + 2.0 * mass + ball) + 300.0;
    let force = -scene.force_on_flexible(slab)[1];
    assert!((force / weight - 1.0).abs() < 1e-4, "{force} of {weight} N");
    let at = scene.world.bodies[light].translation();
    assert!((f64::from(at.y) - 0.25).abs() < 1e-4);
}

#[test]
fn impulses_applied_between_steps_change_velocities_by_what_they_say() {
    let mut scene = Scene::new(DT);
    scene.flexible(slab().friction(0.0));
    let shape = || {
        ColliderBuilder::ball(0.25)
            .density(real(400.0))
            .friction(0.0)
    };
    let ball = scene.rigid(at(0.0, 0.25), shape()).0;
    scene.steps(60);
    let mass = scene.mass(ball);
    let body = &mut scene.world.bodies[ball];
    body.apply_impulse(vec2(0.5 * mass, 2.0 * mass), true);
    body.apply_torque_impulse(real(0.5 * mass * 0.0625 * 3.0), true);
    scene.steps(60);
    let t = 60.0 * DT;
    let body = &scene.world.bodies[ball];
    assert!((f64::from(body.linvel().x) - 0.5).abs() < 1e-5);
    assert!((f64::from(body.angvel()) - 3.0).abs() < 1e-3);
    // The force of the last contact acts on for half a step: G dt / 2 of 0.02 m/s, and that while it flies.
    let height = f64::from(body.translation().y) - 0.25 - (2.0 * t - 0.5 * G * t * t);
    assert!(height.abs() < 0.5 * G * DT * t * 1.2, "{height} m");
}

#[test]
fn additional_mass_and_a_centre_of_mass_off_the_origin_count() {
    // A beam whose weight sits far out: it stands on the slab only if the centre of mass is over its base, and tips otherwise.
    for (offset, tips) in [(0.2, false), (0.3, true)] {
        let mut twins = Twins::new();
        let shape = ColliderBuilder::cuboid(0.25, 0.25)
            .density(0.0)
            .friction(1.0);
        let body = at(0.0, 0.25).additional_mass_properties(MassProperties::new(
            vec2(offset, 0.0),
            50.0,
            2.0,
        ));
        let handles = twins.add(body, shape);
        twins.steps(120);
        let [claimed, alone] = twins.of(handles);
        assert_eq!(
            claimed.rotation().angle() < -0.1,
            tips,
            "{offset}: {}",
            claimed.rotation().angle()
        );
        assert_eq!(alone.rotation().angle() < -0.1, tips);
        if !tips {
            twins.assert_close(handles, ALIKE, "offset");
            let [slab_force] = [twins
                .claimed
                .report()
                .contacts()
                .iter()
                .map(|contact| contact.normal_force)
                .sum::<f64>()];
            assert!(
                (slab_force / (50.0 * G) - 1.0).abs() < 1e-3,
                "{slab_force} N"
            );
        }
    }
    let mut scene = Scene::new(DT);
    let slab = scene.flexible(slab());
    let heavy = scene
        .rigid(at(0.0, 0.25).additional_mass(300.0), crate_of(400.0))
        .0;
    scene.steps(120);
    assert!((scene.mass(heavy) - 400.0).abs() < 1e-3);
    let force = -scene.force_on_flexible(slab)[1];
    assert!((force / (400.0 * G) - 1.0).abs() < 1e-4, "{force} N");
}

#[test]
fn a_body_that_turns_about_a_centre_off_its_origin_flies_as_with_rapier_alone() {
    let mut twins = Twins::new();
    // Thrown from the slab's side, claimed by a touch with a light box.
    let shape = ColliderBuilder::cuboid(0.4, 0.1)
        .translation(vec2(0.4, 0.0))
        .density(200.0);
    let body = at(0.0, 0.1).linvel(vec2(0.0, 4.0)).angvel(3.0);
    let handles = twins.add(body, shape.friction(0.0));
    twins.steps(90);
    // In free flight rapier is of first order: g t dt / 2.
    twins.assert_close(handles, [0.02, 0.02, 0.05, 0.1], "flight");
}

#[test]
fn kinematic_bodies_of_both_kinds_push_claimed_ones() {
    let mut twins = Twins::new();
    let by_velocity = RigidBodyBuilder::kinematic_velocity_based().translation(vec2(-5.0, 0.3));
    let by_position = RigidBodyBuilder::kinematic_position_based().translation(vec2(3.0, 0.3));
    let pusher = || ColliderBuilder::cuboid(0.2, 0.2);
    let one = twins.add(by_velocity.linvel(vec2(0.5, 0.0)), pusher());
    let other = twins.add(by_position, pusher());
    let pushed = [-4.5, 3.5].map(|x| twins.add(at(x, 0.25), crate_of(300.0)));
    for step in 0..480 {
        let x = 3.0 + 0.5 * DT * f64::from(step + 1);
        twins.each(other, |body| {
            body.set_next_kinematic_translation(vec2(x, 0.3))
        });
        twins.steps(1);
    }
    for (pusher, pushed) in [one, other].into_iter().zip(pushed) {
        twins.assert_close(pusher, [1e-4, 0.0, 1e-3, 0.0], "the pusher");
        twins.assert_close(pushed, ALIKE, "the pushed box");
        let [claimed, _] = twins.of(pushed);
        let [by, _] = twins.of(pusher);
        let gap = f64::from(claimed.translation().x - by.translation().x) - 0.45;
        assert!(gap.abs() < 1e-3, "it stays in touch: {gap} m");
    }
    assert!(twins.claimed.report().n_claimed() >= 2);
}

#[test]
fn dominant_bodies_are_not_moved_by_those_they_dominate() {
    // A light plank of dominance 1 pushes a heavy box on the slab as if the box weighed nothing.
    let mut twins = Twins::new();
    let dominant = at(-1.0, 0.1).linvel(vec2(1.0, 0.0)).dominance_group(1);
    let dominant = twins.add(
        dominant
            .gravity_scale(0.0)
            .locked_axes(LockedAxes::ROTATION_LOCKED),
        ColliderBuilder::cuboid(0.25, 0.09)
            .density(1.0)
            .friction(0.0),
    );
    let heavy = twins.add(at(0.0, 0.25), crate_of(1000.0).friction(0.0));
    twins.steps(240);
    let [claimed, alone] = twins.of(dominant);
    assert!(
        (alone.linvel().x - 1.0).abs() < 1e-3,
        "rapier: {}",
        alone.linvel()
    );
    assert!(
        (claimed.linvel().x - 1.0).abs() < 1e-3,
        "{}",
        claimed.linvel()
    );
    // They meet after half a second and go on together; rapier's own box hops before the plank.
    let [pushed, _] = twins.of(heavy);
    assert!(
        (f64::from(pushed.translation().x) - 0.5).abs() < 1e-3,
        "{}",
        pushed.translation()
    );
    assert!(
        (f64::from(pushed.linvel().x) - 1.0).abs() < 1e-3,
        "{}",
        pushed.linvel()
    );
    // And a flexible block does not stop it either.
    let mut scene = Scene::in_free_space(DT);
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
        .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0));
    let block = scene.flexible(block.translation([0.5, -0.5]));
    let body = at(0.0, 0.0).linvel(vec2(1.0, 0.0)).dominance_group(10);
    let (body, _) = scene.rigid(body, ColliderBuilder::ball(0.2));
    scene.steps(480);
    assert_eq!(scene.world.bodies[body].linvel().x, 1.0);
    assert!(
        scene.body(block).linvel()[0] > 0.95,
        "{:?}",
        scene.body(block).linvel()
    );
}

#[test]
fn a_dominated_box_rests_on_a_flexible_block_without_weighing_on_it() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(elastic(1e6, 1000.0, 2e-2));
    let block = scene.flexible(block);
    let (heavy, _) = scene.rigid(at(0.5, 1.25).dominance_group(-1), crate_of(4000.0));
    scene.steps(480);
    let report = scene.report();
    let on_ground: f64 = (report.contacts().iter())
        .filter(|contact| contact.position[1] < 0.1)
        .map(|contact| contact.normal_force)
        .sum();
    let weight = G * scene.body(block).mass();
    assert!(
        (on_ground / weight - 1.0).abs() < 1e-4,
        "{on_ground} of {weight} N"
    );
    let top = scene.body(block).position(22)[1];
    let y = f64::from(scene.world.bodies[heavy].translation().y);
    assert!((y - top - 0.25).abs() < 1e-4, "{y} m on {top} m");
}

#[test]
fn teleports_and_set_velocities_of_claimed_bodies_count_at_once() {
    let mut twins = Twins::new();
    let body = twins.add(at(0.0, 0.25), crate_of(300.0));
    twins.steps(60);
    twins.each(body, |body| {
        body.set_translation(vec2(3.0, 1.0), true);
        body.set_rotation(foil2d::rapier::math::Rotation::new(0.2), true);
        body.set_linvel(vec2(1.0, 0.0), true);
        body.set_angvel(-1.0, true);
    });
    twins.steps(30);
    twins.assert_close(body, ALIKE, "in flight");
    let t = 30.0 * DT;
    let [claimed, _] = twins.of(body);
    assert!((f64::from(claimed.translation().x) - 3.0 - t).abs() < 1e-4);
    // Turned where it lies, it begins to fall over as it should: on one corner, without a jump.
    let mut twins = Twins::new();
    let body = twins.add(at(0.0, 0.25), crate_of(300.0));
    twins.steps(30);
    twins.each(body, |body| {
        body.set_position(Pose::new(vec2(0.0, 0.3), 0.2), true);
    });
    twins.steps(60);
    twins.assert_close(body, [0.03, 0.05, 0.3, 0.6], "on its corner");
}

#[test]
fn colliders_added_removed_and_disabled_change_what_a_claimed_body_stands_on() {
    let mut scene = Scene::new(DT);
    scene.flexible(slab());
    // Its own mass, for when it has no collider left.
    let (body, feet) = scene.rigid(at(0.0, 0.25).additional_mass(10.0), crate_of(300.0));
    scene.steps(60);
    let y = |scene: &Scene| f64::from(scene.world.bodies[body].translation().y);
    assert!((y(&scene) - 0.25).abs() < 1e-4);
    // A longer leg under it, when it is lifted.
    scene.world.bodies[body].set_translation(vec2(0.0, 0.6), true);
    let leg = ColliderBuilder::cuboid(0.25, 0.1)
        .translation(vec2(0.0, -0.35))
        .density(100.0);
    let leg = scene.world.insert_collider(leg, Some(body));
    scene.steps(240);
    assert!((y(&scene) - 0.45).abs() < 1e-3, "{}", y(&scene));
    scene.world.colliders[leg].set_enabled(false);
    scene.steps(240);
    assert!((y(&scene) - 0.25).abs() < 1e-3, "{}", y(&scene));
    scene.world.colliders[leg].set_enabled(true);
    scene.world.bodies[body].set_translation(vec2(0.0, 0.46), true);
    scene.steps(240);
    assert!((y(&scene) - 0.45).abs() < 1e-3, "{}", y(&scene));
    scene.world.remove_collider(leg);
    scene.steps(240);
    assert!((y(&scene) - 0.25).abs() < 1e-3, "{}", y(&scene));
    scene.world.remove_collider(feet);
    scene.steps(60);
    assert!(y(&scene) < 0.0, "nothing is left to stand on");
    assert_eq!(scene.report().n_claimed(), 0);
}

#[test]
fn bodies_removed_or_disabled_in_contact_let_go_of_their_neighbours() {
    for disables in [false, true] {
        let mut scene = Scene::new(DT);
        let slab = scene.flexible(slab());
        let stack: Vec<_> = (0..4)
            .map(|level| {
                scene
                    .rigid(at(0.0, 0.25 + 0.5 * f64::from(level)), crate_of(300.0))
                    .0
            })
            .collect();
        scene.steps(120);
        let weight = 75.0 * G;
        let force = |scene: &Scene| -scene.force_on_flexible(slab)[1];
        assert!((force(&scene) / (4.0 * weight) - 1.0).abs() < 1e-3);
        // The second one goes: the upper two fall half a metre, and all that are left are carried.
        if disables {
            scene.world.bodies[stack[1]].set_enabled(false);
        } else {
            scene.world.remove_body(stack[1]);
        }
        scene.steps(480);
        let y = |handle: RigidBodyHandle| f64::from(scene.world.bodies[handle].translation().y);
        assert!((y(stack[3]) - 1.25).abs() < 5e-3, "{}", y(stack[3]));
        assert!(
            (force(&scene) / (3.0 * weight) - 1.0).abs() < 1e-3,
            "{} N",
            force(&scene)
        );
        if disables {
            assert!(
                (y(stack[1]) - 0.75).abs() < 1e-3,
                "a disabled body stays where it was"
            );
        }
    }
}

#[test]
fn a_change_of_type_counts_from_the_next_step_on() {
    let mut scene = Scene::new(DT);
    scene.flexible(slab());
    let (body, _) = scene.rigid(at(0.0, 0.5), crate_of(300.0));
    scene.world.bodies[body].set_body_type(RigidBodyType::Fixed, true);
    scene.steps(30);
    assert_eq!(scene.world.bodies[body].translation().y, 0.5);
    scene.world.bodies[body].set_body_type(RigidBodyType::Dynamic, true);
    scene.steps(240);
    let y = f64::from(scene.world.bodies[body].translation().y);
    assert!((y - 0.25).abs() < 1e-3, "{y}");
}

/// A world with a flexible ring, pinned below, around everything: whatever is within its box is solved with it.
fn within_a_ring(rate: f64, gravity: bool) -> Scene {
    let mut scene = match gravity {
        true => Scene::new(1.0 / rate),
        false => Scene::in_free_space(1.0 / rate),
    };
    let ring = FlexBodyBuilder::annulus(8.0, 8.5, 0.8)
        .material(elastic(1e8, 20.0, 0.0))
        .pin_where(|[_, y]| y < 0.0, Pin::both())
        .can_sleep(false);
    scene.flexible(ring);
    scene
}

/// What is round touches a sharp corner along the line to its centre. Without friction nothing turns it there, and between a corner at 30° from upright and
/// a wall the forces are those of a wedge.
#[test]
fn a_round_body_between_a_corner_and_a_wall_rests_without_turning() {
    let radius = 0.1;
    let shapes = [
        ColliderBuilder::ball(real(radius)),
        ColliderBuilder::capsule_y(0.1, real(radius)),
    ];
    // Mirrored, the corner and what is round are named the other way round.
    for ((shape, up), side) in shapes
        .iter()
        .zip([0.0, 0.1])
        .flat_map(|case| [-1.0, 1.0].map(|side| (case, side)))
    {
        for half in [0.02, 0.1, 1.0] {
            let mut scene = within_a_ring(60.0, true);
            let corner = ColliderBuilder::cuboid(real(half), real(half))
                .translation(vec2(0.0, -half * std::f64::consts::SQRT_2))
                .rotation(real(std::f64::consts::FRAC_PI_4))
                .friction(0.0);
            let corner = scene.fixed(corner);
            let wall = ColliderBuilder::cuboid(0.1, 1.0).translation(vec2(0.25 * side, 0.0));
            let wall = scene.fixed(wall.friction(0.0));
            let at = [0.5 * radius * side, 0.75f64.sqrt() * radius];
            let body = RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1] + up));
            let (ball, _) = scene.rigid(body, shape.clone().density(100.0).friction(0.0));
            scene.steps(60);
            let name = format!("{half} m, {side}");
            let weight = scene.mass(ball) * G;
            let body = &scene.world.bodies[ball];
            let (spin, turn) = (f64::from(body.angvel()), turn_of(body));
            assert!(
                spin.abs() < 1e-3 && turn.abs() < 1e-3,
                "{name}: {spin} rad/s, {turn} rad"
            );
            let forces = [corner, wall].map(|collider| {
                let [x, y] = scene.force_on_collider(collider);
                x.hypot(y) / weight
            });
            let exact = [2.0 / 3f64.sqrt(), 1.0 / 3f64.sqrt()];
            for (force, exact) in forces.into_iter().zip(exact) {
                assert!((force - exact).abs() < 1e-3, "{name}: {force} of {exact}");
            }
        }
    }
}

/// A ball that rolls or slides to the edge of a box goes over it, and keeps its energy to the first order of the step.
#[test]
fn a_ball_rolls_over_an_edge() {
    let radius = 0.1;
    for (friction, speed) in [(0.0, 0.2), (0.0, 0.5), (1.0, 0.2), (1.0, 0.5)] {
        let mut scene = within_a_ring(240.0, true);
        let table = ColliderBuilder::cuboid(1.0, 1.0).translation(vec2(-1.0, -1.0));
        scene.fixed(table.friction(real(friction)));
        let spin = if friction > 0.0 { -speed / radius } else { 0.0 };
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(-0.05, radius))
            .linvel(vec2(speed, 0.0))
            .angvel(real(spin));
        let shape = ColliderBuilder::ball(real(radius)).density(100.0);
        let (ball, _) = scene.rigid(body, shape.friction(real(friction)));
        let mass = scene.mass(ball);
        let energy = |scene: &Scene| {
            let body = &scene.world.bodies[ball];
            kinetic_of(body) + mass * G * place_of(body)[1]
        };
        let began =
            0.5 * mass * (speed * speed + 0.5 * (radius * spin).powi(2)) + mass * G * radius;
        scene.steps(192);
        let body = &scene.world.bodies[ball];
        let (vx, spin) = (velocity_of(body)[0], f64::from(body.angvel()));
        assert!(vx > speed, "{vx} m/s after {speed} m/s to the edge");
        assert!(
            friction > 0.0 || spin.abs() < 1e-3,
            "{spin} rad/s without friction"
        );
        let gained = (energy(&scene) - began) / (mass * G * radius);
        assert!(gained.abs() < 1e-2, "{gained} of m g r");
    }
}

/// Compact bodies on long arms turn about their hinges, where they have all the inertia that a step needs: nothing is damped.
#[test]
fn a_body_on_a_hinge_keeps_its_energy() {
    // A ball that whirls without gravity, and a box that swings from horizontal.
    let whirl = (false, 1.0, 6.0, ColliderBuilder::ball(0.1));
    let swing = (true, 3.0, 0.0, ColliderBuilder::cuboid(0.1, 0.1));
    for (gravity, arm, spin, shape) in [whirl, swing] {
        let mut scene = within_a_ring(60.0, gravity);
        let ground = scene.world.insert_body(RigidBodyBuilder::fixed());
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(arm, 0.0))
            .linvel(vec2(0.0, arm * spin))
            .angvel(real(spin));
        let (body, _) = scene.rigid(body, shape.density(100.0));
        let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-arm, 0.0));
        scene.world.insert_impulse_joint(ground, body, hinge);
        let mass = scene.mass(body);
        let whole = match gravity {
            true => mass * G * arm,
            false => 0.5 * mass * (arm * spin).powi(2),
        };
        let energy = |scene: &Scene| {
            let body = &scene.world.bodies[body];
            let potential = if gravity {
                mass * G * place_of(body)[1]
            } else {
                0.0
            };
            kinetic_of(body) + potential
        };
        scene.step();
        let began = energy(&scene);
        scene.steps(360);
        let change = (energy(&scene) - began) / whole;
        assert!(change.abs() < 1e-4, "{change} of {whole} J");
    }
}

/// How a lift holds what it lifts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lifts {
    Lying,
    Welded,
    /// On a rigid box that a joint holds to the lift.
    Jointed,
}

/// A lift that goes up at 0.5 m/s for a second: by how much it has risen, and what it lifts (m), what has been dissipated (J), and whether all was solved.
fn lifted(
    lift: RigidBodyBuilder,
    density: f64,
    lifts: Lifts,
    is_large: bool,
) -> ([f64; 2], f64, bool) {
    let mut scene = Scene::new(1.0 / 60.0);
    let height = if lifts == Lifts::Jointed { 0.2 } else { 0.0 };
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
        .material(elastic(1e7, 1000.0, 1e-3))
        .translation([-0.2, height]);
    let block = scene.flexible(match is_large {
        true => block.large_strain(),
        false => block.small_strain(),
    });
    let lift = lift.translation(vec2(0.0, -0.1)).linvel(vec2(0.0, 0.5));
    let (lift, _) = scene.rigid(
        lift,
        ColliderBuilder::cuboid(2.0, 0.1).density(real(density)),
    );
    match lifts {
        Lifts::Lying => {}
        Lifts::Welded => {
            let weld = AttachmentBuilder::weld(block).where_(|[_, y]| y < 1e-9);
            let weld = weld.to_rigid_body(lift);
            let weld = scene.bodies.attach(weld, &scene.world.bodies);
            weld.expect("a weld of the lower edge");
        }
        Lifts::Jointed => {
            let shape = ColliderBuilder::cuboid(0.3, 0.1).density(500.0);
            let (cube, _) = scene.rigid(at(0.0, 0.1), shape);
            let joint = FixedJointBuilder::new()
                .local_anchor1(vec2(0.0, 0.1))
                .local_anchor2(vec2(0.0, -0.1))
                .contacts_enabled(false);
            scene.world.insert_impulse_joint(lift, cube, joint);
        }
    }
    let before = scene.body(block).centre_of_mass()[1];
    let mut is_solved = true;
    for _ in 0..60 {
        is_solved &= scene.step().quality() == Quality::Solved;
    }
    let risen = f64::from(scene.world.bodies[lift].translation().y) + 0.1;
    let carried = scene.body(block).centre_of_mass()[1] - before;
    (
        [risen, carried],
        scene.report().energy().dissipated,
        is_solved,
    )
}

/// What is locked keeps the velocity that it has, whatever lies on it or hangs at it and however light it is itself: its work is that of something driven, and
/// the books say the same as of a kinematic lift.
#[test]
fn what_is_locked_and_moves_lifts_what_lies_on_it() {
    for lifts in [Lifts::Lying, Lifts::Welded, Lifts::Jointed] {
        for is_large in [true, false] {
            let driven = RigidBodyBuilder::kinematic_velocity_based();
            let (_, expected, _) = lifted(driven, 1.0, lifts, is_large);
            for density in [1.0, 400.0, 1e5] {
                let locked = RigidBodyBuilder::dynamic().locked_axes(LockedAxes::all());
                let ([risen, carried], dissipated, is_solved) =
                    lifted(locked, density, lifts, is_large);
                let name = format!("{lifts:?}, large {is_large}, {density} kg/m³");
                assert!((risen - 0.5).abs() < 1e-3, "{name}: {risen} m");
                // It goes along, however it was jolted.
                assert!((carried - 0.5).abs() < 0.03, "{name}: {carried} m");
                assert!(is_solved, "{name}");
                // It lifts 785 J.
                let off = dissipated - expected;
                assert!(off.abs() < 0.5, "{name}: {dissipated} J, not {expected} J");
            }
        }
    }
}
