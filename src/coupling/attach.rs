//! Attaching flexible bodies: where the anchors are when an attachment is made.

use super::shapes::pose_of;
use crate::body::{
    Anchor, Attachment, AttachmentBuilder, AttachmentError, AttachmentHandle, AttachmentKind,
    AttachmentTarget, Choice, FlexBody, FlexBodySet, Plan, Shift,
};
use crate::math::{Vec2, is_held, judged::Judged, node_vec};
use crate::rapier::prelude::*;

impl FlexBodySet {
    /// Attaches a flexible body to the world, to a rigid body or to another flexible body.
    ///
    /// The attachment lives until it is [detached](FlexBodySet::detach) or one of its bodies is removed. Implicit integrators
    /// (`β0 > 0`) only.
    ///
    /// # Errors
    /// If the description is wrong; nothing is then changed.
    pub fn attach(
        &mut self,
        builder: AttachmentBuilder,
        bodies: &RigidBodySet,
    ) -> Result<AttachmentHandle, AttachmentError> {
        let plan = builder.0;
        let target = plan.target.ok_or(AttachmentError::NoTarget)?;
        let body = self.try_get(plan.body)?;
        let nodes = chosen(body, &plan.choice)?;
        check_numbers(&plan)?;
        if plan.kind == AttachmentKind::Weld && nodes.len() < 2 {
            return Err(AttachmentError::WeldOfOne);
        }
        let sum: Vec2 = nodes
            .iter()
            .map(|&node| node_vec(body.positions(), node))
            .sum();
        let mean = sum / nodes.len() as f64;
        let places: Vec<Vec2> = match plan.kind {
            AttachmentKind::Weld => {
                let all = nodes.iter();
                all.map(|&node| node_vec(body.positions(), node)).collect()
            }
            _ => vec![mean],
        };
        let anchors = self.anchors_of(&plan, target, &places, bodies)?;
        self.check_near(&plan, target, (&places, &anchors), bodies)?;
        if plan.kind == AttachmentKind::Weld {
            let held: Vec<Vec2> = anchors
                .iter()
                .map(|anchor| self.world_point(target, anchor, bodies))
                .collect();
            check_strain(body, &nodes, &places, &held)?;
        }
        let kind = match plan.kind {
            AttachmentKind::Spring {
                stiffness, damping, ..
            } if !plan.has_rest_length => AttachmentKind::Spring {
                stiffness,
                damping,
                rest_length: (mean - self.world_point(target, &anchors[0], bodies)).norm(),
            },
            kind => kind,
        };
        Ok(self.insert_attachment(Attachment {
            body: plan.body,
            target,
            kind,
            nodes,
            anchors,
            pivot: mean,
            contacts_enabled: plan.contacts_enabled,
            last: Shift::default(),
            next: Shift::default(),
            force: [0.0; 2],
            torque: 0.0,
        }))
    }

    fn anchors_of(
        &self,
        plan: &Plan,
        target: AttachmentTarget,
        places: &[Vec2],
        bodies: &RigidBodySet,
    ) -> Result<Vec<Anchor>, AttachmentError> {
        let given = plan.point;
        match target {
            AttachmentTarget::World => {
                let points = places.iter().map(|&at| Anchor::Point(given.unwrap_or(at)));
                Ok(points.collect())
            }
            AttachmentTarget::RigidBody(handle) => {
                let body = bodies
                    .get(handle)
                    .ok_or(AttachmentError::RigidBody(handle))?;
                if self
                    .iter()
                    .any(|(_, flex)| flex.rigid_body_handle() == handle)
                {
                    return Err(AttachmentError::Carrier(handle));
                }
                let pose = pose_of(body.position());
                let local = |&at: &Vec2| Anchor::Point(given.unwrap_or(pose.inverse_transform(at)));
                Ok(places.iter().map(local).collect())
            }
            AttachmentTarget::Flexible(handle) => {
                let other = self.try_get(handle)?;
                if handle == plan.body {
                    return Err(AttachmentError::SameBody);
                }
                let near = |&at: &Vec2| nearest(other, given.unwrap_or(at));
                Ok(places.iter().map(near).collect())
            }
        }
    }

    /// Refuses to join flexible bodies that are far apart: the overlap or gap that a joint begins with is closed within steps, and
    /// that would tear at both of them.
    fn check_near(
        &self,
        plan: &Plan,
        target: AttachmentTarget,
        (places, anchors): (&[Vec2], &[Anchor]),
        bodies: &RigidBodySet,
    ) -> Result<(), AttachmentError> {
        let (AttachmentTarget::Flexible(other), false) =
            (target, matches!(plan.kind, AttachmentKind::Spring { .. }))
        else {
            return Ok(());
        };
        let most = 0.5 * extent(self.try_get(plan.body)?).min(extent(self.try_get(other)?));
        let pairs = places.iter().zip(anchors);
        let distance = pairs
            .map(|(at, anchor)| (at - self.world_point(target, anchor, bodies)).norm())
            .fold(0.0, f64::max);
        if distance > most {
            return Err(AttachmentError::TooFar { distance, most });
        }
        Ok(())
    }

