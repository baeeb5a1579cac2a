//! Sleep: what rests sleeps with its island, wakes when it is met or changed, and loses nothing by it.

mod common;

use common::*;

fn block(young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([0.5, 0.25], [6, 3]).material(elastic(young, 1000.0, 1e-3))
}

fn sleeps(scene: &Scene, body: FlexBodyHandle) -> bool {
    scene.world.bodies[scene.body(body).rigid_body_handle()].is_sleeping()
}

/// Steps until all that can sleep does; returns the time it took (s), if that was less than `limit`.
fn settle(scene: &mut Scene, limit: f64) -> Option<f64> {
    let steps = (limit / scene.dt()) as usize;
    (0..steps)
        .find(|_| {
            scene.step();
            let mut bodies = scene.world.bodies.iter();
            bodies.all(|(_, body)| body.is_fixed() || body.is_sleeping())
        })
        .map(|step| step as f64 * scene.dt())
}

/// Blocks and boxes in `n` piles of their own: block, box, block, box.
fn piles(n: usize) -> (Scene, Vec<FlexBodyHandle>, Vec<RigidBodyHandle>) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let (mut flexible, mut rigid) = (Vec::new(), Vec::new());
    for pile in 0..n {
        let x = pile as f64 - 0.5 * n as f64;
        for level in 0..2 {
            let y = 0.5 * f64::from(level);
            flexible.push(scene.flexible(block(1e7).translation([x, y + 0.01])));
            let at = vec2(x + 0.25, y + 0.40);
            let (body, _) = scene.world.insert(
                RigidBodyBuilder::dynamic().translation(at),
                ColliderBuilder::cuboid(real(0.2), real(0.1)).density(real(500.0)),
            );
            rigid.push(body);
        }
    }
    (scene, flexible, rigid)
}

#[test]
fn a_settled_pile_sleeps_within_five_seconds_and_a_touch_wakes_it() {
    let (mut scene, flexible, rigid) = piles(10);
    assert!(
        settle(&mut scene, 5.0).is_some(),
        "not all asleep after 5 s"
    );
    let before: Vec<_> = rigid
        .iter()
        .map(|&body| *scene.world.bodies[body].position())
        .collect();
    scene.steps(60);
    assert_eq!(scene.report().n_asleep(), flexible.len());
    assert_eq!(scene.report().n_islands(), 0, "what sleeps is not solved");
    for (&body, before) in rigid.iter().zip(&before) {
        assert_eq!(scene.world.bodies[body].position(), before);
    }
    // A ball falls on the first pile.
    scene.world.insert(
        RigidBodyBuilder::dynamic().translation(vec2(-4.75, 1.2)),
        ColliderBuilder::ball(real(0.05)).density(real(500.0)),
    );
    let mut woke = false;
    for _ in 0..60 {
        scene.step();
        woke |= !sleeps(&scene, flexible[1]);
    }
    assert!(woke, "the pile did not feel the ball");
    assert!(sleeps(&scene, flexible[19]), "another pile woke");
    assert!(settle(&mut scene, 5.0).is_some(), "does not sleep again");
}

#[test]
fn a_fast_ball_wakes_a_sleeper_before_it_is_inside() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let body = scene.flexible(block(1e7));
    settle(&mut scene, 5.0).expect("it rests");
    let (ball, _) = scene.world.insert(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.25, 5.0))
            .linvel(vec2(0.0, -200.0)),
        ColliderBuilder::ball(real(0.05)).density(real(1000.0)),
    );
    for _ in 0..4 {
        scene.step();
        let y = f64::from(scene.world.bodies[ball].translation().y);
        let top = scene
            .body(body)
            .positions()
            .chunks(2)
            .fold(0.0f64, |top, x| top.max(x[1]));
        assert!(y > 0.5 * top, "the ball is at {y} m, inside the block");
    }
    assert!(!sleeps(&scene, body));
}

#[test]
fn nothing_drifts_over_a_hundred_cycles_of_sleep() {
    let (mut scene, flexible, rigid) = piles(1);
    settle(&mut scene, 5.0).expect("it rests");
    scene.steps(120);
    let place = |scene: &Scene| {
        let mut all: Vec<f64> = Vec::new();
        for &body in &flexible {
            all.extend(scene.body(body).positions());
        }
        for &body in &rigid {
            let at = scene.world.bodies[body].translation();
            all.extend([f64::from(at.x), f64::from(at.y)]);
        }
        all
    };
    let start = place(&scene);
    let weight = scene.body(flexible[0]).total_contact_force();
    for _ in 0..100 {
        scene.bodies[flexible[0]].wake_up();
        scene.step();
        assert!(!sleeps(&scene, flexible[0]), "it was woken");
        settle(&mut scene, 5.0).expect("it rests again");
    }
    let drift = place(&scene)
        .iter()
        .zip(&start)
        .fold(0.0f64, |drift, (end, start)| drift.max((end - start).abs()));
    assert!(drift < by_precision(1e-6, 1e-8), "drifted by {drift:e} m");
    let force = scene.body(flexible[0]).total_contact_force();
    let off = (force[1] - weight[1])
        .abs()
        .max((force[0] - weight[0]).abs());
    assert!(off < 1e-3, "the forces changed by {off} N");
}

