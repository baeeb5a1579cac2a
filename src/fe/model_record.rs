//! What a snapshot writes of a model: its description. Matrices are assembled anew, which gives the same bits; their fingerprint is
//! compared.

use super::mass_matrix::{MassKind, MassMatrix};
use super::material::Material;
use super::mesh::{CellKind, Mesh, MeshError};
use super::model::{Model, ModelDescription, ModelError};
use super::record::{ElementRecord, KnownLaws, MaterialRecord};
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::mix;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use thiserror::Error;

/// Why a body cannot be saved or restored.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelRecordError {
    /// A material of the user's has no name.
    #[error(
        "its material, {0}, has no name: let `Material::record` return `MaterialRecord::Named`, and hand it over in `KnownLaws` when the snapshot is restored"
    )]
    UnnamedMaterial(String),
    /// An element of the user's has no name.
    #[error(
        "its element `{0}` has no name: let `Element::record` return `ElementRecord::Named`, and hand it over in `KnownLaws` when the snapshot is restored"
    )]
    UnnamedElement(&'static str),
    /// Nobody knows the material.
    #[error("its material is {0:?}: hand it over in `KnownLaws` and `Snapshot::restore_with`")]
    UnknownMaterial(MaterialRecord),
    /// Nobody knows the element.
    #[error("its element is {0:?}: hand it over in `KnownLaws` and `Snapshot::restore_with`")]
    UnknownElement(ElementRecord),
    /// The mesh is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The model cannot be assembled.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A list has not the length that the mesh asks for.
    #[error("its {0} do not fit its mesh: the data is damaged")]
    Length(&'static str),
    /// The assembled model is another one than was saved.
    #[error(
        "its stiffness or mass is not what was saved: an element or a material of this name has changed, or the library is another version of itself"
    )]
    Differs,
}

/// A model as a snapshot writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ModelRecord {
    nodes: Vec<[f64; 2]>,
    cells: Vec<(CellKind, Vec<usize>)>,
    rest_positions: Vec<f64>,
    /// Empty where the body was built at rest.
    placed_positions: Vec<f64>,
    elements: Vec<ElementRecord>,
    material: MaterialRecord,
    /// Region of every cell, names of regions, and their materials.
    cell_regions: Vec<u32>,
    region_names: Vec<(u32, String)>,
    regions: Vec<(u32, MaterialRecord)>,
    thickness: f64,
    mass_kind: MassKind,
    massless: Vec<bool>,
    held: Vec<bool>,
    fingerprint: u64,
}

impl ModelRecord {
    /// The record of a model.
    ///
    /// # Errors
    /// If a law has no name.
    pub fn of(model: &Model) -> Result<Self, ModelRecordError> {
        let description = &model.description;
        let mesh = &description.mesh;
        let regions = description.regions.iter();
        let regions = regions.map(|(region, own)| Ok((*region, record_of(own)?)));
        let names = mesh.region_names();
        let named = |element: &Arc<dyn super::element::Element>| match element.record() {
            ElementRecord::Unknown => Err(ModelRecordError::UnnamedElement(element.name())),
            record => Ok(record),
        };
        let elements: Result<_, _> = description.elements.iter().map(named).collect();
        Ok(Self {
            nodes: mesh.nodes().to_vec(),
            cells: mesh
                .cells()
                .map(|cell| (cell.kind, cell.nodes.to_vec()))
                .collect(),
            rest_positions: description.rest_positions.clone(),
            placed_positions: description.placed_positions.clone(),
            elements: elements?,
            material: record_of(&description.material)?,
            cell_regions: mesh.cells().map(|cell| cell.region).collect(),
            region_names: names.map(|(at, name)| (at, name.to_owned())).collect(),
            regions: regions.collect::<Result<_, ModelRecordError>>()?,
            thickness: description.thickness,
            mass_kind: description.mass_kind,
            massless: description.massless.clone(),
            held: description.held.clone(),
            fingerprint: fingerprint(model),
        })
    }

    /// Assembles the model again.
    ///
    /// # Errors
    /// If a law is not known, or the model is not what was saved.
    pub fn build(self, laws: &KnownLaws) -> Result<Model, ModelRecordError> {
        let mesh = Mesh::from_mixed_cells(self.nodes, &self.cells)?;
        let mut mesh = mesh.with_regions(self.cell_regions)?;
        for (region, name) in self.region_names {
            mesh = mesh.with_region_name(region, name)?;
        }
        let n_nodes = mesh.n_nodes();
        if self.rest_positions.len() != 2 * n_nodes {
            return Err(ModelRecordError::Length("rest positions"));
        }
        if ![0, 2 * n_nodes].contains(&self.placed_positions.len()) {
            return Err(ModelRecordError::Length("placed positions"));
        }
        if [&self.massless, &self.held].map(Vec::len) != [n_nodes; 2] {
            return Err(ModelRecordError::Length("flags"));
        }
        let found = |record: MaterialRecord| {
            let material = laws.find_material(&record);
            material.ok_or(ModelRecordError::UnknownMaterial(record))
        };
        let material = found(self.material)?;
        let regions = self.regions.into_iter();
        let regions = regions.map(|(region, record)| Ok((region, found(record)?)));
        let known = |record: ElementRecord| {
            let found = laws.find_element(&record);
            found.ok_or(ModelRecordError::UnknownElement(record))
        };
        let elements: Result<_, _> = self.elements.into_iter().map(known).collect();
        let model = Model::assemble(ModelDescription {
            mesh: Arc::new(mesh),
            rest_positions: self.rest_positions,
            placed_positions: self.placed_positions,
            elements: elements?,
            material,
            regions: regions.collect::<Result<_, ModelRecordError>>()?,
            thickness: self.thickness,
            mass_kind: self.mass_kind,
            massless: self.massless,
            held: self.held,
        })?;
        if fingerprint(&model) == self.fingerprint {
            Ok(model)
        } else {
            Err(ModelRecordError::Differs)
        }
    }
}

/// The record of a material, if it has one.
fn record_of(material: &Arc<dyn Material>) -> Result<MaterialRecord, ModelRecordError> {
    match material.record() {
        MaterialRecord::Unknown => Err(ModelRecordError::UnnamedMaterial(format!("{material:?}"))),
        record => Ok(record),
    }
}

/// A hash of all that a step reads of a model's matrices.
fn fingerprint(model: &Model) -> u64 {
    let rayleigh = model.rayleigh();
    let numbers = [rayleigh.mass, rayleigh.stiffness];
    let hash = numbers
        .iter()
        .fold(0, |hash, number| mix(hash, number.to_bits()));
    let hash = hash_matrix(hash, model.stiffness());
    match model.mass() {
        MassMatrix::Lumped(mass) => mass.iter().fold(hash, |hash, m| mix(hash, m.to_bits())),
        MassMatrix::Consistent(matrix) => hash_matrix(hash, matrix),
    }
}

fn hash_matrix(hash: u64, matrix: &BlockMatrix) -> u64 {
    let rows = (0..matrix.n_nodes()).flat_map(|node| matrix.row_blocks(node));
    rows.flatten()
        .fold(hash, |hash, entry| mix(hash, entry.to_bits()))
}
