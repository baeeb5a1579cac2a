//! The assembled body: cells in groups, nodal masses, the pattern of the matrix.

use super::Inadmissible;
use super::cells::CellGroup;
use super::deformed::{Deformation, Deformed};
use super::description::{FiniteStrainDescription, FiniteStrainError};
use super::hole::{Hole, area, loop_of, n_holes, relative, terms_of};
use super::hourglass::Hourglass;
use super::lanes::Packs;
use super::linearization::Linearization;
use super::point::Form;
use super::pressure::{InnerPressure, PressureError};
use super::treatment::Treatment;
use crate::fe::element::{ElementError, MAX_NODES, kinematics::physical_gradient};
use crate::fe::material::Rayleigh;
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::mesh::{Cell, Mesh};
use crate::fe::model::{ModelError, element_of, placed_nodes};
use crate::linalg::block_matrix::BlockMatrix;
use std::sync::Arc;

/// The assembled, immutable model of one body at large strain, with lumped masses.
///
/// ```
/// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, Form};
/// use foil2d::fe::material::hyperelastic::StableNeoHookean;
/// use foil2d::fe::mesh::{CellKind, generate::rectangle};
///
/// let mesh = rectangle([1.0, 0.5], [4, 2], CellKind::Tri6)?;
/// let law = StableNeoHookean::plane_strain(1e5, 0.3);
/// let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))?;
///
/// // Stretched to twice its length: energy, and forces that pull back.
/// let stretched: Vec<f64> = model.rest_positions().chunks(2).flat_map(|p| [2.0 * p[0], p[1]]).collect();
/// assert!(model.elastic_energy(&stretched) > 0.0);
/// let mut deformation = model.deformation(model.rest_positions());
/// let mut residual = vec![0.0; model.n_dofs()];
/// model.subtract_force(Form::Equilibrium, &stretched, &mut deformation, &mut residual)?;
/// assert!(residual[0] > 0.0 && residual[8] < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FiniteStrainModel {
    pub(super) description: FiniteStrainDescription,
    pub(super) groups: Vec<CellGroup>,
    pub(super) n_points: usize,
    masses: Vec<f64>,
    /// All holes, if there is a pressure in one.
    pub(super) holes: Vec<Hole>,
    /// The zero matrix with the pattern of the tangent.
    pattern: BlockMatrix,
}

impl FiniteStrainModel {
    /// Lays out cells and matrix, and lumps the mass.
    ///
    /// # Errors
    /// If a parameter is out of its range, a cell has no element, or an element refuses it.
    pub fn assemble(description: FiniteStrainDescription) -> Result<Self, FiniteStrainError> {
        description.validate()?;
        let mesh = &description.mesh;
        let n_nodes = mesh.n_nodes();
        let mut holes = Hole::all(&description)?;
        let coupled = mesh.cells().map(|cell| cell.nodes);
        let coupled: Vec<_> = coupled
            .chain(holes.iter().filter_map(Hole::coupled))
            .collect();
        let pattern = BlockMatrix::from_cells(n_nodes, coupled.into_iter());
        holes.iter_mut().for_each(|hole| hole.place(&pattern));
        let mut model = Self {
            groups: Vec::new(),
            n_points: 0,
            masses: vec![0.0; n_nodes],
            holes,
            pattern,
            description,
        };
        let mesh = Arc::clone(&model.description.mesh);
        for (index, cell) in mesh.cells().enumerate() {
            model
                .add_cell(index, &cell)
                .map_err(FiniteStrainError::Model)?;
        }
        let mut n_cells = 0;
        for group in &mut model.groups {
            group.first_point = model.n_points;
            model.n_points += group.volumes.len();
            group.first_cell = n_cells;
            n_cells += group.cells.len();
            group.packs = Packs::of(group, &model.description.rest_positions);
        }
        Ok(model)
    }

