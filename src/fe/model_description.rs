//! What a model is assembled from, and what can be wrong with it.

use super::element::{Element, ElementError};
use super::mass::MassError;
use super::mass_matrix::MassKind;
use super::material::Material;
use super::mesh::Mesh;
use std::sync::Arc;
use thiserror::Error;

/// Why a model cannot be assembled.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// No element fits a cell.
    #[error("cell {cell} has {n_nodes} nodes and no element for it: pass one with `element(...)`")]
    NoElement {
        /// Index of the cell.
        cell: usize,
        /// Its node count.
        n_nodes: usize,
    },
    /// An element refused a cell.
    #[error("cell {cell}: {source}")]
    Element {
        /// Index of the cell.
        cell: usize,
        /// What the element found.
        source: ElementError,
    },
    /// The mass cannot be moved off the contact boundary.
    #[error(transparent)]
    Mass(#[from] MassError),
    /// Thickness is not positive.
    #[error("the thickness is {0} m: give a finite positive one")]
    Thickness(f64),
    /// A region is damped in another way than the rest of the body.
    #[error(
        "the material of region {0} has another Rayleigh damping than the rest of the body, which is damped as one: give all of them the same"
    )]
    RegionDamping(u32),
}

/// What a model is assembled from.
#[derive(Clone, Debug)]
pub struct ModelDescription {
    /// Nodes and cells, in the body's reference placement.
    pub mesh: Arc<Mesh>,
    /// Unstrained positions of the nodes in the world's axes, interleaved (m): the mesh, placed.
    pub rest_positions: Vec<f64>,
    /// Where the nodes are when the body is built, in the world's axes, interleaved (m): displacements count from there. Empty where that is at rest.
    pub placed_positions: Vec<f64>,
    /// Elements that replace the default ones of their node count.
    pub elements: Vec<Arc<dyn Element>>,
    /// The constitutive law, but for the regions that follow.
    pub material: Arc<dyn Material>,
    /// Materials of regions of the mesh that have their own, damped as the others are; a later one of the same region counts.
    pub regions: Vec<(u32, Arc<dyn Material>)>,
    /// Thickness out of the plane (m).
    pub thickness: f64,
    /// Representation of the mass.
    pub mass_kind: MassKind,
    /// Nodes whose mass moves inwards, one flag per node; empty for none.
    pub massless: Vec<bool>,
    /// Nodes that cannot move, and so cannot carry another node's mass; empty for none.
    pub held: Vec<bool>,
}

impl ModelDescription {
    /// The material of a region.
    pub fn material_of(&self, region: u32) -> &Arc<dyn Material> {
        let own = self.regions.iter().rev().find(|(own, _)| *own == region);
        own.map_or(&self.material, |(_, material)| material)
    }

    pub(super) fn check_damping(&self) -> Result<(), ModelError> {
        let damping = self.material.rayleigh();
        let other = |(_, own): &&(u32, Arc<dyn Material>)| own.rayleigh() != damping;
        match self.regions.iter().find(other) {
            Some((region, _)) => Err(ModelError::RegionDamping(*region)),
            None => Ok(()),
        }
    }
}
