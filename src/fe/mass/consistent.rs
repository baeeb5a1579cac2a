//! Redistribution of a consistent mass matrix (Khenous, Laborde, Renard 2008): rows of massless nodes vanish, and what they
//! held is kept by the nodes inside.
//!
//! What massless nodes share with a massive one goes to its diagonal, what they have among themselves moves inwards as nodal
//! masses do. Then `m_ij' = m_ij (p_i + p_j)/2` with `p = 1 + w q`, `q` linear in `1`, `X`, `Y` and `X² + Y²`, restores
//! `1·M 1`, `1·M x` and `x·M x`; all of them are linear in `p`.

use super::moments::Frame;
use super::{KEPT, MassError, Redistribution, extremes, move_inwards};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::complementarity::solve_lu_in_place;
use crate::math::{judged::Judged, rounding};

/// A massive node keeps at least this part of its rows: `m_ij (p_i + p_j)/2` is positive definite while p hardly changes from
/// node to node.
const SMALLEST: Judged = Judged::new("fe::SMALLEST", 0.3);

/// Loss of a pivot at which a condition is one of those before it.
const DEPENDENT: f64 = rounding::SHARE;

const N_TERMS: usize = 4;

/// Moves the consistent mass of massless nodes inwards and restores the moments of the whole, as
/// [`redistribute`](super::redistribute) does with nodal masses; all second moments but the polar one are left alone.
///
/// - `weight`: how readily a node's mass is changed for that (-), shape `(n)`.
///
/// # Errors
/// [`MassError`]; the matrix is then unchanged.
pub fn redistribute_consistent<'a>(
    nodes: &[[f64; 2]],
    matrix: &mut BlockMatrix,
    massless: &[bool],
    neighbours: impl Fn(usize) -> &'a [usize],
    weight: &[f64],
) -> Result<Redistribution, MassError> {
    let sums = product(matrix, &vec![1.0; nodes.len()]);
    let mut lumped = sums.clone();
    let moved = move_inwards(&mut lumped, massless, neighbours)?;
    let frame = Frame::new(nodes, &sums);
    let places: Vec<[f64; 2]> = nodes.iter().map(|&x| frame.coordinates(x)).collect();
    let target = moments(matrix, &places, &frame);
    let mut changed = matrix.clone();
    empty_rows(&mut changed, massless);
    let left = product(&changed, &vec![1.0; nodes.len()]);
    for (node, wanted) in lumped.iter().enumerate() {
        let missing = wanted - left[node];
        changed.add_diagonal(node, [missing, missing]);
    }
    let conditions = Conditions::new(&changed, &places, &frame, weight);
    let mut factor = vec![1.0; nodes.len()];
    for n_terms in [N_TERMS, 3, 1] {
        let is_found = conditions.solve(&target, n_terms, &mut factor);
        if is_found && extremes(&factor, massless).0 >= SMALLEST {
            break;
        }
        factor.fill(1.0);
    }
    scale(&mut changed, &factor);
    let found = moments(&changed, &places, &frame);
    let kept = |term: usize| (found[term] - target[term]).abs() <= KEPT * target[0];
    *matrix = changed;
    let (smallest_factor, largest_factor) = extremes(&factor, massless);
    Ok(Redistribution {
        moved,
        keeps_centre: kept(1) && kept(2),
        keeps_polar_moment: kept(3),
        keeps_second_moments: false,
        smallest_factor,
        largest_factor,
    })
}

/// `M f` of a scalar field at the nodes.
fn product(matrix: &BlockMatrix, field: &[f64]) -> Vec<f64> {
    let interleaved: Vec<f64> = field.iter().flat_map(|&value| [value, 0.0]).collect();
    let rows = 0..field.len();
    rows.map(|node| matrix.multiply_node(node, &interleaved)[0])
        .collect()
}

