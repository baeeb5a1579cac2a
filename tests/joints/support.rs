//! Scenes in which rapier's joints are solved with flexible bodies: a small flexible block rests on a body that cannot move
//! (dynamic, with all axes locked), so that all that is joined to it is claimed.

use crate::common::*;

/// A step of 1/120 s.
pub const DT: f64 = 1.0 / 120.0;

/// A locked body at the origin with a soft block lying on it, 100 m from the scene.
pub fn claimed_anchor(scene: &mut Scene) -> RigidBodyHandle {
    let anchor = scene.world.insert_body(locked_body().can_sleep(false));
    let (world, bodies) = (&mut scene.world, &mut scene.bodies);
    lay_block_on(world, bodies, anchor, [100.0, -0.5], 1e-3);
    anchor
}

/// A dynamic body of this mass and inertia at a place, without colliders.
pub fn free_body(scene: &mut Scene, at: [f64; 2], mass: f64, inertia: f64) -> RigidBodyHandle {
    add_free_body(&mut scene.world, at, mass, inertia)
}

/// Joins two bodies.
pub fn join(
    scene: &mut Scene,
    one: RigidBodyHandle,
    other: RigidBodyHandle,
    joint: impl Into<GenericJoint>,
) -> ImpulseJointHandle {
    scene.world.impulse_joints.insert(one, other, joint, true)
}

pub fn position(scene: &Scene, body: RigidBodyHandle) -> [f64; 2] {
    place_of(&scene.world.bodies[body])
}

pub fn angle(scene: &Scene, body: RigidBodyHandle) -> f64 {
    turn_of(&scene.world.bodies[body])
}

/// Distance of a joint's anchors (m).
pub fn gap(scene: &Scene, joint: &ImpulseJoint) -> f64 {
    let anchor = |body: RigidBodyHandle, frame: &Pose| {
        let at = *scene.world.bodies[body].position() * frame.translation;
        [f64::from(at.x), f64::from(at.y)]
    };
    let one = anchor(joint.body1(), &joint.data.local_frame1);
    let other = anchor(joint.body2(), &joint.data.local_frame2);
    (one[0] - other[0]).hypot(one[1] - other[1])
}
