//! Flexible links in a row that are drawn straight between two places: what they store is known in closed form.

use crate::common::*;

/// Length, height and thickness of a link (m).
const LINK: [f64; 3] = [0.5, 0.05, 0.3];

/// A link of this modulus (Pa) from `x` on (m), of small or large strain.
fn link(modulus: f64, x: f64, is_small: bool) -> FlexBodyBuilder {
    let [length, height, thickness] = LINK;
    let link = FlexBodyBuilder::rectangle([length, height], [5, 1])
        .material(elastic(modulus, 600.0, 1e-3))
        .thickness(thickness)
        .translation([x, -0.5 * height]);
    if is_small { link.small_strain() } else { link }
}

/// What `n` links store that are drawn out by `gap` each (J).
fn stored(n: usize, modulus: f64, gap: f64) -> f64 {
    let [length, height, thickness] = LINK;
    0.5 * n as f64 * modulus * height * thickness / length * gap * gap
}

/// Links that are pinned to each other, `gap` apart, and by both ends to the world; they turn against each other at first.
fn pinned(
    scene: &mut Scene,
    n: usize,
    (modulus, gap): (f64, f64),
    is_small: bool,
) -> Vec<FlexBodyHandle> {
    let space = LINK[0] + gap;
    let mut links: Vec<FlexBodyHandle> = Vec::new();
    for k in 0..n {
        let turn = if k % 2 == 0 { 0.1 } else { -0.1 };
        let body = link(modulus, k as f64 * space, is_small).angvel(turn);
        let body = scene.flexible(body);
        let left = AttachmentBuilder::pin(body).where_(|[x, _]| x == 0.0);
        let left = match links.last() {
            None => left.to_world().at_point([0.0, 0.0]),
            Some(&before) => left.to_flexible(before),
        };
        scene
            .bodies
            .attach(left, &scene.world.bodies)
            .expect("nodes of an edge");
        links.push(body);
    }
    let right = AttachmentBuilder::pin(links[n - 1]).where_(|[x, _]| x == LINK[0]);
    let right = right.to_world().at_point([n as f64 * space, 0.0]);
    scene
        .bodies
        .attach(right, &scene.world.bodies)
        .expect("nodes of an edge");
    links
}

/// The same two links, welded to hubs that rapier's hinges hold.
fn hinged(scene: &mut Scene, (modulus, gap): (f64, f64), is_small: bool) -> Vec<FlexBodyHandle> {
    let space = LINK[0] + gap;
    let ground = scene.world.insert_body(RigidBodyBuilder::fixed());
    let hub = |scene: &mut Scene, x: f64| {
        let mass = MassProperties::new(Vector::ZERO, real(0.5), real(1e-3));
        let hub = RigidBodyBuilder::dynamic().translation(vec2(x, 0.0));
        scene
            .world
            .insert_body(hub.additional_mass_properties(mass))
    };
    let hinge = |x: f64| RevoluteJointBuilder::new().local_anchor1(vec2(x, 0.0));
    let (mut links, mut last) = (Vec::new(), ground);
    for k in 0..2 {
        let x = k as f64 * space;
        let body = scene.flexible(link(modulus, x, is_small));
        let hubs = [x, x + LINK[0]].map(|x| hub(scene, x));
        for (hub, end) in hubs.into_iter().zip([0.0, LINK[0]]) {
            let weld = AttachmentBuilder::weld(body).where_(move |[x, _]| x == end);
            let weld = weld.to_rigid_body(hub);
            scene
                .bodies
                .attach(weld, &scene.world.bodies)
                .expect("nodes of an edge");
        }
        scene.world.insert_impulse_joint(last, hubs[0], hinge(0.0));
        (last, links) = (hubs[1], [links, vec![body]].concat());
    }
    scene
        .world
        .insert_impulse_joint(ground, last, hinge(2.0 * space));
    links
}

