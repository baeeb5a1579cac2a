//! Multibodies: their links are claimed and solved for as rigid bodies, their joints as rows.
//!
//! Rapier keeps them in the coordinates of their joints, and moves links by nothing else. For its full step all coordinates are such
//! that only the user moves, at the rates that land the links where they were solved to be (`lent_multibodies`). What else a joint has, springs,
//! motors, limits, friction and what its coordinates weigh, is read as rows (`gather_multibodies`) and masses.

use crate::math::{Vec2, from_rapier};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::RigidLoad;

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

/// Mass, forces and damping of a link. Rapier's multibodies know nothing of dominance and of the body's own damping, and what a body's locks hold weighs
/// nothing in them, which nothing can be solved with: it weighs what it does.
///
/// The root's coordinates are those of the body: what damps them and adds to their inertia is the body's. So is what adds to the inertia of a joint,
/// which is what its link weighs more where its parent stands still.
pub(super) fn load_of_link(
    (multibody, id): (&Multibody, usize),
    body: &RigidBody,
    gravity: Vec2,
) -> RigidLoad {
    let mass = f64::from(body.mass());
    let inertia = f64::from(body.mass_properties().local_mprops.principal_inertia());
    let force = from_rapier(body.user_force()) + mass * f64::from(body.gravity_scale()) * gravity;
    let mut weights = [mass, mass, inertia];
    let mut damping = [0.0; 3];
    if let Some(link) = multibody.link(id) {
        for (axis, place) in free_axes(link) {
            let more = f64::from(multibody.armature()[place]);
            let along = if axis == ANGULAR { ANGULAR..3 } else { 0..2 };
            weights[along].iter_mut().for_each(|weight| *weight += more);
            if link.is_root() {
                damping[axis] = f64::from(multibody.damping()[place]);
            }
        }
    }
    let inverse_mass = weights.map(|weight| if weight > 0.0 { 1.0 / weight } else { 0.0 });
    RigidLoad {
        inverse_mass,
        force: [force.x, force.y, f64::from(body.user_torque())],
        damping: std::array::from_fn(|axis| damping[axis] * inverse_mass[axis]),
    }
}
