//! Forces, energies and tangents of holes under pressure.

use super::support::{KINDS, deformed, dot, largest, ring};
use foil2d::fe::finite_strain::{
    FiniteStrainDescription, FiniteStrainError, FiniteStrainModel, Form, InnerPressure,
    Linearization, PressureError,
};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, Mesh, generate};

const START: [f64; 4] = [1.1, 0.2, -0.1, 0.9];
const END: [f64; 4] = [1.3, 0.4, -0.2, 0.8];
const CONSERVING: Form = Form::EnergyMomentum { decay: 0.0 };

fn pressures() -> [InnerPressure; 4] {
    [
        InnerPressure::constant(3e4),
        InnerPressure::isothermal(5e4),
        InnerPressure::adiabatic(2e6, 1.4),
        InnerPressure::isothermal(-3e4).outside(5e4),
    ]
}

fn ring_of(kind: CellKind, pressure: InnerPressure) -> FiniteStrainModel {
    let divisions = if kind == CellKind::Tri6 {
        [7, 1]
    } else {
        [11, 2]
    };
    ring([0.3, 0.4], divisions, kind, 0.3, pressure)
}

/// The internal force between two states.
fn force(model: &FiniteStrainModel, form: Form, start: &[f64], end: &[f64]) -> Vec<f64> {
    let mut deformation = model.deformation(start);
    let mut force = vec![0.0; model.n_dofs()];
    let outcome = model.subtract_force(form, end, &mut deformation, &mut force);
    outcome.expect("the states are admissible");
    force.iter_mut().for_each(|value| *value = -*value);
    force
}

/// What a pressure adds to the internal force.
fn pressure_force(model: &FiniteStrainModel, form: Form, start: &[f64], end: &[f64]) -> Vec<f64> {
    let bare = model.with_pressure(0, InnerPressure::NONE).expect("a hole");
    let with = force(model, form, start, end);
    let without = force(&bare, form, start, end);
    with.iter().zip(without).map(|(a, b)| a - b).collect()
}

