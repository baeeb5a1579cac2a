//! One cell: what it takes from its nodes, and what it gives to forces and matrix.

use super::point::each;
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::Number;

/// One cell: its nodes, and the gradients of its shape functions and the volume at each of its points.
pub(super) struct Kinematics<'a, const N: usize> {
    pub(super) nodes: &'a [u32; N],
    pub(super) gradients: &'a [[[f64; 2]; N]],
    pub(super) volumes: &'a [f64],
}

/// Subtracts the forces of a cell (N) from what its nodes have.
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
#[inline(always)]
pub(super) fn deformation_gradient<T: Number, const N: usize>(
    differences: &[[T; 2]; N],
    gradient: &[[T; 2]; N],
) -> [T; 4] {
    let mut f = [T::ZERO; 4];
    for (&[x, y], &[by_x, by_y]) in differences.iter().zip(gradient).skip(1) {
        f[0] += x * by_x;
        f[1] += x * by_y;
        f[2] += y * by_x;
        f[3] += y * by_y;
    }
    f
}

/// Adds `volume ∇N_a · A · ∇N_b` to the blocks `a <= b`.
#[inline(always)]
pub(super) fn add_point<T: Number, const N: usize>(
    gradient: &[[T; 2]; N],
    moduli: &[[T; 4]; 4],
    volume: T,
    blocks: &mut [[[T; 4]; N]; N],
) {
    for (b, &[x, y]) in gradient.iter().enumerate() {
        let (x, y) = (volume * x, volume * y);
        // The stress that a motion of node b along each axis brings.
        let stress =
            |row: usize, axis: usize| moduli[row][2 * axis] * x + moduli[row][2 * axis + 1] * y;
        let stress = each(|row| [stress(row, 0), stress(row, 1)]);
        for (row, &[x, y]) in blocks.iter_mut().zip(gradient).take(b + 1) {
            let block = &mut row[b];
            block[0] += x * stress[0][0] + y * stress[1][0];
            block[1] += x * stress[0][1] + y * stress[1][1];
            block[2] += x * stress[2][0] + y * stress[3][0];
            block[3] += x * stress[2][1] + y * stress[3][1];
        }
    }
}

/// Adds the blocks `a <= b` of a cell, and their transposes, at their places in the matrix.
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
