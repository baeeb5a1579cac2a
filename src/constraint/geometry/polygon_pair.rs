//! Contacts between two rounded convex parts: up to two points of one part against one face of the other, each with
//! `distance = n·(p - face) - r_a - r_b`, or one vertex against one vertex with `distance = |p_b - p_a| - r_a - r_b`.
//!
//! The pair is decided on the cores: the axis of least overlap gives the reference face, the edge of the other part
//! that faces it is clipped to the width of the reference face (as in Box2D). Where the cores are apart and nearest
//! at two vertices, these make the contact.

use super::clip::{ClippedPoint, IncidentEdge};
use super::pair_axis::{Axis, Pair};
use super::segment_query::direction_or;
use super::{ConvexPart, Pose2};
use crate::math::{Vec2, cross};

/// The core feature that a contact point is measured to, in the local coordinates of its part (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaceOrVertex {
    /// Start and end of a face, its outward normal on the right. For a half-space two points of its boundary.
    Face([Vec2; 2]),
    /// A vertex.
    Vertex(Vec2),
}

/// One contact of a pair of parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairContact {
    /// Whether part `b` carries the point and part `a` the face; else the other way round.
    pub point_on_b: bool,
    /// The contact point on the core of the part that carries it, in its local coordinates (m): a vertex, or a point
    /// of an edge that reaches beyond the face.
    pub point: Vec2,
    /// What the point is measured to, in the local coordinates of the other part.
    pub face: FaceOrVertex,
    /// Unit normal in world axes, from the part with the face to the part with the point.
    pub normal: Vec2,
    /// Signed distance of the rounded surfaces (m), negative for overlap.
    pub distance: f64,
    /// Names the pair of features: the carrier (bit 31), vertex against vertex (bit 30), the face or vertex (bits
    /// 15 to 29) and the vertex that is the point or from which it was clipped (bits 0 to 14), so that it stays the
    /// same while a vertex slides past the end of the face.
    pub id: u32,
}

/// The face that the contacts of a pair were measured to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PairReference {
    /// Whether it is a face of part `b`.
    pub on_b: bool,
    /// Its index.
    pub face: u32,
}

/// Up to two contacts of a pair of parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairContacts {
    contacts: [PairContact; 2],
    n_contacts: usize,
    /// To hand to the next query of this pair; `None` after a contact of two vertices.
    pub reference: Option<PairReference>,
}

impl PairContacts {
    const EMPTY: Self = Self {
        contacts: [PairContact {
            point_on_b: true,
            point: Vec2::new(0.0, 0.0),
            face: FaceOrVertex::Vertex(Vec2::new(0.0, 0.0)),
            normal: Vec2::new(0.0, 1.0),
            distance: f64::INFINITY,
            id: 0,
        }; 2],
        n_contacts: 0,
        reference: None,
    };

    /// The contacts, in the direction of the reference face.
    #[inline]
    pub fn as_slice(&self) -> &[PairContact] {
        &self.contacts[..self.n_contacts]
    }

    /// Iterates over the contacts.
    #[inline]
    pub fn iter(&self) -> std::slice::Iter<'_, PairContact> {
        self.as_slice().iter()
    }

    /// Number of contacts.
    #[inline]
    pub fn len(&self) -> usize {
        self.n_contacts
    }

    /// Whether the parts are farther apart than the margin.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.n_contacts == 0
    }

    fn with_reference(part: usize, face: usize) -> Self {
        let reference = Some(PairReference {
            on_b: part == 1,
            face: face as u32,
        });
        Self {
            reference,
            ..Self::EMPTY
        }
    }

    /// Adds a point at a height above the face of `axis` if it is within the margin.
    fn push_face(&mut self, pair: &Pair, axis: Axis, at: ClippedPoint, margin: f64) {
        let target = pair.parts[axis.part];
        let contact = PairContact {
            point_on_b: axis.part == 0,
            point: at.point,
            face: FaceOrVertex::Face(target.face(axis.face)),
            normal: pair.poses[axis.part].rotate(target.normals()[axis.face]),
            distance: at.height - pair.rounding(),
            id: id(axis.part == 0, axis.face, at.vertex),
        };
        self.push(contact, margin);
    }

    fn push(&mut self, contact: PairContact, margin: f64) {
        if contact.distance <= margin {
            self.contacts[self.n_contacts] = contact;
            self.n_contacts += 1;
        }
    }
}

