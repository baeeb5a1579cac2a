//! Rapier's shapes as rounded convex parts, converted once and kept until the shape changes.

use crate::constraint::geometry::{ConvexPart, Pose2};
use crate::math::{Vec2, atan2, from_rapier};
use crate::rapier::math::Pose;
use crate::rapier::parry::shape::{Shape, TypedShape};
use crate::rapier::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// A part of a shape, in the collider's coordinates.
#[derive(Clone, Debug)]
pub struct ShapePart {
    /// The part, in its own coordinates.
    pub part: Arc<ConvexPart>,
    /// Where it sits on the collider.
    pub pose: Pose2,
}

/// Converted shapes of all colliders met so far.
#[derive(Default)]
pub struct ShapeCache {
    entries: HashMap<ColliderHandle, Entry>,
}

struct Entry {
    /// Kept so that a shape changed in place gets a new address.
    shape: SharedShape,
    parts: Vec<ShapePart>,
}

impl std::fmt::Debug for ShapeCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ShapeCache")
            .field("n_shapes", &self.entries.len())
            .finish()
    }
}

impl ShapeCache {
    /// The parts of a collider's shape.
    pub fn parts(&mut self, handle: ColliderHandle, collider: &Collider) -> &[ShapePart] {
        let shape = collider.shared_shape();
        let is_current = self
            .entries
            .get(&handle)
            .is_some_and(|entry| Arc::ptr_eq(&entry.shape.0, &shape.0));
        if !is_current {
            let mut parts = Vec::new();
            convert(shape.as_ref(), Pose2::identity(), &mut parts);
            self.entries.insert(
                handle,
                Entry {
                    shape: shape.clone(),
                    parts,
                },
            );
        }
        &self.entries[&handle].parts
    }

    /// Drops shapes of colliders that no longer exist.
    pub fn retain(&mut self, colliders: &ColliderSet) {
        self.entries.retain(|handle, _| colliders.contains(*handle));
    }
}

/// A pose of rapier's, in `f64`.
pub fn pose_of(pose: &Pose) -> Pose2 {
    // The rotation is normalized again: its f32 entries are a unit vector to 1e-7 only.
    let (cos, sin) = (f64::from(pose.rotation.re), f64::from(pose.rotation.im));
    Pose2::new(from_rapier(pose.translation), atan2(sin, cos))
}

/// Radius by which rapier rounds the corners of a shape (m); none where it computes boxes without it.
pub(crate) fn rounding(shape: &dyn Shape) -> f64 {
    match shape.as_typed_shape() {
        TypedShape::RoundCuboid(round) => f64::from(round.border_radius),
        TypedShape::RoundTriangle(round) => f64::from(round.border_radius),
        TypedShape::RoundConvexPolygon(round) => f64::from(round.border_radius),
        _ => 0.0,
    }
}

pub(super) fn convert(shape: &dyn Shape, pose: Pose2, parts: &mut Vec<ShapePart>) {
    let mut push = |part: ConvexPart| {
        parts.push(ShapePart {
            part: Arc::new(part),
            pose,
        })
    };
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => push(ConvexPart::ball(Vec2::zeros(), f64::from(ball.radius))),
        TypedShape::Cuboid(cuboid) => push(box_part(from_rapier(cuboid.half_extents), 0.0)),
        TypedShape::RoundCuboid(round) => {
            push(box_part(
                from_rapier(round.inner_shape.half_extents),
                f64::from(round.border_radius),
            ));
        }
        TypedShape::Capsule(capsule) => push(ConvexPart::capsule(
            from_rapier(capsule.segment.a),
            from_rapier(capsule.segment.b),
            f64::from(capsule.radius),
        )),
        TypedShape::Segment(segment) => push(segment_part(segment)),
        TypedShape::Triangle(triangle) => {
            push(points_part(&[triangle.a, triangle.b, triangle.c], 0.0))
        }
        TypedShape::RoundTriangle(round) => {
            let inner = &round.inner_shape;
            push(points_part(
                &[inner.a, inner.b, inner.c],
                f64::from(round.border_radius),
            ));
        }
        TypedShape::ConvexPolygon(polygon) => push(points_part(polygon.points(), 0.0)),
        TypedShape::RoundConvexPolygon(round) => {
            push(points_part(
                round.inner_shape.points(),
                f64::from(round.border_radius),
            ));
        }
        TypedShape::HalfSpace(half_space) => {
            push(ConvexPart::half_space(from_rapier(half_space.normal)))
        }
        TypedShape::TriMesh(mesh) => {
            for triangle in mesh.triangles() {
                push(points_part(&[triangle.a, triangle.b, triangle.c], 0.0));
            }
        }
        TypedShape::Polyline(polyline) => {
            for segment in polyline.segments() {
                push(segment_part(&segment));
            }
        }
        TypedShape::HeightField(field) => {
            for segment in field.segments() {
                push(segment_part(&segment));
            }
        }
        TypedShape::Compound(compound) => {
            for (local, child) in compound.shapes() {
                let local = pose_of(local);
                let angle = atan2(pose.sin, pose.cos) + atan2(local.sin, local.cos);
                let child_pose = Pose2::new(pose.transform(local.translation), angle);
                convert(child.as_ref(), child_pose, parts);
            }
        }
        // Voxels and custom shapes have no convex parts we know of: they meet no flexible body.
        _ => {}
    }
}

fn box_part(half: Vec2, radius: f64) -> ConvexPart {
    let corners = [
        Vec2::new(-half.x, -half.y),
        Vec2::new(half.x, -half.y),
        Vec2::new(half.x, half.y),
        Vec2::new(-half.x, half.y),
    ];
    ConvexPart::polygon(corners.to_vec(), radius)
}

fn points_part(points: &[Vector], radius: f64) -> ConvexPart {
    ConvexPart::polygon(
        points.iter().map(|&point| from_rapier(point)).collect(),
        radius,
    )
}

fn segment_part(segment: &crate::rapier::parry::shape::Segment) -> ConvexPart {
    ConvexPart::segment(from_rapier(segment.a), from_rapier(segment.b))
}
