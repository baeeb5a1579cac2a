//! Closed loops of edges with what they enclose on their left: surfaces of bodies, and lines, gone along both ways.

use crate::math::{Vec2, angle_between, cross, perp, rotation, rounding};
use std::f64::consts::{PI, TAU};

/// Largest turn from one edge of a rounding to the next (rad): what lies between them and the round by no more than .02 of its radius is left to
/// contact, which any side of it leads out of.
const FACET: f64 = PI / 8.0;

/// Edges that run from one to the next and come back to where they began, with what they enclose on their left.
#[derive(Clone, Debug, Default)]
pub struct Loops {
    starts: Vec<Vec2>,
    next: Vec<usize>,
    names: Vec<u32>,
}

impl Loops {
    /// Edges by where they start (m), which edge follows each, and the names of the points where they start.
    pub fn new(starts: Vec<Vec2>, next: Vec<usize>, names: Vec<u32>) -> Self {
        Self {
            starts,
            next,
            names,
        }
    }

    /// A polygon, counter-clockwise.
    pub fn polygon(vertices: &[Vec2]) -> Self {
        let n = vertices.len();
        let next = (0..n).map(|edge| (edge + 1) % n).collect();
        Self::new(vertices.to_vec(), next, (0..n as u32).collect())
    }

    /// A convex core, counter-clockwise: a polygon, a segment or a point, rounded by a radius (m). Arcs are drawn by edges within them.
    pub fn rounded(core: &[Vec2], radius: f64) -> Self {
        let n = core.len();
        let outward = |from: usize, to: usize| -perp(core[to] - core[from]).normalize();
        let mut vertices = Vec::with_capacity(Self::n_rounded(n));
        for (at, &centre) in core.iter().enumerate() {
            let (first, angle) = if n == 1 {
                (Vec2::x(), TAU - FACET)
            } else {
                let [before, after] = [(at + n - 1) % n, (at + 1) % n];
                let [first, last] = [outward(before, at), outward(at, after)];
                // Both edges of a segment are one: it is turned round at its ends.
                let angle = if n == 2 {
                    PI
                } else {
                    angle_between(first, last)
                };
                (first, angle)
            };
            let n_edges = (angle / FACET - rounding::SHARE).ceil().max(0.0) as usize;
            for step in 0..=n_edges {
                let turned = rotation(angle * step as f64 / n_edges.max(1) as f64) * first;
                vertices.push(centre + radius * turned);
            }
        }
        Self::polygon(&vertices)
    }

    /// Number of points that a core of `n` vertices is drawn with at most if it is rounded.
    pub fn n_rounded(n: usize) -> usize {
        2 * n + (TAU / FACET) as usize
    }

    /// The rim of a solid, by edges with the solid on their left.
    pub fn rim(points: &[Vec2], edges: &[[u32; 2]]) -> Option<Self> {
        Self::linked(points, edges)
    }

    /// Lines without thickness, gone along both ways.
    pub fn lines(points: &[Vec2], edges: &[[u32; 2]]) -> Option<Self> {
        let both: Vec<[u32; 2]> = edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        Self::linked(points, &both)
    }

    /// Links edges to loops around the free space on their right; `None` if some end nowhere.
    fn linked(points: &[Vec2], edges: &[[u32; 2]]) -> Option<Self> {
        let mut leaving: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
        for (edge, [from, _]) in edges.iter().enumerate() {
            leaving[*from as usize].push(edge);
        }
        let place = |name: u32| points[name as usize];
        let mut next = Vec::with_capacity(edges.len());
        let mut is_taken = vec![false; edges.len()];
        for [from, to] in edges {
            let back = place(*from) - place(*to);
            // The first to the left of the way back: what lies between is free.
            let first = leaving[*to as usize]
                .iter()
                .copied()
                .min_by(|&one, &other| {
                    let turns =
                        [one, other].map(|edge| turn(back, place(edges[edge][1]) - place(*to)));
                    turns[0].total_cmp(&turns[1])
                })?;
            if std::mem::replace(&mut is_taken[first], true) {
                return None;
            }
            next.push(first);
        }
        let starts = edges.iter().map(|[from, _]| place(*from)).collect();
        let names = edges.iter().map(|[from, _]| *from).collect();
        Some(Self::new(starts, next, names))
    }

    /// Number of edges.
    pub fn n_edges(&self) -> usize {
        self.starts.len()
    }

    /// Where an edge starts and ends (m).
    #[inline]
    pub fn edge(&self, edge: usize) -> [Vec2; 2] {
        [self.starts[edge], self.starts[self.next[edge]]]
    }

