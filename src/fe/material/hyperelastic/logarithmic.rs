//! Logarithmic strains in the plane, and the conserving pair of the energies that are made of them.
//!
//! With the principal stretches `λ1 >= λ2` of a gradient in the plane and a logarithmic strain `ε3` out of it, which a step does not change,
//!
//! ```text
//! s = ln λ1 + ln λ2 = ln J,    d = ln λ1 - ln λ2,    cosh d = q = t/2J
//! θ = s + ε3,    m = |dev ε|² = (s - 2 ε3)²/6 + d²/2,    W = K/2 θ² + ψ(m)
//! ```
//!
//! with `ψ = μ m` in Hencky's law, and of less slope where material flows. Every difference between two states is a product of one and a quotient
//! that does not cancel,
//!
//! ```text
//! ΔW = K θ̄ Δs + ψ̄ Δm,    Δm = (s̄ - 2 ε3)/3 Δs + ½ Δd²,    Δs = (Δ ln J/ΔJ) ΔJ
//! Δd² = D̄ Δq,    D̄ = 2 c((d + d')/2) c((d' - d)/2),    c(x) = x/sinh x,    Δq = ½ (h̄ Δt - t̄ ΔJ/JJ'),    h̄ = ½ (1/J + 1/J')
//! ```
//!
//! whose coefficients of `Δt` and `ΔJ` are the pair:
//!
//! ```text
//! a = ¼ ψ̄ D̄ h̄,    b = (Δ ln J/ΔJ) [K θ̄ + ψ̄ (s̄ - 2 ε3)/3] - ¼ ψ̄ D̄ t̄/JJ'
//! ```

use super::Invariants;
use super::quotient::{quotient, rise_of_slope_of_ln, slope_of_ln};
use crate::math::{exp, exp_m1, ln};

/// Logarithmic strains of a gradient of deformation in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LogStrain {
    pub t: f64,
    pub j: f64,
    /// `s = ln J` (-).
    pub sum: f64,
    /// `d >= 0` (-).
    pub difference: f64,
    /// `d²` (-), and its analytic continuation to `q < 1`, where rounding may lead.
    pub square: f64,
    /// `q - 1` (-).
    beyond: f64,
}

impl LogStrain {
    /// Of a gradient `[F_xx, F_xy, F_yx, F_yy]` with `J > 0`: `t - 2 J` is a sum of squares, which loses no digits at small strains.
    pub fn of(gradient: [f64; 4]) -> Self {
        let [xx, xy, yx, yy] = gradient;
        let (along, across) = (xx - yy, xy + yx);
        Self::new(Invariants::of(gradient), along * along + across * across)
    }

    /// Of the invariants: at a strain of `ε` its digits are those of `ε²`.
    pub fn of_invariants(at: Invariants) -> Self {
        Self::new(at, at.t - 2.0 * at.j)
    }

    /// `tanh² (d/2) = (t - 2 J)/(t + 2 J)`.
    fn new(Invariants { t, j }: Invariants, gap: f64) -> Self {
        let beyond = 0.5 * gap / j;
        let tangent = (gap.max(0.0) / (t + 2.0 * j)).sqrt();
        let difference = 2.0 * tangent * quotient(tangent);
        let square = match beyond < 0.0 {
            true => beyond * continued(0.0, beyond),
            false => difference * difference,
        };
        Self {
            t,
            j,
            sum: ln(j),
            difference,
            square,
            beyond,
        }
    }

    /// `m`, the square of the deviator (-).
    pub fn deviator(&self, lateral: f64) -> f64 {
        let plane = self.sum - 2.0 * lateral;
        plane * plane / 6.0 + 0.5 * self.square
    }

    /// `D̄`.
    fn slope_to(&self, other: &Self) -> f64 {
        let (z, to) = (self.beyond, other.beyond);
        if z.min(to) >= 0.0 {
            let half = |sign: f64| 0.5 * (other.difference + sign * self.difference);
            return 2.0 * over_sinh(half(1.0)) * over_sinh(half(-1.0));
        }
        match z.max(to) < CONTINUED {
            true => continued(z, to),
            false => (other.square - self.square) / (to - z),
        }
    }
}

/// `q - 1` up to which [`continued`] has all digits (-).
const CONTINUED: f64 = 1e-3;

/// `D̄` by the series `d² = 2 z - z²/3 + 4 z³/45 - z⁴/35 + 16 z⁵/1575 ...`, `z = q - 1`.
fn continued(z: f64, to: f64) -> f64 {
    let coefficients = [2.0, -1.0 / 3.0, 4.0 / 45.0, -1.0 / 35.0, 16.0 / 1575.0];
    // (z'ⁿ⁺¹ - zⁿ⁺¹)/(z' - z) = z' (z'ⁿ - zⁿ)/(z' - z) + zⁿ.
    let (mut sum, mut quotient, mut power) = (0.0, 1.0, z);
    for coefficient in coefficients {
        sum += coefficient * quotient;
        quotient = to * quotient + power;
        power *= z;
    }
    sum
}

