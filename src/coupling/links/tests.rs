use super::*;
use crate::rapier::math::Real;

fn known<T>(value: Option<T>) -> T {
    match value {
        Some(value) => value,
        None => panic!("the scene has what is asked for"),
    }
}

/// Four links on revolute and prismatic joints, free or on a fixed base, at rest and without damping; the handles of the moving ones.
fn multibody(is_based: bool) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, 0.0);
    let at = |x: f64, y: f64| Vector::new(x as Real, y as Real);
    let places = [(0.0, 0.0), (1.0, 0.2), (1.9, -0.3), (1.2, 1.1)];
    let mut links = Vec::new();
    for (index, (x, y)) in places.into_iter().enumerate() {
        let body = match is_based && index == 0 {
            true => RigidBodyBuilder::fixed(),
            false => RigidBodyBuilder::dynamic(),
        };
        let shape = ColliderBuilder::cuboid(0.2, 0.1)
            .mass((1 + 2 * index) as Real)
            .collision_groups(InteractionGroups::none());
        let body = body.translation(at(x, y)).can_sleep(false);
        links.push(world.insert(body, shape).0);
    }
    let turn = |a: (f64, f64), b: (f64, f64)| {
        let joint = RevoluteJointBuilder::new().local_anchor1(at(a.0, a.1));
        joint.local_anchor2(at(b.0, b.1)).build().data
    };
    let rail = PrismaticJointBuilder::new(at(0.6, 0.8))
        .local_anchor1(at(0.2, 0.9))
        .build()
        .data;
    let joints = [
        (0, 1, turn((0.5, 0.1), (-0.5, -0.1))),
        (1, 2, turn((0.4, -0.2), (-0.5, 0.3))),
        (1, 3, rail),
    ];
    let mut last = None;
    for (one, other, joint) in joints {
        last = world
            .multibody_joints
            .insert(links[one], links[other], joint, true);
    }
    let joints = &mut world.multibody_joints;
    let (tree, _) = known(last.and_then(|handle| joints.get_mut(handle)));
    tree.damping_mut().fill(0.0);
    if is_based {
        links.remove(0);
    }
    (world, links)
}

/// Velocity and place of a link's centre, spin and angle.
fn motion_of(world: &mut PhysicsWorld, link: RigidBodyHandle) -> RigidMotion {
    let body = &world.bodies[link];
    let centre = body.center_of_mass();
    let motion = RigidMotion {
        centre: Vec2::new(f64::from(centre.x), f64::from(centre.y)),
        angle: f64::from(body.rotation().angle()),
        ..RigidMotion::default()
    };
    let sets = RapierSets::of_world(world, &(), &());
    link_motion(link, motion, &sets)
}

/// What a force or a torque on one link does to another, as the flexible stage reckons it and as rapier does it.
#[test]
fn links_answer_forces_on_each_other_as_rapier_moves_them() {
    for is_based in [false, true] {
        let n = multibody(is_based).1.len();
        for (from, at, axis) in (0..n)
            .flat_map(|from| (0..n).flat_map(move |at| (0..3).map(move |axis| (from, at, axis))))
        {
            let (mut world, links) = multibody(is_based);
            world.step();
            let dt = f64::from(world.integration_parameters.dt);
            let answer = {
                let sets = RapierSets::of_world(&mut world, &(), &());
                let index = known(multibody_of(links[at], &sets));
                let found = known(sets.multibody_joints.get_multibody(index));
                let tree = known(Tree::read(found, &sets));
                let pace = Pace::new(dt, sets.integration_parameters, 0);
                let foreseen = known(tree.solve(found, &sets, pace, &[]));
                let place = |handle| tree.links.iter().position(|link| link.handle == handle);
                let [at, from] = [at, from].map(|link| known(place(links[link])));
                foreseen.answers.answer(&tree, at, from)
            };
            let before = motion_of(&mut world, links[at]);
            let strength = 0.5;
            let body = &mut world.bodies[links[from]];
            match axis {
                0 => body.add_force(Vector::new(strength as Real, 0.0), true),
                1 => body.add_force(Vector::new(0.0, strength as Real), true),
                _ => body.add_torque(strength as Real, true),
            }
            world.step();
            let after = motion_of(&mut world, links[at]);
            let gained = Vector3::new(
                after.velocity.x - before.velocity.x,
                after.velocity.y - before.velocity.y,
                after.spin - before.spin,
            ) / (strength * dt);
            let moved = Vector3::new(
                after.centre.x - before.centre.x,
                after.centre.y - before.centre.y,
                after.angle - before.angle,
            ) / (strength * dt * dt);
            let [velocity, position] =
                [answer.velocity, answer.position].map(|matrix| matrix.column(axis).into_owned());
            let name = format!("based {is_based}, axis {axis} of {from} on {at}");
            let off = (gained - velocity).norm();
            assert!(
                off < 1e-3 * (0.1 + velocity.norm()),
                "{name}: {gained} {velocity}"
            );
            // Single precision knows places to 1e-7 m.
            let off = (moved - position).norm();
            let known = 2e-7 / (strength * dt * dt);
            assert!(
                off < known + 1e-3 * position.norm(),
                "{name}: {moved} {position}"
            );
        }
    }
}
