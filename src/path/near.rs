//! The near pairs of a placement: what the rows of contact are made of.
//!
//! A row is a foot inside an edge, or a vertex against a vertex where each lies in the other's cone, asked of all the edges
//! that meet in them. Elsewhere another pair of the two chains is closer, and has a row of its own. For the same reason the bottom of a
//! notch that keeps its shape has no rows.

use super::distance::{Beside, Foot, direction, inner_foot};
use super::search::Extent;
use super::{MemberPair, MotionKind, Path, Surfaces};
use crate::math::{Vec2, cross, mix, perp};

/// Sine of the turn between two edges below which they may be meant as one (-): joints of a floor that is given in single precision.
const FLAT: f64 = 1e-3;

/// What a point is near to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    /// The inside of an edge.
    Edge(usize),
    /// A vertex, as a point.
    Vertex(usize),
}

/// A point near an edge or a vertex of another member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPair {
    /// Which of the member pairs it belongs to.
    pub pair: usize,
    /// The point.
    pub point: usize,
    /// What it is near to.
    pub target: Target,
    /// Where on the edge, in (0, 1), or on its line beyond a notch; 0 on a vertex.
    pub xi: f64,
    /// From the target to the point, of length one; zero where the distance is.
    pub normal: Vec2,
    /// Distance of the cores (m).
    pub distance: f64,
    /// The same from step to step as long as the pair has its name and its members their points and edges in the same
    /// order; different for different rows but for chance (1 in 10⁹ with 10⁵ rows).
    pub key: u64,
}

impl Path {
    /// Writes all near pairs within `closing + reach` of each other, in the order of the member pairs, then of points and
    /// targets.
    ///
    /// - `reach`: how far beyond closing (m).
    /// - `rows`: overwritten.
    pub fn near(
        &mut self,
        surfaces: &Surfaces,
        pairs: &[MemberPair],
        reach: f64,
        rows: &mut Vec<NearPair>,
    ) {
        rows.clear();
        let extent = Extent::of(surfaces);
        self.search.refresh(extent);
        for (index, pair) in pairs.iter().enumerate() {
            if pair.is_asleep {
                continue;
            }
            let first = rows.len();
            let within = pair.closing + reach;
            // A vertex against a vertex is found from both sides; the first tells it.
            for (side, members) in [[pair.one, pair.other], [pair.other, pair.one]]
                .into_iter()
                .enumerate()
            {
                if side == 1 && pair.one == pair.other {
                    break;
                }
                self.search
                    .points_and_edges(extent, members, within, |point, edge| {
                        let asked = Asked {
                            surfaces,
                            pair,
                            index,
                            side,
                            within,
                        };
                        asked.list(point, edge, rows);
                    });
            }
            rows[first..].sort_unstable_by_key(|row| (row.point, row.target));
        }
    }
}

/// Adds the rows of the point of a near pair on the lines of the edges that go on from the ends of its edge, where they rise on its side and it has
/// no foot inside them.
///
/// Between such edges, and nowhere else, what keeps off the lines keeps off the edges: a corner that the point stands for may touch one that
/// the point is beyond.
pub fn add_beyond(
    surfaces: &Surfaces,
    pairs: &[MemberPair],
    near: &NearPair,
    rows: &mut Vec<NearPair>,
) {
    let pair = &pairs[near.pair];
    let owns = surfaces.members()[pair.one].points.contains(&near.point);
    let asked = Asked {
        surfaces,
        pair,
        index: near.pair,
        side: usize::from(!owns),
        within: f64::INFINITY,
    };
    if let Target::Edge(edge) = near.target
        && pair.one != pair.other
    {
        asked.list_beyond(near, edge, rows);
    }
}

/// A member pair being asked, from one side.
struct Asked<'a> {
    surfaces: &'a Surfaces,
    pair: &'a MemberPair,
    index: usize,
    side: usize,
    within: f64,
}

