//! The same scene gives the same bits, and the order in which bodies were inserted is not physics.

mod common;
#[path = "snapshot/scenes.rs"]
mod scenes;

use common::{Hash, Recorder, elastic, motion_of};
use foil2d::body::BuildError;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A world with named bodies.
struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
    blocks: Vec<(&'static str, FlexBodyHandle)>,
    boxes: Vec<(&'static str, RigidBodyHandle)>,
}

fn flexible(name: &str) -> FlexBodyBuilder {
    let rubber = elastic(2e8, 1000.0, 2e-3);
    let builder = match name {
        "beam" => FlexBodyBuilder::rectangle([4.0, 0.3], [24, 3])
            .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
            .translation([-2.0, 2.0]),
        "block" => FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
            .rotation(0.3)
            .translation([4.0, 0.002]),
        "disc" => FlexBodyBuilder::disc(0.5, 0.15)
            .translation([-5.0, 0.502])
            .angvel(2.0),
        _ => FlexBodyBuilder::rectangle([0.8, 0.6], [8, 6])
            .translation([-1.4, 2.302])
            .linvel([0.5, 0.0]),
    };
    builder.material(rubber).friction(0.4)
}

fn rigid(name: &str) -> (RigidBodyBuilder, ColliderBuilder) {
    let (at, shape) = match name {
        "crate" => ([0.5, 2.502], ColliderBuilder::cuboid(0.2, 0.2)),
        "top" => ([0.55, 2.904], ColliderBuilder::cuboid(0.15, 0.2)),
        "ball" => ([1.3, 2.552], ColliderBuilder::ball(0.25)),
        _ => ([6.0, 0.202], ColliderBuilder::capsule_x(0.3, 0.2)),
    };
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(at[0], at[1]));
    (body, shape.density(400.0).friction(0.4))
}

const FLEXIBLE: [&str; 4] = ["beam", "block", "disc", "slab"];
const RIGID: [&str; 4] = ["crate", "top", "ball", "capsule"];

fn scene(flexible_order: [usize; 4], rigid_order: [usize; 4]) -> Result<Scene, BuildError> {
    let mut world = PhysicsWorld::new();
    let mut flex_bodies = FlexBodySet::new();
    let floor = ColliderBuilder::cuboid(20.0, 0.5).translation(Vector::new(0.0, -0.5));
    world.insert_collider(floor, None);
    let (mut blocks, mut boxes) = (Vec::new(), Vec::new());
    for index in 0..4 {
        let name = FLEXIBLE[flexible_order[index]];
        blocks.push((name, flex_bodies.insert(flexible(name), &mut world)?));
        let name = RIGID[rigid_order[index]];
        let (body, collider) = rigid(name);
        boxes.push((name, world.insert(body, collider).0));
    }
    blocks.sort_unstable_by_key(|(name, _)| *name);
    boxes.sort_unstable_by_key(|(name, _)| *name);
    Ok(Scene {
        world,
        flex_bodies,
        flex: FlexPipeline::new(),
        blocks,
        boxes,
    })
}

impl Scene {
    fn step(&mut self) {
        self.flex
            .step(&mut self.world, &mut self.flex_bodies)
            .expect("the scene steps");
    }

    /// Positions (m) and velocities (m/s) of everything, body by body in the order of their names.
    fn state(&self) -> [Vec<f64>; 2] {
        let [mut positions, mut velocities] = [Vec::new(), Vec::new()];
        for (_, handle) in &self.blocks {
            let body = &self.flex_bodies[*handle];
            positions.extend_from_slice(body.positions());
            velocities.extend_from_slice(body.velocities());
        }
        for (_, handle) in &self.boxes {
            let body = &self.world.bodies[*handle];
            let motion = motion_of(body);
            let (pose, rates) = motion.split_at(4);
            positions.extend(pose);
            velocities.extend(rates);
        }
        [positions, velocities]
    }

    /// FNV-1a over all bits of the state, of the committed motion in the frames and of the report.
    fn hash(&self) -> u64 {
        let mut hash = Hash::default();
        let mut take = |value: f64| hash.take(value);
        self.state().into_iter().flatten().for_each(&mut take);
        for (_, handle) in &self.blocks {
            let body = &self.flex_bodies[*handle];
            let state = body.state();
            [&state.displacement, &state.rate, &state.acceleration]
                .into_iter()
                .flatten()
                .for_each(|x| take(*x));
            (0..body.n_nodes())
                .flat_map(|node| body.contact_force(node))
                .for_each(&mut take);
        }
        let report = self.flex.report();
        for contact in report.contacts() {
            contact.position.into_iter().for_each(&mut take);
            take(contact.normal_force);
            take(contact.tangential_force);
        }
        take(report.energy().total());
        hash.0
    }
}

