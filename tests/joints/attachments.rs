//! Attachments of flexible bodies: statics, dynamics, coming and going.

use crate::common::*;
use crate::support::*;
use foil2d::body::AttachmentError;
use foil2d::pipeline::Held;

/// A beam of 2 m along x, its left end at the origin.
fn beam() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([2.0, 0.2], [20, 2]).material(elastic(2e8, 1000.0, 2e-2))
}

fn is_left_end([x, _]: [f64; 2]) -> bool {
    x < 1e-9
}

fn tip(scene: &Scene, beam: FlexBodyHandle) -> f64 {
    let body = scene.body(beam);
    let nodes = body.mesh().nodes().iter();
    let right = nodes.enumerate().filter(|(_, [x, _])| *x > 1.999);
    let heights: Vec<f64> = right.map(|(node, _)| body.position(node)[1]).collect();
    heights.iter().sum::<f64>() / heights.len() as f64
}

fn attach(scene: &mut Scene, builder: AttachmentBuilder) -> AttachmentHandle {
    scene
        .bodies
        .attach(builder, &scene.world.bodies)
        .expect("the description is right")
}

/// Reaction of an attachment: force and torque (N, N m).
fn reaction(scene: &Scene, handle: AttachmentHandle) -> ([f64; 2], f64) {
    let found = scene
        .report()
        .joints()
        .iter()
        .find(|report| report.joint == Held::Attachment(handle));
    found.map_or(([0.0; 2], 0.0), |report| (report.force, report.torque))
}

#[test]
fn a_beam_welded_to_a_wall_sags_like_a_clamped_one() {
    let sag = |weld: Option<bool>| {
        let mut scene = Scene::new(DT);
        let builder = match weld {
            None => beam().pin_where(is_left_end, Pin::both()),
            Some(_) => beam(),
        };
        let beam = scene.flexible(builder);
        let mut handle = None;
        if let Some(to_body) = weld {
            let weld = AttachmentBuilder::weld(beam).where_(is_left_end);
            let weld = if to_body {
                let wall = scene
                    .world
                    .insert_body(RigidBodyBuilder::fixed().translation(vec2(-3.0, 1.0)));
                weld.to_rigid_body(wall)
            } else {
                weld.to_world()
            };
            handle = Some(attach(&mut scene, weld));
        }
        scene.steps(1200);
        let weight = G * scene.body(beam).mass();
        if let Some(handle) = handle {
            let (force, torque) = reaction(&scene, handle);
            println!("{force:?} {torque} of {weight}");
            // At rest the wall carries the weight and its moment, to what is left of the swinging (1e-4 after 10 s).
            assert!((force[1] / weight - 1.0).abs() < 1e-3);
            assert!((torque / weight - 1.0).abs() < 1e-2);
        }
        tip(&scene, beam)
    };
    let clamped = sag(None);
    for to_body in [false, true] {
        let welded = sag(Some(to_body));
        println!("{clamped} {welded}");
        // The same rows, eliminated there and multipliers here; the corotated frame differs: of the order of the slope squared.
        assert!((welded / clamped - 1.0).abs() < 2e-3, "{welded} {clamped}");
    }
}

#[test]
fn a_plate_hung_from_a_pin_swings_about_it() {
    // Period of a rigid plate about the middle of its left edge: T = 2π √(I/(m g L)), small swings.
    let mut scene = Scene::new(DT).with_integrator(Beta2::trapezoidal());
    let (width, height) = (1.0, 0.5);
    let plate = scene.flexible(
        FlexBodyBuilder::rectangle([width, height], [8, 4])
            .material(elastic(1e8, 1000.0, 1e-4))
            .rotation(-std::f64::consts::FRAC_PI_2 + 0.1)
            .translation([-0.25 * 0.1f64.cos(), -0.25 * 0.1f64.sin()]),
    );
    let pin = AttachmentBuilder::pin(plate)
        .where_(|[x, y]| x < 1e-9 && (y - 0.25).abs() < 0.01)
        .to_world();
    attach(&mut scene, pin);
    // Lumped masses of n cells along a side have 1 + 2/n² of its inertia.
    let own = width * width * (1.0 + 2.0 / 64.0) + height * height * (1.0 + 2.0 / 16.0);
    let inertia = own / 12.0 + 0.25 * width * width;
    let exact =
        std::f64::consts::TAU * (inertia / (G * 0.5 * width)).sqrt() * (1.0 + 0.1f64 * 0.1 / 16.0);
    let (mut crossings, mut last, mut time) = (Vec::new(), 0.1, 0.0);
    let mut largest = 0.0f64;
    while crossings.len() < 21 {
        scene.step();
        time += DT;
        let now = 0.1 + scene.body(plate).angle();
        if now < 0.0 && last >= 0.0 {
            crossings.push(time - DT * now / (now - last));
            largest = 0.0;
        }
        largest = largest.max(now.abs());
        last = now;
        assert!(time < 60.0, "it does not swing: {now}");
    }
    let period = (crossings[20] - crossings[0]) / 20.0;
    println!("{period} {exact} {:e}", period / exact - 1.0);
    // Second order in the step: (ω dt)²/12 = 1e-4; the plate stretches by ρ g L² / 2E.
    assert!((period / exact - 1.0).abs() < 5e-4);
}

