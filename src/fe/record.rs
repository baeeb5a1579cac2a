//! How elements and materials are named in snapshots, and found again.
//!
//! Built-in ones are written with their parameters. One of your own gives a name ([`Material::record`], [`Element::record`]); whoever
//! reads the snapshot hands over the object of that name in [`KnownLaws`].

#[cfg(feature = "serde-serialize")]
pub use super::model_record::ModelRecordError;

use super::element::{Element, Quad4, Quad8, Tri3, Tri6};
use super::material::hyperelastic::{
    Corotated, Gent, Hencky, Hyperelastic, HyperelasticSolid, J2Plasticity, MooneyRivlin,
    MooneyRivlinSheet, NeoHookean, NeoHookeanSheet, StVenantKirchhoff, StableNeoHookean,
};
use super::material::{LinearElastic, Material, Rayleigh};
use std::sync::Arc;

/// What a snapshot writes of a material.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[non_exhaustive]
pub enum MaterialRecord {
    /// Nothing: bodies of this material cannot be saved.
    #[default]
    Unknown,
    /// Hooke's law, with its parameters.
    LinearElastic(LinearElastic),
    /// A law of large strain, with density (kg/m³) and damping.
    Hyperelastic(LawRecord, f64, Rayleigh),
    /// The name of a material in [`KnownLaws`]; two with different parameters need two names.
    Named(String),
}

impl MaterialRecord {
    /// That of a solid of large strain: nothing if its law has no record.
    pub(super) fn hyperelastic(solid: &HyperelasticSolid) -> Self {
        match solid.law().record() {
            LawRecord::Unknown => Self::Unknown,
            law => Self::Hyperelastic(law, solid.density(), solid.rayleigh()),
        }
    }
}

/// What a snapshot writes of a law of large strain.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[non_exhaustive]
pub enum LawRecord {
    /// Nothing: bodies of this law cannot be saved, unless their material has a name.
    #[default]
    Unknown,
    /// [`Corotated`].
    Corotated(Corotated),
    /// [`NeoHookean`].
    NeoHookean(NeoHookean),
    /// [`StVenantKirchhoff`].
    StVenantKirchhoff(StVenantKirchhoff),
    /// [`StableNeoHookean`].
    StableNeoHookean(StableNeoHookean),
    /// [`NeoHookeanSheet`].
    NeoHookeanSheet(NeoHookeanSheet),
    /// [`MooneyRivlin`].
    MooneyRivlin(MooneyRivlin),
    /// [`MooneyRivlinSheet`].
    MooneyRivlinSheet(MooneyRivlinSheet),
    /// [`Gent`].
    Gent(Gent),
    /// [`Hencky`].
    Hencky(Hencky),
    /// [`J2Plasticity`].
    J2Plasticity(J2Plasticity),
}

impl LawRecord {
    /// The law, `None` if nothing was written of it.
    fn law(&self) -> Option<Arc<dyn Hyperelastic>> {
        Some(match self {
            Self::Unknown => return None,
            Self::Corotated(law) => Arc::new(*law),
            Self::NeoHookean(law) => Arc::new(*law),
            Self::StVenantKirchhoff(law) => Arc::new(*law),
            Self::StableNeoHookean(law) => Arc::new(*law),
            Self::NeoHookeanSheet(law) => Arc::new(*law),
            Self::MooneyRivlin(law) => Arc::new(*law),
            Self::MooneyRivlinSheet(law) => Arc::new(*law),
            Self::Gent(law) => Arc::new(*law),
            Self::Hencky(law) => Arc::new(*law),
            Self::J2Plasticity(law) => Arc::new(*law),
        })
    }
}

/// What a snapshot writes of an element.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[non_exhaustive]
pub enum ElementRecord {
    /// Nothing: bodies with this element cannot be saved.
    #[default]
    Unknown,
    /// [`Tri3`].
    Tri3,
    /// [`Tri6`].
    Tri6,
    /// [`Quad4`].
    Quad4,
    /// The name of an element in [`KnownLaws`].
    Named(String),
    /// [`Quad8`].
    Quad8,
}

/// Elements and materials of your own, by the names that their records give.
#[derive(Clone, Debug, Default)]
pub struct KnownLaws {
    materials: Vec<(String, Arc<dyn Material>)>,
    elements: Vec<(String, Arc<dyn Element>)>,
}

impl KnownLaws {
    /// None but the built-in ones.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material under the name its [record](Material::record) gives; a later one of the same name replaces it.
    pub fn material(mut self, name: impl Into<String>, material: impl Material + 'static) -> Self {
        self.materials.push((name.into(), Arc::new(material)));
        self
    }

    /// Adds an element under the name its [record](Element::record) gives; a later one of the same name replaces it.
    pub fn element(mut self, name: impl Into<String>, element: impl Element + 'static) -> Self {
        self.elements.push((name.into(), Arc::new(element)));
        self
    }

    /// The material of a record, `None` if its name is not known.
    pub fn find_material(&self, record: &MaterialRecord) -> Option<Arc<dyn Material>> {
        match record {
            MaterialRecord::Unknown => None,
            MaterialRecord::LinearElastic(law) => Some(Arc::new(*law)),
            MaterialRecord::Hyperelastic(law, density, rayleigh) => {
                let solid = HyperelasticSolid::of(law.law()?);
                Some(Arc::new(
                    solid.with_density(*density).with_damping(*rayleigh),
                ))
            }
            MaterialRecord::Named(name) => find(&self.materials, name),
        }
    }

    /// The element of a record, `None` if its name is not known.
    pub fn find_element(&self, record: &ElementRecord) -> Option<Arc<dyn Element>> {
        match record {
            ElementRecord::Unknown => None,
            ElementRecord::Tri3 => Some(Arc::new(Tri3)),
            ElementRecord::Tri6 => Some(Arc::new(Tri6)),
            ElementRecord::Quad4 => Some(Arc::new(Quad4)),
            ElementRecord::Quad8 => Some(Arc::new(Quad8)),
            ElementRecord::Named(name) => find(&self.elements, name),
        }
    }
}

fn find<T: ?Sized>(known: &[(String, Arc<T>)], name: &str) -> Option<Arc<T>> {
    let mut latest_first = known.iter().rev();
    latest_first
        .find(|(own, _)| own == name)
        .map(|(_, found)| Arc::clone(found))
}