#[test]
fn the_same_scene_gives_the_same_bits_at_every_step() -> Result<(), BuildError> {
    let order = [0, 1, 2, 3];
    let (mut one, mut other) = (scene(order, order)?, scene(order, order)?);
    let mut n_contacts = 0;
    for step in 0..300 {
        one.step();
        other.step();
        assert_eq!(one.hash(), other.hash(), "step {step}");
        n_contacts = n_contacts.max(one.flex.report().contacts().len());
    }
    assert!(one.state().iter().flatten().all(|x| x.is_finite()));
    assert!(n_contacts > 8, "the scene collides: {n_contacts} contacts");
    Ok(())
}

#[test]
fn a_scene_stepped_on_another_thread_gives_the_same_bits() -> Result<(), BuildError> {
    let run = || -> Result<u64, BuildError> {
        let mut scene = scene([0, 1, 2, 3], [0, 1, 2, 3])?;
        (0..90).for_each(|_| scene.step());
        Ok(scene.hash())
    };
    let elsewhere = std::thread::spawn(run).join().expect("the thread runs")?;
    assert_eq!(run()?, elsewhere);
    Ok(())
}

#[test]
fn the_order_of_insertion_changes_no_bit() -> Result<(), BuildError> {
    // Members of an island are visited in the order of their places, and rapier's own bodies only meet the floor.
    let mut reference = scene([0, 1, 2, 3], [0, 1, 2, 3])?;
    let mut others = [
        scene([3, 2, 1, 0], [0, 1, 2, 3])?,
        scene([0, 1, 2, 3], [3, 1, 0, 2])?,
        scene([2, 0, 3, 1], [2, 3, 1, 0])?,
    ];
    for step in 0..300 {
        reference.step();
        let expected = reference.hash();
        for (index, other) in others.iter_mut().enumerate() {
            other.step();
            assert_eq!(expected, other.hash(), "order {index}, step {step}");
        }
    }
    Ok(())
}

/// FNV-1a over the bits of every body, flexible and rigid, in the order of their handles.
fn hash_of(run: &scenes::Run) -> u64 {
    let mut hash = Hash::default();
    let mut take = |value: f64| hash.take(value);
    for (_, body) in run.flex_bodies.iter() {
        body.positions().iter().for_each(|x| take(*x));
        body.velocities().iter().for_each(|v| take(*v));
        body.total_contact_force().into_iter().for_each(&mut take);
    }
    for (_, body) in run.world.bodies.iter() {
        motion_of(body).into_iter().for_each(&mut take);
    }
    hash.0
}

#[test]
fn a_scene_of_everything_comes_to_the_same_bits_and_events_twice() {
    let run = || {
        let (mut run, log) = (scenes::everything(), Recorder::default());
        (0..200).for_each(|_| run.step(&log));
        (hash_of(&run), log.take())
    };
    assert_eq!(run(), run());
}

/// What 300 steps of a scene with contact, joints, attachments, hooks and sleep come to, on every machine. A change that moves
/// results changes this number, and says so in its commit.
#[cfg(all(feature = "enhanced-determinism", not(feature = "f64")))]
#[test]
fn a_scene_of_everything_comes_to_the_same_bits_on_every_platform() {
    let mut run = scenes::everything();
    let log = Recorder::default();
    (0..300).for_each(|_| run.step(&log));
    let found = hash_of(&run);
    assert_eq!(found, 0x1d4b_3d50_19f7_6e03, "found {found:#018x}");
}

/// Beside everything, enough boxes for rapier to share them out.
#[cfg(feature = "parallel")]
#[test]
fn the_number_of_threads_changes_no_bit() {
    let of_threads = |n_threads: usize| {
        let mut run = scenes::everything();
        for index in 0..120 {
            let (column, row) = (index % 20, index / 20);
            let at = [18.0 + 0.31 * f64::from(column), 0.2 + 0.4 * f64::from(row)];
            run.rigid(at, ColliderBuilder::cuboid(0.14, 0.14));
        }
        let pipeline = &mut run.world.physics_pipeline;
        pipeline.configure_thread_pool(n_threads).expect("threads");
        let log = Recorder::default();
        (0..60).for_each(|_| run.step(&log));
        (hash_of(&run), log.take())
    };
    let alone = of_threads(1);
    for n_threads in [2, 3] {
        let together = of_threads(n_threads);
        assert_eq!(alone.0, together.0, "{n_threads} threads");
        assert_eq!(alone.1, together.1, "events with {n_threads} threads");
    }
}

#[test]
fn bodies_far_away_change_no_bit_of_an_island() -> Result<(), BuildError> {
    let order = [0, 1, 2, 3];
    let mut alone = scene(order, order)?;
    let mut beside = scene(order, order)?;
    let far = flexible("block").translation([15.0, 0.3]);
    beside.flex_bodies.insert(far, &mut beside.world)?;
    let (body, collider) = rigid("crate");
    beside
        .world
        .insert(body.translation(Vector::new(-15.0, 0.5)), collider);
    for step in 0..200 {
        alone.step();
        beside.step();
        assert_eq!(alone.state(), beside.state(), "step {step}");
    }
    Ok(())
}