#[test]
fn a_block_on_a_spring_sags_and_swings_as_it_must() {
    // m = 62.5 kg on k = 5000 N/m: sag m g / k, frequency √(k/m).
    let mut scene = Scene::new(DT).with_integrator(Beta2::trapezoidal());
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.25, 0.25], [2, 2]).material(elastic(1e8, 1000.0, 1e-4)),
    );
    let (k, m) = (5000.0, scene.body(block).mass());
    let spring = AttachmentBuilder::spring_damper(block, k, 0.0)
        .where_(|[x, y]| (x - 0.125).abs() < 1e-9 && y > 0.24)
        .at_point([0.125, 1.25])
        .rest_length(1.0)
        .to_world();
    attach(&mut scene, spring);
    let sag = m * G / k;
    let omega = (k / m).sqrt();
    let (mut low, mut turns, mut last) = (0.0f64, Vec::new(), 0.0);
    let mut time = 0.0;
    for _ in 0..1200 {
        scene.step();
        time += DT;
        let now = scene.body(block).centre_of_mass()[1] - 0.125;
        low = low.min(now);
        let (before, after) = (last + sag, now + sag);
        if before >= 0.0 && after < 0.0 {
            turns.push(time - DT * after / (after - before));
        }
        last = now;
    }
    let period = (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64;
    println!(
        "low {low} of {} period {period} of {}",
        -2.0 * sag,
        std::f64::consts::TAU / omega
    );
    // It swings by twice the sag; (ω dt)²/12 = 5e-4.
    assert!((low / (-2.0 * sag) - 1.0).abs() < 5e-3);
    assert!((period * omega / std::f64::consts::TAU - 1.0).abs() < 1e-3);
}

#[test]
fn a_weld_to_a_dynamic_body_and_one_to_a_flexible_body_keep_momentum() {
    let mut scene = Scene::in_free_space(DT);
    // All turn about the origin at 1 rad/s.
    let one = scene.flexible(beam().linvel([-0.1, 1.0]).angvel(1.0));
    let other = scene.flexible(
        beam()
            .translation([2.0, 0.0])
            .linvel([-0.1, 3.0])
            .angvel(1.0),
    );
    let (hub, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(-0.5, 0.1))
            .linvel(vec2(-0.1, -0.5))
            .angvel(1.0),
        ColliderBuilder::cuboid(0.5, 0.5).density(200.0),
    );
    let to_hub = AttachmentBuilder::weld(one)
        .where_(is_left_end)
        .to_rigid_body(hub);
    attach(&mut scene, to_hub);
    let together = AttachmentBuilder::weld(other)
        .where_(is_left_end)
        .to_flexible(one);
    attach(&mut scene, together);
    scene.step();
    let start = (scene.report().momentum(), scene.report().angular_momentum());
    let energy = scene.report().energy().total();
    let mut worst = 0.0f64;
    for _ in 0..600 {
        scene.step();
        let now = (scene.report().momentum(), scene.report().angular_momentum());
        for (a, b) in [
            (now.0[0], start.0[0]),
            (now.0[1], start.0[1]),
            (now.1, start.1),
        ] {
            worst = worst.max((a - b).abs());
        }
        assert!(scene.report().energy().total() < 1.01 * energy);
    }
    println!(
        "{start:?} {worst:e} energy {energy} -> {}",
        scene.report().energy().total()
    );
    assert!(worst < 1e-9 * start.1.abs());
}

