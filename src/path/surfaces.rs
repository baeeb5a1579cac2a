//! Surfaces as data: points, the edges between them, and the members they belong to.

use super::bounds::Bounds;
use crate::math::Vec2;
use std::ops::Range;

/// How many neighbouring points or edges share one box of the search: with 16 a chain of 2,000 edges is 125 boxes, and a
/// small body one. The result does not depend on it, and its cost hardly does between 8 and 32.
pub(super) const CHUNK: usize = 16;

/// How the points of a member move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// Not at all.
    Still,
    /// Together: a centre moves along a line and everything turns about it at a constant rate.
    Rigid,
    /// Each along a line of its own.
    Flexible,
}

/// A part of the surfaces that belongs to one body.
#[derive(Clone, Debug)]
pub struct Member {
    /// How its points move.
    pub kind: MotionKind,
    /// Whether its edges bound material, which lies on their left: counter-clockwise loops, clockwise ones round holes.
    pub solid: bool,
    /// Its points.
    pub points: Range<usize>,
    /// Its edges. A point without edges has one of length zero, so that a ball needs no case of its own.
    pub edges: Range<usize>,
    /// Where its connected parts stand in the list of their first points.
    pub(super) parts: Range<usize>,
    /// Its boxes, in those of the still or of the moving members: the whole, chunks of points, chunks of edges.
    pub(super) boxes: Range<usize>,
}

impl Member {
    pub(super) fn n_point_boxes(&self) -> usize {
        self.points.len().div_ceil(CHUNK)
    }
}

/// Points, edges and members; filled anew whenever bodies come or go, with kept buffers.
///
/// Members that stay (terrain) are added first and kept with [`truncate`](Self::truncate): their boxes are made only once.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    points: Vec<Vec2>,
    edges: Vec<[u32; 2]>,
    members: Vec<Member>,
    /// Where the edges of each point begin in `adjacent`; they end where those of the next begin.
    adjacent_from: Vec<u32>,
    adjacent: Vec<u32>,
    /// One point of each connected part of a member.
    parts: Vec<u32>,
    pub(super) still_boxes: Vec<Bounds>,
    pub(super) n_moving_boxes: usize,
    /// Scratch of [`Self::add`]: of each point of a member, another of the same connected part.
    leader: Vec<u32>,
}

impl Surfaces {
    /// No surfaces.
    #[cfg(test)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Removes all members but the first ones.
    pub fn truncate(&mut self, n_members: usize) {
        let Some(first) = self.members.get(n_members) else {
            return;
        };
        let (points, edges, parts) = (first.points.start, first.edges.start, first.parts.start);
        let n_adjacent = self.adjacent_from[points] as usize;
        self.members.truncate(n_members);
        self.points.truncate(points);
        self.edges.truncate(edges);
        self.parts.truncate(parts);
        self.adjacent_from.truncate(points);
        self.adjacent.truncate(n_adjacent);
        let boxes_end = |kind: fn(MotionKind) -> bool, members: &[Member]| {
            let last = members.iter().rev().find(|member| kind(member.kind));
            last.map_or(0, |member| member.boxes.end)
        };
        let n_still = boxes_end(|kind| kind == MotionKind::Still, &self.members);
        self.still_boxes.truncate(n_still);
        self.n_moving_boxes = boxes_end(|kind| kind != MotionKind::Still, &self.members);
    }

    /// Adds a member and returns its index.
    ///
    /// - `points`: where they are (m).
    /// - `edges`: start and end, counted within `points`.
    ///
    /// # Panics
    /// If there is no point, or an edge ends beyond the points.
    pub fn add(
        &mut self,
        kind: MotionKind,
        solid: bool,
        points: &[Vec2],
        edges: impl IntoIterator<Item = [u32; 2]>,
    ) -> usize {
        assert!(!points.is_empty(), "a member needs at least one point");
        let (first_point, first_edge) = (self.points.len(), self.edges.len());
        self.points.extend_from_slice(points);
        for edge in edges {
            assert!(
                edge.iter().all(|&end| (end as usize) < points.len()),
                "edge {edge:?} of a member with {} points: number its ends from 0",
                points.len()
            );
            self.edges.push(edge.map(|end| end + first_point as u32));
        }
        self.close_lone_points(first_point, first_edge);
        self.list_adjacent(first_point, first_edge);
        let first_part = self.parts.len();
        self.list_parts(first_point, first_edge);
        let member = Member {
            kind,
            solid,
            points: first_point..self.points.len(),
            edges: first_edge..self.edges.len(),
            parts: first_part..self.parts.len(),
            boxes: self.reserve_boxes(kind, first_point, first_edge),
        };
        self.members.push(member);
        let index = self.members.len() - 1;
        if kind == MotionKind::Still {
            self.bound_still(index);
        }
        index
    }

    /// Adds a chain of edges from each point to the next, closed or open, and returns its index. One point is a ball, two of
    /// an open chain a capsule or a segment.
    ///
    /// # Panics
    /// If there is no point.
    #[cfg(test)]
    pub fn add_chain(
        &mut self,
        kind: MotionKind,
        solid: bool,
        points: &[Vec2],
        closed: bool,
    ) -> usize {
        let n = points.len() as u32;
        let n_edges = if closed { n } else { n.saturating_sub(1) };
        let n_edges = if n > 1 { n_edges } else { 0 };
        self.add(kind, solid, points, (0..n_edges).map(|k| [k, (k + 1) % n]))
    }

