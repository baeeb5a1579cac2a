//! Stacks: heavy on light on flexible, and forces that a statically indeterminate box spreads evenly.

mod common;

use common::*;
use foil2d::pipeline::{ContactReport, Participant};

/// A rigid box of half extents `half` (m), density 0 but for its `mass` (kg).
fn boxed(
    scene: &mut Scene,
    at: [f64; 2],
    half: [f64; 2],
    mass: f64,
) -> (RigidBodyHandle, ColliderHandle) {
    scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1])),
        ColliderBuilder::cuboid(real(half[0]), real(half[1]))
            .density(0.0)
            .mass(real(mass))
            .friction(0.5),
    )
}

/// Upward force of one participant on another (N).
fn upward(contacts: &[ContactReport], below: Participant, above: Participant) -> f64 {
    contacts
        .iter()
        .map(|contact| {
            let [nx, ny] = contact.normal;
            let force = contact.normal_force * ny + contact.tangential_force * nx;
            if (contact.contactor, contact.target) == (above, below) {
                force
            } else if (contact.contactor, contact.target) == (below, above) {
                -force
            } else {
                0.0
            }
        })
        .sum()
}

/// Three boxes on a beam of 4 m × 0.2 m with its lower corners pinned; largest errors of the three interfaces' forces in
/// the last ten seconds of a minute, relative to the weight above.
fn three_boxes(masses: [f64; 3], x: f64, dt: f64) -> f64 {
    let mut scene = Scene::new(dt);
    let beam = scene.flexible(
        FlexBodyBuilder::rectangle([4.0, 0.2], [40, 4])
            .material(elastic(1e10, 1000.0, 0.02))
            .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both()),
    );
    let boxes: Vec<_> = (0..3)
        .map(|k| boxed(&mut scene, [x, 0.4 + 0.4 * k as f64], [0.2, 0.2], masses[k]))
        .collect();
    let mut worst = 0.0f64;
    let steps = (60.0 / dt) as usize;
    for step in 0..steps {
        scene.step();
        if step < steps - (10.0 / dt) as usize {
            continue;
        }
        let mut below = Participant::Flex(beam);
        for k in 0..3 {
            let own = Participant::Rigid(boxes[k].1);
            let force = upward(scene.report().contacts(), below, own);
            worst = worst.max((force / (masses[k..].iter().sum::<f64>() * G) - 1.0).abs());
            below = own;
        }
    }
    for (k, (body, _)) in boxes.iter().enumerate() {
        let body = &scene.world.bodies[*body];
        let off = f64::from(body.translation().x) - x;
        assert!(off.abs() < 0.01, "box {k} is {off} m beside its place");
        assert!(
            body.linvel().length() < 1e-4,
            "box {k} moves at {:?}",
            body.linvel()
        );
    }
    worst
}

#[test]
fn three_boxes_of_one_weight_stand_on_a_beam_for_a_minute() {
    // Once between the nodes of the beam and once with the boxes' corners exactly above nodes.
    for x in [2.03, 2.0] {
        let error = three_boxes([100.0; 3], x, 1.0 / 60.0);
        assert!(error < 1e-3, "x {x}: forces are off by {error:e}");
    }
}

#[test]
fn a_box_a_thousand_times_heavier_stands_on_two_light_ones_on_a_beam_for_a_minute() {
    for x in [2.03, 2.0] {
        let error = three_boxes([10.0, 10.0, 10_000.0], x, 1.0 / 60.0);
        assert!(error < 1e-3, "x {x}: forces are off by {error:e}");
    }
}

