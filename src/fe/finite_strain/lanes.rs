//! Forces and tangents of four cells at a time, side by side in the registers of the machine.
//!
//! Every cell gets the digits that it would get by itself: a lane knows of no other, and sums are taken in the same order.

mod exchange;

use self::exchange::{gather, invariants_of, one_by_one, read, side_by_side, write};
use super::Inadmissible;
use super::cells::CellGroup;
use super::deformed::Deformed;
use super::guard::Reach;
use super::hourglass::{Hourglass, Shape};
use super::one_cell::{add_point, deformation_gradient};
use super::point::{Form, consistent_moduli, each, stress_of_sums};
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants};
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{LANES, Number, Wide};
use faer::traits::pulp::{Arch, Simd, WithSimd};

/// Shape functions and volumes of the cells of a group, four side by side; the last ones are repeated where their number asks for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Packs {
    /// `dN_a/dX` (1/m), shape `(n_packs, n_points, n_nodes)`.
    gradients: Vec<[Wide; 2]>,
    /// `w det J thickness` (m^3), shape `(n_packs, n_points)`.
    volumes: Vec<Wide>,
    /// What tells from the nodes of a cell that none of its places is flat; none where no place is guarded.
    reach: Vec<Reach>,
    /// The modes that the one point of a cell does not see, or none of any.
    hourglass: Vec<Hourglass<Wide>>,
}

impl Packs {
    /// Puts the cells of a group side by side.
    pub fn of(group: &CellGroup, rest_positions: &[f64]) -> Self {
        let (n, n_nodes) = (group.n_points, group.n_nodes);
        let n_cells = group.cells.len();
        let mut packs = Self::default();
        for first in (0..n_cells).step_by(LANES) {
            let cell = |lane: usize| (first + lane).min(n_cells - 1);
            for point in 0..n {
                for node in 0..n_nodes {
                    let place = |lane| (cell(lane) * n + point) * n_nodes + node;
                    let along =
                        |axis: usize| Wide::from_fn(|lane| group.gradients[place(lane)][axis]);
                    packs.gradients.push([along(0), along(1)]);
                }
                let volume = |lane| group.volumes[cell(lane) * n + point];
                packs.volumes.push(Wide::from_fn(volume));
            }
            if !group.hourglass.is_empty() {
                let modes = each(|lane| &group.hourglass[cell(lane)]);
                packs.hourglass.push(Hourglass::side_by_side(modes));
            }
            if group.guards.len() > 0 {
                packs.reach.push(Reach::of(group, cell, rest_positions));
            }
        }
        packs
    }
}

/// Gradients at the points of a group.
pub(super) struct Deform<'a, const N: usize> {
    pub group: &'a CellGroup,
    pub positions: &'a [f64],
    pub out: &'a mut Deformed,
}

impl<const N: usize> Deform<'_, N> {
    /// Writes them, and which cells may be flat.
    pub fn run(self) {
        Arch::new().dispatch(self);
    }
}

impl<const N: usize> WithSimd for Deform<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (group, n) = (self.group, self.group.n_points);
        let out = &mut self.out.gradients[group.points()];
        let is_flat = &mut self.out.is_flat[group.flat_places()];
        for (pack, cells) in group.nodes.as_chunks::<N>().0.chunks(LANES).enumerate() {
            let first = pack * LANES;
            let differences = gather(cells, self.positions);
            let mut one = [Wide::ZERO; 4];
            for point in 0..n {
                let gradient = &group.packs.gradients.as_chunks::<N>().0[pack * n + point];
                let f = deformation_gradient(&differences, gradient);
                write(f, n, cells.len(), &mut out[first * n + point..]);
                if point == 0 {
                    one = f;
                }
            }
            if let Some(reach) = group.packs.reach.get(pack) {
                let found = reach.find_flat(&differences, one);
                is_flat[first..first + cells.len()].copy_from_slice(&found[..cells.len()]);
            }
        }
    }
}

/// The stored energy of a group, but for its hourglass modes.
pub(super) struct PointEnergy<'a, const N: usize> {
    pub group: &'a CellGroup,
    pub law: &'a dyn Hyperelastic,
    pub positions: &'a [f64],
}

impl<const N: usize> PointEnergy<'_, N> {
    /// Energy of points and guarded places (J).
    pub fn sum(self) -> f64 {
        Arch::new().dispatch(self)
    }
}

