//! Joints between rigid bodies, and what holds flexible ones.

use super::super::names::no_such;
use super::super::problem::Problem;
use super::super::scene::{Attach, AttachKind, Joint, JointKind};
use super::super::source::Source;
use super::super::words::{AttachCulprit, of_attachment};
use super::checks::{are_finite, check_pair};
use super::nodes::nodes;
use super::{Built, vector};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

pub fn join(built: &mut Built, source: &Source, joint: &Joint) -> Result<(), Problem> {
    let [one, other] = &joint.between.0;
    let first = built.names.rigid_named(source, one)?.body;
    let second = built.names.rigid_named(source, other)?.body;
    if first == second {
        return Err(source.problem(other, "a joint is between two bodies: name another one"));
    }
    check_pair(source, "at", &joint.at)?;
    let place = vector(joint.at.get().0);
    let bodies = &built.world.bodies;
    let pose = |handle: RigidBodyHandle| {
        let found = bodies.get(handle).map(|body| *body.position());
        found.unwrap_or(Pose::IDENTITY)
    };
    let poses = [first, second].map(pose);
    let anchors = poses.map(|pose| pose.inverse_transform_point(place));
    let mut made: GenericJoint = match &joint.kind {
        JointKind::Revolute => RevoluteJointBuilder::new()
            .local_anchor1(anchors[0])
            .local_anchor2(anchors[1])
            .into(),
        JointKind::Fixed => {
            let frames = poses.map(|pose| pose.inverse() * Pose::from_translation(place));
            FixedJointBuilder::new()
                .local_frame1(frames[0])
                .local_frame2(frames[1])
                .into()
        }
        JointKind::Prismatic { axis } => {
            check_pair(source, "axis", axis)?;
            let [x, y] = axis.get().0;
            let most = x.abs().max(y.abs());
            if most == 0.0 {
                let what = "the axis has no direction: give one such as [1.0, 0.0]";
                return Err(source.problem(axis, what));
            }
            // Rapier's numbers may not hold its square.
            let axis = vector([x / most, y / most]);
            let [own, others] = poses.map(|pose| pose.rotation.inverse() * axis);
            PrismaticJointBuilder::new(own)
                .local_axis2(others)
                .local_anchor1(anchors[0])
                .local_anchor2(anchors[1])
                .into()
        }
    };
    made.contacts_enabled = joint.contacts;
    let joints = &mut built.world.impulse_joints;
    built
        .names
        .joints
        .push(joints.insert(first, second, made, true));
    Ok(())
}

pub fn attach(built: &mut Built, source: &Source, spec: &Attach) -> Result<(), Problem> {
    let body = built.names.flexible_named(source, &spec.body)?;
    let Some(shaped) = built.shaped.get(spec.body.get()) else {
        return Err(source.problem(&spec.body, "this body has no mesh"));
    };
    let mut is_boundary = vec![false; shaped.mesh.n_nodes()];
    for &node in shaped.mesh.boundary().nodes() {
        is_boundary[node] = true;
    }
    let mut chosen = nodes(source, shaped, spec.nodes.get())?;
    chosen.retain(|&node| is_boundary[node]);
    if chosen.is_empty() {
        let what = "the nodes chosen lie inside the body: choose some of its boundary";
        return Err(source.problem(&spec.nodes, what));
    }
    if let AttachKind::Spring { stiffness, damping } = *spec.kind.get()
        && !are_finite(&[stiffness, damping])
    {
        let what = format!(
            "the spring has the stiffness {stiffness:?} and the damping {damping:?}: give finite numbers up to 1e18"
        );
        return Err(source.problem(&spec.kind, what));
    }
    let attachment = match *spec.kind.get() {
        AttachKind::Pin => AttachmentBuilder::pin(body),
        AttachKind::Weld => AttachmentBuilder::weld(body),
        AttachKind::Spring { stiffness, damping } => {
            AttachmentBuilder::spring_damper(body, stiffness, damping)
        }
    };
    let attachment = attachment.nodes(chosen);
    let attachment = match &spec.to {
        None => attachment.to_world(),
        Some(name) => {
            let names = &built.names;
            let flexible = names.flexible.get(name.get());
            let rigid = names.rigid_if_named(name.get());
            match (flexible, rigid) {
                (Some(&other), _) => attachment.to_flexible(other),
                (None, Some(other)) => attachment.to_rigid_body(other.body),
                (None, None) => {
                    return Err(source.problem(name, no_such("body", name.get(), names.all())));
                }
            }
        }
    };
    let made = built.flex_bodies.attach(attachment, &built.world.bodies);
    let made = made.map_err(|error| {
        let (culprit, what) = of_attachment(&error, &shaped.mesh);
        match culprit {
            AttachCulprit::Kind => source.problem(&spec.kind, what),
            AttachCulprit::Nodes => source.problem(&spec.nodes, what),
            AttachCulprit::To => match &spec.to {
                Some(name) => source.problem(name, what),
                None => source.problem(&spec.body, what),
            },
        }
    })?;
    built.names.attachments.push(made);
    Ok(())
}
