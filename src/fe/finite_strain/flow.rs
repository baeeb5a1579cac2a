//! Bodies whose law flows: every point is an elastic one in its own intermediate placement, `Fe = F Fp⁻¹ = Σ_a x_a ⊗ Fp⁻ᵀ ∇N_a`, with the
//! incremental potential of the step for its energy (see [`J2Plasticity`]).
//!
//! `Fp` is that of the beginning of the step all through it; what flows in the step is known when it is committed.
//!
//! Hourglass modes of four-node cells flow as well, or they would lock: with what has flowed of them, `c_p`,
//!
//! ```text
//! c = Feᵀ q - c_p,    u = c·K c,    φ = u/2  while √u <= g,  else  g √u - g²/2  (stored g²/2, dissipated g (√u - g))
//! ```
//!
//! with `g` by the fully plastic bending of the cell, less what its mean stress has taken of it: the share `√(1 - (σ/Y)²)` at the end of the last
//! step, when modes beyond it are brought there and what they lose counts as dissipated.

use super::Inadmissible;
use super::cells::{CellGroup, with_node_count};
use super::deformed::Deformed;
use super::dilatation::Smoothing;
use super::hourglass::{Hourglass, Shape};
use super::linearization::Linearization;
use super::model::FiniteStrainModel;
use super::one_cell::{add_point, deformation_gradient, gather, scatter, subtract};
use super::point::{Form, stress_of_sums};
use crate::fe::LEAST_LEFT;
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants, J2Plasticity, PlasticState};
use crate::fe::recovery::Stress;
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::judged::Judged;

/// Energy of a body that may flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowEnergy {
    /// Stored at the end (J).
    pub stored: f64,
    /// Dissipated by plastic flow on the way there (J), never negative.
    pub dissipated: f64,
}

impl FiniteStrainModel {
    /// What has flowed in a body as it is made: nothing, one entry per quadrature point; none of a body whose law does not flow.
    pub fn virgin(&self) -> Vec<PlasticState> {
        match self.flows() {
            true => vec![PlasticState::VIRGIN; self.n_points],
            false => Vec::new(),
        }
    }

    /// Whether a law of the body flows.
    pub(crate) fn flows(&self) -> bool {
        let flows = |group: &CellGroup| group.solid.law.as_ref().plasticity().is_some();
        self.groups.iter().any(flows)
    }

    /// Whether what has flowed in the other body means the same in this one.
    pub fn flows_as(&self, other: &Self) -> bool {
        // Points are numbered by groups of cells.
        let laws = |model: &'_ Self| -> Vec<(Vec<usize>, Option<J2Plasticity>)> {
            let groups = model.groups.iter();
            let laws =
                groups.map(|group| (group.cells.clone(), group.solid.law.plasticity().copied()));
            laws.collect()
        };
        let flows = |model: &Self| model.flows();
        !(flows(self) || flows(other)) || laws(self) == laws(other)
    }

    /// Energy at the end of a step to `positions` (m), before which this has flowed.
    ///
    /// # Panics
    /// If there is not one entry per dof, or of `flowed` not as many as [`virgin`](Self::virgin) has.
    pub fn energy_after(&self, positions: &[f64], flowed: &[PlasticState]) -> FlowEnergy {
        self.assert_length(positions);
        let mut sum = FlowEnergy::default();
        for group in &self.groups {
            let law = group.solid.law.as_ref();
            let Some(plastic) = law.plasticity() else {
                sum.stored += group.energy(law, positions);
                continue;
            };
            let mut points = FlowEnergy::default();
            group.visit_flow(
                plastic,
                positions,
                &flowed[group.points()],
                |_, energy, _| {
                    points.stored += energy.stored;
                    points.dissipated += energy.dissipated;
                },
            );
            sum.stored += points.stored;
            sum.stored += with_node_count!(group, guards_energy(positions));
            sum.stored += with_node_count!(group, smoothed_energy(positions));
            sum.dissipated += points.dissipated;
        }
        for hole in &self.holes {
            sum.stored += hole.energy(positions);
        }
        sum
    }

    /// Commits a step to `positions` (m): lets what would flow have flowed. Returns what that dissipates (J).
    ///
    /// # Panics
    /// As [`energy_after`](Self::energy_after).
    pub fn commit_flow(&self, positions: &[f64], flowed: &mut [PlasticState]) -> f64 {
        if flowed.is_empty() {
            return 0.0;
        }
        self.assert_length(positions);
        let mut dissipated = 0.0;
        for group in &self.groups {
            let Some(plastic) = group.solid.law.as_ref().plasticity() else {
                continue;
            };
            let states = &mut flowed[group.points()];
            let before = states.to_vec();
            group.visit_flow(plastic, positions, &before, |point, energy, state| {
                dissipated += energy.dissipated;
                states[point] = state;
            });
        }
        dissipated
    }

    /// Cauchy's stress (Pa) at the quadrature points of a cell at `positions` (m) where this has flowed, in the world's axes; of a four-node
    /// cell its mean one at all of them.
    ///
    /// # Panics
    /// As [`energy_after`](Self::energy_after), or if there is no such cell.
    pub fn cell_stress_after(
        &self,
        cell: usize,
        positions: &[f64],
        flowed: &[PlasticState],
    ) -> Vec<Stress> {
        for group in &self.groups {
            let (Some(law), Ok(place)) = (
                group.solid.law.as_ref().plasticity(),
                group.cells.binary_search(&cell),
            ) else {
                continue;
            };
            let states = &flowed[self.points_of(cell)];
            let gradients = group.gradients_of(place, positions);
            let pressures = group.smoothed_pressures(place, &gradients);
            let points = gradients.iter().zip(states).zip(pressures);
            let stresses: Vec<Stress> = points
                .map(|((gradient, state), pressure)| cauchy(law, state, *gradient).under(pressure))
                .collect();
            return match group.hourglass.is_empty() {
                true => stresses,
                false => vec![stresses[0]; group.n_nodes],
            };
        }
        self.cell_stress(cell, positions)
    }

    /// The numbers of the points of a cell among those that have flowed.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn points_of(&self, cell: usize) -> std::ops::Range<usize> {
        for group in &self.groups {
            if let Ok(place) = group.cells.binary_search(&cell) {
                let first = group.first_point + place * group.n_points;
                return first..first + group.n_points;
            }
        }
        panic!("there is no cell {cell}")
    }
}