/// A force that pulls turns a link back by its lever, far faster than a step is long: bars of small strain used to swing farther with every iteration, and
/// what was solved by chance had up to thousands of times the energy that had been brought.
#[test]
fn what_is_drawn_straight_stores_what_was_brought() {
    let mut findings = Findings::default();
    // Drawn out by up to a hundredth of their length, by 15 to 3,000 kN.
    for (modulus, gap) in [
        (1e8, 5e-3),
        (1e9, 5e-3),
        (7e10, 5e-4),
        (2.1e11, 1e-4),
        (2.1e11, 5e-4),
    ] {
        for rate in [60.0, 240.0] {
            for is_small in [false, true] {
                // Hinges of rigid hubs yield to forces of thousands of times their weight.
                let yields = modulus > 1e10;
                for n in [0, 2, 4].into_iter().skip(usize::from(yields)) {
                    let mut scene = Scene::in_free_space(1.0 / rate);
                    let links = match n {
                        0 => hinged(&mut scene, (modulus, gap), is_small),
                        n => pinned(&mut scene, n, (modulus, gap), is_small),
                    };
                    // Hubs share the gaps as the links do.
                    let brought = stored(links.len(), modulus, gap);
                    let (mut most, mut energy, mut n_unsolved) = (0.0f64, 0.0, 0);
                    for _ in 0..(2.0 * rate) as usize {
                        let report = scene.try_step().expect("the input is right");
                        n_unsolved += usize::from(!is_solved(report));
                        let of = report.energy();
                        energy = of.kinetic + of.elastic;
                        most = most.max(energy);
                    }
                    let given = scene.report().energy().dissipated;
                    // They swing by .1 rad/s in the beginning: .02 J of every link.
                    let more = 0.03 * links.len() as f64 + 0.01 * brought;
                    let holds = most <= brought + more && (energy / brought - 1.0).abs() < 0.02;
                    // Damped bodies of large strain turn what closes them at once into heat.
                    let is_told = given > -more && (!is_small || given < 2.0 * more);
                    findings.check(n_unsolved == 0 && holds && is_told, || {
                        format!(
                            "{modulus:e} Pa, {gap} m, {rate} Hz, small {is_small}, {n} links: brought {brought} J, at most {most}, in the end {energy}, dissipated {given}, unsolved {n_unsolved}"
                        )
                    });
                }
            }
        }
    }
    findings.report();
}

/// A link on a pin that a spring pulls taut is longer by `F L / E A` and swings no farther than at first: both hold on to the world, which does not turn
/// with it.
#[test]
fn a_link_that_a_spring_pulls_taut_swings_no_farther() {
    let [length, height, thickness] = LINK;
    for (modulus, stiffness) in [(1e9, 1e5), (1e9, 1e6), (1e10, 1e7)] {
        for rate in [60.0, 240.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            let body = scene.flexible(link(modulus, 0.0, true).angvel(0.1));
            let end = |x: f64| move |[at, _]: [f64; 2]| at == x;
            let pin = AttachmentBuilder::pin(body).where_(end(0.0)).to_world();
            let spring = AttachmentBuilder::spring_damper(body, stiffness, 1e-2 * stiffness)
                .where_(end(length))
                .rest_length(0.4)
                .to_world()
                .at_point([length + 0.5, 0.0]);
            for attachment in [pin.at_point([0.0, 0.0]), spring] {
                let attached = scene.bodies.attach(attachment, &scene.world.bodies);
                attached.expect("nodes of an edge");
            }
            let own = modulus * height * thickness / length;
            let expected = 0.1 * stiffness / (own + stiffness);
            let (mut swings, mut longer) = ([0.0f64; 2], 0.0);
            for half in &mut swings {
                for _ in 0..rate as usize {
                    scene.step();
                    let body = scene.body(body);
                    let places = (0..body.n_nodes()).map(|node| body.position(node));
                    let right: Vec<[f64; 2]> = places.filter(|x| x[0] > 0.99 * length).collect();
                    let sum = right
                        .iter()
                        .fold([0.0; 2], |sum, x| [sum[0] + x[0], sum[1] + x[1]]);
                    let [x, y] = sum.map(|sum| sum / right.len() as f64);
                    *half = half.max(y.abs());
                    longer = x.hypot(y) - length;
                }
            }
            let context = format!("{modulus:e} Pa, {stiffness:e} N/m, {rate} Hz");
            assert!(
                (longer - expected).abs() < 1e-2 * expected,
                "{context}: longer by {longer} m, not {expected}"
            );
            assert!(
                swings[1] <= 1.05 * swings[0] && swings[0] < 0.02,
                "{context}: swings by {swings:?} m"
            );
        }
    }
}