/// Shoelace on the polygon, and of curved sides on 400 chords of each parabola.
fn area_by_chords(model: &FiniteStrainModel, at: &[f64], n_chords: usize) -> f64 {
    let around = model.mesh().boundary().loops()[1].nodes();
    let is_curved = model.mesh().cells().any(|cell| cell.kind == CellKind::Tri6);
    let node = |k: usize| {
        let node = around[k % around.len()];
        [at[2 * node], at[2 * node + 1]]
    };
    let mut points = Vec::new();
    let side = if is_curved { 2 } else { 1 };
    for k in (0..around.len()).step_by(side) {
        let [a, m, b] = [node(k), node(k + 1), node(k + 2)];
        for chord in 0..(if is_curved { n_chords } else { 1 }) {
            let s = chord as f64 / n_chords as f64;
            let weights = [
                (1.0 - s) * (1.0 - 2.0 * s),
                4.0 * s * (1.0 - s),
                s * (2.0 * s - 1.0),
            ];
            points.push([0, 1].map(|i| weights[0] * a[i] + weights[1] * m[i] + weights[2] * b[i]));
        }
    }
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    // The loop of a hole runs clockwise.
    -0.5 * pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

#[test]
fn the_area_is_that_of_straight_and_of_curved_sides() {
    for kind in KINDS {
        let model = ring_of(kind, InnerPressure::constant(1.0));
        let at = deformed(&model, END, 0.02);
        let area = model.hole_area(0, &at).expect("a hole");
        // The error of chords falls with their square, and is extrapolated to nothing.
        let [coarse, fine] = [50, 100].map(|n| area_by_chords(&model, &at, n));
        let expected = fine + (fine - coarse) / 3.0;
        assert!(
            (area / expected - 1.0).abs() < 1e-9,
            "{kind:?} {area} {expected}"
        );
        assert_eq!(model.hole_area(1, &at), None);
        let bare = FiniteStrainDescription::new(
            model.mesh().clone(),
            Corotated::plane_strain(1.0, 0.0),
            1.0,
        );
        let bare = FiniteStrainModel::assemble(bare).expect("a body");
        assert_eq!(bare.hole_area(0, &at), Some(area));
    }
}

/// `p = const` and `p A^γ = const` to rounding, and `f = -p t ∂A/∂x` by central differences of the area.
#[test]
fn the_force_is_the_pressure_times_the_slope_of_the_area() {
    for kind in KINDS {
        for pressure in pressures() {
            let model = ring_of(kind, pressure);
            let at = deformed(&model, END, 0.02);
            let found = pressure_force(&model, Form::Equilibrium, &at, &at);
            let p = model.hole_pressure(0, &at).expect("a hole");
            let rest = model.hole_area(0, model.rest_positions()).expect("a hole");
            let area = model.hole_area(0, &at).expect("a hole");
            assert!((p - pressure.at(area / rest)).abs() < 1e-12 * p.abs());
            let h = 1e-4;
            for dof in 0..model.n_dofs() {
                let moved = |by: f64| {
                    let mut moved = at.clone();
                    moved[dof] += by;
                    model.hole_area(0, &moved).expect("a hole")
                };
                // The area is quadratic: central differences are exact but for rounding.
                let slope = (moved(h) - moved(-h)) / (2.0 * h);
                let error = found[dof] + 0.7 * p * slope;
                assert!(error.abs() < 1e-8 * largest(&found), "{kind:?} {error:e}");
            }
        }
    }
}

#[test]
fn the_conserving_force_does_the_work_of_the_gas_and_turns_nothing() {
    for kind in KINDS {
        for pressure in pressures() {
            let model = ring_of(kind, pressure);
            let bare = model.with_pressure(0, InnerPressure::NONE).expect("a hole");
            for (part, limit) in [(1.0, 1e-13), (1e-4, 1e-9)] {
                let start = deformed(&model, START, 0.01);
                let whole = deformed(&model, END, -0.02);
                let end: Vec<f64> = (start.iter().zip(&whole))
                    .map(|(a, b)| a + part * (b - a))
                    .collect();
                let force = pressure_force(&model, CONSERVING, &start, &end);
                let way: Vec<f64> = end.iter().zip(&start).map(|(a, b)| a - b).collect();
                let energy = |at: &[f64]| model.elastic_energy(at) - bare.elastic_energy(at);
                let rise = energy(&end) - energy(&start) - model.pressure_work(&start, &end);
                let work = dot(&force, &way);
                assert!(
                    (work / rise - 1.0).abs() < 100.0 * limit,
                    "{kind:?} {work} {rise}"
                );
                let (mut sum, mut moment) = ([0.0; 2], 0.0);
                for (node, pair) in force.chunks_exact(2).enumerate() {
                    let [x, y] = [0, 1].map(|k| 0.5 * (start[2 * node + k] + end[2 * node + k]));
                    sum = [sum[0] + pair[0], sum[1] + pair[1]];
                    moment += x * pair[1] - y * pair[0];
                }
                // The elastic force, whose rounding is left in the difference, is larger.
                let size = largest(&super::forces::force(&model, CONSERVING, &start, &end));
                assert!(largest(&sum) < 1e-12 * size, "{kind:?} {sum:?}");
                assert!(moment.abs() < 1e-12 * size, "{kind:?} {moment:e}");
            }
        }
    }
}

/// The largest difference of the tangent from central differences of the force, and the largest entry (N/m).
fn tangent_error(model: &FiniteStrainModel, form: Form, start: &[f64], end: &[f64]) -> [f64; 2] {
    let mut deformation = model.deformation(start);
    let mut residual = vec![0.0; model.n_dofs()];
    let outcome = model.subtract_force(form, end, &mut deformation, &mut residual);
    outcome.expect("the states are admissible");
    let mut matrix = model.new_matrix();
    model.add_tangent(form, Linearization::Consistent, &deformation, &mut matrix);
    let n = model.n_dofs();
    let (mut worst, mut size) = (0.0f64, 0.0f64);
    let h = 1e-6;
    for dof in 0..n {
        let mut unit = vec![0.0; n];
        unit[dof] = 1.0;
        let mut column = vec![0.0; n];
        matrix.multiply(&unit, &mut column);
        let moved = |by: f64| {
            let mut moved = end.to_vec();
            moved[dof] += by;
            force(model, form, start, &moved)
        };
        let (above, below) = (moved(h), moved(-h));
        for row in 0..n {
            let slope = (above[row] - below[row]) / (2.0 * h);
            worst = worst.max((column[row] - slope).abs());
            size = size.max(slope.abs());
            let mirrored = matrix
                .block(row / 2, dof / 2)
                .map_or(0.0, |b| b[2 * (row % 2) + dof % 2]);
            let own = matrix
                .block(dof / 2, row / 2)
                .map_or(0.0, |b| b[2 * (dof % 2) + row % 2]);
            assert!(
                (mirrored - own).abs() < 1e-14 * own.abs().max(1e5),
                "the tangent is symmetric"
            );
        }
    }
    [worst, size]
}

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    for kind in KINDS {
        for pressure in pressures() {
            let model = ring_of(kind, pressure);
            let at = deformed(&model, END, 0.02);
            for form in [Form::Equilibrium, CONSERVING] {
                let [error, size] = tangent_error(&model, form, &at, &at);
                assert!(
                    error < 1e-7 * size,
                    "{kind:?} {form:?} {pressure:?}: {error:e} of {size:e}"
                );
            }
        }
    }
}

