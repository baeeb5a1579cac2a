//! Steps that are not solved in one piece are solved in parts, and tell of the step as a whole.

mod common;

use common::*;
use foil2d::pipeline::Quality;

/// What collisions of two bodies show.
#[derive(Default)]
struct Collisions {
    findings: Findings,
    /// Steps that were taken in parts, and unsolved ones.
    n_cut: usize,
    n_unsolved: usize,
}

/// A soft square and a rigid bar that spin into each other in free space, off centre, by up to their size in a step.
fn collide(seed: u64, shown: &mut Collisions) {
    let mut dice = Dice(seed);
    let dt = dice.pick(&[1.0 / 30.0, 1.0 / 60.0]);
    let mut scene = Scene::in_free_space(dt);
    let material = elastic(10f64.powf(dice.between(6.5, 8.0)), 1000.0, 1e-3);
    let square = scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
            .material(material)
            .friction(0.5)
            .translation([-1.8, -0.5])
            .linvel([dice.between(0.2, 0.5) / dt, 0.0])
            .angvel(dice.between(-5.0, 5.0)),
    );
    let bar = RigidBodyBuilder::dynamic()
        .translation(vec2(0.6, dice.between(-0.7, 0.7)))
        .rotation(real(dice.between(0.0, 3.0)))
        .linvel(vec2(-dice.between(0.2, 0.5) / dt, 0.0))
        .angvel(real(dice.between(-15.0, 15.0)));
    let collider = ColliderBuilder::cuboid(0.6, 0.15)
        .density(1000.0)
        .friction(0.5);
    scene.rigid(bar, collider);
    let (brought, whole) = (energy_of(&scene), momentum_of(&scene));
    let name = |step: usize| format!("seed {seed}, step {step}");
    for step in 0..30 {
        let report = scene.try_step().expect("nothing is wrong with it");
        let (is_solved, n_parts) = (is_solved(report), report.n_parts());
        shown.n_cut += usize::from(n_parts > 1);
        shown.n_unsolved += usize::from(!is_solved);
        let energy = energy_of(&scene);
        shown.findings.check(energy <= 1.01 * brought, || {
            format!("{}: {energy} J of {brought}", name(step))
        });
    }
    let size = scene.body(square).mass() * 20.0;
    let sum = momentum_of(&scene);
    for axis in [0, 1] {
        let lost = (sum[axis] - whole[axis]).abs() / size;
        shown.findings.check(lost < by_precision(1e-5, 1e-10), || {
            format!("seed {seed}: momentum off by {lost:e}")
        });
    }
}

#[test]
fn collisions_in_parts_keep_momentum_and_energy() {
    let mut shown = Collisions::default();
    for seed in 0..200 {
        collide(seed, &mut shown);
    }
    println!(
        "{} of 6000 steps cut, {} not solved",
        shown.n_cut, shown.n_unsolved
    );
    // Else nothing was tested.
    assert!(shown.n_cut > 10, "{} steps cut", shown.n_cut);
    assert!(
        shown.n_unsolved <= 6,
        "{} steps not solved",
        shown.n_unsolved
    );
    shown.findings.report();
}

