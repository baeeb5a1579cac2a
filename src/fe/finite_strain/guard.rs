//! What keeps cells from turning inside out at their nodes and between their corners, where the law has no energy for what is turned.
//!
//! The law sees the gradient `F` of a cell at its quadrature points, whose determinants stay above zero while a corner folds over: a bow tie.
//! With `J = det F` at the nodes,
//!
//! ```text
//! W = κ V f(J/J0),    f(z) = (1 - z)³/z  for z < 1,  else 0
//! ```
//!
//! per node of a cell and its share `V` of the volume, and for the straight triangle between the corners of one with curved sides: twice
//! continuously differentiable, convex, and infinite where a corner is flat, as the barriers are that keep surfaces apart elsewhere (Li et al., 2020). The energy that comes decides how flat a corner may get, not rounding: a
//! thousand `κ V` leave a ten-thousandth of the area. It is an energy of the invariant `J` like any other, and with its slope between
//! the ends of a step it conserves energy and both momenta.

mod barrier;

use self::barrier::{FLAT, guard_energy, slopes};
use super::Inadmissible;
use super::cells::CellGroup;
use super::deformed::Deformed;
use super::linearization::Linearization;
use super::one_cell::{add_point, deformation_gradient, gather, scatter, subtract};
use super::point::{Form, cofactor, invariants, law_moduli};
use crate::fe::element::{Element, MAX_NODES, Tri3, kinematics::physical_gradient};
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants};
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{LANES, Wide, rounding};

/// Rounding that a bound on `J` may have (-), far above that of a few sums.
const ROUNDING: f64 = rounding::SHARE;

/// A gradient that turns what it deforms inside out.
const TURNED: [f64; 4] = [1.0, 0.0, 0.0, -1.0];

/// Places that are guarded in a cell of so many nodes: its nodes, and what is between the corners of six, or at each corner of the straight cell
/// of eight.
///
/// Six determinants above zero leave room for a side that bends around the corner opposite.
const fn n_guarded(n_nodes: usize) -> usize {
    match n_nodes {
        6 => 7,
        8 => 12,
        n => n,
    }
}

/// The guarded places of a group of cells: those of all of them, or none.
#[derive(Clone, Debug, Default)]
pub(super) struct Guards {
    /// `dN_a/dX` (1/m) at the places, shape `(n_cells, n_guarded, n_nodes)`.
    gradients: Vec<[f64; 2]>,
    /// `κ V` (J), shape `(n_cells, n_guarded)`; zero where a cell has no gradient, as where two sides are one line.
    energies: Vec<f64>,
}

/// A cell of which a place may be flat: its number in the group, nodes, gradients of the shape functions at the guarded places, and `κ V`.
type Guarded<'a, const N: usize> = (usize, &'a [u32; N], &'a [[[f64; 2]; N]], &'a [f64]);

/// How far `F` at the guarded places of cells side by side may be from that at one point.
///
/// A place has `F = F_0 + Σ_a (d_a - F_0 D_a) ⊗ dN_a/dX` with the differences `d_a` of the positions and `D_a` of those at rest, so it is within
/// `E = max |d_a - F_0 D_a| max Σ_a |dN_a/dX|` of `F_0`, and `det F >= det F_0 - |F_0| E - E²/2`.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    rest: [[Wide; 2]; MAX_NODES],
    /// The largest `Σ_a |dN_a/dX|` of a place of each cell (1/m).
    spread: Wide,
    /// `dN_a/dX` (1/m), shape `(n_guarded, n_nodes)`; of places that have none those of another.
    gradients: Vec<[Wide; 2]>,
}

impl Reach {
    /// That of the cells of a group that stand in the lanes.
    pub fn of(group: &CellGroup, cell: impl Fn(usize) -> usize, rest_positions: &[f64]) -> Self {
        let (n, n_places) = (group.n_nodes, n_guarded(group.n_nodes));
        let mut rest = [[Wide::default(); 2]; MAX_NODES];
        for (node, rest) in rest.iter_mut().enumerate().take(n) {
            let at = |lane: usize, node: usize, axis: usize| {
                rest_positions[2 * group.nodes[cell(lane) * n + node] as usize + axis]
            };
            *rest = [0, 1].map(|k| Wide::from_fn(|lane| at(lane, node, k) - at(lane, 0, k)));
        }
        let spread = |lane| {
            let first = cell(lane) * n_places * n;
            let places = group.guards.gradients[first..first + n_places * n].chunks_exact(n);
            let spreads = places.map(|gradient| {
                let lengths = gradient[1..].iter().map(|[x, y]| (x * x + y * y).sqrt());
                lengths.sum::<f64>()
            });
            spreads.fold(0.0, f64::max)
        };
        let mut gradients = Vec::new();
        for place in 0..n_places {
            let of_lane = |lane: usize| {
                let first = cell(lane) * n_places;
                let own = first..first + n_places;
                let energies = &group.guards.energies[own.clone()];
                let counted = |place: &usize| energies[*place] > 0.0;
                let other = Some(place).filter(counted);
                let other = other.or_else(|| (0..n_places).find(counted));
                (first + other.unwrap_or(place)) * n
            };
            for node in 0..n {
                let of = |lane: usize, k: usize| group.guards.gradients[of_lane(lane) + node][k];
                gradients.push([0, 1].map(|k| Wide::from_fn(|lane| of(lane, k))));
            }
        }
        Self {
            rest,
            spread: Wide::from_fn(spread),
            gradients,
        }
    }

