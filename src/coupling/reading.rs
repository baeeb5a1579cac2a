//! Reading rapier: loads, prescribed motions and contact laws of rigid bodies, refused if they are not finite.

use super::multibody::{ANGULAR, free_axes};
use super::placed::{local_centre, read_motion};
use super::sets::RapierSets;
use super::shapes::{ShapeFault, pose_of};
use super::under_way::Span;
use crate::body::FlexBodyHandle;
use crate::constraint::contact::{ContactLaw, Owner};
use crate::constraint::geometry::Pose2;
use crate::linalg::cholesky::CholeskyError;
use crate::math::{Vec2, atan2, from_rapier, is_held, judged::Judged};
use crate::rapier::math::{Pose, Real, Rotation};
use crate::rapier::prelude::*;
use crate::system::{RigidBlock, RigidLoad, RigidMotion};
use thiserror::Error;

/// Why an island cannot be gathered.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum GatherError {
    /// The effective matrix of a flexible body is not positive definite.
    #[error("{body:?}: {source}")]
    Factorization {
        /// The body.
        body: FlexBodyHandle,
        /// What the factorization found.
        source: CholeskyError,
    },
    /// A rigid body moves, weighs or is loaded by what is not finite.
    #[error("{0:?} is not finite")]
    RigidBody(RigidBodyHandle),
    /// A joint of a claimed body has an anchor, motor or softness that is not finite.
    #[error("{0:?} is not finite")]
    Joint(ImpulseJointHandle),
    /// A joint of a multibody of which a claimed body is a link, as above.
    #[error("{0:?} is not finite")]
    MultibodyJoint(MultibodyJointHandle),
    /// A coupling of a multibody's coordinates, of which one is no angle, or that is not finite.
    #[error("the coordinate of {0:?} is coupled by what cannot be solved with")]
    Coupling(MultibodyJointHandle),
    /// A collider's friction, restitution or skin is not finite.
    #[error("a coefficient of {0:?} is not finite")]
    Coefficient(ColliderHandle),
    /// A collider's shape holds numbers that no part can be made of.
    #[error("{0:?} has {fault}", fault = .1.fault)]
    Shape(ColliderHandle, ShapeFault),
    /// A hook left numbers that are not finite, or no normal.
    #[error("the hook leaves numbers that are not finite between {0:?}")]
    Hook([ColliderHandle; 2]),
}

/// The name of a collider in contact keys.
pub(super) fn owner_of(handle: ColliderHandle) -> Owner {
    Owner::Collider(handle.into_raw_parts().0)
}

/// Pose of a collider about its body's centre of mass.
pub(super) fn offset_of(collider: &Collider, body: &RigidBody) -> Pose2 {
    let mut pose = collider
        .position_wrt_parent()
        .map_or_else(Pose2::identity, pose_of);
    pose.translation -= local_centre(body);
    pose
}

/// A body that stays where it is.
pub(super) fn at_rest(pose: &Pose2) -> RigidMotion {
    RigidMotion {
        centre: pose.translation,
        angle: atan2(pose.sin, pose.cos),
        ..RigidMotion::default()
    }
}

/// A fixed or kinematic body, or one rapier keeps for itself: it moves as rapier says.
///
/// - `is_link`: whether it is a link of a multibody, of which rapier moves no root that is not dynamic.
pub(super) fn prescribed_block(
    body: &RigidBody,
    is_link: bool,
    parameters: &IntegrationParameters,
    span: Span,
) -> RigidBlock {
    let dt = f64::from(parameters.dt);
    let start = read_motion(body);
    if body.is_fixed() || is_link && body.is_kinematic() {
        let rest = RigidMotion {
            velocity: Vec2::zeros(),
            spin: 0.0,
            ..start
        };
        return RigidBlock::prescribed(rest, rest);
    }
    let next = match body.body_type() {
        RigidBodyType::KinematicPositionBased => *body.next_position(),
        _ => driven_to(body, parameters),
    };
    let next = pose_of(&next);
    let centre = next.transform(local_centre(body));
    let turned = (atan2(next.sin, next.cos) - start.angle + std::f64::consts::PI)
        .rem_euclid(std::f64::consts::TAU)
        - std::f64::consts::PI;
    let end = RigidMotion {
        centre,
        angle: start.angle + turned,
        velocity: (centre - start.centre) / dt,
        spin: turned / dt,
    };
    let [start, end] = span.of(start, end);
    RigidBlock::prescribed(start, end)
}

