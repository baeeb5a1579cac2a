//! How far apart the two of a candidate are, whichever way they face.
//!
//! Where geometry has no gap, because a point has slid off what it met or looks at it from behind, a force still needs bodies that
//! touch: this tells whether they do.

use super::candidate::{Candidate, Pair};
use super::kinematics::{PlacedPart, Scene, flex_of, rigid_of};
use crate::constraint::geometry::separation;
use crate::math::Vec2;
use crate::system::{FlexBlock, Point};

impl Candidate {
    /// Distance of the point from the surface of the target at the current iterate, positive on either side (m).
    pub fn distance(&self, scene: &Scene<'_>) -> f64 {
        let skin = self.law.skin;
        match self.pair {
            Pair::NodeOnPart { node, rigid, part } => {
                let point = scene.blocks[node.0].position(Point::Node(node.1));
                (signed_distance(scene, point, rigid, &scene.parts[part]) - skin).abs()
            }
            Pair::VertexOnSurface {
                rigid,
                arm,
                radius,
                flex,
                segments,
                ..
            } => {
                let point = scene.blocks[rigid].position(Point::Arm(arm));
                (distance_to_segments(scene, point, flex, segments) - radius - skin).abs()
            }
            Pair::NodeOnSurface {
                node,
                flex,
                segments,
            } => {
                let point = scene.blocks[node.0].position(Point::Node(node.1));
                (distance_to_segments(scene, point, flex, segments) - skin).abs()
            }
            Pair::VertexOnPart {
                point: (block, arm),
                radius,
                rigid,
                part,
                ..
            } => {
                let point = scene.blocks[block].position(Point::Arm(arm));
                (signed_distance(scene, point, rigid, &scene.parts[part]) - radius - skin).abs()
            }
            // Crossing edges: as near as the nearest vertex of either is to the other.
            Pair::Crossing { blocks, parts } => {
                let [one, other] = parts.map(|part| &scene.parts[part]);
                let there = vertices_to_part(scene, (blocks[0], one), (blocks[1], other));
                let back = vertices_to_part(scene, (blocks[1], other), (blocks[0], one));
                (there.min(back) - skin).abs()
            }
            Pair::PointOnFace { .. } => 0.0,
        }
    }
}

/// Signed distance of a world point from a placed part, negative inside (m).
fn signed_distance(scene: &Scene<'_>, point: Vec2, rigid: usize, placed: &PlacedPart) -> f64 {
    let Some(motion) = rigid_of(scene, rigid) else {
        return f64::INFINITY;
    };
    let local = placed.pose.inverse_transform(motion.current().arm(point));
    separation(&placed.part, local, None, None).distance
}

/// Least signed distance of the vertices of one placed part from another (m).
fn vertices_to_part(
    scene: &Scene<'_>,
    (carrier, placed): (usize, &PlacedPart),
    (rigid, target): (usize, &PlacedPart),
) -> f64 {
    let vertices = placed.part.vertices().iter();
    let distances = vertices.map(|vertex| {
        let arm = placed.pose.transform(*vertex);
        let point = scene.blocks[carrier].position(Point::Arm(arm));
        signed_distance(scene, point, rigid, target) - placed.part.radius()
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// Distance of a world point from the listed segments of a flexible surface (m).
fn distance_to_segments(
    scene: &Scene<'_>,
    point: Vec2,
    flex: usize,
    (first, end): (usize, usize),
) -> f64 {
    let Some(body) = flex_of(scene, flex) else {
        return f64::INFINITY;
    };
    let listed = scene.segments[first..end].iter();
    let distances = listed.map(|&segment| distance_to_segment(body, segment as usize, point));
    distances.fold(f64::INFINITY, f64::min)
}

fn distance_to_segment(body: &FlexBlock, segment: usize, point: Vec2) -> f64 {
    let [from, to] = body.model().mesh().boundary().segments()[segment].map(|n| body.position(n));
    let along = to - from;
    let xi = (along.dot(&(point - from)) / along.norm_squared()).clamp(0.0, 1.0);
    (point - from - xi * along).norm()
}
