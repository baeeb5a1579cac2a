//! The equations of motion of a multibody in its joint coordinates, and their solution.

use super::Tree;
use crate::linalg::complementarity::{factorize_cholesky, solve_cholesky_in_place};
use crate::math::rounding;
use crate::rapier::prelude::*;
use crate::system::LinkAnswer;
use nalgebra::Matrix3;

/// `M̃`, `Q - C` and the joint velocities of the coordinates that move freely.
#[derive(Clone, Debug)]
pub struct Equations {
    pub(super) mass: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) pace: Pace,
}

impl Equations {
    /// Adds a row that pulls back with `-k (g + shift)` at the end of the step, `shift` being its value now (m or rad).
    pub fn add_spring(&mut self, row: &[f64], stiffness: f64, shift: f64) {
        let Pace { dt, share } = self.pace;
        let rate = self.rate(row);
        self.add(
            row,
            share * dt * dt * stiffness,
            -stiffness * (shift + dt * rate),
        );
    }

    /// Adds a row that resists with `-c (rate - goal)`, `goal` its wanted rate (m/s or rad/s).
    pub fn add_damper(&mut self, row: &[f64], damping: f64, goal: f64) {
        let rate = self.rate(row);
        self.add(row, self.pace.dt * damping, -damping * (rate - goal));
    }

    /// Rate of a row when the step begins (m/s or rad/s).
    pub fn rate(&self, row: &[f64]) -> f64 {
        row.iter().zip(&self.rates).map(|(g, v)| g * v).sum()
    }

    /// Adds a force along a row.
    pub fn add_force(&mut self, row: &[f64], force: f64) {
        self.add(row, 0.0, force);
    }

    fn add(&mut self, row: &[f64], mass: f64, force: f64) {
        let n = self.force.len();
        for (a, one) in row.iter().enumerate() {
            self.force[a] += one * force;
            for (b, other) in row.iter().enumerate() {
                self.mass[a * n + b] += mass * one * other;
            }
        }
    }

    /// Factorizes; `None` if some coordinate weighs nothing.
    pub fn solve(&self) -> Option<Solved> {
        let n = self.force.len();
        let mut factor = self.mass.clone();
        factorize_cholesky(&mut factor, n, rounding::FEW).then(|| {
            let mut acceleration = self.force.clone();
            solve_cholesky_in_place(&factor, n, &mut acceleration);
            Solved {
                factor,
                acceleration,
                share: self.pace.share,
            }
        })
    }
}

/// Factor of `M̃`, and the accelerations of the joint coordinates.
#[derive(Clone, Debug)]
pub struct Solved {
    factor: Vec<f64>,
    acceleration: Vec<f64>,
    /// See [`Pace::share`].
    share: f64,
}

impl Solved {
    /// `M̃⁻¹ r`.
    pub fn response(&self, row: &[f64]) -> Vec<f64> {
        let mut answer = row.to_vec();
        solve_cholesky_in_place(&self.factor, row.len(), &mut answer);
        answer
    }

    /// Mass that a row moves, `1 / g M̃⁻¹ g` (kg or kg m²).
    pub fn weight(&self, row: &[f64]) -> f64 {
        let moved: f64 = row.iter().zip(self.response(row)).map(|(g, x)| g * x).sum();
        1.0 / moved
    }

    /// Rate of change of a row (m/s² or rad/s²).
    pub fn along(&self, row: &[f64]) -> f64 {
        row.iter().zip(&self.acceleration).map(|(g, a)| g * a).sum()
    }

    /// Acceleration of a link (m/s², rad/s²).
    pub fn acceleration(&self, tree: &Tree, link: usize) -> [f64; 3] {
        tree.acceleration(link, &self.acceleration)
    }

    /// How a link answers wrenches on another one, or itself: `J M̃⁻¹ Jᵀ`, and the way that goes with it.
    pub fn answer(&self, tree: &Tree, link: usize, other: usize) -> LinkAnswer {
        let rows_of = |link: usize| -> [Vec<f64>; 3] {
            std::array::from_fn(|axis| {
                let mut wrench = [0.0; 3];
                wrench[axis] = 1.0;
                tree.pull_back(link, wrench)
            })
        };
        let (rows, sources) = (rows_of(link), rows_of(other));
        let answers = [0, 1, 2].map(|axis: usize| self.response(&sources[axis]));
        let velocity = Matrix3::from_fn(|a, b| {
            let terms = rows[a].iter().zip(&answers[b]);
            terms.map(|(row, answer)| row * answer).sum()
        });
        LinkAnswer {
            velocity,
            position: self.share * velocity,
        }
    }
}

/// Length of the step and what rapier makes of it.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    pub dt: f64,
    /// `c`: how far a steady force moves, over `dt Δv`.
    pub share: f64,
}

impl Pace {
    /// Of rapier's step with a body of so many additional iterations.
    pub fn new(dt: f64, parameters: &IntegrationParameters, additional: usize) -> Self {
        let n = (parameters.num_solver_iterations + additional).max(1) as f64;
        Self {
            dt,
            share: 0.5 * (n + 1.0) / n,
        }
    }
}
