//! St. Venant and Kirchhoff's law: Hooke's law for Green's strain, `W = λ/2 (tr E)² + μ |E|²`, `E = (FᵀF - I)/2`.

use super::{BesideRest, ElasticConstants, Hyperelastic, Invariants};
use crate::fe::record::LawRecord;

/// `W = λ/8 (t - 2)² + μ/4 (t² - 2 t + 2 - 2 J²)`: stress linear in Green's strain.
///
/// Under uniaxial compression it softens below a stretch of `1/√3` and needs no force at none; material turned inside out
/// stays so, since `J` and `-J` have the same energy.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct StVenantKirchhoff {
    constants: ElasticConstants,
}

impl StVenantKirchhoff {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        Self {
            constants: ElasticConstants::new(young, poisson),
        }
    }
}

impl Hyperelastic for StVenantKirchhoff {
    fn name(&self) -> &'static str {
        "St. Venant-Kirchhoff"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::StVenantKirchhoff(*self)
    }

    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        // t² - 2t + 2 - 2J² around rest, where its terms cancel.
        let (dt, dj) = (t - 2.0, j - 1.0);
        let shear = dt * (dt + 2.0) - 2.0 * dj * (dj + 2.0);
        0.125 * lambda * dt * dt + 0.25 * mu * shear
    }

    fn gradient(&self, at: Invariants) -> [f64; 2] {
        self.conserving_pair(at, at)
    }

    fn hessian(&self, _at: Invariants) -> [f64; 3] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        [0.25 * lambda + 0.5 * mu, 0.0, -mu]
    }

    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let Invariants { t, j } = from.mean(to);
        [0.25 * lambda * (t - 2.0) + 0.5 * mu * (t - 1.0), -mu * j]
    }

    /// With the means `T` of `t - 2` and `K` of `J - 1`: `λ/2 T + μ (T - K)` and `λ/2 T + μ (2 + T + K)`.
    fn conserving_sums(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 2] {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let (from, to) = (BesideRest::of(from), BesideRest::of(to));
        let (t, j) = (0.5 * (from.t() + to.t()), 0.5 * (from.j() + to.j()));
        let pressure = 0.5 * lambda * t;
        [pressure + mu * (t - j), pressure + mu * (2.0 + t + j)]
    }

    /// `W = λ/2 (g + s)² + μ ((g + s)² - (g - s)²/2 + 2 s)`.
    fn energy_of(&self, gradient: [f64; 4]) -> f64 {
        let (lambda, mu) = (self.constants.lambda(), self.constants.mu());
        let at = BesideRest::of(gradient);
        let (t, j) = (0.5 * at.t(), at.j());
        0.5 * lambda * t * t + mu * (t * t - 0.5 * j * j + 2.0 * at.shear)
    }

    fn conserving_hessian(&self, _from: Invariants, to: Invariants) -> [f64; 3] {
        self.hessian(to)
    }

    /// `λ tr E/|J|`.
    fn out_of_plane_stress(&self, Invariants { t, j }: Invariants) -> f64 {
        0.5 * self.constants.lambda() * (t - 2.0) / j.abs().max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [-0.4, 0.0, 0.3, 0.49] {
            let law = StVenantKirchhoff::plane_strain(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
        }
    }

    /// In one dimension `P = E λ (λ² - 1)/2`, least at `λ = 1/√3` with `-.1924500897 E`.
    #[test]
    fn a_bar_softens_below_one_over_the_root_of_three() {
        let law = StVenantKirchhoff::plane_strain(1.0, 0.0);
        let stress = |stretch: f64| principal_stress(&law, [stretch, 1.0])[0];
        let least = 1.0 / 3.0_f64.sqrt();
        assert!((stress(least) + 0.1924500897).abs() < 1e-10);
        assert!(stress(least) < stress(least - 0.01) && stress(least) < stress(least + 0.01));
    }
}