    fn add_cell(&mut self, index: usize, cell: &Cell<'_>) -> Result<(), ModelError> {
        let wrap = |source: ElementError| ModelError::Element {
            cell: index,
            source,
        };
        let description = &self.description;
        let element = element_of(&description.elements, index, cell)?;
        let element = element.as_ref();
        let n = cell.nodes.len();
        let corners = placed_nodes(&description.rest_positions, cell);
        let (corners, thickness) = (&corners[..n], description.thickness);
        let solid = description.solid_of(cell.region);
        let mut lumped = [0.0; MAX_NODES];
        element
            .lumped_mass(corners, solid.density, thickness, &mut lumped[..n])
            .map_err(wrap)?;
        for (&node, mass) in cell.nodes.iter().zip(lumped) {
            self.masses[node] += mass;
        }
        let treatment = Treatment::of(element, solid.law.as_ref());
        let quadrature = treatment.quadrature(element);
        let sizes = [n, quadrature.len()];
        let group = CellGroup::find(&mut self.groups, sizes, treatment, &solid);
        group.cells.push(index);
        for point in quadrature {
            let mut gradient = [[0.0; 2]; MAX_NODES];
            let gradient = &mut gradient[..n];
            let determinant =
                physical_gradient(element, corners, point.at, gradient).map_err(wrap)?;
            group.gradients.extend_from_slice(gradient);
            group.volumes.push(determinant * point.weight * thickness);
            if treatment == Treatment::Stiffened {
                let at_rest = solid.law.constants().linear(solid.density);
                let hourglass = Hourglass::new(element, corners, gradient, &at_rest, thickness);
                group.hourglass.push(hourglass.map_err(wrap)?);
            }
        }
        if let Some(dilatation) = &mut group.dilatation {
            dilatation
                .add_cell(element, corners, thickness)
                .map_err(wrap)?;
        }
        let guards = &mut group.guards;
        guards.add(element, corners, solid.law.as_ref(), thickness);
        for &row in cell.nodes {
            // The pattern was built from these cells; numbers of nodes fit into 32 bits.
            group.nodes.push(row as u32);
            let places = cell
                .nodes
                .iter()
                .filter_map(|&column| self.pattern.place(row, column));
            group.places.extend(places.map(|place| place as u32));
        }
        Ok(())
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.masses.len()
    }

    /// Number of dofs, two a node.
    pub fn n_dofs(&self) -> usize {
        2 * self.n_nodes()
    }

    /// The mesh, in its own coordinates.
    pub fn mesh(&self) -> &Mesh {
        &self.description.mesh
    }

    /// Undeformed positions in the world's axes, interleaved (m).
    pub fn rest_positions(&self) -> &[f64] {
        &self.description.rest_positions
    }

    /// The constitutive law, but for regions that have one of their own.
    pub fn law(&self) -> &dyn Hyperelastic {
        self.description.law.as_ref()
    }

    /// Viscous damping.
    pub fn damping(&self) -> Rayleigh {
        self.description.damping
    }

    /// Nodal masses (kg): row sums, or of cells with midside nodes the scaled diagonal.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// The zero matrix with the blocks of the tangent.
    pub fn new_matrix(&self) -> BlockMatrix {
        self.pattern.clone()
    }

    /// The deformation at a step that begins at `positions` (m).
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn deformation(&self, positions: &[f64]) -> Deformation {
        let n_around = self.holes.last().map_or(0, |hole| hole.positions().end);
        let sizes = [self.n_dofs(), self.mesh().n_cells()];
        let deformed = Deformed::new(self.n_points, sizes, n_around);
        let mut deformation = Deformation {
            start: deformed.clone(),
            end: deformed,
        };
        deformation.start.flowed = self.virgin();
        self.begin(positions, &mut deformation);
        deformation
    }

