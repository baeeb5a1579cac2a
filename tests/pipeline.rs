//! The step as its user sees it: time, bodies that come and go, rapier's events and queries, pins and loads.

use foil2d::body::{BuildError, FlexBodyError};
use foil2d::coupling::RapierSets;
use foil2d::pipeline::{Participant, StepError};
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::sync::Mutex;

type Outcome = Result<(), Box<dyn Error>>;

const GRAVITY: f64 = 9.81;

/// Relative rounding of rapier's numbers.
const REAL_EPSILON: f64 = Real::EPSILON as f64;

fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x as Real, y as Real)
}

fn rubber() -> LinearElastic {
    LinearElastic::plane_stress(1e6, 0.3)
        .density(1000.0)
        .rayleigh(2e-2)
}

/// A square of 1 m and 1000 kg.
fn square() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber())
}

/// A beam of 4 m from `x = -2 m`, held at both lower corners, its top at `y = 1.3 m`.
fn beam() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([4.0, 0.3], [24, 2])
        .material(
            LinearElastic::plane_stress(1e9, 0.3)
                .density(1000.0)
                .rayleigh(1e-2),
        )
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
        .translation([-2.0, 1.0])
}

#[derive(Default)]
struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
}

impl Scene {
    fn with_floor() -> Self {
        let mut scene = Self::default();
        let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(vector(0.0, -0.5));
        scene.world.insert_collider(floor, None);
        scene
    }

    fn without_gravity() -> Self {
        let mut scene = Self::default();
        scene.world.gravity = Vector::ZERO;
        scene
    }

    fn insert(&mut self, builder: FlexBodyBuilder) -> Result<FlexBodyHandle, BuildError> {
        self.flex_bodies.insert(builder, &mut self.world)
    }

    fn insert_box(&mut self, half: f64, at: [f64; 2], density: f64) -> RigidBodyHandle {
        let body = RigidBodyBuilder::dynamic().translation(vector(at[0], at[1]));
        let shape = ColliderBuilder::cuboid(half as Real, half as Real).density(density as Real);
        self.world.insert(body, shape).0
    }

    fn step(&mut self) -> Result<&StepReport, StepError> {
        self.flex.step(&mut self.world, &mut self.flex_bodies)
    }

    fn steps(&mut self, n: usize) -> Result<(), StepError> {
        for _ in 0..n {
            self.step()?;
        }
        Ok(())
    }

    fn dt(&self) -> f64 {
        f64::from(self.world.integration_parameters.dt)
    }

    fn set_dt(&mut self, dt: f64) {
        self.world.integration_parameters.dt = dt as Real;
    }

    fn height(&self, handle: RigidBodyHandle) -> f64 {
        f64::from(self.world.bodies[handle].translation().y)
    }

    /// All bits of the motion of all bodies.
    fn bits(&self) -> Vec<u64> {
        let mut bits = Vec::new();
        for (_, body) in self.flex_bodies.iter() {
            let all = body.positions().iter().chain(body.velocities());
            bits.extend(all.map(|x| x.to_bits()));
        }
        for (_, body) in self.world.rigid_bodies() {
            let (at, turn) = (body.translation(), body.rotation());
            let (linvel, angvel) = (body.linvel(), body.angvel());
            let motion: [Real; 7] = [at.x, at.y, turn.re, turn.im, linvel.x, linvel.y, angvel];
            bits.extend(motion.map(|x| f64::from(x).to_bits()));
        }
        bits
    }

    /// What a ray straight down from `y = 20 m` hits, and at which height.
    fn look_down(&self, x: f64) -> Option<(ColliderHandle, f64)> {
        let ray = Ray::new(vector(x, 20.0), vector(0.0, -1.0));
        let hit = self
            .world
            .cast_ray(&ray, 100.0, true, QueryFilter::default())?;
        Some((hit.0, 20.0 - f64::from(hit.1)))
    }
}

mod time {
    use super::*;

    #[test]
    fn a_step_of_no_length_moves_nothing_and_the_next_one_goes_on() -> Outcome {
        let mut scene = Scene::with_floor();
        let block = scene.insert(square().translation([0.0, 5.0]))?;
        let crate_body = scene.insert_box(0.3, [3.0, 5.0], 100.0);
        let dt = scene.dt();
        scene.set_dt(0.0);
        scene.steps(3)?;
        scene.set_dt(dt);
        for _ in 0..30 {
            scene.step()?;
            let before = scene.bits();
            scene.set_dt(0.0);
            let report = scene.step()?;
            assert!(report.contacts().is_empty());
            assert_eq!(before, scene.bits());
            scene.set_dt(dt);
        }
        // The trapezoidal rule is exact for constant acceleration; rapier's rule, with its substeps, is of first order.
        let t = 30.0 * dt;
        let fallen = 5.5 - scene.flex_bodies[block].centre_of_mass()[1];
        assert!((fallen - 0.5 * GRAVITY * t * t).abs() < 1e-5, "{fallen} m");
        let fallen = 5.0 - scene.height(crate_body);
        assert!((fallen - 0.5 * GRAVITY * t * t).abs() < GRAVITY * t * dt);
        Ok(())
    }

    #[test]
    fn queries_work_after_a_step_of_no_length() -> Outcome {
        let mut scene = Scene::with_floor();
        let block = scene.insert(square().translation([0.0, 0.001]))?;
        scene.steps(10)?;
        let ball = ColliderBuilder::ball(0.5).translation(vector(4.0, 3.0));
        let ball = scene.world.insert_collider(ball, None);
        scene.set_dt(0.0);
        scene.step()?;
        let surface = scene.flex_bodies[block].collider_handle();
        assert_eq!(scene.look_down(0.4).map(|hit| hit.0), Some(surface));
        assert_eq!(scene.look_down(4.0).map(|hit| hit.0), Some(ball));
        Ok(())
    }

