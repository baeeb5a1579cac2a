//! Outlines of rapier's shapes: the points and edges that flexible surfaces meet, converted once and kept until the shape changes.
//!
//! What has a core keeps its true surface: the outline is drawn inwards by an offset and rounded by it, which rounds sharp corners by
//! that much and nothing else. Chains without thickness (polylines, height fields, the rim of triangle meshes) stay where they are and
//! are met at the offset.

use super::shapes::{convert, pose_of};
use crate::constraint::geometry::tangle::Loops;
use crate::constraint::geometry::{ConvexPart, Pose2};
use crate::math::{HashMap, Vec2, atan2, cross, from_rapier};
use crate::rapier::parry::shape::{Shape, TypedShape};
use crate::rapier::prelude::*;

/// A piece of an outline, in the collider's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Piece {
    /// All points with `normal · (x - origin) <= 0`.
    HalfSpace {
        /// A point of the boundary (m).
        origin: Vec2,
        /// Outward unit normal.
        normal: Vec2,
    },
    /// A convex core, counter-clockwise: a polygon, a segment or a point, rounded by a radius.
    Convex {
        /// The core's vertices (m).
        vertices: Vec<Vec2>,
        /// Radius of the rounding (m).
        radius: f64,
        /// Least thickness of the core (m).
        width: f64,
    },
    /// Edges without thickness.
    Chain {
        /// Points (m).
        points: Vec<Vec2>,
        /// Edges between them.
        edges: Vec<[u32; 2]>,
        /// Whether they run around something solid, on their left.
        is_rim: bool,
    },
}

impl Piece {
    /// Number of points that a piece may be drawn with.
    fn n_points(&self) -> u32 {
        match self {
            Self::HalfSpace { .. } => 2,
            Self::Convex {
                vertices, radius, ..
            } if *radius > 0.0 => Loops::n_rounded(vertices.len()) as u32,
            Self::Convex { vertices, .. } => vertices.len() as u32,
            Self::Chain { points, .. } => points.len() as u32,
        }
    }
}

/// The outline of one collider.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    /// Its pieces, in the order of the shape.
    pub pieces: Vec<Piece>,
}

impl Outline {
    /// Its pieces with the names that their points are counted from: those of the collider are counted through, so that as many pieces
    /// have names of their own as there are points.
    pub fn named_pieces(&self) -> impl Iterator<Item = (u32, &Piece)> {
        self.pieces.iter().scan(0, |next, piece| {
            let first = *next;
            *next += piece.n_points();
            Some((first, piece))
        })
    }

    /// Distance at which flexible surfaces stay from true ones (m): the offset, where something has no thickness.
    pub fn gap(&self, offset: f64) -> f64 {
        let is_thin = |piece: &Piece| matches!(piece, Piece::Chain { .. });
        if self.pieces.iter().any(is_thin) {
            offset
        } else {
            0.0
        }
    }
}

/// Outlines of all colliders met so far.
#[derive(Default)]
pub(super) struct OutlineCache {
    entries: HashMap<ColliderHandle, (SharedShape, Outline)>,
}

impl std::fmt::Debug for OutlineCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OutlineCache")
            .field("n_outlines", &self.entries.len())
            .finish()
    }
}

impl OutlineCache {
    /// The outline of a collider's shape.
    pub fn outline(&mut self, handle: ColliderHandle, collider: &Collider) -> &Outline {
        let shape = collider.shared_shape();
        let entry = self
            .entries
            .entry(handle)
            .or_insert_with(|| (shape.clone(), outline_of(shape.as_ref())));
        if !std::sync::Arc::ptr_eq(&entry.0.0, &shape.0) {
            *entry = (shape.clone(), outline_of(shape.as_ref()));
        }
        &entry.1
    }

    /// The outline of a collider that has been met, if it has.
    pub fn known(&self, handle: ColliderHandle) -> Option<&Outline> {
        self.entries.get(&handle).map(|(_, outline)| outline)
    }

    /// Drops outlines of colliders that no longer exist.
    pub fn retain(&mut self, colliders: &ColliderSet) {
        self.entries.retain(|handle, _| colliders.contains(*handle));
    }
}

/// Whether a shape is one convex piece, which is drawn as a whole wherever it is drawn.
pub(super) fn is_convex_piece(shape: &dyn Shape) -> bool {
    matches!(outline_of(shape).pieces[..], [Piece::Convex { .. }])
}

/// The outline of a shape.
pub(super) fn outline_of(shape: &dyn Shape) -> Outline {
    let mut outline = Outline::default();
    add_shape(shape, Pose2::identity(), &mut outline.pieces);
    outline
}

