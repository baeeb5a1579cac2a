//! Where rapier has a body, and how fast.

use super::multibody::velocity_of;
use super::shapes::pose_of;
use crate::constraint::geometry::Pose2;
use crate::math::{Vec2, atan2, from_rapier};
use crate::rapier::math::{Pose, Real, Vector};
use crate::rapier::prelude::*;
use crate::system::RigidMotion;

/// Where rapier has a body, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Placed {
    pub pose: Pose,
    linvel: Vector,
    angvel: Real,
}

impl Placed {
    /// Of a link its velocity is that of its joints.
    pub fn of(handle: RigidBodyHandle, body: &RigidBody, joints: &MultibodyJointSet) -> Self {
        let (linvel, angvel) = velocity_of(handle, body, joints);
        Self {
            pose: *body.position(),
            linvel,
            angvel,
        }
    }

    /// The motion of the body's centre of mass.
    pub fn motion(&self, body: &RigidBody) -> RigidMotion {
        let pose = pose_of(&self.pose);
        RigidMotion {
            centre: pose.transform(local_centre(body)),
            angle: atan2(pose.sin, pose.cos),
            velocity: from_rapier(self.linvel),
            spin: f64::from(self.angvel),
        }
    }
}

/// A body's motion as rapier has it.
pub(crate) fn read_motion(body: &RigidBody) -> RigidMotion {
    let placed = Placed {
        pose: *body.position(),
        linvel: body.linvel(),
        angvel: body.angvel(),
    };
    placed.motion(body)
}

/// The centre of mass in the body's coordinates.
pub(crate) fn local_centre(body: &RigidBody) -> Vec2 {
    from_rapier(body.local_center_of_mass())
}

/// Pose of a body that has moved so.
pub(super) fn pose_after(body: &RigidBody, motion: &RigidMotion) -> Pose2 {
    let turned = Pose2::new(Vec2::zeros(), motion.angle);
    let origin = motion.centre - turned.transform(local_centre(body));
    Pose2::new(origin, motion.angle)
}
