//! The rigid motion that iterations leave at the end of a step of a free body.
//!
//! Internal forces have no resultant and no couple about where the nodes are in the middle of a step, however far the end is from its place, so what a residual has of both
//! is inertia alone: `Σ r = -c m a` and `Σ (x½ - X½) × r = -c φ Σ m (x½ - X½)·(x' - X')` of a shift `a` and a turn `φ` of the end, with `c` as in
//! [`Inertia`](super::Inertia). Iterations end where the elastic part of a residual is rounding, `E ε |x|`; beside that, what is left of these three is small and unseen, and
//! would be momentum that comes from nowhere, step by step.

use crate::fe::finite_strain::FiniteStrainModel;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp};

/// Moves `end` (m) so that its residual (N) has neither a resultant nor a couple; `rate` is `c` (1/s²).
pub(super) fn balance(
    model: &FiniteStrainModel,
    rate: f64,
    residual: &[f64],
    start: &[f64],
    end: &mut [f64],
) {
    let masses = model.masses();
    // From a node near by no digits are lost.
    let [first, last] = [start, &*end].map(|positions| node_vec(positions, 0));
    let arms = |node: usize, end: &[f64]| {
        let [before, after] = [node_vec(start, node) - first, node_vec(end, node) - last];
        (0.5 * (before + after), after)
    };
    let (mut mass, mut force) = (0.0, Vec2::zeros());
    let (mut middle, mut after) = (Vec2::zeros(), Vec2::zeros());
    for (node, m) in masses.iter().enumerate() {
        let (half, whole) = arms(node, end);
        mass += m;
        force += node_vec(residual, node);
        middle += *m * half;
        after += *m * whole;
    }
    let (middle, after) = (middle / mass, after / mass);
    let (mut couple, mut inertia) = (0.0, 0.0);
    for (node, m) in masses.iter().enumerate() {
        let (half, whole) = arms(node, end);
        couple += cross(half - middle, node_vec(residual, node));
        inertia += m * (half - middle).dot(&(whole - after));
    }
    let shift = force / (rate * mass);
    let turn = couple / (rate * inertia);
    // A body that is turned by half a circle in a step, or has one node, has nothing to be turned by.
    let turn = if turn.is_finite() { turn } else { 0.0 };
    for node in 0..masses.len() {
        let (_, whole) = arms(node, end);
        add_node_vec(end, node, shift + turn * perp(whole - after));
    }
}
