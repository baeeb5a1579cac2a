//! Chains of strips, and a strip as a rope: let go from the horizontal with a ball of 5 kg at the end.

use crate::common::*;
use foil2d::fe::material::Rayleigh;
use foil2d::fe::material::hyperelastic::{Corotated, HyperelasticSolid};
use foil2d::fe::mesh::CellKind;

const LENGTH: f64 = 4.0;
const WIDTH: f64 = 0.04;

fn ball(scene: &mut Scene) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic().translation(vec2(LENGTH + 0.2, 0.5 * WIDTH));
    let (ball, _) = scene.rigid(body, ColliderBuilder::ball(0.2).mass(5.0));
    ball
}

fn strip(length: f64, n_cells: usize, young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([length, WIDTH], [n_cells, 1])
        .material(elastic(young, 1000.0, 1e-3))
        .thickness(WIDTH)
}

/// The same strip as one of large strain, of cells that bend.
fn rope(length: f64, n_cells: usize, young: f64) -> FlexBodyBuilder {
    let law = Corotated::plane_strain(young, 0.3);
    let damping = Rayleigh {
        mass: 0.0,
        stiffness: 1e-3,
    };
    FlexBodyBuilder::rectangle_of([length, WIDTH], [n_cells, 1], CellKind::Tri6)
        .material(
            HyperelasticSolid::new(law)
                .with_density(1000.0)
                .with_damping(damping),
        )
        .thickness(WIDTH)
}

fn attach(scene: &mut Scene, attachment: AttachmentBuilder) {
    let bodies = &scene.world.bodies;
    scene.bodies.attach(attachment, bodies).expect("both exist");
}

/// Energy that comes free on the way down (J): the strip's middle falls by half its length, the ball by all of it.
fn brought() -> f64 {
    let strip = 1000.0 * LENGTH * WIDTH * WIDTH;
    G * (0.5 * LENGTH * strip + (LENGTH + 0.2) * 5.0)
}

/// Mean of the nodes of a body's end at `x` of its mesh (m).
fn end(body: &FlexBody, x: f64) -> [f64; 2] {
    let nodes = body.mesh().nodes().iter().enumerate();
    let nodes = nodes.filter(|(_, at)| (at[0] - x).abs() < 1e-9);
    let places: Vec<_> = nodes.map(|(node, _)| body.position(node)).collect();
    let n = places.len() as f64;
    places
        .iter()
        .fold([0.0; 2], |[x, y], at| [x + at[0] / n, y + at[1] / n])
}

fn swing(
    scene: &mut Scene,
    ball: RigidBodyHandle,
    mut each: impl FnMut(&Scene),
) -> (Onlooker, [f64; 2]) {
    let mut onlooker = Onlooker::default();
    let mut lowest = [0.0f64, 0.0];
    let mut furthest = 0.0f64;
    onlooker.watch(scene, 180, |scene| {
        let [x, y] = place_of(&scene.world.bodies[ball]);
        lowest[0] = lowest[0].min(y);
        furthest = furthest.max(x.hypot(y));
        each(scene);
    });
    lowest[1] = furthest;
    (onlooker, lowest)
}

/// It swings through its lowest point within 3 s, and is no longer than it was.
fn check_swing(findings: &mut Findings, name: &str, [lowest, furthest]: [f64; 2]) {
    println!("{name}: lowest {lowest:.3} m, furthest {furthest:.3} m");
    // A mathematical pendulum of 4.2 m passes its lowest point after 1.2 s; a chain that whips comes within some tenths of it.
    findings.check(lowest < -3.7, || {
        format!("{name}: the ball gets down to {lowest:.3} m")
    });
    // The ball pulls with some 3 m g at the bottom: 1 % of strain at 1e7 Pa, and twice that in the whip of the end.
    findings.check(furthest < 1.03 * (LENGTH + 0.2), || {
        format!("{name}: the ball gets {furthest:.3} m away")
    });
}

#[test]
fn a_chain_of_pinned_strips_swings() {
    swing_chain(8, 1e7);
}

#[test]
fn a_chain_of_twenty_stiff_strips_swings() {
    swing_chain(20, 1e9);
}

