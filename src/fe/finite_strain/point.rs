//! Stress `P` and moduli `∂P/∂F'` at one quadrature point.
//!
//! Gradients and stresses are `[xx, xy, yx, yy]`; the first index is of space, the second of the undeformed material.

use super::linearization::{Linearization, forget_turn};
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants};

/// Which stress the forces are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// That of the end, for equilibrium.
    Equilibrium,
    /// The conserving one between beginning and end of a step.
    EnergyMomentum {
        /// The decay `χ ≥ 0` of vibrations (-).
        decay: f64,
    },
}

impl Form {
    /// How much of the end is in the gradient that forces are taken at (-).
    pub(super) fn share_of_end(self) -> f64 {
        match self {
            Self::Equilibrium => 1.0,
            Self::EnergyMomentum { .. } => 0.5,
        }
    }
}

/// The cofactor matrix, `∂ det F/∂F`.
#[inline]
pub(super) fn cofactor([xx, xy, yx, yy]: [f64; 4]) -> [f64; 4] {
    [yy, -yx, -xy, xx]
}

#[inline]
pub(super) fn middle(start: [f64; 4], end: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|k| 0.5 * (start[k] + end[k]))
}

/// The first Piola–Kirchhoff stress `P` (Pa).
#[inline]
pub(super) fn stress<L: Hyperelastic + ?Sized>(
    law: &L,
    form: Form,
    start: [f64; 4],
    end: [f64; 4],
) -> [f64; 4] {
    let pair = match form {
        Form::Equilibrium => law.gradient(Invariants::of(end)),
        Form::EnergyMomentum { .. } => {
            law.conserving_pair(Invariants::of(start), Invariants::of(end))
        }
    };
    stress_of_pair(law, form, pair, [start, end])
}

/// `P = 2 a F + b cof F` of a pair, with the decay (Pa).
#[inline]
pub(super) fn stress_of_pair<L: Hyperelastic + ?Sized>(
    law: &L,
    form: Form,
    [a, b]: [f64; 2],
    [start, end]: [[f64; 4]; 2],
) -> [f64; 4] {
    let at = match form {
        Form::Equilibrium => end,
        Form::EnergyMomentum { .. } => middle(start, end),
    };
    let cofactor = cofactor(at);
    let mut stress: [f64; 4] = std::array::from_fn(|k| 2.0 * a * at[k] + b * cofactor[k]);
    if let Form::EnergyMomentum { decay } = form
        && decay > 0.0
    {
        let [xx, yy, xy] = decay_stress(law, decay, start, end);
        stress[0] += at[0] * xx + at[1] * xy;
        stress[1] += at[0] * xy + at[1] * yy;
        stress[2] += at[2] * xx + at[3] * xy;
        stress[3] += at[2] * xy + at[3] * yy;
    }
    stress
}

/// `S = χ/2 D0 : (E' - E)` as `[S_xx, S_yy, S_xy]` (Pa), with `E' - E` the symmetric part of `F½ᵀ (F' - F)`, exactly.
#[inline]
fn decay_stress<L: Hyperelastic + ?Sized>(
    law: &L,
    decay: f64,
    start: [f64; 4],
    end: [f64; 4],
) -> [f64; 3] {
    let constants = law.constants();
    let at = middle(start, end);
    let change: [f64; 4] = std::array::from_fn(|k| end[k] - start[k]);
    let xx = at[0] * change[0] + at[2] * change[2];
    let yy = at[1] * change[1] + at[3] * change[3];
    let xy = at[0] * change[1] + at[2] * change[3] + at[1] * change[0] + at[3] * change[2];
    let pressure = 0.5 * decay * constants.lambda() * (xx + yy);
    let twice_shear = decay * constants.mu();
    [
        pressure + twice_shear * xx,
        pressure + twice_shear * yy,
        0.5 * twice_shear * xy,
    ]
}

/// The symmetric moduli `∂P/∂F'` (Pa).
///
/// From `P = 2 a F½ + b cof F½`: `s (2 a I + b ∂cof/∂F + 4 W_tt F½⊗F½ + 2 W_tJ (F½⊗cof + cof⊗F½) + W_JJ cof⊗cof)` with the derivatives of
/// the pair for those of `W`, `s = 1/2`, and `F½` for `F'` in the second factors, which keeps the products definite; for equilibrium all at the
/// end and `s = 1`.
pub(super) fn moduli<L: Hyperelastic + ?Sized>(
    law: &L,
    form: Form,
    kind: Linearization,
    start: [f64; 4],
    end: [f64; 4],
) -> [[f64; 4]; 4] {
    let invariants = Invariants::of(end);
    let derivatives = match form {
        Form::Equilibrium => (law.gradient(invariants), law.hessian(invariants)),
        Form::EnergyMomentum { .. } => {
            let before = Invariants::of(start);
            let pair = law.conserving_pair(before, invariants);
            (pair, law.conserving_hessian(before, invariants))
        }
    };
    moduli_of_pair(law, (form, kind), derivatives, [start, end])
}

