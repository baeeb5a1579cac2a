//! Gent's law for rubber whose chains have a length: `W = -μ m/2 ln(1 - (I1 - 3)/m) - μ ln J + λ/2 ln² J`.

use super::quotient::{rise_of_slope_of_ln, slope_of_ln};
use super::{ElasticConstants, Hyperelastic, Invariants, Volumetric};
use crate::fe::material::MaterialError;
use crate::fe::record::LawRecord;
use crate::math::ln;

/// `W = -μ m/2 ln(1 - (t - 2)/m) - μ ln J + λ/2 ln² J` in plane strain, for `J > 0` and `t < 2 + m` only.
///
/// Lamé's first constant at rest is `λ + 2 μ/m`. Where `I1 - 3 = t - 2` comes near to the limit `m` the material stiffens beyond bounds: rubber has some 30 to 100. For small strains, and
/// for `m` without bound, it is [`NeoHookean`](super::NeoHookean). A step that would stretch it beyond the limit is not found, and has to
/// be shortened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Gent {
    constants: ElasticConstants,
    limit: f64,
}

impl Gent {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest, and the limit `m` (-) of
    /// `I1 - 3`.
    pub fn plane_strain(young: f64, poisson: f64, limit: f64) -> Self {
        Self {
            constants: ElasticConstants::new(young, poisson),
            limit,
        }
    }

    /// `λ` of the volumetric part, less than Lamé's at rest by what the stiffening adds there: `2 μ/m` (Pa).
    fn volume_modulus(&self) -> f64 {
        self.constants.lambda() - 2.0 * self.constants.mu() / self.limit
    }

    /// What is left of the limit.
    fn left(&self, at: Invariants) -> f64 {
        self.limit - (at.t - 2.0)
    }
}

impl Hyperelastic for Gent {
    fn name(&self) -> &'static str {
        "Gent"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::Gent(*self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        Volumetric::logarithmic(self.volume_modulus())
    }

    fn energy_density(&self, at: Invariants) -> f64 {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        let log = ln(at.j);
        -0.5 * mu * self.limit * ln(self.left(at) / self.limit) - mu * log
            + 0.5 * lambda * log * log
    }

    fn gradient(&self, at: Invariants) -> [f64; 2] {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        [
            0.5 * mu * self.limit / self.left(at),
            (lambda * ln(at.j) - mu) / at.j,
        ]
    }

    fn hessian(&self, at: Invariants) -> [f64; 3] {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        let left = self.left(at);
        [
            0.5 * mu * self.limit / (left * left),
            0.0,
            (mu + lambda * (1.0 - ln(at.j))) / (at.j * at.j),
        ]
    }

    /// `a = μ m/2 Δ ln l/Δl` with what is left, `l = m + 2 - t`; `b` as of [`NeoHookean`](super::NeoHookean).
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        let stiffening = slope_of_ln(self.left(from), self.left(to));
        let slope = slope_of_ln(from.j, to.j);
        [
            0.5 * mu * self.limit * stiffening,
            slope * (0.5 * lambda * ln(from.j * to.j) - mu),
        ]
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        let stiffening = rise_of_slope_of_ln(self.left(from), self.left(to));
        let [slope, rise] = [slope_of_ln, rise_of_slope_of_ln].map(|of| of(from.j, to.j));
        let along_j = rise * (0.5 * lambda * ln(from.j * to.j) - mu) + 0.5 * slope * lambda / to.j;
        [-mu * self.limit * stiffening, 0.0, 2.0 * along_j]
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0 && self.left(at) > 0.0
    }

    /// `∂W/∂I1` times two, less `μ` and with `λ ln J`, over `J`.
    fn out_of_plane_stress(&self, at: Invariants) -> f64 {
        let (lambda, mu) = (self.volume_modulus(), self.constants.mu());
        (mu * (at.t - 2.0) / self.left(at) + lambda * ln(at.j)) / at.j
    }

    fn validate(&self) -> Result<(), MaterialError> {
        self.constants.validate()?;
        if !(self.limit > 0.0 && self.limit.is_finite()) {
            return Err(MaterialError::Parameter {
                name: "the limit of Gent's law",
                value: self.limit,
                cure: "give a positive finite value of I1 - 3, such as 50 for rubber",
            });
        }
        if self.volume_modulus() < 0.0 {
            return Err(MaterialError::Parameter {
                name: "Poisson's ratio of Gent's law",
                value: self.constants.poisson(),
                cure: "give at least 1/(m + 2), or its volumetric part is negative",
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{NeoHookean, conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_near_its_limit_and_far_from_it() {
        for limit in [3.0, 20.0, 1e3] {
            for nu in [0.25, 0.3, 0.49] {
                let law = Gent::plane_strain(1e6, nu, limit);
                assert_eq!(check_law(&law), Ok(()), "{limit} {nu}");
                assert_eq!(law.validate(), Ok(()));
            }
        }
        assert!(Gent::plane_strain(1e6, 0.3, 0.0).validate().is_err());
        assert!(Gent::plane_strain(1e6, 0.3, f64::NAN).validate().is_err());
        assert!(Gent::plane_strain(1e6, 0.15, 3.0).validate().is_err());
    }

    /// With the area kept, `P = μ m (σ - 1/σ³)/(m - σ² - 1/σ² + 2)` more than what the side bears, over it.
    #[test]
    fn a_pull_stiffens_towards_the_limit() {
        let (limit, nu) = (10.0, 0.3);
        let law = Gent::plane_strain(1.0, nu, limit);
        let mu = law.constants.mu();
        for stretch in [0.5f64, 1.5, 3.0, 3.4] {
            let side = 1.0 / stretch;
            let [pull, across] = principal_stress(&law, [stretch, side]);
            let difference = stretch * pull - side * across;
            let squares = stretch * stretch + side * side;
            let exact = mu * limit * (stretch * stretch - side * side) / (limit + 2.0 - squares);
            assert!((difference / exact - 1.0).abs() < 1e-13, "{stretch}");
        }
    }

    #[test]
    fn without_a_limit_it_is_neo_hookean() {
        let at = Invariants { t: 3.0, j: 1.3 };
        let far = Gent::plane_strain(1.0, 0.3, 1e8).energy_density(at);
        let exact = NeoHookean::plane_strain(1.0, 0.3).energy_density(at);
        assert!((far / exact - 1.0).abs() < 1e-7);
    }
}
