//! What a body of large strain is assembled from.

use super::pressure::{InnerPressure, PressureError};
use super::solid::Solid;
use crate::fe::element::Element;
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::material::{Material, MaterialError, Plane, Rayleigh};
use crate::fe::mesh::Mesh;
use crate::fe::model::{Model, ModelError};
use std::sync::Arc;
use thiserror::Error;

/// Why a body of large strain cannot be assembled.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FiniteStrainError {
    /// A cell has no element, an element refuses it, or the thickness is not positive.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A parameter of the law, the density or the damping is out of its range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// An inner pressure is out of its range, or has no hole.
    #[error(transparent)]
    Pressure(#[from] PressureError),
    /// There is not one rest position per dof.
    #[error("{found} rest positions were given for {expected} dofs: give x and y of every node")]
    RestPositions {
        /// Numbers given.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
}

/// What a body of large strain is assembled from.
#[derive(Clone, Debug)]
pub struct FiniteStrainDescription {
    /// Nodes and cells.
    pub mesh: Arc<Mesh>,
    /// Undeformed positions in the world's axes, interleaved (m).
    pub rest_positions: Vec<f64>,
    /// Elements that replace the default ones of their node count; their quadrature and shape functions are used.
    pub elements: Vec<Arc<dyn Element>>,
    /// The constitutive law.
    pub law: Arc<dyn Hyperelastic>,
    /// Density of the undeformed material (kg/m^3).
    pub density: f64,
    /// Viscous damping; its stiffness part acts as decay `2 η / dt` of the energy–momentum form, its mass part drags all motion.
    pub damping: Rayleigh,
    /// Thickness out of the plane (m).
    pub thickness: f64,
    /// What the stress out of the plane is told by; the law knows the plane alone.
    pub plane: Plane,
    /// Regions of the mesh that are made of something else; a later one of the same region counts.
    pub regions: Vec<(u32, Solid)>,
    /// Pressures in the holes of the mesh, one each in the order of its loops; empty for none.
    pub pressures: Vec<InnerPressure>,
}

impl FiniteStrainDescription {
    /// A body 1 m thick where its mesh is, of a density (kg/m^3), without damping.
    pub fn new(mesh: Mesh, law: impl Hyperelastic + 'static, density: f64) -> Self {
        Self {
            plane: Plane::Strain,
            rest_positions: mesh.nodes().iter().flatten().copied().collect(),
            mesh: Arc::new(mesh),
            elements: Vec::new(),
            law: Arc::new(law),
            density,
            damping: Rayleigh::NONE,
            thickness: 1.0,
            regions: Vec::new(),
            pressures: Vec::new(),
        }
    }

    /// A body of a material, whose mesh is placed at `rest_positions` (m); `None` if the material has no law for large strains.
    pub fn of_material(
        mesh: Arc<Mesh>,
        rest_positions: Vec<f64>,
        elements: &[Arc<dyn Element>],
        material: &dyn Material,
        thickness: f64,
    ) -> Option<Self> {
        let Solid {
            law,
            density,
            plane,
        } = Solid::of_material(material)?;
        Some(Self {
            mesh,
            rest_positions,
            elements: elements.to_vec(),
            law,
            density,
            damping: material.rayleigh(),
            thickness,
            plane,
            regions: Vec::new(),
            pressures: Vec::new(),
        })
    }

    /// The body that a model is at rest; `None` if one of its materials has no law for large strains.
    pub fn of_model(model: &Model) -> Option<Self> {
        let description = &model.description;
        let own = Self::of_material(
            Arc::clone(&description.mesh),
            description.rest_positions.clone(),
            &description.elements,
            description.material.as_ref(),
            description.thickness,
        )?;
        own.with_region_materials(&description.regions)
    }

    /// The same body with these materials in some regions, damped as the others are; `None` if one of them has no law for large strains.
    pub fn with_region_materials(mut self, regions: &[(u32, Arc<dyn Material>)]) -> Option<Self> {
        for (region, material) in regions {
            let solid = Solid::of_material(material.as_ref())?;
            self.regions.push((*region, solid));
        }
        Some(self)
    }

    /// What the cells of a region are made of.
    pub(super) fn solid_of(&self, region: u32) -> Solid {
        let own = self.regions.iter().rev().find(|(own, _)| *own == region);
        own.map_or_else(|| self.solid(), |(_, solid)| solid.clone())
    }

    fn solid(&self) -> Solid {
        Solid {
            law: Arc::clone(&self.law),
            density: self.density,
            plane: self.plane,
        }
    }

    pub(super) fn validate(&self) -> Result<(), FiniteStrainError> {
        self.solid().validate()?;
        for (_, solid) in &self.regions {
            solid.validate()?;
        }
        let is_damping = |value: f64| value >= 0.0 && value.is_finite();
        let Rayleigh { mass, stiffness } = self.damping;
        if !is_damping(mass) {
            return Err(MaterialError::DampingMass { value: mass }.into());
        }
        if !is_damping(stiffness) {
            return Err(MaterialError::DampingStiffness { value: stiffness }.into());
        }
        if !(self.thickness.is_finite() && self.thickness > 0.0) {
            return Err(ModelError::Thickness(self.thickness).into());
        }
        let (found, expected) = (self.rest_positions.len(), 2 * self.mesh.n_nodes());
        if found != expected {
            return Err(FiniteStrainError::RestPositions { found, expected });
        }
        Ok(())
    }
}
