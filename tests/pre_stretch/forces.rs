//! Forces, energies and masses.

use crate::support::*;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::{J2Plasticity, NeoHookeanSheet};
use foil2d::fe::mesh::generate::rectangle;
use foil2d::prelude::*;

fn assert_near(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value / expected - 1.0).abs() < tolerance,
        "{what} is {value:e}, not {expected:e} ({:e})",
        value / expected - 1.0
    );
}

/// A strip of any law pulls at its pins by what the law says, in the first step and after a hundred, and no node moves. What the law says is solved here anew; of
/// rubber that keeps its volume it is `μ (λ - 1/λ²)` over the unstretched section. Rounding of the stretches is all there is: 1e-9 is far above it.
#[test]
fn pins_feel_the_closed_form_from_the_first_step_on() {
    for stretch in [STRETCH, 0.97, 1.8] {
        let plane = neo_hookean(constants(), stretch);
        let [young, nu] = [YOUNG, 0.45];
        let solid = [
            young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            0.5 * young / (1.0 + nu),
        ];
        let bulky = neo_hookean(solid, stretch);
        let across = stretch.powf(-0.5);
        let rubber = [across, YOUNG / 3.0 * (stretch - 1.0 / (stretch * stretch))];
        let bulky_law = HyperelasticSolid::new(NeoHookean::plane_strain(young, nu));
        let sheet = HyperelasticSolid::new(NeoHookeanSheet::plane_stress(YOUNG, 0.5));
        let strips = [
            (strip(hooke()), plane),
            (strip(bulky_law.with_density(DENSITY)), bulky),
            (strip(sheet.with_density(DENSITY)), rubber),
        ];
        for (body, [across, nominal]) in strips {
            // Under pressure a strip as slender as this one buckles, but not within a step.
            let n_steps = if stretch < 1.0 { 1 } else { 100 };
            let body = body.pre_stretch(PreStretch::along_x(stretch));
            let mut run = Run::new(body, 1.0 / 120.0);
            assert_eq!(run.strip().displacement(60), [0.0; 2]);
            let force = nominal * HEIGHT / across * THICKNESS;
            for _ in 0..n_steps {
                run.step();
                let [right, left] = run.pulls();
                assert_near("the pull", right, force, 1e-9);
                assert_near("the pull", -left, force, 1e-9);
            }
            let still = (0..run.strip().n_nodes()).all(|node| {
                let [x, y] = run.strip().displacement(node);
                x.hypot(y) < 1e-9 * LENGTH
            });
            assert!(still, "a strip that is held is in equilibrium");
            let mass = DENSITY * LENGTH * HEIGHT * THICKNESS / (stretch * across);
            assert_near("the mass", run.strip().mass(), mass, 1e-9);
        }
    }
}

/// The stress asked for is the stress told, turned with the body, along one axis and along both.
#[test]
fn a_stress_that_is_asked_for_is_there() {
    let sheet = || HyperelasticSolid::new(NeoHookeanSheet::plane_stress(YOUNG, 0.4));
    let bodies = || {
        [
            free_strip(hooke()),
            free_strip(sheet().with_density(DENSITY)),
        ]
    };
    for stress in [[1e5, 0.0], [-1e5, 0.0], [0.0, 3e5], [5e5, 3e5], [4e6, -2e5]] {
        for body in bodies() {
            let body = body
                .pre_stretch(PreStretch::by_stress(stress))
                .rotation(0.5 * std::f64::consts::PI)
                .build()
                .unwrap_or_else(|error| panic!("{stress:?}: {error}"));
            for state in body.point_states(17).expect("the element tells") {
                let [x, y] = [state.stress.yy, state.stress.xx];
                let size = stress[0].abs().max(stress[1].abs());
                let off = (x - stress[0]).abs().max((y - stress[1]).abs());
                assert!(off < 1e-9 * size, "{stress:?}: {x:e}, {y:e}");
            }
        }
    }
}

