//! Rapier's shapes as lines to be drawn.

use crate::math::{atan2, cos, from_rapier, sin};
use crate::rapier::math::Vector;
use crate::rapier::parry::shape::{Shape, TypedShape};
use std::f64::consts::TAU;

/// Half of the length at which the line of a half-space is cut (m).
const HALF_SPACE: f64 = 100.0;

/// Pieces of a full circle.
const CIRCLE: f64 = 48.0;

/// Points that belong together, in the collider's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RigidLine {
    /// Points (m); of a closed line the first is not repeated.
    pub(super) points: Vec<[f64; 2]>,
    /// Whether they enclose a convex area.
    pub(super) is_closed: bool,
    /// Whether the line goes on for ever and is cut.
    pub(super) is_endless: bool,
}

/// The lines of a shape: convex parts as closed ones. Custom shapes and voxels have none.
pub(super) fn lines_of(shape: &dyn Shape) -> Vec<RigidLine> {
    let mut lines = Vec::new();
    add_lines(shape, &|point| point, &mut lines);
    lines
}

fn add_lines(shape: &dyn Shape, place: &dyn Fn([f64; 2]) -> [f64; 2], lines: &mut Vec<RigidLine>) {
    let mut push = |points: &[Vector], radius: f64| {
        let points = points.iter().map(|&point| from_rapier(point).into());
        lines.push(rounded(points.collect(), radius, place));
    };
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => push(&[Vector::ZERO], ball.radius.into()),
        TypedShape::Cuboid(cuboid) => push(&corners(cuboid.half_extents), 0.0),
        TypedShape::RoundCuboid(round) => push(
            &corners(round.inner_shape.half_extents),
            round.border_radius.into(),
        ),
        TypedShape::Capsule(capsule) => {
            push(
                &[capsule.segment.a, capsule.segment.b],
                capsule.radius.into(),
            );
        }
        TypedShape::Segment(segment) => push(&[segment.a, segment.b], 0.0),
        TypedShape::Triangle(triangle) => push(&[triangle.a, triangle.b, triangle.c], 0.0),
        TypedShape::RoundTriangle(round) => {
            let inner = &round.inner_shape;
            push(&[inner.a, inner.b, inner.c], round.border_radius.into());
        }
        TypedShape::ConvexPolygon(polygon) => push(polygon.points(), 0.0),
        TypedShape::RoundConvexPolygon(round) => {
            push(round.inner_shape.points(), round.border_radius.into());
        }
        TypedShape::TriMesh(mesh) => mesh
            .triangles()
            .for_each(|triangle| push(&[triangle.a, triangle.b, triangle.c], 0.0)),
        TypedShape::Polyline(polyline) => polyline
            .segments()
            .for_each(|segment| push(&[segment.a, segment.b], 0.0)),
        TypedShape::HeightField(field) => field
            .segments()
            .for_each(|segment| push(&[segment.a, segment.b], 0.0)),
        TypedShape::HalfSpace(half_space) => {
            let normal = from_rapier(half_space.normal);
            let along = [-normal.y * HALF_SPACE, normal.x * HALF_SPACE];
            lines.push(RigidLine {
                points: vec![place([-along[0], -along[1]]), place(along)],
                is_closed: false,
                is_endless: true,
            });
        }
        TypedShape::Compound(compound) => {
            for (pose, child) in compound.shapes() {
                let [cos, sin] = [pose.rotation.re, pose.rotation.im].map(f64::from);
                let at = from_rapier(pose.translation);
                let outer =
                    |[x, y]: [f64; 2]| place([at.x + cos * x - sin * y, at.y + sin * x + cos * y]);
                add_lines(child.as_ref(), &outer, lines);
            }
        }
        _ => {}
    }
}

fn corners(half: Vector) -> [Vector; 4] {
    [
        Vector::new(-half.x, -half.y),
        Vector::new(half.x, -half.y),
        Vector::new(half.x, half.y),
        Vector::new(-half.x, half.y),
    ]
}

