//! Multibodies that something flexible is held by: they move as the same thing does on impulse joints, and by what only multibodies have as rapier alone
//! moves them.

use crate::common::*;
use foil2d::pipeline::StepError;

/// A bar of a mass (kg) from one point to another.
fn bar(scene: &mut Scene, [from, to]: [[f64; 2]; 2], mass: f64) -> RigidBodyHandle {
    let way = [to[0] - from[0], to[1] - from[1]];
    let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(middle[0], middle[1]))
        .rotation(real(way[1].atan2(way[0])));
    let half = 0.5 * way[0].hypot(way[1]);
    let shape = ColliderBuilder::cuboid(real(half), 0.02)
        .mass(real(mass))
        .collision_groups(InteractionGroups::none());
    scene.rigid(body, shape).0
}

/// Welds a pad of a mass (kg) to the middle of a link, where it touches nothing.
fn pad_on(scene: &mut Scene, link: RigidBodyHandle, mass: f64) {
    let at = scene.world.bodies[link].translation();
    let [x, y] = [f64::from(at.x), f64::from(at.y)];
    let soft = LinearElastic::plane_stress(1e6, 0.3).density(mass / 0.01);
    let pad = FlexBodyBuilder::rectangle([0.1, 0.1], [2, 2])
        .material(soft.rayleigh(1e-3))
        .collision_groups(InteractionGroups::none())
        .translation([x - 0.05, y - 0.05]);
    let pad = scene.flexible(pad);
    let weld = AttachmentBuilder::weld(pad)
        .where_(|_| true)
        .to_rigid_body(link);
    let attached = scene.bodies.attach(weld, &scene.world.bodies);
    attached.expect("all nodes of the pad");
}

/// Joins two bodies, by an impulse joint or as a link without damping; of the joint its handle as a link.
fn join(
    scene: &mut Scene,
    [first, second]: [RigidBodyHandle; 2],
    joint: impl Into<GenericJoint>,
    is_link: bool,
) -> Option<MultibodyJointHandle> {
    if !is_link {
        scene
            .world
            .impulse_joints
            .insert(first, second, joint, true);
        return None;
    }
    let joints = &mut scene.world.multibody_joints;
    let handle = joints.insert(first, second, joint, true).expect("a joint");
    let (multibody, _) = joints.get_mut(handle).expect("it is there");
    multibody.damping_mut().fill(0.0);
    Some(handle)
}

/// Angle between two bodies (rad).
fn turn_between(one: &RigidBody, other: &RigidBody) -> f64 {
    let turn = one.rotation().inverse() * *other.rotation();
    f64::from(turn.angle().abs())
}

/// By how much the velocity and spin that the joints of a link say differ from those of its body (m/s or rad/s).
fn velocity_missed(scene: &Scene, link: RigidBodyHandle) -> f64 {
    let joints = &scene.world.multibody_joints;
    let id = joints.rigid_body_link(link).expect("a link");
    let multibody = joints.get_multibody(id.multibody).expect("it is there");
    let rates = multibody.generalized_velocity();
    let said = multibody.body_jacobian(id.id) * rates;
    let body = &scene.world.bodies[link];
    let own = [body.linvel().x, body.linvel().y, body.angvel()];
    let missed = said
        .iter()
        .zip(own)
        .map(|(said, own)| f64::from((said - own).abs()));
    missed.fold(0.0, f64::max)
}

/// A mechanism with a pad on it; its moving bodies.
type Mechanism = fn(&mut Scene, bool) -> Vec<RigidBodyHandle>;

