//! What a body can be asked beyond its motion: what its material bears, how far its strains are from small, what has flowed, and its
//! natural frequencies.
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
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::frequency::frequency_bound;
use crate::fe::model::ModelError;
use crate::fe::modes::{Modes, ModesError, lowest_modes, lowest_modes_at};
use crate::fe::recovery::{PointState, Stress, Stretch};
use crate::integrator::Beta2;
use crate::math::{hypot, node_vec, sin_cos};

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

    /// An upper bound of the largest natural frequency of the body as it is held (rad/s), with nodes without mass held too,
    /// as a contact may; a step by central difference may last `2 / ω`, one by another explicit member [`critical_step`](Self::critical_step).
    ///
    /// With stiffness damping it is `ω (√(1 + ζ²) + ζ)`, `ζ = β ω / 2`: that of an undamped body with the same critical
    /// step, where damping takes its rate from the half step before.
    ///
    /// The first call costs one small eigenvalue problem per cell.
    pub fn explicit_frequency(&self) -> f64 {
        *self.frequency.get_or_init(|| {
            let bound = frequency_bound(self.touched_model(), self.fixed_dofs());
            let omega = bound.unwrap_or(f64::INFINITY);
            let ratio = 0.5 * self.model().rayleigh().stiffness * omega;
            omega * (ratio + hypot(ratio, 1.0))
        })
    }

    /// The longest stable step (s) by an explicit member, see [`Beta2::explicit_critical_step`] and [`explicit_frequency`](Self::explicit_frequency).
    pub fn critical_step(&self, integrator: &Beta2) -> f64 {
        let (bound, damping) = (self.explicit_frequency(), self.model().rayleigh().stiffness);
        if bound == f64::INFINITY {
            return 0.0;
        }
        // `ω` of `ω (√(1 + ζ²) + ζ)` with `ζ = β ω / 2`.
        let frequency = bound / (1.0 + damping * bound).sqrt();
        integrator.explicit_critical_step(frequency, damping)
    }

    /// The `n_modes` lowest natural modes of the body as it is pinned, known to a relative `tolerance` (-); see [`lowest_modes`].
    ///
    /// Of a body of small strain in its frame, whatever its place; of one of large strain about where it is now and in the world's axes, which
    /// is meant for equilibria. Contacts, joints, attachments and damping are left out.
    ///
    /// # Errors
    /// [`ModesError`], as of [`lowest_modes`] and [`lowest_modes_at`].
    pub fn natural_modes(&self, n_modes: usize, tolerance: f64) -> Result<Modes, ModesError> {
        let is_fixed = self.fixed_dofs();
        match self.large() {
            Some(large) => lowest_modes_at(large, self.positions(), is_fixed, n_modes, tolerance),
            None => lowest_modes(self.free_model(), is_fixed, n_modes, tolerance),
        }
    }
}
