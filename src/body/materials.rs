//! Materials of a body: one, and others in regions of its mesh.

use super::error::BuildError;
use super::region::Region;
use crate::fe::material::Material;
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::mesh::Mesh;
use crate::fe::model::Model;
use std::sync::Arc;

/// The number of a region in a mesh.
pub(super) fn number_of(region: &Region, mesh: &Mesh) -> Result<u32, BuildError> {
    let found = region.found_in(mesh);
    found.ok_or_else(|| BuildError::NoRegion {
        region: region.clone(),
        known: mesh.regions(),
    })
}

/// What a builder was given.
#[derive(Clone, Debug, Default)]
pub(super) struct Materials {
    /// That of every region without one of its own.
    pub main: Option<Arc<dyn Material>>,
    pub regions: Vec<(Region, Arc<dyn Material>)>,
}

/// Says that a material has no law for large strains.
fn lawless(region: Option<u32>, material: &dyn Material) -> BuildError {
    BuildError::NoLargeLaw {
        material: format!("{material:?}"),
        region,
    }
}

/// The law for large strains of the material of a region, or of a whole body.
pub(super) fn large_law_of(
    region: Option<u32>,
    material: &dyn Material,
) -> Result<Arc<dyn Hyperelastic>, BuildError> {
    let law = material.large_law();
    law.ok_or_else(|| lawless(region, material))
}

/// Says which material of a model has no law for large strains.
pub(super) fn missing_law(model: &Model) -> BuildError {
    let regions = model.mesh().regions();
    let without = |region: &&u32| model.material_of(**region).large_law().is_none();
    match regions.iter().find(without) {
        Some(&region) if regions.len() > 1 => lawless(Some(region), model.material_of(region)),
        Some(&region) => lawless(None, model.material_of(region)),
        None => lawless(None, model.material()),
    }
}

/// Refuses the first of the materials that has no law for large strains, by its name and place.
pub(super) fn check_large_laws(
    main: &dyn Material,
    regions: &[(u32, Arc<dyn Material>)],
) -> Result<(), BuildError> {
    for (region, own) in regions {
        large_law_of(Some(*region), own.as_ref())?;
    }
    large_law_of(None, main).map(|_| ())
}

/// One material, and those of other regions by their numbers.
pub(super) type Resolved = (Arc<dyn Material>, Vec<(u32, Arc<dyn Material>)>);

impl Materials {
    /// The material of every region of a mesh, each validated.
    pub fn resolve(self, mesh: &Mesh) -> Result<Resolved, BuildError> {
        let mut own = Vec::new();
        for (region, material) in self.regions {
            material.validate()?;
            own.push((number_of(&region, mesh)?, material));
        }
        if let Some(main) = self.main {
            main.validate()?;
            return Ok((main, own));
        }
        let has_own = |region: &u32| own.iter().any(|(own, _)| own == region);
        if let Some(region) = mesh.regions().into_iter().find(|region| !has_own(region)) {
            return Err(match own.is_empty() {
                true => BuildError::NoMaterial,
                false => BuildError::RegionWithoutMaterial { region },
            });
        }
        // All regions have their own: the first stands for the body.
        let main = own.first().map(|(_, material)| Arc::clone(material));
        Ok((main.ok_or(BuildError::NoMaterial)?, own))
    }
}
