//! What of the work of a solver decides the bits of its next answers: patterns, and factors that are taken or corrected again.
//!
//! Written is what they were made of. Made anew they come out the same: a factor of the same numbers in the same order of elimination is the same to
//! the last bit.

use super::ConeSolver;
use super::correction::{Corrected, FactorRows};
use super::problem::{ConeEntry, ConeLaw, ConeProblem, ConeRow};
use super::system::System;
use crate::linalg::block_matrix::BlockMatrix;
use serde::{Deserialize, Serialize};

/// What a solver goes on from.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct ConeRecord {
    is_hard: bool,
    /// Pairs of nodes that are coupled, each once; none where nothing was analyzed.
    pairs: Option<Vec<[u32; 2]>>,
    factor: Option<FactorRecord>,
}

/// What a factor was made of, and what it has been corrected for.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct FactorRecord {
    spans: Vec<(u32, u32)>,
    entries: Vec<ConeEntry>,
    weights: Vec<[f64; 3]>,
    /// The values of `A`.
    values: Vec<[f64; 4]>,
    correction: Corrected,
}

impl ConeSolver {
    /// What the solver goes on from.
    pub(crate) fn record(&self) -> ConeRecord {
        ConeRecord {
            is_hard: self.is_hard,
            pairs: self
                .system
                .analysis
                .as_ref()
                .map(|known| pairs_of(&known.hull)),
            factor: self.system.factor_record(),
        }
    }

    /// Makes what was recorded of a solver again, for matrices of this pattern; `None` if it is of others.
    pub(crate) fn remembered(record: &ConeRecord, matrix: &BlockMatrix) -> Option<Self> {
        let mut solver = Self {
            is_hard: record.is_hard,
            ..Self::default()
        };
        if let Some(pairs) = &record.pairs {
            let n_nodes = matrix.n_nodes();
            let mut nodes = pairs.iter().flatten();
            if nodes.any(|&node| node as usize >= n_nodes) {
                return None;
            }
            let cells = pairs
                .iter()
                .map(|pair| pair.iter().map(|&node| node as usize));
            solver.system.couple(matrix, cells, false);
        }
        if let Some(factor) = &record.factor {
            let mut matrix = matrix.clone();
            if matrix.blocks().len() != factor.values.len() {
                return None;
            }
            matrix.blocks_mut().copy_from_slice(&factor.values);
            solver.system.make_again(factor, &matrix)?;
        }
        Some(solver)
    }
}

/// Every pair of nodes that a matrix couples, once.
fn pairs_of(matrix: &BlockMatrix) -> Vec<[u32; 2]> {
    let rows = (0..).zip(0..matrix.n_nodes());
    let pairs = rows.flat_map(|(node, row)| {
        let others = matrix.neighbours(row).iter();
        others.map(move |&other| [node, other])
    });
    pairs.filter(|[node, other]| other > node).collect()
}

impl System {
    /// What the factor at hand was made of, if there is one.
    fn factor_record(&self) -> Option<FactorRecord> {
        self.has_factor.then(|| FactorRecord {
            spans: self.spans.clone(),
            entries: self.entries.clone(),
            weights: self.weights.clone(),
            values: self.values.clone(),
            correction: self.correction.corrected().clone(),
        })
    }

    /// Makes a factor again; `None` if the record does not fit the pattern or itself.
    fn make_again(&mut self, record: &FactorRecord, matrix: &BlockMatrix) -> Option<()> {
        let row = |&entries: &(u32, u32)| ConeRow {
            entries,
            law: ConeLaw::Bilateral,
            free: [0.0; 2],
            give: [0.0; 2],
            acted: [0.0; 2],
            scale: [0.0; 2],
            local: f64::INFINITY,
        };
        let rows: Vec<ConeRow> = record.spans.iter().map(row).collect();
        let load = vec![0.0; matrix.n_dofs()];
        let problem = ConeProblem {
            matrix,
            load: &load,
            rows: &rows,
            entries: &record.entries,
        };
        problem.check().ok()?;
        if rows.len() != record.weights.len() || !record.correction.is_sound(rows.len()) {
            return None;
        }
        self.prepare(&problem, None).ok()?;
        self.factorize(&problem, &record.weights).ok()?;
        let analysis = self.analysis.as_mut()?;
        let rows = FactorRows {
            spans: &self.spans,
            entries: &self.entries,
        };
        let factor = &mut analysis.factor;
        self.correction
            .correct_again(&record.correction, rows, factor, matrix.n_dofs());
        Some(())
    }
}
