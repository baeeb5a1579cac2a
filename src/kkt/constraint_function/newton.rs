//! A Newton step of the constraint functions on `w = W p + b`, with a line search along it.
//!
//! Unknowns are `p/F` in rows of gaps and `τ` in rows of friction, where the multiplier is `-μ p τ`.

use super::functions::{Value, normal, tangential};
use crate::linalg::complementarity::{Problem, RowKind, solve_lu_in_place};
use crate::math::rounding;

/// Least `|∂w/∂λ|` and `|∂v/∂τ|` in the Jacobian: redundant rows (a rigid box on four points) have a singular `W` and share
/// their load as it is. It changes steps by this share, and no solution.
const FLOOR: f64 = rounding::ITERATED;

/// Loss of size of a pivot at which the Jacobian counts as singular.
const SINGULAR: f64 = rounding::SQUARE;

/// Halvings of a step.
const MOST_HALVINGS: usize = 12;

/// Share of the decrease promised by the slope that a step has to bring (Armijo).
const DECREASE: f64 = 1e-4;

/// What lengths and forces are divided by, and the rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::kkt) struct Scale {
    /// `ℓ` (m).
    pub length: f64,
    /// `F` (N).
    pub force: f64,
    /// What a multiplier moves, over `W` (s²).
    pub b0: f64,
    /// `[ε_N, ε_T]` (-).
    pub epsilon: [f64; 2],
}

impl Scale {
    /// The scale of a problem: what contact has to prevent, but no less than `least` (m).
    pub fn of(problem: &Problem<'_>, b0: f64, least: f64, epsilon: [f64; 2]) -> Self {
        let n = problem.rows.len();
        let (mut length, mut mobility) = (least, 0.0f64);
        for (row, kind) in problem.rows.iter().enumerate() {
            let free = b0 * problem.free[row];
            length = length.max(match kind {
                RowKind::Unilateral => -free,
                _ => free.abs(),
            });
            mobility = mobility.max(problem.delassus[row * n + row]);
        }
        // Without mobility no force moves anything.
        let force = if mobility > 0.0 {
            length / (b0 * mobility)
        } else {
            1.0
        };
        Self {
            length,
            force,
            b0,
            epsilon,
        }
    }
}

/// Buffers of the iterations.
#[derive(Debug, Default)]
pub(in crate::kkt) struct Newton {
    /// `p/F` and `τ` of each row.
    unknowns: Vec<f64>,
    trial: Vec<f64>,
    values: Vec<Value>,
    forces: Vec<f64>,
    jacobian: Vec<f64>,
    step: Vec<f64>,
    column_size: Vec<f64>,
}

impl Newton {
    /// Takes the multipliers (N) as the iterate.
    pub fn start(&mut self, rows: &[RowKind], multipliers: &[f64], scale: &Scale) {
        self.unknowns.clear();
        for (row, kind) in rows.iter().enumerate() {
            self.unknowns.push(match *kind {
                RowKind::Friction {
                    normal,
                    coefficient,
                } => {
                    let limit = coefficient * multipliers[normal];
                    if limit > 0.0 {
                        (-multipliers[row] / limit).clamp(-1.0, 1.0)
                    } else {
                        0.0
                    }
                }
                _ => multipliers[row] / scale.force,
            });
        }
    }

    /// The ratio `τ`, or `p/F`, of a row.
    pub fn unknown(&self, row: usize) -> f64 {
        self.unknowns[row]
    }

    /// The largest `|w|`, `|v|` of the iterate where the rows have moved by `b0 motion` (m).
    pub fn residual(&mut self, rows: &[RowKind], motion: &[f64], scale: &Scale) -> f64 {
        let along = |row: usize| scale.b0 * motion[row] / scale.length;
        let values =
            (0..rows.len()).map(|row| value(&rows[row], along(row), self.unknowns[row], scale));
        values.fold(0.0f64, |worst, value| {
            // `max` would pass over a NaN.
            if value.value.abs() <= worst {
                worst
            } else {
                value.value.abs()
            }
        })
    }