    /// Which cells have a flat place, with the differences of their positions and `F` at a point of each: the places are looked at only where
    /// they may be flat.
    #[inline(always)]
    pub fn find_flat<const N: usize>(
        &self,
        differences: &[[Wide; 2]; N],
        at: [Wide; 4],
    ) -> [bool; LANES] {
        let mut farthest = Wide::default();
        for (&[x, y], &[rest_x, rest_y]) in differences.iter().zip(&self.rest).skip(1) {
            let off_x = x - (at[0] * rest_x + at[1] * rest_y);
            let off_y = y - (at[2] * rest_x + at[3] * rest_y);
            farthest = farthest.max(off_x * off_x + off_y * off_y);
        }
        let off = farthest.sqrt() * self.spread;
        let [t, j] = invariants(at);
        let least = j - t.sqrt() * off - off * off * 0.5;
        let is_far = |least: f64| least > FLAT * (1.0 + ROUNDING);
        if least.0.iter().all(|least| is_far(*least)) {
            return [false; LANES];
        }
        let mut is_flat = [false; LANES];
        for gradient in self.gradients.as_chunks::<N>().0 {
            let [_, j] = invariants(deformation_gradient(differences, gradient));
            for (is_flat, j) in is_flat.iter_mut().zip(j.0) {
                // What is not a number is looked at.
                *is_flat |= j < FLAT.get() || j.is_nan();
            }
        }
        is_flat
    }
}

impl Guards {
    /// Adds the nodes of a cell, if the law and the element want them guarded.
    pub fn add(
        &mut self,
        element: &dyn Element,
        corners: &[[f64; 2]],
        law: &dyn Hyperelastic,
        thickness: f64,
    ) {
        // Of three nodes the gradient is the same everywhere.
        let nodes = element.reference_nodes();
        if nodes.len() == 3 || law.admits(Invariants::of(TURNED)) {
            return;
        }
        let constants = law.constants();
        let modulus = constants.lambda() + 2.0 * constants.mu();
        let area: f64 = element.quadrature().iter().map(|point| point.weight).sum();
        let share = area / nodes.len() as f64;
        let mut push = |gradient: &[[f64; 2]], determinant: f64| {
            self.gradients.extend_from_slice(&gradient[..nodes.len()]);
            self.energies
                .push(modulus * determinant * share * thickness);
        };
        for &at in nodes {
            let mut gradient = [[0.0; 2]; MAX_NODES];
            let found = physical_gradient(element, corners, at, &mut gradient[..nodes.len()]);
            push(&gradient, found.unwrap_or(0.0));
        }
        if nodes.len() == 8 {
            for corner in 0..4 {
                let local = [corner, (corner + 1) % 4, (corner + 3) % 4];
                let mut own = [[0.0; 2]; 3];
                let places = local.map(|node| corners[node]);
                let found = physical_gradient(&Tri3, &places, [0.0; 2], &mut own);
                let mut gradient = [[0.0; 2]; MAX_NODES];
                for (node, own) in local.into_iter().zip(own) {
                    gradient[node] = own;
                }
                // The unit square of the triangle's determinant is a quarter of the natural square.
                push(&gradient, 0.25 * found.unwrap_or(0.0));
            }
        }
        if nodes.len() == 6 {
            let mut gradient = [[0.0; 2]; MAX_NODES];
            let found = physical_gradient(&Tri3, &corners[..3], [0.0; 2], &mut gradient[..3]);
            push(&gradient, found.unwrap_or(0.0));
        }
    }

    /// Number of guarded places.
    pub fn len(&self) -> usize {
        self.energies.len()
    }
}

impl CellGroup {
    fn guarded<const N: usize>(
        &self,
        is_wanted: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = Guarded<'_, N>> {
        let nodes = self.nodes.as_chunks::<N>().0.iter();
        let n = n_guarded(N);
        let gradients = self.guards.gradients.as_chunks::<N>().0.chunks_exact(n);
        let energies = self.guards.energies.chunks_exact(n);
        let cells = nodes.zip(gradients).zip(energies).enumerate();
        cells
            .filter(move |(place, _)| is_wanted(*place))
            .map(|(place, ((nodes, gradients), energies))| (place, nodes, gradients, energies))
    }

