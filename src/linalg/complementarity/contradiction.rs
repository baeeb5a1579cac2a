//! Rows that contradict each other: a body between two that are driven together, joints that cannot all hold.
//!
//! Such rows have no multipliers, and what looks for them follows a ray on which they grow beyond all bounds. Where all rows give way a little, what is
//! asked for is met where it can be, and elsewhere in the mean. Laws that take energy (all but those with a velocity of rebound in `b`) take
//! it then too: `p·(b + W p / 2) <= 0`.

use super::active_set::{GOOD, Redundancy};
use super::dense::dot;
use super::give::{INDEPENDENT, approach, give};
use super::problem::{Checked, RowKind, Status};
use super::residual::measure;
use super::{Answer, LAST, NEAR, Outcome, PATHS, Solver};

/// Steps at most: halvings of either of two numbers, which rounding ends before that.
const MOST_STEPS: usize = 100;

/// Buffers of a problem whose rows give way.
#[derive(Debug, Clone, Default)]
pub(super) struct Softened {
    delassus: Vec<f64>,
    free: Vec<f64>,
    multipliers: Vec<f64>,
    status: Vec<Status>,
    /// The best answers: of the problem as it is, and of the rows that give way.
    found: Answer,
    compromise: Answer,
}

/// What comes of steps that give way to less and less.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Course {
    /// They end in an answer.
    Arrives,
    /// They go on in multipliers that move nothing: rows contradict each other, and what is missed is in the mean the least (Pazy 1971).
    Contradicts,
    /// A step has not been found, or neither it nor what it moves was less than half of the one before, or there is no end of them.
    Fails,
}

impl Solver {
    /// Lets all rows of a problem give way that has not been solved, and makes what is found so the best answer, unless there is a moderate one that
    /// misses less than half of it.
    ///
    /// Frictionless rows that contradict each other have no answer. Others may have one that slides, where those of rows that give way jam: it is looked
    /// for once more, but for sweeps, which grow along what jams.
    pub(super) fn give_way(&mut self, problem: Checked, outcome: &mut Outcome) {
        let mut softened = std::mem::take(&mut self.softened);
        softened.soften(problem);
        std::mem::swap(&mut self.best, &mut softened.found);
        let course = self.approach(problem, &mut softened, outcome);
        std::mem::swap(&mut self.best, &mut softened.compromise);
        std::mem::swap(&mut self.best, &mut softened.found);
        let is_solved = match course {
            Course::Arrives => false,
            Course::Contradicts => problem.has_friction() && self.rescue(problem, &PATHS, outcome),
            Course::Fails => {
                self.rescue(problem, &PATHS, outcome) || self.rescue(problem, &LAST, outcome)
            }
        };
        let compromise = &mut softened.compromise;
        let is_better = self.best.is_moderate && self.best.residual < 0.5 * compromise.residual;
        if !(is_solved || is_better) {
            std::mem::swap(&mut self.best, compromise);
        }
        self.softened = softened;
    }

    /// Steps from no multipliers, each of which gives way to what the last one has not met, as long as they get shorter or move less. What they end in
    /// is the best answer then.
    fn approach(
        &mut self,
        problem: Checked,
        softened: &mut Softened,
        outcome: &mut Outcome,
    ) -> Course {
        softened.begin(problem);
        let mut last = [f64::INFINITY; 2];
        for _ in 0..MOST_STEPS {
            let giving = [problem.delassus, &softened.delassus];
            let (multipliers, free) = (&softened.multipliers, &mut softened.free);
            approach(giving, problem.free, multipliers, free);
            let giving = problem.with(&softened.delassus, &softened.free);
            self.start(giving, &softened.multipliers, &softened.status);
            let is_found = self.follow_active_set(giving, (Redundancy::MinimumNorm, 1.0), outcome)
                || self.rescue(giving, &NEAR, outcome);
            let next @ [step, motion] = softened.go_on(problem, &self.best);
            let multipliers = &softened.multipliers;
            let now = measure(problem, multipliers, |row| {
                problem.velocity(row, multipliers)
            });
            self.best.judge(now);
            if now.residual <= GOOD {
                return Course::Arrives;
            } else if motion <= INDEPENDENT * step {
                return Course::Contradicts;
            } else if !is_found || step > 0.5 * last[0] && motion > 0.5 * last[1] {
                return Course::Fails;
            }
            last = next;
        }
        Course::Fails
    }
}

impl Softened {
    /// Copies the problem with rows that give way.
    fn soften(&mut self, problem: Checked) {
        let n = problem.n_rows();
        self.delassus.clear();
        self.delassus.extend_from_slice(problem.delassus);
        for row in 0..n {
            self.delassus[row * (n + 1)] *= 1.0 + give(INDEPENDENT);
        }
    }

    /// Begins with no multipliers.
    fn begin(&mut self, problem: Checked) {
        self.multipliers.clear();
        self.multipliers.resize(problem.n_rows(), 0.0);
        self.status.clear();
        let kinds = problem.rows.iter();
        self.status.extend(kinds.map(|kind| match kind {
            RowKind::Bilateral => Status::Stick,
            _ => Status::Open,
        }));
    }

    /// Takes an answer over, and returns how long the step to it is and how much it moves, in square roots of energy.
    fn go_on(&mut self, problem: Checked, answer: &Answer) -> [f64; 2] {
        let (mut step, mut motion) = (0.0_f64, 0.0_f64);
        for (last, p) in self.multipliers.iter_mut().zip(&answer.multipliers) {
            *last = p - *last;
        }
        for row in (0..problem.n_rows()).filter(|&row| problem.is_movable(row)) {
            let weight = problem.diagonal(row).sqrt();
            let moved = dot(problem.row(row), &self.multipliers);
            step = step.max(weight * self.multipliers[row].abs());
            motion = motion.max(moved.abs() / weight);
        }
        self.multipliers.copy_from_slice(&answer.multipliers);
        self.status.copy_from_slice(&answer.status);
        [step, motion]
    }
}
