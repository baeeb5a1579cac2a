//! Flexible bodies that meet themselves: arms that are pressed together, strips that fold, tips that clap.

mod common;

use common::*;
use foil2d::fe::material::LinearElastic;
use foil2d::fe::material::hyperelastic::{HyperelasticSolid, NeoHookean};
use foil2d::fe::mesh::CellKind;
use foil2d::pipeline::Participant;

/// Side of a cell of the U (m).
const CELL: f64 = 0.1;

/// Cells of the U: two arms of two cells, three apart, on a base of two.
const WIDE: usize = 7;
const HIGH: usize = 12;

/// A body in the shape of a U, its lower left corner at the origin.
///
/// ```text
/// +--+     +--+   1.2
/// |  |     |  |
/// |  |     |  |
/// |  +-----+  |   0.2
/// +-----------+
///    .2   .5  .7
/// ```
fn u_shape() -> FlexBodyBuilder {
    let is_cell = |i: usize, j: usize| j < 2 || !(2..5).contains(&i);
    let mut names = vec![usize::MAX; (WIDE + 1) * (HIGH + 1)];
    let (mut nodes, mut cells) = (Vec::new(), Vec::new());
    for j in 0..HIGH {
        for i in (0..WIDE).filter(|&i| is_cell(i, j)) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            cells.push(corners.map(|(i, j)| {
                let name = &mut names[j * (WIDE + 1) + i];
                if *name == usize::MAX {
                    *name = nodes.len();
                    nodes.push([CELL * i as f64, CELL * j as f64]);
                }
                *name
            }));
        }
    }
    FlexBodyBuilder::cells(nodes, CellKind::Quad4, &cells)
}

fn rubber(young: f64) -> HyperelasticSolid {
    HyperelasticSolid::new(NeoHookean::plane_strain(young, 0.3)).with_density(1000.0)
}

/// Pairs of edges of a surface that cross.
fn n_crossings(body: &FlexBody) -> usize {
    let edges = body.mesh().boundary().segments();
    let at = |node: usize| body.position(node);
    let side = |a: Point, b: Point, c: Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut n = 0;
    for (index, &[a, b]) in edges.iter().enumerate() {
        for &[c, d] in &edges[index + 1..] {
            if [a, b].iter().any(|end| [c, d].contains(end)) {
                continue;
            }
            let [a, b, c, d] = [a, b, c, d].map(at);
            let cross = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
            n += usize::from(cross);
        }
    }
    n
}

/// Forces of the contacts that a body has with itself, along their normals, summed (N).
fn own_force(report: &StepReport, body: FlexBodyHandle) -> f64 {
    let own = Participant::Flex(body);
    let contacts = report.contacts().iter();
    let of_itself = contacts.filter(|one| one.contactor == own && one.target == own);
    of_itself.map(|contact| contact.normal_force).sum()
}

/// The nodes of the outer sides of both tips.
fn tips(body: &FlexBody) -> [Vec<usize>; 2] {
    [0.0, 0.7].map(|x| {
        let nodes = body.mesh().nodes().iter().enumerate();
        let at = nodes.filter(|(_, node)| (node[0] - x).abs() < 1e-9 && node[1] > 1.05);
        at.map(|(node, _)| node).collect()
    })
}

/// What presses the arms together where they touch already goes through the contact. These touch below where they are pressed, and the feet of the
/// arms take up that couple: a tenth more than what comes on top goes through the contact of the body of large strain.
#[test]
fn arms_that_are_pressed_together_touch_and_carry_the_load() {
    for is_sensor in [false, true] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let builder = u_shape()
            .material(
                LinearElastic::plane_strain(1e6, 0.3)
                    .density(1000.0)
                    .rayleigh(0.02),
            )
            .pin_where(|[_, y]| y < 1e-9, Pin::both());
        let body = scene.flexible(builder.sensor(is_sensor));
        let mut carried = Vec::new();
        let mut last = 0.0;
        for load in [12e3, 16e3] {
            let tips = tips(scene.body(body));
            for step in 0..480 {
                // Laid on by and by: what friction holds depends on how it came there.
                let now = last + (load - last) * (f64::from(step + 1) / 240.0).min(1.0);
                for (nodes, sign) in tips.iter().zip([1.0, -1.0]) {
                    let each = sign * now / nodes.len() as f64;
                    for &node in nodes {
                        let set = scene.bodies[body].set_nodal_force(node, [each, 0.0]);
                        set.expect("a node of the body");
                    }
                }
                scene.step();
                assert!(is_sensor || n_crossings(scene.body(body)) == 0);
                assert!(scene.report().self_crossing().is_empty());
            }
            last = load;
            carried.push(own_force(scene.report(), body));
        }
        // A sensor touches nothing, itself included.
        if is_sensor {
            assert_eq!(carried, [0.0; 2]);
            continue;
        }
        let more = carried[1] - carried[0];
        assert!(
            carried[0] > 0.0 && (more / 4e3 - 1.0).abs() < 0.15,
            "{carried:?}"
        );
        // What it does to itself moves it nowhere.
        let total = scene.force_on_flexible(body);
        assert!(
            total[0].abs() + total[1].abs() < 1e-6 * carried[1],
            "{total:?}"
        );
    }
}

