//! Links of multibody joints feel flexible bodies and push back: what the whole keeps.

use crate::common::*;
use crate::support::join;
use foil2d::pipeline::StepError;

/// Two hinged bars of 2 kg that rest in free space.
fn bars(scene: &mut Scene) -> [RigidBodyHandle; 2] {
    let bars = [0.0, 1.0].map(|x| {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(x, 0.0))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.45), real(0.1)).density(real(2.0 / 0.18));
        scene.world.insert(body, shape).0
    });
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.5, 0.0))
        .local_anchor2(vec2(-0.5, 0.0));
    let joints = &mut scene.world.multibody_joints;
    let handle = joints
        .insert(bars[0], bars[1], hinge, true)
        .expect("a joint");
    // Rapier brakes all that turns in a multibody, its root against space.
    let (multibody, _) = joints.get_mut(handle).expect("it is there");
    multibody.damping_mut().fill(0.0);
    bars
}

/// A block of 9 kg with this velocity.
fn block(scene: &mut Scene, stiffness: f64, at: [f64; 2], velocity: [f64; 2]) -> FlexBodyHandle {
    scene.flexible(
        FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3])
            .material(
                LinearElastic::plane_stress(stiffness, 0.3)
                    .density(100.0)
                    .rayleigh(1e-4),
            )
            .translation(at)
            .linvel(velocity),
    )
}

/// Velocity and spin of a link's centre as its joints move: rapier's copy in the body is a substep behind.
fn velocity(scene: &Scene, body: RigidBodyHandle) -> [f64; 3] {
    let joints = &scene.world.multibody_joints;
    let Some(id) = joints.rigid_body_link(body) else {
        let body = &scene.world.bodies[body];
        let (along, spin) = (body.linvel(), body.angvel());
        return [along.x, along.y, spin].map(f64::from);
    };
    let multibody = joints.get_multibody(id.multibody).expect("it is there");
    let (jacobian, rates) = (
        multibody.body_jacobian(id.id),
        multibody.generalized_velocity(),
    );
    [0, 1, 2].map(|axis| {
        let terms = jacobian.row(axis).into_iter().zip(rates.iter());
        terms.map(|(j, v)| f64::from(*j) * f64::from(*v)).sum()
    })
}

/// Linear momentum, angular momentum about the origin and kinetic energy.
#[derive(Clone, Copy, Default)]
struct Kept {
    linear: [f64; 2],
    angular: f64,
    energy: f64,
}

/// What rigid bodies have.
fn of_rigid(scene: &Scene, bodies: &[RigidBodyHandle]) -> Kept {
    bodies.iter().fold(Kept::default(), |sum, &handle| {
        let body = &scene.world.bodies[handle];
        let ([x, y, spin], centre) = (velocity(scene, handle), body.center_of_mass());
        let mass = f64::from(body.mass());
        let inertia = 1.0 / f64::from(body.mass_properties().effective_world_inv_inertia);
        let lever = f64::from(centre.x) * y - f64::from(centre.y) * x;
        Kept {
            linear: [sum.linear[0] + mass * x, sum.linear[1] + mass * y],
            angular: sum.angular + mass * lever + inertia * spin,
            energy: sum.energy + 0.5 * (mass * (x * x + y * y) + inertia * spin * spin),
        }
    })
}

/// What flexible bodies and links have.
fn of_all(scene: &Scene, links: &[RigidBodyHandle]) -> Kept {
    let flexible = scene.bodies.iter();
    flexible.fold(of_rigid(scene, links), |sum, (_, body)| {
        let ([x, y], energy) = (body.momentum(), body.energy());
        Kept {
            linear: [sum.linear[0] + x, sum.linear[1] + y],
            angular: sum.angular + body.angular_momentum([0.0; 2]),
            energy: sum.energy + energy.kinetic + energy.elastic,
        }
    })
}

/// Largest change of linear momentum over a second (N s), and whether something touched a link.
fn drift(scene: &mut Scene, links: &[RigidBodyHandle]) -> (f64, bool) {
    scene.step();
    let start = of_all(scene, links).linear;
    let (mut worst, mut moves) = (0.0f64, false);
    for _ in 0..(1.0 / scene.dt()).round() as usize {
        scene.step();
        let now = of_all(scene, links);
        worst = worst.max((now.linear[0] - start[0]).abs());
        worst = worst.max((now.linear[1] - start[1]).abs());
        moves |= of_rigid(scene, links).energy > 1e-3;
    }
    (worst, moves)
}