    #[test]
    fn every_new_step_length_costs_one_factorization_a_body_and_none_after_it() -> Outcome {
        let mut scene = Scene::with_floor();
        scene.insert(square().translation([0.0, 0.001]))?;
        scene.insert(square().translation([3.0, 0.001]))?;
        for (index, dt) in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 1000.0, 1.0 / 30.0]
            .into_iter()
            .enumerate()
        {
            scene.set_dt(dt);
            let counts: Vec<u64> = (0..20)
                .map(|_| Ok(scene.step()?.n_factorizations()))
                .collect::<Result<_, StepError>>()?;
            assert_eq!(counts[0], 2, "step length {index}");
            assert!(counts[1..].iter().all(|&count| count == 0), "{counts:?}");
        }
        // A step of no length between two others needs no factor and spoils none.
        let dt = scene.dt();
        scene.set_dt(0.0);
        assert_eq!(scene.step()?.n_factorizations(), 0);
        scene.set_dt(dt);
        assert_eq!(scene.step()?.n_factorizations(), 0);
        Ok(())
    }

    #[test]
    fn one_factorization_serves_for_ever_in_contact_and_in_rotation() -> Outcome {
        let mut scene = Scene::with_floor();
        scene.insert(square().translation([0.0, 0.5]))?;
        scene.insert(square().translation([5.0, 30.0]).angvel(4.0))?;
        scene.insert(beam().translation([10.0, 1.0]))?;
        let mut total = 0;
        for _ in 0..120 {
            total += scene.step()?.n_factorizations();
        }
        assert_eq!(total, 3);
        Ok(())
    }

    #[test]
    fn a_changing_step_length_keeps_a_resting_block_at_rest_under_its_weight() -> Outcome {
        let mut scene = Scene::with_floor();
        let block = scene.insert(square().translation([0.0, 0.001]))?;
        scene.steps(240)?;
        let weight = GRAVITY * scene.flex_bodies[block].mass();
        let height = scene.flex_bodies[block].centre_of_mass()[1];
        for step in 0..200 {
            scene.set_dt([1.0 / 60.0, 1.0 / 240.0, 1.0 / 30.0, 1.0 / 100.0][step % 4]);
            scene.step()?;
            let body = &scene.flex_bodies[block];
            let force = body.total_contact_force()[1];
            // At rest no inertia depends on the step: what is left is what 4 s of damping left of the fall.
            assert!(
                (force / weight - 1.0).abs() < 1e-3,
                "step {step}: {force} N"
            );
            assert!((body.centre_of_mass()[1] - height).abs() < 1e-6);
        }
        Ok(())
    }

    #[test]
    fn the_split_form_steps_as_the_world_does() -> Outcome {
        let scene = || -> Result<Scene, BuildError> {
            let mut scene = Scene::with_floor();
            scene.insert(beam())?;
            scene.insert(square().translation([0.1, 2.5]).rotation(0.4))?;
            scene.insert_box(0.2, [-1.0, 1.6], 500.0);
            scene.insert_box(0.2, [6.0, 0.6], 500.0);
            Ok(scene)
        };
        let (mut whole, mut split) = (scene()?, scene()?);
        for step in 0..90 {
            let expected = whole.step()?.clone();
            let world = &mut split.world;
            let sets = RapierSets {
                physics_pipeline: &mut world.physics_pipeline,
                gravity: world.gravity,
                integration_parameters: &world.integration_parameters,
                islands: &mut world.islands,
                broad_phase: &mut world.broad_phase,
                narrow_phase: &mut world.narrow_phase,
                bodies: &mut world.bodies,
                colliders: &mut world.colliders,
                impulse_joints: &mut world.impulse_joints,
                multibody_joints: &mut world.multibody_joints,
                soft_bodies: &mut world.soft_bodies,
                ccd_solver: &mut world.ccd_solver,
                hooks: &(),
                events: &(),
            };
            let report = split.flex.step_sets(sets, &mut split.flex_bodies)?;
            assert_eq!(expected.contacts().len(), report.contacts().len());
            assert_eq!(expected.energy(), report.energy());
            assert_eq!(whole.bits(), split.bits(), "step {step}");
        }
        Ok(())
    }
}

mod coming_and_going {
    use super::*;

    #[test]
    fn bodies_come_and_go_at_run_time_and_their_handles_go_stale() -> Outcome {
        let mut scene = Scene::with_floor();
        let first = scene.insert(square().translation([0.0, 0.001]))?;
        scene.steps(60)?;
        let second = scene.insert(square().translation([0.0, 1.05]))?;
        assert_eq!(scene.flex_bodies.len(), 2);
        scene.steps(120)?;
        let [low, high] = [first, second].map(|body| scene.flex_bodies[body].centre_of_mass()[1]);
        assert!(high - low > 0.9, "the second rests on the first");
        let (n_bodies, n_colliders) = (scene.world.bodies.len(), scene.world.colliders.len());
        let carrier = scene.flex_bodies[first].rigid_body_handle();
        let surface = scene.flex_bodies[first].collider_handle();
        let body = scene.flex_bodies.remove(first, &mut scene.world)?;
        assert!((body.mass() - 1000.0).abs() < 1e-9, "it is handed out");
        assert!(!scene.world.bodies.contains(carrier));
        assert!(!scene.world.colliders.contains(surface));
        assert_eq!(scene.world.bodies.len(), n_bodies - 1);
        assert_eq!(scene.world.colliders.len(), n_colliders - 1);
        assert_eq!(
            scene.flex_bodies.try_get(first).err(),
            Some(FlexBodyError::Stale(first))
        );
        assert_eq!(scene.flex_bodies.len(), 1);
        // The second falls onto the floor and carries nothing but itself.
        scene.steps(240)?;
        let body = &scene.flex_bodies[second];
        assert!((body.centre_of_mass()[1] - 0.5).abs() < 0.02);
        let force = body.total_contact_force()[1];
        assert!((force / (GRAVITY * 1000.0) - 1.0).abs() < 1e-3, "{force} N");
        // A new body takes the vacant slot, with another handle and none of the old contacts.
        let third = scene.insert(square().translation([5.0, 3.0]))?;
        assert_eq!(third.into_raw_parts().0, first.into_raw_parts().0);
        assert_ne!(third, first);
        scene.step()?;
        assert_eq!(scene.flex_bodies[third].total_contact_force(), [0.0; 2]);
        Ok(())
    }

    #[test]
    fn removing_a_rigid_body_in_contact_frees_the_beam_under_it() -> Outcome {
        let mut scene = Scene::default();
        let beam = scene.insert(beam())?;
        scene.steps(240)?;
        let own = scene.flex_bodies[beam].position(12)[1];
        let crate_body = scene.insert_box(0.25, [0.0, 1.55], 1000.0);
        scene.steps(360)?;
        assert_eq!(scene.flex.report().n_claimed(), 1);
        let loaded = scene.flex_bodies[beam].position(12)[1];
        assert!(
            loaded < own - 1e-4,
            "{loaded} m under load, {own} m without"
        );
        scene.world.remove_body(crate_body);
        scene.step()?;
        assert_eq!(scene.flex.report().n_claimed(), 0);
        assert!(scene.flex.report().contacts().is_empty());
        scene.steps(480)?;
        let freed = scene.flex_bodies[beam].position(12)[1];
        assert!((freed - own).abs() < 1e-6, "{freed} m, was {own} m");
        Ok(())
    }