/// The slope of `ψ` between two states (Pa), and its derivative by `m` of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slope {
    pub value: f64,
    pub rise: f64,
}

/// A pair `(a, b)` and `[∂a/∂t', (∂a/∂J' + ∂b/∂t')/2, ∂b/∂J']` (Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub pair: [f64; 2],
    pub slopes: [f64; 3],
}

/// The pair of two states.
///
/// - `lateral`: the strain `ε3` (-).
/// - `bulk`: the modulus `K` (Pa).
pub(super) fn between(
    from: &LogStrain,
    to: &LogStrain,
    [lateral, bulk]: [f64; 2],
    slope: Slope,
) -> Pair {
    let (x, y) = (
        0.5 * (from.difference + to.difference),
        0.5 * (to.difference - from.difference),
    );
    let by_q = from.slope_to(to);
    // c'/c = -k, and x + y = d': the sum vanishes with it.
    let rise = if to.difference < SMALL {
        let half = over_sinh(0.5 * from.difference);
        -half * half * langevin_slope(0.5 * from.difference)
    } else {
        -0.5 * by_q * (langevin(x) + langevin(y)) / sinh(to.difference)
    };
    let at = End::of(to, lateral);
    let inverse = 1.0 / to.j;
    let logarithm = [slope_of_ln(from.j, to.j), rise_of_slope_of_ln(from.j, to.j)];
    assemble(
        [lateral, bulk],
        Pieces {
            slope: at.along_m(slope),
            by_q: at.along_q(by_q, rise),
            inverse: Dual::of_j(0.5 * (1.0 / from.j + inverse), -0.5 * inverse * inverse),
            inverse_squared: Dual::of_j(inverse / from.j, -inverse * inverse / from.j),
            logarithm: Dual::of_j(logarithm[0], logarithm[1]),
            sum: Dual::of_j(0.5 * (from.sum + to.sum), 0.5 * inverse),
            t: Dual([0.5 * (from.t + to.t), 0.5, 0.0]),
        },
    )
}

/// Gradient and Hessian at one state.
pub(super) fn at(strain: &LogStrain, [lateral, bulk]: [f64; 2], slope: Slope) -> Pair {
    let difference = strain.difference;
    let by_q = strain.slope_to(strain);
    let rise = if difference < SMALL {
        -2.0 * langevin_slope(0.0)
    } else {
        -by_q * langevin(difference) / sinh(difference)
    };
    let at = End::of(strain, lateral);
    let inverse = 1.0 / strain.j;
    let squared = inverse * inverse;
    assemble(
        [lateral, bulk],
        Pieces {
            slope: at.along_m(slope),
            by_q: at.along_q(by_q, rise),
            inverse: Dual::of_j(inverse, -squared),
            inverse_squared: Dual::of_j(squared, -2.0 * squared * inverse),
            logarithm: Dual::of_j(inverse, -squared),
            sum: Dual::of_j(strain.sum, inverse),
            t: Dual([strain.t, 1.0, 0.0]),
        },
    )
}

/// Difference of strains below which derivatives are those at none, to a share of the square (-).
const SMALL: f64 = 1e-4;

/// A number with its derivatives by `t'` and `J'`.
#[derive(Clone, Copy)]
struct Dual([f64; 3]);

impl Dual {
    fn of_j(value: f64, by_j: f64) -> Self {
        Self([value, 0.0, by_j])
    }

    fn times(self, other: Self) -> Self {
        let (Self([a, a_t, a_j]), Self([b, b_t, b_j])) = (self, other);
        Self([a * b, a_t * b + a * b_t, a_j * b + a * b_j])
    }

    fn scaled(self, factor: f64) -> Self {
        Self(self.0.map(|entry| factor * entry))
    }

    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    fn plus_number(self, number: f64) -> Self {
        let Self([value, by_t, by_j]) = self;
        Self([value + number, by_t, by_j])
    }
}

/// Derivatives of `q'` and `m'` by `t'` and `J'`.
struct End {
    q: [f64; 2],
    m: [f64; 2],
}

impl End {
    fn of(strain: &LogStrain, lateral: f64) -> Self {
        let half = 0.5 / strain.j;
        let q = [half, -half * strain.t / strain.j];
        let by_q = 0.5 * strain.slope_to(strain);
        let by_s = (strain.sum - 2.0 * lateral) / 3.0;
        Self {
            m: [by_q * q[0], by_q * q[1] + by_s / strain.j],
            q,
        }
    }

    fn along_m(&self, Slope { value, rise }: Slope) -> Dual {
        Dual([value, rise * self.m[0], rise * self.m[1]])
    }

