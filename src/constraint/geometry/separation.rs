//! Signed distance of a point to a rounded convex part, `d(p) = min |p - x| - r` over the core `x` outside and
//! `d(p) = max n_i·(p - v_i) - r` over the faces inside.
//!
//! What the instantaneous distance cannot tell, the point's position at the beginning of the step does: through which
//! face it came in, on which side of a thin part it belongs, and whether it passed right through.

use super::depth::RESTING;
use super::entry::{Axis, crossed_face, inside, thin_entry_face};
use super::segment_query::direction_or;
use super::{ConvexPart, Feature};
use crate::math::{Vec2, cross, perp, rounding};

/// Relative to the part's size: a point this near to a vertex has no direction from it.
pub(super) const AT_VERTEX: f64 = rounding::SUM;

/// Relative to the part's size: features whose distances differ by less than this tie. A node flush with an edge breathes over it by some
/// 1e-8 as forces change, and keeps its face: where node and vertex took turns, towers never came to rest.
pub(super) const TIE: f64 = rounding::SINGLE;

/// A point seen from a rounded convex part, in the part's local coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Signed distance to the rounded surface (m), negative inside.
    pub distance: f64,
    /// Outward unit normal, from the part to the point; the gradient of `distance`.
    pub normal: Vec2,
    /// The feature of the core that the distance refers to.
    pub feature: Feature,
    /// Nearest point of that feature of the core (m); the surface point is `foot + radius * normal`.
    pub foot: Vec2,
}