#[test]
fn a_prescribed_motion_carries_the_body_along() {
    let mut scene = Scene::in_free_space(DT);
    let beam = scene.flexible(beam());
    let weld = AttachmentBuilder::weld(beam).where_(is_left_end).to_world();
    let weld = attach(&mut scene, weld);
    let mut time = 0.0;
    for _ in 0..600 {
        time += DT;
        let angle = 0.3 * (1.0 - (2.0 * time).cos());
        let offset = [0.1 * time, 0.0];
        let attachment = scene.bodies.attachment_mut(weld).expect("it lives");
        attachment
            .set_target(offset, angle)
            .expect("it is held by the world");
        scene.step();
        let body = scene.body(beam);
        let left = body
            .mesh()
            .nodes()
            .iter()
            .enumerate()
            .filter(|(_, at)| is_left_end(**at));
        for (node, at) in left {
            let (sin, cos) = angle.sin_cos();
            let wanted = [offset[0] - sin * (at[1] - 0.1), 0.1 + cos * (at[1] - 0.1)];
            let now = body.position(node);
            let off = (now[0] - wanted[0]).hypot(now[1] - wanted[1]);
            assert!(off < 1e-9, "off by {off} at {time}");
        }
    }
}

#[test]
fn a_removed_attachment_lets_go_and_its_handle_is_stale() {
    let mut scene = Scene::new(DT);
    let beam = scene.flexible(beam());
    let wall = scene.world.insert_body(RigidBodyBuilder::fixed());
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(2.2, 0.1)),
        ColliderBuilder::ball(0.1).density(1000.0),
    );
    let left = AttachmentBuilder::weld(beam)
        .where_(is_left_end)
        .to_rigid_body(wall);
    let left = attach(&mut scene, left);
    let right = AttachmentBuilder::pin(beam)
        .where_(|[x, y]| x > 1.999 && (y - 0.1).abs() < 0.01)
        .to_rigid_body(ball);
    let right = attach(&mut scene, right);
    scene.steps(60);
    assert_eq!(scene.report().n_claimed(), 1);
    // The ball goes, and the attachment with it.
    scene.world.remove_body(ball);
    scene.steps(5);
    assert!(matches!(
        scene.bodies.attachment(right),
        Err(AttachmentError::Stale(_))
    ));
    scene.bodies.detach(left).expect("it lives");
    // The step after it still knows the last reaction, as its accelerations are means.
    scene.step();
    let before = scene.body(beam).linvel()[1];
    scene.steps(60);
    let fallen = scene.body(beam).linvel()[1] - before;
    assert!(
        (fallen + G * 60.0 * DT).abs() < 1e-3 * G,
        "it falls freely: {fallen}"
    );
    assert!(matches!(
        scene.bodies.detach(left),
        Err(AttachmentError::Stale(_))
    ));
    // With the body go its attachments.
    let again = AttachmentBuilder::weld(beam)
        .where_(is_left_end)
        .to_rigid_body(wall);
    let again = attach(&mut scene, again);
    scene
        .bodies
        .remove(beam, &mut scene.world)
        .expect("it lives");
    assert!(matches!(
        scene.bodies.attachment(again),
        Err(AttachmentError::Stale(_))
    ));
    let never = AttachmentHandle::default();
    assert_eq!(
        scene.bodies.detach(never).err(),
        Some(AttachmentError::Foreign(AttachmentHandle::invalid()))
    );
}

#[test]
fn a_body_that_hangs_on_a_beam_at_rest_falls_when_it_is_let_go() {
    let mut scene = Scene::new(DT);
    let beam = scene.flexible(beam());
    let clamp = AttachmentBuilder::weld(beam).where_(is_left_end).to_world();
    attach(&mut scene, clamp);
    // It may sleep, as rapier sees nothing that holds it.
    let (ball, _) = scene.world.insert(
        RigidBodyBuilder::dynamic().translation(vec2(2.0, -0.5)),
        ColliderBuilder::ball(0.1).mass(20.0),
    );
    let hang = AttachmentBuilder::pin(beam)
        .where_(|[x, y]| x > 1.999 && y < 1e-9)
        .to_rigid_body(ball);
    let hang = attach(&mut scene, hang);
    scene.steps(1200);
    let rest = position(&scene, ball)[1];
    let pull = reaction(&scene, hang).0[1];
    assert!((pull / (-20.0 * G) - 1.0).abs() < 1e-3, "{pull}");
    scene.bodies.detach(hang).expect("it lives");
    scene.world.bodies[ball].wake_up(true);
    scene.steps(60);
    let fallen = position(&scene, ball)[1] - rest;
    assert!((fallen / (-0.125 * G) - 1.0).abs() < 0.05, "{fallen}");
}

