//! Where a solve begins, and what is good enough for it.

use super::law::{ConeStatus, project};
use super::proximal::FINE;
use super::{ConeProblem, ConeSolver, SETTLING, State};

impl ConeSolver {
    /// Takes the multipliers `p` as often as the energy `½ s² pᵀW p + s pᵀw` is least, `s = -pᵀw / pᵀW p`, with `w` where they are zero.
    pub(super) fn scale_start(&mut self, problem: &ConeProblem, multipliers: &mut [[f64; 2]]) {
        let [free, moved] = &mut self.moves;
        free.clear();
        free.extend_from_slice(problem.load);
        moved.clear();
        moved.resize(free.len(), 0.0);
        self.system.solve_bodies(free);
        for (row, force) in problem.rows.iter().zip(&*multipliers) {
            problem.push(row, 1.0, *force, moved);
        }
        self.system.solve_bodies(moved);
        let (mut along, mut square) = (0.0, 0.0);
        for (row, force) in problem.rows.iter().zip(&*multipliers) {
            let (at, by) = (problem.motion(row, free), problem.motion(row, moved));
            for k in 0..2 {
                along -= force[k] * (row.free[k] + at[k]);
                square += force[k] * (by[k] + row.give[k] * force[k]);
            }
        }
        let share = along / square;
        if share.is_finite() && share > 0.0 {
            multipliers.iter_mut().flatten().for_each(|p| *p *= share);
        }
    }

    /// Takes over what the caller remembers, as far as the laws admit it.
    pub(super) fn warm_start(
        &mut self,
        problem: &ConeProblem,
        multipliers: &[[f64; 2]],
        slip: &[f64],
    ) {
        self.start.clear();
        self.start_slip.clear();
        for (index, row) in problem.rows.iter().enumerate() {
            let acted = row.acted();
            let is_usable = self.reduced.resistance[index] > 0.0
                && multipliers[index].iter().all(|value| value.is_finite());
            let given = if is_usable {
                multipliers[index]
            } else {
                [0.0; 2]
            };
            self.start
                .push(project(row, [given[0] + acted[0], given[1] + acted[1]], [1.0; 2]).0);
            let is_usable = row.has_tangent() && slip[index].is_finite();
            self.start_slip
                .push(if is_usable { slip[index].abs() } else { 0.0 });
        }
        self.state
            .status
            .resize(problem.rows.len(), ConeStatus::Open);
        self.restart(problem);
        self.slide_open(problem);
    }

    /// Lets what carries no force at the start slide as it does there: with less dilation an open contact that slides looks as if it pressed.
    fn slide_open(&mut self, problem: &ConeProblem) {
        for (index, row) in problem.rows.iter().enumerate() {
            if row.has_tangent() && self.start[index] == [0.0; 2] {
                self.start_slip[index] = self.reduced.gap(problem, index, &self.state.a)[1].abs();
            }
        }
        self.state.slip.clone_from(&self.start_slip);
    }

    pub(super) fn restart(&mut self, problem: &ConeProblem) {
        self.state.forces.clone_from(&self.start);
        self.state.slip.clone_from(&self.start_slip);
        self.move_by_forces(problem);
    }

    /// `a = A⁻¹ (load + Gᵀ P)`.
    pub(super) fn move_by_forces(&mut self, problem: &ConeProblem) {
        self.state.measure = None;
        self.state.a.resize(problem.matrix.n_dofs(), 0.0);
        self.reduced
            .total_load(problem, &self.state.forces, &mut self.state.a);
        self.system.solve_bodies(&mut self.state.a);
    }

    /// Allows the errors that the settings admit, but no more than the share [`SETTLING`] of what the start is off in the mean of squares: what
    /// comes to rest is solved the finer the less it moves, and comes to rest. In the mean, since errors of all rows together bring that share of
    /// the energy of what moves, however few rows that are: by the largest, one box that slips would let a thousand others tremble.
    pub(super) fn set_goal(&mut self, problem: &ConeProblem) {
        let State {
            forces,
            slip,
            a,
            status,
            measure,
        } = &mut self.state;
        let start = self
            .reduced
            .measure(problem, a, forces, slip, &self.settings, status);
        *measure = Some(start);
        let (settings, share) = (&self.settings, SETTLING.get());
        self.reduced.enough = settings.gap_tolerance.min(share * start.mean.miss);
        let least = FINE * settings.tolerance;
        self.reduced.goal = settings
            .tolerance
            .min((share * start.mean.residual).max(least));
    }
}