impl CellGroup {
    /// Hands out energies (J) and new states of all points, by their number in the group.
    fn visit_flow(
        &self,
        law: &J2Plasticity,
        positions: &[f64],
        flowed: &[PlasticState],
        mut visit: impl FnMut(usize, FlowEnergy, PlasticState),
    ) {
        with_node_count!(self, visit_points(law, positions, flowed, &mut visit));
    }

    fn visit_points<const N: usize>(
        &self,
        law: &J2Plasticity,
        positions: &[f64],
        flowed: &[PlasticState],
        visit: &mut impl FnMut(usize, FlowEnergy, PlasticState),
    ) {
        for (cell, kinematics) in self.kinematics::<N>().enumerate() {
            let differences = gather(kinematics.nodes, positions);
            let points = kinematics.gradients.iter().zip(kinematics.volumes);
            for (point, (gradient, volume)) in points.enumerate() {
                let point = cell * self.n_points + point;
                let state = &flowed[point];
                let elastic = state.elastic(deformation_gradient(&differences, gradient));
                let mut flow = law.flow(state, elastic);
                let mut energy = FlowEnergy {
                    stored: volume * flow.stored,
                    dissipated: volume * flow.dissipated,
                };
                if let Some(hourglass) = self.hourglass.get(cell) {
                    let shape = flowing_shape(state, self.shape(cell, positions));
                    let limit = law.bending_limit(state, *volume);
                    let ([stored, dissipated], flowed) = hourglass.flow(limit, &shape);
                    // What the mean stress leaves for the next step: what is beyond flows now.
                    let left = (1.0 - flow.used * flow.used).max(0.0).sqrt();
                    flow.state.bendable = left.max(LEAST_BENDABLE.get());
                    let limit = law.bending_limit(&flow.state, *volume);
                    let shape = Shape { flowed, ..shape };
                    let (eased, flowed) = hourglass.ease(limit, &shape);
                    energy.stored += stored - eased;
                    energy.dissipated += dissipated + eased;
                    let bent = (dissipated + eased) / *volume;
                    flow.state.strain += law.bending_strain(state, bent);
                    flow.state.bend = match flow.state.inverse == state.inverse {
                        true => flowed,
                        // The placement of the point has flowed, too; what is elastic stays.
                        false => {
                            let now = flowing_shape(&flow.state, self.shape(cell, positions));
                            now.moved_to(&shape, flowed)
                        }
                    };
                }
                visit(point, energy, flow.state);
            }
        }
    }

    /// The hourglass modes of a cell between two shapes, after what has flowed.
    pub(super) fn bend(
        &self,
        law: &J2Plasticity,
        form: Form,
        (place, flowed): (usize, &PlasticState),
        pair: [Shape; 2],
    ) -> Bend {
        let [start, end] = pair.map(|shape| flowing_shape(flowed, shape));
        let limit = law.bending_limit(flowed, self.volumes[place]);
        let (_, gradients) = self.quad(place);
        Bend {
            answers: self.hourglass[place].flowing(form, limit, [&start, &end]),
            gradients: gradients.map(|gradient| flowed.gradient(gradient)),
            pair: [start, end],
        }
    }