#[test]
fn wrong_descriptions_are_refused() {
    let mut scene = Scene::new(DT);
    let one = scene.flexible(beam());
    let pinned = scene.flexible(
        beam()
            .translation([0.0, 5.0])
            .pin_where(is_left_end, Pin::both()),
    );
    let above = scene.flexible(beam().translation([1.8, 0.25]));
    let carrier = scene.body(pinned).rigid_body_handle();
    let inside = scene
        .body(one)
        .mesh()
        .nodes()
        .iter()
        .position(|[x, y]| (x - 1.0).abs() < 1e-9 && (y - 0.1).abs() < 1e-9);
    let inside = inside.expect("the mesh has a node in the middle");
    let pin = || AttachmentBuilder::pin(one).node(0);
    let spring = |k: f64| {
        AttachmentBuilder::spring_damper(one, k, 0.0)
            .node(0)
            .to_world()
    };
    let upper_face = |beyond: f64| {
        AttachmentBuilder::weld(one)
            .where_(move |[x, y]| x > beyond && y > 0.199)
            .to_flexible(above)
    };
    let cases: [(AttachmentBuilder, &str); 18] = [
        (pin(), "no target"),
        (AttachmentBuilder::pin(one).to_world(), "holds no node"),
        (
            AttachmentBuilder::pin(one).node(10_000).to_world(),
            "use an index below",
        ),
        (
            AttachmentBuilder::pin(one).node(inside).to_world(),
            "lies inside",
        ),
        (
            AttachmentBuilder::pin(one).nodes([0, 0]).to_world(),
            "named twice",
        ),
        (
            AttachmentBuilder::weld(one).node(0).to_world(),
            "cannot keep a direction",
        ),
        (pin().node(0).to_world(), "named twice"),
        (pin().to_world().rest_length(0.5), "no length at rest"),
        (
            AttachmentBuilder::weld(one)
                .nodes([0, 1])
                .rest_length(0.5)
                .to_world(),
            "no length at rest",
        ),
        (pin().to_rigid_body(carrier), "carries a flexible body"),
        (
            pin().to_rigid_body(RigidBodyHandle::invalid()),
            "not in the rigid-body set",
        ),
        (pin().to_flexible(one), "attached to itself"),
        (pin().to_flexible(pinned), "bring the bodies together"),
        (
            pin().to_flexible(pinned).at_point([0.0, 5.0]),
            "bring the bodies together",
        ),
        (pin().to_world().at_point([f64::NAN, 0.0]), "not finite"),
        (spring(-1.0), "negative"),
        (
            AttachmentBuilder::pin(pinned)
                .where_(is_left_end)
                .to_world(),
            "pinned by the builder",
        ),
        // Some nodes lie beside the other body: all have its corner nearest.
        (upper_face(1.55), "along the other body's surface"),
    ];
    for (builder, words) in cases {
        let error = scene
            .bodies
            .attach(builder, &scene.world.bodies)
            .expect_err(words)
            .to_string();
        assert!(error.contains(words), "{error}");
    }
    assert_eq!(scene.bodies.iter_attachments().count(), 0);
    // Those along it may.
    let handle = attach(&mut scene, upper_face(1.75));
    scene.bodies.detach(handle).expect("it lives");
    // An integrator that cannot hold them says so.
    attach(&mut scene, pin().to_world());
    scene.flex = FlexPipeline::new()
        .with_integrator(Beta2::central_difference())
        .insisting();
    let error = scene.try_step().expect_err("beta0 = 0").to_string();
    assert!(error.contains("beta0"), "{error}");
}

