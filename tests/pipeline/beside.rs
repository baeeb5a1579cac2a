//! Bodies of small strain beside what they do not touch: they move as they would without it.

use crate::common::*;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::pipeline::{ContactReport, Participant};

const DT: f64 = 1.0 / 60.0;

/// Beside a slab whose box it is in, whatever the mesh: surfaces that lose their mass before the first step are no reason to begin it without weight.
#[test]
fn what_falls_past_something_begins_with_all_its_weight() {
    for kind in [CellKind::Tri3, CellKind::Quad4, CellKind::Tri6] {
        for n in [4, 6, 8, 10] {
            let mut scene = Scene::new(DT);
            let slab = ColliderBuilder::cuboid(8.0, 0.5).rotation(0.7);
            scene.fixed(slab.translation(vec2(3.0, -3.0)));
            let mesh = generate::rectangle([0.5, 0.4], [n, n], kind).expect("a sound mesh");
            let body = FlexBodyBuilder::mesh(mesh)
                .small_strain()
                .material(elastic(1e7, 500.0, 0.0))
                .translation([0.0, 2.0]);
            let body = scene.flexible(body);
            for step in 1..=10 {
                scene.step();
                let expected = -G * DT * f64::from(step);
                let [_, speed] = scene.body(body).linvel();
                assert!(
                    (speed - expected).abs() < 1e-5,
                    "{kind:?} {n}, step {step}: {speed} m/s, not {expected}"
                );
            }
        }
    }
}

/// A block that lands, alone or with another one flying in parallel above it that it does not touch.
fn landing(seed: u64, has_company: bool) -> Vec<[f64; 2]> {
    let mut dice = Dice(seed);
    let mut scene = Scene::new(1.0 / 240.0);
    scene.ground(0.0);
    let (width, height) = (dice.between(0.5, 1.0), dice.between(0.3, 0.5));
    let (turn, young) = (dice.between(-0.6, 0.6), dice.between(6.0, 8.0));
    let velocity = [dice.between(-1.0, 1.0), dice.between(-5.0, -1.0)];
    let block = |height: f64, at: [f64; 2], young: f64| {
        FlexBodyBuilder::rectangle([width, height], [6, 3])
            .small_strain()
            .material(elastic(10f64.powf(young), 1000.0, 0.0))
            .friction(0.0)
            .rotation(turn)
            .translation(at)
            .linvel(velocity)
    };
    let body = scene.flexible(block(height, [0.0, 0.6], young));
    let away = height + 0.12;
    let above = [-away * turn.sin(), 0.6 + away * turn.cos()];
    if has_company {
        scene.flexible(block(0.2, above, dice.between(5.0, 8.0)));
    }
    let mut places = Vec::new();
    for _ in 0..60 {
        scene.step();
        let contacts = scene.report().contacts();
        let meets = |one: &ContactReport| {
            let parts = [one.contactor, one.target];
            parts
                .iter()
                .all(|part| matches!(part, Participant::Flex(_)))
        };
        if contacts.iter().any(meets) {
            break;
        }
        places.push(scene.body(body).centre_of_mass());
    }
    places
}

/// Energy that contact takes and gives back is that of what presses each other, not of all that is solved together.
#[test]
fn what_lands_does_not_depend_on_what_flies_beside_it() {
    let mut n_landed = 0;
    for seed in 1..=12 {
        let (alone, beside) = (landing(seed, false), landing(seed, true));
        n_landed += usize::from(beside.len() > 10);
        for (step, (one, other)) in alone.iter().zip(&beside).enumerate() {
            let away = (one[0] - other[0]).hypot(one[1] - other[1]);
            let most = by_precision(1e-6, 1e-9);
            assert!(away < most, "{seed}, step {step}: {away} m elsewhere");
        }
    }
    assert!(n_landed > 6, "{n_landed}");
}