/// Where its velocity takes a body in a step, as rapier goes: by its substeps, each rounded.
fn driven_to(body: &RigidBody, parameters: &IntegrationParameters) -> Pose {
    let n_substeps = parameters.num_solver_iterations.max(1);
    let dt = parameters.dt / n_substeps as Real;
    let (way, turn) = (body.linvel() * dt, body.angvel() * dt);
    let centre = body.local_center_of_mass();
    let mut pose = *body.position();
    let mut place = pose.transform_point(centre);
    for _ in 0..n_substeps {
        place += way;
        let (cos, sin) = (pose.rotation.re, pose.rotation.im);
        let (cos, sin) = (cos - turn * sin, sin + turn * cos);
        let size = (cos * cos + sin * sin).sqrt();
        pose.rotation = Rotation::from_cos_sin_unchecked(cos / size, sin / size);
    }
    pose.translation = place - pose.rotation * centre;
    pose
}

/// Share of its inertia by which a body of negative dominance is felt by those that dominate it.
///
/// Mass ratios of a million are solved to full precision, and what falls with all its forces scaled falls as before.
const DOMINATED: Judged = Judged::new("coupling::DOMINATED", 1e-6);

/// Mass, forces and damping of a dynamic body.
pub(super) fn load_of(body: &RigidBody, gravity: Vec2) -> RigidLoad {
    let properties = body.mass_properties();
    let inverse_mass = [
        f64::from(properties.effective_inv_mass.x),
        f64::from(properties.effective_inv_mass.y),
        f64::from(properties.effective_world_inv_inertia),
    ];
    let mass = f64::from(body.mass());
    let force = from_rapier(body.user_force()) + mass * f64::from(body.gravity_scale()) * gravity;
    let (linear, angular) = (
        f64::from(body.linear_damping()),
        f64::from(body.angular_damping()),
    );
    let scale = if body.dominance_group() < 0 {
        DOMINATED.get()
    } else {
        1.0
    };
    RigidLoad {
        inverse_mass: inverse_mass.map(|inverse| inverse / scale),
        force: [force.x, force.y, f64::from(body.user_torque())].map(|force| scale * force),
        damping: [linear, linear, angular],
    }
}

/// Mass and inertia of a body, whatever is locked (kg, kg m²).
fn weight_of(body: &RigidBody) -> [f64; 2] {
    let inertia = body.mass_properties().local_mprops.principal_inertia();
    [f64::from(body.mass()), f64::from(inertia)]
}