#[test]
fn a_body_that_moves_anywhere_stays_awake() {
    // A clamped strip that swings: its carrier stands still as ever.
    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    let material = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let body = scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 0.05], [20, 2])
            .material(material)
            .pin_where(|[x, _]| x == 0.0, Pin::both()),
    );
    scene.steps(600);
    assert!(!sleeps(&scene, body));
    let patient = scene.flexible(
        block(1e7)
            .translation([0.0, 50.0])
            .can_sleep(false)
            .gravity_scale(0.0),
    );
    scene.steps(120);
    assert!(!sleeps(&scene, patient), "it may not sleep");
}

type Change = fn(&mut FlexBody);

#[test]
fn whatever_is_changed_wakes() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let body = scene.flexible(block(1e7));
    let changes: [(&str, Change); 4] = [
        ("a force", |body| {
            body.set_nodal_force(0, [1.0, 0.0]).expect("a force")
        }),
        ("a body force", |body| {
            body.set_body_force([0.0, -1.0]).expect("a force")
        }),
        ("gravity", |body| {
            body.set_gravity_scale(1.1).expect("a factor")
        }),
        ("velocities", |body| {
            let velocities = vec![0.1; body.positions().len()];
            body.set_velocities(&velocities).expect("velocities");
        }),
    ];
    for (name, change) in changes {
        settle(&mut scene, 10.0).unwrap_or_else(|| panic!("before {name} it rests"));
        change(&mut scene.bodies[body]);
        scene.step();
        assert!(!sleeps(&scene, body), "{name} does not wake it");
    }
    settle(&mut scene, 10.0).expect("it rests");
    let carrier = scene.body(body).rigid_body_handle();
    let world = &mut scene.world;
    world.islands.wake_up(&mut world.bodies, carrier, true);
    scene.step();
    assert!(!sleeps(&scene, body), "rapier's own call does not wake it");
}

#[test]
fn a_pile_wakes_with_the_forces_it_fell_asleep_with_while_others_were_solved() {
    let (mut scene, flexible, rigid) = piles(1);
    // Somebody is awake, so that steps are solved while the pile sleeps.
    scene.flexible(block(1e7).translation([20.0, 0.0]).can_sleep(false));
    let falls_asleep = (0..600).any(|_| {
        scene.step();
        flexible.iter().all(|&body| sleeps(&scene, body))
    });
    assert!(falls_asleep, "the pile rests");
    let forces = |scene: &Scene| -> Vec<f64> {
        let on = flexible.iter().map(|&body| scene.force_on_flexible(body));
        let colliders = rigid
            .iter()
            .map(|&body| scene.world.bodies[body].colliders()[0]);
        let on_rigid = colliders.map(|collider| scene.force_on_collider(collider));
        on.chain(on_rigid).flatten().collect()
    };
    let points = |scene: &Scene| -> Vec<[f64; 2]> {
        let all = scene.report().contacts().iter();
        all.map(|contact| [contact.normal_force, contact.tangential_force])
            .collect()
    };
    let (asleep, each) = (forces(&scene), points(&scene));
    scene.steps(60);
    assert_eq!(forces(&scene), asleep, "the report keeps them");
    scene.bodies[flexible[0]].wake_up();
    scene.step();
    assert!(!sleeps(&scene, flexible[1]), "the whole pile was woken");
    let largest = asleep.iter().fold(0.0f64, |most, f| most.max(f.abs()));
    let off = |one: &[f64], other: &[f64]| {
        let pairs = one.iter().zip(other);
        pairs.fold(0.0f64, |off, (a, b)| off.max((a - b).abs())) / largest
    };
    let sums = off(&forces(&scene), &asleep);
    let now = points(&scene);
    assert_eq!(now.len(), each.len(), "the same points touch");
    let single = off(now.as_flattened(), each.as_flattened());
    // Of redundant contacts, shares are what is remembered: forgotten, they differ by 5e-5 of the largest force. The rest is the motion
    // that is left when a body falls asleep, 1e-8 of its size in the time until then, and what forces that are kept may miss: a millionth of the margin
    // between the bodies, here a ten-millionth of what they are pressed together by.
    assert!(sums < 5e-7, "sums differ by {sums:e}");
    assert!(single < 5e-7, "single forces differ by {single:e}");
}

