//! The restrained motion of section C.2: contactor and target are tracked from separation, the constraint is added on contact and
//! dropped when its force would pull, the tangential one is relaxed at the limit of friction and restored on sticking, and both
//! are carried across the ends of segments.

mod common;

use common::*;
use foil2d::pipeline::ContactReport;

const DT: f64 = 1.0 / 240.0;

fn block(size: [f64; 2], cells: [usize; 2]) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle(size, cells).material(elastic(1e6, 1000.0, 1e-2))
}

/// The lowest node of a body (m).
fn bottom(body: &FlexBody) -> f64 {
    let heights = (0..body.n_nodes()).map(|node| body.position(node)[1]);
    heights.fold(f64::INFINITY, f64::min)
}

#[test]
fn separated_bodies_move_freely_and_the_constraint_is_added_in_the_step_that_closes_the_gap() {
    let mut scene = Scene::new(DT).with_integrator(Beta2::trapezoidal());
    scene.ground(0.5);
    let gap = 0.05;
    let body = scene.flexible(block([1.0, 0.5], [8, 4]).translation([0.0, gap]));
    let mut met = None;
    for n in 1..60 {
        scene.step();
        let t = n as f64 * scene.dt();
        let fallen = 0.5 * G * t * t;
        let lowest = bottom(scene.body(body));
        if fallen < gap {
            assert!(
                scene.report().contacts().is_empty(),
                "a force at a distance, {t} s"
            );
            // The trapezoidal rule is exact for a constant acceleration.
            assert!(
                (lowest - (gap - fallen)).abs() < 1e-9,
                "{lowest} after {t} s"
            );
        } else if met.is_none() {
            met = Some(fallen - gap);
            let contacts = scene.report().contacts();
            assert_eq!(
                contacts.len(),
                9,
                "every node of the lower edge meets the floor"
            );
            let is_held =
                |c: &ContactReport| c.gap.abs() < by_precision(1e-6, 1e-9) && c.normal_force > 0.0;
            assert!(contacts.iter().all(is_held), "{contacts:?}");
        }
        assert!(lowest > -by_precision(1e-6, 1e-9), "overlap of {lowest}");
    }
    assert!(
        met.is_some_and(|beyond| beyond > 0.0),
        "the block has landed"
    );
}

#[test]
fn a_constraint_is_dropped_when_its_force_would_pull() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let body = scene.flexible(block([1.0, 0.5], [8, 4]));
    scene.steps(480);
    let weight = G * scene.body(body).mass();
    assert!(!scene.report().contacts().is_empty());
    // Pulled up by one corner with a growing force: the block is lifted off from there, node by node, until it leaves.
    let mut counts = vec![scene.report().contacts().len()];
    for step in 0..480 {
        let pull = 1.3 * weight * (step as f64 / 240.0).min(1.0);
        let corner = scene.body(body).n_nodes() - 1;
        scene.bodies[body]
            .set_nodal_force(corner, [0.0, pull])
            .expect("the node is there");
        scene.step();
        let contacts = scene.report().contacts();
        let rounding = 1e-12 * weight;
        let pulls = contacts.iter().any(|c| c.normal_force < -rounding);
        assert!(!pulls, "a contact pulls: {contacts:?}");
        if counts.last() != Some(&contacts.len()) {
            counts.push(contacts.len());
        }
    }
    assert!(counts.len() > 3, "released one after the other: {counts:?}");
    assert_eq!(counts.last(), Some(&0), "and then free");
    assert!(bottom(scene.body(body)) > 0.0);
}

#[test]
fn the_tangential_constraint_is_relaxed_at_the_limit_and_restored_on_sticking() {
    // Exact in both of rapier's precisions.
    let friction = 0.375;
    let mut scene = Scene::new(DT);
    scene.ground(friction);
    let body = scene.flexible(block([1.0, 0.5], [8, 4]).friction(friction));
    scene.steps(480);
    let weight = G * scene.body(body).mass();
    let n_nodes = scene.body(body).n_nodes() as f64;
    let push = |scene: &mut Scene, share: f64, n: usize| {
        let each = share * friction * weight / n_nodes;
        for node in 0..scene.body(body).n_nodes() {
            let set = scene.bodies[body].set_nodal_force(node, [each, 0.0]);
            set.expect("the node is there");
        }
        scene.steps(n);
        let contacts = scene.report().contacts();
        let n_sticking = contacts.iter().filter(|c| c.sticks).count();
        let excess = contacts.iter().fold(0.0f64, |worst, c| {
            worst.max(c.tangential_force.abs() - friction * c.normal_force)
        });
        assert!(excess <= 1e-9 * weight, "beyond the cone by {excess} N");
        (n_sticking, contacts.len(), scene.body(body).linvel()[0])
    };
    // Below the limit all nodes stick, and nothing moves.
    let (sticking, all, speed) = push(&mut scene, 0.7, 480);
    assert!(
        sticking > all / 2 && speed.abs() < 1e-6,
        "{sticking} of {all}, {speed} m/s"
    );
    // Beyond it none does: what is left over accelerates the block.
    let before = scene.body(body).linvel()[0];
    let (sticking, _, speed) = push(&mut scene, 1.5, 120);
    let gained = 0.5 * friction * G * 120.0 * scene.dt();
    assert_eq!(sticking, 0, "all slide");
    // It rocks while it starts.
    assert!(
        ((speed - before) / gained - 1.0).abs() < 0.02,
        "{speed} of {gained}"
    );
    // Back below the limit it slows down, stops, and sticks again.
    let (sticking, all, speed) = push(&mut scene, 0.5, 720);
    assert!(
        sticking > all / 2 && speed.abs() < 1e-6,
        "{sticking} of {all}, {speed} m/s"
    );
    let place = scene.body(body).centre_of_mass()[0];
    push(&mut scene, 0.5, 240);
    let creep = scene.body(body).centre_of_mass()[0] - place;
    assert!(creep.abs() < 1e-8, "creeps by {creep} m");
}

