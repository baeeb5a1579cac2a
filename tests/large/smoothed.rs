//! Eight-node cells whose areas are smoothed: material that all but keeps its volume, and metal that flows.

use super::support::{deformed, describe, dot, largest, warped_plate};
use foil2d::fe::finite_strain::{FiniteStrainModel, Form, Linearization};
use foil2d::fe::material::hyperelastic::{
    Gent, Hencky, Hyperelastic, J2Plasticity, MooneyRivlin, NeoHookean, PlasticState,
    StableNeoHookean,
};
use foil2d::fe::mesh::CellKind;
use std::sync::Arc;

const POISSON: f64 = 0.4999;
const BOTH: [Form; 2] = [Form::Equilibrium, Form::EnergyMomentum { decay: 0.2 }];
const KEPT: [f64; 4] = [1.25, 0.3, -0.1, 0.776];

fn soft() -> [Arc<dyn Hyperelastic>; 5] {
    [
        Arc::new(NeoHookean::plane_strain(1e5, POISSON)),
        Arc::new(StableNeoHookean::plane_strain(1e5, POISSON)),
        Arc::new(MooneyRivlin::plane_strain(1e4, 5e3, POISSON)),
        Arc::new(Gent::plane_strain(1e5, POISSON, 30.0)),
        Arc::new(Hencky::plane_strain(1e5, POISSON)),
    ]
}

/// Minus the residual (N), after what has flowed.
fn force(
    model: &FiniteStrainModel,
    form: Form,
    [start, end]: [&[f64]; 2],
    flowed: &[PlasticState],
) -> Vec<f64> {
    let mut deformation = model.deformation(start);
    deformation.begin_with(flowed);
    let mut force = vec![0.0; model.n_dofs()];
    model
        .subtract_force(form, end, &mut deformation, &mut force)
        .expect("the states are admissible");
    force.iter_mut().for_each(|value| *value = -*value);
    force
}

fn way(start: &[f64], end: &[f64]) -> Vec<f64> {
    end.iter()
        .zip(start)
        .map(|(end, start)| end - start)
        .collect()
}

/// The work of a step is what the energy rises by; the decay takes some of it, by what cells change their smooth areas, and turns nothing.
#[test]
fn steps_of_what_keeps_its_volume_conserve_energy_and_both_momenta() {
    for law in soft() {
        let model = warped_plate(CellKind::Quad8, law);
        let name = model.law().name();
        let start = deformed(&model, [1.1, 0.1, -0.1, 0.9], 0.005);
        let end = deformed(&model, KEPT, -0.005);
        let way = way(&start, &end);
        let rise = model.elastic_energy(&end) - model.elastic_energy(&start);
        let at = |decay| {
            let form = Form::EnergyMomentum { decay };
            force(&model, form, [&start, &end], &[])
        };
        let plain = at(0.0);
        let size: f64 = plain.iter().zip(&way).map(|(f, x)| (f * x).abs()).sum();
        let error = dot(&plain, &way) - rise;
        assert!(error.abs() < 1e-13 * size, "{name}: {error:e} of {size:e}");
        assert!(dot(&at(0.2), &way) > rise, "{name}");
        for force in [plain, at(0.2)] {
            let (mut sum, mut moment) = ([0.0; 2], 0.0);
            for (node, pair) in force.chunks_exact(2).enumerate() {
                let [x, y] = [0, 1].map(|k| 0.5 * (start[2 * node + k] + end[2 * node + k]));
                sum = [sum[0] + pair[0], sum[1] + pair[1]];
                moment += x * pair[1] - y * pair[0];
            }
            let size = largest(&force);
            assert!(largest(&sum) < 1e-12 * size, "{name}: {sum:?}");
            assert!(moment.abs() < 1e-12 * size, "{name}: {moment:e}");
        }
    }
}

