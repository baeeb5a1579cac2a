//! Scenes that people build first: a bin of jelly, a block that is crushed, a strip that is folded up, a rope that is thrown in a heap. Each is judged in
//! every step by where things are and by the energy that is left.

mod common;

use common::*;
use foil2d::fe::material::hyperelastic::{HyperelasticSolid, NeoHookean};
use foil2d::pipeline::{Participant, Quality};

/// Pairs of edges of a surface that cross.
fn n_crossings(body: &FlexBody) -> usize {
    let edges = body.mesh().boundary().segments();
    let at = |node: usize| body.position(node);
    let side = |a: Point, b: Point, c: Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut n = 0;
    for (index, &[a, b]) in edges.iter().enumerate() {
        let [from, to] = [a, b].map(at);
        let reach = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        for &[c, d] in &edges[index + 1..] {
            if [a, b].iter().any(|end| [c, d].contains(end)) {
                continue;
            }
            let [c, d] = [c, d].map(at);
            let long = reach + (d[0] - c[0]).abs().max((d[1] - c[1]).abs());
            if (c[0] - from[0]).abs() > long || (c[1] - from[1]).abs() > long {
                continue;
            }
            let cross = side(from, to, c) * side(from, to, d) < 0.0
                && side(c, d, from) * side(c, d, to) < 0.0;
            n += usize::from(cross);
        }
    }
    n
}

/// Twenty soft blocks fall into a bin. Those of 2e4 Pa sink by a third under the others.
#[test]
fn twenty_soft_blocks_fall_into_a_bin_and_come_to_rest() {
    let mut findings = Findings::default();
    for young in [2e4, 1e5] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        for x in [-0.95, 0.95] {
            scene.fixed(ColliderBuilder::cuboid(0.1, 3.0).translation(vec2(x, 3.0)));
        }
        for k in 0..20 {
            let [column, row] = [k % 4, k / 4].map(f64::from);
            let at = [-0.76 + 0.38 * column + 0.03 * (row % 2.0), 0.1 + 0.42 * row];
            scene.flexible(
                FlexBodyBuilder::rectangle([0.3, 0.3], [5, 5])
                    .material(elastic(young, 500.0, 1e-2))
                    .friction(0.5)
                    .rotation(0.1 * (row % 3.0 - 1.0))
                    .translation(at),
            );
        }
        let name = format!("E {young:.0e}");
        let mass: f64 = scene.bodies.iter().map(|(_, body)| body.mass()).sum();
        let begin = energy_of(&scene);
        let mut onlooker = Onlooker::default();
        let mut unfinished = 0;
        let mut most = f64::NEG_INFINITY;
        onlooker.watch(&mut scene, 360, |scene| {
            unfinished += usize::from(scene.report().quality() == Quality::Unfinished);
            most = most.max(energy_of(scene) - begin);
        });
        let brought = mass * G * 0.5;
        let overlap = onlooker.overlap();
        let [x, y] = momentum_of(&scene).map(|part| part / mass);
        let bodies: Vec<&FlexBody> = scene.bodies.iter().map(|(_, body)| body).collect();
        let forces = bodies.iter().map(|body| body.total_contact_force()[1]);
        let carried: f64 = forces.sum();
        let speeds = bodies
            .iter()
            .map(|body| (2.0 * body.energy().kinetic / body.mass()).sqrt());
        let fastest = speeds.fold(0.0, f64::max);
        println!(
            "{name}: {} steps not solved, {unfinished} of them unfinished, overlap {:.1e} of a thickness, {most:.2e} J above what there was, ends at {:.1e} m/s, fastest {fastest:.1e}, {:.4} of the weight, {:?}",
            onlooker.n_unsolved(),
            overlap.share,
            x.hypot(y),
            carried / (mass * G),
            onlooker.most_from(0),
        );
        findings.check(unfinished == 0, || {
            format!("{name}: {unfinished} unfinished")
        });
        findings.check(overlap.share < Onlooker::DEEPEST, || {
            format!("{name}: {overlap:?}")
        });
        findings.check(most < 1e-3 * brought, || format!("{name}: {most} J gained"));
        onlooker.check_energy(&mut findings, &name, brought);
        findings.check(fastest < 0.05, || format!("{name}: {fastest} m/s"));
        findings.check((carried / (mass * G) - 1.0).abs() < 0.02, || {
            format!("{name}: {carried} N carried")
        });
    }
    findings.report();
}

