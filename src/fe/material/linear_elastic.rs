//! Isotropic linear elasticity: `sigma = D eps`, `W = eps . D eps / 2`.

use super::hyperelastic::{Hyperelastic, NeoHookean};
use super::{Material, MaterialError, Rayleigh};
use crate::fe::record::MaterialRecord;
use std::sync::Arc;

/// What happens in the direction normal to the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Plane {
    /// A thin sheet, free to change its thickness: `s_zz = 0`.
    Stress,
    /// A slice of a long body, held between two walls: `e_zz = 0`.
    Strain,
}

/// Hooke's law for an isotropic material.
///
/// The density has no default: [`Material::validate`] refuses a material whose density was never set.
/// The setters `density` and `rayleigh` share their names with the getters of [`Material`]; on a value of
/// this type write `Material::density(&steel)` to read.
///
/// ```
/// use foil2d::fe::material::{LinearElastic, Material};
///
/// let steel = LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0).rayleigh(1e-5);
/// assert!(steel.validate().is_ok());
/// assert_eq!(Material::density(&steel), 7800.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct LinearElastic {
    plane: Plane,
    young: f64,
    poisson: f64,
    density: f64,
    rayleigh: Rayleigh,
}

impl LinearElastic {
    /// A thin sheet of Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-).
    pub fn plane_stress(young: f64, poisson: f64) -> Self {
        Self::new(Plane::Stress, young, poisson)
    }

    /// A slice of a long body, of Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-).
    pub fn plane_strain(young: f64, poisson: f64) -> Self {
        Self::new(Plane::Strain, young, poisson)
    }

    fn new(plane: Plane, young: f64, poisson: f64) -> Self {
        Self {
            plane,
            young,
            poisson,
            density: 0.0,
            rayleigh: Rayleigh::NONE,
        }
    }

    /// Sets the density (kg/m^3).
    pub fn density(mut self, density: f64) -> Self {
        self.density = density;
        self
    }

    /// Sets the stiffness part beta (s) of Rayleigh damping.
    pub fn rayleigh(mut self, stiffness_part: f64) -> Self {
        self.rayleigh.stiffness = stiffness_part;
        self
    }

    /// Sets the mass part alpha (1/s) of Rayleigh damping, which drags rigid motion too.
    pub fn rayleigh_mass(mut self, mass_part: f64) -> Self {
        self.rayleigh.mass = mass_part;
        self
    }

    /// Sets both parts of Rayleigh damping, such as those of [`Rayleigh::from_ratios`].
    pub fn damping(mut self, rayleigh: Rayleigh) -> Self {
        self.rayleigh = rayleigh;
        self
    }

    /// Young's modulus (Pa).
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio (-).
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Whether this is plane stress or plane strain.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// The three distinct entries `(D_xxxx, D_xxyy, D_xyxy)` (Pa) of Hooke's law in the plane.
    fn moduli(&self) -> (f64, f64, f64) {
        let (young, nu) = (self.young, self.poisson);
        let shear = young / (2.0 * (1.0 + nu));
        let (normal, cross) = match self.plane {
            Plane::Stress => (young / (1.0 - nu * nu), young * nu / (1.0 - nu * nu)),
            Plane::Strain => {
                let scale = young / ((1.0 + nu) * (1.0 - 2.0 * nu));
                (scale * (1.0 - nu), scale * nu)
            }
        };
        (normal, cross, shear)
    }
}

impl Material for LinearElastic {
    /// The neo-Hookean law that is this one at rest. In plane stress there is none for Poisson's ratios from -0.5 down: a solid with these moduli in the plane
    /// would not be stable out of it.
    fn large_law(&self) -> Option<Arc<dyn Hyperelastic>> {
        let law = NeoHookean::at_rest(self);
        law.validate().is_ok().then(|| Arc::new(law) as _)
    }

    fn record(&self) -> MaterialRecord {
        MaterialRecord::LinearElastic(*self)
    }

    fn density(&self) -> f64 {
        self.density
    }

