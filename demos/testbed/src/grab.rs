//! The testbed's mouse on flexible bodies.

use crate::scenes::Scene;
use foil2d::prelude::*;
use std::error::Error;

/// Frequency of a body on the spring of the mouse (rad/s), and its damping ratio (-).
const FREQUENCY: f64 = 12.0;
const DAMPING_RATIO: f64 = 0.7;

/// What the mouse holds, it holds by the node that is nearest.
///
/// The testbed ties what is clicked to a body that follows the mouse, by a joint. In rapier a flexible body is carried by a rigid one that has
/// no place to be pulled by, so such a joint is replaced by a spring of the node. When the button is released the testbed removes the mouse's
/// body, and the spring goes with it.
pub fn hold_by_nodes(scene: &mut Scene) -> Result<(), Box<dyn Error>> {
    let carried = |handle| {
        let mut bodies = scene.flex_bodies.iter();
        bodies.find(|(_, body)| body.rigid_body_handle() == handle)
    };
    let grabbed = scene
        .world
        .impulse_joints
        .iter()
        .find_map(|(handle, joint)| {
            let (body, _) = carried(joint.body2())?;
            Some((handle, joint.body1(), body))
        });
    let Some((joint, mouse, body)) = grabbed else {
        return Ok(());
    };
    scene.world.impulse_joints.remove(joint, true);
    let at = scene.world.bodies[mouse].translation();
    let held = &scene.flex_bodies[body];
    let node = held.pick([at.x, at.y].map(f64::from)).node;
    let stiffness = held.mass() * FREQUENCY * FREQUENCY;
    let damping = 2.0 * DAMPING_RATIO * held.mass() * FREQUENCY;
    let spring = AttachmentBuilder::spring_damper(body, stiffness, damping)
        .node(node)
        .rest_length(0.0)
        .at_point([0.0, 0.0])
        .to_rigid_body(mouse);
    scene.flex_bodies.attach(spring, &scene.world.bodies)?;
    Ok(())
}