    #[test]
    fn a_box_in_contact_may_change_its_shape_or_lose_its_collider() -> Outcome {
        let mut scene = Scene::default();
        scene.insert(beam())?;
        let crate_body = scene.insert_box(0.25, [0.0, 1.551], 300.0);
        // Mass of its own, so that it falls without a collider too.
        scene.world.bodies[crate_body].set_additional_mass(50.0, true);
        scene.steps(60)?;
        let collider = scene.world.bodies[crate_body].colliders()[0];
        let twelve: Vec<Vector> = (0..12)
            .map(|corner| {
                let (sin, cos) = (0.3 + f64::from(corner) * 0.5236).sin_cos();
                vector(0.25 * cos, 0.25 * sin)
            })
            .collect();
        let shapes = [
            SharedShape::convex_hull(&twelve).ok_or("a dodecagon")?,
            SharedShape::triangle(vector(-0.25, -0.25), vector(0.25, -0.25), vector(0.0, 0.2)),
            SharedShape::ball(0.25),
            SharedShape::capsule_x(0.1, 0.2),
            SharedShape::round_cuboid(0.2, 0.2, 0.05),
        ];
        for shape in shapes {
            scene.world.colliders[collider].set_shape(shape);
            for _ in 0..30 {
                scene.step()?;
                assert!(scene.height(crate_body).is_finite());
            }
            assert!(scene.height(crate_body) > 1.2, "the beam still carries it");
        }
        scene.world.remove_collider(collider);
        scene.steps(120)?;
        assert!(scene.height(crate_body) < 1.0, "nothing holds it any more");
        Ok(())
    }

    #[test]
    fn sleeping_boxes_wake_when_a_flexible_body_touches_them_and_not_before() -> Outcome {
        let mut scene = Scene::with_floor();
        let crates = [0.5, 3.0].map(|x| scene.insert_box(0.25, [x, 0.25], 500.0));
        scene.steps(300)?;
        let sleeps = |scene: &Scene| crates.map(|handle| scene.world.bodies[handle].is_sleeping());
        assert_eq!(sleeps(&scene), [true, true]);
        // One metre of fall takes 0.45 s.
        let block = scene.insert(square().translation([0.05, 1.5]))?;
        scene.steps(12)?;
        assert_eq!(sleeps(&scene), [true, true], "nothing touches them yet");
        scene.steps(48)?;
        assert_eq!(sleeps(&scene), [false, true]);
        scene.steps(240)?;
        // The block rests on the box and on nothing else, or fell beside it: the box bears what it bears.
        let bottom = scene.flex_bodies[block]
            .positions()
            .chunks_exact(2)
            .map(|at| at[1])
            .fold(f64::INFINITY, f64::min);
        assert!(bottom > -1e-6, "{bottom} m");
        Ok(())
    }
}

mod rapier_features {
    use super::*;

    #[derive(Default)]
    struct Listener {
        events: Mutex<Vec<CollisionEvent>>,
    }

    impl EventHandler for Listener {
        fn handle_collision_event(
            &self,
            _: &RigidBodySet,
            _: &ColliderSet,
            event: CollisionEvent,
            _: Option<&ContactPair>,
        ) {
            if let Ok(mut events) = self.events.lock() {
                events.push(event);
            }
        }

        fn handle_contact_force_event(
            &self,
            _: Real,
            _: &RigidBodySet,
            _: &ColliderSet,
            _: &ContactPair,
            _: Real,
        ) {
        }

        fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
    }

    impl Listener {
        fn count(&self, started: bool) -> usize {
            let events = self.events.lock().expect("no handler panicked");
            events
                .iter()
                .filter(|event| event.started() == started)
                .count()
        }
    }

    #[test]
    fn a_block_that_lands_starts_a_collision_and_none_starts_or_stops_while_it_rests() -> Outcome {
        let mut scene = Scene::with_floor();
        let block = scene.insert(
            square()
                .active_events(ActiveEvents::COLLISION_EVENTS)
                .translation([0.0, 0.2]),
        )?;
        let listener = Listener::default();
        let mut landed_at = None;
        let mut counts = Vec::new();
        for step in 0..480 {
            scene.flex.step_with_events(
                &mut scene.world,
                &mut scene.flex_bodies,
                &(),
                &listener,
            )?;
            let touches = !scene.flex.report().contacts().is_empty();
            landed_at = landed_at.or(touches.then_some(step));
            counts.push((listener.count(true), listener.count(false)));
        }
        // 0.2 m of fall take 12.1 steps; rapier starts a collision when its detection sees it coming.
        let landed_at = landed_at.ok_or("the block lands")?;
        assert!((11..15).contains(&landed_at), "{landed_at}");
        assert_eq!(counts[landed_at - 2], (0, 0));
        assert_eq!(counts[landed_at], (1, 0));
        // It may bounce; whatever starts stops, but for the last, and in the last four seconds it rests.
        let (started, stopped) = counts[479];
        assert_eq!(started, stopped + 1);
        assert_eq!(counts[240], counts[479]);
        let floor = scene
            .world
            .all_colliders()
            .find(|(_, collider)| collider.parent().is_none())
            .map(|(handle, _)| handle);
        let surface = scene.flex_bodies[block].collider_handle();
        let events = listener.events.lock().map_err(|_| "a handler panicked")?;
        let pair = [events[0].collider1(), events[0].collider2()];
        assert!(pair.contains(&surface) && pair.contains(&floor.ok_or("the floor")?));
        drop(events);
        // Taken away while it touches, it stops the collision.
        scene.flex_bodies.remove(block, &mut scene.world)?;
        scene
            .flex
            .step_with_events(&mut scene.world, &mut scene.flex_bodies, &(), &listener)?;
        assert_eq!(
            (listener.count(true), listener.count(false)),
            (started, started)
        );
        Ok(())
    }

    #[test]
    fn a_sensor_feels_a_flexible_body_and_does_not_push_it() -> Outcome {
        let mut scene = Scene::default();
        let block = scene.insert(square().translation([0.0, 2.0]))?;
        let sensor = ColliderBuilder::cuboid(5.0, 0.2)
            .sensor(true)
            .active_events(ActiveEvents::COLLISION_EVENTS);
        scene.world.insert_collider(sensor, None);
        let listener = Listener::default();
        for _ in 0..60 {
            scene.flex.step_with_events(
                &mut scene.world,
                &mut scene.flex_bodies,
                &(),
                &listener,
            )?;
        }
        let t = 60.0 * scene.dt();
        let fallen = 2.5 - scene.flex_bodies[block].centre_of_mass()[1];
        assert!((fallen - 0.5 * GRAVITY * t * t).abs() < 1e-5, "{fallen} m");
        assert_eq!((listener.count(true), listener.count(false)), (1, 1));
        Ok(())
    }

