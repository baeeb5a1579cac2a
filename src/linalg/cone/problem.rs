//! The problem as data: `A a = r + Gᵀ p`, `w = free + G a + give p`, and a law between `w` and `p + acted` on every row.

use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::CholeskyError;
use thiserror::Error;

/// What one node contributes to the normal and the tangential component of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ConeEntry {
    /// The node, in the numbering of the matrix.
    pub node: u32,
    /// `dw_n/da` of the two dofs of the node.
    pub normal: [f64; 2],
    /// `dw_t/da` of the two dofs of the node; not read on rows with one component.
    pub tangent: [f64; 2],
}

/// The law of one row, between `w` and the whole multiplier `P = p + acted`.
///
/// All but contacts have one component, the first; their second multiplier is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ConeLaw {
    /// `0 <= w_n`, `0 <= P_n`, `w_n P_n = 0` and `|P_t| <= mu P_n`, where a slip `w_t` is opposed by `mu P_n`.
    Contact {
        /// The coefficient of friction `mu` (-), zero or more.
        friction: f64,
    },
    /// `w = 0`, any multiplier: a joint or a tie.
    Bilateral,
    /// `0 <= w`, `0 <= P`, `w P = 0`: a stop that pushes and never pulls.
    Unilateral,
    /// `low <= P <= high`; `w = 0` inside, `w >= 0` at `low` and `w <= 0` at `high`: a motor or a brake.
    Box {
        /// The least multiplier, zero or less, perhaps infinite.
        low: f64,
        /// The greatest multiplier, zero or more, perhaps infinite.
        high: f64,
    },
}

/// One row: a contact with its normal and tangent, or a single equation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeRow {
    /// The entries of the row, `entries.0..entries.1`.
    pub entries: (u32, u32),
    /// Its law.
    pub law: ConeLaw,
    /// `w` where nothing moves and no multiplier acts, normal and tangential.
    pub free: [f64; 2],
    /// How far the row gives way to its own multiplier, `dw/dp`, zero or more: a spring in series.
    pub give: [f64; 2],
    /// Multipliers that have acted already and are part of `r`; the law holds for the whole of `p + acted`.
    pub acted: [f64; 2],
    /// An estimate of the diagonal of `G A⁻¹ Gᵀ`, normal and tangential, good within some factor of ten. Zero, without
    /// `give`, says that nothing can move the row.
    pub scale: [f64; 2],
    /// The first diagonal of `G A⁻¹ Gᵀ` by the stiffest body that the row grips, if all of that was held but the grips: `Σ n²/A_ii` there. Several rows
    /// that hold a stiff body move next to nothing together, however far each of them would move all of it. Infinite where none is known.
    pub local: f64,
}

/// The problem; see the [module](super).
#[derive(Debug, Clone, Copy)]
pub struct ConeProblem<'a> {
    /// `A`, symmetric positive definite.
    pub matrix: &'a BlockMatrix,
    /// `r`, length `n_dofs`.
    pub load: &'a [f64],
    /// The rows of `G`.
    pub rows: &'a [ConeRow],
    /// The entries of all rows.
    pub entries: &'a [ConeEntry],
}

/// Why a problem could not be solved.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ConeError {
    /// A slice has not the length that the others ask for.
    #[error("{what} has {found} entries, give {expected}")]
    Length {
        /// The slice.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// An entry of the load is infinite or not a number.
    #[error("the load of dof {dof} is {value}: look for a state that has blown up")]
    Load {
        /// The dof.
        dof: usize,
        /// The entry.
        value: f64,
    },
    /// An entry of the matrix is infinite or not a number.
    #[error(
        "the matrix holds a number that is not finite in the row of node {node}: look for a state that has blown up"
    )]
    Matrix {
        /// The node.
        node: usize,
    },
    /// A number of a row is infinite or not a number, or `give` or `scale` is negative.
    #[error(
        "row {row} holds {value} as {what}: give a finite number, no negative give or scale, and a positive local"
    )]
    Row {
        /// The row.
        row: usize,
        /// Which of its numbers.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A row names entries or nodes that do not exist.
    #[error("row {row} names entry {entry}, which does not exist or names no node of the matrix")]
    Entry {
        /// The row.
        row: usize,
        /// The entry.
        entry: usize,
    },
    /// A coefficient of friction is negative or not finite.
    #[error(
        "row {row} has the coefficient of friction {coefficient}: give a finite one, zero or more"
    )]
    Friction {
        /// The row.
        row: usize,
        /// Its coefficient (-).
        coefficient: f64,
    },
    /// The bounds of a box row do not hold zero between them.
    #[error("box row {row} has the bounds [{low}, {high}]: give low <= 0 <= high")]
    Bounds {
        /// The row.
        row: usize,
        /// Its lower bound.
        low: f64,
        /// Its upper bound.
        high: f64,
    },
    /// The matrix has no factor.
    #[error("the matrix of the bodies has no factor: {0}")]
    Factor(#[from] CholeskyError),
}

impl ConeRow {
    /// Whether the row has a tangential component that can carry a force.
    pub(super) fn has_tangent(&self) -> bool {
        matches!(self.law, ConeLaw::Contact { friction } if friction > 0.0)
    }

    /// The coefficient of friction; zero on rows without friction.
    pub(super) fn friction(&self) -> f64 {
        match self.law {
            ConeLaw::Contact { friction } => friction,
            _ => 0.0,
        }
    }