    /// As for laws that do not flow, by the intermediate placement.
    pub(super) fn subtract_flowing_forces<const N: usize>(
        &self,
        law: &J2Plasticity,
        form: Form,
        positions: &[f64],
        (start, end): (&Deformed, &mut Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let points = self.points();
        let n = self.n_points;
        let cells = self
            .kinematics::<N>()
            .zip(start.gradients[points.clone()].chunks_exact(n))
            .zip(end.gradients[points.clone()].chunks_exact_mut(n))
            .zip(start.flowed[points].chunks_exact(n))
            .zip(&self.cells);
        for ((((cell, start), end), flowed), &index) in cells {
            let differences = gather(cell.nodes, positions);
            let mut force = [[0.0; 2]; N];
            for (point, state) in flowed.iter().enumerate() {
                let gradient = &cell.gradients[point];
                end[point] = deformation_gradient(&differences, gradient);
                let at = Invariants::of(end[point]);
                if !law.admits(at) {
                    return Err(Inadmissible {
                        cell: index,
                        jacobian: at.j,
                        law: law.name(),
                    });
                }
                let pair = [start[point], end[point]].map(|f| state.elastic(f));
                let ([a, b], _) = derivatives(law, form, state, pair);
                let volume = cell.volumes[point];
                let sums = [2.0 * a + b, 2.0 * a - b];
                let stress =
                    stress_of_sums(law.constants(), form, sums, pair).map(|part| volume * part);
                for (force, gradient) in force.iter_mut().zip(gradient) {
                    let [x, y] = state.gradient(*gradient);
                    force[0] += stress[0] * x + stress[1] * y;
                    force[1] += stress[2] * x + stress[3] * y;
                }
            }
            subtract(cell.nodes, force, residual);
        }
        Ok(())
    }

    /// As for laws that do not flow, by the intermediate placement.
    pub(super) fn add_flowing_tangent<const N: usize>(
        &self,
        law: &J2Plasticity,
        (form, kind): (Form, Linearization),
        (start, end): (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        let is_added = kind == Linearization::Consistent;
        let smoothing = Smoothing::of(self, form, (start, end)).unless(is_added);
        let points = self.points();
        let n = self.n_points;
        let cells = self
            .kinematics::<N>()
            .zip(start.gradients[points.clone()].chunks_exact(n))
            .zip(end.gradients[points.clone()].chunks_exact(n))
            .zip(start.flowed[points].chunks_exact(n))
            .zip(self.places.as_chunks::<N>().0.chunks_exact(N));
        for (place, ((((cell, start), end), flowed), places)) in cells.enumerate() {
            let (mut blocks, shifts) = ([[[0.0; 4]; N]; N], smoothing.shifts(place));
            for (point, state) in flowed.iter().enumerate() {
                let gradient = cell.gradients[point].map(|gradient| state.gradient(gradient));
                let pair = [start[point], end[point]].map(|f| state.elastic(f));
                let found = derivatives(law, form, state, pair);
                let (shift, asked) = (shifts[point], (form, kind));
                let moduli = smoothing.moduli(shift, law.constants(), asked, found, pair);
                let volume = cell.volumes[point];
                let share = kind.share(&gradient, &moduli, volume);
                add_point(&gradient, &moduli, share * volume, &mut blocks);
            }
            scatter(&blocks, places, matrix);
        }
    }
}

/// Hourglass modes that flow, in the intermediate placement of their cell.
pub(super) struct Bend {
    /// What their forces are those of, and what they rise as.
    answers: [Hourglass; 2],
    gradients: [[f64; 2]; 4],
    pair: [Shape; 2],
}

impl Bend {
    pub(super) fn add_force(&self, form: Form, force: &mut [[f64; 2]; 4]) {
        let [start, end] = &self.pair;
        self.answers[0].add_force(form, &self.gradients, (start, end), force);
    }

    pub(super) fn add_tangent(&self, of: (Form, Linearization), blocks: &mut [[[f64; 4]; 4]; 4]) {
        let ([start, end], [forces, rising]) = (&self.pair, &self.answers);
        forces.add_tangent_rising(rising, of, &self.gradients, (start, end), blocks);
    }
}

/// The shape of a cell in its intermediate placement.
fn flowing_shape(state: &PlasticState, shape: Shape) -> Shape {
    Shape {
        gradient: state.elastic(shape.gradient),
        flowed: state.bend,
        ..shape
    }
}

/// Share of its plastic bending that is left to a cell whose mean stress is the yield stress: without any its hourglass modes would have no
/// stiffness (-).
const LEAST_BENDABLE: Judged = LEAST_LEFT;

/// Cauchy's stress of a gradient of deformation after what has flowed (Pa).
fn cauchy(law: &J2Plasticity, state: &PlasticState, gradient: [f64; 4]) -> Stress {
    let elastic = state.elastic(gradient);
    let ([by_t, by_j], _) = law.at(state, elastic);
    let [xx, xy, yx, yy] = elastic;
    let volume = Invariants::of(gradient).j;
    let spherical = by_j * Invariants::of(elastic).j;
    Stress {
        xx: (2.0 * by_t * (xx * xx + xy * xy) + spherical) / volume,
        yy: (2.0 * by_t * (yx * yx + yy * yy) + spherical) / volume,
        xy: 2.0 * by_t * (xx * yx + xy * yy) / volume,
        zz: law.lateral_stress(state, elastic) / volume,
    }
}

/// The pair that a form takes, and its derivatives.
fn derivatives(
    law: &J2Plasticity,
    form: Form,
    state: &PlasticState,
    [start, end]: [[f64; 4]; 2],
) -> ([f64; 2], [f64; 3]) {
    match form {
        Form::Equilibrium => law.at(state, end),
        Form::EnergyMomentum { .. } => law.between(state, [start, end]),
    }
}
