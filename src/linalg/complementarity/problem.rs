//! The problem as data: `w = W p + b` and, on every row, a law between `p_i` and `w_i`.

use crate::math::rounding;
use thiserror::Error;

/// Diagonal entries below this fraction of the largest one belong to rows that nothing can move.
const IMMOVABLE: f64 = rounding::SQUARE;

/// The law of one row, between its multiplier `p_i` and its velocity `w_i = (W p + b)_i`.
///
/// All but the first two read "`p_i` stays within its bounds, `w_i = 0` inside them, `w_i <= 0` at the
/// upper and `w_i >= 0` at the lower one": the multiplier opposes the motion it does not prevent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowKind {
    /// `w_i = 0`, any multiplier: a joint or a tie.
    Bilateral,
    /// `0 <= p_i`, `0 <= w_i`, `p_i w_i = 0`: a contact that pushes and never pulls.
    Unilateral,
    /// Coulomb friction: `|p_i| <= mu p_n`.
    Friction {
        /// The row of the contact's normal multiplier `p_n`; its kind must be [`RowKind::Unilateral`].
        normal: usize,
        /// The coefficient of friction `mu` (-), zero or more.
        coefficient: f64,
    },
    /// Constant bounds `low <= p_i <= high`, each of which may be infinite: a motor or a limit.
    Box {
        /// The least multiplier.
        low: f64,
        /// The greatest multiplier.
        high: f64,
    },
}

/// Where a row stands in its law; the warm start of the next solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Status {
    /// No multiplier: an open contact, its friction row, friction without a coefficient, or a row that
    /// nothing can move.
    #[default]
    Open,
    /// `w_i = 0`: a tied, closed or sticking row, or a box row strictly between its bounds.
    Stick,
    /// `p_i` is at its upper bound (`mu p_n` or `high`) and `w_i <= 0`.
    SlipPositive,
    /// `p_i` is at its lower bound (`-mu p_n` or `low`) and `w_i >= 0`.
    SlipNegative,
}

/// Find `p` with `w = W p + b` such that every row obeys its law.
///
/// Units are the caller's. If `p` is an impulse (N s) and `w` a velocity (m/s), `W` is in 1/kg.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// The Delassus matrix `W`, row-major, symmetric positive semidefinite, shape `(n, n)`.
    pub delassus: &'a [f64],
    /// The velocity `b` that the rows would have without multipliers, shape `(n)`.
    pub free: &'a [f64],
    /// The law of each row, shape `(n)`.
    pub rows: &'a [RowKind],
    /// Multipliers that have acted already, and are part of `b`, shape `(n)`, or empty if there are none. Contacts and
    /// friction obey their laws with the whole of `p + acted`; bounds of a [`RowKind::Box`] hold for `p`.
    pub acted: &'a [f64],
}

/// Data that states no problem.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ComplementarityError {
    /// An entry of `W` is infinite or not a number.
    #[error(
        "the Delassus matrix holds {value} at ({row}, {column}): look for a singular effective matrix"
    )]
    Delassus {
        /// The row of the entry.
        row: usize,
        /// The column of the entry.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// An entry of `b` is infinite or not a number.
    #[error("the free velocity of row {row} is {value}: look for a state that has blown up")]
    Free {
        /// The row.
        row: usize,
        /// The entry.
        value: f64,
    },
    /// The normal row of a friction row does not exist or is not unilateral.
    #[error("friction row {row} names row {normal} as its normal: name a unilateral row")]
    Normal {
        /// The friction row.
        row: usize,
        /// The row it names.
        normal: usize,
    },
    /// A coefficient of friction is negative or not finite.
    #[error(
        "friction row {row} has the coefficient {coefficient}: give a finite one, zero or more"
    )]
    Coefficient {
        /// The friction row.
        row: usize,
        /// Its coefficient (-).
        coefficient: f64,
    },
    /// The bounds of a box row leave no finite multiplier.
    #[error("box row {row} has the bounds [{low}, {high}]: give low <= high")]
    Bounds {
        /// The box row.
        row: usize,
        /// Its lower bound.
        low: f64,
        /// Its upper bound.
        high: f64,
    },
}