fn add_shape(shape: &dyn Shape, pose: Pose2, pieces: &mut Vec<Piece>) {
    match shape.as_typed_shape() {
        TypedShape::Polyline(polyline) => {
            let points = polyline.vertices().iter();
            let points = points.map(|&point| pose.transform(from_rapier(point)));
            pieces.push(Piece::Chain {
                points: points.collect(),
                edges: polyline.indices().to_vec(),
                is_rim: false,
            });
        }
        TypedShape::HeightField(field) => {
            let mut points: Vec<Vec2> = Vec::new();
            let mut edges = Vec::new();
            let mut goes_on = false;
            for cell in 0..field.num_cells() {
                let Some(segment) = field.segment_at(cell) else {
                    goes_on = false;
                    continue;
                };
                // Neighbours share a vertex, whose place each of them rounds in its own way.
                if !goes_on {
                    points.push(pose.transform(from_rapier(segment.a)));
                }
                points.push(pose.transform(from_rapier(segment.b)));
                let end = points.len() as u32 - 1;
                edges.push([end - 1, end]);
                goes_on = true;
            }
            pieces.push(Piece::Chain {
                points,
                edges,
                is_rim: false,
            });
        }
        TypedShape::TriMesh(mesh) => {
            let points = mesh.vertices().iter();
            let points = points.map(|&point| pose.transform(from_rapier(point)));
            let points: Vec<Vec2> = points.collect();
            pieces.push(Piece::Chain {
                edges: rim_of(&points, mesh.indices()),
                points,
                is_rim: true,
            });
        }
        TypedShape::Segment(segment) => pieces.push(Piece::Chain {
            points: [segment.a, segment.b]
                .map(|point| pose.transform(from_rapier(point)))
                .to_vec(),
            edges: vec![[0, 1]],
            is_rim: false,
        }),
        TypedShape::Compound(compound) => {
            for (local, child) in compound.shapes() {
                let local = pose_of(local);
                let angle = atan2(pose.sin, pose.cos) + atan2(local.sin, local.cos);
                let pose = Pose2::new(pose.transform(local.translation), angle);
                add_shape(child.as_ref(), pose, pieces);
            }
        }
        _ => {
            let mut parts = Vec::new();
            // What cannot be converted has been refused where it was placed.
            if convert(shape, pose, &mut parts).is_err() {
                return;
            }
            pieces.extend(parts.iter().map(|part| piece_of(&part.part, &part.pose)));
        }
    }
}

fn piece_of(part: &ConvexPart, pose: &Pose2) -> Piece {
    if part.is_half_space() {
        return Piece::HalfSpace {
            origin: pose.translation,
            normal: pose.rotate(part.normals()[0]),
        };
    }
    Piece::Convex {
        vertices: part.vertices().iter().map(|v| pose.transform(*v)).collect(),
        radius: part.radius(),
        width: part.width(),
    }
}

/// The edges that belong to one triangle only, with it on their left.
fn rim_of(points: &[Vec2], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut sides: Vec<([u32; 2], [u32; 2])> = Vec::new();
    for &[a, b, c] in triangles {
        let [at, one, other] = [a, b, c].map(|name| points[name as usize]);
        let is_left = cross(one - at, other - at) >= 0.0;
        let [b, c] = if is_left { [b, c] } else { [c, b] };
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.push(([from.min(to), from.max(to)], [from, to]));
        }
    }
    sides.sort_unstable();
    let is_rim = |slot: &usize| {
        let name = sides[*slot].0;
        let before = slot.checked_sub(1).map(|other| sides[other].0);
        let after = sides.get(slot + 1).map(|other| other.0);
        before != Some(name) && after != Some(name)
    };
    let rim = (0..sides.len()).filter(is_rim);
    rim.map(|slot| sides[slot].1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapier::parry::shape::{HeightField, Segment};

    #[test]
    fn cells_of_a_height_field_are_one_chain_but_for_removed_ones() {
        let n = 600;
        let mut field = HeightField::new(vec![0.0; n + 1], Vector::new(60.0, 1.0));
        let pieces = |field: &HeightField| match &outline_of(field).pieces[..] {
            [Piece::Chain { points, edges, .. }] => [points.len(), edges.len()],
            _ => [0, 0],
        };
        // Seen from both sides, the places of these joints differ by rounding.
        let all: Vec<Segment> = field.segments().collect();
        assert!(all.windows(2).any(|pair| pair[0].b != pair[1].a));
        assert_eq!(pieces(&field), [n + 1, n]);
        field.set_segment_removed(7, true);
        assert_eq!(pieces(&field), [n + 1, n - 1]);
    }

    #[test]
    fn the_rim_of_two_triangles_leaves_out_what_they_share() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        let mut rim = rim_of(&square, &[[0, 2, 1], [0, 2, 3]]);
        rim.sort_unstable();
        assert_eq!(rim, [[0, 1], [1, 2], [2, 3], [3, 0]]);
    }
}
