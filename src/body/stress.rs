//! What the material of a body bears.

use super::flex_body::FlexBody;
use crate::fe::model::ModelError;
use crate::fe::recovery::Stress;

impl FlexBody {
    /// Strains `[e_xx, e_yy, g_xy]` (-) and stresses (Pa) at the quadrature points of a cell, in the body's frame.
    ///
    /// # Errors
    /// If the element cannot evaluate its strain.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn cell_stress(&self, cell: usize) -> Result<Vec<([f64; 3], Stress)>, ModelError> {
        self.model.cell_stress(cell, self.local_displacements())
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
        self.model.smooth(region, |cell| match &self.large {
            Some(large) => Ok(large.cell_stress(cell, &self.state.position)),
            None => Ok(self
                .cell_stress(cell)?
                .into_iter()
                .map(|(_, stress)| stress)
                .collect()),
        })
    }

    /// Smoothed von Mises stress at every node (Pa).
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn von_mises(&self) -> Result<Vec<f64>, ModelError> {
        Ok(self.stress()?.iter().map(Stress::von_mises).collect())
    }
}
