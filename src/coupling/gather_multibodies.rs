//! The joints of multibodies as joint rows.
//!
//! Locked axes, limits and motors are those of an impulse joint, but that nothing softens the axes and that the turn is the coordinate that rapier counts. Springs,
//! damping and friction of a coordinate, coordinates that only the user moves, and couplings of two of them are rows of their own.

use super::claim::Claims;
use super::claim_multibodies::ClaimedMultibodies;
use super::joints::{RowWriter, Side, is_representable_joint, slot};
use super::multibody::{ANGULAR, free_axes};
use super::reading::GatherError;
use super::seats::OpenIsland;
use crate::constraint::joint::{
    JointGrip, JointKey, JointLaw, JointMemory, JointOwner, JointRow, Measure, Spring,
};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::Point;

/// Adds the joints of the claimed multibodies that hold bodies of the component.
///
/// # Errors
/// If a number of a joint is not finite, or two coordinates are coupled that are not both angles.
pub(super) fn add_multibodies(
    claims: &Claims,
    memory: &JointMemory,
    open: &mut OpenIsland<'_, '_>,
) -> Result<(), GatherError> {
    let sets = open.sets;
    let claimed = claims.multibodies();
    for &index in claimed.as_slice() {
        let Some(multibody) = sets.multibody_joints.get_multibody(index) else {
            continue;
        };
        // All links that move are solved together.
        let mut links = multibody.links().map(MultibodyLink::rigid_body_handle);
        let component = links.find_map(|link| claims.component_of_rigid(link));
        if component != Some(open.settings.component) {
            continue;
        }
        let mut gatherer = MultibodyGatherer {
            index,
            multibody,
            claimed,
            memory,
            open: &mut *open,
        };
        for link in multibody.links() {
            let parent = link.parent_id().and_then(|parent| multibody.link(parent));
            if let Some(parent) = parent {
                let bodies = [parent, link].map(MultibodyLink::rigid_body_handle);
                gatherer.add_joint(link, bodies)?;
            }
            gatherer.add_couplings_of(link)?;
        }
    }
    Ok(())
}

struct MultibodyGatherer<'a, 'b, 'r> {
    index: MultibodyIndex,
    multibody: &'a Multibody,
    claimed: &'a ClaimedMultibodies,
    memory: &'a JointMemory,
    open: &'a mut OpenIsland<'b, 'r>,
}

