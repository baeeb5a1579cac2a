//! Gathering joints and attachments as joint rows.

use super::claim::Claims;
use super::gather_multibodies::add_multibodies;
use super::gather_settings::GatherSettings;
use super::joints::{self, RowWriter, Side, is_representable_joint};
use super::placed::local_centre;
use super::reading::GatherError;
use super::seats::OpenIsland;
use crate::body::{Anchor, Attachment, AttachmentKind, AttachmentTarget, FlexBodySet, Shift};
use crate::constraint::joint::{
    JointGrip, JointKey, JointLaw, JointMemory, JointOwner, JointRow, Measure, Spring,
};
use crate::kkt::Island;
use crate::math::Vec2;
use crate::rapier::prelude::*;
use crate::system::{Point, RigidBlock, RigidMotion};

/// Adds joint rows to an island.
pub(super) struct JointGatherer<'a, 'r> {
    /// Multipliers of joints where the step, or its part, begins.
    pub last: &'a JointMemory,
    /// The island, and whose it is.
    pub open: OpenIsland<'a, 'r>,
}

impl JointGatherer<'_, '_> {
    /// Adds the joints and attachments of the component.
    pub fn add_all(
        &mut self,
        claims: &Claims,
        flex_bodies: &FlexBodySet,
    ) -> Result<(), GatherError> {
        let component = self.open.settings.component;
        for &handle in claims.joints() {
            self.add_joint(handle, claims)?;
        }
        add_multibodies(claims, self.last, &mut self.open)?;
        for attached in claims.attached() {
            if claims.component_of_flex(attached.flex) != component {
                continue;
            }
            let Some(attachment) = flex_bodies.attachments().get(attached.parts) else {
                continue;
            };
            let owner = JointOwner::Attachment(attached.parts.0, attached.parts.1);
            let flex = [Some(attached.flex), attached.other];
            self.add_attachment(attachment, (owner, flex));
        }
        Ok(())
    }

    fn add_joint(
        &mut self,
        handle: ImpulseJointHandle,
        claims: &Claims,
    ) -> Result<(), GatherError> {
        let OpenIsland { settings, sets, .. } = self.open;
        let Some(joint) = sets.impulse_joints.get(handle) else {
            return Ok(());
        };
        let bodies = [joint.body1(), joint.body2()];
        let claimed = bodies
            .iter()
            .find_map(|&body| claims.component_of_rigid(body));
        if claimed != Some(settings.component) {
            return Ok(());
        }
        if !is_representable_joint(&joint.data) {
            return Err(GatherError::Joint(handle));
        }
        let frames = [&joint.data.local_frame1, &joint.data.local_frame2];
        let mut sides = [None; 2];
        for ((side, body), frame) in sides.iter_mut().zip(bodies).zip(frames) {
            let block = self.open.block_of(body);
            let body = sets.bodies.get(body);
            *side = block
                .zip(body)
                .map(|(block, body)| Side::new(block, body, frame));
        }
        let [Some(first), Some(second)] = sides else {
            return Ok(());
        };
        let mut writer = RowWriter {
            island: &mut *self.open.island,
            memory: self.last,
            owner: joints::owner_of(handle),
            sides: [first, second],
            dt: settings.step.dt,
            counted: None,
        };
        writer.write(&joint.data);
        Ok(())
    }

    fn add_attachment(
        &mut self,
        attachment: &Attachment,
        (owner, flex): (JointOwner, [Option<usize>; 2]),
    ) {
        let OpenIsland { settings, sets, .. } = self.open;
        let [own, other] = flex.map(|flex| flex.and_then(|flex| self.open.seats.flex_block(flex)));
        let (target, centre) = match attachment.target {
            AttachmentTarget::World => {
                let block = moved_world(attachment, settings);
                (Some(self.open.add_rigid(block)), attachment.pivot)
            }
            AttachmentTarget::RigidBody(handle) => {
                let body = sets.bodies.get(handle).filter(|body| body.is_enabled());
                let Some(body) = body else {
                    return;
                };
                let block = self.open.block_of(handle);
                (block, local_centre(body))
            }
            AttachmentTarget::Flexible(_) => (other, Vec2::zeros()),
        };
        let (Some(own), Some(target)) = (own, target) else {
            return;
        };
        let island = &mut *self.open.island;
        let mut row = 0;
        for (slot, anchor) in attachment.anchors.iter().enumerate() {
            let nodes = match attachment.kind {
                AttachmentKind::Weld => &attachment.nodes[slot..=slot],
                _ => &attachment.nodes[..],
            };
            for (measure, law) in rows_of(attachment.kind) {
                let key = JointKey { owner, row };
                row += 1;
                let remembered = self.last.recall(&key);
                let first = island.joints.grips.len();
                hold_anchor(island, (target, centre), anchor);
                let weight = 1.0 / nodes.len() as f64;
                let grips = nodes
                    .iter()
                    .map(|&node| JointGrip::new(own, Point::Node(node), weight));
                island.joints.grips.extend(grips);
                island.joints.rows.push(JointRow {
                    key,
                    measure,
                    sign: 1.0,
                    grips: (first, island.joints.grips.len()),
                    law,
                    remembered,
                });
            }
        }
    }
}

/// Adds the grips of an anchor, with weights that add up to -1.
fn hold_anchor(island: &mut Island, (target, centre): (usize, Vec2), anchor: &Anchor) {
    match *anchor {
        Anchor::Point(local) => {
            let arm = Point::Arm(local - centre);
            island.joints.grips.push(JointGrip::new(target, arm, -1.0));
        }
        Anchor::Surface([a, b], xi) => {
            for (node, weight) in [(a, xi - 1.0), (b, -xi)] {
                let grip = JointGrip::new(target, Point::Node(node), weight);
                island.joints.grips.push(grip);
            }
        }
    }
}

/// What is measured at one anchor, and how it is held.
fn rows_of(kind: AttachmentKind) -> impl Iterator<Item = (Measure, JointLaw)> {
    let along = [Measure::Along(Vec2::x()), Measure::Along(Vec2::y())];
    let (measures, law) = match kind {
        AttachmentKind::Pin | AttachmentKind::Weld => {
            let law = JointLaw::Rigid {
                goal: 0.0,
                rate: 0.0,
            };
            ([Some(along[0]), Some(along[1])], law)
        }
        AttachmentKind::Spring {
            stiffness,
            damping,
            rest_length,
        } => {
            let law = JointLaw::Spring(Spring {
                stiffness,
                damping,
                rest: rest_length,
                rate: 0.0,
                most: f64::INFINITY,
                is_relative: false,
            });
            if stiffness == 0.0 && damping == 0.0 {
                // It holds nothing.
                ([None, None], law)
            } else if rest_length > 0.0 {
                ([Some(Measure::Distance), None], law)
            } else {
                // Without a length there is no direction: two springs across each other are the same from everywhere.
                ([Some(along[0]), Some(along[1])], law)
            }
        }
    };
    measures
        .into_iter()
        .flatten()
        .map(move |measure| (measure, law))
}

/// The world's side of an attachment, which moves as the user has said.
fn moved_world(attachment: &Attachment, settings: &GatherSettings) -> RigidBlock {
    let dt = settings.step.dt / settings.span.share();
    let Attachment {
        pivot, last, next, ..
    } = attachment;
    let place = |shift: &Shift| RigidMotion {
        centre: pivot + shift.offset,
        angle: shift.angle,
        velocity: (next.offset - last.offset) / dt,
        spin: (next.angle - last.angle) / dt,
    };
    let [start, end] = settings.span.of(place(last), place(next));
    RigidBlock::prescribed(start, end)
}