    fn group(own: Group, others: Group) -> InteractionGroups {
        InteractionGroups::new(own, others, InteractionTestMode::And)
    }

    #[test]
    fn collision_groups_let_bodies_pass_that_must_not_meet() -> Outcome {
        let mut scene = Scene::default();
        let floor = ColliderBuilder::cuboid(50.0, 0.5)
            .translation(vector(0.0, -0.5))
            .collision_groups(group(Group::GROUP_1, Group::GROUP_1));
        scene.world.insert_collider(floor, None);
        let one = group(Group::GROUP_1, Group::ALL);
        let two = group(Group::GROUP_2, Group::ALL);
        let held = scene.insert(square().collision_groups(one).translation([0.0, 0.3]))?;
        let passing = scene.insert(square().collision_groups(two).translation([3.0, 0.3]))?;
        // At rest on the floor at first, then the groups of the floor's partner forbid it from the start.
        let touching = scene.insert(square().collision_groups(two).translation([6.0, 0.0]))?;
        scene.steps(60)?;
        let y = |handle| scene.flex_bodies[handle].centre_of_mass()[1];
        assert!((y(held) - 0.5).abs() < 0.1, "{}", y(held));
        let t = 60.0 * scene.dt();
        let free = 0.5 * GRAVITY * t * t;
        assert!((y(passing) - (0.8 - free)).abs() < 1e-5, "{}", y(passing));
        assert!((y(touching) - (0.5 - free)).abs() < 1e-5, "{}", y(touching));
        Ok(())
    }

    #[test]
    fn rigid_bodies_of_one_claim_keep_their_collision_groups() -> Outcome {
        // Two boxes on a beam overlap in the air above it: of different groups, each sinks to the beam.
        let mut scene = Scene::default();
        scene.insert(beam())?;
        let boxes = [Group::GROUP_1, Group::GROUP_2].map(|own| {
            let body = RigidBodyBuilder::dynamic().translation(vector(0.0, 1.501));
            let shape = ColliderBuilder::cuboid(0.2, 0.2)
                .density(300.0)
                .collision_groups(group(own, Group::ALL ^ (Group::GROUP_1 | Group::GROUP_2)));
            scene.world.insert(body, shape).0
        });
        scene.steps(120)?;
        assert_eq!(scene.flex.report().n_claimed(), 2);
        let between_boxes = scene.flex.report().contacts().iter().any(|contact| {
            let is_rigid = |one| matches!(one, Participant::Rigid(_));
            is_rigid(contact.contactor) && is_rigid(contact.target)
        });
        assert!(!between_boxes);
        let [a, b] = boxes.map(|handle| scene.world.bodies[handle].translation());
        assert!((a - b).length() < 1e-3, "{a} and {b}");
        Ok(())
    }

    /// Lets contacts of one collider through, or none.
    struct Ghost(ColliderHandle);

