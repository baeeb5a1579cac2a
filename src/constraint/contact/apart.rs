//! How far apart the two of a candidate are, whichever way they face.
//!
//! Where geometry has no gap, because a point has slid off what it met or looks at it from behind, a force still needs bodies that
//! touch: this tells whether they do.

use super::candidate::{Candidate, Pair};
use super::scene::{PlacedPart, Scene, flex_of, rigid_of};
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
            Pair::PointOnFace { .. } | Pair::Astray { .. } | Pair::Near { .. } => 0.0,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{ContactKey, ContactLaw, Owner};
    use crate::constraint::geometry::{ConvexPart, Pose2};
    use crate::system::{Block, RigidBlock, RigidMotion};
    use std::sync::Arc;

    /// Two squares of half-width 1 m, the second with its centre at `place` and turned by `angle`; rounded by `radius`.
    fn distance(place: [f64; 2], angle: f64, pair: Pair, skin: f64, radius: f64) -> f64 {
        let still = |centre: Vec2, angle: f64| {
            let motion = RigidMotion {
                centre,
                angle,
                ..RigidMotion::default()
            };
            Block::Rigid(RigidBlock::prescribed(motion, motion))
        };
        let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        let square = ConvexPart::polygon(corners.map(Vec2::from).to_vec(), radius);
        let placed = PlacedPart {
            part: Arc::new(square),
            pose: Pose2::identity(),
        };
        let scene = Scene {
            blocks: &[still(Vec2::zeros(), 0.0), still(place.into(), angle)],
            parts: &[placed.clone(), placed],
            segments: &[],
        };
        let owner = Owner::Collider(0);
        let candidate = Candidate {
            key: ContactKey {
                contactor: owner,
                point: 0,
                target: owner,
                part: 0,
            },
            pair,
            law: ContactLaw {
                friction: 0.0,
                restitution: 0.0,
                skin,
                direction: None,
                carried: Vec2::zeros(),
            },
        };
        candidate.distance(&scene)
    }

    #[test]
    fn a_vertex_is_as_far_from_a_part_as_pythagoras_says_less_radii_and_skin() {
        let vertex = Pair::VertexOnPart {
            point: (1, Vec2::new(-1.0, -1.0)),
            radius: 0.5,
            rigid: 0,
            part: 0,
            towards: Vec2::zeros(),
            meets_vertices: true,
        };
        // Its vertex is 3 m and 4 m off the corner; rounded by 0.5 m, as is the part, with a skin of 0.25 m.
        let far = distance([5.0, 6.0], 0.0, vertex, 0.25, 0.5);
        assert!((far - 3.75).abs() < 1e-12, "{far}");
        // A depth of 0.3 m counts as a distance, with which the radius goes.
        let deep = distance([1.7, 1.0], 0.0, vertex, 0.0, 0.0);
        assert!((deep - 0.8).abs() < 1e-12, "{deep}");
    }

    #[test]
    fn crossing_parts_are_as_near_as_the_nearest_vertex_of_either() {
        let crossing = Pair::Crossing {
            blocks: [0, 1],
            parts: [0, 1],
        };
        // A square on its tip, which is 0.5 m beside the other's face: that tip, and no vertex of the other, is near.
        let tip = 1.5 + std::f64::consts::SQRT_2;
        let quarter = std::f64::consts::FRAC_PI_4;
        for place in [[tip, 0.0], [-tip, 0.0], [0.0, tip]] {
            let found = distance(place, quarter, crossing, 0.1, 0.0);
            assert!((found - 0.4).abs() < 1e-12, "{place:?}: {found}");
        }
        // And the other way round.
        let corner = distance([2.0, 2.0], quarter, crossing, 0.0, 0.0);
        let expected = 2.0 * std::f64::consts::SQRT_2 - std::f64::consts::SQRT_2 - 1.0;
        assert!((corner - expected).abs() < 1e-12, "{corner}");
    }
}