fn swing_chain(n: usize, young: f64) {
    let mut findings = Findings::default();
    let mut scene = Scene::new(1.0 / 60.0);
    let ball = ball(&mut scene);
    let length = LENGTH / n as f64;
    let mut links: Vec<FlexBodyHandle> = Vec::new();
    for i in 0..n {
        let link = scene.flexible(
            strip(length, 4, young)
                .translation([i as f64 * length, 0.0])
                .collision_groups(InteractionGroups::none()),
        );
        let pin = AttachmentBuilder::pin(link).where_(|[x, _]| x < 1e-9);
        let pin = match links.last() {
            Some(&before) => pin.to_flexible(before),
            None => pin.to_world(),
        };
        attach(&mut scene, pin);
        links.push(link);
    }
    let last = AttachmentBuilder::pin(links[n - 1])
        .where_(move |[x, _]| x > length - 1e-9)
        .to_rigid_body(ball);
    attach(&mut scene, last);
    let mut widest = 0.0f64;
    let (onlooker, reached) = swing(&mut scene, ball, |scene| {
        for pair in links.windows(2) {
            let [from, to] =
                [(pair[0], length), (pair[1], 0.0)].map(|(link, x)| end(scene.body(link), x));
            widest = widest.max((to[0] - from[0]).hypot(to[1] - from[1]));
        }
    });
    let name = format!("{n} links, E {young:.0e}");
    onlooker.check(&mut findings, &name);
    onlooker.check_energy(&mut findings, &name, brought());
    check_swing(&mut findings, &name, reached);
    // A pin is a row of the step's own equations; a tenth of a millimetre is what its linear part may leave of a turn.
    findings.check(widest < 1e-4, || {
        format!("{name}: links are {widest:.2e} m apart")
    });
    findings.report();
}

#[test]
fn a_strip_that_swings_keeps_the_area_of_its_cells() {
    let mut scene = Scene::new(1.0 / 60.0);
    let ball = ball(&mut scene);
    let rope = scene.flexible(rope(LENGTH, 80, 1e7));
    let pin = AttachmentBuilder::pin(rope);
    attach(&mut scene, pin.where_(|[x, _]| x < 1e-9).to_world());
    let pin = AttachmentBuilder::pin(rope);
    let at_end = pin.where_(|[x, _]| x > LENGTH - 1e-9);
    attach(&mut scene, at_end.to_rigid_body(ball));
    // Two triangles a cell of the grid.
    let rest = 0.5 * LENGTH * WIDTH / 80.0;
    let mut range = [1.0f64; 2];
    let (onlooker, reached) = swing(&mut scene, ball, |scene| {
        let body = scene.body(rope);
        for cell in body.mesh().cells() {
            let corners = cell.corners();
            let area: f64 = (0..corners.len())
                .map(|i| {
                    let from = body.position(corners[i]);
                    let to = body.position(corners[(i + 1) % corners.len()]);
                    0.5 * (from[0] * to[1] - to[0] * from[1])
                })
                .sum();
            range = [range[0].min(area / rest), range[1].max(area / rest)];
        }
    });
    let mut findings = Findings::default();
    onlooker.check(&mut findings, "rope");
    onlooker.check_energy(&mut findings, "rope", brought());
    check_swing(&mut findings, "rope", reached);
    // Strains of a few percent at most, where it is bent at its ends: (1 - nu) of them in the area.
    findings.check(range[0] > 0.9 && range[1] < 1.1, || {
        format!("a cell has {:.3} to {:.3} of its area", range[0], range[1])
    });
    findings.report();
}

#[test]
fn a_strip_between_two_pins_sags_as_a_string() {
    let mut scene = Scene::new(1.0 / 60.0);
    let body = RigidBodyBuilder::dynamic().translation(vec2(0.5 * LENGTH, -0.2));
    let (ball, _) = scene.rigid(body, ColliderBuilder::ball(0.2).mass(5.0));
    let strip = scene.flexible(rope(LENGTH, 80, 1e7));
    for x in [0.0, LENGTH] {
        let pin = AttachmentBuilder::pin(strip);
        let at_end = pin.where_(move |[at, _]| (at - x).abs() < 1e-9);
        attach(&mut scene, at_end.to_world());
    }
    let pin = AttachmentBuilder::pin(strip);
    let in_the_middle = pin.where_(|[x, y]| (x - 0.5 * LENGTH).abs() < 1e-6 && y < 1e-9);
    attach(&mut scene, in_the_middle.to_rigid_body(ball));
    let mut lowest = 0.0f64;
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 180, |scene| {
        lowest = lowest.min(place_of(&scene.world.bodies[ball])[1] + 0.2);
    });
    let mut findings = Findings::default();
    onlooker.check(&mut findings, "string");
    // Two halves that turn by t stretch by t² / 2 and carry E A t³: energy E A L t⁴ / 8 against the weight of the ball and half of
    // that of the strip on the way L t / 2. t = (4 W / (E A))^(1/3) = 0.27, 0.55 m down, less what bending carries.
    let weight = G * (5.0 + 0.5 * 1000.0 * LENGTH * WIDTH * WIDTH);
    let turn = (4.0 * weight / (1e7 * WIDTH * WIDTH)).cbrt();
    let expected = -0.5 * LENGTH * turn;
    println!("string: lowest {lowest:.3} m, {expected:.3} m by energy");
    onlooker.check_energy(&mut findings, "string", -weight * expected);
    findings.check((1.15 * expected..0.8 * expected).contains(&lowest), || {
        format!("the ball gets down to {lowest:.3} m, {expected:.3} m by energy")
    });
    findings.report();
}
