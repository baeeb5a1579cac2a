//! Mooney and Rivlin's law for rubber: `W = C1 (I1 - 3) + C2 (I2 - 3)` and a volumetric part, as a slice and as a sheet.

use super::quotient::{rise_of_slope_of_ln, slope_of_ln};
use super::{ElasticConstants, Hyperelastic, Invariants, Volumetric};
use crate::fe::material::{MaterialError, Plane};
use crate::fe::record::LawRecord;
use crate::math::ln;

/// `W = C1 (I1 - 3) + C2 (I2 - 3) - (2 C1 + 4 C2) ln J + λ/2 ln² J` in plane strain, for `J > 0` only.
///
/// There `I1 = t + 1` and `I2 = t + J²`. Rest is free of stress, with the shear modulus `2 (C1 + C2)` and Lamé's first constant
/// `λ + 4 C2`. With `C2 = 0` it is [`NeoHookean`](super::NeoHookean).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct MooneyRivlin {
    first: f64,
    second: f64,
    constants: ElasticConstants,
}

impl MooneyRivlin {
    /// The law in plane strain with the constants `C1` and `C2` (Pa), and with Poisson's ratio `poisson` (-) at rest.
    pub fn plane_strain(first: f64, second: f64, poisson: f64) -> Self {
        Self {
            first,
            second,
            constants: constants_of(first, second, poisson),
        }
    }

    /// `λ` of the volumetric part (Pa).
    fn volume_modulus(&self) -> f64 {
        self.constants.lambda() - 4.0 * self.second
    }

    /// `2 C1 + 4 C2`.
    fn tension(&self) -> f64 {
        2.0 * self.first + 4.0 * self.second
    }
}

fn constants_of(first: f64, second: f64, poisson: f64) -> ElasticConstants {
    ElasticConstants::new(4.0 * (first + second) * (1.0 + poisson), poisson)
}

/// Refuses constants of which one is negative: the law then has no least energy for some stretches.
fn check_constants(first: f64, second: f64) -> Result<(), MaterialError> {
    let named = [
        ("C1 of the Mooney-Rivlin law", first),
        ("C2 of the Mooney-Rivlin law", second),
    ];
    match named
        .into_iter()
        .find(|(_, value)| !(*value >= 0.0 && value.is_finite()))
    {
        Some((name, value)) => Err(MaterialError::Parameter {
            name,
            value,
            cure: "give zero or a positive finite value in Pa",
        }),
        None => Ok(()),
    }
}

impl Hyperelastic for MooneyRivlin {
    fn name(&self) -> &'static str {
        "Mooney-Rivlin"
    }

    fn constants(&self) -> ElasticConstants {
        self.constants
    }

    fn record(&self) -> LawRecord {
        LawRecord::MooneyRivlin(*self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        Volumetric::logarithmic(self.volume_modulus())
    }

    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        let log = ln(j);
        (self.first + self.second) * (t - 2.0) + self.second * (j - 1.0) * (j + 1.0)
            - self.tension() * log
            + 0.5 * self.volume_modulus() * log * log
    }

    fn gradient(&self, Invariants { j, .. }: Invariants) -> [f64; 2] {
        let log = (self.volume_modulus() * ln(j) - self.tension()) / j;
        [self.first + self.second, 2.0 * self.second * j + log]
    }

    fn hessian(&self, Invariants { j, .. }: Invariants) -> [f64; 3] {
        let log = self.tension() + self.volume_modulus() * (1.0 - ln(j));
        [0.0, 0.0, 2.0 * self.second + log / (j * j)]
    }

    /// `b = C2 (J + J') + (Δ ln J/ΔJ) (λ/2 ln JJ' - 2 C1 - 4 C2)`.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let log = 0.5 * self.volume_modulus() * ln(from.j * to.j) - self.tension();
        let slope = slope_of_ln(from.j, to.j);
        [
            self.first + self.second,
            self.second * (from.j + to.j) + slope * log,
        ]
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let [slope, rise] = [slope_of_ln, rise_of_slope_of_ln].map(|of| of(from.j, to.j));
        let log = 0.5 * self.volume_modulus() * ln(from.j * to.j) - self.tension();
        let along_j = self.second + rise * log + 0.5 * slope * self.volume_modulus() / to.j;
        [0.0, 0.0, 2.0 * along_j]
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }

    /// `[2 C1 + 2 C2 t - (2 C1 + 4 C2) + λ ln J]/J`, the derivative by the third stretch where it is one.
    fn out_of_plane_stress(&self, Invariants { t, j }: Invariants) -> f64 {
        (2.0 * self.second * (t - 2.0) + self.volume_modulus() * ln(j)) / j
    }

    fn validate(&self) -> Result<(), MaterialError> {
        check_constants(self.first, self.second)?;
        self.constants.validate()?;
        let value = self.constants.poisson();
        if self.volume_modulus() < 0.0 {
            return Err(MaterialError::Parameter {
                name: "Poisson's ratio of the Mooney-Rivlin law",
                value,
                cure: "give a larger one, as its volumetric part is negative here: 0.4 suits all C1 and C2",
            });
        }
        Ok(())
    }
}