    impl PhysicsHooks for Ghost {
        fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
            let is_ghost = context.collider1 == self.0 || context.collider2 == self.0;
            (!is_ghost).then_some(SolverFlags::default())
        }
    }

    #[test]
    fn the_users_hook_lets_a_box_fall_through_a_beam() -> Outcome {
        let mut scene = Scene::default();
        scene.insert(beam())?;
        let drop_at = |scene: &mut Scene, x: f64| {
            let body = RigidBodyBuilder::dynamic().translation(vector(x, 2.0));
            let shape = ColliderBuilder::cuboid(0.2, 0.2)
                .density(300.0)
                .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
            scene.world.insert(body, shape)
        };
        let (ghost, ghost_shape) = drop_at(&mut scene, -0.5);
        let (solid, _) = drop_at(&mut scene, 0.5);
        let hooks = Ghost(ghost_shape);
        for _ in 0..60 {
            scene
                .flex
                .step_with_events(&mut scene.world, &mut scene.flex_bodies, &hooks, &())?;
        }
        assert!(scene.height(solid) > 1.3, "{}", scene.height(solid));
        assert!(scene.height(ghost) < 0.0, "{}", scene.height(ghost));
        Ok(())
    }

    #[test]
    fn a_joint_without_contacts_between_its_bodies_keeps_them_apart_from_the_solver() -> Outcome {
        let mut scene = Scene::default();
        scene.insert(beam())?;
        let boxes = [-0.1, 0.1].map(|x| scene.insert_box(0.2, [x, 1.501], 300.0));
        let joint = SpringJointBuilder::new(0.2, 10.0, 1.0).contacts_enabled(false);
        scene.world.insert_impulse_joint(boxes[0], boxes[1], joint);
        scene.steps(60)?;
        let between_boxes = scene.flex.report().contacts().iter().any(|contact| {
            let is_rigid = |one| matches!(one, Participant::Rigid(_));
            is_rigid(contact.contactor) && is_rigid(contact.target)
        });
        assert!(
            !between_boxes,
            "the joint forbids contacts between its bodies"
        );
        Ok(())
    }

    #[test]
    fn a_disabled_rigid_body_is_not_there() -> Outcome {
        let mut scene = Scene::default();
        let block = scene.insert(square().translation([-0.5, 2.0]))?;
        let shelf = RigidBodyBuilder::dynamic()
            .translation(vector(0.0, 0.5))
            .gravity_scale(0.0)
            .enabled(false);
        let (shelf, _) = scene.world.insert(shelf, ColliderBuilder::cuboid(1.0, 0.2));
        let gone = ColliderBuilder::cuboid(1.0, 0.2).enabled(false);
        scene.world.insert_collider(gone, None);
        scene.steps(60)?;
        let t = 60.0 * scene.dt();
        let fallen = 2.5 - scene.flex_bodies[block].centre_of_mass()[1];
        assert!((fallen - 0.5 * GRAVITY * t * t).abs() < 1e-5, "{fallen} m");
        assert_eq!(scene.height(shelf), 0.5);
        Ok(())
    }

    fn middle(body: &FlexBody, nodes: [usize; 2]) -> (f64, f64) {
        let [a, b] = nodes.map(|node| body.position(node));
        (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
    }

    #[test]
    fn a_ray_hits_the_deformed_surface_right_after_the_step() -> Outcome {
        let mut scene = Scene::default();
        let beam = scene.insert(beam())?;
        let block = scene.insert(square().translation([6.0, 10.0]).linvel([3.0, 0.0]))?;
        let mut lowest = f64::INFINITY;
        for step in 0..60 {
            scene.step()?;
            // Between the nodes at the middle of the top edge: 62 of 3 rows of 25, and the next.
            let body = &scene.flex_bodies[beam];
            let (x, y) = middle(body, [62, 63]);
            let hit = scene.look_down(x).ok_or("the beam is under the ray")?;
            assert_eq!(hit.0, body.collider_handle(), "step {step}");
            // The ray starts 20 m above: rounding of that length.
            let tolerance = 8.0 * 20.0 * REAL_EPSILON;
            assert!(
                (hit.1 - y).abs() <= tolerance,
                "step {step}: {} not {y}",
                hit.1
            );
            lowest = lowest.min(y);
            let falling = &scene.flex_bodies[block];
            let (x, y) = middle(falling, [22, 23]);
            let hit = scene.look_down(x).ok_or("the block is under the ray")?;
            assert_eq!(hit.0, falling.collider_handle(), "step {step}");
            assert!(
                (hit.1 - y).abs() <= tolerance,
                "step {step}: {} not {y}",
                hit.1
            );
        }
        assert!(lowest < 1.3 - 1e-3, "the beam sags: {lowest} m");
        Ok(())
    }

    #[test]
    fn a_moving_platform_carries_a_flexible_block_with_it() -> Outcome {
        for is_position_based in [false, true] {
            let mut scene = Scene::default();
            let platform = if is_position_based {
                RigidBodyBuilder::kinematic_position_based()
            } else {
                RigidBodyBuilder::kinematic_velocity_based()
            };
            let shape = ColliderBuilder::cuboid(3.0, 0.25).friction(1.0);
            let (platform, _) = scene.world.insert(platform, shape);
            let block = scene.insert(square().friction(1.0).translation([-0.5, 0.251]))?;
            scene.steps(120)?;
            let start = scene.flex_bodies[block].centre_of_mass();
            let (mut x, mut y) = (0.0, 0.0);
            for step in 0..120 {
                let speed = [0.5, 0.3].map(|v: f64| v * (f64::from(step) / 60.0).min(1.0));
                x += speed[0] * scene.dt();
                y += speed[1] * scene.dt();
                let body = &mut scene.world.bodies[platform];
                if is_position_based {
                    body.set_next_kinematic_translation(vector(x, y));
                } else {
                    body.set_linvel(vector(speed[0], speed[1]), true);
                }
                scene.step()?;
            }
            let at = scene.world.bodies[platform].translation();
            assert!((f64::from(at.x) - x).abs() < 1e-4 && (f64::from(at.y) - y).abs() < 1e-4);
            let end = scene.flex_bodies[block].centre_of_mass();
            // It sticks: 0.5 m/s² is far below μg; it sways by its own shear, 0.5 m/s² × ρ/G of 1 mm.
            assert!(
                (end[0] - start[0] - x).abs() < 5e-3,
                "{} not {x}",
                end[0] - start[0]
            );
            assert!(
                (end[1] - start[1] - y).abs() < 5e-3,
                "{} not {y}",
                end[1] - start[1]
            );
        }
        Ok(())
    }

    #[test]
    fn a_fast_rigid_ball_does_not_pass_through_a_thin_beam() -> Outcome {
        for speed in [20.0, 60.0, 200.0] {
            let mut scene = Scene::without_gravity();
            scene.insert(beam())?;
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(0.0, 6.0))
                .linvel(vector(0.0, -speed));
            let (ball, _) = scene
                .world
                .insert(body, ColliderBuilder::ball(0.1).density(10.0));
            scene.steps(60)?;
            let y = scene.height(ball);
            assert!(y > 1.0, "at {speed} m/s the ball ends at {y} m");
        }
        Ok(())
    }

    #[test]
    fn a_ball_teleported_near_a_beam_at_high_speed_does_not_pass_through_it() -> Outcome {
        let mut scene = Scene::without_gravity();
        scene.insert(beam())?;
        let body = RigidBodyBuilder::dynamic().translation(vector(30.0, 30.0));
        let (ball, _) = scene
            .world
            .insert(body, ColliderBuilder::ball(0.1).density(10.0));
        scene.steps(5)?;
        scene.world.bodies[ball].set_translation(vector(0.0, 2.3), true);
        scene.world.bodies[ball].set_linvel(vector(0.0, -120.0), true);
        scene.steps(10)?;
        assert!(scene.height(ball) > 1.0, "{}", scene.height(ball));
        Ok(())
    }

    #[test]
    fn a_fast_flexible_body_meets_another_whichever_was_inserted_first() -> Outcome {
        for plate_first in [true, false] {
            let mut scene = Scene::without_gravity();
            let plate = || {
                FlexBodyBuilder::rectangle([4.0, 0.2], [16, 2])
                    .material(rubber())
                    .pin_where(|[x, _]| x == 0.0 || x == 4.0, Pin::both())
                    .translation([-2.0, 0.0])
            };
            let bullet = || {
                FlexBodyBuilder::rectangle([0.2, 0.2], [2, 2])
                    .material(rubber())
                    .translation([-0.1, 1.5])
                    .linvel([0.0, -80.0])
            };
            let bullet = if plate_first {
                scene.insert(plate())?;
                scene.insert(bullet())?
            } else {
                let bullet = scene.insert(bullet())?;
                scene.insert(plate())?;
                bullet
            };
            let mut met = false;
            for _ in 0..5 {
                met |= !scene.step()?.contacts().is_empty();
            }
            let y = scene.flex_bodies[bullet].centre_of_mass()[1];
            assert!(met, "plate first: {plate_first}: the bullet ends at {y} m");
        }
        Ok(())
    }
}

mod loads {
    use super::*;

    /// A cantilever of 2 m × 0.4 m × 0.1 m along x, clamped at `x = 0`, 80 kg.
    fn cantilever() -> FlexBodyBuilder {
        FlexBodyBuilder::rectangle([2.0, 0.4], [16, 4])
            .material(
                LinearElastic::plane_stress(1e7, 0.3)
                    .density(1000.0)
                    .rayleigh(2e-2),
            )
            .thickness(0.1)
            .pin_where(|[x, _]| x == 0.0, Pin::both())
    }

    #[test]
    fn supports_of_a_clamped_beam_carry_its_weight_and_its_moment() -> Outcome {
        let mut scene = Scene::default();
        let beam = scene.insert(cantilever())?;
        scene.steps(1200)?;
        let body = &scene.flex_bodies[beam];
        let weight = GRAVITY * body.mass();
        assert!((body.mass() - 80.0).abs() < 1e-9);
        let [x, y] = body.total_reaction();
        // At rest only what 20 s of damping left; gravity is rapier's 9.81, rounded.
        let tolerance = 1e-6 * weight;
        assert!(
            x.abs() < tolerance && (y - weight).abs() < tolerance,
            "{x} {y}"
        );
        // The moment balances the weight at the deformed centre of mass.
        let moment = body.reaction_moment([0.0, 0.0]);
        let expected = weight * body.centre_of_mass()[0];
        assert!(
            (moment - expected).abs() < tolerance,
            "{moment} not {expected}"
        );
        assert!((expected / weight - 1.0).abs() < 0.01);
        assert!(body.total_contact_force() == [0.0; 2]);
        Ok(())
    }

