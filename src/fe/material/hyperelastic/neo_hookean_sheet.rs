//! The logarithmic neo-Hookean law in plane stress: `W = min over z of μ/2 (t + z² - 3) - μ ln Jz + λ/2 ln² Jz`, `z` the stretch of the
//! thickness.

use super::quotient::{rise_of_slope_of_ln, slope_of_ln};
use super::{ElasticConstants, Hyperelastic, Invariants};
use crate::fe::material::{LinearElastic, MaterialError, Plane};
use crate::fe::record::LawRecord;
use crate::math::{exp, ln};

/// A thin sheet of [`NeoHookean`](super::NeoHookean) material, which is free to change its thickness; that of rubber may keep its volume
/// (`ν = 0.5`). For `J > 0` only, as that law, and for Poisson's ratios from 0 on.
///
/// The energy is least where `σ_zz = 0`. With `s = z²` that is, divided by `λ + μ`,
///
/// ```text
/// d (s - 1) + ν (2 ln J + ln s) = 0,    d = 1 - 2 ν
/// ```
///
/// one equation for `s(J)`, increasing and convex in `ln s`: Newton's method falls towards its root from above, and ends where it falls no
/// more. The energy is `μ/2 (t - 2) + g(J)` with `g' = -μ s/J`, as the thickness does no work where it is free.
///
/// As `ln J` and `g` are both simple functions of `s`, the slope of `g` between two states is a quotient of slopes by `s`, none of which vanishes:
///
/// ```text
/// Δg/ΔJ = -μ/2 (2 ν + d (s + s')) / (d + ν Δln s/Δs) · Δln J/ΔJ
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct NeoHookeanSheet {
    young: f64,
    poisson: f64,
    mu: f64,
    /// Those of plane strain with the same moduli in the plane.
    constants: ElasticConstants,
}

impl NeoHookeanSheet {
    /// A thin sheet with Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-) at rest, those of three dimensions.
    pub fn plane_stress(young: f64, poisson: f64) -> Self {
        let sheet = LinearElastic::plane_stress(young, poisson);
        Self {
            young,
            poisson,
            mu: 0.5 * young / (1.0 + poisson),
            constants: ElasticConstants::in_plane(&sheet),
        }
    }

    /// `1 - 2 ν`.
    fn compressibility(&self) -> f64 {
        1.0 - 2.0 * self.poisson
    }

    /// The squared stretch of the thickness where the area is stretched to `J`.
    fn squared_thickness(&self, j: f64) -> f64 {
        let (d, nu) = (self.compressibility(), self.poisson);
        let area = 2.0 * nu * ln(j);
        // `exp u - 1` is at least `u`, and for `u > 0` the logarithm is not negative: two bounds from above.
        let mut u = -area / (1.0 - nu);
        if area < 0.0 && d > 0.0 {
            u = u.min(ln(1.0 - area / d));
        }
        let mut squared = exp(u);
        if d <= 0.0 {
            return squared;
        }
        let next = |u: f64, squared: f64| {
            let residual = d * (squared - 1.0) + area + nu * u;
            u - residual / (d * squared + nu)
        };
        let mut fallen = next(u, squared);
        // What is not a number falls no more, either.
        while fallen < u {
            (u, squared) = (fallen, exp(fallen));
            fallen = next(u, squared);
        }
        squared
    }

    /// `-d ln z / d ln J`.
    fn thinning(&self, squared: f64) -> f64 {
        self.poisson / (self.compressibility() * squared + self.poisson)
    }
}

