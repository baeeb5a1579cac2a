//! What the quadrature points of a body are at one instant.

use super::hourglass::Shape;
use crate::fe::material::hyperelastic::PlasticState;

/// A deformation: gradients, one per quadrature point, and amplitudes of the hourglass modes (m) where cells have such.
#[derive(Clone, Debug, Default)]
pub(super) struct Deformed {
    pub(super) gradients: Vec<[f64; 4]>,
    pub(super) amplitudes: Vec<[f64; 2]>,
    /// Positions of the nodes (m).
    pub(super) positions: Vec<f64>,
    /// Whether a guarded place of a cell may be flat, group after group.
    pub(super) is_flat: Vec<bool>,
    /// Positions around the holes under pressure, relative to one of each (m).
    pub(super) around: Vec<f64>,
    /// What has flowed before the step, one per quadrature point; of its beginning, and of bodies that may flow.
    pub(super) flowed: Vec<PlasticState>,
}

impl Deformed {
    pub(super) fn new(n_points: usize, [n_dofs, n_cells]: [usize; 2], n_around: usize) -> Self {
        Self {
            gradients: vec![[0.0; 4]; n_points],
            amplitudes: vec![[0.0; 2]; n_points],
            positions: vec![0.0; n_dofs],
            is_flat: vec![false; n_cells],
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