    /// Lets a step begin at `positions` (m); until a force is asked for it ends there, too.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn begin(&self, positions: &[f64], deformation: &mut Deformation) {
        self.assert_length(positions);
        deformation.start.positions.copy_from_slice(positions);
        for group in &self.groups {
            group.deform(positions, &mut deformation.start);
        }
        for hole in &self.holes {
            hole.gather_into(positions, &mut deformation.start.around[hole.positions()]);
        }
        deformation.stay();
    }

    /// Subtracts the internal force (N) from `residual`, for a step that ends at `positions` (m), and keeps its deformation for
    /// [`add_tangent`](Self::add_tangent). Allocates nothing.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first cell where the law has no energy; the residual then is incomplete.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn subtract_force(
        &self,
        form: Form,
        positions: &[f64],
        deformation: &mut Deformation,
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        self.assert_length(positions);
        self.assert_length(residual);
        deformation.end.positions.copy_from_slice(positions);
        for group in &self.groups {
            let pair = (&deformation.start, &mut deformation.end);
            let law = group.solid.law.as_ref();
            group.subtract_force(law, form, positions, pair, residual)?;
        }
        for hole in &self.holes {
            let end = &mut deformation.end.around[hole.positions()];
            hole.gather_into(positions, end);
            let start = &deformation.start.around[hole.positions()];
            hole.subtract_force(form, [start, end], residual);
        }
        Ok(())
    }

    /// Adds `∂f/∂x'` (N/m) at the end last asked for. Allocates nothing.
    ///
    /// # Panics
    /// If the matrix was not made by [`new_matrix`](Self::new_matrix).
    pub fn add_tangent(
        &self,
        form: Form,
        kind: Linearization,
        deformation: &Deformation,
        matrix: &mut BlockMatrix,
    ) {
        assert!(
            matrix.has_pattern_of(&self.pattern),
            "the tangent of a body fits only its own matrices: make them with `new_matrix`"
        );
        for group in &self.groups {
            let pair = (&deformation.start, &deformation.end);
            let law = group.solid.law.as_ref();
            group.add_tangent(law, (form, kind), pair, matrix);
        }
        for hole in &self.holes {
            let pair = [&deformation.start, &deformation.end];
            let pair = pair.map(|one| &one.around[hole.positions()]);
            hole.add_tangent((form, kind), pair, matrix);
        }
    }

    /// Stored energy (J) at `positions` (m) of a body that has not flowed and does not, that of gases in holes included; not a number where the
    /// law or a gas has none. Of others [`energy_after`](Self::energy_after) tells.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn elastic_energy(&self, positions: &[f64]) -> f64 {
        self.assert_length(positions);
        let energy = |group: &CellGroup| group.energy(group.solid.law.as_ref(), positions);
        let elastic: f64 = self.groups.iter().map(energy).sum();
        self.holes
            .iter()
            .fold(elastic, |sum, hole| sum + hole.energy(positions))
    }

    /// Energy of gases in the body at rest (J).
    pub(crate) fn rest_energy(&self) -> f64 {
        let holes = self.holes.iter();
        holes.fold(0.0, |sum, hole| sum + hole.energy(self.rest_positions()))
    }

    /// Number of holes of the mesh, with or without pressure.
    pub fn n_holes(&self) -> usize {
        n_holes(self.mesh())
    }

    /// Inner pressures, one per hole; none where no hole has one.
    pub fn pressures(&self) -> &[InnerPressure] {
        &self.description.pressures
    }

    /// Whether another body is this one but for the numbers of its inner pressures.
    pub(crate) fn has_layout_of(&self, other: &Self) -> bool {
        let pairs = self.holes.iter().zip(&other.holes);
        Arc::ptr_eq(&self.description.mesh, &other.description.mesh)
            && self.holes.len() == other.holes.len()
            && pairs
                .into_iter()
                .all(|(one, other)| one.pressure.is_gas() == other.pressure.is_gas())
    }

    /// The same body with another pressure in a hole; in others what there was.
    ///
    /// # Errors
    /// If there is no such hole, or a number is out of its range.
    pub fn with_pressure(
        &self,
        hole: usize,
        pressure: InnerPressure,
    ) -> Result<Self, FiniteStrainError> {
        pressure.validate()?;
        let n_holes = self.n_holes();
        if hole >= n_holes {
            return Err(PressureError::Hole { hole, n_holes }.into());
        }
        let mut description = self.description.clone();
        description.pressures.resize(n_holes, InnerPressure::NONE);
        let before = std::mem::replace(&mut description.pressures[hole], pressure);
        if self.holes.is_empty() || before.is_gas() != pressure.is_gas() {
            return Self::assemble(description);
        }
        let mut model = self.clone();
        model.holes[hole].pressure = pressure;
        model.description = description;
        Ok(model)
    }

    /// Area of a hole at `positions` (m²); `None` if there is no such hole.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn hole_area(&self, hole: usize, positions: &[f64]) -> Option<f64> {
        self.assert_length(positions);
        (hole < self.n_holes()).then(|| {
            let nodes = loop_of(self.mesh(), hole);
            let terms = terms_of(self.mesh(), &nodes);
            area(&terms, |place| relative(&nodes, place, positions))
        })
    }

    /// Pressure in a hole at `positions`, above that outside (Pa); `None` if there is no such hole.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn hole_pressure(&self, hole: usize, positions: &[f64]) -> Option<f64> {
        let area = self.hole_area(hole, positions)?;
        let pressure = |hole: &Hole| hole.pressure.at(area / hole.area);
        Some(self.holes.get(hole).map_or(0.0, pressure))
    }

    /// Work of the constant pressures on the way from one placement to another (J). That of gases is what their energy falls by, which is part of
    /// [`elastic_energy`](Self::elastic_energy).
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn pressure_work(&self, from: &[f64], to: &[f64]) -> f64 {
        self.assert_length(from);
        self.assert_length(to);
        let constant = self.holes.iter().filter(|hole| !hole.pressure.is_gas());
        let works = constant.map(|hole| hole.work(from, to));
        works.sum()
    }

    pub(super) fn assert_length(&self, dofs: &[f64]) {
        assert!(
            dofs.len() == self.n_dofs(),
            "{} numbers were given for {} dofs",
            dofs.len(),
            self.n_dofs()
        );
    }
}
