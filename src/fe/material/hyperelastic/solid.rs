//! A law for large strains with a density and a damping: what a body that bends and stretches far is made of.

use super::{Hyperelastic, Invariants};
use crate::fe::material::{LinearElastic, Material, MaterialError, Plane, Rayleigh};
use crate::fe::record::MaterialRecord;
use std::sync::Arc;

/// A material of large strain, in plane strain or, of a law for sheets, in plane stress.
///
/// A body of it is a large-strain body: it may bend, stretch and turn as far as it likes. As a [`Material`] it is Hooke's law with the
/// same constants at rest, by which critical steps and frequencies are estimated.
///
/// ```
/// use foil2d::fe::material::hyperelastic::{HyperelasticSolid, StableNeoHookean};
/// use foil2d::fe::material::Material;
///
/// let rubber = HyperelasticSolid::new(StableNeoHookean::plane_strain(1e6, 0.45)).with_density(1100.0);
/// assert!(rubber.validate().is_ok());
/// ```
#[derive(Clone, Debug)]
pub struct HyperelasticSolid {
    law: Arc<dyn Hyperelastic>,
    /// The law at rest, with density and damping.
    at_rest: LinearElastic,
}

impl HyperelasticSolid {
    /// A solid of this law; its density must be given.
    pub fn new(law: impl Hyperelastic + 'static) -> Self {
        Self::of(Arc::new(law))
    }

    /// A solid of a law that is shared.
    pub fn of(law: Arc<dyn Hyperelastic>) -> Self {
        Self {
            at_rest: law.constants().linear(0.0),
            law,
        }
    }

    /// Sets the density of the undeformed material (kg/m³).
    pub fn with_density(mut self, density: f64) -> Self {
        self.at_rest = self.at_rest.density(density);
        self
    }

    /// Sets both parts of Rayleigh damping. The stiffness part brakes strains, never rotations; the mass part drags all motion.
    pub fn with_damping(mut self, rayleigh: Rayleigh) -> Self {
        self.at_rest = self.at_rest.damping(rayleigh);
        self
    }

    /// The law.
    pub fn law(&self) -> &Arc<dyn Hyperelastic> {
        &self.law
    }
}

impl Material for HyperelasticSolid {
    fn density(&self) -> f64 {
        Material::density(&self.at_rest)
    }

    fn stress(&self, strain: [f64; 3]) -> [f64; 3] {
        self.at_rest.stress(strain)
    }

    fn tangent(&self, strain: [f64; 3]) -> [[f64; 3]; 3] {
        self.at_rest.tangent(strain)
    }

    fn energy_density(&self, strain: [f64; 3]) -> f64 {
        self.at_rest.energy_density(strain)
    }

    fn out_of_plane_stress(&self, strain: [f64; 3]) -> f64 {
        match self.law.plane() {
            Plane::Stress => 0.0,
            Plane::Strain => self.at_rest.out_of_plane_stress(strain),
        }
    }

    fn thickness_strain(&self, [xx, yy, xy]: [f64; 3]) -> f64 {
        let at = Invariants::of([1.0 + xx, 0.5 * xy, 0.5 * xy, 1.0 + yy]);
        self.law.thickness_stretch(at) - 1.0
    }

    fn wave_speed(&self) -> f64 {
        self.at_rest.wave_speed()
    }

    fn is_linear(&self) -> bool {
        // At rest it is Hooke's law, which is all that small strains ask of it.
        true
    }

    fn rayleigh(&self) -> Rayleigh {
        Material::rayleigh(&self.at_rest)
    }

    fn hyperelastic(&self) -> Option<&Arc<dyn Hyperelastic>> {
        Some(&self.law)
    }

    fn validate(&self) -> Result<(), MaterialError> {
        self.law.validate()?;
        self.at_rest.validate()
    }

    fn record(&self) -> MaterialRecord {
        MaterialRecord::hyperelastic(self)
    }
}
