//! Vertices that meet: where contacts slide over a vertex and back again, pass after pass.
//!
//! Over an edge the force has the direction of its normal. At a vertex between two edges it may have any direction between those of
//! both, and where neither has its solution over its own edge, this is the one there is: the two vertices stay together, and the force
//! is what holds them. That is one row, with the direction half way, that sticks to the vertex within a cone that reaches the forces
//! on either side, as one that sticks by friction does within Coulomb's.

use super::{FeasiblePath, Way};
use crate::constraint::contact::{ContactKey, ContactLaw, Kinematics};
use crate::math::{Vec2, perp};
use crate::path::{NearPair, Target};

/// Passes within a step that have a force slide off at a vertex before its two sides are held together there.
const SLIDES: usize = 2;

/// Marks the names of meetings in contact keys.
const MEETING: u32 = 1 << 30;

/// Two vertices at which forces have slid off within the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The way, and the vertices of its first and second member.
    way: usize,
    vertices: [usize; 2],
    /// Passes in which a force has slid off here, and the last of them.
    slides: usize,
    last: usize,
    /// Normals and directions of force on the first member, the two that are farthest from each other; of length one.
    normals: [Vec2; 2],
    forces: [Vec2; 2],
    /// Whether the vertices are held together.
    is_held: bool,
}

impl FeasiblePath {
    /// Notes that a contact with this row and force has slid off at the base, in a pass of the step.
    pub(in crate::kkt) fn note_slide(
        &mut self,
        near: &NearPair,
        row: &Kinematics,
        multiplier: [f64; 2],
        pass: usize,
    ) {
        let Some(met) = self.vertex_beyond(near) else {
            return;
        };
        let is_first = self.members_of(near)[0] == self.ways[near.pair].members[0];
        let (vertices, sign) = if is_first {
            ([near.point, met], 1.0)
        } else {
            ([met, near.point], -1.0)
        };
        let normal = sign * row.normal;
        let force = multiplier[0] * normal + multiplier[1] * sign * row.tangent();
        if force.norm() <= 0.0 {
            return;
        }
        let force = force.normalize();
        let other = sign * self.other_normal(near, met, row.normal);
        // The same share of friction on the other side.
        let turned = force.dot(&normal) * other + force.dot(&perp(normal)) * perp(other);
        let meetings = &mut self.meetings;
        let known = meetings
            .iter_mut()
            .find(|one| one.way == near.pair && one.vertices == vertices);
        match known {
            Some(meeting) => {
                meeting.slide([normal, other], [force, turned], pass);
            }
            None => meetings.push(Meeting {
                way: near.pair,
                vertices,
                slides: 1,
                last: pass,
                normals: [normal, other],
                forces: [force, turned],
                is_held: false,
            }),
        }
    }

    /// The normal on the other side of a vertex that is slid over, on the side of this normal; this normal where there is none.
    fn other_normal(&self, near: &NearPair, vertex: usize, normal: Vec2) -> Vec2 {
        let is_other = |edge: &&u32| near.target != Target::Edge(**edge as usize);
        let Some(&edge) = self.surfaces.edges_at(vertex).iter().find(is_other) else {
            return normal;
        };
        let [from, to] = self.surfaces.ends(edge as usize);
        let across = perp(to - from).normalize();
        if across.dot(&normal) < 0.0 {
            -across
        } else {
            across
        }
    }

    /// The vertex of the target beyond which a point now is.
    fn vertex_beyond(&self, near: &NearPair) -> Option<usize> {
        let edge = match near.target {
            Target::Vertex(vertex) => return Some(vertex),
            Target::Edge(edge) => edge,
        };
        let point = self.surfaces.points()[near.point];
        let [from, to] = self.surfaces.ends(edge);
        let along = (point - from).dot(&(to - from));
        let vertices = self.surfaces.edges()[edge].map(|end| end as usize);
        if along <= 0.0 {
            Some(vertices[0])
        } else if along >= (to - from).norm_squared() {
            Some(vertices[1])
        } else {
            None
        }
    }

