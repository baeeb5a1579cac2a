//! On which side of a part a point belongs, from where it was at the beginning of the step: the entry face is the last
//! one that the path `start + t (point - start)` crosses inward.

use super::depth::{RESTING, RESTING_THIN};
use super::separation::{AT_VERTEX, TIE, from_face, from_vertex};
use super::{ConvexPart, Feature, Separation};
use crate::math::{Vec2, cross};

/// Start, direction and length of a two-vertex core.
pub(super) struct Axis {
    origin: Vec2,
    direction: Vec2,
    pub length: f64,
}

impl Axis {
    pub fn new(part: &ConvexPart) -> Self {
        let [origin, end] = [part.vertices()[0], part.vertices()[1]];
        let length = (end - origin).norm();
        Self {
            origin,
            direction: (end - origin) / length,
            length,
        }
    }

    /// Position along the axis and to the left of it.
    pub fn coordinates(&self, point: Vec2) -> [f64; 2] {
        let offset = point - self.origin;
        [self.direction.dot(&offset), cross(self.direction, offset)]
    }

    fn spans(&self, along: f64, slack: f64) -> bool {
        along >= -slack && along <= self.length + slack
    }
}

/// The face of a two-vertex core that a point belongs to although it lies behind it or on the axis.
pub(super) fn thin_entry_face(
    part: &ConvexPart,
    axis: &Axis,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Option<usize> {
    let [along, height] = axis.coordinates(point);
    let is_opposite = axis.spans(along, 0.0);
    if part.is_one_sided() {
        return is_opposite.then_some(0);
    }
    let reference_face = match reference {
        Some(Feature::Face(face)) => Some(face as usize),
        _ => None,
    };
    let on_axis = height.abs() <= AT_VERTEX * part.size();
    let Some(start) = start else {
        let undecided = is_opposite && (on_axis || part.radius() == 0.0);
        return reference_face.filter(|_| undecided);
    };
    let [start_along, start_height] = axis.coordinates(start);
    let slop = RESTING_THIN * part.size();
    if start_height.abs() <= slop && axis.spans(start_along, slop) && reference_face.is_some() {
        // Resting on the axis: its side is what it was, not what rounding makes of the start.
        return reference_face.filter(|_| is_opposite);
    }
    if start_height.abs() <= AT_VERTEX * part.size() {
        return None;
    }
    let side = usize::from(start_height < 0.0);
    let is_behind = on_axis || (height < 0.0) != (start_height < 0.0);
    let crossing = start_along + (along - start_along) * start_height / (start_height - height);
    let crossing = if on_axis { along } else { crossing };
    (is_behind && axis.spans(crossing, 0.0)).then_some(side)
}

/// The face that a point inside a polygon is measured to.
pub(super) fn inside(
    part: &ConvexPart,
    point: Vec2,
    reference: Option<Feature>,
    start: Option<Vec2>,
) -> Separation {
    let n_faces = part.normals().len();
    let tie = TIE * part.size();
    let slop = RESTING * part.width();
    let start_best = start.map_or(f64::INFINITY, |start| {
        let distances = (0..n_faces).map(|face| part.face_distance(face, start));
        distances.fold(f64::NEG_INFINITY, f64::max)
    });
    if let (true, Some(Feature::Face(face))) = (start_best < -slop, reference) {
        // Deep inside since before this step: only the reference still knows the way out.
        return from_face(part, face as usize, point);
    }
    let limit = start_best.min(0.0) - slop;
    let is_visible =
        |face: usize| start.is_none_or(|start| part.face_distance(face, start) >= limit);
    let approach = |face: usize| {
        start.map_or(0.0, |start| {
            part.face_distance(face, start) - part.face_distance(face, point)
        })
    };
    let mut best = f64::NEG_INFINITY;
    let mut nearest = 0;
    for face in (0..n_faces).filter(|face| is_visible(*face)) {
        let distance = part.face_distance(face, point);
        let wins_tie = distance >= best - tie && approach(face) > approach(nearest) + tie;
        if distance > best + tie || wins_tie {
            nearest = face;
        }
        best = best.max(distance);
    }
    match reference {
        Some(Feature::Face(face)) => {
            let face = face as usize;
            let is_kept = is_visible(face) && part.face_distance(face, point) >= best - tie;
            from_face(part, if is_kept { face } else { nearest }, point)
        }
        Some(Feature::Vertex(vertex))
            if (point - part.vertices()[vertex as usize]).norm() <= tie =>
        {
            from_vertex(part, vertex as usize, point, start)
        }
        _ => from_face(part, nearest, point),
    }
}

/// The face by which a point that is outside now came into the core during the step, if it crossed the core by more
/// than the slop.
pub(super) fn crossed_face(
    part: &ConvexPart,
    start: Vec2,
    point: Vec2,
    reference: Option<Feature>,
) -> Option<usize> {
    let n_faces = part.normals().len();
    let slop = RESTING * part.width();
    let (mut enter, mut leave) = (0.0, 1.0);
    let mut entry = None;
    let (mut start_best, mut start_face) = (f64::NEG_INFINITY, 0);
    for face in 0..n_faces {
        let before = part.face_distance(face, start);
        let after = part.face_distance(face, point);
        if before > start_best {
            (start_best, start_face) = (before, face);
        }
        if before > 0.0 && after > 0.0 {
            return None;
        }
        if before > 0.0 && before / (before - after) >= enter {
            (enter, entry) = (before / (before - after), Some(face));
        } else if after > 0.0 {
            leave = f64::min(leave, before / (before - after));
        }
    }
    if enter >= leave {
        return None;
    }
    let reference_face = match reference {
        Some(Feature::Face(face)) => Some(face as usize),
        _ => None,
    };
    // A start on or below the surface came in earlier, by the reference if that is still its way out.
    let is_way_out = |face: &usize| start_best < -slop || part.face_distance(*face, start) >= -slop;
    let near_face = (start_best >= -slop).then_some(start_face);
    let entry = entry.or(reference_face.filter(is_way_out)).or(near_face)?;
    let middle = start + 0.5 * (enter + leave) * (point - start);
    let is_deep = (0..n_faces).all(|face| part.face_distance(face, middle) < -slop);
    (is_deep && part.face_distance(entry, point) < 0.0).then_some(entry)
}
