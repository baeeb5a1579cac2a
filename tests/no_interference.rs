//! The flexible stage leaves rapier alone: bit for bit without flexible bodies, and in behaviour where they are far away.

mod common;

use common::{motion_of, soft_block};
use foil2d::body::BuildError;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

const N_BODIES: usize = 200;

/// 200 dynamic bodies: columns of boxes, balls, capsules and polygons, a chain, welded, sliding, roped and sprung pairs,
/// over a floor and a moving platform.
fn crowded_world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.insert_collider(
        ColliderBuilder::cuboid(60.0, 0.5).translation(Vector::new(0.0, -0.5)),
        None,
    );
    world.insert(
        RigidBodyBuilder::kinematic_velocity_based()
            .translation(Vector::new(-30.0, 0.25))
            .linvel(Vector::new(0.5, 0.0)),
        ColliderBuilder::cuboid(1.0, 0.25).friction(0.8),
    );
    add_columns(&mut world);
    add_chain(&mut world);
    add_pairs(&mut world);
    let n_dynamic = world
        .rigid_bodies()
        .filter(|(_, body)| body.is_dynamic())
        .count();
    assert_eq!(n_dynamic, N_BODIES);
    world
}

/// 160 bodies in 16 columns.
fn add_columns(world: &mut PhysicsWorld) {
    let corners = [[-0.4, -0.3], [0.4, -0.3], [0.3, 0.3], [-0.2, 0.4]];
    let corners = corners.map(|[x, y]: [Real; 2]| Vector::new(x, y));
    for column in 0..16 {
        for row in 0..10 {
            let shape = match (column + row) % 4 {
                0 => ColliderBuilder::cuboid(0.4, 0.3),
                1 => ColliderBuilder::ball(0.35),
                2 => ColliderBuilder::capsule_x(0.3, 0.2),
                _ => {
                    ColliderBuilder::convex_hull(&corners).expect("four corners of a quadrilateral")
                }
            };
            let lean = 0.02 * row as Real;
            let at = Vector::new(-30.0 + 2.5 * column as Real + lean, 0.6 + 0.9 * row as Real);
            world.insert(
                RigidBodyBuilder::dynamic()
                    .translation(at)
                    .rotation(0.03 * row as Real)
                    .ccd_enabled(row == 9),
                shape
                    .density(1.0 + row as Real)
                    .friction(0.4)
                    .restitution(0.1),
            );
        }
    }
}

/// 20 links that hang from a fixed body.
fn add_chain(world: &mut PhysicsWorld) {
    let mut last =
        world.insert_body(RigidBodyBuilder::fixed().translation(Vector::new(20.0, 12.0)));
    for link in 0..20 {
        let at = Vector::new(20.25 + 0.5 * link as Real, 12.0);
        let (body, _) = world.insert(
            RigidBodyBuilder::dynamic().translation(at),
            ColliderBuilder::capsule_x(0.15, 0.05).density(2.0),
        );
        let reach = if link == 0 { 0.0 } else { 0.25 };
        let joint = RevoluteJointBuilder::new()
            .local_anchor1(Vector::new(reach, 0.0))
            .local_anchor2(Vector::new(-0.25, 0.0))
            .contacts_enabled(false);
        world.insert_impulse_joint(last, body, joint);
        last = body;
    }
}

/// Ten pairs of bodies, joined in different ways.
fn add_pairs(world: &mut PhysicsWorld) {
    for pair in 0..10 {
        let at = Vector::new(22.0 + 3.0 * pair as Real, 2.0);
        let mut half = |offset: Real| {
            let body = RigidBodyBuilder::dynamic().translation(at + Vector::new(offset, 0.0));
            world
                .insert(body, ColliderBuilder::cuboid(0.3, 0.3).density(1.5))
                .0
        };
        let (left, right) = (half(-0.5), half(0.5));
        let anchors = [Vector::new(0.5, 0.0), Vector::new(-0.5, 0.0)];
        let joint: GenericJoint = match pair % 4 {
            0 => FixedJointBuilder::new()
                .local_anchor1(anchors[0])
                .local_anchor2(anchors[1])
                .into(),
            1 => PrismaticJointBuilder::new(Vector::new(1.0, 0.0))
                .local_anchor1(anchors[0])
                .local_anchor2(anchors[1])
                .limits([-0.2, 0.6])
                .into(),
            2 => RopeJointBuilder::new(1.5).into(),
            _ => SpringJointBuilder::new(1.2, 80.0, 2.0).into(),
        };
        world.insert_impulse_joint(left, right, joint);
    }
}