    /// Cells of which a place may be flat at the beginning or at the end of a step.
    fn near_flat<'a, const N: usize>(
        &'a self,
        start: &'a Deformed,
        end: &'a Deformed,
    ) -> impl Iterator<Item = Guarded<'a, N>> {
        let range = self.flat_places();
        let [start, end] = [start, end].map(|one| &one.is_flat[range.clone()]);
        self.guarded(move |place| start[place] || end[place])
    }

    /// Stored energy of the guards of one cell (J).
    pub(super) fn guard_energy<const N: usize>(&self, place: usize, positions: &[f64]) -> f64 {
        let n = n_guarded(N);
        let differences = gather(&self.nodes.as_chunks::<N>().0[place], positions);
        let gradients = &self.guards.gradients.as_chunks::<N>().0[place * n..][..n];
        let places = gradients
            .iter()
            .zip(&self.guards.energies[place * n..][..n]);
        let energies = places.map(|(gradient, unit)| {
            let f = deformation_gradient(&differences, gradient);
            guard_energy(*unit, Invariants::of(f).j)
        });
        energies.sum()
    }

    /// `dN_a/dX` (1/m) at the guarded places of one cell.
    #[cfg(test)]
    pub(super) fn guard_gradients<const N: usize>(
        &self,
        place: usize,
    ) -> impl Iterator<Item = &[[f64; 2]; N]> {
        let n = n_guarded(N);
        self.guards.gradients.as_chunks::<N>().0[place * n..][..n].iter()
    }

    /// That of all cells (J).
    pub(super) fn guards_energy<const N: usize>(&self, positions: &[f64]) -> f64 {
        let is_guarded = self.guards.len() > 0;
        let cells = 0..if is_guarded { self.cells.len() } else { 0 };
        cells
            .map(|place| self.guard_energy::<N>(place, positions))
            .sum()
    }

    /// Subtracts the forces of the guards.
    pub(super) fn subtract_guard_forces<const N: usize>(
        &self,
        law: &dyn Hyperelastic,
        form: Form,
        (start, end): (&Deformed, &Deformed),
        residual: &mut [f64],
    ) -> Result<(), Inadmissible> {
        for (place, nodes, gradients, energies) in self.near_flat::<N>(start, end) {
            let pair = [start, end].map(|one| gather(nodes, &one.positions));
            for (gradient, unit) in gradients.iter().zip(energies) {
                let [start, end] = pair.map(|of| deformation_gradient(&of, gradient));
                let (before, after) = (Invariants::of(start).j, Invariants::of(end).j);
                if *unit == 0.0 || before.min(after) >= FLAT {
                    continue;
                }
                if after <= 0.0 {
                    return Err(Inadmissible {
                        cell: self.cells[place],
                        jacobian: after,
                        law: law.name(),
                    });
                }
                let at = form.gradient_of(start, end);
                let slope = unit * slopes(form, before, after)[0];
                let stress = cofactor(at).map(|part| slope * part);
                let force = gradient
                    .map(|[x, y]| [stress[0] * x + stress[1] * y, stress[2] * x + stress[3] * y]);
                subtract(nodes, force, residual);
            }
        }
        Ok(())
    }

    /// Adds the tangent of the guards.
    pub(super) fn add_guard_tangent<const N: usize>(
        &self,
        (form, kind): (Form, Linearization),
        (start, end): (&Deformed, &Deformed),
        matrix: &mut BlockMatrix,
    ) {
        let scale = form.share_of_end();
        for (place, nodes, gradients, energies) in self.near_flat::<N>(start, end) {
            let places = &self.places.as_chunks::<N>().0[place * N..][..N];
            let pair = [start, end].map(|one| gather(nodes, &one.positions));
            for (gradient, unit) in gradients.iter().zip(energies) {
                let [start, end] = pair.map(|of| deformation_gradient(&of, gradient));
                let (before, after) = (Invariants::of(start).j, Invariants::of(end).j);
                if *unit == 0.0 || before.min(after) >= FLAT {
                    continue;
                }
                let [slope, rise] = slopes(form, before, after);
                let slope = match kind {
                    Linearization::Consistent => slope,
                    Linearization::Definite | Linearization::Impulsive { .. } => 0.0,
                };
                let at = form.gradient_of(start, end);
                // The area of what turns as a whole stays: no turn is resisted.
                let moduli = law_moduli(at, [0.0, slope], [0.0, 0.0, rise / scale], scale);
                let share = kind.share(gradient, &moduli, *unit);
                let mut blocks = [[[0.0; 4]; N]; N];
                add_point(gradient, &moduli, share * unit, &mut blocks);
                scatter(&blocks, places, matrix);
            }
        }
    }
}