/// Columns of the conditions: what unit changes of p at the nodes do to the moments, per node (kg).
fn columns(matrix: &BlockMatrix, places: &[[f64; 2]], frame: &Frame) -> Vec<[f64; N_TERMS]> {
    let along: [Vec<f64>; 2] = [0, 1].map(|axis| places.iter().map(|x| x[axis]).collect());
    let sums = product(matrix, &vec![1.0; places.len()]);
    let [mx, my] = along.each_ref().map(|x| product(matrix, x));
    let flatness = frame.flatness();
    (0..places.len())
        .map(|node| {
            let [x, y] = places[node];
            let polar = (x * mx[node] + flatness * y * my[node]) / (1.0 + flatness);
            let [first_x, first_y] = [
                0.5 * (x * sums[node] + mx[node]),
                0.5 * (y * sums[node] + my[node]),
            ];
            [sums[node], first_x, first_y, polar]
        })
        .collect()
}

/// `1·M 1`, `1·M X`, `1·M Y` and the polar moment, in the frame's units (kg).
fn moments(matrix: &BlockMatrix, places: &[[f64; 2]], frame: &Frame) -> [f64; N_TERMS] {
    let mut sum = [0.0; N_TERMS];
    for column in columns(matrix, places, frame) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += value;
        }
    }
    sum
}

/// The linear conditions on the coefficients of `q`.
struct Conditions {
    columns: Vec<[f64; N_TERMS]>,
    /// `w` times the terms of `q`.
    terms: Vec<[f64; N_TERMS]>,
}

impl Conditions {
    fn new(matrix: &BlockMatrix, places: &[[f64; 2]], frame: &Frame, weight: &[f64]) -> Self {
        let flatness = frame.flatness();
        let terms = places.iter().zip(weight).map(|([x, y], w)| {
            let polar = (x * x + flatness * y * y) / (1.0 + flatness);
            [*w, w * x, w * y, w * polar]
        });
        Self {
            columns: columns(matrix, places, frame),
            terms: terms.collect(),
        }
    }

    /// Finds p that meets the first `n_terms` conditions; returns whether there is one.
    fn solve(&self, target: &[f64; N_TERMS], n_terms: usize, factor: &mut [f64]) -> bool {
        let n = n_terms;
        let (mut system, mut right) = (vec![0.0; n * n], vec![0.0; n]);
        for row in 0..n {
            right[row] = target[row];
            for (column, terms) in self.columns.iter().zip(&self.terms) {
                right[row] -= column[row];
                for (entry, term) in system[row * n..(row + 1) * n].iter_mut().zip(terms) {
                    *entry += column[row] * term;
                }
            }
        }
        let mut size = vec![0.0; n];
        if !solve_lu_in_place(&mut system, &mut right, &mut size, DEPENDENT) {
            return false;
        }
        for (factor, terms) in factor.iter_mut().zip(&self.terms) {
            *factor = 1.0 + terms.iter().zip(&right).map(|(t, c)| t * c).sum::<f64>();
        }
        true
    }
}

/// Sets the rows and columns of massless nodes to zero.
fn empty_rows(matrix: &mut BlockMatrix, massless: &[bool]) {
    for_each_block(matrix, |i, j, block| {
        if massless[i] || massless[j] {
            *block = [0.0; 4];
        }
    });
}

fn scale(matrix: &mut BlockMatrix, factor: &[f64]) {
    for_each_block(matrix, |i, j, block| {
        let mean = 0.5 * (factor[i] + factor[j]);
        *block = block.map(|value| mean * value);
    });
}

fn for_each_block(matrix: &mut BlockMatrix, mut change: impl FnMut(usize, usize, &mut [f64; 4])) {
    for i in 0..matrix.n_nodes() {
        for slot in 0..matrix.neighbours(i).len() {
            let j = matrix.neighbours(i)[slot] as usize;
            if let Some(block) = matrix.block_mut(i, j) {
                change(i, j, block);
            }
        }
    }
}