    /// Whether a near pair is one of those that take turns where vertices are held together.
    pub(in crate::kkt) fn is_at_meeting(&self, near: &NearPair) -> bool {
        let mut held = self
            .meetings
            .iter()
            .filter(|one| one.is_held && one.way == near.pair);
        held.any(|meeting| {
            let other = match meeting.vertices {
                [one, other] if one == near.point => other,
                [one, other] if other == near.point => one,
                _ => return false,
            };
            match near.target {
                Target::Vertex(vertex) => vertex == other,
                Target::Edge(edge) => self.surfaces.edges_at(other).contains(&(edge as u32)),
            }
        })
    }

    /// Number of meetings of the step.
    pub(in crate::kkt) fn n_meetings(&self) -> usize {
        self.meetings.len()
    }

    /// A meeting whose vertices are held together: as a near pair, its row at the base with the motion of the first vertex along the
    /// surface, its law and its name.
    pub(in crate::kkt) fn held(
        &self,
        index: usize,
    ) -> Option<(NearPair, Kinematics, Vec2, ContactLaw, ContactKey)> {
        let meeting = &self.meetings[index];
        if !meeting.is_held {
            return None;
        }
        let [point, vertex] = meeting.vertices;
        let outward = (meeting.normals[0] + meeting.normals[1]).normalize();
        let normal = (meeting.forces[0] + meeting.forces[1]).normalize();
        let way: &Way = &self.ways[meeting.way];
        let arm = self.surfaces.points()[point] - self.surfaces.points()[vertex];
        let near = NearPair {
            pair: meeting.way,
            point,
            target: Target::Vertex(vertex),
            xi: 0.0,
            normal: outward,
            distance: arm.dot(&outward),
            key: 0,
        };
        let mut row = self.kinematics(&near);
        // The place where the vertex comes to lie.
        let away = arm - (near.distance - row.gap) * outward;
        row.normal = normal;
        row.gap = normal.dot(&away);
        let [cos, sin] = [
            normal.dot(&meeting.forces[0]),
            normal.perp(&meeting.forces[0]).abs(),
        ];
        let law = ContactLaw {
            friction: sin / cos,
            ..way.law
        };
        let mut key = self.key(&near);
        key.part |= MEETING;
        Some((near, row, away, law, key))
    }

    /// Lets the vertices of a meeting go.
    pub(in crate::kkt) fn let_go(&mut self, near: &NearPair) {
        let Target::Vertex(vertex) = near.target else {
            return;
        };
        let held = self.meetings.iter_mut();
        for meeting in held.filter(|one| one.vertices == [near.point, vertex]) {
            (meeting.is_held, meeting.slides) = (false, 0);
        }
    }
}

impl Meeting {
    /// Notes one more slide, with normal and force on this side and on the other side of the vertex that is slid over.
    fn slide(&mut self, normals: [Vec2; 2], forces: [Vec2; 2], pass: usize) {
        self.slides += usize::from(pass > self.last);
        self.last = pass;
        // The side before, unless it is the same.
        let is_same = (self.normals[0] - normals[0]).norm() <= SAME;
        let before = if is_same {
            (normals[1], forces[1])
        } else {
            (self.normals[0], self.forces[0])
        };
        (self.normals, self.forces) = ([normals[0], before.0], [forces[0], before.1]);
        let is_sharp = |[a, b]: [Vec2; 2]| a.dot(&b) <= LEAST_COSINE;
        self.is_held = self.slides >= SLIDES && !is_sharp(self.normals) && !is_sharp(self.forces);
    }
}

/// Turn below which two normals are the same side (rad).
const SAME: f64 = 1e-6;

/// Cosine of the widest angle between two forces whose mean has a direction to speak of.
const LEAST_COSINE: f64 = -0.9;
