//! Numbers of cells on their way between arrays and the registers in which the cells stand side by side.

use crate::fe::finite_strain::point::{each, invariants};
use crate::fe::material::hyperelastic::Invariants;
use crate::math::{LANES, Number, Wide};

/// Positions of the nodes of cells relative to their first ones (m).
#[inline(always)]
pub(super) fn gather<const N: usize>(cells: &[[u32; N]], positions: &[f64]) -> [[Wide; 2]; N] {
    let mut differences = [[Wide::ZERO; 2]; N];
    for lane in 0..LANES {
        let nodes = &cells[lane.min(cells.len() - 1)];
        let at = |node: u32| {
            let pair = &positions[2 * node as usize..][..2];
            [pair[0], pair[1]]
        };
        let origin = at(nodes[0]);
        for (difference, &node) in differences.iter_mut().zip(nodes) {
            let place = at(node);
            difference[0].0[lane] = place[0] - origin[0];
            difference[1].0[lane] = place[1] - origin[1];
        }
    }
    differences
}

/// Values of one point of each cell, which are `stride` apart.
#[inline(always)]
pub(super) fn read<const K: usize>(
    values: &[[f64; K]],
    stride: usize,
    n_cells: usize,
) -> [Wide; K] {
    let mut read = [Wide::ZERO; K];
    for lane in 0..LANES {
        let one = &values[lane.min(n_cells - 1) * stride];
        for (read, one) in read.iter_mut().zip(one) {
            read.0[lane] = *one;
        }
    }
    read
}

/// Writes values of one point of each cell, which are `stride` apart.
#[inline(always)]
pub(super) fn write<const K: usize>(
    of_cells: [Wide; K],
    stride: usize,
    n_cells: usize,
    values: &mut [[f64; K]],
) {
    for lane in 0..n_cells {
        for (value, of_cells) in values[lane * stride].iter_mut().zip(&of_cells) {
            *value = of_cells.0[lane];
        }
    }
}

/// Invariants of each cell.
#[inline(always)]
pub(super) fn invariants_of(gradient: [Wide; 4]) -> [Invariants; LANES] {
    let [t, j] = invariants(gradient);
    each(|lane| Invariants {
        t: t.0[lane],
        j: j.0[lane],
    })
}

/// The gradient of each cell.
#[inline(always)]
pub(super) fn one_by_one(gradient: [Wide; 4]) -> [[f64; 4]; LANES] {
    each(|lane| each(|k| gradient[k].0[lane]))
}

/// Values of each cell, side by side.
#[inline(always)]
pub(super) fn side_by_side<const K: usize>(of_lanes: [[f64; K]; LANES]) -> [Wide; K] {
    let mut parts = [Wide::ZERO; K];
    for (k, part) in parts.iter_mut().enumerate() {
        *part = Wide::from_fn(|lane| of_lanes[lane][k]);
    }
    parts
}