impl<'a> IntoIterator for &'a PairContacts {
    type Item = &'a PairContact;
    type IntoIter = std::slice::Iter<'a, PairContact>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Contacts between part `a` at `pose_a` and part `b` at `pose_b` whose distance is at most `margin` (m).
///
/// - `reference`: what the last query of this pair returned, so that the reference face does not alternate between
///   faces that are about as good, nor turn around while the parts overlap deeply.
///
/// Two half-spaces have no contacts. A part that lies behind a one-sided segment is inside it.
pub fn polygon_pair(
    a: &ConvexPart,
    pose_a: &Pose2,
    b: &ConvexPart,
    pose_b: &Pose2,
    margin: f64,
    reference: Option<PairReference>,
) -> PairContacts {
    let pair = Pair::new([a, b], [*pose_a, *pose_b]);
    match (a.is_half_space(), b.is_half_space()) {
        (true, true) => return PairContacts::EMPTY,
        (true, false) => return half_space_contacts(&pair, 0, margin),
        (false, true) => return half_space_contacts(&pair, 1, margin),
        (false, false) => {}
    }
    if pair.centre_gap() > margin {
        return PairContacts::EMPTY;
    }
    let separating = pair.separating_axis();
    if separating.is_some_and(|axis| pair.is_beyond(axis, margin)) {
        return PairContacts::EMPTY;
    }
    if let Some(vertices) = pair.nearest_vertices(separating) {
        return vertex_contact(&pair, vertices, margin);
    }
    match pair.reference_axis(reference) {
        Some(axis) => face_contacts(&pair, axis, margin),
        None if pair.has_one_sided() => PairContacts::EMPTY,
        None => vertex_contact(&pair, [0, 0], margin),
    }
}

/// Vertex `vertices[0]` of `a` against vertex `vertices[1]` of `b`.
fn vertex_contact(pair: &Pair, vertices: [usize; 2], margin: f64) -> PairContacts {
    // A ball carries the point, as it does against a face.
    let point_on_b = pair.parts[0].vertices().len() > 1 || pair.parts[1].vertices().len() == 1;
    let (target, source) = if point_on_b { (0, 1) } else { (1, 0) };
    let face = pair.parts[target].vertices()[vertices[target]];
    let point = pair.parts[source].vertices()[vertices[source]];
    let offset = pair.relative[target].transform(point) - face;
    let contact = PairContact {
        point_on_b,
        point,
        face: FaceOrVertex::Vertex(face),
        normal: pair.poses[target].rotate(direction_or(offset, Vec2::y())),
        distance: offset.norm() - pair.rounding(),
        id: 1 << 30 | id(point_on_b, vertices[target], vertices[source]),
    };
    let mut contacts = PairContacts::EMPTY;
    contacts.push(contact, margin);
    contacts
}

fn id(point_on_b: bool, target: usize, vertex: usize) -> u32 {
    u32::from(point_on_b) << 31 | (target as u32 & 0x7fff) << 15 | (vertex as u32 & 0x7fff)
}

/// The incident edge against the reference face of `axis`.
fn face_contacts(pair: &Pair, axis: Axis, margin: f64) -> PairContacts {
    let edge = IncidentEdge::new(pair, axis);
    let ends = match edge.clip(pair.tolerance) {
        Some(ends) => ends,
        None if pair.has_one_sided() => return PairContacts::EMPTY,
        // Only a kept reference that is not quite the best axis misses the edge: its lower end stands for it.
        None => [edge.deepest(); 2],
    };
    let mut contacts = PairContacts::with_reference(axis.part, axis.face);
    if (ends[1].point - ends[0].point).norm() > pair.tolerance {
        contacts.push_face(pair, axis, ends[0], margin);
        contacts.push_face(pair, axis, ends[1], margin);
    } else {
        let lower = usize::from(ends[1].height < ends[0].height);
        contacts.push_face(pair, axis, ends[lower], margin);
    }
    contacts
}

/// The lowest vertex of the other part over half-space `part` and the lower one of its neighbours.
fn half_space_contacts(pair: &Pair, part: usize, margin: f64) -> PairContacts {
    let vertices = pair.parts[1 - part].vertices();
    let n = vertices.len();
    let normal = pair.parts[part].normals()[0];
    let place = |vertex: usize| pair.relative[part].transform(vertices[vertex]);
    let height = |vertex: usize| normal.dot(&place(vertex));
    let lower = |one: usize, two: usize| if height(two) < height(one) { two } else { one };
    let lowest = (1..n).fold(0, lower);
    let mut picked = [lowest, lower((lowest + 1) % n, (lowest + n - 1) % n)];
    if cross(normal, place(picked[0]) - place(picked[1])) > 0.0 {
        picked.swap(0, 1);
    }
    let axis = Axis {
        part,
        face: 0,
        separation: height(lowest),
    };
    let mut contacts = PairContacts::with_reference(part, 0);
    for vertex in &picked[..n.min(2)] {
        let point = ClippedPoint {
            vertex: *vertex,
            point: vertices[*vertex],
            height: height(*vertex),
        };
        contacts.push_face(pair, axis, point, margin);
    }
    contacts
}
