//! The one judge of every answer: the natural map `p_i - proj_i(p_i - w_i / W_ii)`, zero exactly at a solution.

use super::give::{INDEPENDENT, give};
use super::problem::{Checked, Problem};

/// The natural-map residual of `multipliers`, free of units.
///
/// `max_i sqrt(W_ii) |p_i - proj_i(p_i - w_i / W_ii)|`, where `proj_i` is the projection on the
/// multipliers that the law of row `i` admits (for friction, at the present normal multiplier), divided by the largest
/// `|b_i| / sqrt(W_ii)` or `sqrt(W_ii) |p_i|`. Multipliers count up to a thousand times what acts (`b`, and multipliers that the laws
/// ask for at least): those that grow beyond all bounds make no answer of what they leave in motion. The weight `sqrt(W_ii)` makes each term the
/// square root of an energy, so that rows may differ in unit and mass. The residual does not change under
/// `W -> s W`, `b -> r b`, nor under a change of the unit of one row. Rows that nothing can move must carry
/// the admissible multiplier nearest to zero.
///
/// - `multipliers`: `p`, shape `(n)`.
///
/// Infinite if the problem or the multipliers are not finite, or if a friction row is not paired.
///
/// # Panics
/// If the shapes do not agree.
pub fn natural_map_residual(problem: &Problem, multipliers: &[f64]) -> f64 {
    assert_eq!(
        multipliers.len(),
        problem.rows.len(),
        "give one multiplier per row"
    );
    match problem.check() {
        Ok(checked) => {
            measure(checked, multipliers, |row| {
                checked.velocity(row, multipliers)
            })
            .residual
        }
        Err(_) => f64::INFINITY,
    }
}

/// A residual, and the sizes that it comes from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    /// The natural-map residual (-).
    pub residual: f64,
    /// The largest of what acts and of the multipliers, in square roots of energy; zero if nothing acts.
    pub scale: f64,
    /// What acts, in square roots of energy.
    pub given: f64,
    /// The row with the largest term.
    pub worst_row: usize,
}

impl Measure {
    /// Whether the multipliers are those of a problem that has an answer: rows that contradict each other ask for any, and more than rows would that
    /// gave way, see [`give`].
    pub fn is_moderate(&self) -> bool {
        self.scale * give(INDEPENDENT) <= self.given
    }
}

/// Measures the natural map of `multipliers`, given the velocity `w_i` of each row.
pub(super) fn measure(
    problem: Checked,
    multipliers: &[f64],
    velocity: impl Fn(usize) -> f64,
) -> Measure {
    let (mut largest, mut carried, mut given, mut worst_row) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    let mut idle = true;
    for row in 0..problem.n_rows() {
        let multiplier = multipliers[row];
        if !problem.is_movable(row) {
            idle &= multiplier == problem.idle_multiplier(row);
            continue;
        }
        let diagonal = problem.diagonal(row);
        let weight = diagonal.sqrt();
        let normal = problem.normal_multiplier(row, multipliers);
        let moved = multiplier - velocity(row) / diagonal;
        let term = weight * (multiplier - problem.project(row, moved, normal)).abs();
        // `f64::max` would pass over a NaN
        if !term.is_finite() || !multiplier.is_finite() {
            return Measure {
                residual: f64::INFINITY,
                scale: f64::INFINITY,
                given: 0.0,
                worst_row: row,
            };
        }
        if term > largest {
            (largest, worst_row) = (term, row);
        }
        carried = carried.max(weight * multiplier.abs());
        given = given
            .max(weight * problem.idle_multiplier(row).abs())
            .max(problem.free[row].abs() / weight);
    }
    let residual = match (idle, largest > 0.0) {
        (false, _) => f64::INFINITY,
        (true, false) => 0.0,
        (true, true) => largest / given.max(carried.min(given / give(INDEPENDENT))),
    };
    Measure {
        residual,
        scale: carried.max(given),
        given,
        worst_row,
    }
}
