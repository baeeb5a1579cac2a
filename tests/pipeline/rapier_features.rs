//! What rapier's users rely on: events, groups, hooks, queries, sleeping platforms and fast bodies.

use crate::support::*;
use foil2d::pipeline::Participant;

#[test]
fn a_block_that_lands_starts_a_collision_and_none_starts_or_stops_while_it_rests() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(
        square()
            .active_events(ActiveEvents::COLLISION_EVENTS)
            .translation([0.0, 0.2]),
    )?;
    let listener = Recorder::default();
    let mut landed_at = None;
    let mut counts = Vec::new();
    for step in 0..480 {
        scene
            .flex
            .step_with_events(&mut scene.world, &mut scene.flex_bodies, &(), &listener)?;
        let touches = !scene.flex.report().contacts().is_empty();
        landed_at = landed_at.or(touches.then_some(step));
        counts.push(listener.starts_and_stops());
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
    let events = listener.collisions();
    let pair = [events[0].collider1(), events[0].collider2()];
    assert!(pair.contains(&surface) && pair.contains(&floor.ok_or("the floor")?));
    // Taken away while it touches, it stops the collision.
    scene.flex_bodies.remove(block, &mut scene.world)?;
    scene
        .flex
        .step_with_events(&mut scene.world, &mut scene.flex_bodies, &(), &listener)?;
    assert_eq!(listener.starts_and_stops(), (started, started));
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
    let listener = Recorder::default();
    for _ in 0..60 {
        scene
            .flex
            .step_with_events(&mut scene.world, &mut scene.flex_bodies, &(), &listener)?;
    }
    let t = 60.0 * scene.dt();
    let fallen = 2.5 - scene.flex_bodies[block].centre_of_mass()[1];
    assert!((fallen - 0.5 * GRAVITY * t * t).abs() < 1e-5, "{fallen} m");
    assert_eq!(listener.starts_and_stops(), (1, 1));
    Ok(())
}

fn group(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}

#[test]
fn collision_groups_let_bodies_pass_that_must_not_meet() -> Outcome {
    let mut scene = Scene::default();
    let floor = ColliderBuilder::cuboid(50.0, 0.5)
        .translation(vec2(0.0, -0.5))
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
    scene.insert(beam().can_sleep(false))?;
    let boxes = [Group::GROUP_1, Group::GROUP_2].map(|own| {
        let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, 1.501));
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
        let body = RigidBodyBuilder::dynamic().translation(vec2(x, 2.0));
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
        .translation(vec2(0.0, 0.5))
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
    let beam = scene.insert(beam().can_sleep(false))?;
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
                body.set_next_kinematic_translation(vec2(x, y));
            } else {
                body.set_linvel(vec2(speed[0], speed[1]), true);
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
fn a_fixed_body_that_comes_moves_or_goes_is_met_in_the_same_step() -> Outcome {
    // Nothing here moves but the block, so no step needs rapier's detection step: what the user does must count all the same.
    let mut scene = Scene::default();
    let block = scene.insert(square().translation([0.0, 0.0]))?;
    let bottom = |scene: &Scene| {
        let positions = scene.flex_bodies[block].positions();
        positions
            .iter()
            .skip(1)
            .step_by(2)
            .fold(f64::INFINITY, |low, y| low.min(*y))
    };
    scene.steps(10)?;
    // A table under it, a little below.
    let top = bottom(&scene) - 1e-3;
    let table = RigidBodyBuilder::fixed().translation(vec2(0.0, top - 0.25));
    let (table, surface) = scene
        .world
        .insert(table, ColliderBuilder::cuboid(2.0, 0.25));
    scene.steps(120)?;
    assert!((bottom(&scene) - top).abs() < 1e-5, "it rests on the table");
    // Moved down by a metre, the table lets it fall and catches it again.
    scene.world.bodies[table].set_translation(vec2(0.0, top - 1.25), true);
    scene.step()?;
    assert!(
        scene.flex.report().contacts().is_empty(),
        "the table is gone from where it was"
    );
    scene.steps(240)?;
    assert!(
        (bottom(&scene) - top + 1.0).abs() < 1e-5,
        "it rests a metre lower"
    );
    // Disabled, it is not there; enabled in the way of the falling block, it is.
    scene.world.bodies[table].set_enabled(false);
    scene.step()?;
    assert!(
        scene.flex.report().contacts().is_empty(),
        "the table is disabled"
    );
    scene.world.bodies[table].set_translation(vec2(0.0, top - 2.25), true);
    scene.world.bodies[table].set_enabled(true);
    scene.steps(240)?;
    assert!(
        (bottom(&scene) - top + 2.0).abs() < 1e-5,
        "it rests two metres lower"
    );
    // Another shape counts at once, and none lets it fall.
    scene.world.colliders[surface].set_shape(SharedShape::cuboid(2.0, 0.125));
    scene.steps(240)?;
    assert!(
        (bottom(&scene) - top + 2.125).abs() < 1e-5,
        "it rests on a thinner table"
    );
    scene.world.remove_body(table);
    scene.step()?;
    assert!(
        scene.flex.report().contacts().is_empty(),
        "the table was removed"
    );
    Ok(())
}

#[test]
fn a_box_inserted_or_teleported_onto_a_block_is_claimed_in_the_same_step() -> Outcome {
    let mut scene = Scene::with_floor();
    scene.insert(square().translation([-0.5, 1e-4]))?;
    scene.steps(60)?;
    assert_eq!(scene.step()?.n_claimed(), 0);
    let crate_body = scene.insert_box(0.25, [0.0, 1.2505], 500.0);
    assert_eq!(
        scene.step()?.n_claimed(),
        1,
        "it has mass from its first step on"
    );
    scene.steps(60)?;
    scene.world.bodies[crate_body].set_translation(vec2(8.0, 0.25), true);
    assert_eq!(scene.step()?.n_claimed(), 0);
    scene.steps(10)?;
    scene.world.bodies[crate_body].set_translation(vec2(0.0, 1.2505), true);
    assert_eq!(scene.step()?.n_claimed(), 1);
    scene.steps(120)?;
    assert!(
        (scene.height(crate_body) - 1.25).abs() < 0.02,
        "it rests on the block"
    );
    Ok(())
}