#[test]
fn only_what_comes_or_goes_nearby_wakes() {
    let mut scene = Scene::new(1.0 / 60.0);
    let ground = scene.ground(0.5);
    let body = scene.flexible(block(1e7));
    let post = |x: f64| ColliderBuilder::cuboid(real(0.1), real(0.2)).translation(vec2(x, 0.2));
    settle(&mut scene, 5.0).expect("it rests");
    let far = scene.fixed(post(30.0));
    scene.step();
    assert!(sleeps(&scene, body), "woken by what came far away");
    scene.world.remove_collider(far);
    scene.step();
    assert!(sleeps(&scene, body), "woken by what went far away");
    let near = scene.fixed(post(0.6));
    scene.step();
    assert!(!sleeps(&scene, body), "not woken by what came beside it");
    settle(&mut scene, 5.0).expect("it rests again");
    // One goes and another comes: there are as many as before.
    scene.world.remove_collider(ground);
    scene.world.remove_collider(near);
    for x in [30.0, 40.0] {
        scene.fixed(post(x));
    }
    let before = scene.body(body).centre_of_mass()[1];
    scene.step();
    let fallen = before - scene.body(body).centre_of_mass()[1];
    assert!(fallen > 1e-4, "it falls in the same step: {fallen} m");
}

#[test]
fn a_tower_of_flush_rigid_and_flexible_blocks_sleeps_within_five_seconds() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    for (level, is_flexible) in [false, false, false, true, false, true, false]
        .into_iter()
        .enumerate()
    {
        let y = 0.01 + 0.31 * level as f64;
        if is_flexible {
            let block = FlexBodyBuilder::rectangle([0.5, 0.3], [5, 3]);
            let block = block.material(elastic(1e7, 1000.0, 1e-2));
            scene.flexible(block.translation([-0.25, y]));
        } else {
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, y + 0.15));
            let shape = ColliderBuilder::cuboid(0.25, 0.15).density(500.0);
            scene.world.insert(body, shape);
        }
    }
    let asleep = (0..300).find(|_| {
        scene.step();
        let mut bodies = scene.world.bodies.iter();
        bodies.all(|(_, body)| body.is_sleeping())
    });
    assert!(asleep.is_some(), "awake after 300 steps");
}

/// Rapier stops a body in the step in which it has been still for half a second, whatever is found for it in that step.
#[test]
fn a_box_that_is_hit_as_it_falls_asleep_takes_the_blow() {
    for speed in [5.0, 20.0] {
        for late in 0..4 {
            let mut scene = Scene::in_free_space(1.0 / 60.0);
            // At the box in its thirtieth step.
            let gap = speed * (29.0 + 0.25 * f64::from(late)) / 60.0;
            let striker = block(1e6).translation([0.2 + gap, -0.125]);
            let striker = scene.flexible(striker.linvel([-speed, 0.0]));
            let (hit, _) = scene.rigid(
                RigidBodyBuilder::dynamic(),
                ColliderBuilder::cuboid(real(0.2), real(0.2)).density(real(1000.0)),
            );
            let before = momentum_of(&scene)[0];
            for step in 0..40 {
                scene.step();
                let now = momentum_of(&scene)[0];
                let name = format!("{speed} m/s, {late}, step {step}: {now} of {before} N s");
                assert!((now / before - 1.0).abs() < 1e-5, "{name}");
            }
            let after = velocity_of(&scene.world.bodies[hit])[0];
            assert!(after < -0.1 * speed, "the box moves at {after} m/s");
            assert!(!sleeps(&scene, striker));
        }
    }
}

#[test]
fn what_is_attached_to_a_flexible_body_does_not_sleep_while_it_drifts() {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let body = scene.flexible(block(1e6).linvel([0.0, 0.05]));
    let rider = RigidBodyBuilder::dynamic()
        .translation(vec2(0.25, 0.5))
        .linvel(vec2(0.0, 0.05));
    let (rider, _) = scene.rigid(rider, ColliderBuilder::cuboid(real(0.1), real(0.1)));
    let pin = AttachmentBuilder::pin(body).node(0);
    let attached = scene
        .bodies
        .attach(pin.to_rigid_body(rider), &scene.world.bodies);
    attached.expect("both are there");
    let before = momentum_of(&scene)[1];
    scene.steps(120);
    let after = momentum_of(&scene)[1];
    assert!(
        (after / before - 1.0).abs() < 1e-5,
        "{after} of {before} N s"
    );
}

