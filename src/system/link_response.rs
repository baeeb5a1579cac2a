//! How a link of a multibody answers forces on it and on the others, and what it has been given to hand on.
//!
//! Another solver moves the multibody. It is told of the forces as one wrench for the whole step, of which velocities and positions make what
//! that solver makes of it.

use super::Response;
use crate::math::{Mat2, Vec2, cross};
use nalgebra::{Matrix3, Vector3};

/// How a link answers a steady wrench on one of its multibody, both about their centres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkAnswer {
    /// What velocities gain, over the step's length (1/kg, 1/(kg m), 1/(kg m²)).
    pub velocity: Matrix3<f64>,
    /// How far positions move, over the square of the step's length.
    pub position: Matrix3<f64>,
}

impl LinkAnswer {
    fn of(&self, of: Response) -> &Matrix3<f64> {
        match of {
            Response::Position => &self.position,
            Response::Velocity | Response::Acceleration | Response::ByMass => &self.velocity,
        }
    }
}

/// A link's answer to forces, and the sum of those that acted.
#[derive(Clone, Debug, Default)]
pub struct LinkResponse {
    /// To a wrench on itself; positions over `b0`.
    own: LinkAnswer,
    /// To wrenches on other links of the multibody, by their blocks.
    others: Vec<(usize, LinkAnswer)>,
    /// Impulse of this step's forces (N s, N s, N m s).
    impulse: [f64; 3],
    /// The part of the forces that goes on into the next step, as stored accelerations do (N, N, N m).
    lasting: [f64; 3],
}

impl LinkResponse {
    /// An answer to which nothing has been given yet.
    ///
    /// - `answers`: to wrenches on all links that take part, by their blocks.
    /// - `scale`: what a multiplier moves, over `b0` and the answer of positions.
    pub fn new(own: usize, answers: &[(usize, LinkAnswer)], scale: f64) -> Self {
        let mut response = Self::default();
        for &(block, answer) in answers {
            let answer = LinkAnswer {
                position: scale * answer.position,
                ..answer
            };
            match block == own {
                true => response.own = answer,
                false => response.others.push((block, answer)),
            }
        }
        response
    }

    /// Impulse that this step's forces give (N s, N s, N m s).
    pub fn impulse(&self) -> [f64; 3] {
        self.impulse
    }

    /// Forces at the end of the step, which act on for the first part of the next (N, N, N m).
    pub fn lasting(&self) -> [f64; 3] {
        self.lasting
    }

    /// What a wrench on the link does to it: acceleration (m/s², rad/s²), or way over `b0`.
    pub(super) fn answer(&self, wrench: [f64; 3], of: Response) -> [f64; 3] {
        (self.own.of(of) * Vector3::from(wrench)).into()
    }

    /// What the wrenches on the other links among those of all blocks do to it.
    pub(super) fn answer_others(&self, wrenches: &[[f64; 3]], of: Response) -> [f64; 3] {
        let answers = self.others.iter();
        let answers = answers.map(|(from, answer)| answer.of(of) * Vector3::from(wrenches[*from]));
        answers.sum::<Vector3<f64>>().into()
    }

    /// What a wrench on another link does to it, if that is one of the same multibody.
    pub(super) fn answer_from(
        &self,
        other: usize,
        wrench: [f64; 3],
        of: Response,
    ) -> Option<[f64; 3]> {
        let (_, answer) = self.others.iter().find(|(block, _)| *block == other)?;
        Some((answer.of(of) * Vector3::from(wrench)).into())
    }

    /// How a point at a lever moves by a force at a lever of another link, if it is one of the same multibody (1/kg).
    pub(super) fn compliance_across(
        &self,
        at: Vec2,
        (other, from): (usize, Vec2),
        of: Response,
    ) -> Option<Mat2> {
        let (_, answer) = self.others.iter().find(|(block, _)| *block == other)?;
        Some(between_points(answer.of(of), at, from))
    }

    /// Whether other links answer together with it.
    pub(super) fn has_others(&self) -> bool {
        !self.others.is_empty()
    }

    /// See [`super::Block::compliance`], for two levers.
    pub(super) fn compliance(&self, at: Vec2, from: Vec2, of: Response) -> Mat2 {
        between_points(self.own.of(of), at, from)
    }

    pub(super) fn mobility_between(&self, at: [f64; 3], from: [f64; 3], of: Response) -> f64 {
        Vector3::from(at).dot(&Vector3::from(self.answer(from, of)))
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

/// How a point at one lever moves by forces at another one.
fn between_points(answer: &Matrix3<f64>, at: Vec2, from: Vec2) -> Mat2 {
    let columns = [Vec2::x(), Vec2::y()].map(|force| {
        let moved = answer * Vector3::new(force.x, force.y, cross(from, force));
        Vec2::new(moved.x - moved.z * at.y, moved.y + moved.z * at.x)
    });
    Mat2::from_columns(&columns)
}