    #[test]
    fn a_tip_force_adds_itself_and_its_lever_to_the_supports() -> Outcome {
        let mut scene = Scene::without_gravity();
        let beam = scene.insert(cantilever())?;
        // Node 16 is the lower right corner.
        let tip = 16;
        scene.flex_bodies[beam].set_nodal_force(tip, [30.0, -50.0])?;
        scene.steps(1200)?;
        let body = &scene.flex_bodies[beam];
        let [x, y] = body.total_reaction();
        assert!(
            (x + 30.0).abs() < 1e-4 && (y - 50.0).abs() < 1e-4,
            "{x} {y}"
        );
        // The clamped body's theory is of first order: equilibrium holds where it was built.
        let moment = body.reaction_moment([0.0, 0.0]);
        assert!((moment - 100.0).abs() < 1e-4, "{moment} N m");
        // Timoshenko: F L³/3EI + F L/κGA down, and M L²/2EI up, for the pull acts 0.2 m below the axis.
        let deflection = body.displacement(tip)[1];
        let (bending, shear) = (1e7 * 0.1 * 0.4f64.powi(3) / 12.0, 1e7 / 2.6 * 0.04 / 1.2);
        let down = 50.0 * (8.0 / (3.0 * bending) + 2.0 / shear);
        let up = 30.0 * 0.2 * 4.0 / (2.0 * bending);
        assert!(
            (deflection / (up - down) - 1.0).abs() < 0.02,
            "{deflection} not {}",
            up - down
        );
        // Setting the force again replaces it.
        scene.flex_bodies[beam].set_nodal_force(tip, [0.0, 0.0])?;
        scene.steps(1200)?;
        let body = &scene.flex_bodies[beam];
        assert!(body.displacement(tip)[1].abs() < 1e-6);
        assert!(body.total_reaction()[1].abs() < 1e-4);
        Ok(())
    }

    #[test]
    fn nodal_forces_of_the_builder_add_up_and_accelerate_a_free_body() -> Outcome {
        let mut scene = Scene::without_gravity();
        let pushed = scene.insert(
            square()
                .nodal_force(0, [100.0, 0.0])
                .nodal_force(0, [50.0, 0.0])
                .nodal_force(20, [150.0, 0.0]),
        )?;
        let t = {
            scene.steps(60)?;
            60.0 * scene.dt()
        };
        let body = &scene.flex_bodies[pushed];
        // Opposite corners of one side: no torque, a = 300 N / 1000 kg, to the round-off of 60 steps.
        let [vx, vy] = body.linvel();
        assert!((vx - 0.3 * t).abs() < 1e-9 && vy.abs() < 1e-9, "{vx} {vy}");
        let [x, _] = body.centre_of_mass();
        assert!((x - 0.5 - 0.15 * t * t).abs() < 1e-9, "{x}");
        assert!(body.angle().abs() < 1e-6, "{}", body.angle());
        Ok(())
    }

    #[test]
    fn gravity_scale_and_body_force_accelerate_by_what_they_say() -> Outcome {
        let mut scene = Scene::default();
        let cases = [
            (scene.insert(square())?, -1.0),
            (
                scene.insert(square().translation([3.0, 0.0]).gravity_scale(0.0))?,
                0.0,
            ),
            (
                scene.insert(square().translation([6.0, 0.0]).gravity_scale(0.5))?,
                -0.5,
            ),
            (
                scene.insert(square().translation([9.0, 0.0]).gravity_scale(-2.0))?,
                2.0,
            ),
            (
                scene.insert(
                    square()
                        .translation([12.0, 0.0])
                        .body_force([0.0, 2.0 * 9.81]),
                )?,
                1.0,
            ),
        ];
        let late = scene.insert(square().translation([15.0, 0.0]))?;
        scene.flex_bodies[late].set_gravity_scale(0.0)?;
        scene.flex_bodies[late].set_body_force([9.81, 0.0])?;
        scene.steps(60)?;
        let t = 60.0 * scene.dt();
        for (handle, factor) in cases {
            let y = scene.flex_bodies[handle].centre_of_mass()[1] - 0.5;
            // Rapier's gravity is rounded: 9.81 in f32 is off by 3e-8.
            let expected = 0.5 * factor * GRAVITY * t * t;
            assert!((y - expected).abs() < 1e-5, "{factor}: {y} not {expected}");
        }
        let [x, y] = scene.flex_bodies[late].centre_of_mass();
        assert!((x - 15.5 - 0.5 * GRAVITY * t * t).abs() < 1e-9 && (y - 0.5).abs() < 1e-12);
        Ok(())
    }

    #[test]
    fn velocities_set_at_run_time_move_the_body_as_they_say() -> Outcome {
        let mut scene = Scene::without_gravity();
        let body = scene.insert(square())?;
        scene.steps(5)?;
        // A translation of (2, -1) m/s and a spin of 0.5 rad/s about the centre.
        let velocities: Vec<f64> = scene.flex_bodies[body]
            .positions()
            .chunks_exact(2)
            .flat_map(|at| [2.0 - 0.5 * (at[1] - 0.5), -1.0 + 0.5 * (at[0] - 0.5)])
            .collect();
        scene.flex_bodies[body].set_velocities(&velocities)?;
        assert_eq!(scene.flex_bodies[body].velocities(), &velocities[..]);
        scene.steps(60)?;
        let t = 60.0 * scene.dt();
        let moved = &scene.flex_bodies[body];
        let [x, y] = moved.centre_of_mass();
        assert!((x - 0.5 - 2.0 * t).abs() < 1e-9 && (y - 0.5 + t).abs() < 1e-9);
        // The spin stretches the square by ρω²L²/E of 1e-4; angular momentum holds it to that.
        assert!(
            (moved.angle() - 0.5 * t).abs() < 2e-4 * t,
            "{}",
            moved.angle()
        );
        // Pinned directions stay at rest.
        let held = scene.insert(cantilever().translation([10.0, 0.0]))?;
        let n = 2 * scene.flex_bodies[held].n_nodes();
        scene.flex_bodies[held].set_velocities(&vec![1.0; n])?;
        assert_eq!(scene.flex_bodies[held].velocity(0), [0.0; 2]);
        assert_eq!(scene.flex_bodies[held].velocity(16), [1.0; 2]);
        scene.step()?;
        assert_eq!(scene.flex_bodies[held].displacement(0), [0.0; 2]);
        Ok(())
    }

