//! Cells of one node count, in flat arrays: gradients of the shape functions, volumes, places in the matrix.

use super::Inadmissible;
use super::deformed::Deformed;
use super::guard::Guards;
use super::hourglass::{Hourglass, Shape};
use super::linearization::Linearization;
use super::point::{self, Form};
use super::solid::Solid;
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants};
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
    /// What keeps the nodes of the cells from turning, or nothing.
    pub(super) guards: Guards,
    /// Where its guarded places begin among those of the body.
    pub(super) first_guard: usize,
}

/// One cell: its nodes, and the gradients of its shape functions and the volume at each of its points.
pub(super) struct Kinematics<'a, const N: usize> {
    pub(super) nodes: &'a [u32; N],
    pub(super) gradients: &'a [[[f64; 2]; N]],
    pub(super) volumes: &'a [f64],
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
    /// The group of so many nodes and points a cell, of cells with hourglass modes or without, and of this material; an empty one if there is
    /// none yet.
    pub(super) fn find<'a>(
        groups: &'a mut Vec<Self>,
        [n_nodes, n_points]: [usize; 2],
        is_stiffened: bool,
        solid: &Solid,
    ) -> &'a mut Self {
        let is_it = |group: &Self| {
            group.n_nodes == n_nodes
                && group.n_points == n_points
                && group.hourglass.is_empty() != is_stiffened
                && group.solid.is_same(solid)
        };
        let at = groups.iter().position(is_it).unwrap_or(groups.len());
        if at == groups.len() {
            groups.push(Self {
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
                first_guard: 0,
            });
        }
        &mut groups[at]
    }

    /// The points of this group among those of the body.
    pub(super) fn points(&self) -> std::ops::Range<usize> {
        self.first_point..self.first_point + self.volumes.len()
    }

    /// The guarded places of this group among those of the body.
    pub(super) fn guarded_places(&self) -> std::ops::Range<usize> {
        self.first_guard..self.first_guard + self.guards.len()
    }

    /// Writes the deformation at these positions (m).
    pub(super) fn deform(&self, positions: &[f64], out: &mut Deformed) {
        let gradients = &mut out.gradients[self.points()];
        with_node_count!(self, deform_points(positions, gradients));
        let guarded = &mut out.guarded[self.guarded_places()];
        with_node_count!(self, deform_guards(positions, guarded));
        for (place, point) in self.stiffened() {
            let (nodes, _) = self.quad(place);
            out.amplitudes[point] = self.hourglass[place].amplitude(&gather(nodes, positions));
        }
    }

    /// Stored energy (J) of the group at these positions (m).
    pub(super) fn energy(&self, law: &dyn Hyperelastic, positions: &[f64]) -> f64 {
        let energy: f64 = with_node_count!(self, point_energy(law, positions));
        let energy = energy + with_node_count!(self, guard_energy(positions));
        let stiffened = self.stiffened();
        energy
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

    /// Subtracts the internal force of the group, after writing the deformation of the end.
    pub(super) fn subtract_force(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        positions: &[f64],
        (start, end): (&Deformed, &mut Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let points = self.points();
        match law.plasticity() {
            None => {
                let pair = (&start.gradients[points.clone()], &mut end.gradients[points]);
                with_node_count!(
                    self,
                    subtract_point_forces(law, form, positions, pair, residual)
                )?;
            }
            Some(law) => {
                let pair = (start, &mut *end);
                with_node_count!(
                    self,
                    subtract_flowing_forces(law, form, positions, pair, residual)
                )?;
            }
        }
        let pair = (start, &mut *end);
        with_node_count!(
            self,
            subtract_guard_forces(law, form, positions, pair, residual)
        )?;
        for (place, point) in self.stiffened() {
            let (nodes, gradients) = self.quad(place);
            let hourglass = &self.hourglass[place];
            end.amplitudes[point] = hourglass.amplitude(&gather(nodes, positions));
            let mut force = [[0.0; 2]; 4];
            let pair = [start.shape(point), end.shape(point)];
            match law.plasticity() {
                None => hourglass.add_force(form, gradients, (&pair[0], &pair[1]), &mut force),
                Some(law) => {
                    let flowed = &start.flowed[point];
                    let bend = self.bend(law, form, (place, flowed), pair);
                    bend.add_force(form, &mut force);
                }
            }
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
        let points = self.points();
        match law.plasticity() {
            None => {
                let pair = (&start.gradients[points.clone()], &end.gradients[points]);
                with_node_count!(self, add_point_tangent(law, form, kind, pair, matrix));
            }
            Some(law) => {
                let asked = (form, kind);
                with_node_count!(self, add_flowing_tangent(law, asked, (start, end), matrix));
            }
        }
        with_node_count!(self, add_guard_tangent((form, kind), (start, end), matrix));
        for (place, point) in self.stiffened() {
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

    /// Writes `F` at every point of the group.
    fn deform_points<const N: usize>(&self, positions: &[f64], out: &mut [[f64; 4]]) {
        let cells = self
            .kinematics::<N>()
            .zip(out.chunks_exact_mut(self.n_points));
        for (cell, out) in cells {
            let differences = gather(cell.nodes, positions);
            for (gradient, out) in cell.gradients.iter().zip(out) {
                *out = deformation_gradient(&differences, gradient);
            }
        }
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

    fn point_energy<const N: usize>(&self, law: &dyn Hyperelastic, positions: &[f64]) -> f64 {
        let mut energy = 0.0;
        for cell in self.kinematics::<N>() {
            let differences = gather(cell.nodes, positions);
            for (gradient, volume) in cell.gradients.iter().zip(cell.volumes) {
                let at = Invariants::of(deformation_gradient(&differences, gradient));
                energy += volume * law.energy_density(at);
            }
        }
        energy
    }

    fn subtract_point_forces<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        positions: &[f64],
        (start, end): (&[[f64; 4]], &mut [[f64; 4]]),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let cells = self
            .kinematics::<N>()
            .zip(start.chunks_exact(self.n_points))
            .zip(end.chunks_exact_mut(self.n_points))
            .zip(&self.cells);
        for (((cell, start), end), &index) in cells {
            let differences = gather(cell.nodes, positions);
            let mut force = [[0.0; 2]; N];
            let points = cell.gradients.iter().zip(cell.volumes).zip(start).zip(end);
            for (((gradient, volume), start), end) in points {
                *end = deformation_gradient(&differences, gradient);
                let at = Invariants::of(*end);
                if !law.admits(at) {
                    return Err(Inadmissible {
                        cell: index,
                        jacobian: at.j,
                        law: law.name(),
                    });
                }
                let stress = point::stress(law, form, *start, *end).map(|part| volume * part);
                for (force, [x, y]) in force.iter_mut().zip(gradient) {
                    force[0] += stress[0] * x + stress[1] * y;
                    force[1] += stress[2] * x + stress[3] * y;
                }
            }
            subtract(cell.nodes, force, residual);
        }
        Ok(())
    }

    fn add_point_tangent<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        kind: Linearization,
        (start, end): (&[[f64; 4]], &[[f64; 4]]),
        matrix: &mut BlockMatrix,
    ) {
        let cells = self
            .kinematics::<N>()
            .zip(start.chunks_exact(self.n_points))
            .zip(end.chunks_exact(self.n_points))
            .zip(self.places.as_chunks::<N>().0.chunks_exact(N));
        for (((cell, start), end), places) in cells {
            let mut blocks = [[[0.0; 4]; N]; N];
            let points = cell.gradients.iter().zip(cell.volumes).zip(start).zip(end);
            for (((gradient, &volume), start), end) in points {
                let moduli = point::moduli(law, form, kind, *start, *end);
                let share = kind.share(gradient, &moduli, volume);
                add_point(gradient, &moduli, share * volume, &mut blocks);
            }
            scatter(&blocks, places, matrix);
        }
    }
}

#[inline]
pub(super) fn subtract<const N: usize>(
    nodes: &[u32; N],
    force: [[f64; 2]; N],
    residual: &mut [f64],
) {
    for (&node, force) in nodes.iter().zip(force) {
        let residual = &mut residual[2 * node as usize..][..2];
        residual[0] -= force[0];
        residual[1] -= force[1];
    }
}

/// Positions of a cell's nodes relative to its first one (m): no digits are lost far from the origin.
#[inline]
pub(super) fn gather<const N: usize>(nodes: &[u32; N], positions: &[f64]) -> [[f64; 2]; N] {
    let at = |node: u32| {
        let pair = &positions[2 * node as usize..][..2];
        [pair[0], pair[1]]
    };
    let [origin_x, origin_y] = at(nodes[0]);
    nodes.map(|node| {
        let [x, y] = at(node);
        [x - origin_x, y - origin_y]
    })
}

/// `F = Σ_a (x_a - x_0) ⊗ dN_a/dX`.
#[inline]
pub(super) fn deformation_gradient<const N: usize>(
    differences: &[[f64; 2]; N],
    gradient: &[[f64; 2]; N],
) -> [f64; 4] {
    let mut f = [0.0; 4];
    for ([x, y], [by_x, by_y]) in differences.iter().zip(gradient).skip(1) {
        f[0] += x * by_x;
        f[1] += x * by_y;
        f[2] += y * by_x;
        f[3] += y * by_y;
    }
    f
}

/// Adds `volume ∇N_a · A · ∇N_b` to the blocks `a <= b`.
#[inline]
pub(super) fn add_point<const N: usize>(
    gradient: &[[f64; 2]; N],
    moduli: &[[f64; 4]; 4],
    volume: f64,
    blocks: &mut [[[f64; 4]; N]; N],
) {
    for (b, [x, y]) in gradient.iter().enumerate() {
        let (x, y) = (volume * x, volume * y);
        // The stress that a motion of node b along each axis brings.
        let stress =
            |row: usize, axis: usize| moduli[row][2 * axis] * x + moduli[row][2 * axis + 1] * y;
        let stress: [[f64; 2]; 4] = std::array::from_fn(|row| [stress(row, 0), stress(row, 1)]);
        for (row, [x, y]) in blocks.iter_mut().zip(gradient).take(b + 1) {
            let block = &mut row[b];
            block[0] += x * stress[0][0] + y * stress[1][0];
            block[1] += x * stress[0][1] + y * stress[1][1];
            block[2] += x * stress[2][0] + y * stress[3][0];
            block[3] += x * stress[2][1] + y * stress[3][1];
        }
    }
}

#[inline]
pub(super) fn scatter<const N: usize>(
    blocks: &[[[f64; 4]; N]; N],
    places: &[[u32; N]],
    matrix: &mut BlockMatrix,
) {
    for (a, row) in blocks.iter().enumerate() {
        for (b, &block) in row.iter().enumerate().skip(a) {
            matrix.add_block_at(places[a][b] as usize, block);
            if a != b {
                let [xx, xy, yx, yy] = block;
                matrix.add_block_at(places[b][a] as usize, [xx, yx, xy, yy]);
            }
        }
    }
}