    fn along_q(&self, value: f64, rise: f64) -> Dual {
        Dual([value, rise * self.q[0], rise * self.q[1]])
    }
}

/// What a pair is made of.
struct Pieces {
    /// `ψ̄`.
    slope: Dual,
    /// `D̄`.
    by_q: Dual,
    /// `h̄`.
    inverse: Dual,
    /// `1/JJ'`.
    inverse_squared: Dual,
    /// `Δ ln J/ΔJ`.
    logarithm: Dual,
    /// `s̄`.
    sum: Dual,
    /// `t̄`.
    t: Dual,
}

fn assemble([lateral, bulk]: [f64; 2], of: Pieces) -> Pair {
    let shear = of.slope.times(of.by_q).scaled(0.25);
    let along_s = of.sum.plus_number(lateral).scaled(bulk).plus(
        of.slope
            .times(of.sum.plus_number(-2.0 * lateral))
            .scaled(1.0 / 3.0),
    );
    let Dual([a, a_t, a_j]) = shear.times(of.inverse);
    let turned = shear.times(of.t).times(of.inverse_squared).scaled(-1.0);
    let Dual([b, b_t, b_j]) = of.logarithm.times(along_s).plus(turned);
    Pair {
        pair: [a, b],
        slopes: [a_t, 0.5 * (a_j + b_t), b_j],
    }
}

/// `sinh x`.
pub(super) fn sinh(x: f64) -> f64 {
    // e^x - 1 = u: sinh x = (u + u/(1 + u))/2, without cancellation.
    let above = exp_m1(x.abs());
    (0.5 * (above + above / (1.0 + above))).copysign(x)
}

/// `cosh x`.
pub(super) fn cosh(x: f64) -> f64 {
    let above = exp(x.abs());
    0.5 * (above + 1.0 / above)
}

/// `c(x) = x/sinh x`.
pub(super) fn over_sinh(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x / sinh(x) }
}

/// `x²` below which a series takes the place of hyperbolic functions: it leaves out some 1e-17.
const SERIES: f64 = 0.01;

/// `k(x) = coth x - 1/x`.
fn langevin(x: f64) -> f64 {
    let squared = x * x;
    if squared < SERIES {
        let coefficients = [
            2.0 / 93555.0,
            -1.0 / 4725.0,
            2.0 / 945.0,
            -1.0 / 45.0,
            1.0 / 3.0,
        ];
        return x * coefficients
            .into_iter()
            .fold(0.0, |sum, coefficient| sum * squared + coefficient);
    }
    cosh(x) / sinh(x) - 1.0 / x
}

/// `k'(x) = 1/x² - 1/sinh² x`.
fn langevin_slope(x: f64) -> f64 {
    let squared = x * x;
    if squared < SERIES {
        let coefficients = [
            18.0 / 93555.0,
            -7.0 / 4725.0,
            10.0 / 945.0,
            -1.0 / 15.0,
            1.0 / 3.0,
        ];
        return coefficients
            .into_iter()
            .fold(0.0, |sum, coefficient| sum * squared + coefficient);
    }
    let sinh = sinh(x);
    1.0 / squared - 1.0 / (sinh * sinh)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Branches meet, and functions are what they are called: hyperbolic functions of the standard library, derivatives by differences.
    #[test]
    fn hyperbolic_quotients_are_those_of_the_standard_library() {
        for x in [1e-9, 1e-3, 0.09999, 0.10001, 0.9, 3.0, 20.0] {
            for x in [x, -x] {
                assert!((sinh(x) / x.sinh() - 1.0).abs() < 1e-15);
                assert!((cosh(x) / x.cosh() - 1.0).abs() < 1e-15);
                assert!((over_sinh(x) * x.sinh() / x - 1.0).abs() < 1e-15);
                let exact = if x.abs() < 1e-2 {
                    x / 3.0
                } else {
                    1.0 / x.tanh() - 1.0 / x
                };
                assert!((langevin(x) - exact).abs() < 1e-10 + 1e-12, "{x}");
                let step = 1e-5;
                let slope = (langevin(x + step) - langevin(x - step)) / (2.0 * step);
                assert!((langevin_slope(x) - slope).abs() < 1e-9, "{x}");
            }
        }
    }

    /// `d` is known to its own digits however small it is.
    #[test]
    fn small_differences_of_strain_keep_their_digits() {
        for strain in [1e-12, 1e-6, 1e-3, 0.3, 2.0f64] {
            let found = LogStrain::of([strain.exp(), 0.0, 0.0, (-strain).exp()]);
            // The stretches themselves are rounded.
            let allowed = 2e-16 + 1e-15 * strain;
            assert!((found.difference - 2.0 * strain).abs() < 2.0 * allowed);
            assert!(found.sum.abs() < 4.0 * allowed);
        }
    }
}
