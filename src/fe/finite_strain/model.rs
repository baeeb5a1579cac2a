//! The assembled body: cells in groups, nodal masses, the pattern of the matrix.

use super::Inadmissible;
use super::cells::{CellGroup, Deformed};
use super::hourglass::Hourglass;
use super::linearization::Linearization;
use super::point::Form;
use super::solid::Solid;
use crate::fe::element::quadrature::SQUARE_1;
use crate::fe::element::{Element, ElementError, MAX_NODES, kinematics::physical_gradient};
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::material::{Material, MaterialError, Plane, Rayleigh};
use crate::fe::mesh::{Cell, Mesh};
use crate::fe::model::{Model, ModelError, element_of, placed_nodes};
use crate::fe::record::ElementRecord;
use crate::linalg::block_matrix::BlockMatrix;
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
}

impl FiniteStrainDescription {
    /// A body 1 m thick where its mesh is, of a density (kg/m^3), without damping.
    pub fn new(mesh: Mesh, law: impl Hyperelastic + 'static, density: f64) -> Self {
        Self {
            plane: Plane::Strain,
            regions: Vec::new(),
            rest_positions: mesh.nodes().iter().flatten().copied().collect(),
            mesh: Arc::new(mesh),
            elements: Vec::new(),
            law: Arc::new(law),
            density,
            damping: Rayleigh::NONE,
            thickness: 1.0,
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
    fn solid_of(&self, region: u32) -> Solid {
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

    fn validate(&self) -> Result<(), FiniteStrainError> {
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

/// Gradients of deformation at the quadrature points: at the beginning of a step, and at the end last asked for.
#[derive(Clone, Debug)]
pub struct Deformation {
    start: Deformed,
    end: Deformed,
}

impl Deformation {
    /// Makes the end of the step the beginning of the next.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
    }

    /// Quadrature points that are turned inside out at the beginning of the step.
    pub fn n_inverted(&self) -> usize {
        let is_inverted = |[xx, xy, yx, yy]: &&[f64; 4]| xx * yy - xy * yx <= 0.0;
        self.start.gradients.iter().filter(is_inverted).count()
    }
}

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
    n_points: usize,
    n_guarded: usize,
    masses: Vec<f64>,
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
        let pattern = BlockMatrix::from_cells(
            n_nodes,
            mesh.cells()
                .map(|cell| cell.nodes)
                .collect::<Vec<_>>()
                .into_iter(),
        );
        let mut model = Self {
            groups: Vec::new(),
            n_points: 0,
            n_guarded: 0,
            masses: vec![0.0; n_nodes],
            pattern,
            description,
        };
        let mesh = Arc::clone(&model.description.mesh);
        for (index, cell) in mesh.cells().enumerate() {
            model
                .add_cell(index, &cell)
                .map_err(FiniteStrainError::Model)?;
        }
        for group in &mut model.groups {
            group.first_point = model.n_points;
            model.n_points += group.volumes.len();
            group.first_guard = model.n_guarded;
            model.n_guarded += group.guards.len();
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
        // The element whose inner modes are left out has stiffened hourglass modes in their place.
        let is_stiffened = element.record() == ElementRecord::Quad4;
        let quadrature = match is_stiffened {
            true => &SQUARE_1,
            false => element.quadrature(),
        };
        let sizes = [n, quadrature.len()];
        let group = CellGroup::find(&mut self.groups, sizes, is_stiffened, &solid);
        group.cells.push(index);
        for point in quadrature {
            let mut gradient = [[0.0; 2]; MAX_NODES];
            let gradient = &mut gradient[..n];
            let determinant =
                physical_gradient(element, corners, point.at, gradient).map_err(wrap)?;
            group.gradients.extend_from_slice(gradient);
            group.volumes.push(determinant * point.weight * thickness);
            if is_stiffened {
                let at_rest = solid.law.constants().linear(solid.density);
                let hourglass = Hourglass::new(element, corners, gradient, &at_rest, thickness);
                group.hourglass.push(hourglass.map_err(wrap)?);
            }
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
        let mut deformation = Deformation {
            start: Deformed::new(self.n_points, self.n_guarded),
            end: Deformed::new(self.n_points, self.n_guarded),
        };
        self.begin(positions, &mut deformation);
        deformation
    }

    /// Lets a step begin at `positions` (m); until a force is asked for it ends there, too.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn begin(&self, positions: &[f64], deformation: &mut Deformation) {
        self.assert_length(positions);
        for group in &self.groups {
            group.deform(positions, &mut deformation.start);
        }
        let Deformation { start, end } = deformation;
        end.gradients.copy_from_slice(&start.gradients);
        end.amplitudes.copy_from_slice(&start.amplitudes);
        end.guarded.copy_from_slice(&start.guarded);
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
        for group in &self.groups {
            let pair = (&deformation.start, &mut deformation.end);
            let law = group.solid.law.as_ref();
            group.subtract_force(law, form, positions, pair, residual)?;
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
    }

    /// Stored energy (J) at `positions` (m); not a number where the law has none.
    ///
    /// # Panics
    /// If there is not one entry per dof.
    pub fn elastic_energy(&self, positions: &[f64]) -> f64 {
        self.assert_length(positions);
        let energy = |group: &CellGroup| group.energy(group.solid.law.as_ref(), positions);
        self.groups.iter().map(energy).sum()
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