impl Asked<'_> {
    fn list(&self, point: usize, edge: usize, rows: &mut Vec<NearPair>) {
        let surfaces = self.surfaces;
        let vertices = surfaces.edges()[edge];
        let own = self.pair.one == self.pair.other;
        if own && vertices.contains(&(point as u32)) {
            self.list_ends(point, edge, rows);
            return;
        }
        let (position, ends) = (surfaces.points()[point], surfaces.ends(edge));
        let beside = Beside::of(position, ends);
        if beside.is_inner() {
            let foot = inner_foot(position, ends, beside.inside);
            if !self.is_notch(point, foot.normal) {
                self.push(point, Target::Edge(edge), foot, rows);
            }
            return;
        }
        if self.side == 1 {
            return;
        }
        for (end, vertex) in vertices
            .map(|vertex| vertex as usize)
            .into_iter()
            .enumerate()
        {
            // Once for each vertex: from the first of its edges, and within one member from the smaller index.
            let is_first = surfaces.edges_at(vertex)[0] as usize == edge
                && !(end == 1 && vertices[0] == vertices[1]);
            if !is_first || !beside.is_beyond(end) || own && vertex <= point {
                continue;
            }
            self.list_vertices(point, vertex, None, rows);
        }
    }

    /// Lists the other end of an edge of the same member that ends in the point, which is as any other vertex but for that edge.
    fn list_ends(&self, point: usize, edge: usize, rows: &mut Vec<NearPair>) {
        let [from, to] = self.surfaces.edges()[edge].map(|end| end as usize);
        if from.min(to) == point && from != to {
            self.list_vertices(point, from.max(to), Some(edge), rows);
        }
    }

    /// Lists two vertices if each lies in the other's cone, an edge between them not asked.
    fn list_vertices(
        &self,
        point: usize,
        vertex: usize,
        between: Option<usize>,
        rows: &mut Vec<NearPair>,
    ) {
        let [position, met] = [point, vertex].map(|one| self.surfaces.points()[one]);
        if self.in_cone(position, vertex, between) && self.in_cone(met, point, between) {
            let (normal, distance) = direction(met, position);
            let foot = Foot {
                xi: 0.0,
                normal,
                distance,
            };
            self.push(point, Target::Vertex(vertex), foot, rows);
        }
    }

    fn in_cone(&self, position: Vec2, vertex: usize, between: Option<usize>) -> bool {
        let asked = self.surfaces.edges_at(vertex).iter();
        let mut asked = asked.filter(|&&edge| between != Some(edge as usize));
        asked.all(|&edge| {
            let end = usize::from(self.surfaces.edges()[edge as usize][0] as usize != vertex);
            Beside::of(position, self.surfaces.ends(edge as usize)).is_beyond(end)
        })
    }

    fn list_beyond(&self, near: &NearPair, edge: usize, rows: &mut Vec<NearPair>) {
        let surfaces = self.surfaces;
        let points = surfaces.points();
        let position = points[near.point];
        for vertex in surfaces.edges()[edge].map(|end| end as usize) {
            let own = self.run(edge, vertex);
            for &next in surfaces.edges_at(vertex) {
                let next = next as usize;
                let run = self.run(next, vertex);
                let rises = run.dot(&near.normal) > FLAT * run.norm();
                let end = usize::from(surfaces.edges()[next][0] as usize != vertex);
                let is_beyond = Beside::of(position, surfaces.ends(next)).is_beyond(end);
                if next == edge || !rises || !is_beyond {
                    continue;
                }
                let [from, to] = surfaces.ends(next);
                let across = perp(to - from).normalize();
                let normal = across * across.dot(&own).signum();
                let distance = normal.dot(&(position - points[vertex]));
                if distance > 0.0 {
                    let along = to - from;
                    let foot = Foot {
                        xi: along.dot(&(position - from)) / along.norm_squared(),
                        normal,
                        distance,
                    };
                    self.push(near.point, Target::Edge(next), foot, rows);
                }
            }
        }
    }

    /// From a vertex to the other end of an edge.
    fn run(&self, edge: usize, vertex: usize) -> Vec2 {
        let [from, to] = self.surfaces.edges()[edge].map(|end| end as usize);
        let far = if from == vertex { to } else { from };
        self.surfaces.points()[far] - self.surfaces.points()[vertex]
    }

    /// Whether a vertex of a surface that keeps its shape lies between its two edges as seen from where this normal comes from. Both rise
    /// towards what is there, and their own rows, or those of its ends, are closer wherever it goes.
    fn is_notch(&self, vertex: usize, normal: Vec2) -> bool {
        let surfaces = self.surfaces;
        let [one, other] = *surfaces.edges_at(vertex) else {
            return false;
        };
        let member = [self.pair.one, self.pair.other][self.side];
        if surfaces.members()[member].kind == MotionKind::Flexible {
            return false;
        }
        let [one, other] = [one, other].map(|edge| self.run(edge as usize, vertex));
        // Between two runs of less than half a turn.
        let between = [cross(one, -normal), cross(-normal, other)];
        let turn = cross(one, other);
        let is_flat = turn.abs() <= FLAT * one.norm() * other.norm();
        !is_flat && between.iter().all(|part| part * turn > 0.0)
    }

    fn push(&self, point: usize, target: Target, foot: Foot, rows: &mut Vec<NearPair>) {
        if foot.distance > self.within {
            return;
        }
        let Foot {
            xi,
            normal,
            distance,
        } = foot;
        let key = self.key(point, target);
        rows.push(NearPair {
            pair: self.index,
            point,
            target,
            xi,
            normal,
            distance,
            key,
        });
    }

    fn key(&self, point: usize, target: Target) -> u64 {
        let members = self.surfaces.members();
        let (of, against) = if self.side == 0 {
            (self.pair.one, self.pair.other)
        } else {
            (self.pair.other, self.pair.one)
        };
        let point = (point - members[of].points.start) as u64;
        let (sort, target) = match target {
            Target::Edge(edge) => (0, edge - members[against].edges.start),
            Target::Vertex(vertex) => (1, vertex - members[against].points.start),
        };
        let words = [2 * self.side as u64 + sort, point, target as u64];
        words.into_iter().fold(mix(0, self.pair.name), mix)
    }
}

#[cfg(test)]
mod beyond_tests;
#[cfg(test)]
mod own_tests;
#[cfg(test)]
mod tests;