/// The noise of single precision grows with the distance from the origin: what moves by less than some eight digits of its size sleeps all the same.
#[test]
fn what_rests_far_from_the_origin_sleeps() {
    for (away, is_large) in [(100.0, false), (400.0, false), (100.0, true), (400.0, true)] {
        let mut scene = Scene::new(1.0 / 60.0);
        let ground = floor(0.5).translation(vec2(away, -0.5));
        scene.fixed(ground);
        let block = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4])
            .material(
                LinearElastic::plane_stress(1e6, 0.3)
                    .density(1000.0)
                    .rayleigh(1e-3),
            )
            .translation([away, 0.02]);
        let block = scene.flexible(match is_large {
            true => block.large_strain(),
            false => block.small_strain(),
        });
        scene.steps(900);
        let carrier = scene.body(block).rigid_body_handle();
        let sleeps = scene.world.bodies[carrier].is_sleeping();
        assert!(sleeps, "{away} m, large {is_large}");
    }
}

/// Three blocks a tenth of a metre apart, boxes on the outer ones: the first two fall asleep before what is on the third has come to rest, and the block
/// between, which is awake, makes the box that sleeps ours for a while.
#[test]
fn what_is_awake_beside_a_sleeping_box_does_not_let_it_fall_into_the_block_under_it() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    for k in 0..3 {
        let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]);
        let block = block.material(elastic(3e5, 1000.0, 1e-2));
        scene.flexible(block.translation([-1.25 + 0.5 * f64::from(k), 0.001]));
    }
    let boxes = [(-1.0, 0.0), (0.0, 60.0)].map(|(x, damping)| {
        let body = RigidBodyBuilder::dynamic().translation(vec2(x, 0.8));
        let body = body.linear_damping(real(damping)).lock_rotations();
        let shape = ColliderBuilder::cuboid(real(0.2), real(0.1)).density(1000.0);
        scene.world.insert(body, shape).0
    });
    let height = |scene: &Scene| f64::from(scene.world.bodies[boxes[0]].translation().y);
    let (mut n_alone, mut before) = (0, f64::NAN);
    for step in 0..420 {
        scene.step();
        let [sleeps, other] = boxes.map(|body| scene.world.bodies[body].is_sleeping());
        n_alone += usize::from(sleeps && !other);
        let moved = height(&scene) - std::mem::replace(&mut before, height(&scene));
        assert!(
            step < 180 || moved.abs() < 1e-4,
            "step {step}: {moved} m, asleep: {sleeps}"
        );
    }
    assert!(n_alone > 0, "they fell asleep together");
}

/// Columns of blocks sway for long, and by ever less: what has stayed in equilibrium sleeps, however finely it still trembles.
#[test]
fn stacks_of_blocks_fall_asleep() {
    for (young, rate, n_blocks) in [
        (1e6, 60.0, 3),
        (1e6, 120.0, 3),
        (1e6, 240.0, 3),
        (1e7, 60.0, 5),
    ] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.5);
        let blocks: Vec<_> = (0..n_blocks)
            .map(|k| {
                let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
                    .material(elastic(young, 1000.0, 2e-3))
                    .translation([0.0, 0.01 + 0.41 * f64::from(k)]);
                scene.flexible(block)
            })
            .collect();
        scene.steps((25.0 * rate) as usize);
        for block in blocks {
            let carrier = scene.body(block).rigid_body_handle();
            let sleeps = scene.world.bodies[carrier].is_sleeping();
            assert!(sleeps, "{young} Pa, {n_blocks} blocks at 1/{rate} s");
        }
    }
}

