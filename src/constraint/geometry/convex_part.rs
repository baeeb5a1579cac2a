//! The rounded convex part `P = core + disc(r)`, the one shape that every collider reduces to.
//!
//! ```text
//!    polygon: face i from i to i+1         two vertices: left side first        ball       half-space
//!
//!        3 <--- 2 --- 2                        Face(0): 1 -> 0
//!        |            |                     0 ================= 1                o          ^ n
//!        3            1                        Face(1): 0 -> 1                   0      ----+----
//!        |            |                                                                 ///////////
//!        0 --- 0 ---> 1
//! ```
//!
//! A face runs counter-clockwise around the core: its outward normal points to the right of its direction,
//! `n = (e_y, -e_x) / |e|`.

use super::Pose2;
use super::outline::{bounds, clean};
use crate::math::{Vec2, perp};

/// A feature of a part's core.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Feature {
    /// Face `i`, from vertex `i` to vertex `i + 1`. With two vertices, `Face(0)` is the side to the left of the
    /// direction from vertex 0 to vertex 1 and `Face(1)` the right one. A half-space has `Face(0)` only.
    Face(u32),
    /// Vertex `i`.
    Vertex(u32),
}

/// A convex core rounded by a disc, in the local coordinates of its body.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPart {
    /// Counter-clockwise; empty for a half-space.
    vertices: Vec<Vec2>,
    /// Outward unit normals, one per face.
    normals: Vec<Vec2>,
    radius: f64,
    /// Middle of the core's bounding box.
    middle: Vec2,
    /// Radius of the core about the middle of its bounding box, plus `radius`.
    size: f64,
    /// Least thickness of a polygonal core over its faces; zero for other cores.
    width: f64,
}

impl ConvexPart {
    /// The part with these core vertices, counter-clockwise (m), rounded by `radius` (m).
    ///
    /// Repeated vertices and vertices on a straight face are dropped, a clockwise polygon is reversed and one without
    /// area becomes the segment or point that it is; features refer to the outcome, [`ConvexPart::vertices`]. A core
    /// of two vertices collides on both sides.
    ///
    /// # Panics
    /// If there is no vertex, a vertex is not finite, or the radius is negative or not finite.
    pub fn new(vertices: Vec<Vec2>, radius: f64) -> Self {
        assert!(
            !vertices.is_empty(),
            "a convex part needs at least one vertex"
        );
        assert!(
            vertices.iter().all(|v| v.x.is_finite() && v.y.is_finite()),
            "a convex part needs finite vertices"
        );
        assert!(
            radius >= 0.0 && radius.is_finite(),
            "a convex part needs a radius >= 0, not {radius}"
        );
        let vertices = clean(vertices);
        let (min, max) = bounds(vertices.iter().copied());
        let middle = 0.5 * (min + max);
        let reach = vertices
            .iter()
            .map(|v| (v - middle).norm())
            .fold(0.0, f64::max);
        let mut part = Self {
            vertices,
            normals: Vec::new(),
            radius,
            middle,
            size: reach + radius,
            width: 0.0,
        };
        part.set_faces();
        part
    }

    /// A disc.
    pub fn ball(centre: Vec2, radius: f64) -> Self {
        Self::new(vec![centre], radius)
    }

    /// All points within `radius` of the segment from `a` to `b`.
    pub fn capsule(a: Vec2, b: Vec2, radius: f64) -> Self {
        Self::new(vec![a, b], radius)
    }

    /// The thin segment from `a` to `b`, solid on both sides.
    pub fn segment(a: Vec2, b: Vec2) -> Self {
        Self::new(vec![a, b], 0.0)
    }

    /// The segment from `a` to `b` with material on its right: what is opposite to it on the right is inside, however
    /// deep, and is pushed out to the left.
    pub fn one_sided_segment(a: Vec2, b: Vec2) -> Self {
        let mut part = Self::new(vec![a, b], 0.0);
        part.normals.truncate(1);
        part
    }

    /// A polygon rounded by `radius`; see [`ConvexPart::new`].
    pub fn polygon(vertices: Vec<Vec2>, radius: f64) -> Self {
        Self::new(vertices, radius)
    }

    /// All points with `normal · x <= 0`; the boundary passes through the local origin.
    ///
    /// # Panics
    /// If `normal` has no direction.
    pub fn half_space(normal: Vec2) -> Self {
        let length = normal.norm();
        assert!(
            length > 0.0 && length.is_finite(),
            "a half-space needs a normal with a direction"
        );
        Self {
            vertices: Vec::new(),
            normals: vec![normal / length],
            radius: 0.0,
            middle: Vec2::zeros(),
            size: f64::INFINITY,
            width: f64::INFINITY,
        }
    }

