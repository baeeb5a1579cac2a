//! The edge that meets a reference face, cut to the width of that face, `0 <= t·(p - v) <= l`.

use super::pair_axis::{Axis, Pair};
use crate::math::{Vec2, rounding};

/// The edge of one part that faces the reference face of the other most, in the axes of that face.
pub(super) struct IncidentEdge {
    /// Vertices of its part; a ball's vertex twice.
    vertices: [usize; 2],
    /// Their positions, local to their part (m).
    points: [Vec2; 2],
    /// Their positions along the reference face (m).
    along: [f64; 2],
    /// Their heights above the reference face (m).
    height: [f64; 2],
    /// Length of the reference face (m).
    width: f64,
}

/// A point of the incident edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedPoint {
    /// The end of the edge that it is, or from which it was moved inward.
    pub vertex: usize,
    /// Position, local to the part of the edge (m); exactly that of the vertex unless moved.
    pub point: Vec2,
    /// Height above the reference face (m).
    pub height: f64,
}

impl IncidentEdge {
    /// The edge opposite to the face of `axis`, its ends in the order along that face.
    pub fn new(pair: &Pair, axis: Axis) -> Self {
        let (face_part, edge_part) = (pair.parts[axis.part], pair.parts[1 - axis.part]);
        let relative = &pair.relative[axis.part];
        let normal = face_part.normals()[axis.face];
        let [start, end] = face_part.face(axis.face);
        let width = (end - start).norm();
        let tangent = (end - start) / width;
        let mut vertices = opposite_vertices(pair, axis);
        let offset = |vertex: usize| relative.transform(edge_part.vertices()[vertex]) - start;
        let mut along = vertices.map(|vertex| tangent.dot(&offset(vertex)));
        if along[0] > along[1] {
            vertices.swap(0, 1);
            along.swap(0, 1);
        }
        Self {
            vertices,
            points: vertices.map(|vertex| edge_part.vertices()[vertex]),
            along,
            height: vertices.map(|vertex| normal.dot(&offset(vertex))),
            width,
        }
    }

    /// The ends of what lies over the face, in the order along it; `None` if nothing does.
    pub fn clip(&self, slack: f64) -> Option<[ClippedPoint; 2]> {
        let misses = self.along[1] < -slack || self.along[0] > self.width + slack;
        // An end within the slack stays: it is the vertex itself, and an upright edge has no other point there.
        let overhangs = |i: usize| self.along[i] < -slack || self.along[i] > self.width + slack;
        let end = |i: usize| {
            if overhangs(i) {
                self.cut(i)
            } else {
                self.end(i)
            }
        };
        (!misses).then(|| [end(0), end(1)])
    }

    /// The lower end.
    pub fn deepest(&self) -> ClippedPoint {
        self.end(usize::from(self.height[1] < self.height[0]))
    }

    fn end(&self, i: usize) -> ClippedPoint {
        ClippedPoint {
            vertex: self.vertices[i],
            point: self.points[i],
            height: self.height[i],
        }
    }

    /// End `i` moved inward to the end of the face.
    fn cut(&self, i: usize) -> ClippedPoint {
        let target = self.along[i].clamp(0.0, self.width);
        let fraction = (target - self.along[i]) / (self.along[1 - i] - self.along[i]);
        // At most the other end, which may itself lie within the slack outside of the face.
        let fraction = fraction.clamp(0.0, 1.0);
        ClippedPoint {
            vertex: self.vertices[i],
            point: self.points[i] + fraction * (self.points[1 - i] - self.points[i]),
            height: self.height[i] + fraction * (self.height[1 - i] - self.height[i]),
        }
    }
}

/// Vertices of the edge whose normal is most opposite to that of the face.
fn opposite_vertices(pair: &Pair, axis: Axis) -> [usize; 2] {
    let part = pair.parts[1 - axis.part];
    let normal = pair.parts[axis.part].normals()[axis.face];
    let normal = pair.relative[axis.part].inverse_rotate(normal);
    let mut best = f64::INFINITY;
    let mut vertices = [0, 0];
    for (face, other) in part.normals().iter().enumerate() {
        let alignment = normal.dot(other);
        // Of two edges that face it equally, the first: rounding must not choose for a box on its corner.
        if alignment < best - rounding::SHARE {
            best = alignment;
            vertices = part.face_vertices(face);
        }
    }
    vertices
}
