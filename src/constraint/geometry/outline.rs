//! Cleaning of a polygon's outline, whose shoelace area `sum cross(v_i - v_0, v_{i+1} - v_0) / 2` is positive when
//! counter-clockwise.

use crate::math::{Vec2, cross, rounding};

/// Vertices closer than this fraction of the core's extent are one vertex.
const COINCIDENT: f64 = rounding::SUM;

/// A vertex that turns left by less than this (rad) lies on a straight face: such kinks are noise of an `f32` source,
/// and a dent among them would break convexity.
const STRAIGHT: f64 = rounding::SINGLE;

/// Lower and upper corner of the bounding box of points (m).
pub(super) fn bounds(points: impl Iterator<Item = Vec2>) -> (Vec2, Vec2) {
    let none = (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY));
    points.fold(none, |(min, max), p| (min.inf(&p), max.sup(&p)))
}

/// The same polygon, counter-clockwise, without repeated vertices and those that do not turn left.
pub(super) fn clean(mut vertices: Vec<Vec2>) -> Vec<Vec2> {
    let (min, max) = bounds(vertices.iter().copied());
    let near = COINCIDENT * (max - min).norm();
    vertices.dedup_by(|b, a| (*b - *a).norm() <= near);
    while vertices.len() > 1 && (vertices[0] - vertices[vertices.len() - 1]).norm() <= near {
        vertices.pop();
    }
    let turn = |vertices: &[Vec2], i: usize| {
        let n = vertices.len();
        let (before, after) = (
            vertices[i] - vertices[(i + n - 1) % n],
            vertices[(i + 1) % n] - vertices[i],
        );
        cross(before, after) / (before.norm() * after.norm())
    };
    let area: f64 = (1..vertices.len())
        .map(|i| cross(vertices[i - 1] - vertices[0], vertices[i] - vertices[0]))
        .sum();
    if area < 0.0 && vertices.len() > 2 {
        vertices.reverse();
    }
    let input = vertices.clone();
    while vertices.len() > 2 {
        let Some(i) = (0..vertices.len()).find(|i| turn(&vertices, *i) < STRAIGHT) else {
            return vertices;
        };
        vertices.remove(i);
    }
    if input.len() > 2 {
        longest_chord(&input)
    } else {
        vertices
    }
}

/// The two vertices farthest apart, for a polygon without area.
fn longest_chord(vertices: &[Vec2]) -> Vec<Vec2> {
    let mut chord = vec![vertices[0], vertices[1]];
    for (i, a) in vertices.iter().enumerate() {
        for b in &vertices[i + 1..] {
            if (b - a).norm() > (chord[1] - chord[0]).norm() {
                chord = vec![*a, *b];
            }
        }
    }
    chord
}
