//! The corotated law: Hooke's law for the strain `U - I` of the polar decomposition `F = R U`.

use super::{BesideRest, ElasticConstants, Hyperelastic, Invariants};
use crate::fe::record::LawRecord;

/// `W = μ |F - R|² + λ/2 (tr U - 2)²`, with `R` the rotation nearest to `F`.
///
/// In the plane `tr U = u = √(t + 2 J)`, and
///
/// ```text
/// W = μ t + λ/2 s - 2 (λ + μ) √s + const.,    s = t + 2 J
/// ```
///
/// so that neither a polar decomposition nor its derivative is needed. At `s = 0`, a mirror image, no rotation is the nearest and
/// the root has no slope. The root is rounded there, `√(s + ε²)` with ε = 1/100, and the two coefficients of `s` and its root are
/// those that leave stress and moduli at rest exactly Hooke's. Elsewhere that changes stresses by some `ε²/s` of themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Corotated {
    constants: ElasticConstants,
    /// What stands before `s` (Pa), about `λ/2`.
    linear: f64,
    /// Half of what stands before the root (Pa), about `λ + μ`.
    root: f64,
}

/// `ε²`: where `tr U` is below ε, of 2 at rest, the rotation depends on its rounding more than on the material.
const ROUNDING: f64 = 1e-4;
/// `s + ε²` at rest.
const AT_REST: f64 = 4.0 + ROUNDING;

impl Corotated {
    /// The law in plane strain with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        let constants = ElasticConstants::new(young, poisson);
        let (lambda, mu) = (constants.lambda(), constants.mu());
        // W_s = -μ/2 and W_ss = (λ + μ)/16 at rest.
        let root = (lambda + mu) * AT_REST * AT_REST.sqrt() / 8.0;
        Self {
            constants,
            linear: (lambda + mu) * AT_REST / 8.0 - 0.5 * mu,
            root,
        }
    }

    /// `√(s + ε²)`.
    fn root_of(Invariants { t, j }: Invariants) -> f64 {
        // s is a square, (F_xx + F_yy)² + (F_xy - F_yx)², that rounding may take below zero.
        ((t + 2.0 * j).max(0.0) + ROUNDING).sqrt()
    }

    /// The root, and by how much it is more than at rest: `s - 4` is four times the growth.
    fn risen(at: BesideRest) -> [f64; 2] {
        let (u, rest) = (
            ((4.0 + 4.0 * at.growth).max(0.0) + ROUNDING).sqrt(),
            AT_REST.sqrt(),
        );
        [u, 4.0 * at.growth / (u + rest)]
    }
}

impl Hyperelastic for Corotated {
    fn name(&self) -> &'static str {
        "corotated"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::Corotated(*self)
    }

    fn energy_density(&self, at: Invariants) -> f64 {
        let mu = self.constants.mu();
        let (u, rest) = (Self::root_of(at), AT_REST.sqrt());
        // linear (u² - rest²) - 2 root (u - rest) + μ (t - 2)
        mu * (at.t - 2.0) + (u - rest) * (self.linear * (u + rest) - 2.0 * self.root)
    }

    fn gradient(&self, at: Invariants) -> [f64; 2] {
        self.conserving_pair(at, at)
    }

    fn hessian(&self, at: Invariants) -> [f64; 3] {
        let u = Self::root_of(at);
        let along = 0.5 * self.root / (u * u * u);
        [along, 2.0 * along, 4.0 * along]
    }

    /// `p = linear - 2 root / (u + u')`, `a = μ + p`, `b = 2 p`.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let p = self.linear - 2.0 * self.root / (Self::root_of(from) + Self::root_of(to));
        [self.constants.mu() + p, 2.0 * p]
    }

    /// As `linear - root/rest = -μ/2`, `2 a + b = 2 μ + 4 p = 4 root (u + u' - 2 rest)/(rest (u + u'))`; `2 a - b = 2 μ`.
    fn conserving_sums(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 2] {
        let [[u, w], [end, risen]] = [from, to].map(|f| Self::risen(BesideRest::of(f)));
        let sum = 4.0 * self.root * (w + risen) / (AT_REST.sqrt() * (u + end));
        [sum, 2.0 * self.constants.mu()]
    }

    /// `W = 2 μ s + (linear + μ/2) w²`, with the risen root `w`.
    fn energy_of(&self, gradient: [f64; 4]) -> f64 {
        let mu = self.constants.mu();
        let at = BesideRest::of(gradient);
        let [_, risen] = Self::risen(at);
        2.0 * mu * at.shear + (self.linear + 0.5 * mu) * risen * risen
    }

    /// `∂p/∂s' = root / (u' (u + u')²)`.
    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let (u, end) = (Self::root_of(from), Self::root_of(to));
        let along = 2.0 * self.root / (end * (u + end) * (u + end));
        [along, 2.0 * along, 4.0 * along]
    }

    /// `λ (tr U - 2)/|J|`.
    fn out_of_plane_stress(&self, at: Invariants) -> f64 {
        let stretched = (at.t + 2.0 * at.j).max(0.0).sqrt() - 2.0;
        self.constants.lambda() * stretched / at.j.abs().max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [-0.4, 0.0, 0.3, 0.49] {
            let law = Corotated::plane_strain(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
        }
    }

    /// `P = 2 μ (σ - 1) + λ (σ1 + σ2 - 2)` along each principal stretch, but for the rounding of the root.
    #[test]
    fn stress_is_linear_in_the_principal_stretches() {
        let law = Corotated::plane_strain(1e6, 0.3);
        let (lambda, mu) = (law.constants.lambda(), law.constants.mu());
        for stretches in [[1.5, 0.7], [0.3, 0.4], [3.0, 1.0], [0.5, -0.2]] {
            let found = principal_stress(&law, stretches);
            let sum: f64 = stretches.iter().sum();
            for (stretch, found) in stretches.iter().zip(found) {
                let exact = 2.0 * mu * (stretch - 1.0) + lambda * (sum - 2.0);
                let allowed = (lambda + mu) * ROUNDING * (1.0 + 1.0 / (sum * sum));
                assert!((found - exact).abs() < allowed, "{found} for {exact}");
            }
        }
    }
}