impl<const N: usize> WithSimd for PointEnergy<'_, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let (group, n) = (self.group, self.group.n_points);
        let (mut energy, mut guards) = ([0.0; LANES], 0.0);
        for (pack, cells) in group.nodes.as_chunks::<N>().0.chunks(LANES).enumerate() {
            let differences = gather(cells, self.positions);
            let mut one = [Wide::ZERO; 4];
            for point in 0..n {
                let place = pack * n + point;
                let gradient = &group.packs.gradients.as_chunks::<N>().0[place];
                let f = deformation_gradient(&differences, gradient);
                if point == 0 {
                    one = f;
                }
                let densities = self.law.energies_of(&one_by_one(f));
                let volume = group.packs.volumes[place];
                let own = energy.iter_mut().zip(densities).zip(volume.0);
                for ((energy, density), volume) in own.take(cells.len()) {
                    *energy += volume * density;
                }
            }
            if let Some(reach) = group.packs.reach.get(pack) {
                let found = reach.find_flat(&differences, one);
                for lane in (0..cells.len()).filter(|&lane| found[lane]) {
                    guards += group.guard_energy::<N>(pack * LANES + lane, self.positions);
                }
            }
        }
        energy.iter().sum::<f64>() + guards
    }
}

/// The forces of the points of a group.
pub(super) struct PointForces<'a, const N: usize> {
    pub group: &'a CellGroup,
    pub law: &'a dyn Hyperelastic,
    pub form: Form,
    pub positions: &'a [f64],
    pub start: &'a Deformed,
    pub end: &'a mut Deformed,
    pub residual: &'a mut [f64],
}

impl<const N: usize> PointForces<'_, N> {
    /// Subtracts them, and writes gradients and flat cells of the end.
    pub fn subtract(self) -> Result<(), Inadmissible> {
        Arch::new().dispatch(self)
    }

    /// Who has no energy.
    #[cold]
    fn refused(&self, first: usize, at: &[Invariants; LANES]) -> Inadmissible {
        let lane = at.iter().position(|at| !self.law.admits(*at));
        let lane = lane.unwrap_or(0);
        let cells = &self.group.cells;
        Inadmissible {
            cell: cells[(first + lane).min(cells.len() - 1)],
            jacobian: at[lane].j,
            law: self.law.name(),
        }
    }
}

impl<const N: usize> WithSimd for PointForces<'_, N> {
    type Output = Result<(), Inadmissible>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let (group, n) = (self.group, self.group.n_points);
        let constants = self.law.constants();
        let points = group.points();
        let starts = &self.start.gradients[points.clone()];
        let ends = &mut self.end.gradients[points.clone()];
        let is_flat = &mut self.end.is_flat[group.flat_places()];
        for (pack, cells) in group.nodes.as_chunks::<N>().0.chunks(LANES).enumerate() {
            let first = pack * LANES;
            let differences = gather(cells, self.positions);
            let mut force = [[Wide::ZERO; 2]; N];
            let mut one = [Wide::ZERO; 4];
            for point in 0..n {
                let place = pack * n + point;
                let gradient = &group.packs.gradients.as_chunks::<N>().0[place];
                let end = deformation_gradient(&differences, gradient);
                let slot = first * n + point;
                write(end, n, cells.len(), &mut ends[slot..]);
                if point == 0 {
                    one = end;
                }
                let after = invariants_of(end);
                if !self.law.admits_all(&after) {
                    let own = PointForces {
                        end: self.end,
                        ..self
                    };
                    return Err(own.refused(first, &after));
                }
                let start = read(&starts[slot..], n, cells.len());
                let to = one_by_one(end);
                let sums = match self.form {
                    Form::Equilibrium => self.law.conserving_sums_of(&to, &to),
                    Form::EnergyMomentum { .. } => {
                        self.law.conserving_sums_of(&one_by_one(start), &to)
                    }
                };
                let sums = side_by_side(sums);
                let volume = group.packs.volumes[place];
                let stress = stress_of_sums(constants, self.form, sums, [start, end]);
                let stress = each(|k| volume * stress[k]);
                for (force, [x, y]) in force.iter_mut().zip(gradient) {
                    force[0] += stress[0] * *x + stress[1] * *y;
                    force[1] += stress[2] * *x + stress[3] * *y;
                }
            }
            if let Some(hourglass) = group.packs.hourglass.get(pack) {
                let (own, modes) = (points.start + first, cells.len());
                let amplitude = hourglass.amplitude(&differences);
                write(amplitude, 1, modes, &mut self.end.amplitudes[own..]);
                let start = Shape {
                    gradient: read(&starts[first..], 1, modes),
                    amplitude: read(&self.start.amplitudes[own..], 1, modes),
                    flowed: [Wide::ZERO; 2],
                };
                let end = Shape {
                    gradient: one,
                    amplitude,
                    flowed: [Wide::ZERO; 2],
                };
                let gradient = &group.packs.gradients.as_chunks::<N>().0[pack];
                hourglass.add_force(self.form, gradient, (&start, &end), &mut force);
            }
            for (lane, nodes) in cells.iter().enumerate() {
                for (&node, [x, y]) in nodes.iter().zip(&force) {
                    let residual = &mut self.residual[2 * node as usize..][..2];
                    residual[0] -= x.0[lane];
                    residual[1] -= y.0[lane];
                }
            }
            if let Some(reach) = group.packs.reach.get(pack) {
                let found = reach.find_flat(&differences, one);
                is_flat[first..first + cells.len()].copy_from_slice(&found[..cells.len()]);
            }
        }
        Ok(())
    }
}