/// All bits of the motion of all rigid bodies, in the order of rapier's set.
fn bits(world: &PhysicsWorld) -> Vec<u64> {
    let mut bits = Vec::new();
    for (_, body) in world.rigid_bodies() {
        bits.extend(motion_of(body).map(f64::to_bits));
        bits.push(u64::from(body.is_sleeping()));
    }
    bits
}

fn block_at(x: f64, y: f64) -> FlexBodyBuilder {
    soft_block(2e-3).translation([x, y])
}

#[test]
fn a_world_without_flexible_bodies_steps_bit_for_bit_as_with_rapier_alone() {
    let (mut alone, mut with_pipeline) = (crowded_world(), crowded_world());
    let mut flex = FlexPipeline::new();
    let mut flex_bodies = FlexBodySet::new();
    assert_eq!(bits(&alone), bits(&with_pipeline));
    for step in 0..600 {
        alone.step();
        let report = flex
            .step(&mut with_pipeline, &mut flex_bodies)
            .expect("an empty step");
        assert!(report.contacts().is_empty());
        assert_eq!(bits(&alone), bits(&with_pipeline), "step {step}");
    }
    let moved = crowded_world();
    assert_ne!(bits(&alone), bits(&moved), "the scene moves at all");
}

#[test]
fn a_world_whose_last_flexible_body_was_removed_steps_bit_for_bit_again() -> Result<(), BuildError>
{
    // Two worlds with the same history; after the removal one goes on with rapier alone.
    let history = || -> Result<_, BuildError> {
        let mut world = crowded_world();
        let mut flex = FlexPipeline::new();
        let mut flex_bodies = FlexBodySet::new();
        let (n_bodies, n_colliders) = (world.bodies.len(), world.colliders.len());
        for _ in 0..60 {
            flex.step(&mut world, &mut flex_bodies)
                .expect("no body yet");
        }
        // It falls beside the columns, and a box that is claimed with it falls onto it.
        let above = RigidBodyBuilder::dynamic().translation(Vector::new(-44.5, 1.4));
        let heavy = ColliderBuilder::cuboid(0.3, 0.3).density(500.0);
        let (crate_body, _) = world.insert(above, heavy);
        let body = flex_bodies.insert(block_at(-45.0, 0.05), &mut world)?;
        let mut n_claimed = 0;
        for _ in 0..120 {
            let report = flex
                .step(&mut world, &mut flex_bodies)
                .expect("a block that falls on a box");
            n_claimed = n_claimed.max(report.n_claimed());
        }
        assert_eq!(n_claimed, 1);
        world.remove_body(crate_body);
        flex_bodies
            .remove(body, &mut world)
            .expect("the body is there");
        assert_eq!(
            (world.bodies.len(), world.colliders.len()),
            (n_bodies, n_colliders)
        );
        Ok((world, flex, flex_bodies))
    };
    let (mut with_pipeline, mut flex, mut flex_bodies) = history()?;
    let (mut alone, ..) = history()?;
    assert_eq!(bits(&alone), bits(&with_pipeline));
    for step in 0..300 {
        alone.step();
        flex.step(&mut with_pipeline, &mut flex_bodies)
            .expect("an empty step");
        assert_eq!(bits(&alone), bits(&with_pipeline), "step {step}");
    }
    let is_finite = |(_, body): (_, &RigidBody)| {
        body.translation().is_finite() && body.linvel().is_finite() && body.angvel().is_finite()
    };
    assert!(alone.rigid_bodies().all(is_finite));
    Ok(())
}

/// Bodies whose motion has a known answer, far from anything flexible.
struct Known {
    world: PhysicsWorld,
    slider: RigidBodyHandle,
    stack: Vec<RigidBodyHandle>,
    bob: RigidBodyHandle,
    welded: [RigidBodyHandle; 2],
}