    #[test]
    fn a_prescribed_displacement_stretches_a_bar_by_hookes_law() -> Outcome {
        let mut scene = Scene::without_gravity();
        // ν = 0, so that clamped ends do not disturb the uniform strain.
        let (young, length, area) = (1e6, 2.0, 0.02);
        let bar = scene.insert(
            FlexBodyBuilder::rectangle([length, 0.2], [10, 2])
                .material(
                    LinearElastic::plane_stress(young, 0.0)
                        .density(1000.0)
                        .rayleigh(2e-2),
                )
                .thickness(0.1)
                .pin_where(|[x, _]| x == 0.0, Pin::both())
                .pin_where(|[x, _]| x == 2.0, Pin::x()),
        )?;
        let pulled: Vec<usize> = [10, 21, 32].to_vec();
        let stretch = 0.01;
        for step in 1..=60 {
            let now = stretch * f64::from(step) / 60.0;
            for &node in &pulled {
                // The y direction is not pinned there: its value is ignored.
                scene.flex_bodies[bar].set_pin_displacement(node, [now, 77.0])?;
            }
            scene.step()?;
            let body = &scene.flex_bodies[bar];
            for &node in &pulled {
                let [x, y] = body.displacement(node);
                assert!((x - now).abs() < 1e-14 && y.abs() < 1e-3, "{x} {y}");
            }
        }
        scene.steps(1200)?;
        let body = &scene.flex_bodies[bar];
        let force: f64 = pulled.iter().map(|&node| body.reaction(node)[0]).sum();
        let expected = young * area * stretch / length;
        assert!(
            (force / expected - 1.0).abs() < 1e-9,
            "{force} not {expected}"
        );
        let total = body.total_reaction();
        assert!(total[0].abs() < 1e-9 * expected && total[1].abs() < 1e-9 * expected);
        let energy = body.energy();
        assert!((energy.elastic / (0.5 * expected * stretch) - 1.0).abs() < 1e-9);
        Ok(())
    }

    #[test]
    fn a_hinge_that_is_moved_takes_its_body_along() -> Outcome {
        let mut scene = Scene::default();
        let pendulum = scene.insert(
            FlexBodyBuilder::rectangle([0.2, 1.0], [2, 8])
                .material(rubber())
                .pin(25, Pin::both()),
        )?;
        scene.steps(10)?;
        for step in 1..=240 {
            let x = 0.5 * (1.0 - (std::f64::consts::PI * f64::from(step) / 240.0).cos());
            scene.flex_bodies[pendulum].set_pin_displacement(25, [x, 0.1 * x])?;
            scene.step()?;
            let [dx, dy] = scene.flex_bodies[pendulum].displacement(25);
            assert!((dx - x).abs() < 1e-12 && (dy - 0.1 * x).abs() < 1e-12);
        }
        let body = &scene.flex_bodies[pendulum];
        let [x, y] = body.centre_of_mass();
        // It hangs about half a metre below the hinge and swings by less than a right angle.
        let [hinge_x, hinge_y] = body.position(25);
        let arm = (x - hinge_x).hypot(y - hinge_y);
        assert!(
            (arm - 0.5).abs() < 0.02 && y < hinge_y,
            "{arm} m, {y} under {hinge_y}"
        );
        Ok(())
    }

    #[test]
    fn user_data_travels_with_the_body() -> Outcome {
        let mut scene = Scene::default();
        let body = scene.insert(square().user_data(42))?;
        assert_eq!(scene.flex_bodies[body].user_data, 42);
        scene.flex_bodies[body].user_data = u128::MAX;
        scene.steps(3)?;
        assert_eq!(scene.flex_bodies[body].user_data, u128::MAX);
        let removed = scene.flex_bodies.remove(body, &mut scene.world)?;
        assert_eq!(removed.user_data, u128::MAX);
        Ok(())
    }
}

mod fuzz {
    use super::*;

    /// Marsaglia's xorshift: enough to choose among operations.
    struct Chance(u64);

    impl Chance {
        fn next(&mut self) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0
        }

        fn below(&mut self, n: usize) -> usize {
            (self.next() % n as u64) as usize
        }

        fn within(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
        }

