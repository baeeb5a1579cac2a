//! Multibodies: their links are claimed and solved for as rigid bodies, their joints as rows.
//!
//! Rapier keeps them in the coordinates of their joints, and moves links by nothing else. For its full step all coordinates are such
//! that only the user moves, at the rates that land the links where they were solved to be (`lent_multibodies`). What else a joint has, springs,
//! motors, limits, friction and what its coordinates weigh, is read as rows (`gather_multibodies`) and masses.

use crate::rapier::math::Real;
use crate::rapier::prelude::*;

/// Index of the angular axis in rapier's masks and arrays.
pub(super) const ANGULAR: usize = 2;

/// The free axes of a link's joint, with the places of their coordinates among those of the multibody.
pub(super) fn free_axes(link: &MultibodyLink) -> impl Iterator<Item = (usize, usize)> + use<> {
    let locked = link.joint().data.locked_axes.bits();
    let axes = (0..=ANGULAR).filter(move |axis| locked >> axis & 1 == 0);
    (link.assembly_id()..)
        .zip(axes)
        .map(|(place, axis)| (axis, place))
}

/// Velocity of a body's centre of mass and its spin, as rapier has them: of a link those that its joints say, for what is written in the body is of a
/// substep before.
pub(super) fn velocity_of(
    handle: RigidBodyHandle,
    body: &RigidBody,
    joints: &MultibodyJointSet,
) -> (Vector, Real) {
    let own = (body.linvel(), body.angvel());
    let Some((multibody, id)) = link_of(handle, joints) else {
        return own;
    };
    let (jacobian, rates) = (
        multibody.body_jacobian(id),
        multibody.generalized_velocity(),
    );
    if jacobian.ncols() != rates.len() {
        // Nothing has been stepped yet.
        return own;
    }
    let along = |axis: usize| {
        let terms = jacobian.row(axis);
        let terms = terms.iter().zip(rates.iter()).map(|(j, v)| j * v);
        terms.sum::<Real>()
    };
    (Vector::new(along(0), along(1)), along(ANGULAR))
}

/// The multibody that a body is a link of, and which of its links.
pub(super) fn link_of(
    handle: RigidBodyHandle,
    joints: &MultibodyJointSet,
) -> Option<(&Multibody, usize)> {
    let link = joints.rigid_body_link(handle)?;
    Some((joints.get_multibody(link.multibody)?, link.id))
}
