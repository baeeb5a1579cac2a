//! Lengths along a path.

use crate::fe::finite_strain::FiniteStrainModel;
use crate::math::{Vec2, node_vec};

/// Masses over the whole mass and the square of the radius of gyration.
pub(super) fn weights(model: &FiniteStrainModel) -> Vec<f64> {
    let (rest, masses) = (model.rest_positions(), model.masses());
    let whole: f64 = masses.iter().sum();
    let origin = node_vec(rest, 0);
    let arm = |node: usize| node_vec(rest, node) - origin;
    let nodes = || masses.iter().enumerate();
    let centre = nodes().map(|(node, mass)| *mass * arm(node)).sum::<Vec2>() / whole;
    let squares = nodes().map(|(node, mass)| mass * (arm(node) - centre).norm_squared());
    let moment: f64 = squares.sum();
    masses.iter().flat_map(|mass| [mass / moment; 2]).collect()
}

/// Root mean square over the masses, in radii of gyration.
pub(super) fn length(weights: &[f64], along: &[f64]) -> f64 {
    let squares = weights.iter().zip(along).map(|(w, x)| w * x * x);
    squares.sum::<f64>().sqrt()
}