/// Mass, forces and damping of a link. Rapier's multibodies know nothing of dominance and of the body's own damping, and what a body's locks hold weighs
/// nothing in them, which nothing can be solved with: it weighs what it does. What weighs nothing at all, as links between two rails do, weighs a
/// [millionth](DOMINATED) of the multibody, and is not pulled by gravity.
///
/// The root's coordinates are those of the body: what damps them and adds to their inertia is the body's. So is what adds to the inertia of a joint,
/// which is what its link weighs more where its parent stands still.
pub(super) fn load_of_link(
    (multibody, id): (&Multibody, usize),
    body: &RigidBody,
    sets: &RapierSets<'_>,
) -> RigidLoad {
    let [mass, inertia] = weight_of(body);
    let gravity = mass * f64::from(body.gravity_scale()) * from_rapier(sets.gravity);
    let force = from_rapier(body.user_force()) + gravity;
    let mut weights = [mass, mass, inertia];
    if mass <= 0.0 || inertia <= 0.0 {
        let links = multibody.links().map(MultibodyLink::rigid_body_handle);
        let all = links
            .filter_map(|link| sets.bodies.get(link))
            .map(weight_of);
        let sum = all.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        let least = [sum[0], sum[0], sum[1]].map(|sum| DOMINATED.get() * sum);
        weights = std::array::from_fn(|axis| f64::max(weights[axis], least[axis]));
    }
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

/// Friction and restitution of a pair, combined by rapier's rules.
pub(super) fn law_of(
    colliders: &ColliderSet,
    one: ColliderHandle,
    other: ColliderHandle,
) -> Result<ContactLaw, GatherError> {
    let (Some(first), Some(second)) = (colliders.get(one), colliders.get(other)) else {
        return Ok(ContactLaw::default());
    };
    for (handle, collider) in [(one, first), (other, second)] {
        if !(collider.friction().is_finite() && collider.restitution().is_finite()) {
            return Err(GatherError::Coefficient(handle));
        }
    }
    let friction = CoefficientCombineRule::combine(
        first.friction(),
        second.friction(),
        first.friction_combine_rule(),
        second.friction_combine_rule(),
    );
    let restitution = CoefficientCombineRule::combine(
        first.restitution(),
        second.restitution(),
        first.restitution_combine_rule(),
        second.restitution_combine_rule(),
    );
    Ok(ContactLaw {
        friction: f64::from(friction).max(0.0),
        restitution: f64::from(restitution).max(0.0),
        skin: f64::from(first.contact_skin()) + f64::from(second.contact_skin()),
        direction: None,
        carried: Vec2::zeros(),
    })
}

/// Whether a motion is finite and rapier's precision holds it.
pub(crate) fn is_representable_motion(motion: &RigidMotion) -> bool {
    let RigidMotion {
        centre,
        angle,
        velocity,
        spin,
    } = *motion;
    let all = [centre.x, centre.y, angle, velocity.x, velocity.y, spin];
    all.into_iter().all(is_held)
}

/// Whether all numbers of a load are finite.
pub(super) fn is_representable_load(load: &RigidLoad) -> bool {
    let all = [load.inverse_mass, load.force, load.damping];
    all.into_iter().flatten().all(f64::is_finite)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapier::math::Vector;

    /// What is foreseen of a body that is driven by its velocities is where rapier takes it, whatever it turns about, and wherever.
    #[test]
    fn what_is_driven_goes_where_rapier_takes_it() {
        for at in [0.0, 1000.0] {
            for (spin, off) in [(0.0, 0.0), (3.0, 0.0), (-7.0, 0.4)] {
                for n_substeps in [1, 4, 7] {
                    let mut world = PhysicsWorld::new();
                    world.integration_parameters.num_solver_iterations = n_substeps;
                    let body = RigidBodyBuilder::kinematic_velocity_based()
                        .translation(Vector::new(at as Real, 2.0))
                        .rotation(0.7)
                        .linvel(Vector::new(3.0, -2.0))
                        .angvel(spin as Real);
                    let shape = ColliderBuilder::cuboid(0.3, 0.2);
                    let shape = shape.translation(Vector::new(off as Real, 0.1));
                    let (body, _) = world.insert(body, shape);
                    world.step();
                    for _ in 0..30 {
                        let foreseen =
                            driven_to(&world.bodies[body], &world.integration_parameters);
                        world.step();
                        let found = world.bodies[body].position();
                        let apart = (found.translation - foreseen.translation).length();
                        let turned = (found.rotation.inverse() * foreseen.rotation).angle();
                        let spacing = Real::EPSILON * (1.0 + at as Real);
                        assert!(
                            apart <= spacing,
                            "{at} m, {spin} rad/s, {n_substeps}: {apart}"
                        );
                        assert!(
                            turned.abs() <= 4.0 * Real::EPSILON,
                            "{spin} rad/s: {turned}"
                        );
                    }
                }
            }
        }
    }
}
