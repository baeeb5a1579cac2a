//! What the material of a body bears: at quadrature points, and smoothed at nodes.

use super::flex_body::FlexBody;
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::model::ModelError;
use crate::fe::recovery::{PointState, Stress, Stretch};
use crate::math::sin_cos;

impl FlexBody {
    /// Strains `[e_xx, e_yy, g_xy]` (-) and stresses (Pa) at the quadrature points of a cell, in the body's frame.
    ///
    /// Of a body of large strain the strains are those of Green and Lagrange, `(FᵀF - I)/2`, along the axes it was built in, and the stresses
    /// Cauchy's in the world's: [`point_states`](Self::point_states) has more of both kinds.
    ///
    /// # Errors
    /// If the element cannot evaluate its strain.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn cell_stress(&self, cell: usize) -> Result<Vec<([f64; 3], Stress)>, ModelError> {
        let Some(large) = &self.large else {
            return self.model.cell_stress(cell, self.local_displacements());
        };
        let states = self.large_states(large, cell).into_iter();
        let pair = |state: PointState| {
            let [xx, xy, yx, yy] = state.gradient;
            let strain = [
                0.5 * (xx * xx + yx * yx - 1.0),
                0.5 * (xy * xy + yy * yy - 1.0),
                xx * xy + yx * yy,
            ];
            (strain, state.stress)
        };
        Ok(states.map(pair).collect())
    }

    /// Deformation, stretches and Cauchy's stress at the quadrature points of a cell, in the world's axes.
    ///
    /// A body of small strain turns with its frame, `F = R (I + ε)`; in plane stress its thickness is stretched by `1 - ν/(1 - ν) (ε_xx + ε_yy)`.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// let rubber = HyperelasticSolid::new(NeoHookean::plane_strain(1e6, 0.45)).with_density(1100.0);
    /// let body = FlexBodyBuilder::rectangle([0.2, 0.1], [4, 2]).material(rubber).build()?;
    /// for state in body.point_states(0)? {
    ///     let (longest, shortest, _) = state.stretch.principal();
    ///     assert!(longest - shortest < 1e-12 && state.stress.von_mises() < 1e-6);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the element cannot evaluate its strain.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn point_states(&self, cell: usize) -> Result<Vec<PointState>, ModelError> {
        if let Some(large) = &self.large {
            return Ok(self.large_states(large, cell));
        }
        let angle = self.angle();
        let (sin, cos) = sin_cos(angle);
        let material = self.model.material_of(self.mesh().cell(cell).region);
        let found = self.cell_stress(cell)?.into_iter();
        let state = |(strain, stress): ([f64; 3], Stress)| {
            let [a, b, c] = [1.0 + strain[0], 0.5 * strain[2], 1.0 + strain[1]];
            let gradient = [
                cos * a - sin * b,
                cos * b - sin * c,
                sin * a + cos * b,
                sin * b + cos * c,
            ];
            let thickness = 1.0 + material.thickness_strain(strain);
            PointState {
                gradient,
                stretch: Stretch::of_gradient(gradient, thickness),
                stress: stress.turned(angle),
            }
        };
        Ok(found.map(state).collect())
    }

    /// The points of a cell of large strain, after what has flowed.
    fn large_states(&self, large: &FiniteStrainModel, cell: usize) -> Vec<PointState> {
        let (at, flowed) = (&self.state.position, &self.state.flowed);
        let mut states = large.cell_states(cell, at);
        if !flowed.is_empty() {
            let stresses = large.cell_stress_after(cell, at, flowed);
            for (state, stress) in states.iter_mut().zip(stresses) {
                state.stress = stress;
            }
        }
        states
    }

    /// Smoothed stress at every node, in the body's frame (Pa); of a body of large strain Cauchy's, in the world's axes.
    ///
    /// Where regions of different materials meet, stresses along their interface jump, and this is the mean of both sides: see
    /// [`region_stress`](Self::region_stress).
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn stress(&self) -> Result<Vec<Stress>, ModelError> {
        self.smoothed(None)
    }

    /// As [`stress`](Self::stress), from the cells of one region alone; `None` at the nodes of none of them.
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn region_stress(&self, region: u32) -> Result<Vec<Option<Stress>>, ModelError> {
        let mut is_in = vec![false; self.n_nodes()];
        for cell in self.mesh().cells().filter(|cell| cell.region == region) {
            cell.nodes.iter().for_each(|&node| is_in[node] = true);
        }
        let stresses = self.smoothed(Some(region))?.into_iter().zip(is_in);
        Ok(stresses
            .map(|(stress, is_in)| is_in.then_some(stress))
            .collect())
    }

    fn smoothed(&self, region: Option<u32>) -> Result<Vec<Stress>, ModelError> {
        self.model.smooth(region, |cell| {
            let found = self.cell_stress(cell)?;
            Ok(found.into_iter().map(|(_, stress)| stress).collect())
        })
    }

    /// Smoothed von Mises stress at every node (Pa).
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn von_mises(&self) -> Result<Vec<f64>, ModelError> {
        Ok(self.stress()?.iter().map(Stress::von_mises).collect())
    }

    /// Smoothed principal stresses in the plane at every node: the larger, the smaller (Pa), and the angle of the larger (rad), in the axes of
    /// [`stress`](Self::stress).
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn principal_stress(&self) -> Result<Vec<(f64, f64, f64)>, ModelError> {
        Ok(self.stress()?.iter().map(Stress::principal).collect())
    }

    /// Smoothed stretch at every node, in the world's axes; [`Stretch::principal`] has the principal ones.
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn stretch(&self) -> Result<Vec<Stretch>, ModelError> {
        let components = self.model.smooth(None, |cell| {
            let states = self.point_states(cell)?.into_iter();
            Ok(states.map(|state| state.stretch.as_stress()).collect())
        })?;
        Ok(components.into_iter().map(Stretch::from_stress).collect())
    }
}
