//! The constants of isotropic elasticity: `λ = E ν / ((1 + ν)(1 - 2 ν))`, `μ = E / (2 (1 + ν))`.

use crate::fe::material::{LinearElastic, Material, MaterialError, Plane};

/// Young's modulus and Poisson's ratio, with Lamé's constants computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ElasticConstants {
    young: f64,
    poisson: f64,
    lambda: f64,
    mu: f64,
}

impl ElasticConstants {
    /// The constants of Young's modulus `young` (Pa) and Poisson's ratio `poisson` (-).
    pub fn new(young: f64, poisson: f64) -> Self {
        Self {
            young,
            poisson,
            lambda: young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            mu: 0.5 * young / (1.0 + poisson),
        }
    }

    /// The constants with which a slice of a long body has the moduli in the plane that `material` has: its own in plane strain, and in plane stress
    /// `E (1 + 2 ν)/(1 + ν)²` and `ν/(1 + ν)`.
    pub fn in_plane(material: &LinearElastic) -> Self {
        let (young, poisson) = (material.young(), material.poisson());
        match material.plane() {
            Plane::Strain => Self::new(young, poisson),
            Plane::Stress => {
                let sum = 1.0 + poisson;
                Self::new(young * (1.0 + 2.0 * poisson) / (sum * sum), poisson / sum)
            }
        }
    }

    /// Young's modulus (Pa).
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio (-).
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Lamé's first constant `λ` (Pa).
    pub fn lambda(&self) -> f64 {
        self.lambda
    }

    /// Lamé's second constant `μ`, the shear modulus (Pa).
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// The linear law with these constants in plane strain, of a density (kg/m^3).
    pub fn linear(&self, density: f64) -> LinearElastic {
        LinearElastic::plane_strain(self.young, self.poisson).density(density)
    }

    /// Whether Young's modulus is positive and Poisson's ratio between -1 and 0.5.
    ///
    /// # Errors
    /// [`MaterialError::Young`] or [`MaterialError::PoissonPlaneStrain`] with the value.
    pub fn validate(&self) -> Result<(), MaterialError> {
        self.linear(1.0).validate()
    }
}
