//! Bodies of large strain that are held by more than they rest on: chains of strips and links, fingers that press. They gain nothing, come to
//! rest, and tell the forces that act.

mod common;

use common::*;

fn soft(young: f64, damping: f64) -> LinearElastic {
    let material = LinearElastic::plane_strain(young, 0.3).density(1000.0);
    material.rayleigh(damping)
}

fn attach(scene: &mut Scene, builder: AttachmentBuilder) {
    let attached = scene.bodies.attach(builder, &scene.world.bodies);
    attached.expect("nodes and bodies exist");
}

/// Strips of .3 x .03 m and links of .3 kg by turns, hinged to each other and to the world, and one of 3 kg at the end; returns the energy that gravity
/// can bring (J).
fn chain(scene: &mut Scene, n: usize, young: f64) -> f64 {
    let (mut x, mut brought) = (0.0, 0.0);
    let mut last: Option<RigidBodyHandle> = None;
    for strip in 0..n {
        let builder = FlexBodyBuilder::rectangle([0.3, 0.03], [8, 1])
            .thickness(0.03)
            .material(soft(young, 1e-4))
            .collision_groups(InteractionGroups::none())
            .translation([x, -0.015]);
        let body = scene.flexible(builder);
        brought += G * scene.body(body).mass() * (x + 0.15);
        let begin = AttachmentBuilder::pin(body).where_(|[x, _]| x < 1e-9);
        let begin = match last {
            Some(link) => begin.to_rigid_body(link),
            None => begin.to_world(),
        };
        attach(scene, begin);
        x += 0.3;
        let (off, mass) = if strip + 1 == n {
            (0.1, 3.0)
        } else {
            (0.06, 0.3)
        };
        let shape = ColliderBuilder::cuboid(real(0.055), real(0.02)).mass(real(mass));
        let link = RigidBodyBuilder::dynamic().translation(vec2(x + off, 0.0));
        let shape = shape.collision_groups(InteractionGroups::none());
        let (link, _) = scene.rigid(link, shape);
        let end = AttachmentBuilder::pin(body).where_(|[x, _]| x > 0.3 - 1e-9);
        attach(scene, end.to_rigid_body(link));
        brought += G * mass * (x + off);
        x += 0.12;
        last = Some(link);
    }
    brought
}

/// Let go level, a chain swings down and never has more energy than it began with, to a hundredth of what gravity brings. As forces act wholly within their step, what joints give in one
/// is not owed to another.
#[test]
fn a_chain_of_strips_and_links_gains_no_energy() {
    for (n, young, rate) in [
        (6, 2e7, 60.0),
        (2, 2e6, 30.0),
        (4, 2e6, 30.0),
        (6, 2e6, 60.0),
    ] {
        let mut scene = Scene::new(1.0 / rate);
        let brought = chain(&mut scene, n, young);
        let name = format!("{n} strips, E {young:e}, {rate} Hz");
        let start = energy_of(&scene);
        let (mut most, mut least) = (0.0f64, 0.0f64);
        for _ in 0..(2.5 * rate) as usize {
            scene.step();
            let gain = energy_of(&scene) - start;
            (most, least) = (most.max(gain), least.min(gain));
        }
        assert!(most < 0.01 * brought, "{name}: {most} J of {brought}");
        assert!(least > -0.5 * brought, "{name}: {least} J of {brought}");
    }
}

/// Two soft fingers, welded to jaws, that press a box from both sides by a fifth of their thickness: a state that is held by contact and welds alone,
/// where the stiffness of what is compressed is indefinite.
#[test]
fn fingers_that_press_a_box_come_to_rest() {
    for (squeeze, rate) in [(0.006, 60.0), (0.012, 60.0), (0.006, 30.0)] {
        let mut scene = Scene::new(1.0 / rate);
        let part = RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.07))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.05), real(0.05)).mass(real(2.0));
        let (part, _) = scene.rigid(part, shape.friction(real(0.6)));
        let mut jaws = Vec::new();
        for side in [-1.0, 1.0] {
            let jaw = RigidBodyBuilder::kinematic_position_based();
            let jaw = scene
                .world
                .insert_body(jaw.translation(vec2(0.1 * side, 0.07)));
            let inner = if side < 0.0 { -0.085 } else { 0.055 };
            let finger = FlexBodyBuilder::rectangle([0.03, 0.1], [4, 12])
                .material(
                    LinearElastic::plane_strain(5e5, 0.4)
                        .density(1000.0)
                        .rayleigh(5e-3),
                )
                .friction(0.6)
                .translation([inner, 0.02]);
            let finger = scene.flexible(finger);
            let back = if side < 0.0 { 0.0 } else { 0.03 };
            let weld =
                AttachmentBuilder::weld(finger).where_(move |[x, _]| (x - back).abs() < 1e-9);
            attach(&mut scene, weld.to_rigid_body(jaw));
            jaws.push((jaw, side));
        }
        let support = scene
            .fixed(ColliderBuilder::cuboid(real(0.05), real(0.01)).translation(vec2(0.0, 0.01)));
        let name = format!("{squeeze} m at {rate} Hz");
        for step in 0..(4.0 * rate) as usize {
            let share = (step as f64 / rate * 2.0).min(1.0);
            for (jaw, side) in &jaws {
                let x = side * (0.1 - (0.005 + squeeze) * share);
                scene.world.bodies[*jaw].set_next_kinematic_translation(vec2(x, 0.07));
            }
            if step as f64 == rate {
                let removed = scene.world.remove_collider(support);
                assert!(removed.is_some());
            }
            let report = scene.step();
            if step as f64 > 3.0 * rate {
                assert!(is_solved(report), "{name}");
                assert!(report.energy_limited() < 1e-6, "{name}");
            }
        }
        let speed = velocity_of(&scene.world.bodies[part])[1].abs();
        assert!(speed < 1e-6, "{name}: the box moves at {speed} m/s");
        let sunk = place_of(&scene.world.bodies[part])[1] - 0.07;
        assert!(sunk.abs() < 5e-3, "{name}: the box has sunk by {sunk} m");
    }
}