/// Nodes and regions that are named one after the other are all held, each once: the same as all of them named together.
#[test]
fn all_that_is_chosen_is_held() {
    let held = |choose: fn(AttachmentBuilder) -> AttachmentBuilder| {
        let mut scene = Scene::new(DT);
        let beam = scene.flexible(beam());
        attach(&mut scene, choose(AttachmentBuilder::weld(beam)).to_world());
        scene.steps(30);
        scene.body(beam).positions().to_vec()
    };
    let together = held(|weld| weld.nodes([0, 20, 41]));
    assert_eq!(held(|weld| weld.node(0).node(20).node(41)), together);
    assert_ne!(held(|weld| weld.nodes([0, 20])), together);
    let edge = held(|weld| weld.where_(is_left_end));
    let in_pieces = held(|weld| {
        weld.node(0)
            .where_(|[x, y]| x < 1e-9 && y < 0.15)
            .where_(|[x, y]| x < 1e-9 && y > 0.05)
    });
    assert_eq!(in_pieces, edge);
}

/// A box on a spring from a beam's end is driven between the beam and the ground. Newton's iterations once ended along gaps
/// extrapolated from where they had fled to: the box stood 6 cm deep in the beam, which held 16 times the energy there was.
#[test]
fn a_box_wedged_between_a_beam_and_the_ground_feeds_no_energy() {
    for (dt, speed) in [(1.0 / 30.0, 3.0), (1.0 / 240.0, 8.0)] {
        let mut scene = Scene::new(dt);
        scene.ground(0.5);
        let beam = scene.flexible(
            FlexBodyBuilder::rectangle([2.0, 0.2], [20, 4])
                .material(
                    LinearElastic::plane_stress(1e7, 0.3)
                        .density(1000.0)
                        .rayleigh(1e-4),
                )
                .translation([0.0, 1.0]),
        );
        let wall = AttachmentBuilder::weld(beam).where_(|[x, _]| x < 1e-9);
        attach(&mut scene, wall.to_world());
        let (hung, _) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(2.25, 1.1)),
            ColliderBuilder::cuboid(0.2, 0.2).density(500.0),
        );
        let spring = AttachmentBuilder::spring_damper(beam, 5000.0, 5.0)
            .where_(|[x, _]| x > 1.999)
            .to_rigid_body(hung);
        attach(&mut scene, spring);
        scene.rigid(
            RigidBodyBuilder::dynamic()
                .translation(vec2(1.0, 1.45))
                .linvel(vec2(0.0, -speed)),
            ColliderBuilder::ball(0.15).density(1000.0),
        );
        let given = energy_of_all(&scene);
        for step in 0..(2.0 / dt) as usize {
            scene.try_step().expect("a sound step");
            // What the spring stores only takes from this. Rounding in single precision is 1e-7 of it.
            let now = energy_of_all(&scene);
            let most = given + 1e-5 * given.abs();
            assert!(now < most, "{now} J of {given} J in step {step}");
        }
    }
}

/// Kinetic, elastic and potential energy of all bodies (J).
fn energy_of_all(scene: &Scene) -> f64 {
    let flexible = scene.bodies.iter().map(|(_, body)| {
        let energy = body.energy();
        energy.kinetic + energy.elastic + G * body.mass() * body.centre_of_mass()[1]
    });
    let is_carrier = |handle| {
        let mut all = scene.bodies.iter();
        all.any(|(_, flex)| flex.rigid_body_handle() == handle)
    };
    let rigid = scene.world.bodies.iter();
    let rigid = rigid.filter(|(handle, body)| body.is_dynamic() && !is_carrier(*handle));
    let rigid = rigid.map(|(_, body)| {
        let height = f64::from(body.center_of_mass().y);
        f64::from(body.kinetic_energy()) + G * f64::from(body.mass()) * height
    });
    flexible.sum::<f64>() + rigid.sum::<f64>()
}

/// A spring without stiffness and damping, which a user may turn up later, is not there.
#[test]
fn a_spring_of_nothing_holds_nothing() {
    for is_small in [false, true] {
        let swing = |has_spring: bool| {
            let mut scene = Scene::new(DT);
            let strip = beam().pin_where(|[x, _]| x == 0.0, Pin::both());
            let strip = scene.flexible(if is_small {
                strip.small_strain()
            } else {
                strip
            });
            if has_spring {
                let tip = scene.body(strip).n_nodes() - 1;
                let spring = AttachmentBuilder::spring_damper(strip, 0.0, 0.0).node(tip);
                attach(&mut scene, spring.to_world());
            }
            scene.steps(30);
            scene.body(strip).centre_of_mass()[1]
        };
        let [without, with] = [false, true].map(swing);
        assert!(
            without < 0.099 && (with - without).abs() < 1e-9,
            "{with} m, {without} m"
        );
    }
}
