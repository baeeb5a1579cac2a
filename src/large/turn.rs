//! The mean rotation of a body: the one nearest to `x - c` over its masses, `tan θ = Σ m A × x / Σ m A · x`.

use crate::fe::finite_strain::FiniteStrainModel;
use crate::math::{Vec2, atan2, cross, node_vec, set_node_vec, sin_cos};

/// Arms of the nodes at rest, weighted with their masses.
#[derive(Clone, Debug)]
pub(super) struct MeanRotation {
    /// `m (X - C)`, which sums to zero (kg m).
    arms: Vec<Vec2>,
}

impl MeanRotation {
    pub(super) fn new(model: &FiniteStrainModel) -> Self {
        let rest = model.rest_positions();
        let masses = model.masses();
        let moment: Vec2 = (0..masses.len())
            .map(|node| masses[node] * node_vec(rest, node))
            .sum();
        let centre = moment / masses.iter().sum::<f64>();
        let arms = (0..masses.len()).map(|node| masses[node] * (node_vec(rest, node) - centre));
        Self {
            arms: arms.collect(),
        }
    }

    /// The rotation (rad) at `positions` (m), in (-π, π].
    pub(super) fn angle(&self, positions: &[f64]) -> f64 {
        // As arms sum to zero, positions may be taken from any origin: from one near by no digits are lost.
        let origin = node_vec(positions, 0);
        let (mut along, mut across) = (0.0, 0.0);
        for (node, arm) in self.arms.iter().enumerate() {
            let x = node_vec(positions, node) - origin;
            along += arm.dot(&x);
            across += cross(*arm, x);
        }
        atan2(across, along)
    }
}

/// Turns all nodes of a vector by an angle (rad).
pub(super) fn turn(dofs: &mut [f64], angle: f64) {
    let (sin, cos) = sin_cos(angle);
    for node in 0..dofs.len() / 2 {
        let v = node_vec(dofs, node);
        let turned = Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
        set_node_vec(dofs, node, turned);
    }
}