/// A thin sheet of Mooney–Rivlin rubber that keeps its volume: `W = C1 (t + 1/J² - 3) + C2 (t/J² + J² - 3)`, for `J > 0` only.
///
/// The thickness is `1/J` of its own, and no pressure is needed to keep it. With the means of `t` and `h = 1/J²` over a step,
/// `Δ(t h) = h̄ Δt + t̄ Δh` exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct MooneyRivlinSheet {
    first: f64,
    second: f64,
}

impl MooneyRivlinSheet {
    /// The sheet with the constants `C1` and `C2` (Pa): at rest Young's modulus is `6 (C1 + C2)`.
    pub fn plane_stress(first: f64, second: f64) -> Self {
        Self { first, second }
    }
}

impl Hyperelastic for MooneyRivlinSheet {
    fn name(&self) -> &'static str {
        "Mooney-Rivlin sheet"
    }

    /// Those of plane strain with the same moduli in the plane.
    fn constants(&self) -> ElasticConstants {
        constants_of(self.first, self.second, 1.0 / 3.0)
    }

    fn record(&self) -> LawRecord {
        LawRecord::MooneyRivlinSheet(*self)
    }

    fn plane(&self) -> Plane {
        Plane::Stress
    }

    fn thickness_stretch(&self, at: Invariants) -> f64 {
        1.0 / at.j
    }

    fn energy_density(&self, Invariants { t, j }: Invariants) -> f64 {
        let h = 1.0 / (j * j);
        let (second, area) = (t - 2.0 + (h - 1.0), (j - 1.0) * (j + 1.0));
        self.first * second + self.second * ((t - 2.0) * h + 2.0 * (h - 1.0) + area)
    }

    fn gradient(&self, Invariants { t, j }: Invariants) -> [f64; 2] {
        let h = 1.0 / (j * j);
        let along_h = self.first + self.second * t;
        [
            self.first + self.second * h,
            2.0 * self.second * j - 2.0 * along_h * h / j,
        ]
    }

    fn hessian(&self, Invariants { t, j }: Invariants) -> [f64; 3] {
        let h = 1.0 / (j * j);
        let along_h = self.first + self.second * t;
        [
            0.0,
            -2.0 * self.second * h / j,
            2.0 * self.second + 6.0 * along_h * h * h,
        ]
    }

    /// `a = C1 + C2 h̄`, `b = C2 (J + J') + (C1 + C2 t̄) Δh/ΔJ`, `Δh/ΔJ = -(J + J')/(J J')²`.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        let (sum, product) = (from.j + to.j, from.j * to.j);
        let mean = 0.5 * (1.0 / (from.j * from.j) + 1.0 / (to.j * to.j));
        let along_h = self.first + 0.5 * self.second * (from.t + to.t);
        [
            self.first + self.second * mean,
            self.second * sum - along_h * sum / (product * product),
        ]
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        let (sum, product) = (from.j + to.j, from.j * to.j);
        let squared = product * product;
        let along_h = self.first + 0.5 * self.second * (from.t + to.t);
        // `∂(sum/product²)/∂J' = (1 - 2 sum/J')/product²`.
        let bend = (1.0 - 2.0 * sum / to.j) / squared;
        let a_by_j = -self.second / (to.j * to.j * to.j);
        let b_by_t = -0.5 * self.second * sum / squared;
        [0.0, a_by_j + b_by_t, 2.0 * (self.second - along_h * bend)]
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }

    fn out_of_plane_stress(&self, _: Invariants) -> f64 {
        0.0
    }

    fn validate(&self) -> Result<(), MaterialError> {
        check_constants(self.first, self.second)?;
        self.constants().validate()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{NeoHookean, NeoHookeanSheet, conformance::check_law, principal_stress};
    use super::*;

    #[test]
    fn slices_and_sheets_conform() {
        for (first, second) in [(1e5, 0.0), (1e5, 2e4), (1e5, 1e5), (0.0, 1e5)] {
            for nu in [0.4, 0.49, 0.4999] {
                let law = MooneyRivlin::plane_strain(first, second, nu);
                assert_eq!(check_law(&law), Ok(()), "{first} {second} {nu}");
                assert_eq!(law.validate(), Ok(()));
            }
            let law = MooneyRivlinSheet::plane_stress(first, second);
            assert_eq!(check_law(&law), Ok(()), "{first} {second}");
            assert_eq!(law.validate(), Ok(()));
        }
    }

    /// Source: Treloar, The Physics of Rubber Elasticity: `P = 2 (λ - 1/λ²) (C1 + C2/λ)` pulled along one axis,
    /// `P = 2 (λ - 1/λ⁵) (C1 + C2 λ²)` along both.
    #[test]
    fn a_sheet_has_the_stresses_of_rubber_that_keeps_its_volume() {
        let (first, second) = (3.0, 0.5);
        let law = MooneyRivlinSheet::plane_stress(first, second);
        for stretch in [0.6f64, 1.2, 3.0] {
            let side = 1.0 / stretch.sqrt();
            let [pull, across] = principal_stress(&law, [stretch, side]);
            let exact = 2.0 * (stretch - 1.0 / stretch.powi(2)) * (first + second / stretch);
            assert!(
                (pull - exact).abs() < 1e-13 * (exact.abs() + 1.0),
                "{stretch}"
            );
            assert!(across.abs() < 1e-12, "{stretch}: {across:e}");
            let pulls = principal_stress(&law, [stretch; 2]);
            let exact = 2.0 * (stretch - stretch.powi(-5)) * (first + second * stretch.powi(2));
            for pull in pulls {
                assert!((pull / exact - 1.0).abs() < 1e-13, "{stretch}");
            }
        }
    }

    /// The stress in the plane and that out of it are derivatives of one energy in space, by central differences over 1e-5.
    #[test]
    fn stresses_of_a_slice_are_those_of_the_law_in_space() {
        let (first, second) = (3.0, 0.5);
        let law = MooneyRivlin::plane_strain(first, second, 0.45);
        let energy = |stretches: [f64; 3]| {
            let [a, b, c] = stretches.map(|stretch| stretch * stretch);
            let (i1, i2) = (a + b + c, a * b + b * c + c * a);
            let log = 0.5 * ln(a * b * c);
            first * (i1 - 3.0) + second * (i2 - 3.0) - law.tension() * log
                + 0.5 * law.volume_modulus() * log * log
        };
        let stretches = [1.4, 0.8, 1.0];
        let slope = |axis: usize| {
            let [above, below] = [1e-5, -1e-5].map(|change| {
                let mut at = stretches;
                at[axis] += change;
                energy(at)
            });
            (above - below) / 2e-5
        };
        let found = principal_stress(&law, [stretches[0], stretches[1]]);
        let at = Invariants::of([stretches[0], 0.0, 0.0, stretches[1]]);
        for (axis, found) in found.into_iter().enumerate() {
            assert!((found - slope(axis)).abs() < 1e-7, "{axis}");
        }
        assert!((law.out_of_plane_stress(at) * at.j - slope(2)).abs() < 1e-7);
    }

    #[test]
    fn without_the_second_constant_they_are_the_neo_hookean_laws() {
        let at = Invariants { t: 3.0, j: 1.3 };
        let (one, other) = (
            MooneyRivlin::plane_strain(2.0, 0.0, 0.45),
            NeoHookean::plane_strain(8.0 * 1.45, 0.45),
        );
        assert!((one.energy_density(at) / other.energy_density(at) - 1.0).abs() < 1e-13);
        let (one, other) = (
            MooneyRivlinSheet::plane_stress(2.0, 0.0),
            NeoHookeanSheet::plane_stress(12.0, 0.5),
        );
        assert!((one.energy_density(at) / other.energy_density(at) - 1.0).abs() < 1e-13);
    }

    #[test]
    fn constants_out_of_their_range_are_refused_by_name() {
        let refused =
            |law: &dyn Hyperelastic| law.validate().expect_err("out of range").to_string();
        assert!(refused(&MooneyRivlin::plane_strain(-1.0, 2.0, 0.4)).contains("C1"));
        assert!(refused(&MooneyRivlinSheet::plane_stress(1.0, f64::NAN)).contains("C2"));
        assert!(refused(&MooneyRivlin::plane_strain(0.0, 1.0, 0.2)).contains("Poisson"));
        assert!(
            MooneyRivlinSheet::plane_stress(0.0, 0.0)
                .validate()
                .is_err()
        );
        assert!(
            MooneyRivlin::plane_strain(1.0, 0.0, 0.5)
                .validate()
                .is_err()
        );
    }
}