/// Three bars hinged to each other and to the world, one with limits, one driven.
fn arm(scene: &mut Scene, is_link: bool) -> Vec<RigidBodyHandle> {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    // Where a multibody is built all its coordinates are zero.
    let points = [[0.0, 0.0], [0.5, 0.0], [0.9, 0.0], [1.3, 0.0]];
    let bars = [0, 1, 2].map(|i| bar(scene, [points[i], points[i + 1]], 1.0 + i as f64));
    let half = |i: usize| {
        let [a, b] = [points[i], points[i + 1]];
        0.5 * (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let hinge = |from: f64, to: f64| {
        RevoluteJointBuilder::new()
            .local_anchor1(vec2(from, 0.0))
            .local_anchor2(vec2(-to, 0.0))
            .contacts_enabled(false)
    };
    let driven = hinge(0.0, half(0))
        .motor_model(MotorModel::ForceBased)
        .motor_velocity(2.0, 1e4)
        .motor_max_force(15.0);
    join(scene, [base, bars[0]], driven, is_link);
    let limited = hinge(half(0), half(1)).limits([-0.3, 0.5]);
    join(scene, [bars[0], bars[1]], limited, is_link);
    join(scene, [bars[1], bars[2]], hinge(half(1), half(2)), is_link);
    pad_on(scene, bars[2], 0.5);
    bars.to_vec()
}

/// A carriage on a rail with a motor that holds a place, and a pendulum on it.
fn carriage(scene: &mut Scene, is_link: bool) -> Vec<RigidBodyHandle> {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let carriage = bar(scene, [[-0.2, 0.0], [0.2, 0.0]], 2.0);
    let hanging = bar(scene, [[0.0, 0.0], [0.6, 0.0]], 1.0);
    let rail = PrismaticJointBuilder::new(vec2(1.0, 0.0))
        .motor_model(MotorModel::ForceBased)
        .motor_position(0.3, 200.0, 5.0)
        .limits([-0.05, 0.4]);
    join(scene, [base, carriage], rail, is_link);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-0.3, 0.0));
    join(scene, [carriage, hanging], hinge, is_link);
    pad_on(scene, hanging, 1.0);
    vec![carriage, hanging]
}

/// A bar on a hinge, and a slider along it beside its middle.
fn slide(scene: &mut Scene, is_link: bool) -> Vec<RigidBodyHandle> {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let turning = bar(scene, [[0.0, 0.0], [0.8, 0.0]], 1.0);
    let slider = bar(scene, [[0.2, 0.1], [0.4, 0.1]], 1.0);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-0.4, 0.0));
    join(scene, [base, turning], hinge, is_link);
    let rail = PrismaticJointBuilder::new(vec2(1.0, 0.0))
        .local_anchor1(vec2(-0.1, 0.05))
        .local_anchor2(vec2(0.0, -0.05));
    join(scene, [turning, slider], rail, is_link);
    pad_on(scene, slider, 1.0);
    vec![turning, slider]
}

/// Two bars that are free and turn, built turned.
fn free(scene: &mut Scene, is_link: bool) -> Vec<RigidBodyHandle> {
    let body = RigidBodyBuilder::dynamic().rotation(0.4);
    let shape = ColliderBuilder::cuboid(0.2, 0.05)
        .mass(2.0)
        .collision_groups(InteractionGroups::none());
    let first = scene.rigid(body, shape).0;
    let (sin, cos) = 0.4f64.sin_cos();
    let ends = [0.2, 0.8].map(|along| [along * cos, along * sin]);
    let second = bar(scene, ends, 1.0);
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.2, 0.0))
        .local_anchor2(vec2(-0.3, 0.0));
    join(scene, [first, second], hinge, is_link);
    pad_on(scene, second, 3.0);
    scene.world.bodies[first].add_torque(2.0, true);
    vec![first, second]
}

