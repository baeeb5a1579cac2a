//! Linear algebra: sparse Cholesky, sparse LU for what is not definite, and complementarity.

pub mod block_matrix;
pub mod cholesky;
pub mod complementarity;
pub mod cone;
pub(crate) mod lu;
mod pattern;