/// `u = (c (x y² - x/3), 0)` changes areas by `c (y² - 1/3)`, of which the best linear fit in the cell is nothing: the decay brakes it by the shear modulus
/// alone, at any amplitude, though the areas at the points change.
#[test]
fn decay_of_what_keeps_its_smooth_areas_knows_no_bulk_modulus() {
    let brake = |poisson: f64, share: f64| {
        let law = NeoHookean::plane_strain(2e5 * (1.0 + poisson), poisson);
        let description = describe([2.0, 2.0], [1, 1], CellKind::Quad8, Arc::new(law));
        let model = FiniteStrainModel::assemble(description).expect("one cell");
        let start = model.rest_positions().to_vec();
        let mut end = start.clone();
        for pair in end.chunks_exact_mut(2) {
            let [x, y] = [pair[0] - 1.0, pair[1] - 1.0];
            pair[0] += 0.2 * (x * y * y - share * x);
        }
        let of = |decay| {
            let form = Form::EnergyMomentum { decay };
            dot(
                &force(&model, form, [&start, &end], &[]),
                &way(&start, &end),
            )
        };
        of(0.2) - of(0.0)
    };
    let soft = brake(0.3, 1.0 / 3.0);
    assert!(soft > 1e2, "{soft}");
    for poisson in [0.49, 0.4999] {
        let error = (brake(poisson, 1.0 / 3.0) - soft).abs();
        assert!(error < 1e-9 * soft, "{poisson}: {error:e} of {soft}");
    }
    // And what the fit sees is braked by `χ/2 λ (J' - J)²`: here by .2 (1/3 - s) of the area all over the cell of 4 m².
    let grown: f64 = 0.2 / 3.0;
    let of_lambda = |poisson: f64| brake(poisson, 0.0);
    let lambda = |poisson: f64| 2e5 * poisson / (1.0 - 2.0 * poisson);
    let [low, high] = [0.3, 0.4999];
    let slope = (of_lambda(high) - of_lambda(low)) / (lambda(high) - lambda(low));
    let expected = 0.1 * grown * grown * 4.0;
    assert!(
        (slope / expected - 1.0).abs() < 1e-9,
        "{slope} of {expected}"
    );
}

/// The tangent of a state (N/m).
fn product(
    model: &FiniteStrainModel,
    (form, kind): (Form, Linearization),
    [start, end]: [&[f64]; 2],
    flowed: &[PlasticState],
    way: &[f64],
) -> Vec<f64> {
    let mut deformation = model.deformation(start);
    deformation.begin_with(flowed);
    let mut unused = vec![0.0; model.n_dofs()];
    model
        .subtract_force(form, end, &mut deformation, &mut unused)
        .expect("the states are admissible");
    let mut matrix = model.new_matrix();
    model.add_tangent(form, kind, &deformation, &mut matrix);
    let mut product = vec![0.0; model.n_dofs()];
    matrix.multiply(way, &mut product);
    product
}

fn waves(model: &FiniteStrainModel, seed: f64) -> Vec<f64> {
    let dofs = 0..model.n_dofs();
    dofs.map(|dof| (1.0 + dof as f64 * (1.7 + seed)).sin())
        .collect()
}

/// Central differences over 1e-6 m: truncation of some 1e-9 of a stiffness that is 5,000 times the shear modulus.
fn check_tangent(
    model: &FiniteStrainModel,
    forms: &[Form],
    (state, flowed): (&[f64], &[PlasticState]),
    bound: f64,
) {
    for &form in forms {
        for seed in [0.0, 1.0, 2.0] {
            let way = waves(model, seed);
            let asked = (form, Linearization::Consistent);
            let product = product(model, asked, [state, state], flowed, &way);
            let moved = |step: f64| -> Vec<f64> {
                state
                    .iter()
                    .zip(&way)
                    .map(|(x, way)| x + step * way)
                    .collect()
            };
            let [above, below] =
                [1e-6, -1e-6].map(|step| force(model, form, [state, &moved(step)], flowed));
            let mut worst: f64 = 0.0;
            for ((above, below), product) in above.iter().zip(&below).zip(&product) {
                worst = worst.max(((above - below) / 2e-6 - product).abs());
            }
            worst /= largest(&product);
            let name = model.law().name();
            assert!(worst < bound, "{name} {form:?}: {worst:e}");
        }
    }
}

