//! How far the strains of a body are from small, and what of them stays.
//!
//! The strain of an edge `ΔX` whose ends move apart by `Δu` is
//!
//! ```text
//! (|ΔX + Δu|² - |ΔX|²) / 2|ΔX|² = ΔX·Δu / |ΔX|² + ½ |Δu|² / |ΔX|².
//! ```
//!
//! Small strains are the first term, measured in the body's one frame. The second is what they leave out: `1 - cos φ` where the material has
//! turned by `φ` against the frame, `½ ε²` where it is stretched by `ε`.

use super::flex_body::FlexBody;
use crate::math::node_vec;

impl FlexBody {
    /// Largest strain that small strains leave out at an edge of a cell (-).
    ///
    /// The lengths of the body are wrong by as much. A bent part that has turned by 0.14 rad against the rest of the body has 0.01; a strip that
    /// is held at both ends carries as a string from `(thickness / length)²` on, which the body does not know of.
    ///
    /// Zero for bodies of large strain, which leave nothing out.
    pub fn neglected_strain(&self) -> f64 {
        if self.large.is_some() {
            return 0.0;
        }
        let rest = self.model.mesh().nodes();
        let u = self.local_displacements();
        let mut largest = 0.0f64;
        for cell in self.model.mesh().cells() {
            let corners = cell.corners();
            let mut from = corners[corners.len() - 1];
            for &to in corners {
                let ([x, y], [from_x, from_y]) = (rest[to], rest[from]);
                let length = (x - from_x) * (x - from_x) + (y - from_y) * (y - from_y);
                let apart = (node_vec(u, to) - node_vec(u, from)).norm_squared();
                largest = largest.max(0.5 * apart / length);
                from = to;
            }
        }
        largest
    }

    pub(super) fn elastic_energy(&self) -> f64 {
        let state = &self.state;
        match &self.large {
            Some(large) => large.energy_after(&state.position, &state.flowed).stored,
            None => self.model.elastic_energy(self.local_displacements()),
        }
    }

    /// Accumulated plastic strains `∫ √(2/3) |dp|` at the quadrature points of a cell (-), of a four-node cell at its middle; none of a material that
    /// does not flow.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn plastic_strains(&self, cell: usize) -> Vec<f64> {
        let flowed = &self.state.flowed;
        match &self.large {
            Some(large) if !flowed.is_empty() => {
                let points = flowed[large.points_of(cell)].iter();
                points.map(|point| point.strain).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The largest accumulated plastic strain anywhere (-); zero of what has never flowed.
    pub fn max_plastic_strain(&self) -> f64 {
        let strains = self.state.flowed.iter().map(|point| point.strain);
        strains.fold(0.0, f64::max)
    }

    /// What plastic flow has dissipated since the body was built (J).
    pub fn plastic_dissipation(&self) -> f64 {
        self.state.flow_energy
    }

    /// [`Self::neglected_strain`] where it is beyond `limit`: most bodies tell by their largest displacement that it is not.
    pub(crate) fn neglected_beyond(&self, limit: f64) -> Option<f64> {
        if self.large.is_some() {
            return None;
        }
        let all = self.local_displacements().iter();
        let reach = all.fold(0.0f64, |reach, u| reach.max(u.abs()));
        // Two ends, two components each.
        let bound = 4.0 * (reach / self.model.shortest_edge()).powi(2);
        if bound <= limit {
            return None;
        }
        Some(self.neglected_strain()).filter(|neglected| *neglected > limit)
    }
}