/// A box that slides to rest, a stack of five, a pendulum of 2 m and a welded pair that was thrown.
fn known_world() -> Known {
    let mut world = PhysicsWorld::new();
    let mut floor = ColliderBuilder::cuboid(60.0, 0.5).translation(Vector::new(0.0, -0.5));
    floor = floor.friction(0.3);
    world.insert_collider(floor, None);
    let (slider, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(-40.0, 0.25))
            .linvel(Vector::new(3.0, 0.0))
            .can_sleep(false),
        ColliderBuilder::cuboid(1.0, 0.25).friction(0.3),
    );
    let stack = (0..5)
        .map(|level| {
            let at = Vector::new(0.0, 0.5 + level as Real);
            world
                .insert(
                    RigidBodyBuilder::dynamic().translation(at).can_sleep(false),
                    ColliderBuilder::cuboid(0.5, 0.5),
                )
                .0
        })
        .collect();
    // Two metres long, 0.2 m aside.
    let hang: Real = 3.96;
    let hang = hang.sqrt();
    let hook = world.insert_body(RigidBodyBuilder::fixed().translation(Vector::new(10.0, 5.0)));
    let (bob, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(10.2, 5.0 - hang))
            .can_sleep(false),
        ColliderBuilder::ball(0.01),
    );
    let arm = Vector::new(-0.2, hang);
    let joint = RevoluteJointBuilder::new().local_anchor2(arm);
    world.insert_impulse_joint(hook, bob, joint);
    let welded = [-0.5, 0.5].map(|offset: Real| {
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(30.0 + offset, 20.0))
            .linvel(Vector::new(1.0, 4.0));
        world.insert(body, ColliderBuilder::cuboid(0.2, 0.2)).0
    });
    let weld = FixedJointBuilder::new()
        .local_anchor1(Vector::new(0.5, 0.0))
        .local_anchor2(Vector::new(-0.5, 0.0));
    world.insert_impulse_joint(welded[0], welded[1], weld);
    Known {
        world,
        slider,
        stack,
        bob,
        welded,
    }
}

#[test]
fn a_flexible_body_far_away_leaves_two_hundred_rigid_bodies_every_bit() -> Result<(), BuildError> {
    let (mut alone, mut beside) = (crowded_world(), crowded_world());
    let mut flex = FlexPipeline::new();
    let mut flex_bodies = FlexBodySet::new();
    let n_alone = alone.bodies.len();
    // It falls onto a floor of its own.
    let floor = ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(1000.0, -0.5));
    beside.insert_collider(floor, None);
    let block = flex_bodies.insert(block_at(1000.0, 0.05), &mut beside)?;
    for step in 0..600 {
        alone.step();
        let report = flex
            .step(&mut beside, &mut flex_bodies)
            .expect("a block on a floor");
        assert_eq!(report.n_claimed(), 0);
        let own = bits(&alone);
        assert_eq!(bits(&beside)[..own.len()], own, "step {step}");
    }
    assert_eq!(beside.bodies.len(), n_alone + 1, "the carrier");
    let weight = 9.81 * flex_bodies[block].mass();
    let force = flex_bodies[block].total_contact_force()[1];
    assert!(
        (force / weight - 1.0).abs() < 1e-3,
        "the block rests: {force} N"
    );
    Ok(())
}