    fn stress(&self, strain: [f64; 3]) -> [f64; 3] {
        let (normal, cross, shear) = self.moduli();
        [
            normal * strain[0] + cross * strain[1],
            cross * strain[0] + normal * strain[1],
            shear * strain[2],
        ]
    }

    fn tangent(&self, _strain: [f64; 3]) -> [[f64; 3]; 3] {
        let (normal, cross, shear) = self.moduli();
        [
            [normal, cross, 0.0],
            [cross, normal, 0.0],
            [0.0, 0.0, shear],
        ]
    }

    fn energy_density(&self, strain: [f64; 3]) -> f64 {
        let stress = self.stress(strain);
        0.5 * (stress[0] * strain[0] + stress[1] * strain[1] + stress[2] * strain[2])
    }

    fn out_of_plane_stress(&self, strain: [f64; 3]) -> f64 {
        match self.plane {
            Plane::Stress => 0.0,
            Plane::Strain => {
                let (_, cross, _) = self.moduli();
                cross * (strain[0] + strain[1])
            }
        }
    }

    /// `-ν/(1 - ν) (e_xx + e_yy)` in plane stress.
    fn thickness_strain(&self, strain: [f64; 3]) -> f64 {
        match self.plane {
            Plane::Stress => -self.poisson / (1.0 - self.poisson) * (strain[0] + strain[1]),
            Plane::Strain => 0.0,
        }
    }