/// A small block slides along a slab whose cells are as long as half of it, over twenty ends of segments.
#[test]
fn contact_and_friction_are_carried_across_the_ends_of_segments() {
    let (friction, speed) = (0.2, 2.0);
    let dt = 1.0 / 480.0;
    let mut scene = Scene::new(dt).with_integrator(Beta2::default());
    let slab = FlexBodyBuilder::rectangle([4.0, 0.2], [37, 2])
        .material(elastic(1e9, 1000.0, 1e-3))
        .friction(friction)
        .pin_where(|[_, y]| y == 0.0, Pin::both());
    scene.flexible(slab);
    let slider = FlexBodyBuilder::rectangle([0.2, 0.1], [4, 2])
        .material(elastic(1e8, 1000.0, 1e-3))
        .friction(friction)
        .translation([0.3, 0.2])
        .linvel([speed, 0.0]);
    let slider = scene.flexible(slider);
    scene.steps(24);
    let (start, v0) = (
        scene.body(slider).centre_of_mass(),
        scene.body(slider).linvel()[0],
    );
    let (mut worst_gap, mut sum) = (0.0f64, [0.0; 2]);
    let n = 216;
    for _ in 0..n {
        let report = scene.step();
        worst_gap = worst_gap.max(report.gap_violation());
        let contacts = report.contacts();
        assert!(!contacts.is_empty(), "contact is lost on the way");
        assert!(
            contacts.iter().all(|c| !c.sticks),
            "caught at a segment's end: {contacts:?}"
        );
        let force = scene.force_on_flexible(slider);
        sum = [sum[0] + force[0] / n as f64, sum[1] + force[1] / n as f64];
    }
    let end = scene.body(slider);
    let ends_passed = (end.centre_of_mass()[0] - start[0]) / (4.0 / 37.0);
    assert!(ends_passed > 5.0, "it has passed {ends_passed} ends");
    assert!(worst_gap < 1e-9, "overlap of {worst_gap} m");
    // Friction holds to its limit all the way, and slows the slider as it does a point mass.
    assert!((-sum[0] / sum[1] / friction - 1.0).abs() < 1e-3, "{sum:?}");
    let slowed = (v0 - end.linvel()[0]) / (friction * G * n as f64 * scene.dt());
    assert!((slowed - 1.0).abs() < 1e-2, "slowed by {slowed} of mu g t");
}

/// A node that sticks exactly where two segments meet belongs to either: it may not tremble between them.
#[test]
fn a_node_that_sticks_on_the_end_of_a_segment_stays_there() {
    let mut scene = Scene::new(DT);
    let slab = block([2.0, 0.4], [8, 3])
        .friction(0.8)
        .pin_where(|[_, y]| y == 0.0, Pin::both());
    scene.flexible(slab);
    // Nodes above nodes, pushed along.
    let top = scene.flexible(
        block([0.5, 0.25], [2, 1])
            .friction(0.8)
            .translation([0.75, 0.4]),
    );
    scene.steps(960);
    let weight = G * scene.body(top).mass();
    for node in 0..scene.body(top).n_nodes() {
        let set = scene.bodies[top].set_nodal_force(node, [0.4 * weight / 6.0, 0.0]);
        set.expect("the node is there");
    }
    scene.steps(960);
    let place = scene.body(top).centre_of_mass();
    scene.steps(960);
    let now = scene.body(top).centre_of_mass();
    let creep = (now[0] - place[0]).hypot(now[1] - place[1]);
    assert!(creep < 1e-8, "creeps by {creep} m");
    let [along, up] = scene.force_on_flexible(top);
    assert!(
        (up / weight - 1.0).abs() < 1e-6 && (-along / weight - 0.4).abs() < 1e-6,
        "{along} {up}"
    );
}
