//! Cells of one node count, in flat arrays: gradients of the shape functions, volumes, places in the matrix.

use super::Inadmissible;
use super::deformed::Deformed;
use super::dilatation::{Dilatation, Smoothing};
use super::guard::Guards;
use super::hourglass::{Hourglass, Shape};
use super::lanes::{Deform, Packs, PointEnergy, PointForces, PointTangent};
use super::linearization::Linearization;
use super::one_cell::{Kinematics, add_point, deformation_gradient, gather, scatter, subtract};
use super::point::{Form, derivatives};
use super::solid::Solid;
use super::treatment::Treatment;
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::linalg::block_matrix::BlockMatrix;

/// Cells of one material with the same number of nodes and of quadrature points.
#[derive(Clone, Debug)]
pub(super) struct CellGroup {
    pub(super) n_nodes: usize,
    pub(super) n_points: usize,
    pub(super) solid: Solid,
    /// Number of each cell in the mesh.
    pub(super) cells: Vec<usize>,
    /// Shape `(n_cells, n_nodes)`.
    pub(super) nodes: Vec<u32>,
    /// `dN_a/dX` (1/m), shape `(n_cells, n_points, n_nodes)`.
    pub(super) gradients: Vec<[f64; 2]>,
    /// `w det J thickness` (m^3), shape `(n_cells, n_points)`.
    pub(super) volumes: Vec<f64>,
    /// Places of the blocks `(a, b)` in the matrix, shape `(n_cells, n_nodes, n_nodes)`.
    pub(super) places: Vec<u32>,
    /// Where its points begin among those of the body.
    pub(super) first_point: usize,
    /// Of every cell the modes that its one point does not see, or none of any.
    pub(super) hourglass: Vec<Hourglass>,
    /// Areas that are smoothed over each of its cells, if they are.
    pub(super) dilatation: Option<Dilatation>,
    /// What keeps the nodes of the cells from turning, or nothing.
    pub(super) guards: Guards,
    /// Where its cells begin among all.
    pub(super) first_cell: usize,
    pub(super) packs: Packs,
}

/// Runs a kernel with the node count of a group as a constant, which lets the compiler unroll its loops.
macro_rules! with_node_count {
    ($group:expr, $kernel:ident($($argument:expr),*)) => {
        match $group.n_nodes {
            3 => $group.$kernel::<3>($($argument),*),
            4 => $group.$kernel::<4>($($argument),*),
            6 => $group.$kernel::<6>($($argument),*),
            8 => $group.$kernel::<8>($($argument),*),
            // The kinds of cells of a mesh have no other count.
            n => unreachable!("cells of {n} nodes"),
        }
    };
}
pub(super) use with_node_count;