    /// One Newton step; overwrites the multipliers (N). False if the Jacobian is singular.
    pub fn advance(
        &mut self,
        problem: &Problem<'_>,
        scale: &Scale,
        searches: bool,
        multipliers: &mut [f64],
    ) -> bool {
        let n = problem.rows.len();
        let before = self.evaluate(problem, scale, None);
        self.linearize(problem, scale);
        self.step.clear();
        self.step
            .extend(self.values.iter().map(|value| -value.value));
        self.column_size.resize(n, 0.0);
        if !solve_lu_in_place(
            &mut self.jacobian,
            &mut self.step,
            &mut self.column_size,
            SINGULAR,
        ) {
            return false;
        }
        let mut share = 1.0;
        if searches {
            let mut best = (f64::INFINITY, 1.0);
            for _ in 0..MOST_HALVINGS {
                let merit = self.evaluate(problem, scale, Some(share));
                if merit < best.0 {
                    best = (merit, share);
                }
                if merit <= (1.0 - 2.0 * DECREASE * share) * before {
                    break;
                }
                share *= 0.5;
            }
            share = best.1;
        }
        self.move_by(problem.rows, share);
        std::mem::swap(&mut self.unknowns, &mut self.trial);
        forces(problem.rows, &self.unknowns, scale.force, multipliers);
        true
    }

    /// Puts the iterate, moved by a share of the step, in `trial`: no contact pulls, and friction keeps to its limit.
    fn move_by(&mut self, rows: &[RowKind], share: f64) {
        self.trial.clear();
        for (row, kind) in rows.iter().enumerate() {
            let moved = self.unknowns[row] + share * self.step[row];
            self.trial.push(match kind {
                RowKind::Friction { .. } => moved.clamp(-1.0, 1.0),
                _ => moved.max(0.0),
            });
        }
    }

    /// Sum of squares of `w` and `v` of the iterate, or of it moved by a share of the step; the iterate's values are kept.
    fn evaluate(&mut self, problem: &Problem<'_>, scale: &Scale, share: Option<f64>) -> f64 {
        match share {
            Some(share) => self.move_by(problem.rows, share),
            None => self.trial.clone_from(&self.unknowns),
        }
        let n = problem.rows.len();
        self.forces.resize(n, 0.0);
        forces(problem.rows, &self.trial, scale.force, &mut self.forces);
        if share.is_none() {
            self.values.clear();
        }
        let mut sum = 0.0;
        for (row, kind) in problem.rows.iter().enumerate() {
            let line = &problem.delassus[row * n..(row + 1) * n];
            let moved: f64 = line.iter().zip(&self.forces).map(|(w, p)| w * p).sum();
            let along = scale.b0 * (moved + problem.free[row]) / scale.length;
            let value = value(kind, along, self.trial[row], scale);
            sum += value.value * value.value;
            if share.is_none() {
                self.values.push(value);
            }
        }
        sum
    }

    /// The Jacobian by the unknowns, from the values of the iterate.
    fn linearize(&mut self, problem: &Problem<'_>, scale: &Scale) {
        let n = problem.rows.len();
        let moves = scale.b0 * scale.force / scale.length;
        self.jacobian.clear();
        for (row, value) in self.values.iter().enumerate() {
            let line = &problem.delassus[row * n..(row + 1) * n];
            let slope = value.by_motion * moves;
            self.jacobian.extend(line.iter().map(|w| slope * w));
            let own = &mut self.jacobian[row * n..];
            for (column, kind) in problem.rows.iter().enumerate() {
                if let RowKind::Friction {
                    normal,
                    coefficient,
                } = *kind
                {
                    // t = -μ p τ
                    let by_friction = -coefficient * own[column];
                    own[normal] += self.unknowns[column] * by_friction;
                    own[column] = self.unknowns[normal] * by_friction;
                }
            }
            own[row] += value
                .by_multiplier
                .abs()
                .max(FLOOR)
                .copysign(value.by_multiplier);
        }
    }
}

fn value(kind: &RowKind, motion: f64, unknown: f64, scale: &Scale) -> Value {
    match kind {
        RowKind::Friction { .. } => tangential(motion, unknown, scale.epsilon[1]),
        _ => normal(motion, unknown, scale.epsilon[0]),
    }
}