/// A plate comes down on a block to a fifth of its height, its sides fold, and goes up again: the block is what it was.
#[test]
fn a_block_crushed_to_a_fifth_of_its_height_comes_back() {
    let mut scene = Scene::new(1.0 / 120.0);
    scene.ground(0.5);
    let size = 0.5;
    let law = NeoHookean::plane_strain(1e5, 0.3);
    let solid = HyperelasticSolid::new(law).with_density(1000.0);
    let block = FlexBodyBuilder::rectangle([size, size], [8, 8])
        .material(solid.with_damping(foil2d::fe::material::Rayleigh {
            mass: 0.0,
            stiffness: 0.02,
        }))
        .friction(0.5)
        .translation([-0.5 * size, 1e-3]);
    let block = scene.flexible(block);
    let (plate, _) = scene.rigid(
        RigidBodyBuilder::kinematic_velocity_based().translation(vec2(0.0, size + 0.06)),
        ColliderBuilder::cuboid(1.0, 0.05).friction(0.5),
    );
    let rest = scene.body(block).positions().to_vec();
    let (mut worst, mut crossings, mut lowest) = ([0usize; 2], 0, f64::INFINITY);
    for step in 0..480 {
        // Down by .41 m within a second, up again in another.
        let speed = match step {
            0..120 => -0.41,
            120..144 => 0.0,
            144..264 => 0.6,
            _ => 0.0,
        };
        scene.world.bodies[plate].set_linvel(vec2(0.0, speed), true);
        let report = scene.try_step().expect("the step can be taken");
        worst[0] += usize::from(report.quality() == Quality::Cut);
        worst[1] += usize::from(report.quality() == Quality::Unfinished);
        crossings += n_crossings(scene.body(block)) + scene.report().self_crossing().len();
        let under = place_of(&scene.world.bodies[plate])[1] - 0.05;
        lowest = lowest.min(under);
        let top = scene.body(block).positions().chunks_exact(2);
        let over = top.map(|at| at[1] - under).fold(f64::MIN, f64::max);
        assert!(over < 1e-4, "step {step}: {over} m in the plate");
    }
    let body = scene.body(block);
    let shift = body.centre_of_mass()[0];
    let off = body.positions().chunks_exact(2).zip(rest.chunks_exact(2));
    let off = off
        .map(|(now, was)| (now[0] - shift - was[0]).hypot(now[1] - was[1]))
        .fold(0.0, f64::max);
    println!(
        "crushed to {lowest:.3} m, {worst:?} cut and unfinished, {crossings} crossings, {off:.2e} m off in the end"
    );
    assert!(lowest < 0.2 * size + 1e-3, "{lowest}");
    assert_eq!(crossings, 0);
    assert_eq!(worst[1], 0, "unfinished");
    // It sags by ρ g h²/2 over its stiffness: 1.2 cm of a column, less as it is.
    assert!(off < 0.013, "{off} m");
}

/// Places where a body touches itself, apart from each other by more than `length` (m).
fn own_places(report: &StepReport, body: FlexBodyHandle, length: f64) -> Vec<Point> {
    let own = Participant::Flex(body);
    let mut places: Vec<Point> = Vec::new();
    for contact in report.contacts() {
        let is_own = contact.contactor == own && contact.target == own;
        let [x, y] = contact.position;
        if is_own
            && places
                .iter()
                .all(|at| (at[0] - x).hypot(at[1] - y) > length)
        {
            places.push([x, y]);
        }
    }
    places
}

