//! Invariants less those at rest, to all their digits: what stiff material that turns is made of.
//!
//! A gradient of deformation is a turned dilation and the rest of it,
//!
//! ```text
//! F = S + D,    S = [α, -β; β, α],    D = [γ, δ; δ, -γ]
//! t - 2 = 2 (g + s),    J - 1 = g - s,    g = α² + β² - 1,    s = γ² + δ²
//! ```
//!
//! and the stress of a pair is `P = (2 a + b) S + (2 a - b) D`. At rest `2 a + b` is zero, as a difference of moduli: from `t` and `J`, which are known to
//! their rounding ε, it is known to `ε E`, whatever the strain is, and so is the work that it does, and the couple by which the components of `P` turn a cell.
//! From `g`, which is formed without that rounding, it is known to ε of itself.

/// How a gradient differs from a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BesideRest {
    /// `g = α² + β² - 1` (-), by which the square of the mean stretch has grown.
    pub growth: f64,
    /// `s = γ² + δ²` (-), the square of half the difference of the principal stretches.
    pub shear: f64,
}

/// Splits a gradient `[F_xx, F_xy, F_yx, F_yy]` (-) into `[α, β, γ, δ]`.
#[inline]
fn split([xx, xy, yx, yy]: [f64; 4]) -> [f64; 4] {
    [
        0.5 * (xx + yy),
        0.5 * (yx - xy),
        0.5 * (xx - yy),
        0.5 * (xy + yx),
    ]
}

impl BesideRest {
    /// That of a gradient `[F_xx, F_xy, F_yx, F_yy]` (-).
    #[inline]
    pub fn of(gradient: [f64; 4]) -> Self {
        let [turned, across, along, skew] = split(gradient);
        Self {
            growth: squares_less_one(turned, across),
            shear: along * along + skew * skew,
        }
    }

    /// `t - 2` (-).
    #[inline]
    pub fn t(self) -> f64 {
        2.0 * (self.growth + self.shear)
    }

    /// `J - 1` (-).
    #[inline]
    pub fn j(self) -> f64 {
        self.growth - self.shear
    }
}

/// `a² + b² - 1` without the rounding of the squares.
#[inline]
fn squares_less_one(a: f64, b: f64) -> f64 {
    let ([a, a_left], [b, b_left]) = (square(a), square(b));
    // The difference to one of the larger square is exact near rest, and so is what the smaller one adds to that.
    let (large, small) = (a.max(b), a.min(b));
    ((large - 1.0) + small) + (a_left + b_left)
}

/// A square and what its rounding has left out, after Veltkamp and Dekker (1971).
#[inline]
fn square(a: f64) -> [f64; 2] {
    /// `2²⁷ + 1`: halves a number of 53 bits.
    const HALVES: f64 = 134_217_729.0;
    let scaled = HALVES * a;
    let high = scaled - (scaled - a);
    let low = a - high;
    let product = a * a;
    [
        product,
        ((high * high - product) + 2.0 * high * low) + low * low,
    ]
}

#[cfg(test)]
mod tests {
    use super::super::{
        Corotated, Hyperelastic, Invariants, NeoHookean, StVenantKirchhoff, StableNeoHookean,
    };
    use super::*;
    use crate::math::sin_cos;

    /// Against the squares in whole numbers: of `a = m 2⁻⁵³` and `b = n 2⁻⁵³` they have 106 bits.
    #[test]
    fn squares_less_one_have_all_their_digits() {
        for angle in [0.0, 0.3, 0.78, 1.2, 1.57, 2.9] {
            for stretch in [1.0, 1.0 - 1e-15, 1.0 - 3e-9, 0.999] {
                let (sin, cos) = sin_cos(angle);
                let scale = 2.0f64.powi(53);
                let [a, b] = [cos, sin].map(|part| (stretch * part * scale) as i128);
                let exact = (a * a + b * b - (1i128 << 106)) as f64 / (scale * scale);
                let found = squares_less_one(a as f64 / scale, b as f64 / scale);
                assert!(
                    (found - exact).abs() <= 1e-15 * exact.abs(),
                    "{angle} {stretch}: {found:e} for {exact:e}"
                );
            }
        }
    }

    /// A strain of 1e-6 that turns by .08 rad: what the stress turns, and what its work differs from the change of energy by, beside the stress
    /// and not beside the moduli, which are a million times as large. Some ten terms have a rounding of 1e-16 each.
    #[test]
    fn small_strains_of_what_turns_have_the_digits_of_the_stress() {
        let laws: [Box<dyn Hyperelastic>; 4] = [
            Box::new(Corotated::plane_strain(1e11, 0.3)),
            Box::new(NeoHookean::plane_strain(1e11, 0.3)),
            Box::new(StVenantKirchhoff::plane_strain(1e11, 0.3)),
            Box::new(StableNeoHookean::plane_strain(1e11, 0.3)),
        ];
        let turned = |angle: f64, [xx, yy, xy]: [f64; 3]| {
            let (sin, cos) = sin_cos(angle);
            let (xx, yy) = (1.0 + xx, 1.0 + yy);
            [
                cos * xx - sin * xy,
                cos * xy - sin * yy,
                sin * xx + cos * xy,
                sin * xy + cos * yy,
            ]
        };
        let start = turned(0.7, [1e-6, -2e-6, 1.5e-6]);
        let end = turned(0.78, [-2e-6, 3e-6, 0.5e-6]);
        let [alpha, beta, gamma, delta] = split(std::array::from_fn(|k| 0.5 * (start[k] + end[k])));
        let change: [f64; 4] = std::array::from_fn(|k| end[k] - start[k]);
        for law in &laws {
            let [p, q] = law.conserving_sums(start, end);
            let stress = [
                p * alpha + q * gamma,
                q * delta - p * beta,
                q * delta + p * beta,
                p * alpha - q * gamma,
            ];
            let size = stress.iter().map(|p| p.abs()).sum::<f64>();
            // Hooke's stresses, half of 1e11 times some 1e-6: the moduli do not show in them.
            assert!(size > 1e4 && size < 1e6, "{}: {size:e}", law.name());
            let pairs = stress.iter().zip(change);
            let work: f64 = pairs.map(|(p, change)| p * change).sum();
            let energies = [start, end].map(|gradient| law.energy_of(gradient));
            let error = work - (energies[1] - energies[0]);
            assert!(
                error.abs() < 1e-15 * size,
                "{}: {error:e} of {size:e}",
                law.name()
            );
            // From the invariants it is known to the rounding of the moduli.
            let coarse = law.energy_density(Invariants::of(end)) - energies[1];
            assert!(coarse.abs() < 1e-15 * 1e11, "{}: {coarse:e}", law.name());
        }
    }
}
