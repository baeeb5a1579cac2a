//! Materials of a body: one, and others in regions of its mesh.

use super::error::BuildError;
use crate::fe::material::Material;
use crate::fe::mesh::Mesh;
use std::fmt;
use std::sync::Arc;

/// A region of a mesh, by its number or its name: [`Mesh::with_regions`], [`Mesh::with_region_name`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Region {
    /// By number.
    Number(u32),
    /// By name.
    Name(String),
}

impl From<u32> for Region {
    fn from(number: u32) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Region {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "`{name}`"),
        }
    }
}

impl Region {
    /// Its number in a mesh.
    pub(super) fn number_in(&self, mesh: &Mesh) -> Result<u32, BuildError> {
        let found = match self {
            Self::Number(number) => Some(*number).filter(|own| mesh.regions().contains(own)),
            Self::Name(name) => mesh.region_named(name),
        };
        found.ok_or_else(|| BuildError::NoRegion {
            region: self.clone(),
            known: mesh.regions(),
        })
    }
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
            own.push((region.number_in(mesh)?, material));
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
