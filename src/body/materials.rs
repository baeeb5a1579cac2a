//! Materials of a body: one, and others in regions of its mesh.

use super::error::BuildError;
use super::region::Region;
use crate::fe::material::Material;
use crate::fe::mesh::Mesh;
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
