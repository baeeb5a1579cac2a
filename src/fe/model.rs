//! The discrete body: mesh, elements, material and thickness assembled into `K` and `M`.
//!
//! A model never changes once built; bodies share it by reference count.

use super::element::{Element, MAX_NODES, default_element};
use super::frequency::frequency_bound;
pub use super::mass_matrix::{MassKind, MassMatrix};
use super::massless::{MassiveSupport, redistribute};
use super::material::{Material, Rayleigh};
use super::mesh::{Cell, Mesh};
pub use super::model_description::{ModelDescription, ModelError};
use super::recovery::{CellStress, Stress, smooth_to_nodes};
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::hypot;
use std::sync::{Arc, OnceLock};

/// The assembled, immutable finite-element model of one body.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) description: ModelDescription,
    stiffness: BlockMatrix,
    mass: MassMatrix,
    /// For every massless node the massive nodes that stand for its velocity.
    support: MassiveSupport,
    /// Length of the shortest edge of a cell (m).
    shortest_edge: f64,
    /// Computed when asked for: implicit integration never does.
    largest_frequency: OnceLock<f64>,
}

impl Model {
    /// Assembles stiffness and mass.
    ///
    /// # Errors
    /// If a cell has no element or an element refuses it, if the thickness is not positive, or if mass cannot be moved.
    pub fn assemble(mut description: ModelDescription) -> Result<Self, ModelError> {
        let thickness = description.thickness;
        if !(thickness.is_finite() && thickness > 0.0) {
            return Err(ModelError::Thickness(thickness));
        }
        description.check_damping()?;
        let mesh = Arc::clone(&description.mesh);
        let n_nodes = mesh.n_nodes();
        let mut stiffness = BlockMatrix::from_cells(
            n_nodes,
            (0..mesh.n_cells()).map(|cell| mesh.cell(cell).nodes),
        );
        let mut consistent = match description.mass_kind {
            MassKind::Consistent => Some(stiffness.clone()),
            MassKind::Lumped => None,
        };
        let mut lumped = vec![0.0; n_nodes];
        for_each_cell(&description, |nodes, cell_stiffness, cell_mass| {
            stiffness.add_cell(nodes, cell_stiffness);
            if let Some(consistent) = &mut consistent {
                add_scalar_cell(consistent, nodes, cell_mass);
            } else {
                for (&node, mass) in nodes.iter().zip(cell_mass) {
                    lumped[node] += mass;
                }
            }
        })?;
        let mut mass = match consistent {
            Some(matrix) => MassMatrix::Consistent(matrix),
            None => MassMatrix::Lumped(lumped),
        };
        if description.massless.contains(&true) {
            redistribute(&mut description, &mut mass, &stiffness)?;
        }
        if description.massless.is_empty() {
            description.massless = vec![false; n_nodes];
        }
        let support = MassiveSupport::new(&description.massless, &stiffness);
        let nodes = mesh.nodes();
        let lengths = mesh.edges().into_iter().map(|[from, to]| {
            let ([x, y], [to_x, to_y]) = (nodes[from], nodes[to]);
            hypot(to_x - x, to_y - y)
        });
        let shortest_edge = lengths.fold(f64::INFINITY, f64::min);
        Ok(Self {
            description,
            stiffness,
            mass,
            support,
            shortest_edge,
            largest_frequency: OnceLock::new(),
        })
    }

    /// The same body with its description changed: another material, in all of it or some regions, or thickness.
    ///
    /// # Errors
    /// As [`Model::assemble`].
    pub fn remade(&self, change: impl FnOnce(&mut ModelDescription)) -> Result<Self, ModelError> {
        let mut description = self.description.clone();
        change(&mut description);
        Self::assemble(description)
    }

    /// The mesh, in its own coordinates.
    pub fn mesh(&self) -> &Mesh {
        &self.description.mesh
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.description.mesh.n_nodes()
    }

    /// Number of dofs, two a node.
    pub fn n_dofs(&self) -> usize {
        2 * self.n_nodes()
    }

    /// Unstrained positions in the world's axes, interleaved (m).
    pub fn rest_positions(&self) -> &[f64] {
        &self.description.rest_positions
    }

    /// Where the body was built, in the world's axes, interleaved (m): at rest, but for a body that is stretched there.
    pub fn placed_positions(&self) -> &[f64] {
        match self.is_placed_at_rest() {
            true => self.rest_positions(),
            false => &self.description.placed_positions,
        }
    }

    /// Whether the body was built without strains.
    pub fn is_placed_at_rest(&self) -> bool {
        self.description.placed_positions.is_empty()
    }

    /// The stiffness matrix `K` (N/m).
    pub fn stiffness(&self) -> &BlockMatrix {
        &self.stiffness
    }