/// A body that is built stretched is the body that was built shrunk and is drawn apart: same mass, energy, forces, in any axes.
#[test]
fn what_is_built_stretched_is_what_was_drawn_apart() {
    for (kind, angle) in [
        (CellKind::Quad4, 0.0),
        (CellKind::Tri6, 0.6),
        (CellKind::Quad8, -2.0),
    ] {
        let stretches = [1.3, 0.8];
        let law = || HyperelasticSolid::new(NeoHookean::plane_strain(YOUNG, 0.3));
        let body = FlexBodyBuilder::rectangle_of([1.0, 0.4], [6, 3], kind)
            .material(law().with_density(DENSITY))
            .thickness(THICKNESS)
            .pre_stretch(stretches)
            .rotation(angle)
            .translation([3.0, -2.0])
            .build()
            .expect("a good body");
        let shrunk = rectangle([1.0 / 1.3, 0.4 / 0.8], [6, 3], kind).expect("a mesh");
        let law = NeoHookean::plane_strain(YOUNG, 0.3);
        let mut description = FiniteStrainDescription::new(shrunk, law, DENSITY);
        description.thickness = THICKNESS;
        let model = FiniteStrainModel::assemble(description).expect("a good body");
        let drawn: Vec<f64> = model
            .rest_positions()
            .chunks_exact(2)
            .flat_map(|at| [1.3 * at[0], 0.8 * at[1]])
            .collect();
        let energy = model.elastic_energy(&drawn);
        assert_near("the energy", body.energy().elastic, energy, 1e-10);
        assert_near(
            "the energy of the state",
            body.state().elastic_energy,
            energy,
            1e-10,
        );
        let mass: f64 = model.masses().iter().sum();
        assert_near("the mass", body.mass(), mass, 1e-12);
        assert_eq!(body.angle(), 0.0);
        let principal = body.stretch().expect("the element tells")[0].principal();
        assert_near("the longest stretch", principal.0, 1.3, 1e-10);
        assert_near("the shortest one", principal.1, 0.8, 1e-10);
    }
}

/// Welds to the world hold a strip as pins do.
#[test]
fn welds_hold_the_tension() {
    let body = free_strip(hooke()).pre_stretch(PreStretch::along_x(STRETCH));
    let mut run = Run::new(body, 1.0 / 120.0);
    for end in [0.0, LENGTH] {
        let weld = AttachmentBuilder::weld(run.strip)
            .where_(move |[x, _]| x == end)
            .to_world();
        run.flex_bodies
            .attach(weld, &run.world.bodies)
            .expect("the end can be welded");
    }
    let [across, nominal] = neo_hookean(constants(), STRETCH);
    let expected = nominal * HEIGHT / across * THICKNESS;
    for _ in 0..60 {
        run.step();
        for (end, expected) in [(0.0, -expected), (LENGTH, expected)] {
            let nodes = run.strip().mesh().nodes().iter().enumerate();
            let nodes = nodes.filter(|(_, [x, _])| *x == end);
            let pull: f64 = nodes
                .map(|(node, _)| run.strip().contact_force(node)[0])
                .sum();
            assert_near("the pull", pull, expected, 1e-6);
        }
    }
}

/// A moved pin moves from where it was built, and thickness and material may change as of any body.
#[test]
fn pins_move_and_properties_change_from_where_it_was_built() {
    let body = strip(hooke()).pre_stretch([STRETCH, 1.0]);
    let mut run = Run::new(body, 1.0 / 120.0);
    let ends: Vec<usize> = (0..run.strip().n_nodes())
        .filter(|&node| run.strip().mesh().nodes()[node][0] == LENGTH)
        .collect();
    let mass = run.strip().mass();
    let strip = &mut run.flex_bodies[run.strip];
    for &node in &ends {
        strip
            .set_pin_displacement(node, [0.01, 0.0])
            .expect("a pin");
    }
    strip.set_thickness(2.0 * THICKNESS).expect("a thickness");
    run.step();
    for &node in &ends {
        let [x, y] = run.strip().displacement(node);
        assert!((x - 0.01).abs() < 1e-12 && y.abs() < 1e-12);
    }
    assert_near("the mass", run.strip().mass(), 2.0 * mass, 1e-12);
}

/// A metal below its yield stress is under tension as any other body, and flows no more than it.
#[test]
fn metals_are_stretched_below_their_yield_stress() {
    let metal = J2Plasticity::plane_strain(2.1e11, 0.3, 2.5e8).with_hardening(1e9);
    let body = strip(HyperelasticSolid::new(metal).with_density(7800.0));
    let body = body.pre_stretch(PreStretch::by_stress([1e8, 0.0]));
    let mut run = Run::new(body, 1.0 / 120.0);
    for _ in 0..10 {
        run.step();
    }
    assert_near("the pull", run.pulls()[0], 1e8 * HEIGHT * THICKNESS, 1e-6);
    assert_eq!(run.strip().max_plastic_strain(), 0.0);
}

/// Regions of materials that contract alike are stretched together.
#[test]
fn regions_that_contract_alike_are_stretched_together() {
    let stiff = LinearElastic::plane_stress(10.0 * YOUNG, 0.3).density(3.0 * DENSITY);
    let body = strip(hooke())
        .regions_by(|[_, y]| u32::from(y > 0.5 * HEIGHT))
        .region_material(1, stiff)
        .pre_stretch(PreStretch::along_x(STRETCH));
    let mut run = Run::new(body, 1.0 / 120.0);
    run.step();
    let [across, nominal] = neo_hookean(constants(), STRETCH);
    let expected = 5.5 * nominal * HEIGHT / across * THICKNESS;
    assert_near("the pull", run.pulls()[0], expected, 1e-9);
}