#[test]
fn multibodies_move_as_the_same_thing_on_impulse_joints() {
    // What is free also falls: by 5 m, on which errors of the solver add up.
    let all: [(&str, Mechanism, f64); 4] = [
        ("arm", arm, 0.0),
        ("carriage", carriage, 0.0),
        ("slide", slide, 0.0),
        ("free", free, 5e-6),
    ];
    for (name, make, double) in all {
        for rate in [60.0, 240.0] {
            let [mut one, mut other] = [Scene::new(1.0 / rate), Scene::new(1.0 / rate)];
            let (links, bodies) = (make(&mut one, true), make(&mut other, false));
            let mut apart = 0.0f64;
            for _ in 0..rate as usize {
                one.step();
                other.step();
                for (&link, &body) in links.iter().zip(&bodies) {
                    let [link, body] = [&one.world.bodies[link], &other.world.bodies[body]];
                    let way = f64::from((link.translation() - body.translation()).length());
                    let turn = turn_between(link, body);
                    apart = apart.max(way).max(turn);
                }
                for &link in &links {
                    let missed = velocity_missed(&one, link);
                    let speed = f64::from(one.world.bodies[link].linvel().length());
                    // Ends that are open by 1e-8 m turn.
                    let rounding = by_precision(4e-6, 1e-9) * (1.0 + speed);
                    assert!(missed < rounding, "{name}, {rate} Hz: {missed} m/s");
                }
            }
            // Both are solved by the same rows; rapier keeps the one in coordinates of joints, to its own rounding, and these do not open. What stops
            // 2 m/s within the step opens a joint by 1e-5 of the half of that way.
            let opened = 1e-5 * 0.5 * 2.5 / rate;
            let rounding = by_precision(2e-5, double + opened);
            assert!(apart < rounding, "{name}, {rate} Hz: {apart}");
        }
    }
}

/// A multibody of one or two links and what is asked of it, in rapier's numbers.
struct Case {
    name: &'static str,
    make: fn(&mut Scene) -> RigidBodyHandle,
    /// By how much it may differ from rapier's at 960 Hz (m or rad).
    within: f64,
}

/// A bar of 1 kg and 0.6 m on a hinge to the world, from where it lies; and what is changed of its joint.
fn pendulum(scene: &mut Scene, change: impl Fn(&mut Multibody, usize)) -> RigidBodyHandle {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let link = bar(scene, [[0.0, 0.0], [0.6, 0.0]], 1.0);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-0.3, 0.0));
    let handle = join(scene, [base, link], hinge, true).expect("a link");
    let joints = &mut scene.world.multibody_joints;
    let (multibody, id) = joints.get_mut(handle).expect("it is there");
    // Before the first step the fixed root has coordinates of its own.
    multibody.forward_kinematics(&scene.world.bodies, true);
    change(multibody, id);
    link
}

fn place_of(multibody: &Multibody, id: usize) -> usize {
    multibody.link(id).expect("it is there").assembly_id()
}

