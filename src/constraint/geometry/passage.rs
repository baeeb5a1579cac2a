//! How a point passes through a convex part as it goes straight from where the step began to where it ends.

use super::ConvexPart;
use crate::math::{Vec2, cross};

/// Start and end of a step, between which a point goes straight.
pub type Path = [Vec2; 2];

/// How a point, given in a part's coordinates, has passed through its core: by the side for a part of two vertices, so that
/// the passages through the parts of a line may be summed; a point that came into a polygon counts as passed.
pub fn passage_through(part: &ConvexPart, point: Path) -> i32 {
    let vertices = part.vertices();
    match vertices.len() {
        0 => i32::from(
            part.face_distance(0, point[0]) > 0.0 && part.face_distance(0, point[1]) < 0.0,
        ),
        1 => 0,
        2 => passage_through_segment([vertices[0], vertices[1]], point),
        _ => i32::from(comes_in(part, point)),
    }
}

/// 1 from left to right, -1 back, 0 if the point has not passed between the ends.
fn passage_through_segment([a, b]: [Vec2; 2], point: Path) -> i32 {
    let along = b - a;
    let left = point.map(|at| cross(along, at - a));
    if (left[0] > 0.0) == (left[1] > 0.0) {
        return 0;
    }
    let at = point[0] + left[0] / (left[0] - left[1]) * (point[1] - point[0]);
    let share = (at - a).dot(&along) / along.norm_squared();
    match (0.0..=1.0).contains(&share) {
        true if left[0] > 0.0 => 1,
        true => -1,
        false => 0,
    }
}

/// Whether the way of a point from outside leads through a polygon.
fn comes_in(part: &ConvexPart, [start, end]: Path) -> bool {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, 1.0f64);
    for face in 0..part.normals().len() {
        let [before, after] = [start, end].map(|at| part.face_distance(face, at));
        if before > 0.0 && after > 0.0 {
            return false;
        }
        if before > 0.0 {
            enter = enter.max(before / (before - after));
        } else if after > 0.0 {
            leave = leave.min(before / (before - after));
        }
    }
    enter >= 0.0 && enter < leave
}
