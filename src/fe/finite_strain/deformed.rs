//! What the quadrature points of a body are at one instant.

use super::hourglass::Shape;
use crate::fe::material::hyperelastic::PlasticState;

/// A deformation: gradients, one per quadrature point, and amplitudes of the hourglass modes (m) where cells have such.
#[derive(Clone, Debug, Default)]
pub(super) struct Deformed {
    pub(super) gradients: Vec<[f64; 4]>,
    pub(super) amplitudes: Vec<[f64; 2]>,
    /// Gradients at the guarded places.
    pub(super) guarded: Vec<[f64; 4]>,
    /// Positions around the holes under pressure, relative to one of each (m).
    pub(super) around: Vec<f64>,
    /// What has flowed before the step, one per quadrature point; of its beginning, and of bodies that may flow.
    pub(super) flowed: Vec<PlasticState>,
}

impl Deformed {
    pub(super) fn new(n_points: usize, n_guarded: usize, n_around: usize) -> Self {
        Self {
            gradients: vec![[0.0; 4]; n_points],
            amplitudes: vec![[0.0; 2]; n_points],
            guarded: vec![[0.0; 4]; n_guarded],
            around: vec![0.0; n_around],
            flowed: Vec::new(),
        }
    }

    pub(super) fn shape(&self, point: usize) -> Shape {
        Shape {
            gradient: self.gradients[point],
            amplitude: self.amplitudes[point],
            flowed: [0.0; 2],
        }
    }
}