/// Momentum that rounding may cost (N s) of one of 9 N s: rapier takes forces and keeps velocities in its own precision, so every step
/// of a hundred rounds once.
fn rounding() -> f64 {
    // A body of large strain knows its velocities as far as its positions in the world: `ε x / dt`.
    9.0 * by_precision(100.0 * 6e-8, 2e-12)
}

#[test]
fn a_block_and_the_multibody_that_it_hits_keep_their_momentum_in_every_step() {
    // Head-on, so that nothing turns: soft impacts that the step resolves, and hard ones that it does not.
    for stiffness in [1e5, 1e6, 1e8] {
        for rate in [60.0, 120.0, 480.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            let bars = bars(&mut scene);
            block(&mut scene, stiffness, [1.5, -0.15], [-1.0, 0.0]);
            let (worst, moves) = drift(&mut scene, &bars);
            assert!(moves, "they meet");
            assert!(worst < rounding(), "{stiffness} at {rate} Hz: {worst}");
        }
    }
}

#[test]
fn links_that_are_hit_and_turn_keep_momentum_and_angular_momentum() {
    for rate in [60.0, 120.0, 240.0, 480.0] {
        let mut scene = Scene::in_free_space(1.0 / rate);
        let bars = bars(&mut scene);
        block(&mut scene, 1e6, [0.9, 0.15], [0.0, -1.0]);
        scene.step();
        let start = of_all(&scene, &bars);
        scene.steps(rate as usize);
        let end = of_all(&scene, &bars);
        // Measured 1e-7 N s and 1e-7 N m s (`f32`); rapier alone, for as long again, 1e-3 to 3e-4 and 4e-4 to 1e-4.
        for axis in [0, 1] {
            let missed = (end.linear[axis] - start.linear[axis]).abs();
            assert!(missed < rounding(), "{rate} Hz: {missed} N s");
        }
        let turned = (end.angular - start.angular).abs();
        assert!(
            turned < by_precision(1e-5, 1e-8),
            "{rate} Hz: {turned} N m s"
        );
        // Impacts lose, and nothing gains.
        assert!(end.energy < start.energy, "{} J", end.energy);
    }
}

/// Momentum of everything in the scene along x (N s).
fn along_x(scene: &Scene) -> f64 {
    let carriers: Vec<RigidBodyHandle> = scene
        .bodies
        .iter()
        .map(|(_, body)| body.rigid_body_handle())
        .collect();
    let rigid = scene.world.bodies.iter().map(|(handle, _)| handle);
    let rigid: Vec<RigidBodyHandle> = rigid.filter(|one| !carriers.contains(one)).collect();
    let flexible = scene.bodies.iter();
    let flexible: f64 = flexible
        .map(|(_, body)| body.mass() * body.linvel()[0])
        .sum();
    of_rigid(scene, &rigid).linear[0] + flexible
}

#[test]
fn what_lies_between_a_block_and_a_link_hands_on_all_of_it() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let bars = bars(&mut scene);
    let body = RigidBodyBuilder::dynamic().translation(vec2(1.6, 0.0));
    scene.rigid(body, ColliderBuilder::cuboid(0.1, 0.1).density(50.0));
    block(&mut scene, 1e6, [1.75, -0.15], [-1.0, 0.0]);
    for step in 0..240 {
        scene.step();
        let change = (along_x(&scene) + 9.0).abs();
        assert!(change < rounding(), "step {step}: {change} N s");
    }
    let pushed = of_rigid(&scene, &bars).linear[0];
    assert!(pushed < -1.0, "{pushed} N s");
}

