//! Regions of a mesh.

use crate::fe::mesh::Mesh;
use std::fmt;

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
    /// Its number in a mesh, if it has such a region.
    pub(super) fn found_in(&self, mesh: &Mesh) -> Option<u32> {
        match self {
            Self::Number(number) => Some(*number).filter(|own| mesh.regions().contains(own)),
            Self::Name(name) => mesh.region_named(name),
        }
    }
}