    /// The edge that begins where one ends.
    #[inline]
    pub fn next(&self, edge: usize) -> usize {
        self.next[edge]
    }

    /// Name of the point where an edge starts.
    pub fn name(&self, edge: usize) -> u32 {
        self.names[edge]
    }

    /// Where an edge starts (m).
    pub fn start(&self, edge: usize) -> Vec2 {
        self.starts[edge]
    }

    /// Lower and upper corner of their box (m).
    pub fn bounds(&self) -> [Vec2; 2] {
        let none = [Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)];
        let starts = self.starts.iter();
        starts.fold(none, |[low, high], place| [low.inf(place), high.sup(place)])
    }

    /// Length of all edges (m).
    pub fn length(&self) -> f64 {
        let edges = (0..self.n_edges()).map(|edge| self.edge(edge));
        edges.map(|[from, to]| (to - from).norm()).sum()
    }

    /// Whether a point is in what is enclosed.
    pub fn contain(&self, point: Vec2) -> bool {
        let crossed = (0..self.n_edges()).filter(|&edge| {
            let [a, b] = self.edge(edge);
            let side = (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
            (a.y <= point.y) != (b.y <= point.y) && (side > 0.0) == (b.y > a.y)
        });
        crossed.count() % 2 == 1
    }
}

/// Turn from one direction to another, counter-clockwise: grows with the angle, 0 for none, at most 4; a whole turn for the same direction.
fn turn(from: Vec2, to: Vec2) -> f64 {
    let (along, aside) = (from.dot(&to), cross(from, to));
    let share = along / (along.abs() + aside.abs()).max(f64::MIN_POSITIVE);
    match aside > 0.0 {
        true => 1.0 - share,
        false if aside == 0.0 && along > 0.0 => 4.0,
        false => 3.0 + share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_gone_along_and_back() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]].map(Vec2::from);
        let Some(loops) = Loops::lines(&points, &[[0, 1], [1, 2]]) else {
            panic!("it is closed");
        };
        let mut edge = 0;
        let names: Vec<u32> = (0..5)
            .map(|_| {
                let name = loops.name(edge);
                edge = loops.next(edge);
                name
            })
            .collect();
        assert_eq!(names, [0, 1, 2, 1, 0]);
    }

    /// Three lines that meet: the loop around them passes the middle three times, at the right hand of all.
    #[test]
    fn lines_that_meet_are_gone_around() {
        let points = [[0.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]].map(Vec2::from);
        let Some(loops) = Loops::lines(&points, &[[0, 1], [0, 2], [0, 3]]) else {
            panic!("it is closed");
        };
        let mut edge = 0;
        let mut names = Vec::new();
        for _ in 0..6 {
            names.push(loops.name(edge));
            edge = loops.next(edge);
        }
        assert_eq!((edge, names), (0, vec![0, 1, 0, 2, 0, 3]));
    }

    /// The area of a core that is rounded is its own, that of a band along its edges and that of a disc (Steiner), less what arcs are cut off by.
    #[test]
    fn rounded_cores_are_drawn_within_their_roundings() {
        let core = [[0.0, 0.0], [0.6, -0.1], [0.5, 0.4], [0.1, 0.3]].map(Vec2::from);
        for n in 1..=4 {
            let (core, radius) = (&core[..n], 0.2);
            let loops = Loops::rounded(core, radius);
            assert!(loops.n_edges() <= Loops::n_rounded(n), "{n}");
            let area = |of: &Loops| {
                let edges = (0..of.n_edges()).map(|edge| of.edge(edge));
                edges.map(|[from, to]| cross(from, to)).sum::<f64>() / 2.0
            };
            let own = Loops::polygon(core);
            let straight = area(&own) + radius * own.length();
            let round = (area(&loops) - straight) / (PI * radius * radius);
            // Sixteen facets have .974 of a disc's area; arcs that end at corners have smaller ones.
            assert!((0.97..1.0).contains(&round), "{n}: {round}");
        }
    }

    #[test]
    fn what_a_rim_encloses_is_in_it() {
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        let Some(loops) = Loops::rim(&points, &[[2, 3], [0, 1], [3, 0], [1, 2]]) else {
            panic!("it is closed");
        };
        assert!(loops.contain(Vec2::new(0.3, 0.4)));
        assert!(!loops.contain(Vec2::new(2.3, 0.4)) && !loops.contain(Vec2::new(0.3, 1.4)));
        assert!(Loops::rim(&points, &[[0, 1], [1, 2]]).is_none());
    }
}
