//! Constitutive laws in the plane: `sigma = dW/d eps`, `D = d sigma/d eps`.
//!
//! Strains are `[e_xx, e_yy, g_xy]` with engineering shear `g_xy = 2 e_xy` (-); stresses are
//! `[s_xx, s_yy, s_xy]` (Pa). With this pairing `W` is a plain function of three variables, its
//! gradient is the stress and its Hessian the tangent, which is what [`conformance`] checks.
//!
//! That is for small strains. Laws for large ones are in [`hyperelastic`].

pub mod conformance;
pub mod hyperelastic;
mod linear_elastic;
mod rayleigh;

pub use linear_elastic::{LinearElastic, Plane};
pub use rayleigh::{DampingError, Rayleigh};

use self::hyperelastic::Hyperelastic;
use super::record::MaterialRecord;
use std::fmt::Debug;
use std::sync::Arc;

/// A law from strain to stress, linear or not.
///
/// Implementers are tested by [`conformance::check_material`].
pub trait Material: Send + Sync + Debug {
    /// The density of the undeformed material (kg/m^3).
    fn density(&self) -> f64;

    /// The stress `[s_xx, s_yy, s_xy]` (Pa) at a strain `[e_xx, e_yy, g_xy]`.
    fn stress(&self, strain: [f64; 3]) -> [f64; 3];

    /// The tangent `D = d stress / d strain` (Pa), symmetric, row by row.
    fn tangent(&self, strain: [f64; 3]) -> [[f64; 3]; 3];

    /// The stored energy per unit volume `W` (J/m^3), zero at rest.
    fn energy_density(&self, strain: [f64; 3]) -> f64;

    /// The stress `s_zz` (Pa) normal to the plane: zero in plane stress.
    fn out_of_plane_stress(&self, strain: [f64; 3]) -> f64;

    /// The strain `e_zz` (-) normal to the plane: zero in plane strain, and unless overridden.
    fn thickness_strain(&self, strain: [f64; 3]) -> f64 {
        let _ = strain;
        0.0
    }

    /// The largest speed (m/s) at which a small in-plane disturbance travels at rest.
    ///
    /// It bounds the stable step of explicit integration.
    fn wave_speed(&self) -> f64;

    /// Whether the tangent is the same at every strain, so that one factorization may serve for ever.
    fn is_linear(&self) -> bool;

    /// The viscous damping that goes with the material; none unless overridden.
    fn rayleigh(&self) -> Rayleigh {
        Rayleigh::NONE
    }

    /// The law for large strains of a material that is made for them: what keeps its bodies from being such ones is an error then.
    fn hyperelastic(&self) -> Option<&Arc<dyn Hyperelastic>> {
        None
    }

    /// The law of bodies of large strain, which bodies are by default; that of [`hyperelastic`](Self::hyperelastic) unless overridden. At rest it must
    /// be this material in the plane. Without one a body is refused unless it is said to be one of small strain.
    fn large_law(&self) -> Option<Arc<dyn Hyperelastic>> {
        self.hyperelastic().cloned()
    }

    /// Whether the parameters make sense; called once, when a body is built.
    ///
    /// # Errors
    /// The first parameter out of its range, with its value and the cure.
    fn validate(&self) -> Result<(), MaterialError> {
        Ok(())
    }

    /// What a snapshot writes of the material; bodies of one that is [`MaterialRecord::Unknown`] cannot be saved.
    fn record(&self) -> MaterialRecord {
        MaterialRecord::Unknown
    }
}

/// A material parameter out of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// Young's modulus is not a positive finite number.
    #[error(
        "Young's modulus is {value} Pa: give a positive finite value, such as 2.1e11 for steel"
    )]
    Young {
        /// The value given (Pa).
        value: f64,
    },
    /// Poisson's ratio is outside the range of plane stress.
    #[error("Poisson's ratio is {value}: plane stress takes values above -1 and up to 0.5")]
    PoissonPlaneStress {
        /// The value given (-).
        value: f64,
    },
    /// Poisson's ratio is outside the range of plane strain.
    #[error(
        "Poisson's ratio is {value}: plane strain takes values above -1 and below 0.5; \
         use 0.49 for rubber, or plane stress for a thin sheet"
    )]
    PoissonPlaneStrain {
        /// The value given (-).
        value: f64,
    },
    /// The yield stress is not a positive finite number.
    #[error(
        "the yield stress is {value} Pa: give a positive finite value, such as 2.5e8 for mild steel, or take an elastic law"
    )]
    YieldStress {
        /// The value given (Pa).
        value: f64,
    },
    /// A parameter of hardening is negative or not finite.
    #[error(
        "the {name} of hardening is {value}: give zero or a positive finite value, and a stress to saturate at that is no less than the yield \
         stress; material that softens fails where its mesh is finest"
    )]
    Hardening {
        /// Which parameter.
        name: &'static str,
        /// The value (Pa, of the rate -).
        value: f64,
    },
    /// The density is not a positive finite number.
    #[error(
        "the density is {value} kg/m^3: set a positive finite value with `.density(rho)`, of a hyperelastic solid `.with_density(rho)`"
    )]
    Density {
        /// The value given (kg/m^3).
        value: f64,
    },
    /// The mass part of the damping is negative or not finite.
    #[error(
        "the mass part of Rayleigh damping is {value} 1/s: give zero or a positive finite value"
    )]
    DampingMass {
        /// The value given (1/s).
        value: f64,
    },
    /// The stiffness part of the damping is negative or not finite.
    #[error(
        "the stiffness part of Rayleigh damping is {value} s: give zero or a positive finite value"
    )]
    DampingStiffness {
        /// The value given (s).
        value: f64,
    },
    /// A parameter of a law is out of its range.
    #[error("{name} is {value}: {cure}")]
    Parameter {
        /// Which parameter.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What to do.
        cure: &'static str,
    },
}
