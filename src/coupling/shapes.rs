//! Rapier's shapes as rounded convex parts, converted once and kept until the shape changes.

use crate::constraint::geometry::{ConvexPart, Pose2};
use crate::math::{HashMap, atan2, from_rapier, is_held};
use crate::rapier::math::{Pose, Real};
use crate::rapier::parry::shape::{Shape, TypedShape};
use crate::rapier::prelude::*;
use std::sync::Arc;

/// A part of a shape, in the collider's coordinates.
#[derive(Clone, Debug)]
pub struct ShapePart {
    /// The part, in its own coordinates.
    pub part: Arc<ConvexPart>,
    /// Where it sits on the collider.
    pub pose: Pose2,
}

/// What a shape is made of that no part can be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ShapeFault {
    /// What is wrong.
    pub fault: &'static str,
    /// What to do.
    pub cure: &'static str,
}

const VERTICES: ShapeFault = ShapeFault {
    fault: "a vertex, or the place of a part, that is not finite or too large",
    cure: "give the shape finite vertices (m)",
};

const SIZE: ShapeFault = ShapeFault {
    fault: "a half extent that is negative, not finite or too large",
    cure: "give the shape half extents that are zero or positive (m)",
};

const RADIUS: ShapeFault = ShapeFault {
    fault: "a radius that is negative, not finite or too large",
    cure: "give the shape a radius that is zero or positive (m)",
};

const NORMAL: ShapeFault = ShapeFault {
    fault: "a normal without a direction",
    cure: "give the half-space a finite normal that is not zero",
};

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
    ///
    /// # Errors
    /// If a number of the shape is none that a part can be made of.
    pub fn parts(
        &mut self,
        handle: ColliderHandle,
        collider: &Collider,
    ) -> Result<&[ShapePart], ShapeFault> {
        let shape = collider.shared_shape();
        let is_current = self
            .entries
            .get(&handle)
            .is_some_and(|entry| Arc::ptr_eq(&entry.shape.0, &shape.0));
        if !is_current {
            let mut parts = Vec::new();
            convert(shape.as_ref(), Pose2::identity(), &mut parts)?;
            self.entries.insert(
                handle,
                Entry {
                    shape: shape.clone(),
                    parts,
                },
            );
        }
        Ok(&self.entries[&handle].parts)
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

pub(super) fn convert(
    shape: &dyn Shape,
    pose: Pose2,
    parts: &mut Vec<ShapePart>,
) -> Result<(), ShapeFault> {
    let mut push = |part: Result<ConvexPart, ShapeFault>| {
        parts.push(ShapePart {
            part: Arc::new(part?),
            pose,
        });
        Ok(())
    };
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => push(points_part(&[Vector::ZERO], ball.radius)),
        TypedShape::Cuboid(cuboid) => push(box_part(cuboid.half_extents, 0.0)),
        TypedShape::RoundCuboid(round) => push(box_part(
            round.inner_shape.half_extents,
            round.border_radius,
        )),
        TypedShape::Capsule(capsule) => push(points_part(
            &[capsule.segment.a, capsule.segment.b],
            capsule.radius,
        )),
        TypedShape::Segment(segment) => push(points_part(&[segment.a, segment.b], 0.0)),
        TypedShape::Triangle(triangle) => {
            push(points_part(&[triangle.a, triangle.b, triangle.c], 0.0))
        }
        TypedShape::RoundTriangle(round) => {
            let inner = &round.inner_shape;
            push(points_part(
                &[inner.a, inner.b, inner.c],
                round.border_radius,
            ))
        }
        TypedShape::ConvexPolygon(polygon) => push(points_part(polygon.points(), 0.0)),
        TypedShape::RoundConvexPolygon(round) => {
            push(points_part(round.inner_shape.points(), round.border_radius))
        }
        TypedShape::HalfSpace(half_space) => push(half_space_part(half_space.normal)),
        TypedShape::TriMesh(mesh) => mesh
            .triangles()
            .try_for_each(|triangle| push(points_part(&[triangle.a, triangle.b, triangle.c], 0.0))),
        TypedShape::Polyline(polyline) => polyline
            .segments()
            .try_for_each(|segment| push(points_part(&[segment.a, segment.b], 0.0))),
        TypedShape::HeightField(field) => field
            .segments()
            .try_for_each(|segment| push(points_part(&[segment.a, segment.b], 0.0))),
        TypedShape::Compound(compound) => {
            compound.shapes().iter().try_for_each(|(local, child)| {
                let local = pose_of(local);
                let angle = atan2(pose.sin, pose.cos) + atan2(local.sin, local.cos);
                let place = pose.transform(local.translation);
                let is_placed = is_held(place.x) && is_held(place.y) && angle.is_finite();
                if !is_placed {
                    return Err(VERTICES);
                }
                convert(child.as_ref(), Pose2::new(place, angle), parts)
            })
        }
        // Voxels and custom shapes have no convex parts we know of: they meet no flexible body.
        _ => Ok(()),
    }
}

/// Whether flexible bodies meet a shape.
pub(crate) fn is_met(shape: &dyn Shape) -> bool {
    match shape.as_typed_shape() {
        TypedShape::Voxels(_) | TypedShape::Custom(_) => false,
        TypedShape::Compound(compound) => {
            (compound.shapes().iter()).all(|(_, child)| is_met(child.as_ref()))
        }
        _ => true,
    }
}

fn box_part(half: Vector, radius: Real) -> Result<ConvexPart, ShapeFault> {
    if !(is_length(half.x) && is_length(half.y)) {
        return Err(SIZE);
    }
    let corners = [
        Vector::new(-half.x, -half.y),
        Vector::new(half.x, -half.y),
        Vector::new(half.x, half.y),
        Vector::new(-half.x, half.y),
    ];
    points_part(&corners, radius)
}

fn points_part(points: &[Vector], radius: Real) -> Result<ConvexPart, ShapeFault> {
    let is_placed = |point: &Vector| is_held(f64::from(point.x)) && is_held(f64::from(point.y));
    if points.is_empty() || !points.iter().all(is_placed) {
        return Err(VERTICES);
    }
    if !is_length(radius) {
        return Err(RADIUS);
    }
    let points = points.iter().map(|&point| from_rapier(point));
    Ok(ConvexPart::new(points.collect(), f64::from(radius)))
}

fn half_space_part(normal: Vector) -> Result<ConvexPart, ShapeFault> {
    let normal = from_rapier(normal);
    let length = normal.norm();
    if length > 0.0 && is_held(length) {
        Ok(ConvexPart::half_space(normal))
    } else {
        Err(NORMAL)
    }
}

/// Whether a number is zero or positive, and no larger than what can be computed with.
fn is_length(value: Real) -> bool {
    value >= 0.0 && is_held(f64::from(value))
}
