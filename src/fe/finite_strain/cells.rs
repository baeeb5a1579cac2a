//! Cells of one node count, in flat arrays: gradients of the shape functions, volumes, places in the matrix.

use super::Inadmissible;
use super::point::{self, Form, Linearization};
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants};
use crate::linalg::block_matrix::BlockMatrix;

/// Cells with the same number of nodes and of quadrature points.
#[derive(Clone, Debug)]
pub(super) struct CellGroup {
    pub(super) n_nodes: usize,
    pub(super) n_points: usize,
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
}

/// Gradients of deformation at the beginning and at the end of a step, one each per quadrature point.
pub(super) type Pair<'a> = (&'a [[f64; 4]], &'a [[f64; 4]]);

/// One cell: its nodes, and the gradients of its shape functions and the volume at each of its points.
struct Kinematics<'a, const N: usize> {
    nodes: &'a [u32; N],
    gradients: &'a [[[f64; 2]; N]],
    volumes: &'a [f64],
}

/// Runs a kernel with the node count of a group as a constant, which lets the compiler unroll its loops.
macro_rules! with_node_count {
    ($group:expr, $kernel:ident($($argument:expr),*)) => {
        match $group.n_nodes {
            3 => $group.$kernel::<3>($($argument),*),
            4 => $group.$kernel::<4>($($argument),*),
            6 => $group.$kernel::<6>($($argument),*),
            // The kinds of cells of a mesh have no other count.
            n => unreachable!("cells of {n} nodes"),
        }
    };
}
pub(super) use with_node_count;

impl CellGroup {
    /// The points of this group among those of the body.
    pub(super) fn points(&self) -> std::ops::Range<usize> {
        self.first_point..self.first_point + self.volumes.len()
    }

    fn kinematics<const N: usize>(&self) -> impl Iterator<Item = Kinematics<'_, N>> {
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
    pub(super) fn deform<const N: usize>(&self, positions: &[f64], out: &mut [[f64; 4]]) {
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
    pub(super) fn gradients_of<const N: usize>(
        &self,
        place: usize,
        positions: &[f64],
    ) -> Vec<[f64; 4]> {
        let mut cells = self.kinematics::<N>();
        cells.nth(place).map_or_else(Vec::new, |cell| {
            let differences = gather(cell.nodes, positions);
            let gradients = cell.gradients.iter();
            gradients
                .map(|gradient| deformation_gradient(&differences, gradient))
                .collect()
        })
    }

    /// Stored energy (J) of the group at these positions (m).
    pub(super) fn energy<const N: usize>(&self, law: &dyn Hyperelastic, positions: &[f64]) -> f64 {
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

    /// Subtracts the internal force of the group, after writing `F` of the end.
    pub(super) fn subtract_force<const N: usize>(
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
            for (&node, force) in cell.nodes.iter().zip(force) {
                let residual = &mut residual[2 * node as usize..][..2];
                residual[0] -= force[0];
                residual[1] -= force[1];
            }
        }
        Ok(())
    }

    /// Adds the tangent of the group between two states.
    pub(super) fn add_tangent<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        kind: Linearization,
        (start, end): Pair<'_>,
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
                add_point(gradient, &moduli, volume, &mut blocks);
            }
            scatter(&blocks, places, matrix);
        }
    }
}

/// Positions of a cell's nodes relative to its first one (m): no digits are lost far from the origin.
#[inline]
fn gather<const N: usize>(nodes: &[u32; N], positions: &[f64]) -> [[f64; 2]; N] {
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
fn deformation_gradient<const N: usize>(
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
fn add_point<const N: usize>(
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
fn scatter<const N: usize>(
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
