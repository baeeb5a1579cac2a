//! What the quadrature points of a body are at one instant, and at both ends of a step.

use super::hourglass::Shape;
#[cfg(doc)]
use super::model::FiniteStrainModel;
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

/// Gradients of deformation at the quadrature points: at the beginning of a step, and at the end last asked for.
#[derive(Clone, Debug)]
pub struct Deformation {
    pub(super) start: Deformed,
    pub(super) end: Deformed,
}

impl Deformation {
    /// Lets the step end where it begins.
    pub(super) fn stay(&mut self) {
        let Self { start, end } = self;
        end.gradients.copy_from_slice(&start.gradients);
        end.amplitudes.copy_from_slice(&start.amplitudes);
        end.positions.copy_from_slice(&start.positions);
        end.is_flat.copy_from_slice(&start.is_flat);
        end.around.copy_from_slice(&start.around);
    }

    /// Makes the end of the step the beginning of the next.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        // What has flowed belongs to the beginning.
        std::mem::swap(&mut self.start.flowed, &mut self.end.flowed);
    }

    /// `F` at all quadrature points where the step begins.
    pub(crate) fn start_gradients(&self) -> &[[f64; 4]] {
        &self.start.gradients
    }

    /// Quadrature points that are turned inside out at the beginning of the step.
    pub fn n_inverted(&self) -> usize {
        let is_inverted = |[xx, xy, yx, yy]: &&[f64; 4]| xx * yy - xy * yx <= 0.0;
        self.start.gradients.iter().filter(is_inverted).count()
    }

    /// Lets the step begin with what has flowed before, as [`FiniteStrainModel::virgin`] orders it.
    ///
    /// # Panics
    /// If it is not that of the same body.
    pub fn begin_with(&mut self, flowed: &[PlasticState]) {
        assert_eq!(flowed.len(), self.start.flowed.len(), "one state per point");
        self.start.flowed.copy_from_slice(flowed);
    }

    /// What has flowed before the step.
    pub fn flowed(&self) -> &[PlasticState] {
        &self.start.flowed
    }

    /// The same, to be [committed](FiniteStrainModel::commit_flow).
    pub fn flowed_mut(&mut self) -> &mut [PlasticState] {
        &mut self.start.flowed
    }
}