    /// The mass matrix `M` (kg).
    pub fn mass(&self) -> &MassMatrix {
        &self.mass
    }

    /// Length of the shortest edge of a cell, from node to node (m).
    pub fn shortest_edge(&self) -> f64 {
        self.shortest_edge
    }

    /// Whether a node's mass was moved inwards.
    pub fn is_massless(&self, node: usize) -> bool {
        self.description.massless[node]
    }

    /// Massless nodes with the massive nodes around them.
    pub fn massless_support(&self) -> impl Iterator<Item = (usize, &[usize])> {
        self.support.iter()
    }

    /// Whether some node has no mass.
    pub fn has_massless_nodes(&self) -> bool {
        self.support.iter().next().is_some()
    }

    /// The nodes that carry the mass of a massless node; none for a node with mass.
    pub fn support_of(&self, node: usize) -> &[usize] {
        self.support.of(node)
    }

    /// Damping coefficients of the material.
    pub fn rayleigh(&self) -> Rayleigh {
        self.description.material.rayleigh()
    }

    /// The constitutive law, but for regions that have one of their own.
    pub fn material(&self) -> &dyn Material {
        self.description.material.as_ref()
    }

    /// The constitutive law of a region.
    pub fn material_of(&self, region: u32) -> &dyn Material {
        self.description.material_of(region).as_ref()
    }

    /// Thickness (m).
    pub fn thickness(&self) -> f64 {
        self.description.thickness
    }

    /// An upper bound of the largest natural frequency with no dof held (rad/s), infinite when some node carries no mass.
    ///
    /// The first call costs one small eigenvalue problem per cell. [`frequency`](super::frequency) has bounds for held dofs and
    /// massless nodes, and the frequency itself.
    pub fn largest_frequency(&self) -> f64 {
        *self.largest_frequency.get_or_init(|| {
            if !self.has_massless_nodes() {
                frequency_bound(self, &[]).unwrap_or(f64::INFINITY)
            } else {
                f64::INFINITY
            }
        })
    }

    /// Elastic energy of local displacements `u` (J).
    pub fn elastic_energy(&self, u: &[f64]) -> f64 {
        let mut twice = 0.0;
        for node in 0..self.n_nodes() {
            let [a, b] = self.stiffness.multiply_node(node, u);
            twice += u[2 * node] * a + u[2 * node + 1] * b;
        }
        0.5 * twice
    }

    /// Visits the matrices of every cell again, with the masses before any redistribution; see [`for_each_cell`].
    pub(super) fn for_each_cell(
        &self,
        visit: impl FnMut(&[usize], &[f64], &[f64]),
    ) -> Result<(), ModelError> {
        for_each_cell(&self.description, visit)
    }

    /// Strains `[e_xx, e_yy, g_xy]` (-) and stresses (Pa) at the quadrature points of a cell, in the body's frame.
    ///
    /// - `u`: displacements in the body's frame, interleaved (m).
    ///
    /// # Errors
    /// If the element cannot evaluate its strain.
    ///
    /// # Panics
    /// If the cell does not exist or `u` is not two entries per node.
    pub fn cell_stress(
        &self,
        cell: usize,
        u: &[f64],
    ) -> Result<Vec<([f64; 3], Stress)>, ModelError> {
        let wrap = |source| ModelError::Element { cell, source };
        let nodes = self.mesh().cell(cell);
        let element = element_of(&self.description.elements, cell, &nodes)?;
        let n = nodes.nodes.len();
        let corners = placed_nodes(&self.description.rest_positions, &nodes);
        let mut local = [0.0; 2 * MAX_NODES];
        for (slot, &node) in nodes.nodes.iter().enumerate() {
            local[2 * slot..2 * slot + 2].copy_from_slice(&u[2 * node..2 * node + 2]);
        }
        let material = self.material_of(nodes.region);
        let mut strains = vec![[0.0; 3]; element.quadrature().len()];
        element
            .point_strains(&corners[..n], material, &local[..2 * n], &mut strains)
            .map_err(wrap)?;
        Ok(strains
            .into_iter()
            .map(|strain| (strain, Stress::of(material, strain)))
            .collect())
    }

    /// Smoothed stress at every node, in the body's frame (Pa).
    ///
    /// - `u`: displacements in the body's frame, interleaved (m).
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn nodal_stress(&self, u: &[f64]) -> Result<Vec<Stress>, ModelError> {
        self.smooth(None, |cell| {
            let found = self.cell_stress(cell, u)?;
            Ok(found.into_iter().map(|(_, stress)| stress).collect())
        })
    }