/// What making the tangent of a step symmetric costs is of the first order in its change, as in the rest of the body; a constant pressure costs nothing more.
#[test]
fn the_tangent_of_a_step_errs_by_the_first_order_of_its_change() {
    let gas = InnerPressure::adiabatic(2e6, 1.4);
    let model = ring_of(CellKind::Quad4, gas);
    let start = deformed(&model, START, 0.01);
    let whole = deformed(&model, END, -0.02);
    let error = |part: f64| {
        let end: Vec<f64> = (start.iter().zip(&whole))
            .map(|(a, b)| a + part * (b - a))
            .collect();
        tangent_error(&model, CONSERVING, &start, &end)[0]
    };
    let [tenth, hundredth] = [0.1, 0.01].map(error);
    assert!(hundredth < 0.15 * tenth, "{tenth:e} {hundredth:e}");
}

/// What answers impulses is semidefinite, and no turn of the whole body meets a resistance.
#[test]
fn the_definite_tangent_of_a_gas_resists_no_turn_and_takes_energy() {
    let model = ring_of(CellKind::Quad4, InnerPressure::isothermal(5e5));
    let bare = model.with_pressure(0, InnerPressure::NONE).expect("a hole");
    let at = deformed(&model, END, 0.02);
    let apply = |model: &FiniteStrainModel, kind: Linearization, x: &[f64]| {
        let mut deformation = model.deformation(&at);
        let mut residual = vec![0.0; model.n_dofs()];
        let form = Form::Equilibrium;
        let outcome = model.subtract_force(form, &at, &mut deformation, &mut residual);
        outcome.expect("the state is admissible");
        let mut matrix = model.new_matrix();
        model.add_tangent(form, kind, &deformation, &mut matrix);
        let mut y = vec![0.0; x.len()];
        matrix.multiply(x, &mut y);
        y
    };
    let turn: Vec<f64> = at.chunks_exact(2).flat_map(|p| [-p[1], p[0]]).collect();
    let wild: Vec<f64> = (0..at.len()).map(|k| ((k * k) as f64).sin()).collect();
    for kind in [
        Linearization::Definite,
        Linearization::Impulsive { most: 1e12 },
    ] {
        let [gas, none] = [&model, &bare].map(|model| apply(model, kind, &turn));
        let added: Vec<f64> = gas.iter().zip(&none).map(|(a, b)| a - b).collect();
        assert!(largest(&added) < 1e-10 * largest(&apply(&model, kind, &wild)));
        let [gas, none] = [&model, &bare].map(|model| dot(&wild, &apply(model, kind, &wild)));
        assert!(gas > none);
    }
    let bounded = Linearization::Impulsive { most: 1e-3 };
    let [gas, none] = [&model, &bare].map(|model| apply(model, bounded, &wild));
    let added: Vec<f64> = gas.iter().zip(&none).map(|(a, b)| a - b).collect();
    // A row has as many entries as the loop has nodes, none larger than the bound.
    assert!(largest(&added) < 2.0 * 11.0 * 1e-3 && largest(&added) > 0.0);
}

#[test]
fn what_is_no_hole_or_no_pressure_is_refused_by_name() {
    let model = ring_of(CellKind::Quad4, InnerPressure::NONE);
    let refused = |hole: usize, pressure| match model.with_pressure(hole, pressure) {
        Err(FiniteStrainError::Pressure(error)) => error,
        other => panic!("{other:?}"),
    };
    let hole = refused(1, InnerPressure::NONE);
    assert_eq!(
        hole,
        PressureError::Hole {
            hole: 1,
            n_holes: 1
        }
    );
    let vacuum = refused(0, InnerPressure::isothermal(-2e5));
    assert!(vacuum.to_string().contains("-101325"), "{vacuum}");
    let mesh: Mesh = generate::rectangle([1.0, 1.0], [2, 2], CellKind::Quad4).expect("a square");
    let mut description =
        FiniteStrainDescription::new(mesh, Corotated::plane_strain(1e5, 0.3), 1.0);
    description.pressures = vec![InnerPressure::constant(1.0)];
    let error = FiniteStrainModel::assemble(description).expect_err("no hole");
    let expected = PressureError::Length {
        found: 1,
        n_holes: 0,
    };
    assert_eq!(error, FiniteStrainError::Pressure(expected));
}

/// The hole of a gas that turns inside out has no energy and no force: no step ends there.
#[test]
fn nothing_is_left_of_a_gas_in_a_hole_that_is_turned() {
    let model = ring_of(CellKind::Tri3, InnerPressure::isothermal(1e4));
    let turned = deformed(&model, [-1.0, 0.0, 0.0, 1.0], 0.0);
    assert!(model.elastic_energy(&turned).is_nan());
}