#[test]
fn a_body_a_million_times_heavier_on_a_light_one_presses_with_the_total_weight() {
    let mut findings = Findings::default();
    // B22, on a flexible block that the weight squeezes by 1 %, or hardly.
    for (young, dt) in [(1e9, 1.0 / 60.0), (1e11, 1.0 / 60.0), (1e11, 1.0 / 500.0)] {
        let mut scene = Scene::new(dt);
        let ground = scene.ground(0.5);
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).material(
                LinearElastic::plane_stress(young, 0.3)
                    .density(1000.0)
                    // The heavy body rocks at 5 rad/s: exp(-18) of that is left after 30 s.
                    .rayleigh(5e-2),
            ),
        );
        let (light, _) = boxed(&mut scene, [0.507, 1.1], [0.3, 0.1], 1.0);
        let (heavy, _) = boxed(&mut scene, [0.507, 1.5], [0.3, 0.3], 1e6);
        scene.steps((30.0 / dt) as usize);
        let places = [light, heavy].map(|body| scene.world.bodies[body].translation());
        scene.steps((10.0 / dt) as usize);
        let total = G * (1e6 + 1.0 + scene.body(block).mass());
        let (own, floor) = (Participant::Flex(block), Participant::Rigid(ground));
        let force = upward(scene.report().contacts(), floor, own);
        let error = (force / total - 1.0).abs();
        findings.check(error < 1e-6, || {
            format!("E {young:e}, dt {dt}: off by {error:e}")
        });
        for (body, place) in [light, heavy].into_iter().zip(places) {
            let drift = (scene.world.bodies[body].translation() - place).length();
            findings.check(drift < 1e-6, || {
                format!("E {young:e}, dt {dt}: drifts by {drift:e} m")
            });
        }
    }
    findings.report();
}

#[test]
fn a_box_on_four_points_presses_evenly() {
    // Two feet, two points each: one more than statics decides on rigid ground, and symmetric on a flexible block.
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4]).material(elastic(1e8, 1000.0, 5e-3)),
    );
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(1.0, 0.7))
        .can_sleep(false);
    let body = scene.world.insert_body(body);
    let feet = [-0.5, 0.5].map(|x| {
        let foot = ColliderBuilder::cuboid(0.11, 0.2).translation(vec2(x, 0.0));
        scene
            .world
            .insert_collider(foot.density(1000.0), Some(body))
    });
    scene.steps(1200);
    let half = 0.5 * scene.mass(body) * G;
    for foot in feet {
        let [_, force] = scene.force_on_collider(foot);
        assert!(
            (force / half - 1.0).abs() < 1e-3,
            "a foot presses {force} N, not {half} N"
        );
    }
    let report = scene.report();
    assert!(report.gap_violation() < by_precision(1e-6, 1e-9));
    // Mirrored about the middle, points carry the same force.
    let on_top: Vec<_> = report
        .contacts()
        .iter()
        .filter(|contact| contact.position[1] > 0.4)
        .collect();
    assert!(on_top.len() >= 4, "only {} points carry", on_top.len());
    for contact in &on_top {
        let mirrored =
            |other: &&&ContactReport| (contact.position[0] + other.position[0] - 2.0).abs() < 1e-4;
        let partners = on_top.iter().filter(mirrored);
        let other: f64 = partners.map(|other| other.normal_force).sum();
        let own: f64 = on_top
            .iter()
            .filter(|other| (contact.position[0] - other.position[0]).abs() < 1e-4)
            .map(|other| other.normal_force)
            .sum();
        assert!(
            (own / other - 1.0).abs() < 1e-2,
            "{own} N at {:?}, {other} N opposite",
            contact.position
        );
    }
    let total = (scene.mass(body) + scene.body(block).mass()) * G;
    let lifted: f64 = (0..scene.body(block).n_nodes())
        .map(|node| scene.body(block).contact_force(node)[1])
        .sum();
    assert!(
        (lifted / (total - 2.0 * half) - 1.0).abs() < 1e-3,
        "the block gets {lifted} N"
    );
}

#[test]
fn four_supports_under_a_rigid_box_share_its_weight_equally() {
    // Four equal flexible posts under one rigid box: three unknowns of statics, four forces, one symmetric answer.
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let posts = [0.0, 1.0, 2.0, 3.0].map(|x| {
        scene.flexible(
            FlexBodyBuilder::rectangle([0.2, 0.4], [4, 8])
                .translation([x, 0.0])
                .material(elastic(1e8, 1000.0, 5e-3))
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        )
    });
    let (body, _) = boxed(&mut scene, [1.6, 0.6], [1.8, 0.2], 4000.0);
    scene.steps(1200);
    let quarter = 0.25 * scene.mass(body) * G;
    // A rigid box on equal springs shares by statics and symmetry alone if it stays level: (1/4, 1/4, 1/4, 1/4).
    for post in posts {
        let force = -scene.force_on_flexible(post)[1];
        assert!(
            (force / quarter - 1.0).abs() < 1e-3,
            "a post carries {force} N, not {quarter} N"
        );
    }
}