    /// All members.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Where all points are (m).
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }

    /// The points of a moving member (m), to be placed anew.
    ///
    /// # Panics
    /// If the member is still: it has its boxes already.
    pub fn points_mut(&mut self, member: usize) -> &mut [Vec2] {
        let member = &self.members[member];
        assert!(
            member.kind != MotionKind::Still,
            "a still member stays where it was added"
        );
        &mut self.points[member.points.clone()]
    }

    /// Puts all points, still ones included, where they were.
    pub fn set_points(&mut self, points: &[Vec2]) {
        self.points.copy_from_slice(points);
    }

    /// Start and end of all edges, as points.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The edges that meet in a point: one at least.
    #[inline]
    pub fn edges_at(&self, point: usize) -> &[u32] {
        let from = self.adjacent_from[point] as usize;
        let to = self
            .adjacent_from
            .get(point + 1)
            .map_or(self.adjacent.len(), |&to| to as usize);
        &self.adjacent[from..to]
    }

    /// The ends of an edge (m).
    #[inline]
    pub fn ends(&self, edge: usize) -> [Vec2; 2] {
        self.edges[edge].map(|end| self.points[end as usize])
    }

    /// One point of each connected part of a member.
    pub(super) fn parts(&self, member: usize) -> &[u32] {
        &self.parts[self.members[member].parts.clone()]
    }

    fn close_lone_points(&mut self, first_point: usize, first_edge: usize) {
        let n = self.points.len() - first_point;
        self.leader.clear();
        self.leader.resize(n, 0);
        for edge in &self.edges[first_edge..] {
            edge.iter()
                .for_each(|&end| self.leader[end as usize - first_point] = 1);
        }
        let lone = self.leader.iter().enumerate().filter(|&(_, &met)| met == 0);
        self.edges
            .extend(lone.map(|(point, _)| [(first_point + point) as u32; 2]));
    }

    fn list_adjacent(&mut self, first_point: usize, first_edge: usize) {
        let n = self.points.len() - first_point;
        let begin = self.adjacent.len() as u32;
        // Counts first, then where each point's list begins, then the lists.
        self.leader.clear();
        self.leader.resize(n + 1, 0);
        let ends_of = |edge: &[u32; 2]| if edge[0] == edge[1] { 1 } else { 2 };
        for edge in &self.edges[first_edge..] {
            for &end in &edge[..ends_of(edge)] {
                self.leader[end as usize - first_point + 1] += 1;
            }
        }
        for point in 0..n {
            self.leader[point + 1] += self.leader[point];
        }
        self.adjacent_from
            .extend(self.leader[..n].iter().map(|from| begin + from));
        self.adjacent.resize((begin + self.leader[n]) as usize, 0);
        for (index, edge) in self.edges.iter().enumerate().skip(first_edge) {
            for &end in &edge[..ends_of(edge)] {
                let slot = &mut self.leader[end as usize - first_point];
                self.adjacent[(begin + *slot) as usize] = index as u32;
                *slot += 1;
            }
        }
    }

    /// Finds the connected parts by union–find (the smaller index leads).
    fn list_parts(&mut self, first_point: usize, first_edge: usize) {
        fn lead(leader: &mut [u32], mut point: u32) -> u32 {
            while leader[point as usize] != point {
                leader[point as usize] = leader[leader[point as usize] as usize];
                point = leader[point as usize];
            }
            point
        }
        let n = self.points.len() - first_point;
        self.leader.clear();
        self.leader.extend(0..n as u32);
        for edge in &self.edges[first_edge..] {
            let [a, b] = edge.map(|end| lead(&mut self.leader, end - first_point as u32));
            self.leader[a.max(b) as usize] = a.min(b);
        }
        let leads = self
            .leader
            .iter()
            .enumerate()
            .filter(|&(point, &lead)| point == lead as usize);
        self.parts
            .extend(leads.map(|(point, _)| (first_point + point) as u32));
    }

    fn reserve_boxes(
        &mut self,
        kind: MotionKind,
        first_point: usize,
        first_edge: usize,
    ) -> Range<usize> {
        let chunks = |n: usize| n.div_ceil(CHUNK);
        let n = 1 + chunks(self.points.len() - first_point) + chunks(self.edges.len() - first_edge);
        if kind == MotionKind::Still {
            let from = self.still_boxes.len();
            self.still_boxes.resize(from + n, Bounds::EMPTY);
            from..from + n
        } else {
            let from = self.n_moving_boxes;
            self.n_moving_boxes += n;
            from..from + n
        }
    }

    fn bound_still(&mut self, index: usize) {
        let mut boxes = std::mem::take(&mut self.still_boxes);
        let member = &self.members[index];
        super::search::Extent::of(self).bound_member(index, &mut boxes[member.boxes.clone()]);
        self.still_boxes = boxes;
    }
}

#[cfg(test)]
mod tests;
