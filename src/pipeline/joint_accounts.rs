//! Accounts of joints and attachments: their reactions, in the report and in rapier's own joints.

use super::flex_pipeline::FlexPipeline;
use super::report::{Held, JointReport};
use crate::body::{AttachmentTarget, FlexBodySet};
use crate::constraint::joint::{JointOwner, Measure};
use crate::coupling::{JointImpulse, RapierSets, Span};
use crate::kkt::ActiveJoint;
use crate::math::{Vec2, cross};
use crate::rapier::prelude::ImpulseJointHandle;
use crate::system::Step;

impl FlexPipeline {
    /// Notes what the joints of the solved island did.
    ///
    /// - `first_impulse`: from where on the impulses of rapier's joints are the island's.
    pub(super) fn note_joints(
        &mut self,
        (step, span): (Step, Span),
        first_impulse: usize,
        flex_bodies: &FlexBodySet,
    ) {
        let mut first = 0;
        while first < self.island.ties.len() {
            let owner = self.island.ties[first].row.key.owner;
            let rest = self.island.ties[first..].iter();
            let last = first + rest.take_while(|tie| tie.row.key.owner == owner).count();
            let held = match owner {
                JointOwner::Impulse(index, generation) => {
                    Held::Joint(ImpulseJointHandle::from_raw_parts(index, generation))
                }
                JointOwner::Attachment(index, generation) => {
                    Held::Attachment(flex_bodies.attachment_handle((index, generation)))
                }
            };
            self.report_joint(held, first..last, (step, span));
            for slot in first..last {
                let tie = &self.island.ties[slot];
                let memory = if span.is_last() {
                    &mut self.gatherer.joint_memory
                } else {
                    &mut self.gatherer.under_way.joints
                };
                memory.remember(tie.row.key, tie.multiplier);
                if let Held::Joint(handle) = held {
                    let impulse = step.dt * tie.force(step.dt);
                    let row = tie.row.key.row;
                    let mut noted = self.joint_impulses[first_impulse..].iter_mut();
                    let known = if span.is_first() {
                        None
                    } else {
                        noted.find(|one| one.handle == handle && one.row == row)
                    };
                    match known {
                        Some(known) => known.impulse += impulse,
                        None => self.joint_impulses.push(JointImpulse {
                            handle,
                            row,
                            is_world: matches!(tie.row.measure, Measure::Along(_)),
                            impulse,
                        }),
                    }
                }
            }
            first = last;
        }
    }

    fn report_joint(
        &mut self,
        held: Held,
        ties: std::ops::Range<usize>,
        (step, span): (Step, Span),
    ) {
        let (mut force, mut torque) = (Vec2::zeros(), 0.0);
        let (mut sum, mut count) = (Vec2::zeros(), 0.0);
        for tie in &self.island.ties[ties] {
            let (along, turn) = self.island.joint_force(tie, step.dt);
            let (along, turn) = (span.share() * along, span.share() * turn);
            force += along;
            torque += turn;
            for (weight, position) in self.pulled(tie) {
                torque += weight * cross(position, along);
                sum += position;
                count += 1.0;
            }
        }
        let position = sum / f64::max(count, 1.0);
        self.report.joints.push(JointReport {
            joint: held,
            position: position.into(),
            force: force.into(),
            torque: torque - cross(position, force),
        });
    }

    /// Weights and positions of the points that a row pulls along its direction (-, m).
    fn pulled(&self, tie: &ActiveJoint) -> impl Iterator<Item = (f64, Vec2)> {
        let (first, last) = tie.row.grips;
        let grips = self.island.joint_grips[first..last].iter();
        let pulled = grips.filter(|grip| grip.weight > 0.0);
        pulled.map(|grip| {
            let block = &self.island.blocks[grip.block];
            (grip.weight, block.position(grip.point))
        })
    }

    /// Leaves the reactions on the attachments, whose world's sides have moved.
    pub(super) fn commit_attachments(&mut self, flex_bodies: &mut FlexBodySet) {
        for (_, attachment) in flex_bodies.attachments_mut().iter_mut() {
            (attachment.force, attachment.torque) = ([0.0; 2], 0.0);
            attachment.last = attachment.next;
        }
        for report in &self.report.joints {
            if let Held::Attachment(handle) = report.joint
                && let Ok(attachment) = flex_bodies.attachment_mut(handle)
            {
                attachment.force = report.force;
                attachment.torque = report.torque;
            }
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
