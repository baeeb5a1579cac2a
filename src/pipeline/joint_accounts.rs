//! Accounts of joints and attachments: their reactions, in the report and on the attachments.

use super::entries::JointReport;
use super::names::Names;
use super::participant::Held;
use super::report::StepReport;
use super::solved::SolvedPart;
use crate::body::{AttachmentTarget, FlexBodySet};
use crate::coupling::RapierSets;
use crate::kkt::{ActiveJoint, Island};
use crate::math::{Vec2, cross};
use crate::rapier::prelude::{MultibodyJointHandle, MultibodyLink, RigidBody, RigidBodyHandle};

impl JointReport {
    /// What the joints of a solved part did, one after the other: the rows of each stand together.
    pub(super) fn all_of<'a>(
        part: &'a SolvedPart<'_>,
        names: Names<'a, 'a>,
    ) -> impl Iterator<Item = Self> + 'a {
        let owner = |tie: &ActiveJoint| tie.row.key.owner;
        let joints = part
            .island
            .joints
            .ties
            .chunk_by(move |one, next| owner(one) == owner(next));
        joints.map(move |ties| Self::of(names.held(owner(&ties[0])), ties, part))
    }

    fn of(joint: Held, ties: &[ActiveJoint], part: &SolvedPart<'_>) -> Self {
        let (mut force, mut torque) = (Vec2::zeros(), 0.0);
        let (mut sum, mut count) = (Vec2::zeros(), 0.0);
        let share = part.span.share();
        for tie in ties {
            let (along, turn) = tie.force_in_world(part.step.dt);
            let (along, turn) = (share * along, share * turn);
            force += along;
            torque += turn;
            for (weight, position) in pulled(tie, part.island) {
                torque += weight * cross(position, along);
                sum += position;
                count += 1.0;
            }
        }
        let position = sum / f64::max(count, 1.0);
        Self {
            joint,
            position: position.into(),
            force: force.into(),
            torque: torque - cross(position, force),
        }
    }
}

/// Weights and positions of the points that a row pulls along its direction (-, m).
fn pulled(tie: &ActiveJoint, island: &Island) -> impl Iterator<Item = (f64, Vec2)> {
    let (first, last) = tie.row.grips;
    let grips = island.joints.grips[first..last].iter();
    let pulled = grips.filter(|grip| grip.weight > 0.0);
    pulled.map(|grip| {
        let block = &island.blocks[grip.block];
        (grip.weight, block.position(grip.point))
    })
}

/// Leaves the reactions on the attachments, whose world's sides have moved.
pub(super) fn commit_attachments(report: &StepReport, flex_bodies: &mut FlexBodySet) {
    for (_, attachment) in flex_bodies.attachments_mut().iter_mut() {
        (attachment.force, attachment.torque) = ([0.0; 2], 0.0);
        attachment.last = attachment.next;
    }
    for report in &report.joints {
        if let Held::Attachment(handle) = report.joint
            && let Ok(attachment) = flex_bodies.attachment_mut(handle)
        {
            attachment.force = report.force;
            attachment.torque = report.torque;
        }
    }
}

/// Drops attachments whose rigid body is gone, and wakes what they held: a body without colliders leaves no other trace.
pub(super) fn drop_orphans(sets: &RapierSets<'_>, flex_bodies: &mut FlexBodySet) {
    let is_orphan = |target| match target {
        AttachmentTarget::RigidBody(handle) => !sets.bodies.contains(handle),
        AttachmentTarget::World | AttachmentTarget::Flexible(_) => false,
    };
    let mut all = flex_bodies.iter_attachments();
    while let Some((handle, _)) = all.find(|(_, attachment)| is_orphan(attachment.target())) {
        drop(all);
        // It was found a moment ago: there is nothing to refuse.
        if flex_bodies.detach(handle).is_err() {
            return;
        }
        all = flex_bodies.iter_attachments();
    }
}

/// Whether a joint of rapier holds bodies that sleep, and nothing that moves.
pub(super) fn joins_sleepers(held: Held, sets: &RapierSets<'_>) -> bool {
    let bodies = match held {
        Held::Joint(joint) => {
            let joint = sets.impulse_joints.get(joint);
            joint.map(|joint| [joint.body1(), joint.body2()])
        }
        Held::MultibodyJoint(joint) => bodies_of(joint, sets),
        Held::Attachment(_) => None,
    };
    bodies.is_some_and(|bodies| {
        let bodies = bodies.map(|body| sets.bodies.get(body));
        let is_still =
            |body: &RigidBody| body.is_sleeping() || body.is_fixed() || !body.is_enabled();
        let sleeps = |body: &&RigidBody| body.is_sleeping();
        bodies.iter().flatten().any(sleeps) && bodies.iter().flatten().all(|body| is_still(body))
    })
}

/// The bodies that a joint of a multibody joins.
fn bodies_of(joint: MultibodyJointHandle, sets: &RapierSets<'_>) -> Option<[RigidBodyHandle; 2]> {
    let (multibody, id) = sets.multibody_joints.get(joint)?;
    let link = multibody.link(id)?;
    let parent = multibody.link(link.parent_id()?)?;
    Some([parent, link].map(MultibodyLink::rigid_body_handle))
}
