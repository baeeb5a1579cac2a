//! Hencky's law: Hooke's law for logarithmic strains.

use super::logarithmic::{self, LogStrain, Slope};
use super::{ElasticConstants, Hyperelastic, Invariants, Volumetric};
use crate::fe::record::LawRecord;

/// `W = μ |ε|² + λ/2 (tr ε)²` with `ε = ½ ln FᵀF`, for `J > 0` only.
///
/// It follows metals at strains for which Hooke's law is made, and gives the elastic part of [`J2Plasticity`](super::J2Plasticity), whose plastic
/// strains add up. The nominal stress of a pull falls from a stretch of `e` on, far beyond the use it is for.
///
/// Source: Hencky, Z. techn. Phys. 9 (1928), 215–220; Anand, J. Appl. Mech. 46 (1979), 78–82.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Hencky {
    constants: ElasticConstants,
}

impl Hencky {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        Self {
            constants: ElasticConstants::new(young, poisson),
        }
    }

    /// `K = λ + 2/3 μ` (Pa).
    pub(super) fn bulk(&self) -> f64 {
        self.constants.lambda() + self.constants.mu() / 1.5
    }

    fn slope(&self) -> Slope {
        Slope {
            value: self.constants.mu(),
            rise: 0.0,
        }
    }

    fn between(&self, from: Invariants, to: Invariants) -> logarithmic::Pair {
        let [from, to] = [from, to].map(LogStrain::of_invariants);
        logarithmic::between(&from, &to, [0.0, self.bulk()], self.slope())
    }

    fn at(&self, at: Invariants) -> logarithmic::Pair {
        let strain = LogStrain::of_invariants(at);
        logarithmic::at(&strain, [0.0, self.bulk()], self.slope())
    }
}

impl Hyperelastic for Hencky {
    fn name(&self) -> &'static str {
        "Hencky"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::Hencky(*self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        Volumetric::logarithmic(self.bulk())
    }

    fn energy_density(&self, at: Invariants) -> f64 {
        let strain = LogStrain::of_invariants(at);
        let volume = 0.5 * self.bulk() * strain.sum * strain.sum;
        volume + self.constants.mu() * strain.deviator(0.0)
    }

    fn gradient(&self, at: Invariants) -> [f64; 2] {
        self.at(at).pair
    }

    fn hessian(&self, at: Invariants) -> [f64; 3] {
        self.at(at).slopes
    }

    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        self.between(from, to).pair
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        self.between(from, to).slopes.map(|slope| 2.0 * slope)
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::{conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [-0.4, 0.0, 0.3, 0.49] {
            let law = Hencky::plane_strain(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
        }
    }

    /// `P_i λ_i = 2 μ ε_i + λ tr ε` in plane strain.
    #[test]
    fn stress_is_linear_in_the_logarithms_of_the_stretches() {
        let law = Hencky::plane_strain(1e6, 0.3);
        let (lambda, mu) = (law.constants.lambda(), law.constants.mu());
        for stretches in [[1.5, 0.7], [0.3, 0.4], [3.0, 1.0], [1.001, 0.999]] {
            let found = principal_stress(&law, stretches);
            let sum = stretches[0].ln() + stretches[1].ln();
            for (stretch, found) in stretches.iter().zip(found) {
                let exact = (2.0 * mu * stretch.ln() + lambda * sum) / stretch;
                assert!((found - exact).abs() < 1e-14 * 1e7, "{found} for {exact}");
            }
        }
    }
}