impl CellGroup {
    /// The group of so many nodes and points a cell, of this treatment and of this material; an empty one if there is none yet.
    pub(super) fn find<'a>(
        groups: &'a mut Vec<Self>,
        [n_nodes, n_points]: [usize; 2],
        treatment: Treatment,
        solid: &Solid,
    ) -> &'a mut Self {
        let is_it = |group: &Self| {
            group.n_nodes == n_nodes
                && group.n_points == n_points
                && group.hourglass.is_empty() != (treatment == Treatment::Stiffened)
                && group.dilatation.is_some() == (treatment == Treatment::Smoothed)
                && group.solid.is_same(solid)
        };
        let at = groups.iter().position(is_it).unwrap_or(groups.len());
        if at == groups.len() {
            let volumetric = solid.law.volumetric();
            let volumetric = volumetric.filter(|_| treatment == Treatment::Smoothed);
            let lambda = solid.law.constants().lambda();
            groups.push(Self {
                dilatation: volumetric.map(|law| Dilatation::new(law, lambda)),
                n_nodes,
                n_points,
                solid: solid.clone(),
                cells: Vec::new(),
                nodes: Vec::new(),
                gradients: Vec::new(),
                volumes: Vec::new(),
                places: Vec::new(),
                first_point: 0,
                hourglass: Vec::new(),
                guards: Guards::default(),
                first_cell: 0,
                packs: Packs::default(),
            });
        }
        &mut groups[at]
    }

    /// The points of this group among those of the body.
    pub(super) fn points(&self) -> std::ops::Range<usize> {
        self.first_point..self.first_point + self.volumes.len()
    }

    /// Its cells among those of all groups, one after the other.
    pub(super) fn flat_places(&self) -> std::ops::Range<usize> {
        self.first_cell..self.first_cell + self.cells.len()
    }

    /// Writes the deformation at these positions (m).
    pub(super) fn deform(&self, positions: &[f64], out: &mut Deformed) {
        with_node_count!(self, deform_points(positions, out));
        for (place, point) in self.stiffened() {
            let (nodes, _) = self.quad(place);
            out.amplitudes[point] = self.hourglass[place].amplitude(&gather(nodes, positions));
        }
    }

    /// Stored energy (J) of the group at these positions (m).
    pub(super) fn energy(&self, law: &dyn Hyperelastic, positions: &[f64]) -> f64 {
        let energy = with_node_count!(self, point_energy(law, positions));
        let stiffened = self.stiffened();
        energy
            + with_node_count!(self, smoothed_energy(positions))
            + stiffened
                .map(|(place, _)| self.hourglass[place].energy(&self.shape(place, positions)))
                .sum::<f64>()
    }

    /// `F` and the amplitudes of a cell with hourglass modes.
    pub(super) fn shape(&self, place: usize, positions: &[f64]) -> Shape {
        let (nodes, gradients) = self.quad(place);
        let differences = gather(nodes, positions);
        Shape {
            gradient: deformation_gradient(&differences, gradients),
            amplitude: self.hourglass[place].amplitude(&differences),
            flowed: [0.0; 2],
        }
    }

    /// `F` at the points of one cell.
    pub(super) fn gradients_of(&self, place: usize, positions: &[f64]) -> Vec<[f64; 4]> {
        with_node_count!(self, point_gradients(place, positions))
    }

    /// What smoothed areas add to the pressure at the points of a cell at these gradients (Pa), tension positive.
    pub(super) fn smoothed_pressures(&self, place: usize, gradients: &[[f64; 4]]) -> Vec<f64> {
        match &self.dilatation {
            Some(of) => of.pressures(self, place, gradients),
            None => vec![0.0; gradients.len()],
        }
    }

    /// Subtracts the internal force of the group, after writing the deformation of the end.
    pub(super) fn subtract_force(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        positions: &[f64],
        (start, end): (&Deformed, &mut Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        match law.plasticity() {
            None => {
                let pair = (start, &mut *end);
                with_node_count!(
                    self,
                    subtract_point_forces(law, form, positions, pair, residual)
                )?;
            }
            Some(law) => {
                end.is_flat[self.flat_places()].fill(self.guards.len() > 0);
                let pair = (start, &mut *end);
                with_node_count!(
                    self,
                    subtract_flowing_forces(law, form, positions, pair, residual)
                )?;
            }
        }
        let pair = (start, &*end);
        with_node_count!(self, subtract_guard_forces(law, form, pair, residual))?;
        with_node_count!(self, subtract_smoothed_forces(form, pair, residual))?;
        let Some(law) = law.plasticity() else {
            return Ok(());
        };
        for (place, point) in self.stiffened() {
            let (nodes, _) = self.quad(place);
            let hourglass = &self.hourglass[place];
            end.amplitudes[point] = hourglass.amplitude(&gather(nodes, positions));
            let mut force = [[0.0; 2]; 4];
            let pair = [start.shape(point), end.shape(point)];
            let flowed = &start.flowed[point];
            let bend = self.bend(law, form, (place, flowed), pair);
            bend.add_force(form, &mut force);
            subtract(nodes, force, residual);
        }
        Ok(())
    }

    /// Adds the tangent of the group between two states.
    pub(super) fn add_tangent(
        &self,
        law: &dyn Hyperelastic,
        (form, kind): (Form, Linearization),
        (start, end): (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        match law.plasticity() {
            None => {
                let asked = (form, kind);
                with_node_count!(self, add_point_tangent(law, asked, (start, end), matrix));
            }
            Some(law) => {
                let asked = (form, kind);
                with_node_count!(self, add_flowing_tangent(law, asked, (start, end), matrix));
            }
        }
        with_node_count!(self, add_guard_tangent((form, kind), (start, end), matrix));
        with_node_count!(
            self,
            add_smoothed_tangent((form, kind), (start, end), matrix)
        );
        let is_done = kind == Linearization::Consistent && law.plasticity().is_none();
        for (place, point) in self.stiffened().filter(|_| !is_done) {
            let (_, gradients) = self.quad(place);
            let mut blocks = [[[0.0; 4]; 4]; 4];
            let pair = [start.shape(point), end.shape(point)];
            match law.plasticity() {
                None => {
                    let pair = (&pair[0], &pair[1]);
                    self.hourglass[place].add_tangent((form, kind), gradients, pair, &mut blocks);
                }
                Some(law) => {
                    let flowed = &start.flowed[point];
                    let bend = self.bend(law, form, (place, flowed), pair);
                    bend.add_tangent((form, kind), &mut blocks);
                }
            }
            let places = &self.places.as_chunks::<4>().0[4 * place..][..4];
            scatter(&blocks, places, matrix);
        }
    }

    /// Cells with hourglass modes, and their points.
    fn stiffened(&self) -> impl Iterator<Item = (usize, usize)> {
        let first = self.first_point;
        (0..self.hourglass.len()).map(move |place| (place, first + place))
    }

    /// Nodes of a cell of four, and the gradients of their shape functions at its one point.
    pub(super) fn quad(&self, place: usize) -> (&[u32; 4], &[[f64; 2]; 4]) {
        let nodes = &self.nodes.as_chunks::<4>().0[place];
        (nodes, &self.gradients.as_chunks::<4>().0[place])
    }

    pub(super) fn kinematics<const N: usize>(&self) -> impl Iterator<Item = Kinematics<'_, N>> {
        let nodes = self.nodes.as_chunks::<N>().0;
        let gradients = self.gradients.as_chunks::<N>().0;
        nodes
            .iter()
            .zip(gradients.chunks_exact(self.n_points))
            .zip(self.volumes.chunks_exact(self.n_points))
            .map(|((nodes, gradients), volumes)| Kinematics {
                nodes,
                gradients,
                volumes,
            })
    }

    /// Writes `F` at every point of the group, and which cells may be flat.
    fn deform_points<const N: usize>(&self, positions: &[f64], out: &mut Deformed) {
        let kernel = Deform::<N> {
            group: self,
            positions,
            out,
        };
        kernel.run();
    }

    /// `F` at the points of one cell of the group.
    fn point_gradients<const N: usize>(&self, place: usize, positions: &[f64]) -> Vec<[f64; 4]> {
        let mut cells = self.kinematics::<N>();
        cells.nth(place).map_or_else(Vec::new, |cell| {
            let differences = gather(cell.nodes, positions);
            let gradients = cell.gradients.iter();
            gradients
                .map(|gradient| deformation_gradient(&differences, gradient))
                .collect()
        })
    }

    /// Stored energy of points and guards (J).
    fn point_energy<const N: usize>(&self, law: &dyn Hyperelastic, positions: &[f64]) -> f64 {
        let kernel = PointEnergy::<N> {
            group: self,
            law,
            positions,
        };
        kernel.sum()
    }

    /// What smoothed areas add to the stored energy (J).
    pub(super) fn smoothed_energy<const N: usize>(&self, positions: &[f64]) -> f64 {
        let of = self.dilatation.as_ref();
        of.map_or(0.0, |of| of.energy::<N>(self, positions))
    }

    fn subtract_smoothed_forces<const N: usize>(
        &self,
        form: Form,
        pair: (&Deformed, &Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let of = self.dilatation.as_ref();
        of.map_or(Ok(()), |of| {
            of.subtract_forces::<N>(self, form, pair, residual)
        })
    }

    fn add_smoothed_tangent<const N: usize>(
        &self,
        asked: (Form, Linearization),
        pair: (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        if let Some(of) = &self.dilatation {
            of.add_tangent::<N>(self, asked, pair, matrix);
        }
    }

    fn subtract_point_forces<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        positions: &[f64],
        (start, end): (&Deformed, &mut Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let forces = PointForces::<N> {
            group: self,
            law,
            form,
            positions,
            start,
            end,
            residual,
        };
        forces.subtract()
    }

    fn add_point_tangent<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        (form, kind): (Form, Linearization),
        (start, end): (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        if kind == Linearization::Consistent {
            let tangent = PointTangent::<N> {
                group: self,
                law,
                form,
                start,
                end,
                matrix,
            };
            return tangent.add();
        }
        let smoothing = Smoothing::of(self, form, (start, end));
        let points = self.points();
        let cells = self
            .kinematics::<N>()
            .zip(start.gradients[points.clone()].chunks_exact(self.n_points))
            .zip(end.gradients[points].chunks_exact(self.n_points))
            .zip(self.places.as_chunks::<N>().0.chunks_exact(N));
        for (place, (((cell, start), end), places)) in cells.enumerate() {
            let (mut blocks, shifts) = ([[[0.0; 4]; N]; N], smoothing.shifts(place));
            let points = cell.gradients.iter().zip(cell.volumes).zip(start).zip(end);
            for (point, (((gradient, &volume), start), end)) in points.enumerate() {
                let (found, ends) = (derivatives(law, form, *start, *end), [*start, *end]);
                let shift = shifts[point];
                let moduli = smoothing.moduli(shift, law.constants(), (form, kind), found, ends);
                let share = kind.share(gradient, &moduli, volume);
                add_point(gradient, &moduli, share * volume, &mut blocks);
            }
            scatter(&blocks, places, matrix);
        }
    }
}