#[test]
fn what_drives_a_body_goes_its_piece_of_the_way_in_every_part() {
    // A hammer on a fixed course strikes the free end of a soft strip whose other end a moved pin holds: whatever the step was cut into, both
    // are where they were sent, and the strip outside of the hammer.
    let mut findings = Findings::default();
    let (mut n_cut, mut n_unsolved) = (0, 0);
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let dt = 1.0 / 60.0;
        let mut scene = Scene::in_free_space(dt);
        let strip = scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 0.2], [10, 2])
                .material(elastic(3e6, 1000.0, 1e-3))
                .friction(0.3)
                .pin_where(|[x, _]| x < 1e-9, Pin::both()),
        );
        let offset = scene.body(strip).contact_offset();
        let speed = dice.between(5.0, 40.0);
        let side = dice.between(-0.1, 0.1);
        let hammer = RigidBodyBuilder::kinematic_position_based()
            .translation(vec2(1.0 + side, 0.45))
            .rotation(real(dice.between(-0.5, 0.5)));
        let (hammer, collider) = scene.rigid(hammer, ColliderBuilder::cuboid(0.1, 0.1));
        let mut place = 0.45;
        let nodes: Vec<usize> = (0..scene.body(strip).n_nodes())
            .filter(|&node| scene.body(strip).fixed_dofs()[2 * node])
            .collect();
        for step in 1..=4 {
            place -= dt * speed;
            let turn = scene.world.bodies[hammer].rotation().angle();
            let goal = Pose::new(vec2(1.0 + side, place), turn);
            scene.world.bodies[hammer].set_next_kinematic_position(goal);
            let lift = -0.01 * f64::from(step);
            for &node in &nodes {
                scene
                    .bodies
                    .get_mut(strip)
                    .expect("it is there")
                    .set_pin_displacement(node, [0.0, lift])
                    .expect("the node is pinned");
            }
            let report = scene.try_step().expect("nothing is wrong with it");
            n_cut += usize::from(report.n_parts() > 1);
            let (is_solved, overlap) = (is_solved(report), report.gap_violation());
            n_unsolved += usize::from(!is_solved);
            findings.check(!is_solved || overlap < offset, || {
                format!("seed {seed}, step {step}: {overlap} m")
            });
            let at = place_of(&scene.world.bodies[hammer])[1];
            findings.check((at - place).abs() < 1e-6, || {
                format!("seed {seed}: the hammer is at {at} m, not {place} m")
            });
            for &node in &nodes {
                let [x, y] = scene.body(strip).displacement(node);
                findings.check(x.hypot(y - lift) < 1e-12, || {
                    format!("seed {seed}: a pin is at {x}, {y} m, not {lift} m")
                });
            }
            assert!(scene.world.colliders.contains(collider));
        }
    }
    println!("{n_cut} of 240 steps cut, {n_unsolved} not solved");
    assert!(
        n_cut > 5 && n_unsolved == 0,
        "{n_cut} steps cut, {n_unsolved} not solved"
    );
    findings.report();
}

/// Rapier sweeps every fast body along the chord of its step, and would stop this ball at the hub that it goes round on its arc.
#[test]
fn a_ball_that_is_led_around_a_hub_is_not_stopped_on_the_chord() {
    let (dt, turn) = (1.0 / 60.0, 0.6);
    let mut scene = Scene::in_free_space(dt);
    // Arc and hub are 2 cm apart; the chord is 4.5 cm inside of the arc.
    scene.fixed(ColliderBuilder::ball(real(0.88)));
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(1.0, 0.0))
        .linvel(vec2(0.0, turn / dt))
        .angvel(real(turn / dt));
    let (ball, _) = scene.rigid(ball, ColliderBuilder::ball(real(0.1)).density(1000.0));
    let (pivot, _) = scene.rigid(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::ball(real(0.01)).sensor(true),
    );
    let joint = hinge([0.0, 0.0], [-1.0, 0.0]);
    scene.world.insert_impulse_joint(pivot, ball, joint);
    // What is attached to a flexible body is solved with it.
    let rider = scene.flexible(
        FlexBodyBuilder::rectangle([0.04, 0.04], [2, 2])
            .material(elastic(1e9, 1000.0, 1e-3))
            .translation([1.15, -0.02])
            .linvel([0.0, turn / dt]),
    );
    let weld = AttachmentBuilder::weld(rider).where_(|[x, _]| x < 1e-9);
    scene
        .bodies
        .attach(weld.to_rigid_body(ball), &scene.world.bodies)
        .expect("the description is right");
    for step in 0..60 {
        scene.try_step().expect("nothing is wrong with it");
        let [x, y] = place_of(&scene.world.bodies[ball]);
        let off = (x.hypot(y) - 1.0).abs();
        assert!(off < 1e-4, "step {step}: {off} m off the arc");
        assert!(scene.report().n_claimed() > 0, "it is not ours");
    }
}

/// Rapier leaves boxes a few hundredths of their width deep in lines that something hits them against; there they are led, too.
#[test]
fn a_box_that_is_deep_in_a_line_is_not_pushed_through_it() {
    let mut findings = Findings::default();
    for depth in [0.03, 0.06, 0.1] {
        for speed in [2.0, 10.0, 20.0] {
            let mut scene = Scene::new(1.0 / 60.0);
            let line = [[-3.0, 0.0], [0.2, 0.0], [3.0, 0.0]].map(|[x, y]| vec2(x, y));
            scene.fixed(ColliderBuilder::polyline(line.to_vec(), None).friction(0.1));
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.14 - 0.28 * depth));
            let collider = ColliderBuilder::cuboid(0.36, 0.14).density(300.0);
            let (body, _) = scene.rigid(body.angvel(2.0), collider);
            scene.flexible(
                FlexBodyBuilder::rectangle([0.5, 0.5], [5, 5])
                    .material(elastic(1e6, 1000.0, 1e-3))
                    .translation([-0.1, 0.32])
                    .linvel([0.0, -speed]),
            );
            for step in 0..60 {
                scene.try_step().expect("nothing is wrong with it");
                let y = place_of(&scene.world.bodies[body])[1];
                findings.check(y > 0.13 - 0.28 * depth, || {
                    format!("{depth} of its width deep, {speed} m/s, step {step}: at {y} m")
                });
            }
        }
    }
    findings.report();
}