/// A strip in a channel is pushed from both ends until it lies in folds that touch each other.
#[test]
fn a_strip_is_folded_up_in_a_channel() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let (length, height, channel) = (2.4, 0.02, 0.13);
    for side in [-1.0, 1.0] {
        scene.fixed(
            ColliderBuilder::cuboid(2.0, 0.1)
                .translation(vec2(0.5 * length, side * (channel + 0.1)))
                .friction(0.1),
        );
    }
    let strip = FlexBodyBuilder::rectangle([length, height], [96, 1])
        .material(elastic(1e6, 1000.0, 0.01))
        .friction(0.1)
        .translation([0.0, -0.5 * height])
        .pin_where(|[x, _]| !(0.01..=2.39).contains(&x), Pin::both());
    let strip = scene.flexible(strip);
    let nodes = scene.body(strip).mesh().nodes().to_vec();
    let middle = nodes
        .iter()
        .position(|[x, y]| (x - 0.4).abs() < 1e-9 && *y < 1e-9)
        .expect("a node");
    scene.bodies[strip]
        .set_nodal_force(middle, [0.0, 0.5])
        .expect("a node of the body");
    let (mut folds, mut n) = (0, [0usize; 2]);
    for step in 0..600 {
        let gone = 0.88 * 0.5 * length * f64::from(step.min(540)) / 540.0;
        for (node, [x, _]) in nodes.iter().enumerate() {
            let way = if *x < 0.01 {
                gone
            } else if *x > 2.39 {
                -gone
            } else {
                continue;
            };
            let set = scene.bodies[strip].set_pin_displacement(node, [way, 0.0]);
            set.expect("a pinned node");
        }
        let report = scene.try_step().expect("the step can be taken");
        n[0] += usize::from(report.quality() == Quality::Cut);
        n[1] += usize::from(report.quality() == Quality::Unfinished);
        folds = folds.max(own_places(report, strip, 0.05).len());
        assert!(report.self_crossing().is_empty(), "step {step}");
        assert_eq!(n_crossings(scene.body(strip)), 0, "step {step}");
    }
    println!("{folds} places touch, {n:?} cut and unfinished");
    assert!(folds >= 3, "{folds} places touch");
    assert_eq!(n[1], 0, "unfinished");
}

/// A rope of 200 cells is thrown over a peg, and slides off it into a heap.
#[test]
fn a_rope_is_thrown_over_a_peg_and_onto_a_heap() {
    let mut scene = Scene::new(1.0 / 120.0);
    scene.ground(0.5);
    let peg = ColliderBuilder::ball(0.1).translation(vec2(0.0, 1.3));
    scene.fixed(peg.friction(0.2));
    let rope = FlexBodyBuilder::rectangle([4.0, 0.02], [200, 1])
        .material(elastic(5e6, 1000.0, 2e-3))
        .friction(0.3)
        .translation([-1.4, 1.6])
        .linvel([0.5, 1.0]);
    let rope = scene.flexible(rope);
    let begin = energy_of(&scene);
    let brought = scene.body(rope).mass() * G * 1.6;
    let (mut most, mut n, mut touches, mut on_peg) = (f64::MIN, [0usize; 2], 0, 0);
    for step in 0..360 {
        let report = scene.try_step().expect("the step can be taken");
        n[0] += usize::from(report.quality() == Quality::Cut);
        n[1] += usize::from(report.quality() == Quality::Unfinished);
        touches = touches.max(own_places(report, rope, 0.05).len());
        on_peg += usize::from(report.contacts().iter().any(|one| one.position[1] > 1.0));
        assert!(report.self_crossing().is_empty(), "step {step}");
        assert_eq!(n_crossings(scene.body(rope)), 0, "step {step}");
        most = most.max(energy_of(&scene) - begin);
    }
    println!(
        "{touches} places touch, {on_peg} steps on the peg, {n:?} cut and unfinished, {most:.2e} J above what there was of {brought:.2e}"
    );
    assert!(on_peg > 10 && touches >= 3, "{on_peg}, {touches}");
    assert_eq!(n[1], 0, "unfinished");
    assert!(most < 1e-3 * brought, "{most} J");
}
