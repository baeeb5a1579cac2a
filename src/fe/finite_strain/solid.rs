//! What the cells of a region are made of.

use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::material::{Material, MaterialError, Plane};
use crate::fe::record::LawRecord;
use std::sync::Arc;

/// A law with a density, for the cells of a region.
#[derive(Clone, Debug)]
pub struct Solid {
    /// The constitutive law.
    pub law: Arc<dyn Hyperelastic>,
    /// Density of the undeformed material (kg/m^3).
    pub density: f64,
    /// What the stress out of the plane is told by; the law knows the plane alone.
    pub plane: Plane,
}

impl Solid {
    /// That of a material; `None` if it has no law for large strains.
    pub fn of_material(material: &dyn Material) -> Option<Self> {
        let is_free = material.out_of_plane_stress([1.0, 1.0, 0.0]) == 0.0;
        Some(Self {
            plane: if is_free {
                Plane::Stress
            } else {
                Plane::Strain
            },
            law: material.large_law()?,
            density: material.density(),
        })
    }

    /// Whether cells of both are cells of one material; laws without a record are so only if they are one object.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let is_one_law = || {
            let (own, others) = (self.law.record(), other.law.record());
            Arc::ptr_eq(&self.law, &other.law) || (own != LawRecord::Unknown && own == others)
        };
        self.density == other.density && self.plane == other.plane && is_one_law()
    }

    pub(super) fn validate(&self) -> Result<(), MaterialError> {
        self.law.validate()?;
        let value = self.density;
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(MaterialError::Density { value })
        }
    }
}
