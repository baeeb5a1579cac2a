//! The mass matrix of a body, the same in x and y: nodal masses, or `m_ab I` blocks.

use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{Vec2, cross, node_vec, sum_over_dofs};

/// How the mass of a body is represented.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum MassKind {
    /// Nodal masses (row sums; HRZ on quadratic elements).
    #[default]
    Lumped,
    /// `m = ∫ ρ N N t dA`, with the pattern of the stiffness.
    Consistent,
}

/// The mass matrix, the same in x and y.
#[derive(Clone, Debug)]
pub enum MassMatrix {
    /// One mass per node (kg).
    Lumped(Vec<f64>),
    /// Blocks `m_ab I` (kg).
    Consistent(BlockMatrix),
}

impl MassMatrix {
    /// Row sums per node, `M 1` (kg).
    pub fn node_sums(&self) -> Vec<f64> {
        match self {
            Self::Lumped(mass) => mass.clone(),
            Self::Consistent(matrix) => {
                let ones = vec![1.0; matrix.n_dofs()];
                let mut sums = vec![0.0; matrix.n_dofs()];
                matrix.multiply(&ones, &mut sums);
                sums.iter().step_by(2).copied().collect()
            }
        }
    }

    /// `y += scale M x`; both interleaved.
    pub fn multiply_add(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Lumped(mass) => {
                for ((y, x), mass) in y.chunks_exact_mut(2).zip(x.chunks_exact(2)).zip(mass) {
                    let mass = scale * mass;
                    y[0] += mass * x[0];
                    y[1] += mass * x[1];
                }
            }
            Self::Consistent(matrix) => matrix.multiply_add(scale, x, y),
        }
    }

    /// Adds `scale M` to a block matrix of the same pattern.
    pub fn add_to(&self, scale: f64, matrix: &mut BlockMatrix) {
        match self {
            Self::Lumped(mass) => {
                for (node, mass) in mass.iter().enumerate() {
                    matrix.add_diagonal(node, [scale * mass, scale * mass]);
                }
            }
            Self::Consistent(mass) => matrix.add_scaled(scale, mass),
        }
    }

    /// Row sum of a node (kg).
    pub fn node_sum(&self, node: usize) -> f64 {
        match self {
            Self::Lumped(mass) => mass[node],
            Self::Consistent(matrix) => matrix.row_blocks(node).iter().map(|block| block[0]).sum(),
        }
    }

    /// `x·M y` over all dofs.
    pub fn inner(&self, x: &[f64], y: &[f64]) -> f64 {
        match self {
            Self::Lumped(mass) => sum_over_dofs(mass, [x, y], |mass, [x, y]| mass * x * y),
            Self::Consistent(matrix) => (0..matrix.n_nodes())
                .map(|node| {
                    let [a, b] = matrix.multiply_node(node, y);
                    x[2 * node] * a + x[2 * node + 1] * b
                })
                .sum(),
        }
    }

    /// `Σ (x - c) × (M y)`: the moment of the mass-weighted vectors `y` about `centre`.
    pub fn moment(&self, centre: Vec2, x: &[f64], y: &[f64]) -> f64 {
        match self {
            Self::Lumped(mass) => mass
                .iter()
                .enumerate()
                .map(|(node, mass)| mass * cross(node_vec(x, node) - centre, node_vec(y, node)))
                .sum(),
            Self::Consistent(matrix) => (0..matrix.n_nodes())
                .map(|node| {
                    let [a, b] = matrix.multiply_node(node, y);
                    cross(node_vec(x, node) - centre, Vec2::new(a, b))
                })
                .sum(),
        }
    }
}
