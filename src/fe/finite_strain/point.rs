//! Stress `P` and moduli `∂P/∂F'` at one quadrature point.
//!
//! Gradients and stresses are `[xx, xy, yx, yy]`; the first index is of space, the second of the undeformed material.

use super::linearization::{Linearization, forget_turn};
use crate::fe::material::hyperelastic::{ElasticConstants, Hyperelastic, Invariants};
use crate::math::Number;

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

    /// The decay `χ`, where there is any (-).
    #[inline(always)]
    pub(super) fn decays(self) -> Option<f64> {
        match self {
            Self::EnergyMomentum { decay } if decay > 0.0 => Some(decay),
            _ => None,
        }
    }

    /// The gradient that forces are taken at.
    #[inline(always)]
    pub(super) fn gradient_of<T: Number>(self, start: [T; 4], end: [T; 4]) -> [T; 4] {
        match self {
            Self::Equilibrium => end,
            Self::EnergyMomentum { .. } => middle(start, end),
        }
    }
}

/// Four parts, written out: the closures of iterators are not always inlined, and then not in registers.
#[inline(always)]
pub(super) fn each<T>(of: impl Fn(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}

/// The cofactor matrix, `∂ det F/∂F`.
#[inline(always)]
pub(super) fn cofactor<T: Number>([xx, xy, yx, yy]: [T; 4]) -> [T; 4] {
    [yy, -yx, -xy, xx]
}

#[inline(always)]
pub(super) fn middle<T: Number>(start: [T; 4], end: [T; 4]) -> [T; 4] {
    each(|k| (start[k] + end[k]) * 0.5)
}

/// Invariants of a gradient, `[t, J]`.
#[inline(always)]
pub(super) fn invariants<T: Number>([xx, xy, yx, yy]: [T; 4]) -> [T; 2] {
    [xx * xx + xy * xy + yx * yx + yy * yy, xx * yy - xy * yx]
}

/// The first Piola–Kirchhoff stress `P` (Pa).
#[cfg(test)]
pub(super) fn stress(
    law: &dyn Hyperelastic,
    form: Form,
    start: [f64; 4],
    end: [f64; 4],
) -> [f64; 4] {
    let sums = match form {
        Form::Equilibrium => law.conserving_sums(end, end),
        Form::EnergyMomentum { .. } => law.conserving_sums(start, end),
    };
    stress_of_sums(law.constants(), form, sums, [start, end])
}

/// `P = 2 a F + b cof F = (2 a + b) S + (2 a - b) D` of a pair, with the decay (Pa); see [`BesideRest`](crate::fe::material::hyperelastic::BesideRest).
#[inline(always)]
pub(super) fn stress_of_sums<T: Number>(
    constants: ElasticConstants,
    form: Form,
    [turned, rest]: [T; 2],
    [start, end]: [[T; 4]; 2],
) -> [T; 4] {
    let at = form.gradient_of(start, end);
    let [xx, xy, yx, yy] = at;
    let decay = form
        .decays()
        .map(|decay| Decay::of(constants, decay, [start, end]));
    // A pressure is part of `b`.
    let pressure = decay.map_or(T::ZERO, |decay| decay.pressure);
    // Twice α, β, γ and δ of the two parts.
    let (turned, rest) = ((turned + pressure) * 0.5, (rest - pressure) * 0.5);
    let [alpha, beta] = [turned * (xx + yy), turned * (yx - xy)];
    let [gamma, delta] = [rest * (xx - yy), rest * (xy + yx)];
    let mut stress = [alpha + gamma, delta - beta, delta + beta, alpha - gamma];
    if let Some(Decay { shear, .. }) = decay {
        let [xx, yy, xy] = shear;
        stress[0] += at[0] * xx + at[1] * xy;
        stress[1] += at[0] * xy + at[1] * yy;
        stress[2] += at[2] * xx + at[3] * xy;
        stress[3] += at[2] * xy + at[3] * yy;
    }
    stress
}

/// What resists the changes of a step (Pa).
#[derive(Clone, Copy)]
struct Decay<T> {
    /// `χ μ (E' - E)` as `[xx, yy, xy]`.
    shear: [T; 3],
    /// `χ/2 λ (J' - J)`.
    pressure: T,
}

impl<T: Number> Decay<T> {
    /// With `E' - E` the symmetric part of `F½ᵀ (F' - F)` and `J' - J = cof F½ : (F' - F)`, both exactly.
    #[inline(always)]
    fn of(constants: ElasticConstants, decay: f64, [start, end]: [[T; 4]; 2]) -> Self {
        let at = middle(start, end);
        let change = each(|k| end[k] - start[k]);
        let xx = at[0] * change[0] + at[2] * change[2];
        let yy = at[1] * change[1] + at[3] * change[3];
        let xy = at[0] * change[1] + at[2] * change[3] + at[1] * change[0] + at[3] * change[2];
        let twice_shear = decay * constants.mu();
        Self {
            shear: [xx * twice_shear, yy * twice_shear, xy * (0.5 * twice_shear)],
            pressure: growth([start, end]) * (0.5 * decay * constants.lambda()),
        }
    }
}

/// `J' - J` of two gradients, without a difference of areas (-).
#[inline(always)]
pub(super) fn growth<T: Number>([start, end]: [[T; 4]; 2]) -> T {
    let across = cofactor(middle(start, end));
    let own = each(|k| across[k] * (end[k] - start[k]));
    own[0] + own[1] + own[2] + own[3]
}

/// What a law says of a point between two states: its pair, and the derivatives of that (Pa).
pub(super) fn derivatives(
    law: &dyn Hyperelastic,
    form: Form,
    start: [f64; 4],
    end: [f64; 4],
) -> ([f64; 2], [f64; 3]) {
    let invariants = Invariants::of(end);
    match form {
        Form::Equilibrium => (law.gradient(invariants), law.hessian(invariants)),
        Form::EnergyMomentum { .. } => {
            let before = Invariants::of(start);
            let pair = law.conserving_pair(before, invariants);
            (pair, law.conserving_hessian(before, invariants))
        }
    }
}

/// The symmetric moduli `∂P/∂F'` (Pa).
///
/// From `P = 2 a F½ + b cof F½`: `s (2 a I + b ∂cof/∂F + 4 W_tt F½⊗F½ + 2 W_tJ (F½⊗cof + cof⊗F½) + W_JJ cof⊗cof)` with the derivatives of
/// the pair for those of `W`, `s = 1/2`, and `F½` for `F'` in the second factors, which keeps the products definite; for equilibrium all at the
/// end and `s = 1`.
#[cfg(test)]
pub(super) fn moduli(
    law: &dyn Hyperelastic,
    form: Form,
    kind: Linearization,
    start: [f64; 4],
    end: [f64; 4],
) -> [[f64; 4]; 4] {
    let found = derivatives(law, form, start, end);
    moduli_of_pair(law.constants(), (form, kind), found, [start, end])
}

/// The moduli of a pair and its derivatives (Pa).
pub(super) fn moduli_of_pair(
    constants: ElasticConstants,
    (form, kind): (Form, Linearization),
    (pair, second): ([f64; 2], [f64; 3]),
    ends: [[f64; 4]; 2],
) -> [[f64; 4]; 4] {
    if kind == Linearization::Consistent {
        return consistent_moduli(constants, form, (pair, second), ends);
    }
    let derivatives = (
        definite_pair(constants.mu(), pair),
        definite_hessian(second),
    );
    let mut moduli = moduli_under(constants, form, derivatives, (ends, None));
    if let Linearization::Impulsive { .. } = kind {
        forget_turn(ends[1], &mut moduli);
    }
    moduli
}

/// The same as they are, definite or not.
#[inline(always)]
pub(super) fn consistent_moduli<T: Number>(
    constants: ElasticConstants,
    form: Form,
    derivatives: ([T; 2], [T; 3]),
    ends: [[T; 4]; 2],
) -> [[T; 4]; 4] {
    let stress = form.decays().map(|decay| Decay::of(constants, decay, ends));
    moduli_under(constants, form, derivatives, (ends, stress))
}

/// The same with this stress of the decay, or as if it had none.
#[inline(always)]
fn moduli_under<T: Number>(
    constants: ElasticConstants,
    form: Form,
    ([a, b], [tt, tj, jj]): ([T; 2], [T; 3]),
    ([start, end], stress): ([[T; 4]; 2], Option<Decay<T>>),
) -> [[T; 4]; 4] {
    let at = form.gradient_of(start, end);
    let share = form.share_of_end();
    let Some(decay) = form.decays() else {
        return law_moduli(at, [a, b], [tt, tj, jj], share);
    };
    let Decay { shear, pressure } = stress.unwrap_or(Decay {
        shear: [T::ZERO; 3],
        pressure: T::ZERO,
    });
    // `cof F½ ⊗ χ/2 λ cof F½`, of which the half of the end is not to take half.
    let jj = jj + T::ONE * (decay * constants.lambda());
    let mut moduli = law_moduli(at, [a, b + pressure], [tt, tj, jj], share);
    add_shear_decay(at, 0.5 * decay * constants.mu(), shear, &mut moduli);
    moduli
}

#[inline(always)]
pub(super) fn law_moduli<T: Number>(
    at: [T; 4],
    [a, b]: [T; 2],
    [tt, tj, jj]: [T; 3],
    scale: f64,
) -> [[T; 4]; 4] {
    let cofactor = cofactor(at);
    let mut moduli = [[T::ZERO; 4]; 4];
    for (row, entries) in moduli.iter_mut().enumerate() {
        let (by_t, by_j) = (at[row] * 2.0, cofactor[row]);
        let (along_t, along_j) = (tt * by_t + tj * by_j, tj * by_t + jj * by_j);
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry = (along_t * 2.0 * at[column] + along_j * cofactor[column]) * scale;
        }
        entries[row] += a * (2.0 * scale);
    }
    // cof F is linear in F: its derivative is 1 between xx and yy, -1 between xy and yx.
    let along = b * scale;
    for (row, column, sign) in [(0, 3, 1.0), (3, 0, 1.0), (1, 2, -1.0), (2, 1, -1.0)] {
        moduli[row][column] += along * sign;
    }
    moduli
}

/// Adds `F½ (χ/2 D) F½ᵀ`, `D` with the shear modulus alone, and half its stress, both with `F'` replaced by `F½` where the derivative has it.
///
/// - `mu`: `χ/2 μ` (Pa).
#[inline(always)]
fn add_shear_decay<T: Number>(at: [T; 4], mu: f64, [xx, yy, xy]: [T; 3], moduli: &mut [[T; 4]; 4]) {
    let stress = [[xx, xy], [xy, yy]];
    for (row, entries) in moduli.iter_mut().enumerate() {
        let (i, j) = (row / 2, row % 2);
        for (column, entry) in entries.iter_mut().enumerate() {
            let (k, l) = (column / 2, column % 2);
            *entry += at[2 * i + l] * mu * at[2 * k + j];
            if j == l {
                *entry += (at[2 * i] * at[2 * k] + at[2 * i + 1] * at[2 * k + 1]) * mu;
            }
            if i == k {
                *entry += stress[j][l] * 0.5;
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
mod tests;