/// Blocks and boxes of one width, edge on edge, from 1 mm apart, for two seconds: the largest overlap (m), and the energy gained over
/// what the first step began with (-).
fn edge_on_edge(rate: f64) -> [f64; 2] {
    let mut scene = Scene::new(1.0 / rate);
    scene.ground(0.5);
    for layer in 0..6 {
        let bottom = 0.001 + 0.251 * f64::from(layer);
        if layer % 2 == 0 {
            scene.flexible(
                FlexBodyBuilder::rectangle([0.5, 0.25], [6, 3])
                    .material(elastic(1e6, 1000.0, 1e-3))
                    .translation([-0.25, bottom]),
            );
        } else {
            boxed(&mut scene, [0.0, bottom + 0.125], [0.25, 0.125], 125.0);
        }
    }
    let first = scene.step().energy().total();
    let [mut overlap, mut most] = [0.0f64, first];
    for _ in 0..(2.0 * rate) as usize {
        let report = scene.step();
        overlap = overlap.max(report.gap_violation());
        most = most.max(report.energy().total());
    }
    [overlap, most / first - 1.0]
}

#[test]
fn blocks_and_boxes_of_one_width_stand_edge_on_edge() {
    // Under load a block bulges over the edge of the box by 1 mm: its corner belongs above the box, not beside it. Corners that
    // were taken to be beside each other pinched, up to 2,000 times the energy of the fall.
    for rate in [60.0, 120.0, 240.0] {
        let [overlap, gain] = edge_on_edge(rate);
        println!("1/{rate} s: overlap {overlap:e} m, gain {gain:e}");
        assert!(gain < 1e-3, "{gain} at 1/{rate} s");
        // Gaps are closed to 2e-12 of the scene's size, or the last iteration's 1e5 times that. At 1/60 s corners cross over in
        // single steps (7e-5 m seen).
        let is_resolved = rate > 100.0;
        assert!(overlap < 1e-6 || !is_resolved, "{overlap} at 1/{rate} s");
    }
}

#[test]
fn a_tower_on_a_soft_block_does_not_rock_itself_up() {
    // Eight boxes turn about the edges of a block that is soft within the step, the top one pushed a little. At 1/60 s their spin grew by
    // 1.6 a second while accelerations of the boxes left out what they carry.
    for rate in [30.0, 60.0, 120.0] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.5);
        scene.flexible(
            FlexBodyBuilder::rectangle([0.5, 0.3], [6, 4])
                .material(elastic(1e7, 1000.0, 1e-3))
                .friction(0.5)
                .translation([-0.25, 0.0]),
        );
        let boxes: Vec<_> = (0..8)
            .map(|k| {
                boxed(
                    &mut scene,
                    [0.0, 0.375 + 0.15 * f64::from(k)],
                    [0.25, 0.075],
                    75.0,
                )
            })
            .collect();
        scene.world.bodies[boxes[7].0].set_angvel(real(0.01), true);
        let mut spins = [0.0f64; 2];
        for step in 0..(15.0 * rate) as usize {
            scene.step();
            let fastest = boxes
                .iter()
                .map(|&(body, _)| scene.world.bodies[body].angvel().abs());
            let fastest = fastest.fold(0.0, foil2d::rapier::math::Real::max);
            let late = usize::from(step as f64 > 10.0 * rate);
            spins[late] = spins[late].max(f64::from(fastest));
        }
        println!("1/{rate} s: {spins:?}");
        // What is left are contacts at the block's edges that open and close; without the cure 0.1 and more at 1/60 s.
        assert!(spins[1] < 1e-3, "{spins:?} rad/s at 1/{rate} s");
    }
}