#[test]
fn what_only_multibodies_have_acts_as_in_rapier_alone() {
    let cases = [
        Case {
            name: "damping",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let place = place_of(multibody, id);
                    multibody.damping_mut()[place] = 0.5;
                })
            },
            within: 2e-4,
        },
        Case {
            name: "friction",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let place = place_of(multibody, id);
                    multibody.frictions_mut()[place] = 0.7;
                })
            },
            within: 2e-3,
        },
        Case {
            name: "armature",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let place = place_of(multibody, id);
                    multibody.armature_mut()[place] = 0.3;
                })
            },
            within: 3e-4,
        },
        Case {
            name: "spring",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let link = multibody.link_mut(id).expect("it is there");
                    link.joint.set_spring(2, 30.0, 0.4);
                })
            },
            within: 3e-3,
        },
        Case {
            name: "damping of a root",
            make: |scene| {
                let bars = [0.0, 0.6].map(|x| bar(scene, [[x, 0.0], [x + 0.6, 0.0]], 1.0));
                let hinge = RevoluteJointBuilder::new()
                    .local_anchor1(vec2(0.3, 0.0))
                    .local_anchor2(vec2(-0.3, 0.0));
                let handle = join(scene, bars, hinge, true).expect("a link");
                let joints = &mut scene.world.multibody_joints;
                let (multibody, _) = joints.get_mut(handle).expect("it is there");
                multibody.forward_kinematics(&scene.world.bodies, true);
                multibody.armature_mut()[2] = 0.1;
                for (place, damping) in [0.7, 0.2, 0.3].into_iter().enumerate() {
                    multibody.damping_mut()[place] = damping;
                }
                for (place, rate) in [1.0, 0.0, 3.0].into_iter().enumerate() {
                    multibody.generalized_velocity_mut()[place] = rate;
                }
                bars[0]
            },
            within: 2e-3,
        },
        Case {
            name: "the user's rate",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let place = place_of(multibody, id);
                    let link = multibody.link_mut(id).expect("it is there");
                    link.joint.kinematic = true;
                    multibody.generalized_velocity_mut()[place] = 1.5;
                })
            },
            within: by_precision(1e-3, 1e-7),
        },
        Case {
            name: "a limit beyond a turn",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let link = multibody.link_mut(id).expect("it is there");
                    let joint = &mut link.joint.data;
                    joint.set_limits(JointAxis::AngX, [-8.0, 8.0]);
                    joint.set_motor_model(JointAxis::AngX, MotorModel::ForceBased);
                    joint.set_motor_velocity(JointAxis::AngX, 14.0, 100.0);
                })
            },
            within: 5e-3,
        },
        Case {
            name: "a motor by what it moves",
            make: |scene| {
                pendulum(scene, |multibody, id| {
                    let link = multibody.link_mut(id).expect("it is there");
                    let joint = &mut link.joint.data;
                    joint.set_motor_position(JointAxis::AngX, 0.5, 60.0, 8.0);
                })
            },
            within: 1e-4,
        },
    ];
    for Case { name, make, within } in cases {
        let [mut ours, mut theirs] = [Scene::new(1.0 / 960.0), Scene::new(1.0 / 960.0)];
        let (link, alone) = (make(&mut ours), make(&mut theirs));
        pad_on(&mut ours, link, 1e-6);
        // Rapier's springs and dampers lose by their own steps: these are to be short.
        theirs.world.integration_parameters.num_solver_iterations = 32;
        let mut apart = 0.0f64;
        for _ in 0..960 {
            ours.step();
            theirs.world.step();
            let [one, other] = [&ours.world.bodies[link], &theirs.world.bodies[alone]];
            let way = f64::from((one.translation() - other.translation()).length());
            let turn = turn_between(one, other);
            apart = apart.max(way).max(turn);
        }
        assert!(apart < within, "{name}: {apart}");
    }
}

#[test]
fn a_link_that_weighs_nothing_hands_on_what_it_is_given() {
    // Two rails across each other, of which a link without collider is the first.
    let make = |scene: &mut Scene| {
        let base = scene.world.insert_body(RigidBodyBuilder::fixed());
        let between = RigidBodyBuilder::dynamic().can_sleep(false);
        let between = scene.world.insert_body(between);
        let link = bar(scene, [[-0.2, 0.0], [0.2, 0.0]], 2.0);
        join(
            scene,
            [base, between],
            PrismaticJointBuilder::new(vec2(1.0, 0.0)),
            true,
        );
        join(
            scene,
            [between, link],
            PrismaticJointBuilder::new(vec2(0.0, 1.0)),
            true,
        );
        scene.world.bodies[link].add_force(vec2(3.0, 2.0), true);
        link
    };
    let mut scene = Scene::new(1.0 / 240.0);
    let link = make(&mut scene);
    pad_on(&mut scene, link, 2.0);
    scene.steps(120);
    let at = scene.world.bodies[link].translation();
    let [x, y] = [f64::from(at.x), f64::from(at.y)];
    let falls = 0.125 * (2.0 / 4.0 - G);
    assert!((x / (0.125 * 3.0 / 4.0) - 1.0).abs() < 1e-4, "{x} m");
    assert!((y / falls - 1.0).abs() < 1e-4, "{y} of {falls} m");
}

