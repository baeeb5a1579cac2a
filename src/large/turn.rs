//! The mean rotation of a body: the one nearest to `x - c` over its masses, `tan θ = Σ m A × x / Σ m A · x`.

use super::WorldMotion;
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

/// Writes the accelerations `-ω² (x - c)` of a rigid body with the angular momentum of the motion; returns its spin ω (rad/s).
pub(super) fn centripetal(masses: &[f64], motion: &WorldMotion, acceleration: &mut [f64]) -> f64 {
    let origin = node_vec(&motion.position, 0);
    let (mut mass, mut moment, mut momentum) = (0.0, Vec2::zeros(), Vec2::zeros());
    let (mut inertia, mut angular) = (0.0, 0.0);
    for (node, &m) in masses.iter().enumerate() {
        let x = node_vec(&motion.position, node) - origin;
        let v = node_vec(&motion.velocity, node);
        mass += m;
        moment += m * x;
        momentum += m * v;
        inertia += m * x.norm_squared();
        angular += m * cross(x, v);
    }
    // From the origin to the centre of mass (Huygens and Steiner).
    inertia -= moment.norm_squared() / mass;
    angular -= cross(moment, momentum) / mass;
    let spin = angular / inertia;
    let centre = origin + moment / mass;
    for node in 0..masses.len() {
        let arm = node_vec(&motion.position, node) - centre;
        set_node_vec(acceleration, node, -spin * spin * arm);
    }
    spin
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
