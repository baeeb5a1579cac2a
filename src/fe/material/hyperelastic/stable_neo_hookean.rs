//! The stable neo-Hookean law of Smith, de Goes and Kim (2018), with constants of its own for the plane.

use super::quotient::{quotient_less_one, rise_of_slope_of_ln, slope_of_ln};
use super::{BesideRest, ElasticConstants, Hyperelastic, Invariants, Volumetric};
use crate::fe::record::LawRecord;
use crate::math::{ln, ln_1p};

/// `W = m/2 (t - 2) + l/2 (J - α)² - m/2 ln(t + 1)`, less its value at rest.
///
/// It has an energy and a stress at every `F`, and pushes material that is turned inside out back. In the plane,
/// with Lamé's constants `λ`, `μ` at rest,
///
/// ```text
/// m = 3/2 μ,    l = λ + 2/3 μ,    α = 1 + 2 m / (3 l)
/// ```
///
/// make rest free of stress and the moduli there Hooke's; the constants of three dimensions do not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct StableNeoHookean {
    constants: ElasticConstants,
    /// `m` (Pa).
    shear: f64,
    /// `l` (Pa).
    volumetric: f64,
    /// `α` (-), where the volumetric term has its least.
    rest_volume: f64,
}

impl StableNeoHookean {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        let constants = ElasticConstants::new(young, poisson);
        let shear = 1.5 * constants.mu();
        let volumetric = constants.lambda() + 2.0 / 3.0 * constants.mu();
        Self {
            constants,
            shear,
            volumetric,
            rest_volume: 1.0 + 2.0 * shear / (3.0 * volumetric),
        }
    }
}

impl Hyperelastic for StableNeoHookean {
    fn name(&self) -> &'static str {
        "stable neo-Hookean"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::StableNeoHookean(*self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        Volumetric::quadratic(self.constants.lambda())
    }

    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        // Differences from rest: l/2 ((J - α)² - (1 - α)²), and ln(t + 1) - ln 3.
        let volume = (j - 1.0) * (j + 1.0 - 2.0 * self.rest_volume);
        let distortion = (t - 2.0) - ln((t + 1.0) / 3.0);
        0.5 * self.volumetric * volume + 0.5 * self.shear * distortion
    }

    fn gradient(&self, Invariants { t, j }: Invariants) -> [f64; 2] {
        [
            0.5 * self.shear * t / (t + 1.0),
            self.volumetric * (j - self.rest_volume),
        ]
    }

    fn hessian(&self, Invariants { t, .. }: Invariants) -> [f64; 3] {
        let beyond = t + 1.0;
        [0.5 * self.shear / (beyond * beyond), 0.0, self.volumetric]
    }

    /// `a = m/2 (1 - Δ ln(t + 1)/Δt)`, `b = l (J̄ - α)`.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let slope = slope_of_ln(from.t + 1.0, to.t + 1.0);
        let j = 0.5 * (from.j + to.j);
        [
            0.5 * self.shear * (1.0 - slope),
            self.volumetric * (j - self.rest_volume),
        ]
    }

    /// With `l (1 - α) = -2 m/3` and `q = Δ ln(t + 1)/Δt`, which is 1/3 at rest: `2 a + b = m (1/3 - q) + l (J̄ - 1)` and
    /// `2 a - b = 4 a - (2 a + b)`, `2 a = 2 m/3 + m (1/3 - q)`.
    fn conserving_sums(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 2] {
        let (from, to) = (BesideRest::of(from), BesideRest::of(to));
        let (t, end) = (from.t(), to.t());
        let below = 6.0 + (t + end);
        let less = ((t + end) / 3.0 - 2.0 * quotient_less_one((end - t) / below)) / below;
        let sum = self.shear * less + 0.5 * self.volumetric * (from.j() + to.j());
        [sum, self.shear * (4.0 / 3.0 + 2.0 * less) - sum]
    }

    /// `W = l/2 (J - 1)² + 4/3 m s + m/2 ((t - 2)/3 - ln(1 + (t - 2)/3))`.
    fn energy_of(&self, gradient: [f64; 4]) -> f64 {
        let at = BesideRest::of(gradient);
        let (third, j) = (at.t() / 3.0, at.j());
        0.5 * self.volumetric * j * j
            + self.shear * (4.0 / 3.0 * at.shear + 0.5 * (third - ln_1p(third)))
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let rise = rise_of_slope_of_ln(from.t + 1.0, to.t + 1.0);
        [-self.shear * rise, 0.0, self.volumetric]
    }
}

#[cfg(test)]
mod tests {
    use super::super::{conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [-0.4, 0.0, 0.3, 0.49] {
            let law = StableNeoHookean::plane_strain(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
        }
    }

    /// A stretch through zero to the mirror image meets resistance all the way, and is pushed back from there.
    #[test]
    fn material_turned_inside_out_is_pushed_back() {
        let law = StableNeoHookean::plane_strain(1e5, 0.3);
        for stretch in [0.5, 0.1, 0.0, -0.1, -0.5, -1.0] {
            let [stress, _] = principal_stress(&law, [stretch, 1.0]);
            assert!(stress < 0.0, "{stretch}: {stress}");
        }
    }
}