/// Multipliers (N) of the unknowns.
fn forces(rows: &[RowKind], unknowns: &[f64], force: f64, multipliers: &mut [f64]) {
    for (row, kind) in rows.iter().enumerate() {
        multipliers[row] = match *kind {
            RowKind::Friction {
                normal,
                coefficient,
            } => -coefficient * unknowns[normal] * force * unknowns[row],
            _ => unknowns[row] * force,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two contacts with friction of a body that couples them.
    const DELASSUS: [f64; 16] = [
        2.0, 0.3, 0.5, 0.1, //
        0.3, 1.5, -0.2, 0.4, //
        0.5, -0.2, 1.8, 0.2, //
        0.1, 0.4, 0.2, 1.2,
    ];
    const ROWS: [RowKind; 4] = [
        RowKind::Unilateral,
        RowKind::Friction {
            normal: 0,
            coefficient: 0.4,
        },
        RowKind::Unilateral,
        RowKind::Friction {
            normal: 2,
            coefficient: 0.3,
        },
    ];

    fn problem(free: &[f64; 4]) -> Problem<'_> {
        Problem {
            delassus: &DELASSUS,
            free,
            rows: &ROWS,
            acted: &[],
        }
    }

    #[test]
    fn the_jacobian_is_the_slope_of_the_functions() {
        let free = [-1.0, 0.4, -0.6, -0.1];
        let problem = problem(&free);
        let scale = Scale::of(&problem, 0.01, 1e-9, [1e-2, 0.3]);
        let start = [0.7, 0.3, 0.4, -0.6];
        let values_at = |unknowns: [f64; 4]| {
            let mut newton = Newton {
                unknowns: unknowns.to_vec(),
                ..Newton::default()
            };
            newton.evaluate(&problem, &scale, None);
            newton.linearize(&problem, &scale);
            newton
        };
        let exact = values_at(start);
        let h = 1e-6;
        for column in 0..4 {
            let shifted = |sign: f64| {
                let mut unknowns = start;
                unknowns[column] += sign * h;
                values_at(unknowns).values
            };
            let (above, below) = (shifted(1.0), shifted(-1.0));
            for row in 0..4 {
                let slope = (above[row].value - below[row].value) / (2.0 * h);
                let entry = exact.jacobian[4 * row + column];
                // Central differences of functions that bend over 0.1: h²/6 times 1e3, and rounding over h.
                assert!(
                    (entry - slope).abs() < 1e-8,
                    "({row}, {column}): {entry}, not {slope}"
                );
            }
        }
    }

    #[test]
    fn newtons_iterations_end_where_the_laws_hold() {
        // One contact sticks, one slides.
        let free = [-1.0, 0.2, -0.6, 3.0];
        let problem = problem(&free);
        let scale = Scale::of(&problem, 0.01, 1e-9, [1e-12, 1e-9]);
        let (mut newton, mut multipliers) = (Newton::default(), [0.0; 4]);
        newton.start(&ROWS, &multipliers, &scale);
        let mut n_iterations = 0;
        while n_iterations < 20 {
            assert!(newton.advance(&problem, &scale, true, &mut multipliers));
            n_iterations += 1;
            if newton.evaluate(&problem, &scale, None) < 1e-24 {
                break;
            }
        }
        assert!(n_iterations <= 8, "{n_iterations} iterations");
        let motion = |row: usize| {
            let moved: f64 = (0..4).map(|k| DELASSUS[4 * row + k] * multipliers[k]).sum();
            moved + free[row]
        };
        // g p = eps_N and the slip of sticking, both of the order of rounding.
        assert!(motion(0).abs() < 1e-9 && motion(2).abs() < 1e-9);
        let ratio = -multipliers[1] / (0.4 * multipliers[0]);
        let slips = 1e-9 * (0.5 * std::f64::consts::PI * ratio).tan() * scale.length / scale.b0;
        // The residual allows 1e-12 of `length / b0`, and the ratio's rounding is stretched a thousandfold.
        assert!(
            ratio < 0.999 && (motion(1) - slips).abs() < 1e-10,
            "slips by {}, not {slips}",
            motion(1)
        );
        assert!(
            (multipliers[3] + 0.3 * multipliers[2]).abs() < 1e-7 * multipliers[2],
            "slides at the limit"
        );
        assert!(motion(3) > 0.0 && multipliers[1].abs() < 0.4 * multipliers[0]);
    }
}