/// The outline of a convex set of corners, in their order, with everything within a radius (m).
fn rounded(
    mut points: Vec<[f64; 2]>,
    radius: f64,
    place: &dyn Fn([f64; 2]) -> [f64; 2],
) -> RigidLine {
    let n = points.len();
    if radius > 0.0 {
        if signed_area(&points) < 0.0 {
            points.reverse();
        }
        // Outward normals of the sides that leave each corner.
        let normals: Vec<f64> = (0..n)
            .map(|corner| {
                let ([ax, ay], [bx, by]) = (points[corner], points[(corner + 1) % n]);
                atan2(ax - bx, by - ay)
            })
            .collect();
        let mut outline = Vec::new();
        for (corner, &[x, y]) in points.iter().enumerate() {
            let (from, to) = (normals[(corner + n - 1) % n], normals[corner]);
            let turn = if n == 1 {
                TAU
            } else {
                (to - from).rem_euclid(TAU)
            };
            let n_pieces = (turn / TAU * CIRCLE).ceil().max(1.0) as usize;
            let n_points = if n == 1 { n_pieces } else { n_pieces + 1 };
            for piece in 0..n_points {
                let angle = from + turn * piece as f64 / n_pieces as f64;
                outline.push([x + radius * cos(angle), y + radius * sin(angle)]);
            }
        }
        points = outline;
    }
    RigidLine {
        is_closed: points.len() > 2,
        is_endless: false,
        points: points.into_iter().map(place).collect(),
    }
}

fn signed_area(points: &[[f64; 2]]) -> f64 {
    let n = points.len();
    let sides = (0..n).map(|i| (points[i], points[(i + 1) % n]));
    sides.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hypot;
    use crate::rapier::math::Pose;
    use crate::rapier::prelude::SharedShape;
    use std::f64::consts::PI;

    /// Polygons of 48 sides lie within 0.3 % of the area of what they draw.
    #[test]
    fn lines_enclose_the_area_of_the_shape() {
        let ball = PI * 0.25;
        let shapes = [
            (SharedShape::ball(0.5), ball),
            (SharedShape::cuboid(0.5, 1.0), 2.0),
            (SharedShape::round_cuboid(0.5, 1.0, 0.5), 2.0 + 3.0 + ball),
            (SharedShape::capsule_x(1.0, 0.5), 2.0 + ball),
            (
                SharedShape::round_triangle(
                    Vector::new(0.0, 1.0),
                    Vector::new(1.0, 0.0),
                    Vector::new(0.0, 0.0),
                    0.5,
                ),
                0.5 + 0.5 * (2.0 + 2f64.sqrt()) + ball,
            ),
            (
                SharedShape::compound(vec![(
                    Pose::new(Vector::new(3.0, 1.0), 0.7),
                    SharedShape::cuboid(0.5, 1.0),
                )]),
                2.0,
            ),
        ];
        for (shape, expected) in shapes {
            let lines = lines_of(shape.as_ref());
            assert!(lines.len() == 1 && lines[0].is_closed);
            let area = signed_area(&lines[0].points);
            assert!((area / expected - 1.0).abs() < 3e-3, "{area} {expected}");
        }
    }

    #[test]
    fn a_compound_lies_where_its_parts_do() {
        let pose = Pose::new(Vector::new(3.0, 1.0), 0.5 * PI as crate::rapier::math::Real);
        let shape = SharedShape::compound(vec![(pose, SharedShape::cuboid(0.5, 1.0))]);
        let points = &lines_of(shape.as_ref())[0].points;
        for (found, expected) in points
            .iter()
            .zip([[4.0, 0.5], [4.0, 1.5], [2.0, 1.5], [2.0, 0.5]])
        {
            assert!(hypot(found[0] - expected[0], found[1] - expected[1]) < 1e-6);
        }
        let half = lines_of(SharedShape::halfspace(Vector::Y).as_ref());
        assert!(half[0].is_endless && half[0].points == [[100.0, 0.0], [-100.0, 0.0]]);
    }
}