    fn set_faces(&mut self) {
        let n_faces = if self.vertices.len() == 1 {
            0
        } else {
            self.vertices.len()
        };
        self.normals.reserve_exact(n_faces);
        for face in 0..n_faces {
            let [start, end] = self.face(face);
            self.normals.push(-perp(end - start).normalize());
        }
        if n_faces >= 3 {
            let depth = |face: usize| {
                let depths = self.vertices.iter().map(|v| -self.face_distance(face, *v));
                depths.fold(0.0, f64::max)
            };
            self.width = (0..n_faces).map(depth).fold(f64::INFINITY, f64::min);
        }
    }

    /// The core's vertices, counter-clockwise; none for a half-space.
    #[inline]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// The outward unit normals of the faces.
    #[inline]
    pub fn normals(&self) -> &[Vec2] {
        &self.normals
    }

    /// The radius of the rounding (m).
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether the part is a half-space.
    #[inline]
    pub fn is_half_space(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Whether both sides of a two-vertex core push: false only for [`ConvexPart::one_sided_segment`].
    #[inline]
    pub fn is_two_sided(&self) -> bool {
        !self.is_one_sided()
    }

    #[inline]
    pub(super) fn is_one_sided(&self) -> bool {
        self.vertices.len() == 2 && self.normals.len() == 1
    }

    /// Radius of the part about the middle of its bounding box (m), infinite for a half-space: the length that its
    /// tolerances refer to.
    #[inline]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Middle of its bounding box, in its own coordinates (m).
    #[inline]
    pub fn middle(&self) -> Vec2 {
        self.middle
    }

    #[inline]
    /// Least thickness of the core (m): 0 for points and segments, infinite for a half-space.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Radius of the smallest disc about the local origin that covers the part (m); infinite for a half-space.
    pub fn bounding_radius(&self) -> f64 {
        if self.is_half_space() {
            return f64::INFINITY;
        }
        self.radius + self.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }

    /// Lower and upper corner of the part's bounding box at `pose` (m); infinite for a half-space.
    pub fn aabb(&self, pose: &Pose2) -> [Vec2; 2] {
        if self.is_half_space() {
            return [Vec2::repeat(f64::NEG_INFINITY), Vec2::repeat(f64::INFINITY)];
        }
        let (min, max) = bounds(self.vertices.iter().map(|v| pose.transform(*v)));
        let round = Vec2::repeat(self.radius);
        [min - round, max + round]
    }

    /// Indices of the vertices where a face starts and ends.
    ///
    /// # Panics
    /// If the part is a half-space or a ball.
    #[inline]
    pub fn face_vertices(&self, face: usize) -> [usize; 2] {
        let n_vertices = self.vertices.len();
        match n_vertices {
            2 => [1 - face, face],
            _ => [face, (face + 1) % n_vertices],
        }
    }

    /// Start and end of a face of the core (m). The boundary of a half-space is given by two points one metre apart.
    #[inline]
    pub fn face(&self, face: usize) -> [Vec2; 2] {
        if self.is_half_space() {
            let half = 0.5 * perp(self.normals[0]);
            return [-half, half];
        }
        self.face_vertices(face).map(|vertex| self.vertices[vertex])
    }

    /// Signed distance of a local point to the line of a face of the core (m), positive outside.
    #[inline]
    pub(super) fn face_distance(&self, face: usize, point: Vec2) -> f64 {
        if self.is_half_space() {
            return self.normals[0].dot(&point);
        }
        let start = self.face_vertices(face)[0];
        self.normals[face].dot(&(point - self.vertices[start]))
    }

    /// Normals of the faces that end and start at a vertex: the cone of outward directions, counter-clockwise.
    /// `None` for a ball, whose cone is the whole plane.
    pub(super) fn normal_cone(&self, vertex: usize) -> Option<[Vec2; 2]> {
        match self.vertices.len() {
            0 | 1 => None,
            2 => {
                let side = if vertex == 0 {
                    self.normals[0]
                } else {
                    -self.normals[0]
                };
                Some([side, -side])
            }
            n => Some([self.normals[(vertex + n - 1) % n], self.normals[vertex]]),
        }
    }
}