    /// Smooths stresses (Pa) that are given at the quadrature points of every cell, or of those in a region; zero at nodes of no such cell.
    pub(crate) fn smooth(
        &self,
        region: Option<u32>,
        stresses_of: impl Fn(usize) -> Result<Vec<Stress>, ModelError>,
    ) -> Result<Vec<Stress>, ModelError> {
        let mut elements = Vec::with_capacity(self.mesh().n_cells());
        let mut stresses = Vec::new();
        let mut spans = Vec::new();
        let is_in = |cell: &Cell<'_>| region.is_none_or(|region| cell.region == region);
        let all = self.mesh().cells();
        for (index, cell) in all.clone().enumerate().filter(|(_, cell)| is_in(cell)) {
            let element = element_of(&self.description.elements, index, &cell)?;
            let corners = placed_nodes(&self.description.rest_positions, &cell);
            let area = element.area(&corners[..cell.nodes.len()]);
            let area = area.map_err(|source| ModelError::Element {
                cell: index,
                source,
            })?;
            spans.push((stresses.len(), area));
            stresses.extend(stresses_of(index)?);
            elements.push(element);
        }
        let cells = all.filter(is_in).zip(&elements).zip(&spans).map(
            |((cell, element), &(first, weight))| {
                let last = first + element.quadrature().len();
                CellStress {
                    nodes: cell.nodes,
                    element: element.as_ref(),
                    stresses: &stresses[first..last],
                    weight,
                }
            },
        );
        let mut nodal = vec![Stress::default(); self.n_nodes()];
        smooth_to_nodes(cells, &mut vec![0.0; self.n_nodes()], &mut nodal);
        Ok(nodal)
    }
}

/// Calls `visit` with the nodes of every cell, its stiffness (N/m, shape `(2n, 2n)`) and its mass (kg): the consistent one,
/// shape `(n, n)`, or the lumped one, shape `(n)`.
fn for_each_cell(
    description: &ModelDescription,
    mut visit: impl FnMut(&[usize], &[f64], &[f64]),
) -> Result<(), ModelError> {
    let mut stiffness = [0.0; 4 * MAX_NODES * MAX_NODES];
    let mut mass = [0.0; MAX_NODES * MAX_NODES];
    let thickness = description.thickness;
    for (index, cell) in description.mesh.cells().enumerate() {
        let material = description.material_of(cell.region).as_ref();
        let density = material.density();
        let wrap = |source| ModelError::Element {
            cell: index,
            source,
        };
        let element = element_of(&description.elements, index, &cell)?;
        let n = cell.nodes.len();
        let corners = placed_nodes(&description.rest_positions, &cell);
        let corners = &corners[..n];
        let stiffness = &mut stiffness[..4 * n * n];
        element
            .stiffness(corners, material, thickness, stiffness)
            .map_err(wrap)?;
        let mass = match description.mass_kind {
            MassKind::Consistent => &mut mass[..n * n],
            MassKind::Lumped => &mut mass[..n],
        };
        match description.mass_kind {
            MassKind::Consistent => element.consistent_mass(corners, density, thickness, mass),
            MassKind::Lumped => element.lumped_mass(corners, density, thickness, mass),
        }
        .map_err(wrap)?;
        visit(cell.nodes, stiffness, mass);
    }
    Ok(())
}

/// The element of a cell: the last matching one the user gave, else the default of its node count.
pub(super) fn element_of(
    elements: &[Arc<dyn Element>],
    index: usize,
    cell: &Cell<'_>,
) -> Result<Arc<dyn Element>, ModelError> {
    let n_nodes = cell.nodes.len();
    let own = elements
        .iter()
        .rev()
        .find(|element| element.n_nodes() == n_nodes);
    own.cloned()
        .or_else(|| default_element(n_nodes))
        .ok_or(ModelError::NoElement {
            cell: index,
            n_nodes,
        })
}

/// Nodes of a cell in the world's axes; only the first `cell.nodes.len()` entries are meaningful.
pub(super) fn placed_nodes(rest: &[f64], cell: &Cell<'_>) -> [[f64; 2]; MAX_NODES] {
    let mut corners = [[0.0; 2]; MAX_NODES];
    for (corner, &node) in corners.iter_mut().zip(cell.nodes) {
        *corner = [rest[2 * node], rest[2 * node + 1]];
    }
    corners
}

/// Adds a scalar cell matrix as `m_ab I` blocks.
fn add_scalar_cell(matrix: &mut BlockMatrix, nodes: &[usize], cell: &[f64]) {
    for (a, &row) in nodes.iter().enumerate() {
        for (b, &column) in nodes.iter().enumerate() {
            if let Some(block) = matrix.block_mut(row, column) {
                let mass = cell[a * nodes.len() + b];
                block[0] += mass;
                block[3] += mass;
            }
        }
    }
}
