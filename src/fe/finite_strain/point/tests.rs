use super::*;
use crate::fe::material::hyperelastic::{
    Corotated, Gent, MooneyRivlin, MooneyRivlinSheet, NeoHookean, NeoHookeanSheet,
    StVenantKirchhoff, StableNeoHookean,
};
use crate::math::sin_cos;

const START: [f64; 4] = [1.1, 0.2, -0.1, 0.9];
const END: [f64; 4] = [0.8, 0.5, 0.3, 1.4];

fn laws() -> [Box<dyn Hyperelastic>; 8] {
    [
        Box::new(Corotated::plane_strain(1e5, 0.3)),
        Box::new(StVenantKirchhoff::plane_strain(1e5, 0.3)),
        Box::new(NeoHookean::plane_strain(1e5, 0.3)),
        Box::new(StableNeoHookean::plane_strain(1e5, 0.3)),
        Box::new(NeoHookeanSheet::plane_stress(1e5, 0.4)),
        Box::new(MooneyRivlin::plane_strain(1.2e4, 5e3, 0.4)),
        Box::new(MooneyRivlinSheet::plane_stress(1.2e4, 5e3)),
        Box::new(Gent::plane_strain(1e5, 0.3, 20.0)),
    ]
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The largest difference between the moduli and central differences of the stress over 1e-5 (Pa).
fn error_of_moduli(law: &dyn Hyperelastic, form: Form, start: [f64; 4], end: [f64; 4]) -> f64 {
    let moduli = moduli(law, form, Linearization::Consistent, start, end);
    let mut worst: f64 = 0.0;
    for column in 0..4 {
        let (mut above, mut below) = (end, end);
        above[column] += 1e-5;
        below[column] -= 1e-5;
        let (above, below) = (
            stress(law, form, start, above),
            stress(law, form, start, below),
        );
        for row in 0..4 {
            let slope = (above[row] - below[row]) / 2e-5;
            worst = worst.max((slope - moduli[row][column]).abs());
        }
    }
    worst
}

#[test]
fn the_conserving_stress_does_the_work_that_the_energy_rises_by_and_turns_nothing() {
    for law in laws() {
        let form = Form::EnergyMomentum { decay: 0.0 };
        let p = stress(law.as_ref(), form, START, END);
        let change: [f64; 4] = std::array::from_fn(|k| END[k] - START[k]);
        let [before, after] =
            [START, END].map(|gradient| law.energy_density(Invariants::of(gradient)));
        let error = dot(p, change) - (after - before);
        assert!(error.abs() < 1e-14 * 1e5, "{}: {error:e}", law.name());
        // P F½ᵀ is symmetric.
        let [xx, xy, yx, yy] = middle(START, END);
        let skew = p[0] * yx + p[1] * yy - p[2] * xx - p[3] * xy;
        assert!(skew.abs() < 1e-14 * 1e5, "{}: {skew:e}", law.name());
    }
}

/// `χ/2 (2 μ ΔE : ΔE + λ ΔJ²)` for any change of strain, and nothing for a rotation about the same axes.
#[test]
fn decay_takes_energy_from_every_change_of_strain_and_none_from_rotation() {
    let (sin, cos) = sin_cos(0.7);
    let turned = [
        cos * START[0] - sin * START[2],
        cos * START[1] - sin * START[3],
        sin * START[0] + cos * START[2],
        sin * START[1] + cos * START[3],
    ];
    let law = StableNeoHookean::plane_strain(1e5, 0.3);
    let work = |end: [f64; 4]| {
        let of = |decay| stress(&law, Form::EnergyMomentum { decay }, START, end);
        let (with, without) = (of(0.1), of(0.0));
        let decay: [f64; 4] = std::array::from_fn(|k| with[k] - without[k]);
        dot(decay, std::array::from_fn(|k| end[k] - START[k]))
    };
    assert!(work(turned).abs() < 1e-10);
    let strain = |[xx, xy, yx, yy]: [f64; 4]| {
        let [a, b] = [xx * xx + yx * yx, xy * xy + yy * yy];
        [0.5 * (a - 1.0), 0.5 * (b - 1.0), xx * xy + yx * yy]
    };
    let (before, after) = (strain(START), strain(END));
    let [xx, yy, xy]: [f64; 3] = std::array::from_fn(|k| after[k] - before[k]);
    let grown = Invariants::of(END).j - Invariants::of(START).j;
    let (lambda, mu) = (law.constants().lambda(), law.constants().mu());
    let sheared = 2.0 * mu * (xx * xx + yy * yy + 0.5 * xy * xy);
    let expected = 0.05 * (sheared + lambda * grown * grown);
    assert!((work(END) - expected).abs() < 1e-9 * expected);
}

/// What keeps its volume is braked by the shear modulus alone, at a strain of any size.
#[test]
fn decay_of_what_keeps_its_volume_knows_no_bulk_modulus() {
    // Both of the area 1.
    let (start, end) = ([1.25, 0.0, 0.0, 0.8], [0.8, 0.6, 0.0, 1.25]);
    let brake = |nu: f64| {
        let law = NeoHookean::plane_strain(2.0 * 1e5 * (1.0 + nu), nu);
        let of = |decay| stress(&law, Form::EnergyMomentum { decay }, start, end);
        let (with, without) = (of(0.1), of(0.0));
        let change = std::array::from_fn(|k| end[k] - start[k]);
        dot(std::array::from_fn(|k| with[k] - without[k]), change)
    };
    let soft = brake(0.3);
    assert!(soft > 1e3);
    for nu in [0.49, 0.4999, 0.499_999] {
        // What is left of a modulus times the round-off of areas.
        let error = (brake(nu) - soft).abs();
        assert!(error < 1e-8 * soft, "{nu}: {error:e}");
    }
}

#[test]
fn moduli_are_the_derivative_of_the_stress() {
    for law in laws() {
        let law = law.as_ref();
        let error = error_of_moduli(law, Form::Equilibrium, START, END);
        assert!(error < 1e-8 * 1e6, "{} equilibrium: {error:e}", law.name());
        for decay in [0.0, 0.1] {
            let form = Form::EnergyMomentum { decay };
            let error = error_of_moduli(law, form, END, END);
            assert!(
                error < 1e-8 * 1e6,
                "{} decay {decay}: {error:e}",
                law.name()
            );
        }
    }
}

/// What making the moduli symmetric costs is of the first order in the change of `F`: a tenth for a tenth of it.
#[test]
fn moduli_of_a_step_err_by_the_first_order_of_its_change() {
    for law in laws() {
        let law = law.as_ref();
        let form = Form::EnergyMomentum { decay: 0.1 };
        let error = |part: f64| {
            let end = std::array::from_fn(|k| START[k] + part * (END[k] - START[k]));
            error_of_moduli(law, form, START, end)
        };
        let (whole, tenth, hundredth) = (error(1.0), error(0.1), error(0.01));
        assert!(whole < 0.5 * 1e5, "{}: {whole:e}", law.name());
        assert!(
            tenth < 0.15 * whole && hundredth < 0.15 * tenth,
            "{}",
            law.name()
        );
    }
}

#[test]
fn definite_moduli_are_definite_where_the_derivative_is_not() {
    let crushed = [0.1, 0.0, 0.0, -0.3];
    for law in laws() {
        let law = law.as_ref();
        if !law.admits(Invariants::of(crushed)) {
            continue;
        }
        let least = |kind| {
            let form = Form::EnergyMomentum { decay: 0.05 };
            let moduli = moduli(law, form, kind, START, crushed);
            least_eigenvalue(moduli)
        };
        let name = law.name();
        assert!(least(Linearization::Definite) > 0.0, "{name}");
        if name != "stable neo-Hookean" {
            assert!(least(Linearization::Consistent) < 0.0, "{name}");
        }
    }
}

#[test]
fn moduli_for_impulses_are_semidefinite_bounded_and_know_of_no_turn() {
    let crushed = [0.1, 0.02, -0.3, 1e-4];
    let gradient = [[1.0, 0.0], [0.0, 2.0], [-1.0, -2.0]];
    for law in laws() {
        let law = law.as_ref();
        for end in [END, crushed] {
            if !law.admits(Invariants::of(end)) {
                continue;
            }
            let kind = Linearization::Impulsive { most: 50.0 };
            let moduli = moduli(law, Form::Equilibrium, kind, START, end);
            let size = moduli
                .iter()
                .flatten()
                .fold(0.0f64, |most, x| most.max(x.abs()));
            let [xx, xy, yx, yy] = end;
            for row in moduli {
                assert!(dot(row, [-yx, -yy, xx, xy]).abs() < 1e-12 * size);
            }
            assert!(least_eigenvalue(moduli) > -1e-12 * size);
            let volume = 0.3 * kind.share(&gradient, &moduli, 0.3);
            let mut blocks = [[[0.0; 4]; 3]; 3];
            crate::fe::finite_strain::one_cell::add_point(&gradient, &moduli, volume, &mut blocks);
            for (a, row) in blocks.iter().enumerate() {
                assert!(
                    row[a][0] + row[a][3] <= 50.0 * (1.0 + 1e-12),
                    "{}",
                    law.name()
                );
            }
        }
    }
    // What is softer stays as it is.
    let soft = Linearization::Impulsive { most: 1e9 };
    let law = NeoHookean::plane_strain(1e5, 0.3);
    let moduli = moduli(&law, Form::Equilibrium, soft, START, END);
    assert_eq!(soft.share(&gradient, &moduli, 0.3), 1.0);
}

fn least_eigenvalue(moduli: [[f64; 4]; 4]) -> f64 {
    let matrix = nalgebra::Matrix4::from_fn(|row, column| moduli[row][column]);
    matrix.symmetric_eigenvalues().min()
}
