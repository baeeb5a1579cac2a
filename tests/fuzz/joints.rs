//! Operations on impulse joints and attachments.

use crate::chance::Chance;
use crate::common::*;
use crate::play::{Link, Outcome, Play, Tie};
use foil2d::body::{AttachmentError, AttachmentTarget};
use foil2d::pipeline::StepError;

fn joint(chance: &mut Chance) -> GenericJoint {
    let mut anchor = || vec2(chance.within(-0.3, 0.3), chance.within(-0.3, 0.3));
    let (one, other) = (anchor(), anchor());
    let axis = vec2(0.6, 0.8);
    let speed = real(chance.within(-5.0, 5.0));
    let mut joint: GenericJoint = match chance.below(8) {
        0 => RevoluteJointBuilder::new().into(),
        1 => RevoluteJointBuilder::new()
            .motor_velocity(speed, 100.0)
            .limits([-1.0, 1.5])
            .into(),
        2 => FixedJointBuilder::new().into(),
        3 => PrismaticJointBuilder::new(axis).limits([-0.5, 0.5]).into(),
        4 => PrismaticJointBuilder::new(axis)
            .motor_position(0.3, 500.0, 50.0)
            .motor_max_force(1e4)
            .into(),
        5 => RopeJointBuilder::new(1.0).into(),
        6 => SpringJointBuilder::new(0.5, 1000.0, 20.0).into(),
        _ => PinSlotJointBuilder::new(axis).into(),
    };
    joint.set_local_anchor1(one);
    joint.set_local_anchor2(other);
    joint.set_contacts_enabled(chance.one_in(2));
    joint
}

/// Whether places lie in one room: across the world, joints are no scene.
fn are_near(one: Vector, other: Vector) -> bool {
    (one - other).length() < 10.0
}