#[test]
fn an_impulse_joint_from_a_claimed_body_to_a_link_pulls_both() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let bars = bars(&mut scene);
    let body = RigidBodyBuilder::dynamic().translation(vec2(1.6, 0.5));
    let (hung, _) = scene.rigid(body, ColliderBuilder::cuboid(0.1, 0.1).density(50.0));
    let anchors = [vec2(0.45, 0.0), vec2(-0.15, -0.5)];
    let hinge = RevoluteJointBuilder::new()
        .contacts_enabled(false)
        .local_anchor1(anchors[0])
        .local_anchor2(anchors[1]);
    let joint = join(&mut scene, bars[1], hung, hinge);
    block(&mut scene, 1e6, [1.75, 0.35], [-1.0, 0.0]);
    for step in 0..60 {
        scene.step();
        let change = (along_x(&scene) + 9.0).abs();
        assert!(change < rounding(), "step {step}: {change} N s");
        let ends = [(bars[1], anchors[0]), (hung, anchors[1])];
        let ends = ends.map(|(body, at)| scene.world.bodies[body].position() * at);
        let missed = f64::from((ends[0] - ends[1]).length());
        // A blow of some kN on 13 kg opens it by 1e-5 of the way that it would send them in the step.
        assert!(missed < by_precision(1e-6, 5e-8), "step {step}: {missed} m");
    }
    let pulled = of_rigid(&scene, &bars).linear[0];
    assert!(pulled < -0.5, "{pulled} N s");
    let axes = scene.world.impulse_joints.get(joint).expect("it is there");
    assert_eq!(axes.data.locked_axes, JointAxesMask::LOCKED_REVOLUTE_AXES);
}

#[test]
fn attachments_to_links_pull_back() {
    let kinds: [fn(FlexBodyHandle) -> AttachmentBuilder; 3] =
        [AttachmentBuilder::pin, AttachmentBuilder::weld, |body| {
            AttachmentBuilder::spring_damper(body, 1e4, 0.0)
        }];
    for (kind, make) in kinds.into_iter().enumerate() {
        let mut scene = Scene::in_free_space(1.0 / 120.0);
        let bars = bars(&mut scene);
        let block = block(&mut scene, 1e6, [1.5, -0.15], [1.0, 0.0]);
        let held = make(block)
            .where_(|[x, y]| x < 0.01 && (0.05..0.25).contains(&y))
            .to_rigid_body(bars[1]);
        let attached = scene.bodies.attach(held, &scene.world.bodies);
        attached.expect("the description is right");
        let (worst, moves) = drift(&mut scene, &bars);
        assert!(moves, "the bars are pulled");
        assert!(worst < rounding(), "{kind}: {worst} N s");
    }
}

#[test]
fn the_users_forces_on_a_link_survive_every_step_to_the_last_bit() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let bars = bars(&mut scene);
    block(&mut scene, 1e6, [1.46, -0.15], [-1.0, 0.0]);
    let (force, torque) = (vec2(0.1, -0.3), real(0.7));
    let link = &mut scene.world.bodies[bars[1]];
    link.add_force(force, true);
    link.add_torque(torque, true);
    let kept = |scene: &Scene| {
        let link = &scene.world.bodies[bars[1]];
        assert_eq!((link.user_force(), link.user_torque()), (force, torque));
    };
    let mut touches = false;
    for _ in 0..60 {
        let is_near = !scene.step().contacts().is_empty();
        touches |= is_near;
        kept(&scene);
        let gravity = std::mem::replace(&mut scene.world.gravity, vec2(f64::NAN, 0.0));
        assert!(scene.try_step().is_err(), "gravity is no number");
        scene.world.gravity = gravity;
        if is_near {
            scene.world.bodies[bars[0]].add_torque(real(f64::NAN), true);
            let error = scene.try_step().expect_err("a torque is no number");
            assert!(matches!(error, StepError::RigidBody(_)), "{error}");
            scene.world.bodies[bars[0]].reset_torques(true);
        }
        kept(&scene);
    }
    assert!(touches, "they meet");
}

#[test]
fn a_multibody_that_meets_nothing_flexible_goes_its_way_to_the_last_bit() {
    // Far from everything, or met by what it dominates.
    for (at, dominance) in [(30.0, 0), (1.5, 1)] {
        let (mut alone, mut scene) = (
            Scene::in_free_space(1.0 / 120.0),
            Scene::in_free_space(1.0 / 120.0),
        );
        let (theirs, ours) = (bars(&mut alone), bars(&mut scene));
        for (scene, bars) in [(&mut alone, theirs), (&mut scene, ours)] {
            for bar in bars {
                scene.world.bodies[bar].set_dominance_group(dominance);
            }
            scene.world.bodies[bars[0]].add_force(vec2(0.0, 0.1), true);
        }
        block(&mut scene, 1e6, [at, -0.15], [-1.0, 0.0]);
        for step in 0..120 {
            alone.world.step();
            scene.step();
            for (&one, &other) in ours.iter().zip(&theirs) {
                let (one, other) = (&scene.world.bodies[one], &alone.world.bodies[other]);
                assert_eq!(one.position(), other.position(), "step {step}");
                assert_eq!(one.linvel(), other.linvel(), "step {step}");
            }
        }
    }
}