    /// The bounds of the first component.
    pub(super) fn bounds(&self) -> (f64, f64) {
        match self.law {
            ConeLaw::Contact { .. } | ConeLaw::Unilateral => (0.0, f64::INFINITY),
            ConeLaw::Bilateral => (f64::NEG_INFINITY, f64::INFINITY),
            ConeLaw::Box { low, high } => (low, high),
        }
    }

    /// `acted` as far as the row has components.
    pub(super) fn acted(&self) -> [f64; 2] {
        match self.law {
            ConeLaw::Contact { .. } => self.acted,
            _ => [self.acted[0], 0.0],
        }
    }

    fn check(&self, row: usize) -> Result<(), ConeError> {
        let numbers = [
            ("free", self.free, false),
            ("acted", self.acted, false),
            ("give", self.give, true),
            ("scale", self.scale, true),
        ];
        for (what, pair, is_positive) in numbers {
            for value in pair {
                if !value.is_finite() || (is_positive && value < 0.0) {
                    return Err(ConeError::Row { row, what, value });
                }
            }
        }
        if self.local.is_nan() || self.local <= 0.0 {
            let (what, value) = ("local", self.local);
            return Err(ConeError::Row { row, what, value });
        }
        match self.law {
            ConeLaw::Contact { friction } if !(friction.is_finite() && friction >= 0.0) => {
                Err(ConeError::Friction {
                    row,
                    coefficient: friction,
                })
            }
            ConeLaw::Box { low, high } if !(low <= 0.0 && high >= 0.0) => {
                Err(ConeError::Bounds { row, low, high })
            }
            _ => Ok(()),
        }
    }
}

/// Whether all numbers are finite, told without a branch for each.
fn are_finite(values: &[f64]) -> bool {
    const EXPONENT: u64 = f64::INFINITY.to_bits();
    let exponents = values.iter().map(|value| value.to_bits() & EXPONENT);
    exponents.fold(true, |are, exponent| are & (exponent != EXPONENT))
}

/// `G x` of the row with these entries.
pub(super) fn motion(entries: &[ConeEntry], x: &[f64]) -> [f64; 2] {
    let mut motion = [0.0; 2];
    for entry in entries {
        let dofs = &x[2 * entry.node as usize..][..2];
        motion[0] += entry.normal[0] * dofs[0] + entry.normal[1] * dofs[1];
        motion[1] += entry.tangent[0] * dofs[0] + entry.tangent[1] * dofs[1];
    }
    motion
}

impl<'a> ConeProblem<'a> {
    /// Checks every number once, so that the solvers need not.
    pub(super) fn check(&self) -> Result<(), ConeError> {
        let n_dofs = self.matrix.n_dofs();
        if self.load.len() != n_dofs {
            return Err(ConeError::Length {
                what: "the load",
                found: self.load.len(),
                expected: n_dofs,
            });
        }
        let mut load = self.load.iter().enumerate();
        if !are_finite(self.load)
            && let Some((dof, &value)) = load.find(|(_, value)| !value.is_finite())
        {
            return Err(ConeError::Load { dof, value });
        }
        let is_finite = |node: &usize| are_finite(self.matrix.row_blocks(*node).as_flattened());
        let mut nodes = 0..self.matrix.n_nodes();
        if !are_finite(self.matrix.blocks().as_flattened())
            && let Some(node) = nodes.find(|node| !is_finite(node))
        {
            return Err(ConeError::Matrix { node });
        }
        for (row, data) in self.rows.iter().enumerate() {
            data.check(row)?;
            self.check_entries(row, data)?;
        }
        Ok(())
    }

    fn check_entries(&self, row: usize, data: &ConeRow) -> Result<(), ConeError> {
        let (start, end) = (data.entries.0 as usize, data.entries.1 as usize);
        let entries = self
            .entries
            .get(start..end)
            .ok_or(ConeError::Entry { row, entry: end })?;
        for (k, entry) in entries.iter().enumerate() {
            if entry.node as usize >= self.matrix.n_nodes() {
                return Err(ConeError::Entry {
                    row,
                    entry: start + k,
                });
            }
            for value in entry.normal.into_iter().chain(entry.tangent) {
                if !value.is_finite() {
                    return Err(ConeError::Row {
                        row,
                        what: "a coefficient",
                        value,
                    });
                }
            }
        }
        Ok(())
    }

    /// The entries of one row.
    pub(super) fn entries_of(&self, row: &ConeRow) -> &'a [ConeEntry] {
        &self.entries[row.entries.0 as usize..row.entries.1 as usize]
    }

    /// `G x` of one row.
    pub fn motion(&self, row: &ConeRow, x: &[f64]) -> [f64; 2] {
        motion(self.entries_of(row), x)
    }

    /// Adds `factor Gᵀ P` of one row to `out`.
    pub(super) fn push(&self, row: &ConeRow, factor: f64, force: [f64; 2], out: &mut [f64]) {
        if force == [0.0; 2] {
            return;
        }
        let force = force.map(|value| factor * value);
        for entry in self.entries_of(row) {
            let dofs = &mut out[2 * entry.node as usize..][..2];
            for (k, dof) in dofs.iter_mut().enumerate() {
                *dof += entry.normal[k] * force[0] + entry.tangent[k] * force[1];
            }
        }
    }
}