impl Play {
    pub fn change_links(&mut self) -> &'static str {
        let bodies = &self.scene.world.bodies;
        let is_enabled = |body: &RigidBodyHandle| bodies[*body].is_enabled();
        let enabled: Vec<_> = self.rigid.iter().copied().filter(is_enabled).collect();
        let chance = &mut self.chance;
        let operation = chance.below(8);
        if operation == 0 {
            return self.join_carrier(&enabled);
        }
        if operation < 5 {
            if let (Some(one), Some(other)) = (chance.pick(&enabled), chance.pick(&enabled))
                && one != other
                && are_near(bodies[one].translation(), bodies[other].translation())
                && self.links.len() < 6
            {
                let joints = &mut self.scene.world.impulse_joints;
                let handle = joints.insert(one, other, joint(chance), true);
                let ends = [one, other];
                self.links.push(Link { handle, ends });
            }
            return "join";
        }
        if self.links.is_empty() {
            return "no joint";
        }
        let slot = chance.below(self.links.len());
        let Link { handle, ends } = self.links[slot];
        let are_enabled = ends.iter().all(is_enabled);
        let joints = &mut self.scene.world.impulse_joints;
        if operation < 7 {
            joints.remove(handle, true);
            self.links.swap_remove(slot);
            return "part";
        }
        // Rapier itself panics at an enabled joint of a disabled body.
        if let Some(found) = joints.get_mut(handle, true).filter(|_| are_enabled) {
            if chance.one_in(2) {
                let is_enabled = found.data.is_enabled();
                found.data.set_enabled(!is_enabled);
            } else {
                found.data = joint(chance);
            }
        }
        "change joint"
    }

    /// A joint to a carrier is refused by name where its body is awake and meets the joint; taken off again, all goes on.
    fn join_carrier(&mut self, enabled: &[RigidBodyHandle]) -> &'static str {
        let ends = (self.chance.pick(&self.flexible), self.chance.pick(enabled));
        let (Some(body), Some(other)) = ends else {
            return "no carrier to join";
        };
        let carrier = self.scene.bodies[body].rigid_body_handle();
        if !self.scene.world.bodies[carrier].is_enabled() {
            return "no carrier to join";
        }
        let joints = &mut self.scene.world.impulse_joints;
        let joint = joints.insert(carrier, other, joint(&mut self.chance), true);
        let before = self.bits();
        match self.try_step() {
            Ok(()) => {}
            Err(error) => {
                assert_eq!(error, StepError::CarrierJoint(joint), "{}", self.context);
                assert_eq!(before, self.bits(), "{}", self.context);
                self.n_refused += 1;
            }
        }
        self.scene.world.impulse_joints.remove(joint, true);
        "join carrier"
    }

    pub fn change_ties(&mut self) -> Outcome<&'static str> {
        let operation = self.chance.below(8);
        if operation < 4 && self.ties.len() < 6 {
            return self.tie();
        }
        if self.ties.is_empty() {
            return Ok("nothing attached");
        }
        let slot = self.chance.below(self.ties.len());
        let Tie { handle, target, .. } = self.ties[slot];
        if operation < 7 {
            self.scene.bodies.detach(handle)?;
            self.ties.swap_remove(slot);
            let again = self.scene.bodies.detach(handle).err();
            assert_eq!(again, Some(AttachmentError::Stale(handle)));
            return Ok("detach");
        }
        if target == AttachmentTarget::World {
            let (x, y) = (self.chance.within(-0.5, 0.5), self.chance.within(-0.5, 0.5));
            let angle = self.chance.within(-0.5, 0.5);
            let attachment = self.scene.bodies.attachment_mut(handle)?;
            attachment.set_target([x, y], angle)?;
        }
        Ok("move target")
    }

    /// Attaches some free nodes of a body's surface, by all kinds, to all kinds of targets.
    fn tie(&mut self) -> Outcome<&'static str> {
        let (scene, chance) = (&mut self.scene, &mut self.chance);
        let Some(handle) = chance.pick(&self.flexible) else {
            return Ok("nothing flexible");
        };
        let body = &scene.bodies[handle];
        let boundary = body.mesh().boundary().nodes().iter().copied();
        let free: Vec<usize> = boundary
            .filter(|&node| !body.fixed_dofs()[2 * node])
            .collect();
        let first = chance.below(free.len() - 1);
        let n = 2 + chance.below(2);
        let nodes: Vec<usize> = free.into_iter().skip(first).take(n).collect();
        let kind = chance.below(4);
        let builder = match kind {
            0 => AttachmentBuilder::pin(handle).node(nodes[0]),
            1 => AttachmentBuilder::pin(handle).nodes(nodes),
            2 => AttachmentBuilder::weld(handle).nodes(nodes),
            _ => {
                let (stiffness, damping) = (chance.within(0.0, 1e4), chance.within(0.0, 100.0));
                AttachmentBuilder::spring_damper(handle, stiffness, damping).nodes(nodes)
            }
        };
        let others = self.flexible.iter().copied();
        let others: Vec<_> = others.filter(|&other| other != handle).collect();
        let [x, y] = body.centre_of_mass();
        let rigid = chance.pick(&self.rigid);
        let rigid =
            rigid.filter(|&rigid| are_near(scene.world.bodies[rigid].translation(), vec2(x, y)));
        let other = chance.pick(&others);
        let other = other.filter(|&other| {
            let [x1, y1] = scene.bodies[other].centre_of_mass();
            are_near(vec2(x1, y1), vec2(x, y))
        });
        let (builder, target) = match (chance.below(3), rigid, other) {
            (0, Some(rigid), _) => {
                let builder = builder.to_rigid_body(rigid);
                // Half of them begin apart from what they are held at.
                let builder = if kind != 2 && chance.one_in(2) {
                    builder.at_point([chance.within(-0.3, 0.3), 0.0])
                } else {
                    builder
                };
                (builder, AttachmentTarget::RigidBody(rigid))
            }
            (1, _, Some(other)) => {
                let builder = builder.to_flexible(other);
                (builder, AttachmentTarget::Flexible(other))
            }
            _ => (builder.to_world(), AttachmentTarget::World),
        };
        let builder = if chance.one_in(3) {
            builder.contacts_enabled(chance.one_in(2))
        } else {
            builder
        };
        let is_flexible = matches!(target, AttachmentTarget::Flexible(_));
        let attached = match scene.bodies.attach(builder, &scene.world.bodies) {
            Err(AttachmentError::TooFar { .. } | AttachmentError::Strained { .. })
                if is_flexible =>
            {
                self.n_refused += 1;
                return Ok("attach from too far");
            }
            attached => attached?,
        };
        self.ties.push(Tie {
            handle: attached,
            body: handle,
            target,
        });
        Ok("attach")
    }
}