    fn wave_speed(&self) -> f64 {
        let (normal, _, shear) = self.moduli();
        // Auxetic materials (nu < -1/3 or so) carry shear faster than pressure.
        (normal.max(shear) / self.density).sqrt()
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn rayleigh(&self) -> Rayleigh {
        self.rayleigh
    }

    fn validate(&self) -> Result<(), MaterialError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let damping = |value: f64| value >= 0.0 && value.is_finite();
        let nu = self.poisson;
        if !positive(self.young) {
            return Err(MaterialError::Young { value: self.young });
        }
        // Written as "not inside" so that NaN is refused.
        match self.plane {
            Plane::Stress if !(nu > -1.0 && nu <= 0.5) => {
                return Err(MaterialError::PoissonPlaneStress { value: nu });
            }
            Plane::Strain if !(nu > -1.0 && nu < 0.5) => {
                return Err(MaterialError::PoissonPlaneStrain { value: nu });
            }
            _ => {}
        }
        if !positive(self.density) {
            return Err(MaterialError::Density {
                value: self.density,
            });
        }
        if !damping(self.rayleigh.mass) {
            return Err(MaterialError::DampingMass {
                value: self.rayleigh.mass,
            });
        }
        if !damping(self.rayleigh.stiffness) {
            return Err(MaterialError::DampingStiffness {
                value: self.rayleigh.stiffness,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fe::material::conformance::check_material;

    #[test]
    fn hooke_derives_from_an_energy_over_the_whole_range_of_poisson_ratios() {
        for nu in [-0.9, -0.4, 0.0, 0.3, 0.49] {
            let sheet = LinearElastic::plane_stress(2.1e11, nu).density(7800.0);
            let slice = LinearElastic::plane_strain(1e6, nu).density(1000.0);
            assert_eq!(check_material(&sheet, 1e-3), Ok(()), "plane stress {nu}");
            assert_eq!(check_material(&slice, 1e-2), Ok(()), "plane strain {nu}");
        }
        let rubber = LinearElastic::plane_stress(1e6, 0.5).density(1000.0);
        assert_eq!(check_material(&rubber, 1e-2), Ok(()));
    }

    #[test]
    fn uniaxial_stress_gives_youngs_modulus() {
        // e = [1, -nu, 0] s/E is the strain of s_xx = s alone in a thin sheet.
        let sheet = LinearElastic::plane_stress(200.0, 0.25).density(1.0);
        let stress = sheet.stress([0.01, -0.0025, 0.0]);
        assert!((stress[0] - 2.0).abs() < 1e-14 && stress[1].abs() < 1e-14);
        assert_eq!(sheet.out_of_plane_stress([0.01, -0.0025, 0.0]), 0.0);
    }

    #[test]
    fn plane_strain_obeys_the_three_dimensional_law() {
        // Source: e_zz = (s_zz - nu (s_xx + s_yy)) / E = 0 and e_xx = (s_xx - nu (s_yy + s_zz)) / E.
        let (young, nu, strain) = (70.0, 0.3, [0.02, -0.01, 0.005]);
        let slice = LinearElastic::plane_strain(young, nu).density(1.0);
        let s = slice.stress(strain);
        let zz = slice.out_of_plane_stress(strain);
        assert!((zz - nu * (s[0] + s[1])).abs() < 1e-14);
        assert!(((s[0] - nu * (s[1] + zz)) / young - strain[0]).abs() < 1e-16);
        assert!(((s[1] - nu * (s[0] + zz)) / young - strain[1]).abs() < 1e-16);
        assert!((s[2] * 2.0 * (1.0 + nu) / young - strain[2]).abs() < 1e-16);
    }

    #[test]
    fn the_wave_speed_is_that_of_a_guided_pressure_wave() {
        // nu = 0: c = sqrt(E / rho), the impacting bar of benchmark B1 (E = 900, rho = 1, c = 30).
        let bar = LinearElastic::plane_stress(900.0, 0.0).density(1.0);
        assert!((bar.wave_speed() - 30.0).abs() < 1e-12);
    }

    #[test]
    fn every_parameter_out_of_range_is_refused_with_its_value() {
        use MaterialError::*;
        let good = LinearElastic::plane_strain(1e6, 0.3).density(1000.0);
        assert_eq!(good.validate(), Ok(()));
        let rubber = LinearElastic::plane_stress(1e6, 0.5).density(1.0);
        assert_eq!(rubber.validate(), Ok(()));
        for value in [0.0, -1.0, f64::INFINITY] {
            let poor = LinearElastic::plane_stress(value, 0.3).density(1.0);
            assert_eq!(poor.validate(), Err(Young { value }));
            assert_eq!(good.density(value).validate(), Err(Density { value }));
        }
        for value in [-1.0, 0.51] {
            let poor = LinearElastic::plane_stress(1.0, value).density(1.0);
            assert_eq!(poor.validate(), Err(PoissonPlaneStress { value }));
        }
        for value in [-1.0, 0.5] {
            let poor = LinearElastic::plane_strain(1.0, value).density(1.0);
            assert_eq!(poor.validate(), Err(PoissonPlaneStrain { value }));
        }
        let value = -1e-3;
        let poor = good.rayleigh(value).validate();
        assert_eq!(poor, Err(DampingStiffness { value }));
        let poor = good.rayleigh_mass(value).validate();
        assert_eq!(poor, Err(DampingMass { value }));
        assert!(good.density(f64::NAN).validate().is_err());
        let nan = LinearElastic::plane_stress(1.0, f64::NAN).density(1.0);
        assert!(nan.validate().is_err());
    }

    /// With the moduli of plane stress in the plane, Poisson's ratio of a solid is nu/(1 + nu): below -1 from nu = -0.5 on.
    #[test]
    fn what_is_unstable_out_of_its_plane_has_no_law_for_large_strains() {
        let law = |nu: f64| {
            LinearElastic::plane_stress(1.0, nu)
                .density(1.0)
                .large_law()
        };
        assert!(law(-0.49).is_some() && law(0.5).is_some());
        assert!(law(-0.51).is_none() && law(-0.99).is_none());
        let strain = LinearElastic::plane_strain(1.0, -0.99).density(1.0);
        assert!(strain.large_law().is_some());
    }

    #[test]
    fn a_forgotten_density_is_an_error_that_names_the_cure() {
        let message = match LinearElastic::plane_stress(1e6, 0.3).validate() {
            Err(error) => error.to_string(),
            Ok(()) => String::new(),
        };
        assert!(message.contains(".density(rho)"), "{message}");
    }
}