/// A hand with two fingers on hinges, of which the second turns as the first is told to.
fn hand(scene: &mut Scene) -> [RigidBodyHandle; 2] {
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let fingers = [0.0, 1.0].map(|x| bar(scene, [[x, 0.0], [x + 0.4, 0.0]], 1.0));
    let mut last = None;
    for (finger, x) in fingers.into_iter().zip([0.0, 1.0]) {
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(x, 0.0))
            .local_anchor2(vec2(-0.2, 0.0));
        last = join(scene, [base, finger], hinge, true);
    }
    let joints = &mut scene.world.multibody_joints;
    let (multibody, _) = joints.get_mut(last.expect("a link")).expect("it is there");
    multibody.add_dof_coupling(MultibodyDofCoupling {
        link1: 1,
        dof1: 0,
        axis1: 2,
        link2: 2,
        dof2: 0,
        axis2: 2,
        coeff: -2.0,
        offset: 0.0,
    });
    fingers
}

#[test]
fn coupled_angles_stay_coupled() {
    let mut scene = Scene::new(1.0 / 120.0);
    let fingers = hand(&mut scene);
    pad_on(&mut scene, fingers[0], 2.0);
    let mut turned = 0.0f64;
    for step in 0..60 {
        scene.step();
        let [first, second] =
            fingers.map(|finger| f64::from(scene.world.bodies[finger].rotation().angle()));
        // In f64 what the coupling yields by to the weight.
        let missed = (second + 2.0 * first).abs();
        assert!(
            missed < by_precision(1e-5, 5e-9),
            "step {step}: {missed} rad"
        );
        turned = turned.max(first.abs());
    }
    // The first falls with 3 kg and lifts the second by twice as much.
    assert!(turned > 0.1, "{turned} rad");
}

#[test]
fn links_that_turn_keep_momentum_and_angular_momentum_where_they_are_held_by_something_flexible() {
    for rate in [60.0, 240.0] {
        let mut scene = Scene::in_free_space(1.0 / rate);
        let bodies = free(&mut scene, true);
        scene.world.bodies[bodies[0]].reset_torques(true);
        scene.world.bodies[bodies[1]].add_force(vec2(3.0, -2.0), true);
        scene.step();
        scene.world.bodies[bodies[1]].reset_forces(true);
        scene.steps(2);
        let kept = |scene: &Scene| {
            let [x, y] = scene.report().momentum();
            [x, y, scene.report().angular_momentum()]
        };
        let start = kept(&scene);
        scene.steps(rate as usize);
        let end = kept(&scene);
        for (one, other) in start.into_iter().zip(end) {
            let missed = (one - other).abs();
            assert!(missed < 1e-9, "{rate} Hz: {start:?} {end:?}");
        }
        assert!(start.iter().all(|part| part.abs() > 1e-3), "{start:?}");
    }
}

/// A slider of 2 kg whose motor pushes a free block of 2 kg to a wall at 0.5 m/s, with 50 N at most; the most energy that both had (J).
fn pushed(rate: f64, young: f64, factor: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let base = scene.world.insert_body(RigidBodyBuilder::fixed());
    let body = RigidBodyBuilder::dynamic().translation(vec2(-0.3, 0.0));
    let shape = ColliderBuilder::cuboid(0.1, 0.1).mass(2.0);
    let (slider, _) = scene.rigid(body, shape);
    let rail = PrismaticJointBuilder::new(vec2(1.0, 0.0))
        .local_anchor1(vec2(-0.3, 0.0))
        .motor_model(MotorModel::ForceBased)
        .motor_velocity(0.5, real(factor))
        .motor_max_force(50.0);
    join(&mut scene, [base, slider], rail, true);
    let wall = ColliderBuilder::cuboid(0.1, 1.0).translation(vec2(0.5, 0.0));
    scene.world.colliders.insert(wall);
    let material = LinearElastic::plane_stress(young, 0.3).density(50.0);
    let block = FlexBodyBuilder::rectangle([0.2, 0.2], [3, 3]).translation([0.0, -0.1]);
    let block = scene.flexible(block.material(material));
    let mut most = 0.0f64;
    for _ in 0..(4.0 * rate) as usize {
        scene.step();
        let speed = f64::from(scene.world.bodies[slider].linvel().length());
        let energy = scene.body(block).energy();
        most = most.max(energy.kinetic + energy.elastic + speed * speed);
    }
    let at = f64::from(scene.world.bodies[slider].translation().x);
    let gap = (at - 0.1).abs();
    assert!(
        gap < 1e-4,
        "{rate} Hz, {young:e}: the block is at the wall, {gap} m"
    );
    most
}