/// The consistent tangent of the points of a group.
pub(super) struct PointTangent<'a, const N: usize> {
    pub group: &'a CellGroup,
    pub law: &'a dyn Hyperelastic,
    pub form: Form,
    pub start: &'a Deformed,
    pub end: &'a Deformed,
    pub matrix: &'a mut BlockMatrix,
}

impl<const N: usize> PointTangent<'_, N> {
    /// Adds it.
    pub fn add(self) {
        Arch::new().dispatch(self);
    }
}

impl<const N: usize> WithSimd for PointTangent<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (group, n) = (self.group, self.group.n_points);
        let constants = self.law.constants();
        let points = group.points();
        let first_point = points.start;
        let starts = &self.start.gradients[points.clone()];
        let ends = &self.end.gradients[points];
        let cells = group.nodes.as_chunks::<N>().0.chunks(LANES);
        let places = group.places.as_chunks::<N>().0;
        for (pack, cells) in cells.enumerate() {
            let first = pack * LANES;
            let mut blocks = [[[Wide::ZERO; 4]; N]; N];
            for point in 0..n {
                let place = pack * n + point;
                let gradient = &group.packs.gradients.as_chunks::<N>().0[place];
                let slot = first * n + point;
                let start = read(&starts[slot..], n, cells.len());
                let end = read(&ends[slot..], n, cells.len());
                let (before, after) = (invariants_of(start), invariants_of(end));
                let (pair, second) = match self.form {
                    Form::Equilibrium => (self.law.gradients(&after), self.law.hessians(&after)),
                    Form::EnergyMomentum { .. } => (
                        self.law.conserving_pairs(&before, &after),
                        self.law.conserving_hessians(&before, &after),
                    ),
                };
                let derivatives = (side_by_side(pair), side_by_side(second));
                let moduli = consistent_moduli(constants, self.form, derivatives, [start, end]);
                add_point(gradient, &moduli, group.packs.volumes[place], &mut blocks);
                if let Some(hourglass) = group.packs.hourglass.get(pack) {
                    let (own, modes) = (first_point + first, cells.len());
                    let shape = |gradient, amplitudes: &[[f64; 2]]| Shape {
                        gradient,
                        amplitude: read(&amplitudes[own..], 1, modes),
                        flowed: [Wide::ZERO; 2],
                    };
                    let start = shape(start, &self.start.amplitudes);
                    let end = shape(end, &self.end.amplitudes);
                    let pair = (&start, &end);
                    hourglass.add_consistent_tangent(self.form, gradient, pair, &mut blocks);
                }
            }
            for lane in 0..cells.len() {
                let places = &places[(first + lane) * N..][..N];
                for (a, row) in blocks.iter().enumerate() {
                    for (b, block) in row.iter().enumerate().skip(a) {
                        let [xx, xy, yx, yy] = each(|k| block[k].0[lane]);
                        self.matrix
                            .add_block_at(places[a][b] as usize, [xx, xy, yx, yy]);
                        if a != b {
                            self.matrix
                                .add_block_at(places[b][a] as usize, [xx, yx, xy, yy]);
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