/// A finger that a motor presses to a wall with 17.5 N, whose hand starts to move along the wall at once. What the energy stage takes back is
/// taken from what moves: the wall does not, however hard it is pressed, and no force is told that does not act.
#[test]
fn a_finger_that_is_dragged_along_a_wall_tells_the_forces_that_act() {
    for young in [1e6, 1e8] {
        let mut scene = Scene::in_free_space(1.0 / 120.0);
        let wall = ColliderBuilder::cuboid(real(0.05), real(0.05)).friction(real(0.6));
        scene.fixed(wall.translation(vec2(0.05, 0.05)));
        let hand = RigidBodyBuilder::kinematic_velocity_based().translation(vec2(0.0, 0.3));
        let hand = scene.world.insert_body(hand);
        let properties = MassProperties::new(vec2(0.0, 0.0), real(0.5), real(0.001));
        let jaw = RigidBodyBuilder::dynamic()
            .translation(vec2(-0.05, 0.07))
            .additional_mass_properties(properties);
        let jaw = scene.world.insert_body(jaw);
        let slide = PrismaticJointBuilder::new(vec2(1.0, 0.0))
            .local_anchor1(vec2(-0.05, -0.23))
            .motor_velocity(real(0.2), real(1e4))
            .motor_max_force(real(17.5));
        scene.world.impulse_joints.insert(hand, jaw, slide, true);
        let finger = FlexBodyBuilder::rectangle([0.03, 0.1], [4, 12])
            .material(
                LinearElastic::plane_strain(young, 0.4)
                    .density(1000.0)
                    .rayleigh(5e-3),
            )
            .friction(0.6)
            .translation([-0.035, 0.02]);
        let finger = scene.flexible(finger);
        let weld = AttachmentBuilder::weld(finger).where_(|[x, _]| x < 1e-9);
        attach(&mut scene, weld.to_rigid_body(jaw));
        scene.steps(60);
        scene.world.bodies[hand].set_linvel(vec2(0.0, 0.2), true);
        let (mut told, mut worst) = ([0.0; 2], 0.0f64);
        for _ in 0..12 {
            scene.step();
            let body = scene.body(finger);
            let force = body.total_contact_force();
            for axis in 0..2 {
                told[axis] += scene.dt() * force[axis];
            }
            let pressed: f64 = (scene.report().contacts().iter())
                .map(|contact| contact.normal_force)
                .sum();
            worst = worst.max(pressed.abs());
            // Nothing else acts on the finger.
            let body = scene.body(finger);
            let moves = body.linvel().map(|v| v * body.mass());
            let miss = (told[0] - moves[0]).abs().max((told[1] - moves[1]).abs());
            assert!(miss < 1e-3, "E {young:e}: {told:?} N s told, {moves:?} had");
        }
        // All that moves, 3.5 kg at .4 m/s, stopped within a step, at the very most.
        assert!(worst < 200.0, "E {young:e}: {worst} N");
    }
}

/// A soft block and a box that a plate presses against another until there is no room: steps end where surfaces were stopped, and the report tells the overlap
/// that is there, not the one where forces would have led.
#[test]
fn what_is_crushed_flat_is_told_as_deep_as_it_is() {
    let mut scene = Scene::new(1.0 / 60.0);
    let plate = RigidBodyBuilder::kinematic_position_based().translation(vec2(0.0, -0.1));
    let shape = ColliderBuilder::cuboid(real(4.0), real(0.1));
    let (plate, _) = scene.rigid(plate, shape.clone());
    scene.fixed(shape.translation(vec2(0.0, 1.1)));
    let material = LinearElastic::plane_strain(1e6, 0.45).density(1000.0);
    let block = FlexBodyBuilder::rectangle([0.5, 0.5], [5, 5]).material(material.rayleigh(1e-2));
    scene.flexible(block.translation([0.0, 0.01]));
    let part = RigidBodyBuilder::dynamic().translation(vec2(0.72, 0.2));
    scene.rigid(part, ColliderBuilder::cuboid(real(0.2), real(0.2)));
    let mut onlooker = Onlooker::default();
    for step in 0..120 {
        let height = (0.5 * f64::from(step + 1) / 60.0).min(0.75);
        let place = vec2(0.0, height - 0.1);
        scene.world.bodies[plate].set_next_kinematic_translation(place);
        onlooker.step(&mut scene);
        let told = scene.report().gap_violation();
        assert!(told < 0.5, "step {step}: {told} m told");
    }
    let seen = onlooker.overlap();
    println!(
        "{} of 120 steps not solved; {} m deep, told {} m",
        onlooker.n_unsolved(),
        seen.depth,
        onlooker.told
    );
    assert!(
        seen.depth < 3.0 * onlooker.told,
        "{} m deep, told {} m",
        seen.depth,
        onlooker.told
    );
}
