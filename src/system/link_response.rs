//! How a link of a multibody answers forces, `W = J M̃⁻¹ Jᵀ`, and what it has been given to hand on.
//!
//! Another solver moves the multibody. It is told of the forces as one wrench for the whole step, with which it goes
//! `c dt` times the change of velocity that comes of it; positions here answer in the same way.

use super::Response;
use crate::math::{Mat2, Vec2, cross};
use nalgebra::{Matrix3, Vector3};

/// A link's answer to forces about its centre of mass, and the sum of those that acted.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinkResponse {
    /// Acceleration per wrench `[f_x, f_y, τ]`, symmetric (1/kg, 1/(kg m), 1/(kg m²)).
    mobility: Matrix3<f64>,
    /// How far a multiplier moves the link, over `b0 W` (-).
    pub(super) reach: f64,
    /// Impulse of this step's forces (N s, N s, N m s).
    impulse: [f64; 3],
    /// The part of the forces that goes on into the next step, as stored accelerations do (N, N, N m).
    lasting: [f64; 3],
}

impl LinkResponse {
    /// An answer to which nothing has been given yet.
    pub fn new(mobility: Matrix3<f64>, reach: f64) -> Self {
        Self {
            mobility,
            reach,
            ..Self::default()
        }
    }

    /// Impulse that this step's forces give (N s, N s, N m s).
    pub fn impulse(&self) -> [f64; 3] {
        self.impulse
    }

    /// Forces at the end of the step, which act on for the first part of the next (N, N, N m).
    pub fn lasting(&self) -> [f64; 3] {
        self.lasting
    }

    /// Acceleration under a wrench (m/s², rad/s²).
    pub(super) fn answer(&self, wrench: [f64; 3]) -> [f64; 3] {
        (self.mobility * Vector3::from(wrench)).into()
    }

    /// See [`super::Block::compliance`], for two levers.
    pub(super) fn compliance(&self, at: Vec2, from: Vec2, of: Response) -> Mat2 {
        let scale = self.scale(of);
        let columns = [Vec2::x(), Vec2::y()].map(|force| {
            let [x, y, turn] = self.answer([force.x, force.y, cross(from, force)]);
            scale * Vec2::new(x - turn * at.y, y + turn * at.x)
        });
        Mat2::from_columns(&columns)
    }

    pub(super) fn mobility_between(&self, at: [f64; 3], from: [f64; 3], of: Response) -> f64 {
        let terms = at.iter().zip(self.answer(from));
        self.scale(of) * terms.map(|(at, moved)| at * moved).sum::<f64>()
    }

    fn scale(&self, of: Response) -> f64 {
        if of == Response::Position {
            self.reach
        } else {
            1.0
        }
    }

    /// Begins with forces of which `b1` (s) acts in this step, and whether some of them goes on.
    pub(super) fn begin(&mut self, wrench: [f64; 3], b1: f64, lasts: bool) {
        self.impulse = wrench.map(|value| b1 * value);
        self.lasting = if lasts { wrench } else { [0.0; 3] };
    }

    pub(super) fn add_impulse(&mut self, impulse: [f64; 3]) {
        for (sum, value) in self.impulse.iter_mut().zip(impulse) {
            *sum += value;
        }
    }

    pub(super) fn add_lasting(&mut self, wrench: [f64; 3]) {
        for (sum, value) in self.lasting.iter_mut().zip(wrench) {
            *sum += value;
        }
    }

    /// Forgets what was given: the step did not take place.
    pub(super) fn take_back(&mut self) {
        self.impulse = [0.0; 3];
        self.lasting = [0.0; 3];
    }
}
