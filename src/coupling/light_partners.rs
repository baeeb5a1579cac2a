//! Rigid bodies that are lighter than the nodes that a pin or weld holds on them.

use super::reading::load_of;
use crate::body::{Attachment, FlexBody};
use crate::math::{Vec2, from_rapier, node_vec};
use crate::rapier::prelude::RigidBody;
use nalgebra::{Matrix3, Vector3};

/// Whether the nodes that an attachment holds, with the masses that they have while nothing touches them, are harder to move than its rigid body in some
/// motion that it may have.
///
/// The mass of such nodes is not moved inwards: what is nearly without mass then, body and nodes, has no motion that a step could follow.
pub(super) fn is_lighter(rigid: &RigidBody, flex: &FlexBody, attachment: &Attachment) -> bool {
    let centre = from_rapier(rigid.center_of_mass());
    let held = attachment.nodes().iter().map(|&node| {
        let mass = flex.free_model().mass().node_sum(node);
        (mass, node_vec(&flex.state().position, node) - centre)
    });
    moves_easier(load_of(rigid, Vec2::zeros()).inverse_mass, held)
}

/// Whether a body is easier to move than masses at some arms from its centre (kg, m) in some of its motions: whether its mass matrix less theirs,
/// `diag(m, m, I) - Σ mᵢ Gᵢᵀ Gᵢ` with `Gᵢ = [1, 0, -y; 0, 1, x]`, is not positive definite.
///
/// - `inverse_mass`: of the body, along x and y and about its centre (1/kg, 1/kg m²); zero along what is locked, which is no motion.
fn moves_easier(inverse_mass: [f64; 3], held: impl Iterator<Item = (f64, Vec2)>) -> bool {
    let mut left = Matrix3::zeros();
    for (mass, arm) in held {
        for way in [
            Vector3::new(1.0, 0.0, -arm.y),
            Vector3::new(0.0, 1.0, arm.x),
        ] {
            left -= mass * way * way.transpose();
        }
    }
    for (dof, inverse) in inverse_mass.into_iter().enumerate() {
        if inverse > 0.0 {
            left[(dof, dof)] += 1.0 / inverse;
        } else {
            left.fill_row(dof, 0.0);
            left.fill_column(dof, 0.0);
            left[(dof, dof)] = 1.0;
        }
    }
    left.cholesky().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses of 3 kg, 0.8 m apart about a place 0.3 m off: as one body 6 kg, and `6 * 0.3² + 2 * 3 * 0.4²` about the centre of the other.
    fn is_easier(mass: f64, inertia: f64) -> bool {
        let held = [[0.7, 0.0], [-0.1, 0.0]].map(|arm| (3.0, Vec2::from(arm)));
        moves_easier([1.0 / mass, 1.0 / mass, 1.0 / inertia], held.into_iter())
    }

    #[test]
    fn a_body_is_lighter_where_some_motion_of_it_is() {
        // Of a body that cannot turn the masses alone count.
        assert!(is_easier(5.99, 1e9) && !is_easier(6.01, 1e9));
        // Of one that can hardly be moved, the moments about its centre.
        let moment = 6.0 * 0.3_f64.powi(2) + 2.0 * 3.0 * 0.4_f64.powi(2);
        assert!(is_easier(1e9, 0.999 * moment) && !is_easier(1e9, 1.001 * moment));
        // Between both, the masses that the nodes couple turning to: m = 10 leaves 4 kg, which turn with 1.8 kg m.
        let both = moment + (6.0_f64 * 0.3).powi(2) / 4.0;
        assert!(is_easier(10.0, 0.999 * both) && !is_easier(10.0, 1.001 * both));
    }

    #[test]
    fn what_is_locked_is_no_motion() {
        let held = || [(3.0, Vec2::new(0.2, -0.5))].into_iter();
        assert!(moves_easier([1.0 / 4.0, 1.0 / 4.0, 1.0 / 0.5], held()));
        assert!(!moves_easier([1.0 / 4.0, 1.0 / 4.0, 0.0], held()));
        // 3 kg at 0.5 m across, where x and the turn are free.
        let moment = 3.0 * 0.29;
        let both = moment + (3.0_f64 * 0.5).powi(2) / 1.0;
        assert!(moves_easier([1.0 / 4.0, 0.0, 1.0 / (0.999 * both)], held()));
        assert!(!moves_easier(
            [1.0 / 4.0, 0.0, 1.0 / (1.001 * both)],
            held()
        ));
        assert!(!moves_easier([0.0; 3], held()));
    }

    #[test]
    fn turning_the_world_or_mirroring_it_changes_nothing() {
        let held = [[0.3, 0.1], [-0.2, 0.5], [0.6, -0.4]].map(Vec2::from);
        for share in [0.999, 1.001] {
            // Whatever the threshold is, it is the same one.
            let of = |turn: &dyn Fn(Vec2) -> Vec2, inertia: f64| {
                let held = held.map(|arm| (1.0, turn(arm)));
                moves_easier([0.25, 0.25, 1.0 / inertia], held.into_iter())
            };
            let plain = |arm: Vec2| arm;
            let (mut low, mut high) = (0.0, 100.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if of(&plain, middle) {
                    low = middle
                } else {
                    high = middle
                }
            }
            let turned =
                |arm: Vec2| Vec2::new(0.6 * arm.x - 0.8 * arm.y, 0.8 * arm.x + 0.6 * arm.y);
            let mirrored = |arm: Vec2| Vec2::new(-arm.x, arm.y);
            for turn in [&turned as &dyn Fn(Vec2) -> Vec2, &mirrored] {
                assert_eq!(of(turn, share * high), share < 1.0, "{share} of {high}");
            }
        }
    }
}
