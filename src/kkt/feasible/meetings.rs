//! Vertices that meet: where contacts slide over a vertex and back again, pass after pass.
//!
//! Over an edge the force has the direction of its normal. At a vertex between two edges it may have any direction between those of
//! both, and where neither has its solution over its own edge, this is the one there is: the two vertices stay together, and the force
//! is what holds them. That is one row, with the direction half way, that sticks to the vertex within a cone that reaches the forces
//! on either side, as one that sticks by friction does within Coulomb's.

use super::{FeasiblePath, Way};
use crate::constraint::contact::{ContactKey, ContactLaw, Kinematics};
use crate::math::{Vec2, judged::Judged, perp, rounding};
use crate::path::{NearPair, Target};
use crate::system::Point;

/// Passes within a step that have a force slide off at a vertex before its two sides are held together there.
const SLIDES: usize = 2;

/// Times within a step that vertices are held together.
const MOST_HELD: usize = 2;

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
    /// Normals and directions of force on the first member, of the side that the force slid off last and of the one it came to; of length one.
    normals: [Vec2; 2],
    forces: [Vec2; 2],
    /// Whether the vertices are held together, and how often they were and need not be.
    is_held: bool,
    n_over: usize,
}

impl FeasiblePath {
    /// Notes that the force of a contact has slid from one near pair to another, or off a corner, with the rows of both (or twice the same
    /// one), in a pass of the step.
    pub(in crate::kkt) fn note_slide(
        &mut self,
        from: &NearPair,
        to: Option<&NearPair>,
        rows: [&Kinematics; 2],
        multiplier: [f64; 2],
        pass: usize,
    ) {
        let Some([point, met]) = self.slid_over(from) else {
            return;
        };
        // Of one surface, the lower vertex stands for the first member.
        let is_first = if from.pair >= self.first_own() {
            point < met
        } else {
            self.members_of(from)[0] == self.ways[from.pair].members[0]
        };
        let (vertices, sign) = if is_first {
            ([point, met], 1.0)
        } else {
            ([met, point], -1.0)
        };
        let row = rows[0];
        let own = sign * row.normal;
        let next = match to {
            Some(to) if to.point == from.point => sign * rows[1].normal,
            Some(_) => -sign * rows[1].normal,
            None => sign * self.other_normal(from, met, row.normal),
        };
        let force = multiplier[0] * own + multiplier[1] * sign * row.tangent();
        if force.norm() <= 0.0 {
            return;
        }
        let force = force.normalize();
        // The same share of friction on the other side.
        let turned = force.dot(&own) * next + force.dot(&perp(own)) * perp(next);
        let (normals, forces) = ([own, next], [force, turned]);
        let is_between = self.are_extreme(vertices, own + next);
        let known = self
            .meetings
            .iter_mut()
            .find(|one| one.way == from.pair && one.vertices == vertices);
        let meeting = match known {
            Some(meeting) => meeting,
            None => {
                self.meetings.push(Meeting {
                    way: from.pair,
                    vertices,
                    slides: 0,
                    last: 0,
                    normals,
                    forces,
                    is_held: false,
                    n_over: 0,
                });
                let Some(meeting) = self.meetings.last_mut() else {
                    return;
                };
                meeting
            }
        };
        meeting.slides += usize::from(pass > meeting.last);
        (meeting.last, meeting.normals, meeting.forces) = (pass, normals, forces);
        let is_wide = |[a, b]: [Vec2; 2]| a.dot(&b) <= LEAST_COSINE;
        let turns = (normals[0] - normals[1]).norm() > SAME;
        meeting.is_held = turns
            && is_between
            && meeting.n_over < MOST_HELD
            && meeting.slides >= SLIDES
            && !is_wide(normals)
            && !is_wide(forces);
    }

    /// Whether two vertices are where their surfaces reach farthest towards each other, or nearly so, the first one against this direction, or
    /// where a flexible one draws back farthest: a corner in a dent. Elsewhere one of them lies over an edge of the other, and forces do not
    /// pass from vertex to vertex.
    fn are_extreme(&self, vertices: [usize; 2], along: Vec2) -> bool {
        let is_extreme = |vertex: usize, along: Vec2| {
            let leans = |edge: &u32| {
                let ends = self.surfaces.edges()[*edge as usize].map(|end| end as usize);
                let other = ends[usize::from(ends[0] == vertex)];
                let run = self.surfaces.points()[other] - self.surfaces.points()[vertex];
                run.dot(&along) / (run.norm() * along.norm())
            };
            let edges = self.surfaces.edges_at(vertex);
            let is_flex = matches!(self.points[vertex].point, Point::Node(_));
            edges.iter().map(leans).all(|lean| lean >= -LEANING)
                || is_flex && edges.iter().map(leans).all(|lean| lean <= SAME)
        };
        is_extreme(vertices[0], along) && is_extreme(vertices[1], -along)
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

    /// The vertices of the point and of the target that a near pair has come to: where another near pair takes over.
    pub(in crate::kkt) fn slid_over(&self, near: &NearPair) -> Option<[usize; 2]> {
        Some([near.point, self.vertex_beyond(near)?])
    }

    /// Whether a near pair is one of two vertices, or of one of them and an edge of the other.
    pub(in crate::kkt) fn is_at(&self, near: &NearPair, [one, other]: [usize; 2]) -> bool {
        let met = match near.point {
            point if point == one => other,
            point if point == other => one,
            _ => return false,
        };
        match near.target {
            Target::Vertex(vertex) => vertex == met,
            Target::Edge(edge) => self.surfaces.edges_at(met).contains(&(edge as u32)),
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
        held.any(|meeting| self.is_at(near, meeting.vertices))
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
        row.gap = normal.dot(&away).min(self.gap_at(meeting));
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

    /// The gap of a meeting where one of its vertices lies over an edge of the other; without bound where none does (m).
    ///
    /// Edges lean as bodies turn, and a vertex at its place beside another one may lie in the surface.
    fn gap_at(&self, meeting: &Meeting) -> f64 {
        let near = self.near.iter().filter(|near| {
            near.pair == meeting.way
                && self.is_at(near, meeting.vertices)
                && self.vertex_beyond(near).is_none()
        });
        near.map(|near| self.kinematics(near).gap)
            .fold(f64::INFINITY, f64::min)
    }

    /// Lets the vertices of a meeting go.
    pub(in crate::kkt) fn let_go(&mut self, near: &NearPair) {
        let Target::Vertex(vertex) = near.target else {
            return;
        };
        let held = self.meetings.iter_mut();
        for meeting in held.filter(|one| one.vertices == [near.point, vertex]) {
            (meeting.is_held, meeting.slides) = (false, 0);
            meeting.n_over += 1;
        }
    }
}

/// Turn below which two normals are the same side (rad).
const SAME: f64 = rounding::SINGLE;

/// Sine of the angle by which an edge may lean over a direction in which its end reaches farthest: bodies turn from pass to pass, and a corner that
/// lies over an edge of the other body leans by half a right angle.
const LEANING: Judged = Judged::new("kkt::LEANING", 0.4);

/// Cosine of the widest angle between two forces whose mean has a direction to speak of.
const LEAST_COSINE: Judged = Judged::new("kkt::LEAST_COSINE", -0.9);

#[cfg(test)]
mod tests;