impl Hyperelastic for NeoHookeanSheet {
    fn name(&self) -> &'static str {
        "neo-Hookean sheet"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::NeoHookeanSheet(*self)
    }

    fn plane(&self) -> Plane {
        Plane::Stress
    }

    fn thickness_stretch(&self, at: Invariants) -> f64 {
        self.squared_thickness(at.j).sqrt()
    }

    /// `g = μ/2 [(s - 1) - ln Jz (s + 1)]`.
    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        let squared = self.squared_thickness(j);
        let volume = ln(j) + 0.5 * ln(squared);
        0.5 * self.mu * (t - 2.0 + (squared - 1.0) - volume * (squared + 1.0))
    }

    fn gradient(&self, Invariants { j, .. }: Invariants) -> [f64; 2] {
        [0.5 * self.mu, -self.mu * self.squared_thickness(j) / j]
    }

    fn hessian(&self, Invariants { j, .. }: Invariants) -> [f64; 3] {
        let squared = self.squared_thickness(j);
        let along_j = self.mu * squared / (j * j) * (1.0 + 2.0 * self.thinning(squared));
        [0.0, 0.0, along_j]
    }

    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let [start, end] = [from, to].map(|at| self.squared_thickness(at.j));
        let (d, nu) = (self.compressibility(), self.poisson);
        let above = 2.0 * nu + d * (start + end);
        let below = d + nu * slope_of_ln(start, end);
        let slope = slope_of_ln(from.j, to.j);
        [0.5 * self.mu, -0.5 * self.mu * above / below * slope]
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let [start, end] = [from, to].map(|at| self.squared_thickness(at.j));
        let (d, nu) = (self.compressibility(), self.poisson);
        let above = 2.0 * nu + d * (start + end);
        let below = d + nu * slope_of_ln(start, end);
        // How the squared thickness of the end changes, and with it both.
        let change = -2.0 * self.thinning(end) * end / to.j;
        let [above_rise, below_rise] = [d, nu * rise_of_slope_of_ln(start, end)];
        let ratio = above / below;
        let ratio_rise = (above_rise - ratio * below_rise) / below * change;
        let [slope, rise] = [slope_of_ln, rise_of_slope_of_ln].map(|of| of(from.j, to.j));
        [0.0, 0.0, -self.mu * (ratio_rise * slope + ratio * rise)]
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }

    fn out_of_plane_stress(&self, _: Invariants) -> f64 {
        0.0
    }

    fn validate(&self) -> Result<(), MaterialError> {
        let sheet = LinearElastic::plane_stress(self.young, self.poisson);
        crate::fe::material::Material::validate(&sheet.density(1.0))?;
        // Below zero the volumetric energy of the thickness has no bound.
        if self.poisson < 0.0 {
            return Err(MaterialError::Parameter {
                name: "Poisson's ratio of a neo-Hookean sheet",
                value: self.poisson,
                cure: "give one from 0 to 0.5",
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
    fn the_law_conforms_over_the_range_of_poisson_ratios() {
        for nu in [0.0, 1e-6, 0.1, 0.3, 0.49, 0.4999999, 0.5] {
            let law = NeoHookeanSheet::plane_stress(1e6, nu);
            assert_eq!(check_law(&law), Ok(()), "{nu}");
            assert_eq!(law.validate(), Ok(()), "{nu}");
        }
        for nu in [-0.1, 0.51, f64::NAN] {
            assert!(NeoHookeanSheet::plane_stress(1e6, nu).validate().is_err());
        }
    }

    /// Source: benchmark B45, E = 1, ν = .3, the nominal stress of a pull with free sides: one stretch across for the side and the
    /// thickness.
    #[test]
    fn uniaxial_stress_has_the_digits_of_the_closed_solution() {
        let law = NeoHookeanSheet::plane_stress(1.0, 0.3);
        let known = [
            (0.5, -0.9353520569),
            (0.7, -0.4052304243),
            (1.3, 0.2484958826),
            (2.0, 0.6467446602),
        ];
        for (stretch, expected) in known {
            let [mut low, mut high] = [0.5, 1.5];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let is_pulled = principal_stress(&law, [stretch, middle])[1] > 0.0;
                *(if is_pulled { &mut high } else { &mut low }) = middle;
            }
            let [stress, _] = principal_stress(&law, [stretch, low]);
            assert!(
                (stress / expected - 1.0).abs() < 1e-9,
                "{stretch}: {stress}"
            );
            let at = Invariants::of([stretch, 0.0, 0.0, low]);
            assert!((law.thickness_stretch(at) - low).abs() < 1e-14, "{stretch}");
            if stretch == 0.5 {
                assert!((low - 1.210767391).abs() < 1e-9, "{low}");
            }
        }
    }

    /// What stands for the sheet is the least of the energy in space over all thicknesses, and what keeps its volume has the thickness 1/J.
    #[test]
    fn the_thickness_is_that_of_the_least_energy() {
        let (young, nu) = (3.0, 0.35);
        let law = NeoHookeanSheet::plane_stress(young, nu);
        let solid = ElasticConstants::new(young, nu);
        let (lambda, mu) = (solid.lambda(), solid.mu());
        for (t, j) in [
            (2.0, 1.0),
            (5.0, 0.02),
            (8.0, 3.5),
            (60.0, 20.0),
            (1.0, 1e-9),
        ] {
            let energy = |z: f64| {
                let volume = ln(j * z);
                0.5 * mu * (t + z * z - 3.0) - mu * volume + 0.5 * lambda * volume * volume
            };
            let at = Invariants { t, j };
            let z = law.thickness_stretch(at);
            let size = energy(z).abs() + mu;
            assert!(
                (law.energy_density(at) - energy(z)).abs() < 1e-13 * size,
                "{j}"
            );
            for other in [0.999 * z, 1.001 * z] {
                assert!(energy(other) > energy(z), "{j}");
            }
            let rubber = NeoHookeanSheet::plane_stress(young, 0.5);
            assert!(
                (rubber.thickness_stretch(at) * j - 1.0).abs() < 1e-13,
                "{j}"
            );
        }
        // In plane strain, of the same moduli in the plane, it is another law but at rest.
        let slice = NeoHookean::at_rest(&LinearElastic::plane_stress(young, nu));
        let far = Invariants { t: 5.0, j: 2.0 };
        let [sheet, slice] = [law.gradient(far)[1], slice.gradient(far)[1]];
        assert!((sheet / slice - 1.0).abs() > 0.1);
    }
}
