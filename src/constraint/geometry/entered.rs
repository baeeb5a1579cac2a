//! Signed distance of a vertex that may have come into a part during the step, measured behind the face it came in by.
//!
//! The nearest face is the wrong one for what moves far within a step. The path of the vertex, straight as seen from the part,
//! enters a convex polygon through the last of the face lines that it crosses inwards.

use super::depth::{DEEP, RESTING};
use super::separation::{TIE, from_face};
use super::{ConvexPart, Feature, PairContact, Pose2, Separation, polygon_pair, separation};
use crate::math::{Vec2, rounding};

/// Signed distance of a point (m) that went through the local places of `path`, the first at the beginning of the step.
///
/// - `towards`: direction from the part to the body of the point when the step began, in the part's axes; zero if they were
///   far apart. It tells the side of a point that rested on the surface or overlapped it.
///
/// # Panics
/// If the path is empty.
pub fn entered_separation(part: &ConvexPart, path: &[Vec2], towards: Vec2) -> Separation {
    let (start, point) = (path[0], path[path.len() - 1]);
    let side = way_out(part, start, towards);
    if part.normals().len() < 3 {
        let reference = side.map(|face| Feature::Face(face as u32));
        return separation(part, point, reference, Some(start));
    }
    // The face that the point is behind, `None` while it is outside and has not passed through.
    let mut is_in = is_inside(part, start);
    let mut behind = side.filter(|_| is_in);
    let mut deepest = depth(part, start);
    for places in path.windows(2) {
        let enters = is_inside(part, places[1]);
        if enters && !is_in && behind.is_none() {
            behind = entered_face(part, places[0], places[1], towards);
            deepest = 0.0;
        }
        if enters {
            deepest = deepest.max(depth(part, places[1]));
        } else if is_in && deepest < DEEP * part.width() {
            // It only slid off an edge.
            behind = None;
        } else if !is_in && behind.is_none() {
            behind = passed_face(part, places[0], places[1]);
            deepest = part.width();
        }
        is_in = enters;
    }
    let met = behind.map(|face| from_face(part, face, point));
    met.filter(|met| is_in || met.distance < -part.radius())
        .unwrap_or_else(|| separation(part, point, None, None))
}

/// Signed distance at the beginning of the step (m), of a point that [`entered_separation`] measures.
pub fn start_separation(part: &ConvexPart, start: Vec2, towards: Vec2) -> Separation {
    let side = way_out(part, start, towards);
    match side {
        Some(face) if part.normals().len() >= 3 && is_inside(part, start) => {
            from_face(part, face, start)
        }
        _ => separation(
            part,
            start,
            side.map(|face| Feature::Face(face as u32)),
            None,
        ),
    }
}

/// Whether a point is within the core or so near to it that rounding decides.
fn is_inside(part: &ConvexPart, point: Vec2) -> bool {
    let tie = TIE * part.size();
    (0..part.normals().len()).all(|face| part.face_distance(face, point) <= tie)
}

/// The last face line that the way from `start`, outside, to `point`, inside, crosses; where it comes in at a corner, the face
/// there whose normal is nearest to `towards`.
fn entered_face(part: &ConvexPart, start: Vec2, point: Vec2, towards: Vec2) -> Option<usize> {
    let tie = TIE * part.size();
    let mut last: Option<f64> = None;
    for face in 0..part.normals().len() {
        let before = part.face_distance(face, start);
        if before > tie {
            let when = before / (before - part.face_distance(face, point));
            last = Some(last.map_or(when, |latest| latest.max(when)));
        }
    }
    let entry = start + last? * (point - start);
    way_out(
        part,
        entry,
        if towards == Vec2::zeros() {
            start - point
        } else {
            towards
        },
    )
}

/// The face that a vertex came in by if it passed through the part between two places, or cut one of its corners.
fn passed_face(part: &ConvexPart, start: Vec2, point: Vec2) -> Option<usize> {
    let (mut enter, mut leave) = (0.0, 1.0);
    let mut entry = None;
    for face in 0..part.normals().len() {
        let before = part.face_distance(face, start);
        let after = part.face_distance(face, point);
        if before > 0.0 && after > 0.0 {
            return None;
        }
        let when = before / (before - after);
        if before > 0.0 && when >= enter {
            (enter, entry) = (when, Some(face));
        } else if after > 0.0 {
            leave = f64::min(leave, when);
        }
    }
    let middle = start + 0.5 * (enter + leave) * (point - start);
    let is_deep = enter < leave && depth(part, middle) > DEEP * part.width();
    entry.filter(|_| is_deep)
}

/// Depth below the nearest face, negative outside (m).
fn depth(part: &ConvexPart, point: Vec2) -> f64 {
    (0..part.normals().len()).fold(f64::INFINITY, |least, face| {
        least.min(-part.face_distance(face, point))
    })
}

/// The face by which a point that began the step in a part, or on its surface, leaves it: the nearest if it is hardly inside,
/// else, and among equally near ones, the one whose normal is nearest to `towards`; `None` for the zero vector.
fn way_out(part: &ConvexPart, start: Vec2, towards: Vec2) -> Option<usize> {
    let faces = 0..part.normals().len();
    let depths = faces.clone().map(|face| part.face_distance(face, start));
    let nearest = depths.fold(f64::NEG_INFINITY, f64::max);
    let slop = RESTING * part.width();
    let is_deep = part.width() == 0.0 || nearest < -slop;
    let mut best: Option<(f64, usize)> = None;
    for face in faces.filter(|&face| is_deep || part.face_distance(face, start) >= nearest - slop) {
        let along = part.normals()[face].dot(&towards);
        if along != 0.0 && best.is_none_or(|(most, _)| along > most) {
            best = Some((along, face));
        }
    }
    best.map(|(_, face)| face)
}

/// The deepest contact of two polygons that overlap although neither has a vertex in the other; `None` for all others.
pub fn crossing_overlap(
    a: &ConvexPart,
    pose_a: &Pose2,
    b: &ConvexPart,
    pose_b: &Pose2,
) -> Option<PairContact> {
    // Cores that cross: rounded surfaces meet before, by their vertices.
    let margin = -a.radius() - b.radius() - CROSSED * a.size().min(b.size());
    let found = polygon_pair(a, pose_a, b, pose_b, margin, None);
    let deepest = found
        .iter()
        .min_by(|one, other| one.distance.total_cmp(&other.distance))?;
    let holds = |part: &ConvexPart, pose: &Pose2, other: &ConvexPart, at: &Pose2| {
        let tie = CROSSED * part.size();
        let mut vertices = other.vertices().iter();
        vertices.any(|vertex| depth(part, pose.inverse_transform(at.transform(*vertex))) > tie)
    };
    let is_seen = holds(a, pose_a, b, pose_b) || holds(b, pose_b, a, pose_a);
    (!is_seen).then_some(*deepest)
}

/// Overlap, relative to the smaller part's size, from which crossing edges count: below it they rest on each other.
const CROSSED: f64 = rounding::SINGLE;
