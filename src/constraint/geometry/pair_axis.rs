//! The separating axis of two convex cores, `s = max_i min_j n_i·(w_j - v_i)` over the faces `i` of either core and
//! the vertices `j` of the other, and their nearest vertices.

use super::depth::{DEEP, RESTING_THIN};
use super::{ConvexPart, PairReference, Pose2};
use crate::math::{Vec2, rounding};

/// Relative to the smaller part's size: lengths that differ by less are equal.
const TIE: f64 = rounding::SHARE;

/// Two parts in place; index 0 is `a`, 1 is `b`.
pub(super) struct Pair<'p> {
    pub parts: [&'p ConvexPart; 2],
    pub poses: [Pose2; 2],
    /// `relative[k]` maps local points of the other part to local points of part `k`.
    pub relative: [Pose2; 2],
    /// Length below which points coincide (m).
    pub tolerance: f64,
    /// Size of the smaller part (m).
    size: f64,
}

/// A face of one part as separating axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// 0 if the face is on `a`, 1 if on `b`.
    pub part: usize,
    pub face: usize,
    /// Distance of the other core's deepest vertex to the face's line (m).
    pub separation: f64,
}

impl<'p> Pair<'p> {
    pub fn new(parts: [&'p ConvexPart; 2], poses: [Pose2; 2]) -> Self {
        let size = parts[0].size().min(parts[1].size());
        Self {
            parts,
            poses,
            relative: [
                poses[1].relative_to(&poses[0]),
                poses[0].relative_to(&poses[1]),
            ],
            tolerance: TIE * size,
            size,
        }
    }

    /// Sum of the radii (m).
    pub fn rounding(&self) -> f64 {
        self.parts[0].radius() + self.parts[1].radius()
    }

    /// A lower bound of the distance, from bounding discs (m).
    pub fn centre_gap(&self) -> f64 {
        let [a, b] = self.parts;
        let offset = self.relative[0].transform(b.middle()) - a.middle();
        offset.norm() - a.size() - b.size()
    }

    /// Whether a part is a one-sided segment.
    pub fn has_one_sided(&self) -> bool {
        self.parts.iter().any(|part| part.is_one_sided())
    }

    /// Separation along the outward normal of a face.
    fn axis(&self, part: usize, face: usize) -> Axis {
        let core = self.parts[part];
        let relative = &self.relative[part];
        let normal = relative.inverse_rotate(core.normals()[face]);
        let vertices = self.parts[1 - part].vertices().iter();
        let support = vertices
            .map(|vertex| normal.dot(vertex))
            .fold(f64::INFINITY, f64::min);
        Axis {
            part,
            face,
            separation: core.face_distance(face, relative.translation) + support,
        }
    }

    /// Direction of an axis from `a` to `b`, in the axes of `a`.
    fn direction(&self, axis: Axis) -> Vec2 {
        let normal = self.parts[axis.part].normals()[axis.face];
        if axis.part == 0 {
            normal
        } else {
            -self.relative[0].rotate(normal)
        }
    }

    /// Whether a direction from `a` to `b` (axes of `a`) leaves every one-sided segment by its front.
    fn is_frontal(&self, direction: Vec2) -> bool {
        let [a, b] = self.parts;
        let from_a = !a.is_one_sided() || a.normals()[0].dot(&direction) > -TIE;
        let from_b =
            !b.is_one_sided() || self.relative[0].rotate(b.normals()[0]).dot(&direction) < TIE;
        from_a && from_b
    }

    /// The face with the largest separation, whichever side of a one-sided segment it faces. `None` if neither part
    /// has faces.
    pub fn separating_axis(&self) -> Option<Axis> {
        self.largest(|_| true)
    }

    /// Whether the parts are farther apart along an axis than the margin, neither behind a one-sided segment.
    pub fn is_beyond(&self, axis: Axis, margin: f64) -> bool {
        axis.separation - self.rounding() > margin && self.is_frontal(self.direction(axis))
    }

    /// The face that contacts refer to: among those that face the front of one-sided segments the one with the
    /// largest separation, or the reference face if it is about as good.
    pub fn reference_axis(&self, reference: Option<PairReference>) -> Option<Axis> {
        let best = self.largest(|direction| self.is_frontal(direction))?;
        let Some(kept) = reference.and_then(|reference| self.referred(reference)) else {
            return Some(best);
        };
        let forward = self.direction(kept);
        let turns_around = self.direction(best).dot(&forward) < 0.0;
        let best = if turns_around && best.separation < -DEEP * self.size {
            let onward = |direction: Vec2| forward.dot(&direction) >= 0.0;
            self.largest(|direction| onward(direction) && self.is_frontal(direction))
                .unwrap_or(kept)
        } else {
            best
        };
        let is_kept = kept.separation >= best.separation - RESTING_THIN * self.size;
        Some(if is_kept { kept } else { best })
    }

    fn referred(&self, reference: PairReference) -> Option<Axis> {
        let (part, face) = (usize::from(reference.on_b), reference.face as usize);
        let exists = face < self.parts[part].normals().len();
        let axis = exists.then(|| self.axis(part, face))?;
        self.is_frontal(self.direction(axis)).then_some(axis)
    }

    /// The face with the largest separation among those whose direction is allowed.
    fn largest(&self, is_allowed: impl Fn(Vec2) -> bool) -> Option<Axis> {
        let mut best: Option<Axis> = None;
        for part in 0..2 {
            for face in 0..self.parts[part].normals().len() {
                let axis = self.axis(part, face);
                // Faces that tie go to the first, so that rounding does not choose.
                let is_better =
                    best.is_none_or(|best| axis.separation > best.separation + self.tolerance);
                if is_better && is_allowed(self.direction(axis)) {
                    best = Some(axis);
                }
            }
        }
        best
    }

    /// The nearest vertices `[of a, of b]` if the cores are apart and nearest there, no vertex of one being as near to
    /// a face of the other; `separating` is their separating axis.
    pub fn nearest_vertices(&self, separating: Option<Axis>) -> Option<[usize; 2]> {
        let separation = separating.map_or(0.0, |axis| axis.separation);
        if separation <= -self.tolerance {
            return None;
        }
        let mut vertices = [0, 0];
        let mut offset = Vec2::repeat(f64::INFINITY);
        for (j, vertex) in self.parts[1].vertices().iter().enumerate() {
            let point = self.relative[0].transform(*vertex);
            for (i, other) in self.parts[0].vertices().iter().enumerate() {
                if (point - other).norm_squared() < offset.norm_squared() {
                    offset = point - other;
                    vertices = [i, j];
                }
            }
        }
        let distance = offset.norm();
        if distance <= self.tolerance || !self.is_frontal(offset / distance) {
            return None;
        }
        let face_distance = self.nearest_face(0).min(self.nearest_face(1));
        // Aligned boxes have vertices and faces equally near: then the separation reaches the distance, and the faces
        // have it.
        let is_clear = distance < face_distance - self.tolerance;
        let is_oblique = distance < face_distance && separation < distance - self.tolerance;
        (is_clear || is_oblique).then_some(vertices)
    }

    /// Distance to the nearest face of `part` that has a vertex of the other part opposite to it (m).
    fn nearest_face(&self, part: usize) -> f64 {
        let core = self.parts[part];
        let mut nearest = f64::INFINITY;
        for vertex in self.parts[1 - part].vertices() {
            let point = self.relative[part].transform(*vertex);
            for (face, normal) in core.normals().iter().enumerate() {
                let [start, end] = core.face(face);
                let edge = end - start;
                let length = edge.norm();
                let along = edge.dot(&(point - start)) / length;
                if along >= -self.tolerance && along <= length + self.tolerance {
                    nearest = nearest.min(normal.dot(&(point - start)).abs());
                }
            }
        }
        nearest
    }
}