#[test]
fn what_a_motor_presses_on_something_stiff_gains_nothing() {
    for rate in [60.0, 240.0] {
        for (young, factor) in [(1e6, 1e4), (1e8, 1e4), (1e9, 1e4), (1e9, 1e2)] {
            // Half a joule that moves, and what the motor presses into the block: F²/2k, 5 mJ of the softest.
            let most = pushed(rate, young, factor);
            assert!(most < 0.51, "{rate} Hz, {young:e} Pa: {most} J");
        }
    }
}

#[test]
fn a_step_gives_a_multibody_back_as_the_user_made_it() {
    let mut scene = Scene::new(1.0 / 120.0);
    let fingers = hand(&mut scene);
    pad_on(&mut scene, fingers[0], 0.2);
    let joints = &mut scene.world.multibody_joints;
    let handle = MultibodyJointHandle(fingers[0].0);
    let (multibody, id) = joints.get_mut(handle).expect("it is there");
    multibody.forward_kinematics(&scene.world.bodies, true);
    let place = place_of(multibody, id);
    multibody.frictions_mut()[place] = 0.01;
    let joint = &mut multibody.link_mut(id).expect("it is there").joint.data;
    joint.set_limits(JointAxis::AngX, [-0.3, 1.0]);
    joint.set_motor_velocity(JointAxis::AngX, 0.1, 1.0);
    let settings = |scene: &Scene| {
        let (multibody, _) = scene.world.multibody_joints.get(handle).expect("there");
        let joints = multibody.links().map(|link| {
            let joint = link.joint();
            (
                joint.kinematic,
                joint.data.motor_axes,
                joint.data.limit_axes,
            )
        });
        (
            joints.collect::<Vec<_>>(),
            multibody.frictions().clone(),
            multibody.damping().clone(),
            multibody.couplings().len(),
        )
    };
    let before = settings(&scene);
    for step in 0..60 {
        scene.step();
        assert_eq!(settings(&scene), before, "step {step}");
    }
}

#[test]
fn joints_that_cannot_be_solved_with_are_refused() {
    let mut scene = Scene::new(1.0 / 120.0);
    let fingers = hand(&mut scene);
    pad_on(&mut scene, fingers[0], 0.2);
    scene.step();
    let handle = MultibodyJointHandle(fingers[1].0);
    let change = |scene: &mut Scene, change: &dyn Fn(&mut Multibody, usize)| {
        let joints = &mut scene.world.multibody_joints;
        let (multibody, id) = joints.get_mut(handle).expect("it is there");
        change(multibody, id);
    };
    let spring = |stiffness: f64| {
        move |multibody: &mut Multibody, id: usize| {
            let link = multibody.link_mut(id).expect("it is there");
            link.joint.set_spring(2, real(stiffness), 0.0);
        }
    };
    change(&mut scene, &spring(f64::NAN));
    let error = scene.try_step().expect_err("a spring is no number");
    assert_eq!(error, StepError::MultibodyJoint(handle));
    change(&mut scene, &spring(0.0));
    scene.step();
    change(&mut scene, &|multibody, _| {
        let mut coupling = multibody.remove_dof_coupling(0).expect("it has one");
        coupling.axis1 = 0;
        multibody.add_dof_coupling(coupling);
    });
    let error = scene.try_step().expect_err("a way is no angle");
    assert_eq!(error, StepError::Coupling(handle));
    change(&mut scene, &|multibody, _| {
        let mut coupling = multibody.remove_dof_coupling(0).expect("it has one");
        (coupling.link1, coupling.axis1) = (0, 2);
        multibody.add_dof_coupling(coupling);
    });
    let error = scene
        .try_step()
        .expect_err("a root turns against the world");
    assert_eq!(error, StepError::Coupling(handle));
    change(&mut scene, &|multibody, _| multibody.clear_dof_couplings());
    scene.step();
}
