//! Rigid bodies that are lighter than the nodes that a pin or weld holds on them.

use super::reading::load_of;
use crate::body::{Attachment, FlexBody};
use crate::math::{Vec2, from_rapier, node_vec};
use crate::rapier::prelude::RigidBody;
use nalgebra::Matrix3;

/// Whether the nodes that an attachment holds, with the masses that they have while nothing touches them, are harder to move than its rigid body in some
/// motion that it may have.
///
/// The mass of such nodes is not moved inwards: what is nearly without mass then, body and nodes, has no motion that a step could follow.
pub(super) fn is_lighter(rigid: &RigidBody, flex: &FlexBody, attachment: &Attachment) -> bool {
    let centre = from_rapier(rigid.center_of_mass());
    let mut left = Matrix3::zeros();
    for &node in attachment.nodes() {
        let mass = flex.free_model().mass().node_sum(node);
        let arm: Vec2 = node_vec(&flex.state().position, node) - centre;
        let turning = nalgebra::Vector3::new(-arm.y, arm.x, arm.norm_squared());
        left[(0, 0)] -= mass;
        left[(1, 1)] -= mass;
        for (dof, value) in turning.iter().enumerate() {
            left[(dof, 2)] -= mass * value;
        }
        left[(2, 0)] = left[(0, 2)];
        left[(2, 1)] = left[(1, 2)];
    }
    for (dof, inverse) in load_of(rigid, Vec2::zeros())
        .inverse_mass
        .into_iter()
        .enumerate()
    {
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
