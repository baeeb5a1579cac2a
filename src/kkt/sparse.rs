//! The sparse problem of an island, in the unknowns of its blocks; [`cones`](super::cones) states and solves it.

mod asked;
mod layout;
#[cfg(feature = "serde-serialize")]
mod record;
mod turning;

pub(super) use self::asked::Asked;
use self::layout::Shape;
#[cfg(feature = "serde-serialize")]
pub(crate) use self::record::KeptRecord;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cone::{ConeEntry, ConeRow, ConeSolver};

/// What is kept of an island from step to step: its unknowns and factors.
#[derive(Debug)]
pub(super) struct Kept {
    shapes: Vec<Shape>,
    pub matrix: BlockMatrix,
    /// First node of every block.
    pub first: Vec<usize>,
    /// One for each response: what rests keeps its factors.
    pub solvers: [ConeSolver; 4],
    /// Whether it has been asked for since the step began.
    is_in_use: bool,
    /// What was restored and has not been asked for: matrix and solvers are made when it is.
    #[cfg(feature = "serde-serialize")]
    restored: Option<record::Restored>,
}

/// The sparse problem of an island, with its buffers, and what is kept of those of the step before.
#[derive(Debug, Default)]
pub(super) struct Sparse {
    pub kept: Vec<Kept>,
    /// The island at hand among these.
    pub at: usize,
    pub rows: Vec<ConeRow>,
    pub entries: Vec<ConeEntry>,
    /// Place of every cone row's first component among the scalar rows.
    pub places: Vec<usize>,
    pub load: Vec<f64>,
    pub multipliers: Vec<[f64; 2]>,
    pub slip: Vec<f64>,
    /// Couples of every block by which forces turn it beyond what they did before, by their levers and by the reference arms (N m).
    pub couples: Vec<[f64; 2]>,
    pub answer: Vec<f64>,
}