impl MultibodyGatherer<'_, '_, '_> {
    fn add_joint(
        &mut self,
        link: &MultibodyLink,
        bodies: [RigidBodyHandle; 2],
    ) -> Result<(), GatherError> {
        let mut data = link.joint().data;
        let handle = named(link).1;
        let kinematic = link.joint().kinematic;
        if kinematic {
            // The user alone moves it.
            data.motor_axes = JointAxesMask::empty();
            data.limit_axes = JointAxesMask::empty();
        }
        for (axis, place) in free_axes(link) {
            let motor = &mut data.motors[axis];
            if motor.model == MotorModel::AccelerationBased {
                let weight = self.claimed.weight(self.index, place) as Real;
                motor.model = MotorModel::ForceBased;
                motor.stiffness *= weight;
                motor.damping *= weight;
            }
        }
        let numbers = free_axes(link).flat_map(|(axis, place)| {
            let (stiffness, rest) = link.joint().spring(axis);
            let damping = self.multibody.damping()[place];
            let friction = self.multibody.frictions()[place];
            [stiffness, rest, damping, friction]
        });
        if !is_representable_joint(&data) || !numbers.into_iter().all(|value| value.is_finite()) {
            return Err(GatherError::MultibodyJoint(handle));
        }
        let Some(sides) = self.sides(bodies, [&data.local_frame1, &data.local_frame2]) else {
            return Ok(());
        };
        let multibody = self.multibody;
        let mut writer = self.writer(link, sides);
        writer.write(&data);
        for (axis, place) in free_axes(link) {
            if kinematic {
                let rate = f64::from(multibody.generalized_velocity()[place]);
                let most = f64::INFINITY;
                writer.add(slot::LOCKED, axis, JointLaw::Drive { rate, most }, &data);
                continue;
            }
            let (stiffness, rest) = link.joint().spring(axis);
            let damping = multibody.damping()[place];
            if stiffness != 0.0 || damping != 0.0 {
                let law = JointLaw::Spring(Spring {
                    stiffness: f64::from(stiffness),
                    damping: f64::from(damping),
                    rest: f64::from(rest),
                    rate: 0.0,
                    most: f64::INFINITY,
                    is_relative: false,
                });
                writer.add(slot::SPRING, axis, law, &data);
            }
            let most = f64::from(multibody.frictions()[place]);
            if most > 0.0 {
                let law = JointLaw::Drive { rate: 0.0, most };
                writer.add(slot::FRICTION, axis, law, &data);
            }
        }
        Ok(())
    }

    /// Adds the couplings that say where a link's coordinates are.
    fn add_couplings_of(&mut self, link: &MultibodyLink) -> Result<(), GatherError> {
        for (slot, coupling) in self.multibody.couplings().iter().enumerate() {
            let first = self.multibody.link(coupling.link1);
            if let Some(first) = first.filter(|_| coupling.link2 == link.link_id()) {
                self.add_coupling(slot, coupling, [first, link])?;
            }
        }
        Ok(())
    }

    /// `q2 = c q1 + offset` of two angles: a turn of four bodies.
    fn add_coupling(
        &mut self,
        slot: usize,
        coupling: &MultibodyDofCoupling,
        links: [&MultibodyLink; 2],
    ) -> Result<(), GatherError> {
        let (owner, handle) = named(links[1]);
        let (factor, offset) = (f64::from(coupling.coeff), f64::from(coupling.offset));
        let are_angles = coupling.axis1 == ANGULAR && coupling.axis2 == ANGULAR;
        if !are_angles || !factor.is_finite() || !offset.is_finite() {
            return Err(GatherError::Coupling(handle));
        }
        let start = self.open.island.joints.grips.len();
        // The turn is the number itself when the step begins.
        let mut own = -offset;
        for (link, weight) in links.into_iter().zip([-factor, 1.0]) {
            let parent = link.parent_id().and_then(|id| self.multibody.link(id));
            // A root's angle is against the world, of no two bodies.
            let Some(parent) = parent else {
                return Err(GatherError::Coupling(handle));
            };
            let bodies = [parent, link].map(MultibodyLink::rigid_body_handle);
            let data = &link.joint().data;
            let Some(sides) = self.sides(bodies, [&data.local_frame1, &data.local_frame2]) else {
                self.open.island.joints.grips.truncate(start);
                return Ok(());
            };
            own += weight * self.writer(link, sides).offset();
            for (side, sign) in sides.into_iter().zip([-1.0, 1.0]) {
                let grip = JointGrip::new(side.block(), Point::Arm(side.arm()), sign * weight);
                self.open.island.joints.grips.push(grip);
            }
        }
        let key = JointKey {
            owner,
            row: slot::COUPLING + slot as u32,
        };
        let end = self.open.island.joints.grips.len();
        self.open.island.joints.rows.push(JointRow {
            key,
            measure: Measure::Turn(own),
            sign: 1.0,
            grips: (start, end),
            law: JointLaw::Rigid {
                goal: 0.0,
                rate: 0.0,
            },
            remembered: self.memory.recall(&key),
        });
        Ok(())
    }

    fn writer(&mut self, link: &MultibodyLink, sides: [Side; 2]) -> RowWriter<'_> {
        RowWriter {
            island: &mut *self.open.island,
            memory: self.memory,
            owner: named(link).0,
            sides,
            dt: self.open.settings.step.dt,
            counted: Some(f64::from(link.joint().coords()[ANGULAR])),
        }
    }

    fn sides(&mut self, bodies: [RigidBodyHandle; 2], frames: [&Pose; 2]) -> Option<[Side; 2]> {
        let mut sides = [None; 2];
        for ((side, handle), frame) in sides.iter_mut().zip(bodies).zip(frames) {
            let block = self.open.block_of(handle)?;
            let body = self.open.sets.bodies.get(handle)?;
            *side = Some(Side::new(block, body, frame));
        }
        let [first, second] = sides;
        Some([first?, second?])
    }
}

/// The name of a link's joint in row keys, and for the user.
fn named(link: &MultibodyLink) -> (JointOwner, MultibodyJointHandle) {
    let handle = MultibodyJointHandle(link.rigid_body_handle().0);
    let (index, generation) = handle.0.into_raw_parts();
    (JointOwner::Multibody(index, generation), handle)
}
