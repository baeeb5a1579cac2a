//! Reading, repairing and comparing statuses: which piece of its law, `p_i = proj_i(p_i - c w_i / W_ii)`, `c > 0`,
//! a row is on, with the whole of its multiplier.

use super::problem::{Checked, RowKind, Status};

/// Reads the statuses from `p_i - c w_i / W_ii`, with the `weight` `c` and `p_i` with what has acted; true if one of them changed.
///
/// A status is kept while it is wrong by less than `slack` (in square roots of energy, as in
/// [`Measure::scale`](super::residual::Measure::scale)): round-off must not open and close contacts that carry nothing.
pub(super) fn identify(
    problem: Checked,
    multipliers: &[f64],
    velocity: impl Fn(usize) -> f64,
    (slack, weight): (f64, f64),
    status: &mut [Status],
) -> bool {
    let moved = |row: usize| {
        let step = weight * velocity(row) / problem.diagonal(row);
        multipliers[row] + problem.acted(row) - step
    };
    let mut changed = false;
    // friction last: whether it can act depends on the new status of its normal
    for friction_pass in [false, true] {
        for row in 0..problem.n_rows() {
            let is_friction = matches!(problem.rows[row], RowKind::Friction { .. });
            if is_friction != friction_pass || !problem.is_movable(row) {
                continue;
            }
            let slack = slack / problem.diagonal(row).sqrt();
            let next = match problem.rows[row] {
                RowKind::Bilateral => Status::Stick,
                RowKind::Unilateral => {
                    let margin = if status[row] == Status::Open {
                        slack
                    } else {
                        -slack
                    };
                    if moved(row) > margin {
                        Status::Stick
                    } else {
                        Status::Open
                    }
                }
                RowKind::Box { low, high } => between(moved(row), low, high, slack, status[row]),
                RowKind::Friction { .. } => match problem.friction(row) {
                    Some((normal, coefficient)) if status[normal] != Status::Open => {
                        let bound = coefficient * moved(normal).max(0.0);
                        between(moved(row), -bound, bound, slack, status[row])
                    }
                    _ => Status::Open,
                },
            };
            changed |= next != status[row];
            status[row] = next;
        }
    }
    changed
}

/// Lets every contact that presses, has pressed, or would meet, slide as it does without multipliers; whether there is friction.
pub(super) fn slide(problem: Checked, status: &mut [Status]) -> bool {
    for (row, at) in status.iter_mut().enumerate() {
        let presses = problem.free[row] < 0.0 || problem.acted(row) > 0.0;
        match problem.rows[row] {
            RowKind::Unilateral if presses => *at = Status::Stick,
            RowKind::Friction { .. } if problem.free[row] > 0.0 => *at = Status::SlipNegative,
            RowKind::Friction { .. } => *at = Status::SlipPositive,
            _ => {}
        }
    }
    make_admissible(problem, status);
    problem.has_friction()
}

/// Where `value` lies with respect to its bounds, in favour of the present status.
fn between(value: f64, low: f64, high: f64, slack: f64, present: Status) -> Status {
    let margin = |slipping: Status| if present == slipping { -slack } else { slack };
    if value > high + margin(Status::SlipPositive) {
        Status::SlipPositive
    } else if value < low - margin(Status::SlipNegative) {
        Status::SlipNegative
    } else {
        Status::Stick
    }
}

/// Replaces statuses that the kind of their row does not know.
pub(super) fn make_admissible(problem: Checked, status: &mut [Status]) {
    for row in 0..problem.n_rows() {
        let given = status[row];
        status[row] = match problem.rows[row] {
            _ if !problem.is_movable(row) => Status::Open,
            RowKind::Bilateral => Status::Stick,
            RowKind::Unilateral if given != Status::Open => Status::Stick,
            RowKind::Unilateral => Status::Open,
            RowKind::Box { low, high } => match given {
                Status::SlipPositive if high < f64::INFINITY => given,
                Status::SlipNegative if low > f64::NEG_INFINITY => given,
                _ => Status::Stick,
            },
            RowKind::Friction { .. } => match problem.friction(row) {
                Some((normal, _)) if status[normal] != Status::Open => match given {
                    Status::Open => Status::Stick,
                    _ => given,
                },
                _ => Status::Open,
            },
        };
    }
}

/// A hash of the statuses (FNV-1a), by which a cycle is recognized.
pub(super) fn fingerprint(status: &[Status]) -> u64 {
    status.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &status| {
        (hash ^ status as u64).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