#[test]
fn claims_far_away_cost_two_hundred_rigid_bodies_no_more_than_detection_steps()
-> Result<(), BuildError> {
    // Where a rigid body is claimed, rapier sees one detection step of zero length more in every step. That alone changes
    // bits in a crowd, with no flexible body in the world: contacts that will close within the step are not kept in a
    // step without length. Everything else must change nothing.
    let (mut detected, mut beside) = (crowded_world(), crowded_world());
    let mut flex = FlexPipeline::new();
    let mut flex_bodies = FlexBodySet::new();
    let floor = ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(1000.0, -0.5));
    beside.insert_collider(floor, None);
    flex_bodies.insert(block_at(1000.0, 0.05).can_sleep(false), &mut beside)?;
    let above = RigidBodyBuilder::dynamic().translation(Vector::new(1000.5, 1.15));
    beside.insert(above, ColliderBuilder::cuboid(0.3, 0.3).density(500.0));
    let dt = detected.integration_parameters.dt;
    let mut n_claimed = 0;
    for step in 0..600 {
        detected.integration_parameters.dt = 0.0;
        detected.step();
        detected.integration_parameters.dt = dt;
        detected.step();
        let report = flex
            .step(&mut beside, &mut flex_bodies)
            .expect("a block with a box on it");
        n_claimed = n_claimed.max(report.n_claimed());
        let own = bits(&detected);
        assert_eq!(bits(&beside)[..own.len()], own, "step {step}");
    }
    assert_eq!(n_claimed, 1, "the box is claimed, and nothing else");
    Ok(())
}

/// Steps both worlds for two seconds, one of them with a flexible block at rest a kilometre away.
fn known_worlds_after_two_seconds() -> Result<(Known, Known), BuildError> {
    let (mut alone, mut beside) = (known_world(), known_world());
    let mut flex = FlexPipeline::new();
    let mut flex_bodies = FlexBodySet::new();
    beside.world.insert_collider(
        ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(1000.0, -0.5)),
        None,
    );
    flex_bodies.insert(block_at(1000.0, 0.05), &mut beside.world)?;
    for _ in 0..120 {
        alone.world.step();
        let report = flex
            .step(&mut beside.world, &mut flex_bodies)
            .expect("a block that falls to rest");
        assert_eq!(report.n_claimed(), 0, "nothing rigid touches the block");
    }
    Ok((alone, beside))
}

#[test]
fn a_flexible_body_far_away_leaves_rigid_bodies_their_behaviour() -> Result<(), BuildError> {
    let (alone, beside) = known_worlds_after_two_seconds()?;
    let at = |known: &Known, handle: RigidBodyHandle| {
        let at = known.world.bodies[handle].translation();
        [f64::from(at.x), f64::from(at.y)]
    };
    let mut largest = 0.0f64;
    for handle in (alone.stack.iter())
        .chain(&alone.welded)
        .chain([&alone.slider, &alone.bob])
    {
        let (a, b) = (at(&alone, *handle), at(&beside, *handle));
        let difference = (a[0] - b[0]).hypot(a[1] - b[1]);
        println!("{handle:?}: {a:?} alone, {b:?} beside, {difference:.1e} m apart");
        largest = largest.max(difference);
    }
    assert_eq!(largest, 0.0, "m apart after two seconds");

    // Coulomb: the box stops after v0²/2μg = 1.529 m; rapier is first order in the step, v0 dt = 0.05 m.
    let slid = at(&beside, beside.slider)[0] + 40.0;
    assert!((slid - 9.0 / (2.0 * 0.3 * 9.81)).abs() < 0.05, "{slid} m");
    // The stack stands: rapier's contacts give by 2 mm each at most, more under more weight.
    for (level, &handle) in beside.stack.iter().enumerate() {
        let [x, y] = at(&beside, handle);
        assert!(
            x.abs() < 1e-3 && (y - 0.5 - level as f64).abs() < 1e-2,
            "{x} {y}"
        );
    }
    // The pendulum keeps its length and, after two seconds of period 2.8405 s, swings on the other side.
    let [x, y] = at(&beside, beside.bob);
    assert!(((x - 10.0).hypot(y - 5.0) - 2.0).abs() < 2e-3);
    let expected = 0.2 * (2.0 * (9.81f64 / 2.0).sqrt()).cos();
    assert!((x - 10.0 - expected).abs() < 0.02, "{x}, not {expected}");
    // The thrown pair stays welded and flies its parabola, again to first order: g t dt / 2.
    let [left, right] = beside.welded.map(|handle| at(&beside, handle));
    assert!(((right[0] - left[0]).hypot(right[1] - left[1]) - 1.0).abs() < 1e-3);
    let middle = [0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])];
    assert!(
        (middle[0] - 32.0).abs() < 1e-3 && (middle[1] - 8.38).abs() < 0.17,
        "{middle:?}"
    );
    Ok(())
}