/// The moduli of a pair and its derivatives (Pa).
pub(super) fn moduli_of_pair<L: Hyperelastic + ?Sized>(
    law: &L,
    (form, kind): (Form, Linearization),
    (pair, second): ([f64; 2], [f64; 3]),
    [start, end]: [[f64; 4]; 2],
) -> [[f64; 4]; 4] {
    let (at, scale) = match form {
        Form::Equilibrium => (end, 1.0),
        Form::EnergyMomentum { .. } => (middle(start, end), 0.5),
    };
    let (pair, second) = match kind {
        Linearization::Consistent => (pair, second),
        Linearization::Definite | Linearization::Impulsive { .. } => (
            definite_pair(law.constants().mu(), pair),
            definite_hessian(second),
        ),
    };
    let mut moduli = law_moduli(at, pair, second, scale);
    if let Form::EnergyMomentum { decay } = form
        && decay > 0.0
    {
        let stress = match kind {
            Linearization::Consistent => decay_stress(law, decay, start, end),
            Linearization::Definite | Linearization::Impulsive { .. } => [0.0; 3],
        };
        let [lambda, mu] = [law.constants().lambda(), law.constants().mu()];
        add_decay_moduli(
            at,
            [0.5 * decay * lambda, 0.5 * decay * mu],
            stress,
            &mut moduli,
        );
    }
    if let Linearization::Impulsive { .. } = kind {
        forget_turn(end, &mut moduli);
    }
    moduli
}

#[inline]
pub(super) fn law_moduli(
    at: [f64; 4],
    [a, b]: [f64; 2],
    [tt, tj, jj]: [f64; 3],
    scale: f64,
) -> [[f64; 4]; 4] {
    let cofactor = cofactor(at);
    let mut moduli = [[0.0; 4]; 4];
    for (row, entries) in moduli.iter_mut().enumerate() {
        let (by_t, by_j) = (2.0 * at[row], cofactor[row]);
        let (along_t, along_j) = (tt * by_t + tj * by_j, tj * by_t + jj * by_j);
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry = scale * (2.0 * along_t * at[column] + along_j * cofactor[column]);
        }
        entries[row] += 2.0 * scale * a;
    }
    // cof F is linear in F: its derivative is 1 between xx and yy, -1 between xy and yx.
    moduli[0][3] += scale * b;
    moduli[3][0] += scale * b;
    moduli[1][2] -= scale * b;
    moduli[2][1] -= scale * b;
    moduli
}

/// Adds `F½ (χ/2 D0) F½ᵀ` and half the decay stress, both with `F'` replaced by `F½` where the derivative has it.
#[inline]
fn add_decay_moduli(
    at: [f64; 4],
    [lambda, mu]: [f64; 2],
    [xx, yy, xy]: [f64; 3],
    moduli: &mut [[f64; 4]; 4],
) {
    let stress = [[xx, xy], [xy, yy]];
    for (row, entries) in moduli.iter_mut().enumerate() {
        let (i, j) = (row / 2, row % 2);
        for (column, entry) in entries.iter_mut().enumerate() {
            let (k, l) = (column / 2, column % 2);
            *entry += lambda * at[row] * at[column] + mu * at[2 * i + l] * at[2 * k + j];
            if j == l {
                *entry += mu * (at[2 * i] * at[2 * k] + at[2 * i + 1] * at[2 * k + 1]);
            }
            if i == k {
                *entry += 0.5 * stress[j][l];
            }
        }
    }
}

/// `2 a I + b ∂cof/∂F` has the eigenvalues `2 a ± b`: they are kept from below zero, with a hundredth of the shear modulus left.
fn definite_pair(mu: f64, [a, b]: [f64; 2]) -> [f64; 2] {
    let a = a.max(0.01 * mu);
    [a, b.clamp(-2.0 * a, 2.0 * a)]
}

/// The part of the second derivatives that belongs to eigenvalues above zero.
fn definite_hessian([tt, tj, jj]: [f64; 3]) -> [f64; 3] {
    let mean = 0.5 * (tt + jj);
    let half = 0.5 * (tt - jj);
    let radius = (half * half + tj * tj).sqrt();
    if mean >= radius {
        return [tt, tj, jj];
    }
    // One is negative: what is left is the larger one times the projector on its direction.
    let larger = (mean + radius).max(0.0);
    let (cos, sin) = (half / radius, tj / radius);
    let share = 0.5 * larger;
    [share * (1.0 + cos), share * sin, share * (1.0 - cos)]
}

#[cfg(test)]
mod tests {
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

    /// `F½ S : ΔF = χ/2 ΔE : D0 : ΔE` for any change of strain, and nothing for a rotation about the same axes.
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
        let change = std::array::from_fn(|k| after[k] - before[k]);
        let hooke = law.constants().linear(1.0);
        use crate::fe::material::Material;
        let expected = 0.1 * hooke.energy_density(change);
        assert!((work(END) - expected).abs() < 1e-9 * expected);
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
                super::super::cells::add_point(&gradient, &moduli, volume, &mut blocks);
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
}
