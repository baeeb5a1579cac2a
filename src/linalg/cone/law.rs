//! The projection on what a law admits: the solution of `w + M P ∋ b` for one row, and its slope.
//!
//! With `P` in the cone `|P_t| <= mu P_n` and `w` in its dual, the answer is `M⁻¹ b` if that lies in the cone, the
//! nearest point of the ray `(1, ± mu)` in the norm of `M` if `b` lies beyond it, else zero.

use super::problem::ConeRow;

/// Where a row stands in its law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ConeStatus {
    /// No multiplier: an open contact or stop, or a row that nothing can move.
    #[default]
    Open,
    /// `w = 0`: a sticking contact, one without friction that presses, a tie, or a box row between its bounds.
    Stick,
    /// `P_t = mu P_n`, or the upper bound of a box row; the row slips with `w <= 0`.
    SlipPositive,
    /// `P_t = -mu P_n`, or the lower bound of a box row; the row slips with `w >= 0`.
    SlipNegative,
}

/// Solves for the multiplier of one row.
///
/// - `b`: what the row asks for, `M P - w`.
/// - `metric`: the diagonal of `M`, positive.
#[inline]
pub(super) fn project(row: &ConeRow, b: [f64; 2], metric: [f64; 2]) -> ([f64; 2], ConeStatus) {
    let mu = row.friction();
    let x = [b[0] / metric[0], b[1] / metric[1]];
    if !row.has_tangent() {
        let (low, high) = row.bounds();
        return if x[0] > low && x[0] < high {
            ([x[0], 0.0], ConeStatus::Stick)
        } else if x[0] >= high {
            ([high, 0.0], ConeStatus::SlipPositive)
        } else if low < 0.0 {
            ([low, 0.0], ConeStatus::SlipNegative)
        } else {
            ([0.0; 2], ConeStatus::Open)
        };
    }
    if x[1].abs() <= mu * x[0] {
        return (x, ConeStatus::Stick);
    }
    let along = (b[0] + mu * b[1].abs()) / (metric[0] + mu * mu * metric[1]);
    if along <= 0.0 {
        ([0.0; 2], ConeStatus::Open)
    } else if b[1] > 0.0 {
        ([along, mu * along], ConeStatus::SlipPositive)
    } else {
        ([along, -mu * along], ConeStatus::SlipNegative)
    }
}

/// `dP/db` of [`project`], symmetric: `[nn, nt, tt]`.
#[inline]
pub(super) fn slope(row: &ConeRow, status: ConeStatus, metric: [f64; 2]) -> [f64; 3] {
    let mu = row.friction();
    let ray = |sign: f64| {
        let weight = 1.0 / (metric[0] + mu * mu * metric[1]);
        [weight, sign * mu * weight, mu * mu * weight]
    };
    match (status, row.has_tangent()) {
        (ConeStatus::Stick, true) => [1.0 / metric[0], 0.0, 1.0 / metric[1]],
        (ConeStatus::Stick, false) => [1.0 / metric[0], 0.0, 0.0],
        (ConeStatus::SlipPositive, true) => ray(1.0),
        (ConeStatus::SlipNegative, true) => ray(-1.0),
        _ => [0.0; 3],
    }
}
