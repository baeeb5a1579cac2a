//! Linear algebra: sparse Cholesky and complementarity.

pub mod block_matrix;
pub mod cholesky;
pub mod complementarity;
pub mod cone;