impl<'a> Problem<'a> {
    /// Checks every number once, so that the solvers need not.
    ///
    /// # Panics
    /// If the shapes of the slices do not agree.
    pub(super) fn check(&self) -> Result<Checked<'a>, ComplementarityError> {
        let n = self.rows.len();
        assert_eq!(
            self.free.len(),
            n,
            "a problem needs one free velocity per row"
        );
        assert_eq!(
            self.delassus.len(),
            n * n,
            "a problem of {n} rows needs an n x n matrix"
        );
        assert!(
            self.acted.is_empty() || self.acted.len() == n,
            "a problem needs no acted multipliers or one per row"
        );
        if let Some(entry) = self.delassus.iter().position(|value| !value.is_finite()) {
            let (row, column, value) = (entry / n, entry % n, self.delassus[entry]);
            return Err(ComplementarityError::Delassus { row, column, value });
        }
        for (row, &value) in self.free.iter().enumerate() {
            if !value.is_finite() {
                return Err(ComplementarityError::Free { row, value });
            }
        }
        for row in 0..n {
            self.check_kind(row)?;
        }
        let largest = (0..n)
            .map(|row| self.delassus[row * n + row])
            .fold(0.0, f64::max);
        Ok(Checked {
            delassus: self.delassus,
            free: self.free,
            rows: self.rows,
            acted: self.acted,
            floor: IMMOVABLE * largest,
        })
    }

    fn check_kind(&self, row: usize) -> Result<(), ComplementarityError> {
        match self.rows[row] {
            RowKind::Bilateral | RowKind::Unilateral => Ok(()),
            RowKind::Friction {
                normal,
                coefficient,
            } => {
                if self.rows.get(normal) != Some(&RowKind::Unilateral) {
                    Err(ComplementarityError::Normal { row, normal })
                } else if !(coefficient.is_finite() && coefficient >= 0.0) {
                    Err(ComplementarityError::Coefficient { row, coefficient })
                } else {
                    Ok(())
                }
            }
            RowKind::Box { low, high } => {
                if low <= high && low < f64::INFINITY && high > f64::NEG_INFINITY {
                    Ok(())
                } else {
                    Err(ComplementarityError::Bounds { row, low, high })
                }
            }
        }
    }
}

/// A problem whose numbers are known to be finite and whose friction rows are known to be paired.
#[derive(Debug, Clone, Copy)]
pub(super) struct Checked<'a> {
    pub delassus: &'a [f64],
    pub free: &'a [f64],
    pub rows: &'a [RowKind],
    acted: &'a [f64],
    /// Diagonal entries up to this value mean an immovable row.
    floor: f64,
}

impl<'a> Checked<'a> {
    /// The problem of these numbers, of the same shape, with the same laws.
    pub fn with<'b>(&self, delassus: &'b [f64], free: &'b [f64]) -> Checked<'b>
    where
        'a: 'b,
    {
        Checked {
            delassus,
            free,
            ..*self
        }
    }

    pub fn has_friction(&self) -> bool {
        let is_friction = |kind: &RowKind| matches!(kind, RowKind::Friction { .. });
        self.rows.iter().any(is_friction)
    }

    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    pub fn row(&self, row: usize) -> &'a [f64] {
        let n = self.rows.len();
        &self.delassus[row * n..(row + 1) * n]
    }

    pub fn diagonal(&self, row: usize) -> f64 {
        self.delassus[row * self.rows.len() + row]
    }

    pub fn is_movable(&self, row: usize) -> bool {
        self.diagonal(row) > self.floor
    }

    /// `w_i`, at the cost of one row of the matrix.
    #[inline(always)]
    pub fn velocity(&self, row: usize, multipliers: &[f64]) -> f64 {
        super::dense::dot(self.row(row), multipliers) + self.free[row]
    }

    /// What has acted already of a contact's or friction's multiplier.
    pub fn acted(&self, row: usize) -> f64 {
        match self.rows[row] {
            RowKind::Unilateral | RowKind::Friction { .. } => {
                self.acted.get(row).copied().unwrap_or(0.0)
            }
            RowKind::Bilateral | RowKind::Box { .. } => 0.0,
        }
    }

    /// The admissible multiplier nearest to `value`, friction bounds taken from the whole `normal_multiplier`.
    pub fn project(&self, row: usize, value: f64, normal_multiplier: f64) -> f64 {
        let acted = self.acted(row);
        match self.rows[row] {
            RowKind::Bilateral => value,
            RowKind::Unilateral => value.max(0.0 - acted),
            RowKind::Friction { coefficient, .. } => {
                let bound = coefficient * normal_multiplier.max(0.0);
                value.max(-bound - acted).min(bound - acted)
            }
            RowKind::Box { low, high } => value.max(low).min(high),
        }
    }

    /// The whole multiplier of the normal row of a friction row; zero for any other row.
    pub fn normal_multiplier(&self, row: usize, multipliers: &[f64]) -> f64 {
        match self.rows[row] {
            RowKind::Friction { normal, .. } => multipliers[normal] + self.acted(normal),
            _ => 0.0,
        }
    }

    /// The multiplier of a row that nothing can move: the admissible one nearest to zero.
    pub fn idle_multiplier(&self, row: usize) -> f64 {
        self.project(row, 0.0, 0.0)
    }

    /// The coefficient of friction and the normal row, if the row can carry friction at all.
    pub fn friction(&self, row: usize) -> Option<(usize, f64)> {
        match self.rows[row] {
            RowKind::Friction {
                normal,
                coefficient,
            } if coefficient > 0.0 && self.is_movable(row) && self.is_movable(normal) => {
                Some((normal, coefficient))
            }
            _ => None,
        }
    }
}