/// A triangle falls on a clamped strip and slides off its end. With its force to the end of the step the contact is over before that, without
/// it the triangle ends on the other side of the corner that it went around: halving the step changes nothing of it.
#[test]
fn what_slides_off_an_end_within_a_step_takes_the_whole_of_it() {
    let mut findings = Findings::default();
    for shift in [0.0, -0.01, -0.02, 0.01] {
        let mut scene = Scene::new(1.0 / 30.0);
        let size = [1.039_029_412_645_578, 0.106_114_192_858_538_63];
        let material = LinearElastic::plane_strain(1e7, 0.103_525_017_080_929_33)
            .density(481.428_752_190_320_8)
            .rayleigh(1.188_095_497_266_858_8e-4);
        scene.flexible(
            FlexBodyBuilder::rectangle(size, [20, 1])
                .material(material)
                .friction(0.346)
                .translation([-0.5 * size[0], 2.0 - 0.5 * size[1]])
                .pin_where(|[x, _]| x == 0.0, Pin::both()),
        );
        let corners = [
            [-0.066_612_740_033_208_07, 0.167_107_981_752_903],
            [0.034_515_665_548_462_66, -0.176_553_118_163_876_2],
            [0.154_399_903_808_542_7, 0.092_320_119_173_304_21],
        ];
        let [a, b, c] = corners.map(|[x, y]| vec2(x, y));
        let triangle = RigidBodyBuilder::dynamic()
            .translation(vec2(0.342_465_640_240_878 + shift, 4.868_312_071_447_601))
            .rotation(real(0.409_798_849_296_218_1));
        scene.rigid(
            triangle,
            ColliderBuilder::triangle(a, b, c)
                .mass(real(344.804_753))
                .friction(real(0.910_816_6)),
        );
        for step in 0..74 {
            let quality = scene
                .try_step()
                .expect("nothing is wrong with it")
                .quality();
            findings.check(quality != Quality::Unfinished, || {
                format!("{shift} m aside, step {step}: unfinished")
            });
        }
    }
    findings.report();
}

/// The tip of a triangle, with friction, in a fold that a soft strip makes on the ground: two contacts at the same node may hold it by any forces
/// against each other.
#[test]
fn a_tip_that_is_wedged_in_a_fold_is_held_by_forces_that_are_bounded() {
    let mut slipped = 0.0f64;
    for k in 0..8 {
        slipped = slipped.max(wedge_a_tip(4e-5 * f64::from(k)));
    }
    // What gives way is told, and is little beside cells of a fifth of a metre.
    assert!(slipped > 0.0 && slipped < 5e-3, "{slipped:e} m of slip");
}

/// Wedges it, with the strip so far aside (m); returns the slip that is told (m).
fn wedge_a_tip(aside: f64) -> f64 {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ColliderBuilder::new(SharedShape::halfspace(vec2(0.0, 1.0))).friction(real(0.015)));
    let size = [3.667_563_545_812_243, 0.193_634_638_281_032_05_f64];
    let angle = -1.943_030_635_639_707_1_f64;
    let (sin, cos) = angle.sin_cos();
    let half = [-0.5 * size[0], -0.5 * size[1]];
    let at = [
        aside + 0.209_510_902_708_788_03 + cos * half[0] - sin * half[1],
        4.932_537_732_753_614 + sin * half[0] + cos * half[1],
    ];
    scene.flexible(
        FlexBodyBuilder::rectangle_of(size, [17, 3], CellKind::Tri6)
            .small_strain()
            .material(
                LinearElastic::plane_stress(424_616.582_375_624_2, 0.3)
                    .density(1_707.992_355_726_982_9),
            )
            .friction(0.877_978_747_474_005_6)
            .translation(at)
            .rotation(angle),
    );
    let corners = [
        [-0.267_285_306_318_723_2, -0.115_719_013_733_303],
        [0.097_081_170_811_434_98, -0.274_604_390_691_742_25],
        [0.035_113_675_808_227_17, 0.289_135_530_304_625_1],
    ];
    let [a, b, c] = corners.map(|[x, y]| vec2(x, y));
    scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(0.714_399_4, 1.577_159_8)),
        ColliderBuilder::triangle(a, b, c)
            .mass(real(1_450.285_7))
            .friction(real(0.765_115_4)),
    );
    let mut slipped = 0.0f64;
    for step in 0..140 {
        let report = scene.try_step().expect("nothing is wrong with it");
        let quality = report.quality();
        assert!(quality != Quality::Unfinished, "step {step}: unfinished");
        slipped = slipped.max(report.slip_violation());
    }
    slipped
}

