//! Links of one multibody that press flexible bodies together, or carry one.

use crate::common::*;

fn material(young: f64) -> LinearElastic {
    LinearElastic::plane_stress(young, 0.3)
        .density(600.0)
        .rayleigh(5e-3)
}

fn of_strain(body: FlexBodyBuilder, is_large: bool) -> FlexBodyBuilder {
    match is_large {
        true => body.large_strain(),
        false => body.small_strain(),
    }
}

/// Two boxes on one hinge that are laid on a slab, a little above it.
#[test]
fn links_of_one_multibody_lie_on_a_flexible_slab() {
    for (young, is_large) in [(1e6, true), (1e8, true), (1e8, false), (1e10, false)] {
        for above in [0.0, 1e-3, 0.05] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.6);
            let slab = FlexBodyBuilder::rectangle([3.0, 0.5], [18, 4])
                .material(material(young))
                .translation([-1.5, 0.0])
                .friction(0.7);
            scene.flexible(of_strain(slab, is_large));
            let links = [(-0.3, 0.62, 0.3, 0.12, 35.0), (0.3, 0.55, 0.28, 0.05, 9.0)];
            let links = links.map(|(x, y, width, height, mass)| {
                let body = RigidBodyBuilder::dynamic().translation(vec2(x, y + above));
                let shape = ColliderBuilder::cuboid(real(width), real(height)).mass(real(mass));
                scene.rigid(body, shape.friction(0.7)).0
            });
            let hinge = RevoluteJointBuilder::new()
                .local_anchor1(vec2(0.3, -0.07))
                .local_anchor2(vec2(-0.3, 0.0))
                .contacts_enabled(false);
            let joints = &mut scene.world.multibody_joints;
            joints
                .insert(links[0], links[1], hinge, true)
                .expect("two bodies on one hinge");
            let start = energy_of(&scene);
            let brought = 44.0 * G * above;
            for step in 0..240 {
                scene.try_step().expect("the step can be taken");
                let gained = energy_of(&scene) - start;
                let name = format!("E {young:e}, large {is_large}, {above} m, step {step}");
                assert!(gained < 0.01 * brought + 0.1, "{name}: {gained} J");
                assert!(scene.report().gap_violation() < 0.03, "{name}");
            }
            for (link, height) in links.into_iter().zip([0.62, 0.55]) {
                let body = &scene.world.bodies[link];
                let name = format!("E {young:e}, large {is_large}, {above} m");
                // A soft slab gives way by some millimetres.
                let off = f64::from(body.translation().y) - height;
                assert!(off < 2e-3 && off > -5e-3, "{name}: {off} m");
                assert!(body.linvel().length() < 1e-3, "{name}: {}", body.linvel());
            }
        }
    }
}

/// A link that a motor holds, with a flexible pad heavier than itself welded to it, touches nothing: it comes to rest under the weight.
#[test]
fn a_link_that_a_motor_holds_carries_a_heavier_flexible_body() {
    for (young, is_large) in [(1e6, true), (1e7, true), (1e7, false)] {
        for rate in [60.0, 240.0] {
            let mut scene = Scene::new(1.0 / rate);
            let base = scene.world.insert_body(RigidBodyBuilder::fixed());
            let shape = ColliderBuilder::cuboid(0.25, 0.05).mass(3.0);
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.25, 0.0));
            let (link, _) = scene.rigid(body, shape);
            let hinge = RevoluteJointBuilder::new()
                .local_anchor2(vec2(-0.25, 0.0))
                .motor_model(MotorModel::ForceBased)
                .motor_position(0.0, 3000.0, 300.0);
            let joints = &mut scene.world.multibody_joints;
            joints
                .insert(base, link, hinge, true)
                .expect("a body on a hinge");
            let pad = FlexBodyBuilder::rectangle([0.2, 0.1], [6, 3])
                .material(
                    LinearElastic::plane_stress(young, 0.3)
                        .density(250.0)
                        .rayleigh(1e-3),
                )
                .translation([0.5, -0.05]);
            let pad = scene.flexible(of_strain(pad, is_large));
            let weld = AttachmentBuilder::weld(pad).where_(|[x, _]| x < 1e-9);
            let weld = scene
                .bodies
                .attach(weld.to_rigid_body(link), &scene.world.bodies)
                .expect("an edge of the pad");
            for _ in 0..(4.0 * rate) as usize {
                scene.try_step().expect("the step can be taken");
            }
            let name = format!("E {young:e}, large {is_large}, {rate} Hz");
            let speed = scene.body(pad).linvel();
            assert!(speed[0].hypot(speed[1]) < 1e-3, "{name}: {speed:?}");
            let held = scene.bodies.attachment(weld).expect("it is there").force()[1];
            let weight = 5.0 * G;
            assert!(
                (held / weight - 1.0).abs() < 0.01,
                "{name}: {held} N of {weight}"
            );
        }
    }
}

/// A truck whose wheels are links drives from the ground onto a stiff deck: what holds a wheel from below lets it go up.
#[test]
fn a_truck_of_links_drives_onto_a_flexible_deck() {
    for (young, is_large) in [(2e9, true), (2e9, false), (2e8, true)] {
        let mut scene = Scene::new(1.0 / 60.0);
        for (from, to) in [(-12.0, 0.0), (8.0, 60.0)] {
            let ground = ColliderBuilder::cuboid(real(0.5 * (to - from)), 0.5)
                .translation(vec2(0.5 * (from + to), -0.5));
            scene.fixed(ground.friction(1.0));
        }
        let deck = FlexBodyBuilder::rectangle([7.98, 0.3], [48, 3])
            .material(
                LinearElastic::plane_stress(young, 0.2)
                    .density(1000.0)
                    .rayleigh(2e-3),
            )
            .friction(1.0)
            .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x > 7.97), Pin::both())
            .translation([0.01, -0.3]);
        scene.flexible(of_strain(deck, is_large));
        let chassis = RigidBodyBuilder::dynamic().translation(vec2(-1.8, 0.9));
        let shape = ColliderBuilder::cuboid(1.4, real(0.2)).mass(300.0);
        let (chassis, _) = scene.rigid(chassis, shape);
        for x in [-1.0, 1.0] {
            let wheel = RigidBodyBuilder::dynamic().translation(vec2(-1.8 + x, 0.4));
            let shape = ColliderBuilder::ball(real(0.4)).mass(30.0).friction(1.0);
            let (wheel, _) = scene.rigid(wheel, shape);
            let axle = RevoluteJointBuilder::new()
                .local_anchor1(vec2(x, -0.5))
                .motor_model(MotorModel::ForceBased)
                .motor_velocity(-6.0, 100.0)
                .motor_max_force(300.0)
                .contacts_enabled(false);
            let joints = &mut scene.world.multibody_joints;
            joints
                .insert(chassis, wheel, axle, true)
                .expect("a wheel and its axle");
        }
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..300 {
            scene.try_step().expect("the step can be taken");
            highest = highest.max(f64::from(scene.world.bodies[chassis].translation().y));
        }
        let at = scene.world.bodies[chassis].translation();
        let name = format!("E {young:e}, large {is_large}: {at}, at most {highest} m high");
        assert!(highest < 0.93 && at.x > 8.0, "{name}");
    }
}