/// Two jaws close on the arms, and open again.
#[test]
fn a_jaw_closes_a_u_and_lets_it_go() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let body = scene.flexible(u_shape().material(rubber(1e6)).translation([-0.35, 0.0]));
    let jaws = [-1.0, 1.0].map(|side: f64| {
        let at = vec2(0.6 * side, 1.0);
        let jaw = RigidBodyBuilder::kinematic_velocity_based().translation(at);
        scene.rigid(jaw, ColliderBuilder::cuboid(0.2, 0.3)).0
    });
    let mut most = 0.0f64;
    for step in 0..240 {
        let speed = if step < 120 { -0.25 } else { 0.25 };
        for (jaw, side) in jaws.iter().zip([-1.0, 1.0]) {
            scene.world.bodies[*jaw].set_linvel(vec2(speed * side, 0.0), true);
        }
        scene.step();
        most = most.max(own_force(scene.report(), body));
        assert_eq!(n_crossings(scene.body(body)), 0, "step {step}");
    }
    // There are .3 m between the jaws, and the arms are .2 m thick each.
    assert!(most > 1e3, "{most} N");
    assert_eq!(own_force(scene.report(), body), 0.0);
}

/// A strip whose ends are brought together buckles, folds into a loop and closes on itself.
#[test]
fn a_strip_pushed_from_both_ends_folds_onto_itself() {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let strip = FlexBodyBuilder::rectangle([2.0, 0.04], [50, 1])
        .material(
            LinearElastic::plane_strain(1e6, 0.3)
                .density(1000.0)
                .rayleigh(0.01),
        )
        .pin_where(|[x, _]| !(0.01..=1.99).contains(&x), Pin::both());
    let strip = scene.flexible(strip);
    let nodes = scene.body(strip).mesh().nodes().to_vec();
    let middle = nodes
        .iter()
        .position(|[x, y]| (x - 1.0).abs() < 1e-9 && *y < 1e-9);
    let middle = middle.expect("a node in the middle");
    let set = scene.bodies[strip].set_nodal_force(middle, [0.0, 0.5]);
    set.expect("a node of the body");
    let mut most = 0.0f64;
    for step in 0..300 {
        let gone = 0.93 * f64::from(step.min(240)) / 240.0;
        for (node, [x, _]) in nodes.iter().enumerate() {
            let way = if *x < 0.01 {
                gone
            } else if *x > 1.99 {
                -gone
            } else {
                continue;
            };
            let set = scene.bodies[strip].set_pin_displacement(node, [way, 0.0]);
            set.expect("a pinned node");
        }
        scene.step();
        most = most.max(own_force(scene.report(), strip));
        assert_eq!(n_crossings(scene.body(strip)), 0, "step {step}");
    }
    assert!(most > 1.0, "{most} N");
}

/// The arms of a free U fly at each other and clap.
#[test]
fn a_free_u_that_claps_keeps_its_momenta_and_gains_no_energy() {
    for friction in [0.0, 0.5] {
        let mut scene = Scene::in_free_space(1.0 / 240.0).with_integrator(Beta2::trapezoidal());
        let body = scene.flexible(u_shape().material(rubber(1e6)).friction(friction));
        let nodes = scene.body(body).mesh().nodes().to_vec();
        let velocities = nodes.iter().flat_map(|[x, y]| {
            let height = (y - 0.2).max(0.0);
            let closing = if *x < 0.35 { 12.0 } else { -9.0 };
            [closing * height + 0.3, 0.2]
        });
        let velocities: Vec<f64> = velocities.collect();
        let set = scene.bodies[body].set_velocities(&velocities);
        set.expect("velocities of all nodes");
        let start = energy_of(&scene);
        let momentum = scene.body(body).momentum();
        let spin = scene.body(body).angular_momentum([0.0; 2]);
        let (mut n_claps, mut worst) = (0, [0.0f64; 3]);
        for step in 0..480 {
            scene.step();
            assert_eq!(n_crossings(scene.body(body)), 0, "step {step}");
            n_claps += usize::from(own_force(scene.report(), body) > 0.0);
            let now = scene.body(body).momentum();
            worst[0] = worst[0].max((now[0] - momentum[0]).hypot(now[1] - momentum[1]));
            worst[1] = worst[1].max((scene.body(body).angular_momentum([0.0; 2]) - spin).abs());
            worst[2] = worst[2].max(energy_of(&scene) / start);
        }
        assert!(n_claps > 2, "{n_claps} steps with contact");
        assert!(
            worst[0] < 1e-9 * momentum[0].hypot(momentum[1]),
            "{worst:?}"
        );
        assert!(worst[1] < 1e-6 * spin.abs(), "{worst:?}");
        assert!(worst[2] < 1.01, "{worst:?}");
    }
}