/// A turning paddle crushes a soft block against a wall, between its own end and the ground: what is tried there for an answer has an end. Without one
/// the worst step takes some twenty thousand pivots.
#[test]
fn what_is_crushed_costs_no_more_pivots_than_may_be_spent() {
    let crush = |most: usize| {
        let mut scene = Scene::new(1.0 / 30.0);
        scene.flex.parameters.max_pivots = most;
        scene.ground(0.5);
        let wall = ColliderBuilder::cuboid(0.1, 1.0).translation(vec2(-3.3, 1.0));
        scene.fixed(wall.friction(0.5));
        let block = FlexBodyBuilder::rectangle([0.6, 0.2], [8, 3])
            .material(elastic(5e4, 1000.0, 2e-3))
            .friction(0.5)
            .translation([-3.19, 0.0]);
        scene.flexible(block);
        let paddle = RigidBodyBuilder::kinematic_velocity_based()
            .translation(vec2(-2.2, 0.62))
            .angvel(0.5)
            .linvel(vec2(-0.1, -0.05));
        scene.rigid(paddle, ColliderBuilder::cuboid(0.5, 0.1).friction(0.5));
        let steps = (0..240).map(|_| {
            let report = scene.try_step().expect("nothing is wrong with it");
            report.n_pivots()
        });
        steps.max().unwrap_or_default()
    };
    let most = FlexPipeline::new().parameters.max_pivots;
    for budget in [most, most / 10] {
        let worst = crush(budget);
        println!("{worst} pivots in the worst step of {budget}");
        // Parts that are left when the budget is spent end after a few passes each.
        assert!(worst <= budget + 4000, "{worst} pivots of {budget}");
    }
}

/// A motor turns a ratchet's wheel under a reed of small strain: where the tip of a tooth was about to pass the end of the reed, eight parts of a step were
/// too few, in every step the same, and the wheel stood still for good.
#[test]
fn a_ratchet_turns_on_under_its_reed() {
    let (n_teeth, outer, inner, speed) = (12, 0.2, 0.17, 1.5);
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let axle = scene.world.insert_body(RigidBodyBuilder::fixed());
    let properties = MassProperties::new(vec2(0.0, 0.0), 1.0, 0.02);
    let wheel = RigidBodyBuilder::dynamic().additional_mass_properties(properties);
    let wheel = scene.world.insert_body(wheel);
    let corner = |radius: f64, angle: f64| vec2(radius * angle.cos(), radius * angle.sin());
    for tooth in 0..n_teeth {
        let [from, to] = [tooth, tooth + 1].map(|k| {
            let turns = f64::from(k) / f64::from(n_teeth);
            std::f64::consts::TAU * turns
        });
        let corners = [
            vec2(0.0, 0.0),
            corner(inner, from + 1e-3),
            corner(outer, to),
        ];
        let shape = ColliderBuilder::convex_hull(&corners).expect("a tooth");
        let shape = shape.density(10.0).friction(0.3);
        scene.world.insert_collider(shape, Some(wheel));
    }
    let motor = RevoluteJointBuilder::new()
        .motor_velocity(real(-speed), 1e5)
        .motor_model(MotorModel::ForceBased);
    scene.world.insert_impulse_joint(axle, wheel, motor);
    let (length, turn) = (0.25, -20_f64.to_radians());
    let root = [-0.01 - length * turn.cos(), 0.185 - length * turn.sin()];
    let reed = FlexBodyBuilder::rectangle([length, 0.006], [25, 2])
        .material(
            LinearElastic::plane_strain(1e9, 0.3)
                .density(1200.0)
                .rayleigh(2e-4),
        )
        .thickness(0.02)
        .small_strain()
        .friction(0.3)
        .rotation(turn)
        .translation(root)
        .pin_where(|[x, _]| x < 1e-9, Pin::both());
    scene.flexible(reed);
    let (mut turned, mut last, mut n_stuck) = (0.0, 0.0, 0);
    for _ in 0..240 {
        let report = scene.try_step().expect("a step");
        n_stuck += usize::from(report.quality() == Quality::Unfinished);
        let angle = turn_of(&scene.world.bodies[wheel]);
        let way = angle - last;
        turned += way - std::f64::consts::TAU * (way / std::f64::consts::TAU).round();
        last = angle;
    }
    assert!(
        turned < -0.9 * 4.0 * speed,
        "{turned} rad, {n_stuck} steps unfinished"
    );
}