    /// Where an anchor is now (m).
    fn world_point(
        &self,
        target: AttachmentTarget,
        anchor: &Anchor,
        bodies: &RigidBodySet,
    ) -> Vec2 {
        match (*anchor, target) {
            (Anchor::Point(local), AttachmentTarget::RigidBody(handle)) => {
                let body = bodies.get(handle);
                body.map_or(local, |body| pose_of(body.position()).transform(local))
            }
            (Anchor::Point(point), _) => point,
            (Anchor::Surface([a, b], xi), AttachmentTarget::Flexible(handle)) => {
                let at = |body: &FlexBody, node| node_vec(body.positions(), node);
                let body = self.get(handle);
                body.map_or(Vec2::zeros(), |body| {
                    (1.0 - xi) * at(body, a) + xi * at(body, b)
                })
            }
            (Anchor::Surface(..), _) => Vec2::zeros(),
        }
    }
}

/// Diagonal of the box of a body's nodes at rest (m).
fn extent(body: &FlexBody) -> f64 {
    let nodes = body.mesh().nodes();
    let mut corners = [Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)];
    for node in nodes {
        let node = Vec2::from(*node);
        corners = [corners[0].inf(&node), corners[1].sup(&node)];
    }
    (corners[1] - corners[0]).norm()
}

/// Change of length, relative, that a weld may ask of a boundary segment (-): half of it is gone, or as much again and half is added.
const MOST_STRAIN: Judged = Judged::new("coupling::MOST_STRAIN", 0.5);

/// Refuses to hold neighbouring nodes at places that are much nearer to each other, or farther apart, than the nodes: what is between them
/// would be crushed or torn.
fn check_strain(
    body: &FlexBody,
    nodes: &[usize],
    places: &[Vec2],
    held: &[Vec2],
) -> Result<(), AttachmentError> {
    let index = |node: usize| nodes.iter().position(|&chosen| chosen == node);
    for &segment in body.mesh().boundary().segments() {
        let [Some(from), Some(to)] = segment.map(index) else {
            continue;
        };
        let [length, held] = [places, held].map(|at| (at[to] - at[from]).norm());
        if (held - length).abs() > MOST_STRAIN * length {
            return Err(AttachmentError::Strained {
                nodes: segment,
                length,
                held,
            });
        }
    }
    Ok(())
}

/// The nodes of a choice, checked.
fn chosen(body: &FlexBody, choice: &Choice) -> Result<Vec<usize>, AttachmentError> {
    let boundary = body.mesh().boundary();
    let places = body.mesh().nodes();
    let lies_in = |node: usize| choice.regions.iter().any(|region| region(places[node]));
    let surface = boundary.nodes().iter().copied();
    let in_regions = surface.filter(|&node| !choice.nodes.contains(&node) && lies_in(node));
    let nodes: Vec<usize> = choice.nodes.iter().copied().chain(in_regions).collect();
    if nodes.is_empty() {
        return Err(AttachmentError::NoNodes);
    }
    let n_nodes = body.n_nodes();
    for (index, &node) in nodes.iter().enumerate() {
        if node >= n_nodes {
            return Err(crate::body::FlexBodyError::Node { node, n_nodes }.into());
        }
        if !boundary.is_boundary(node) {
            return Err(AttachmentError::InteriorNode(node));
        }
        if nodes[..index].contains(&node) {
            return Err(AttachmentError::RepeatedNode(node));
        }
        let fixed = body.fixed_dofs();
        if fixed[2 * node] || fixed[2 * node + 1] {
            return Err(AttachmentError::PinnedNode(node));
        }
    }
    Ok(nodes)
}

fn check_numbers(plan: &Plan) -> Result<(), AttachmentError> {
    if let Some(point) = plan.point {
        if plan.kind == AttachmentKind::Weld {
            return Err(AttachmentError::WeldAtPoint);
        }
        if !point.iter().all(|value| is_held(*value)) {
            return Err(AttachmentError::NotFinite("the point"));
        }
    }
    if plan.has_rest_length && !matches!(plan.kind, AttachmentKind::Spring { .. }) {
        return Err(AttachmentError::NoSpring);
    }
    if let AttachmentKind::Spring {
        stiffness,
        damping,
        rest_length,
    } = plan.kind
    {
        let all = [
            ("the stiffness", stiffness),
            ("the damping", damping),
            ("the length at rest", rest_length),
        ];
        for (name, value) in all {
            if !value.is_finite() {
                return Err(AttachmentError::NotFinite(name));
            }
            if value < 0.0 {
                return Err(AttachmentError::Negative(name));
            }
        }
    }
    Ok(())
}

/// The point of a body's surface nearest to a point.
fn nearest(body: &FlexBody, point: Vec2) -> Anchor {
    let mut best = (f64::INFINITY, Anchor::Surface([0, 0], 0.0));
    for &[a, b] in body.mesh().boundary().segments() {
        let [from, to] = [a, b].map(|node| node_vec(body.positions(), node));
        let along = to - from;
        let xi = (along.dot(&(point - from)) / along.norm_squared()).clamp(0.0, 1.0);
        let distance = (from + xi * along - point).norm();
        if distance < best.0 {
            best = (distance, Anchor::Surface([a, b], xi));
        }
    }
    best.1
}
