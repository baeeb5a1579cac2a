//! Forces, energies and tangents of groups of cells with smoothed areas: what smoothing adds to those of the points.

use super::{Cell, Dilatation, N_MODES, Shift};
use crate::fe::element::MAX_POINTS;
use crate::fe::finite_strain::Inadmissible;
use crate::fe::finite_strain::cells::CellGroup;
use crate::fe::finite_strain::deformed::Deformed;
use crate::fe::finite_strain::linearization::Linearization;
use crate::fe::finite_strain::one_cell::{
    add_point, deformation_gradient, gather, scatter, subtract,
};
use crate::fe::finite_strain::point::{Form, cofactor, law_moduli};
use crate::fe::material::hyperelastic::PlasticState;
use crate::linalg::block_matrix::BlockMatrix;

impl Dilatation {
    /// A cell of a group with smoothed areas, by the gradients at its points at both ends, and what has flowed there before.
    fn cell<'a>(
        &'a self,
        group: &'a CellGroup,
        place: usize,
        gradients: [&[[f64; 4]]; 2],
        flowed: &[PlasticState],
    ) -> Cell<'a> {
        let n = group.n_points;
        let own = place * n..(place + 1) * n;
        let mut cell = Cell {
            of: self,
            modes: &self.modes[own.clone()],
            volumes: &group.volumes[own],
            ends: [[[0.0; 4]; MAX_POINTS]; 2],
            scales: [1.0; MAX_POINTS],
        };
        for (end, gradients) in cell.ends.iter_mut().zip(gradients) {
            end[..n].copy_from_slice(gradients);
        }
        for (point, state) in flowed.iter().enumerate() {
            let [a, b, c, d] = state.inverse;
            cell.scales[point] = 1.0 / (a * d - b * c);
            for end in &mut cell.ends {
                end[point] = state.elastic(end[point]);
            }
        }
        cell
    }

    /// A cell of a group between two states, and what has flowed there before the step.
    pub(super) fn cell_between<'a>(
        &'a self,
        group: &'a CellGroup,
        place: usize,
        (start, end): (&'a Deformed, &'a Deformed),
    ) -> (Cell<'a>, &'a [PlasticState]) {
        let first = group.points().start + place * group.n_points;
        let own = first..first + group.n_points;
        let flowed = match group.solid.law.plasticity() {
            Some(_) => &start.flowed[own.clone()],
            None => &[],
        };
        let gradients = [&start.gradients[own.clone()], &end.gradients[own]];
        (self.cell(group, place, gradients, flowed), flowed)
    }

    fn cells<'a>(
        &'a self,
        group: &'a CellGroup,
        pair: (&'a Deformed, &'a Deformed),
    ) -> impl Iterator<Item = (Cell<'a>, &'a [PlasticState])> {
        (0..group.cells.len()).map(move |place| self.cell_between(group, place, pair))
    }

    /// What the smoothed areas add to the stored energy (J) at these positions (m).
    pub(in crate::fe::finite_strain) fn energy<const N: usize>(
        &self,
        group: &CellGroup,
        positions: &[f64],
    ) -> f64 {
        let cells = group.kinematics::<N>().enumerate();
        cells
            .map(|(place, cell)| {
                let differences = gather(cell.nodes, positions);
                let mut gradients = [[0.0; 4]; MAX_POINTS];
                for (at, gradient) in gradients.iter_mut().zip(cell.gradients) {
                    *at = deformation_gradient(&differences, gradient);
                }
                let gradients = &gradients[..group.n_points];
                self.cell(group, place, [gradients; 2], &[]).energy()
            })
            .sum()
    }

    /// What smoothing changes at the points of a cell at equilibrium, by their gradients; nothing where there is no energy.
    pub(in crate::fe::finite_strain) fn pressures(
        &self,
        group: &CellGroup,
        place: usize,
        gradients: &[[f64; 4]],
    ) -> Vec<f64> {
        let cell = self.cell(group, place, [gradients; 2], &[]);
        let slopes = cell.smooth_slopes(Form::Equilibrium);
        let shifts = slopes.map(|slopes| cell.shifts(Form::Equilibrium, &slopes));
        let shifts = shifts.unwrap_or_default().into_iter();
        let pressures = shifts.map(|shift| shift.pressure);
        pressures.take(group.n_points).collect()
    }

    /// Subtracts the forces (N) that smoothing adds, between states whose gradients are known.
    pub(in crate::fe::finite_strain) fn subtract_forces<const N: usize>(
        &self,
        group: &CellGroup,
        form: Form,
        pair: (&Deformed, &Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let cells = self.cells(group, pair).zip(group.kinematics::<N>());
        for (place, ((cell, flowed), kinematics)) in cells.enumerate() {
            let slopes = cell.smooth_slopes(form).map_err(|jacobian| Inadmissible {
                cell: group.cells[place],
                jacobian,
                law: group.solid.law.name(),
            })?;
            let shifts = cell.shifts(form, &slopes);
            let mut force = [[0.0; 2]; N];
            for (point, gradient) in kinematics.gradients.iter().enumerate() {
                let at = form.gradient_of(cell.ends[0][point], cell.ends[1][point]);
                let Shift { slope, decay, .. } = shifts[point];
                let weight = cell.volumes[point] * (slope + decay);
                let stress = cofactor(at).map(|part| weight * part);
                for (force, by) in force.iter_mut().zip(gradient) {
                    let [x, y] = flowed.get(point).map_or(*by, |state| state.gradient(*by));
                    force[0] += stress[0] * x + stress[1] * y;
                    force[1] += stress[2] * x + stress[3] * y;
                }
            }
            subtract(kinematics.nodes, force, residual);
        }
        Ok(())
    }

    /// Adds what smoothing changes in the tangent: all of it to a consistent one, else what a smoothed area answers, to points that know of their
    /// [`Smoothing`](super::Smoothing).
    pub(in crate::fe::finite_strain) fn add_tangent<const N: usize>(
        &self,
        group: &CellGroup,
        (form, kind): (Form, Linearization),
        pair: (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        let cells = self
            .cells(group, pair)
            .zip(group.kinematics::<N>())
            .zip(group.places.as_chunks::<N>().0.chunks_exact(N));
        for (((cell, flowed), kinematics), places) in cells {
            // A place without energy is seen by the forces, which are asked first.
            let Ok(slopes) = cell.smooth_slopes(form) else {
                continue;
            };
            let shifts = cell.shifts(form, &slopes);
            let decay = cell.decay(form);
            let mut blocks = [[[0.0; 4]; N]; N];
            let mut along = [[[0.0; 2]; N]; N_MODES];
            let mut growing = [[[0.0; 2]; N]; N_MODES];
            for (point, gradient) in kinematics.gradients.iter().enumerate() {
                let at = form.gradient_of(cell.ends[0][point], cell.ends[1][point]);
                let by = gradient.map(|by| flowed.get(point).map_or(by, |one| one.gradient(by)));
                let (volume, modes) = (cell.volumes[point], &cell.modes[point]);
                if kind == Linearization::Consistent {
                    let shift = shifts[point];
                    let pair = [0.0, shift.slope + shift.decay];
                    let second = [0.0, 0.0, -shift.fall - 2.0 * decay];
                    let moduli = law_moduli(at, pair, second, form.share_of_end());
                    add_point(&by, &moduli, volume, &mut blocks);
                }
                let scale = volume * cell.scales[point];
                project(
                    cofactor(at),
                    &by,
                    modes.map(|mode| scale * mode),
                    &mut along,
                );
                if decay > 0.0 {
                    let weights = modes.map(|mode| volume * mode);
                    project(cofactor(at), &by, weights, &mut growing);
                }
            }
            let mut smooth = [[[0.0; 4]; N]; N];
            add_modes(&along, &cell.answers(&slopes, kind), &mut smooth);
            if decay > 0.0 {
                let answers = std::array::from_fn(|k| {
                    std::array::from_fn(|l| if k == l { decay } else { 0.0 })
                });
                add_modes(&growing, &answers, &mut smooth);
            }
            let share = share_of(kind, &smooth);
            for (row, own) in blocks.iter_mut().zip(&smooth) {
                for (block, own) in row.iter_mut().zip(own) {
                    for (entry, own) in block.iter_mut().zip(own) {
                        *entry += share * own;
                    }
                }
            }
            scatter(&blocks, places, matrix);
        }
    }
}

/// Adds `w φ_m S ∇N_a`: what the amplitude of a mode changes by as a node moves, of a field that changes by `S : dF`.
fn project<const N: usize>(
    stress: [f64; 4],
    gradient: &[[f64; 2]; N],
    weights: [f64; N_MODES],
    out: &mut [[[f64; 2]; N]; N_MODES],
) {
    let [xx, xy, yx, yy] = stress;
    for (a, &[x, y]) in gradient.iter().enumerate() {
        let own = [xx * x + xy * y, yx * x + yy * y];
        for (row, weight) in out.iter_mut().zip(weights) {
            row[a][0] += weight * own[0];
            row[a][1] += weight * own[1];
        }
    }
}

/// Adds `Σ v_m Q_mn v_nᵀ` to the blocks `a <= b`.
fn add_modes<const N: usize>(
    along: &[[[f64; 2]; N]; N_MODES],
    answers: &[[f64; N_MODES]; N_MODES],
    blocks: &mut [[[f64; 4]; N]; N],
) {
    for b in 0..N {
        let answer = answers.map(|row| {
            let pairs = row.iter().zip(along);
            pairs.fold([0.0; 2], |[x, y], (share, along)| {
                [x + share * along[b][0], y + share * along[b][1]]
            })
        });
        for (a, row) in blocks.iter_mut().enumerate().take(b + 1) {
            let block = &mut row[b];
            for (own, answer) in along.iter().zip(answer) {
                let [x, y] = own[a];
                block[0] += x * answer[0];
                block[1] += x * answer[1];
                block[2] += y * answer[0];
                block[3] += y * answer[1];
            }
        }
    }
}

/// Share of a cell's smoothed stiffness that counts, as [`Linearization::share`] has it of a point's.
fn share_of<const N: usize>(kind: Linearization, blocks: &[[[f64; 4]; N]; N]) -> f64 {
    let Linearization::Impulsive { most } = kind else {
        return 1.0;
    };
    let own = |a: usize| blocks[a][a][0] + blocks[a][a][3];
    let stiffness = (0..N).map(own).fold(0.0, f64::max);
    if stiffness > most {
        most / stiffness
    } else {
        1.0
    }
}
