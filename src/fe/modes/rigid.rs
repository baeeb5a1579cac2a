//! Motions that nothing resists: those of a rigid body that leave what is held where it is.

use super::krylov::Basis;
use super::pencil::Pencil;
use crate::math::rounding;
use nalgebra::{Matrix3, SymmetricEigen};

/// A motion that moves held dofs by less than this of what it moves others by does not move them (-).
const STILL: f64 = rounding::ITERATED;

/// Forces of a rigid motion are within so many roundings of their terms (-).
const ROUNDINGS: f64 = 64.0;

/// Rigid motions that leave held dofs where they are and meet no force, orthonormal in `M`.
pub(super) fn rigid_motions(pencil: &Pencil<'_>, positions: &[f64]) -> Basis {
    let mut motions = Basis::default();
    for motion in still_at_held_dofs(pencil, positions) {
        if meets_no_force(pencil, &motion) {
            motions.add(pencil, motion);
        }
    }
    motions
}

/// Combinations of both translations and the rotation that vanish at held dofs.
fn still_at_held_dofs(pencil: &Pencil<'_>, positions: &[f64]) -> Vec<Vec<f64>> {
    let n_dofs = pencil.n_dofs();
    let count = 0.5 * n_dofs as f64;
    let centre = [0, 1].map(|axis| positions[axis..].iter().step_by(2).sum::<f64>() / count);
    let arm = |node: usize| [0, 1].map(|axis| positions[2 * node + axis] - centre[axis]);
    let sizes = (0..n_dofs / 2).flat_map(arm);
    let size = sizes.fold(0.0, |most: f64, x| most.max(x.abs()));
    if size == 0.0 {
        return Vec::new();
    }
    // What the motions `[x, y, turn]` do to a dof; the turn moves the outermost node by about one.
    let row = |dof: usize| {
        let [x, y] = arm(dof / 2);
        match dof % 2 {
            0 => [1.0, 0.0, -y / size],
            _ => [0.0, 1.0, x / size],
        }
    };
    let held: Vec<usize> = (0..n_dofs).filter(|&dof| pencil.is_held[dof]).collect();
    let mut gram = Matrix3::<f64>::zeros();
    for &dof in &held {
        let row = row(dof);
        gram += Matrix3::from_fn(|i, j| row[i] * row[j]);
    }
    let eigen = SymmetricEigen::new(gram);
    let motions = eigen.eigenvectors.column_iter().map(|factor| {
        let of_dof = |dof: usize| (0..3).map(|k| row(dof)[k] * factor[k]).sum();
        (0..n_dofs).map(of_dof).collect::<Vec<f64>>()
    });
    motions
        .filter_map(|mut motion| {
            let mut most = 0.0f64;
            for &dof in &held {
                most = most.max(motion[dof].abs());
                motion[dof] = 0.0;
            }
            (most <= STILL).then_some(motion)
        })
        .collect()
}

/// Whether `K r` is within the rounding of its terms.
fn meets_no_force(pencil: &Pencil<'_>, motion: &[f64]) -> bool {
    let stiffness = pencil.stiffness();
    let (mut force, mut terms) = (0.0f64, 0.0f64);
    for node in 0..stiffness.n_nodes() {
        let (mut sums, mut sizes) = ([0.0; 2], [0.0; 2]);
        let blocks = stiffness.row_blocks(node);
        for (&other, block) in stiffness.neighbours(node).iter().zip(blocks) {
            let other = &motion[2 * other as usize..][..2];
            for (k, entry) in block.iter().enumerate() {
                sums[k / 2] += entry * other[k % 2];
                sizes[k / 2] += (entry * other[k % 2]).abs();
            }
        }
        force = force.max(sums[0].abs()).max(sums[1].abs());
        terms = terms.max(sizes[0]).max(sizes[1]);
    }
    force <= ROUNDINGS * f64::EPSILON * terms
}