        fn at(&mut self) -> [f64; 2] {
            [self.within(-3.0, 3.0), self.within(0.0, 4.0)]
        }
    }

    const N_OPERATIONS: usize = 2000;

    /// An overlap of the size of a body, undone within the shortest step, gives 1.5 m × 240 / s; beyond ten times that
    /// something feeds on itself (m/s).
    const FASTEST: f64 = 4e3;

    fn flexible(chance: &mut Chance) -> FlexBodyBuilder {
        let material = LinearElastic::plane_stress(chance.within(1e6, 1e8), 0.3)
            .density(1000.0)
            .rayleigh(2e-3);
        let builder = match chance.below(4) {
            0 => FlexBodyBuilder::rectangle([0.6, 0.4], [3, 3]),
            1 => FlexBodyBuilder::disc(0.3, 0.2),
            2 => FlexBodyBuilder::rectangle([1.5, 0.15], [8, 1]),
            _ => FlexBodyBuilder::rectangle([1.5, 0.2], [6, 2])
                .pin_where(|[x, _]| x == 0.0, Pin::both()),
        };
        builder
            .material(material)
            .translation(chance.at())
            .rotation(chance.within(-3.0, 3.0))
            .linvel([chance.within(-3.0, 3.0), 0.0])
            .friction(chance.within(0.0, 1.0))
    }

    fn shape(chance: &mut Chance) -> SharedShape {
        let size = chance.within(0.1, 0.3) as Real;
        let corner = |x: Real, y: Real| Vector::new(x * size, y * size);
        match chance.below(6) {
            0 => SharedShape::ball(size),
            1 => SharedShape::cuboid(size, size),
            2 => SharedShape::capsule_x(size, 0.5 * size),
            3 => SharedShape::triangle(corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)),
            4 => SharedShape::round_cuboid(size, size, 0.1 * size),
            _ => SharedShape::compound(vec![
                (Pose::translation(-size, 0.0), SharedShape::ball(size)),
                (
                    Pose::translation(size, 0.0),
                    SharedShape::cuboid(size, size),
                ),
            ]),
        }
    }

    struct Play {
        scene: Scene,
        flexible: Vec<FlexBodyHandle>,
        rigid: Vec<RigidBodyHandle>,
        n_errors: usize,
    }

    impl Play {
        fn new() -> Self {
            let mut scene = Scene::with_floor();
            for x in [-4.0, 4.0] {
                let wall = ColliderBuilder::cuboid(0.5, 5.0).translation(vector(x, 4.0));
                scene.world.insert_collider(wall, None);
            }
            Self {
                scene,
                flexible: Vec::new(),
                rigid: Vec::new(),
                n_errors: 0,
            }
        }

        fn operate(&mut self, chance: &mut Chance) -> Result<&'static str, Box<dyn Error>> {
            let operation = chance.below(18);
            let name = match operation {
                0 | 1 => self.insert_flexible(chance)?,
                2 | 3 => self.insert_rigid(chance),
                4 => self.remove_flexible(chance)?,
                5 => self.remove_rigid(chance),
                6..=12 => self.change_rigid(operation, chance),
                13..=15 => self.change_flexible(operation, chance)?,
                16 => {
                    let lengths = [0.0, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 60.0, 1.0 / 30.0];
                    self.scene.set_dt(lengths[chance.below(5)]);
                    "step length"
                }
                _ => {
                    self.scene.world.gravity = vector(chance.within(-5.0, 5.0), -9.81);
                    "gravity"
                }
            };
            Ok(name)
        }

        fn insert_flexible(&mut self, chance: &mut Chance) -> Result<&'static str, BuildError> {
            if self.flexible.len() < 5 {
                let handle = self.scene.insert(flexible(chance))?;
                self.flexible.push(handle);
            }
            Ok("insert flexible")
        }

        fn insert_rigid(&mut self, chance: &mut Chance) -> &'static str {
            if self.rigid.len() < 10 {
                let [x, y] = chance.at();
                let body = RigidBodyBuilder::dynamic().translation(vector(x, y));
                let collider = ColliderBuilder::new(shape(chance))
                    .density(chance.within(100.0, 2000.0) as Real)
                    .restitution(chance.within(0.0, 0.8) as Real);
                self.rigid.push(self.scene.world.insert(body, collider).0);
            }
            "insert rigid"
        }

        fn remove_flexible(&mut self, chance: &mut Chance) -> Result<&'static str, FlexBodyError> {
            if !self.flexible.is_empty() {
                let handle = self.flexible.swap_remove(chance.below(self.flexible.len()));
                let scene = &mut self.scene;
                scene.flex_bodies.remove(handle, &mut scene.world)?;
            }
            Ok("remove flexible")
        }

        fn remove_rigid(&mut self, chance: &mut Chance) -> &'static str {
            if !self.rigid.is_empty() {
                let handle = self.rigid.swap_remove(chance.below(self.rigid.len()));
                self.scene.world.remove_body(handle);
            }
            "remove rigid"
        }

        fn change_rigid(&mut self, operation: usize, chance: &mut Chance) -> &'static str {
            if self.rigid.is_empty() {
                return "nothing rigid";
            }
            let handle = self.rigid[chance.below(self.rigid.len())];
            let world = &mut self.scene.world;
            let [x, y] = chance.at();
            let body = &mut world.bodies[handle];
            match operation {
                6 | 7 => {
                    body.set_translation(vector(x, y), true);
                    "teleport"
                }
                8 => {
                    body.set_linvel(vector(10.0 * x, 20.0 * (y - 2.0)), true);
                    "velocity"
                }
                9 => {
                    let is_enabled = body.is_enabled();
                    body.set_enabled(!is_enabled);
                    "enable"
                }
                10 => {
                    let types = [
                        RigidBodyType::Dynamic,
                        RigidBodyType::Dynamic,
                        RigidBodyType::Fixed,
                        RigidBodyType::KinematicVelocityBased,
                        RigidBodyType::KinematicPositionBased,
                    ];
                    body.set_body_type(types[chance.below(5)], true);
                    "type"
                }
                11 => {
                    let collider = body.colliders()[0];
                    world.colliders[collider].set_shape(shape(chance));
                    "shape"
                }
                _ => {
                    if body.is_sleeping() {
                        body.wake_up(true);
                    } else {
                        body.sleep();
                    }
                    "sleep"
                }
            }
        }

        fn change_flexible(
            &mut self,
            operation: usize,
            chance: &mut Chance,
        ) -> Result<&'static str, FlexBodyError> {
            if self.flexible.is_empty() {
                return Ok("nothing flexible");
            }
            let handle = self.flexible[chance.below(self.flexible.len())];
            let body = &mut self.scene.flex_bodies[handle];
            let node = chance.below(body.n_nodes());
            let [x, y] = chance.at();
            match operation {
                13 => {
                    body.set_nodal_force(node, [100.0 * x, 100.0 * (y - 2.0)])?;
                    Ok("nodal force")
                }
                14 => {
                    let n = 2 * body.n_nodes();
                    let velocities: Vec<f64> = (0..n)
                        .map(|dof| if dof % 2 == 0 { x } else { y - 2.0 })
                        .collect();
                    body.set_velocities(&velocities)?;
                    Ok("velocities")
                }
                _ => {
                    let surface = body.collider_handle();
                    let collider = &mut self.scene.world.colliders[surface];
                    let is_enabled = collider.is_enabled();
                    collider.set_enabled(!is_enabled);
                    Ok("enable surface")
                }
            }
        }

        #[track_caller]
        fn assert_finite(&self, context: &str) {
            for (handle, body) in self.scene.flex_bodies.iter() {
                let state = body.state();
                let all = [
                    &state.position,
                    &state.velocity,
                    &state.displacement,
                    &state.rate,
                    &state.acceleration,
                ];
                let is_finite = all.into_iter().flatten().all(|x| x.is_finite());
                assert!(is_finite, "{context}: {handle:?}");
                let speeds = body.velocities().iter().map(|v| v.abs());
                let fastest = speeds.fold(0.0, f64::max);
                assert!(
                    fastest < FASTEST,
                    "{context}: {handle:?} moves at {fastest:e} m/s"
                );
            }
            for (handle, body) in self.scene.world.rigid_bodies() {
                let is_finite = body.translation().is_finite()
                    && body.linvel().is_finite()
                    && body.angvel().is_finite();
                assert!(is_finite, "{context}: {handle:?}");
            }
        }
    }

    /// Plays one seed through; returns how many steps were refused.
    fn play(seed: u64) -> Result<usize, Box<dyn Error>> {
        let mut chance = Chance(seed);
        let mut play = Play::new();
        for index in 0..N_OPERATIONS {
            let operation = play.operate(&mut chance)?;
            let context = format!("seed {seed}, operation {index} ({operation})");
            if let Err(error) = play.scene.step() {
                println!("{context}: {error}");
                play.n_errors += 1;
            }
            play.assert_finite(&context);
        }
        Ok(play.n_errors)
    }

    #[test]
    fn two_thousand_random_operations_between_steps_never_panic_and_stay_finite() -> Outcome {
        let n_errors = play(0x2545_f491_4f6c_dd1d)?;
        assert_eq!(n_errors, 0, "every step of this scene can be taken");
        Ok(())
    }
}
