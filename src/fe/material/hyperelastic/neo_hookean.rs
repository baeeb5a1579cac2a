//! The logarithmic neo-Hookean law: `W = μ/2 (t - 2) - μ ln J + λ/2 ln² J`.

use super::quotient::{quotient_less_one, rise_of_slope_of_ln, slope_of_ln};
use super::{BesideRest, ElasticConstants, Hyperelastic, Invariants, Volumetric};
use crate::fe::material::LinearElastic;
use crate::fe::record::LawRecord;
use crate::math::{ln, ln_1p};

/// Change of `J`, relative to itself, up to which derivatives in the middle are those of the pair, to a share as small (-).
const SMALL: f64 = 1e-6;

/// `W = μ/2 (t - 2) - μ ln J + λ/2 ln² J`, for `J > 0` only.
///
/// The energy grows beyond bounds as material is crushed to nothing, so no solution turns it inside out; a step that would is
/// not found, and has to be shortened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct NeoHookean {
    constants: ElasticConstants,
}

impl NeoHookean {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        Self {
            constants: ElasticConstants::new(young, poisson),
        }
    }

    /// The law that is Hooke's at rest: in plane stress one in the plane, which does not follow the thickness.
    pub fn at_rest(material: &LinearElastic) -> Self {
        Self {
            constants: ElasticConstants::in_plane(material),
        }
    }
}

impl Hyperelastic for NeoHookean {
    fn name(&self) -> &'static str {
        "neo-Hookean"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::NeoHookean(*self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        Volumetric::logarithmic(self.constants.lambda())
    }

    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let log = ln(j);
        0.5 * mu * (t - 2.0) - mu * log + 0.5 * lambda * log * log
    }

    fn gradient(&self, Invariants { j, .. }: Invariants) -> [f64; 2] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        [0.5 * mu, (lambda * ln(j) - mu) / j]
    }

    fn hessian(&self, Invariants { j, .. }: Invariants) -> [f64; 3] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        [0.0, 0.0, (mu + lambda * (1.0 - ln(j))) / (j * j)]
    }

    /// `b = (Δ ln J / ΔJ) (-μ + λ/2 ln JJ')`.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let slope = slope_of_ln(from.j, to.j);
        [0.5 * mu, slope * (0.5 * lambda * ln(from.j * to.j) - mu)]
    }

    /// `2 a + b = μ (1 - q) + q λ/2 ln JJ'`, with `q = Δ ln J/ΔJ` and `e = J - 1`:
    /// `1 - q = (e + e' - 2 (atanh(y)/y - 1))/(2 + e + e')`, `y = (e' - e)/(2 + e + e')`.
    fn conserving_sums(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 2] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let [e, end] = [from, to].map(|f| BesideRest::of(f).j());
        let below = 2.0 + (e + end);
        let less = (e + end - 2.0 * quotient_less_one((end - e) / below)) / below;
        let sum = mu * less + 0.5 * lambda * (1.0 - less) * (ln_1p(e) + ln_1p(end));
        [sum, 2.0 * mu - sum]
    }

    /// `W = μ (2 s + e - ln J) + λ/2 ln² J`, `e = J - 1`.
    fn energy_of(&self, gradient: [f64; 4]) -> f64 {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let at = BesideRest::of(gradient);
        let log = ln_1p(at.j());
        mu * (2.0 * at.shear + (at.j() - log)) + 0.5 * lambda * log * log
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        // Where little changes the middle tells as much, in fewer operations.
        if (to.j - from.j).abs() <= SMALL * to.j {
            return self.hessian(from.mean(to));
        }
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let [slope, rise] = [slope_of_ln, rise_of_slope_of_ln].map(|of| of(from.j, to.j));
        let along_j = rise * (0.5 * lambda * ln(from.j * to.j) - mu) + 0.5 * slope * lambda / to.j;
        [0.0, 0.0, 2.0 * along_j]
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }

    /// `λ ln J/J`.
    fn out_of_plane_stress(&self, at: Invariants) -> f64 {
        self.constants.lambda() * ln(at.j) / at.j
    }
}

#[cfg(test)]
mod tests {
    use super::super::{conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [-0.4, 0.0, 0.3, 0.49] {
            let law = NeoHookean::plane_strain(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
        }
    }

    /// Source: benchmark B45, E = 1, ν = .3, plane strain, the nominal stress along the pull with free sides.
    #[test]
    fn uniaxial_stress_has_the_digits_of_the_closed_solution() {
        let law = NeoHookean::plane_strain(1.0, 0.3);
        let [stress, side] = principal_stress(&law, [0.5, 1.288304972]);
        assert!((stress + 1.084407463).abs() < 1e-9, "{stress}");
        // The digits of the side's stretch, times a modulus of some 1.3.
        assert!(side.abs() < 1e-9, "{side:e}");
    }
}
