//! Filters: which bodies the flexible stage can solve for, and which colliders may push each other.

use super::joints::is_rigid;
use super::pair_name::{PairName, pair_name};
use super::sets::RapierSets;
use crate::constraint::geometry::RESTING;
use crate::math::HashMap;
use crate::rapier::prelude::*;

/// The dynamic rigid body of a collider, if the flexible stage can solve for it.
///
/// One that dominates flexible bodies, whose dominance is zero, does not feel them: rapier moves it, and it is met with the
/// motion its velocity prescribes.
pub(crate) fn claimable_parent(
    sets: &RapierSets<'_>,
    collider: &Collider,
) -> Option<RigidBodyHandle> {
    let parent = collider.parent()?;
    claimable_body(sets, parent).then_some(parent)
}

/// Whether the flexible stage can solve for a rigid body, and forces of flexible bodies move it.
pub(super) fn claimable_body(sets: &RapierSets<'_>, handle: RigidBodyHandle) -> bool {
    let body = sets.bodies.get(handle);
    body.is_some_and(|body| is_movable(body) && body.dominance_group() <= 0)
}

/// Whether forces can move a rigid body at all.
pub(super) fn is_movable(body: &RigidBody) -> bool {
    body.is_dynamic() && body.is_enabled() && !body.is_soft_frame()
}

/// What the user's filter has said of pairs in this step: each is asked about once.
#[derive(Debug, Default)]
pub(super) struct Answers {
    said: HashMap<PairName, Option<SolverFlags>>,
}

impl Answers {
    /// Begins a step.
    pub fn clear(&mut self) {
        self.said.clear();
    }

    /// What was said of a pair, if the filter was asked.
    pub fn of(&self, name: PairName) -> Option<Option<SolverFlags>> {
        self.said.get(&name).copied()
    }

    /// Whether two colliders may push each other: what rapier's narrow phase asks of a pair, the user's hook included.
    pub fn may_touch(
        &mut self,
        sets: &RapierSets<'_>,
        one: ColliderHandle,
        other: ColliderHandle,
    ) -> bool {
        let name = pair_name(one, other);
        let pair = sets.narrow_phase.contact_pair(one, other);
        let [collider1, collider2] = pair.map_or(name, |pair| [pair.collider1, pair.collider2]);
        let (Some(first), Some(second)) =
            (sets.colliders.get(collider1), sets.colliders.get(collider2))
        else {
            return false;
        };
        let is_solid = |collider: &Collider| collider.is_enabled() && !collider.is_sensor();
        let type_of = |collider: &Collider| {
            let body = collider.parent().and_then(|parent| sets.bodies.get(parent));
            body.map_or(RigidBodyType::Fixed, RigidBody::body_type)
        };
        let types = (type_of(first), type_of(second));
        let passes = is_solid(first)
            && is_solid(second)
            && first.collision_groups().test(second.collision_groups())
            && [first, second]
                .iter()
                .any(|collider| collider.active_collision_types().test(types.0, types.1));
        if !passes || joint_forbids(sets, first, second) {
            return false;
        }
        let hooks = first.active_hooks() | second.active_hooks();
        if !hooks.contains(ActiveHooks::FILTER_CONTACT_PAIRS) {
            return true;
        }
        let context = PairFilterContext {
            bodies: sets.bodies,
            colliders: sets.colliders,
            collider1,
            collider2,
            rigid_body1: first.parent(),
            rigid_body2: second.parent(),
        };
        // From both sides, a pair is asked about once.
        let flags = *self
            .said
            .entry(name)
            .or_insert_with(|| sets.hooks.filter_contact_pair(&context));
        flags.is_some_and(|flags| flags.contains(SolverFlags::COMPUTE_RIGID_IMPULSES))
    }
}

/// What a snapshot writes.
#[cfg(feature = "serde-serialize")]
impl Answers {
    /// All answers.
    pub fn all(&self) -> &HashMap<PairName, Option<SolverFlags>> {
        &self.said
    }

    /// Answers given before.
    pub fn remembered(all: impl Iterator<Item = (PairName, Option<SolverFlags>)>) -> Self {
        Self {
            said: all.collect(),
        }
    }
}

/// Whether a joint between the bodies of two colliders keeps them from touching: as the user has said, as it welds them, or as it pins them inside each
/// other.
fn joint_forbids(sets: &RapierSets<'_>, one: &Collider, other: &Collider) -> bool {
    let (Some(parent), Some(other_parent)) = (one.parent(), other.parent()) else {
        return false;
    };
    let parameters = sets.integration_parameters;
    let slop = RESTING * f64::from(parameters.length_unit).abs();
    let dt = f64::from(parameters.dt);
    if links_forbid(sets, [parent, other_parent], [one, other], slop) {
        return true;
    }
    let mut joints = sets.impulse_joints.joints_between(parent, other_parent);
    joints.any(|(_, joint)| {
        let surfaces = match joint.body1() == parent {
            true => [one, other],
            false => [other, one],
        };
        let joint = &joint.data;
        let holds = joint.is_enabled() && is_rigid(joint, dt);
        !joint.contacts_enabled() || holds && contradicts(joint, surfaces, slop)
    })
}

/// Whether two links of a multibody are kept from touching, by it or by the joint between them.
fn links_forbid(
    sets: &RapierSets<'_>,
    bodies: [RigidBodyHandle; 2],
    surfaces: [&Collider; 2],
    slop: f64,
) -> bool {
    let joints = &*sets.multibody_joints;
    let [Some(one), Some(other)] = bodies.map(|body| joints.rigid_body_link(body)) else {
        return false;
    };
    if one.multibody != other.multibody {
        return false;
    }
    let multibody = joints.get_multibody(one.multibody);
    multibody.is_some_and(|multibody| {
        let joined = |[from, to]: [usize; 2], surfaces| {
            let link = multibody
                .link(to)
                .filter(|link| link.parent_id() == Some(from));
            link.is_some_and(|link| {
                let joint = &link.joint().data;
                !joint.contacts_enabled() || contradicts(joint, surfaces, slop)
            })
        };
        let [first, second] = surfaces;
        !multibody.self_contacts_enabled()
            || joined([one.id, other.id], [first, second])
            || joined([other.id, one.id], [second, first])
    })
}

/// Whether contact between the surfaces contradicts a joint that holds: it welds them, or pins them inside each other.
fn contradicts(joint: &GenericJoint, surfaces: [&Collider; 2], slop: f64) -> bool {
    let welds = joint.locked_axes.contains(JointAxesMask::LOCKED_FIXED_AXES);
    welds || pins_inside(joint, surfaces, slop)
}

/// Whether a joint holds a point inside one collider at a point inside the other, so that the two overlap wherever they are, by more than `slop` (m):
/// contact that keeps them apart contradicts such a joint.
fn pins_inside(joint: &GenericJoint, surfaces: [&Collider; 2], slop: f64) -> bool {
    let anchors = [joint.local_anchor1(), joint.local_anchor2()];
    let depth_of = |(surface, anchor): (&Collider, Vector)| {
        let place = surface.position_wrt_parent().copied().unwrap_or_default();
        let nearest = surface.shape().project_point(&place, anchor, false);
        let depth = f64::from((nearest.point - anchor).length());
        nearest.is_inside.then_some(depth)
    };
    let is_pinned = joint.locked_axes.contains(JointAxesMask::LIN_AXES);
    let depths = || surfaces.into_iter().zip(anchors).map(depth_of);
    is_pinned
        && depths()
            .sum::<Option<f64>>()
            .is_some_and(|deep| deep > slop)
}