/// Signed distance of a local `point` to the surface of `part`, with the feature it refers to.
///
/// - `reference`: the feature of the last query; it is kept while it ties with the best one. It also tells the side
///   of a thin part for a point that `start` leaves undecided.
/// - `start`: local position of the point at the beginning of the step (m). A point inside is then measured to a
///   face that was visible from there, and one that crossed the core is reported behind the face it came in by.
///   Without it, the nearest face counts.
///
/// The normal is a unit vector for every finite input: at a vertex it is taken from within the vertex's cone, towards
/// `start` if that is known.
pub fn separation(
    part: &ConvexPart,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Separation {
    let reference = reference.filter(|feature| exists(part, *feature));
    match part.vertices().len() {
        0 => from_face(part, 0, point),
        1 => from_vertex(part, 0, point, start),
        2 => thin_separation(part, point, reference, start),
        _ => polygon_separation(part, point, reference, start),
    }
}

fn exists(part: &ConvexPart, feature: Feature) -> bool {
    match feature {
        Feature::Face(face) => (face as usize) < part.normals().len(),
        Feature::Vertex(vertex) => (vertex as usize) < part.vertices().len(),
    }
}

/// The shallowest face of a polygon that a `point` inside it lies behind, that it came from and that `faces` it; for a point whose
/// nearest face cannot push it, as beside the corner that it belongs above.
pub fn faced_separation(
    part: &ConvexPart,
    point: Vec2,
    start: Vec2,
    faces: impl Fn(Vec2) -> bool,
) -> Option<Separation> {
    let slop = RESTING * part.width();
    let n_faces = if part.width() > 0.0 && !part.is_half_space() {
        part.normals().len()
    } else {
        0
    };
    let is_inside = (0..n_faces).all(|face| part.face_distance(face, point) <= 0.0);
    (0..n_faces)
        .filter(|&face| is_inside && part.face_distance(face, start) >= -slop)
        .map(|face| from_face(part, face, point))
        .filter(|found| faces(found.normal))
        .max_by(|one, other| one.distance.total_cmp(&other.distance))
}

/// The separation as measured to the line of one face.
pub(super) fn from_face(part: &ConvexPart, face: usize, point: Vec2) -> Separation {
    let normal = part.normals()[face];
    let depth = part.face_distance(face, point);
    let foot = if part.is_half_space() {
        point - depth * normal
    } else {
        let [start, end] = part.face(face);
        let edge = end - start;
        start + (edge.dot(&(point - start)) / edge.norm_squared()).clamp(0.0, 1.0) * edge
    };
    Separation {
        distance: depth - part.radius(),
        normal,
        feature: Feature::Face(face as u32),
        foot,
    }
}

/// The separation as measured to one vertex, with a normal inside its cone.
pub(super) fn from_vertex(
    part: &ConvexPart,
    vertex: usize,
    point: Vec2,
    start: Option<Vec2>,
) -> Separation {
    let foot = part.vertices()[vertex];
    let offset = point - foot;
    let distance = offset.norm();
    let near = AT_VERTEX * part.size();
    let cone = part.normal_cone(vertex);
    let middle = cone.map_or(Vec2::y(), |[first, last]| {
        direction_or(first + last, perp(first))
    });
    let direction = if distance > near {
        direction_or(offset, middle)
    } else {
        let approach = start.map_or(Vec2::zeros(), |start| start - foot);
        if approach.norm() > near {
            direction_or(approach, middle)
        } else {
            middle
        }
    };
    Separation {
        distance: distance - part.radius(),
        normal: cone.map_or(direction, |cone| clamp_to_cone(direction, cone, middle)),
        feature: Feature::Vertex(vertex as u32),
        foot,
    }
}

/// The unit vector of a cone (counter-clockwise from `first` to `last`) that is nearest to `direction`.
fn clamp_to_cone(direction: Vec2, [first, last]: [Vec2; 2], middle: Vec2) -> Vec2 {
    let within = cross(first, direction) >= 0.0 && cross(direction, last) >= 0.0;
    if within && direction.dot(&middle) >= 0.0 {
        direction
    } else if first.dot(&direction) >= last.dot(&direction) {
        first
    } else {
        last
    }
}

/// Parts with a core of two vertices.
fn thin_separation(
    part: &ConvexPart,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Separation {
    let axis = Axis::new(part);
    let [along, height] = axis.coordinates(point);
    if let Some(face) = thin_entry_face(part, &axis, point, reference, start) {
        return from_face(part, face, point);
    }
    let tie = TIE * part.size();
    let keeps = |vertex: u32| reference == Some(Feature::Vertex(vertex));
    let keeps_face = matches!(reference, Some(Feature::Face(_)));
    let slack = if keeps_face { tie } else { 0.0 };
    if along < -slack || (keeps(0) && along < tie) {
        return from_vertex(part, 0, point, start);
    }
    if along > axis.length + slack || (keeps(1) && along > axis.length - tie) {
        return from_vertex(part, 1, point, start);
    }
    from_face(part, usize::from(height < 0.0), point)
}

/// Parts with a polygonal core.
fn polygon_separation(
    part: &ConvexPart,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Separation {
    let is_inside = (0..part.normals().len()).all(|face| part.face_distance(face, point) <= 0.0);
    if is_inside {
        return inside(part, point, reference, start);
    }
    let entry = start.and_then(|start| crossed_face(part, start, point, reference));
    match entry {
        Some(face) => from_face(part, face, point),
        None => outside(part, point, reference, start),
    }
}

/// The nearest feature of a polygon for a point outside its core.
fn outside(
    part: &ConvexPart,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Separation {
    let tie = TIE * part.size();
    let mut best = f64::INFINITY;
    let mut nearest = Feature::Face(0);
    for face in 0..part.normals().len() {
        let height = part.face_distance(face, point);
        if height <= 0.0 {
            continue;
        }
        let ([first, last], along, length) = along_face(part, face, point);
        let (distance, feature) = if along < 0.0 {
            (
                (point - part.vertices()[first]).norm(),
                Feature::Vertex(first as u32),
            )
        } else if along > length {
            (
                (point - part.vertices()[last]).norm(),
                Feature::Vertex(last as u32),
            )
        } else {
            (height, Feature::Face(face as u32))
        };
        if distance < best {
            (best, nearest) = (distance, feature);
        }
    }
    let kept = reference.filter(|feature| ties(part, *feature, point, best, tie));
    match kept.unwrap_or(nearest) {
        Feature::Face(face) => from_face(part, face as usize, point),
        Feature::Vertex(vertex) => from_vertex(part, vertex as usize, point, start),
    }
}

/// Whether a feature holds a point of the core as near to `point` as `best`, up to `tie`.
fn ties(part: &ConvexPart, feature: Feature, point: Vec2, best: f64, tie: f64) -> bool {
    match feature {
        Feature::Face(face) => {
            let (_, along, length) = along_face(part, face as usize, point);
            let height = part.face_distance(face as usize, point);
            along >= -tie && along <= length + tie && height >= best - tie
        }
        Feature::Vertex(vertex) => {
            let vertex = vertex as usize;
            let n = part.vertices().len();
            let (_, before, length) = along_face(part, (vertex + n - 1) % n, point);
            let (_, after, _) = along_face(part, vertex, point);
            // The Voronoi region of the vertex, widened by the tie.
            let is_near = (point - part.vertices()[vertex]).norm() <= best + tie;
            is_near && before >= length - tie && after <= tie
        }
    }
}

/// End vertices of a face, position of the point along it and its length (m).
fn along_face(part: &ConvexPart, face: usize, point: Vec2) -> ([usize; 2], f64, f64) {
    let ends = part.face_vertices(face);
    let [start, end] = part.face(face);
    let length = (end - start).norm();
    (ends, (end - start).dot(&(point - start)) / length, length)
}