/// What joints hold as they fall asleep they go on holding, as contacts do, until something wakes them.
#[test]
fn joints_of_sleepers_are_still_told() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let block =
        FlexBodyBuilder::rectangle([1.0, 0.3], [10, 3]).material(elastic(1e7, 1000.0, 5e-3));
    let block = scene.flexible(block.translation([-0.5, 0.001]));
    let boxes = [-0.25, 0.25].map(|x| {
        let body = RigidBodyBuilder::dynamic().translation(vec2(x, 0.4));
        let shape = ColliderBuilder::cuboid(0.2, 0.1).density(1000.0);
        scene.world.insert(body, shape).0
    });
    let weld = FixedJointBuilder::new()
        .local_anchor1(vec2(0.25, 0.0))
        .local_anchor2(vec2(-0.25, 0.0));
    scene.world.insert_impulse_joint(boxes[0], boxes[1], weld);
    let mut last = Vec::new();
    let mut n_asleep = 0;
    for _ in 0..600 {
        let report = scene.step();
        let (sleeps, joints) = (report.n_asleep() == 1, report.joints().to_vec());
        assert_eq!(joints.len(), 1, "asleep: {sleeps}");
        assert!(!report.contacts().is_empty());
        if sleeps && n_asleep > 0 {
            assert_eq!(joints, last);
        }
        n_asleep += usize::from(sleeps);
        last = joints;
    }
    assert!(n_asleep > 60, "{n_asleep} steps asleep");
    scene.bodies[block].wake_up();
    let report = scene.step();
    assert_eq!((report.n_asleep(), report.joints().len()), (0, 1));
    // What is removed is told of no more.
    scene.steps(600);
    let joint = scene
        .world
        .impulse_joints
        .iter()
        .map(|(handle, _)| handle)
        .next();
    scene.world.remove_impulse_joint(joint.expect("the weld"));
    assert!(scene.step().joints().is_empty());
}

/// A platform at the lower end of a vertical slider, a block at rest on it, both asleep.
fn lift() -> (Scene, FlexBodyHandle, RigidBodyHandle, ImpulseJointHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    let post = scene.world.insert_body(RigidBodyBuilder::fixed());
    let (platform, _) = scene.world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::cuboid(0.6, 0.1).density(1000.0),
    );
    let slider = PrismaticJointBuilder::new(vec2(0.0, 1.0)).limits([0.0, 2.0]);
    let slider = scene.world.insert_impulse_joint(post, platform, slider);
    let block = scene.flexible(block(1e7).translation([-0.25, 0.101]));
    let time = settle(&mut scene, 10.0);
    assert!(time.is_some() && sleeps(&scene, block), "nothing moves");
    (scene, block, platform, slider)
}

/// What the block is above the platform by, at its lowest node (m).
fn height(scene: &Scene, block: FlexBodyHandle, platform: RigidBodyHandle) -> f64 {
    let top = f64::from(scene.world.bodies[platform].translation().y) + 0.1;
    let positions = scene.body(block).positions().chunks_exact(2);
    positions.map(|at| at[1]).fold(f64::INFINITY, f64::min) - top
}

#[test]
fn joints_that_are_changed_wake_what_rests_on_their_bodies() {
    type Change = fn(&mut GenericJoint);
    let changes: [(&str, Change); 3] = [
        ("motor", |joint| {
            joint.set_motor_velocity(JointAxis::LinX, 1.0, real(1e6));
        }),
        ("limit", |joint| {
            joint.set_limits(JointAxis::LinX, [0.5, 2.0]);
        }),
        ("anchor", |joint| {
            joint.set_local_anchor1(vec2(0.0, 0.05));
        }),
    ];
    for (name, change) in changes {
        let (mut scene, block, platform, slider) = lift();
        let rest = height(&scene, block, platform);
        let slider = scene.world.impulse_joints.get_mut(slider, true);
        change(&mut slider.expect("the slider").data);
        for step in 0..30 {
            let report = scene.step();
            assert_eq!(report.n_asleep(), 0, "{name}, step {step}");
            let now = height(&scene, block, platform);
            assert!(now > rest - 1e-4, "{name}, step {step}: {now} m");
        }
    }
    for is_taken_out in [true, false] {
        let (mut scene, block, platform, slider) = lift();
        let (rest, joints) = (
            height(&scene, block, platform),
            &mut scene.world.impulse_joints,
        );
        if is_taken_out {
            assert!(joints.remove(slider, true).is_some());
        } else {
            let spring = SpringJointBuilder::new(1.0, real(1e4), real(1e2));
            let post = joints.get(slider).map(ImpulseJoint::body1);
            joints.insert(post.expect("the slider"), platform, spring, true);
        }
        for step in 0..10 {
            assert_eq!(scene.step().n_asleep(), 0, "{is_taken_out}, step {step}");
            let now = height(&scene, block, platform);
            assert!(now > rest - 1e-4, "{is_taken_out}, step {step}: {now} m");
        }
    }
    // As in rapier, it is the user who says whether a change wakes.
    let (mut scene, block, _, slider) = lift();
    let slider = scene.world.impulse_joints.get_mut(slider, false);
    let data = &mut slider.expect("the slider").data;
    data.set_motor_velocity(JointAxis::LinX, 1.0, real(1e6));
    scene.step();
    assert!(sleeps(&scene, block));
}