#[test]
fn tangents_of_what_keeps_its_volume_are_derivatives() {
    for law in soft() {
        let model = warped_plate(CellKind::Quad8, law);
        let state = deformed(&model, KEPT, 0.005);
        check_tangent(&model, &BOTH, (&state, &[]), 1e-7);
    }
}

/// The definite tangent and that of impulses stand for the consistent one, with a softness towards what changes no smooth area: a mode of one cell
/// that only its points see.
#[test]
fn definite_tangents_are_definite_and_do_not_lock() {
    for law in soft() {
        let model = warped_plate(CellKind::Quad8, law);
        let name = model.law().name();
        let rest = model.rest_positions().to_vec();
        let form = Form::EnergyMomentum { decay: 0.2 };
        let ends = [&rest[..], &rest[..]];
        for seed in [0.0, 1.0] {
            let way = waves(&model, seed);
            let [exact, definite] = [Linearization::Consistent, Linearization::Definite]
                .map(|kind| product(&model, (form, kind), ends, &[], &way));
            let difference: Vec<f64> = exact.iter().zip(&definite).map(|(a, b)| a - b).collect();
            let error = largest(&difference) / largest(&exact);
            // In `t` and `J` Hencky's energy is not convex at rest: what is made definite differs by some share of the shear modulus.
            let most = if name == "Hencky" { 1e-3 } else { 1e-9 };
            assert!(error < most, "{name}: {error:e}");
        }
        let state = deformed(&model, [0.6, 0.2, 0.0, 0.9], 0.01);
        let ends = [&state[..], &state[..]];
        for seed in 0..8 {
            let way = waves(&model, f64::from(seed));
            let definite = product(&model, (form, Linearization::Definite), ends, &[], &way);
            assert!(dot(&way, &definite) > 0.0, "{name}");
            let asked = (Form::Equilibrium, Linearization::Impulsive { most: 1e12 });
            let impulsive = product(&model, asked, ends, &[], &way);
            assert!(dot(&way, &impulsive) > 0.0, "{name}");
        }
    }
}

/// Metal that has flowed by a tenth and flows on: the stored and the dissipated energy of a step are its work, tangents are derivatives.
#[test]
fn metal_that_flows_conserves_with_smooth_areas() {
    let law = J2Plasticity::plane_strain(2e5, 0.3, 500.0).with_hardening(2e3);
    let model = warped_plate(CellKind::Quad8, Arc::new(law));
    let mut flowed = model.virgin();
    let middle = deformed(&model, [1.1, 0.05, 0.0, 0.92], 0.005);
    assert!(model.commit_flow(&middle, &mut flowed) > 0.0);
    let end = deformed(&model, [1.15, 0.1, -0.05, 0.9], -0.005);
    let before = model.energy_after(&middle, &flowed);
    let after = model.energy_after(&end, &flowed);
    let form = Form::EnergyMomentum { decay: 0.0 };
    let force = force(&model, form, [&middle, &end], &flowed);
    let rise = after.stored + after.dissipated - before.stored - before.dissipated;
    let work = dot(&force, &way(&middle, &end));
    assert!(after.dissipated > 0.0);
    assert!((work / rise - 1.0).abs() < 1e-11, "{work} for {rise}");
    check_tangent(&model, &[Form::Equilibrium], (&end, &flowed), 1e-6);
    // Within the yield surface, where a step may begin.
    let rest = model.rest_positions().iter().zip(&middle);
    let eased: Vec<f64> = rest.map(|(rest, x)| x + 0.005 * (rest - x)).collect();
    check_tangent(&model, &BOTH, (&eased, &flowed), 1e-6);
    let kinds = [Linearization::Consistent, Linearization::Definite];
    let moved = waves(&model, 0.0);
    let mut elastic = model.virgin();
    model.commit_flow(model.rest_positions(), &mut elastic);
    let rest = [model.rest_positions(); 2];
    let [exact, definite] = kinds.map(|kind| {
        let form = Form::EnergyMomentum { decay: 0.2 };
        product(&model, (form, kind), rest, &elastic, &moved)
    });
    let difference: Vec<f64> = exact.iter().zip(&definite).map(|(a, b)| a - b).collect();
    assert!(largest(&difference) < 0.5 * largest(&exact));
}
