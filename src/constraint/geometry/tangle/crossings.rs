//! Where the edges of two outlines cross.

use super::loops::Loops;
use crate::math::{Vec2, cross, rounding};

/// A point where an edge of the first crosses an edge of the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The edges of both.
    pub edges: [usize; 2],
    /// Where it is along each (-).
    pub along: [f64; 2],
    /// Where it is (m).
    pub place: Vec2,
    /// Whether the first comes into the second there.
    pub enters: bool,
}

/// All crossings of two outlines, with their order along both.
pub(super) struct Crossings {
    pub all: Vec<Crossing>,
    /// The crossing that follows each along the first.
    pub next_on_first: Vec<usize>,
    /// The crossing that each follows along the second.
    pub before_on_second: Vec<usize>,
}

impl Crossings {
    /// The crossings of two outlines; `None` if there are none, or what enters does not leave, as where edges lie on each other.
    pub fn of(first: &Loops, second: &Loops) -> Option<Self> {
        let all = found(first, second);
        let next_on_first = followers(&all, first, 0);
        let before_on_second = inverse(&followers(&all, second, 1));
        let crossings = Self {
            all,
            next_on_first,
            before_on_second,
        };
        (!crossings.all.is_empty() && crossings.alternate()).then_some(crossings)
    }

    /// The same as the second sees them: it comes into the first where that leaves it.
    pub fn seen_by_second(&self) -> Self {
        let turned = |crossing: &Crossing| {
            let ([first, second], [here, there]) = (crossing.edges, crossing.along);
            Crossing {
                edges: [second, first],
                along: [there, here],
                enters: !crossing.enters,
                place: crossing.place,
            }
        };
        Self {
            all: self.all.iter().map(turned).collect(),
            next_on_first: inverse(&self.before_on_second),
            before_on_second: inverse(&self.next_on_first),
        }
    }

    fn alternate(&self) -> bool {
        let differ = |one: usize, other: usize| self.all[one].enters != self.all[other].enters;
        (0..self.all.len()).all(|crossing| {
            differ(crossing, self.next_on_first[crossing])
                && differ(crossing, self.before_on_second[crossing])
        })
    }
}

/// Who comes before each, by who comes after.
fn inverse(after: &[usize]) -> Vec<usize> {
    let mut before = vec![0; after.len()];
    for (one, &other) in after.iter().enumerate() {
        before[other] = one;
    }
    before
}

/// The crossings of edges, with the first outline moved by what rounding may be of it, so that nothing lies on anything.
fn found(first: &Loops, second: &Loops) -> Vec<Crossing> {
    let [low, high] = first.bounds();
    let aside = rounding::SHARE * (high - low).max() * Vec2::new(0.73, 0.41);
    let edges = |loops: &Loops, aside: Vec2| -> Vec<[Vec2; 2]> {
        let edges = 0..loops.n_edges();
        edges
            .map(|edge| loops.edge(edge).map(|end| end + aside))
            .collect()
    };
    let (ours, theirs) = (edges(first, aside), edges(second, Vec2::zeros()));
    let meets = |[a, b]: [Vec2; 2], low: Vec2, high: Vec2| {
        let (from, to) = (a.inf(&b), a.sup(&b));
        from.x <= high.x && low.x <= to.x && from.y <= high.y && low.y <= to.y
    };
    let mut all = Vec::new();
    for (there, &[c, d]) in theirs.iter().enumerate() {
        if !meets([c, d], low + aside, high + aside) {
            continue;
        }
        for (here, &[a, b]) in ours.iter().enumerate() {
            if !meets([a, b], c.inf(&d), c.sup(&d)) {
                continue;
            }
            let [before, after] = [a, b].map(|point| side(c, d, point));
            let [start, end] = [c, d].map(|point| side(a, b, point));
            if (before < 0.0) == (after < 0.0) || (start < 0.0) == (end < 0.0) {
                continue;
            }
            let along = [before / (before - after), start / (start - end)];
            all.push(Crossing {
                edges: [here, there],
                along,
                place: a + along[0] * (b - a),
                enters: before < 0.0,
            });
        }
    }
    all
}

/// Twice the area of a triangle over an edge, the same but for its sign if the edge is turned round: positive on its left.
fn side(from: Vec2, to: Vec2, point: Vec2) -> f64 {
    let is_first = (from.x, from.y) < (to.x, to.y);
    let [one, other] = if is_first { [from, to] } else { [to, from] };
    let area = cross(other - one, point - one);
    if is_first { area } else { -area }
}

/// The crossing that follows each along one of the outlines.
fn followers(all: &[Crossing], loops: &Loops, of: usize) -> Vec<usize> {
    let mut on_edges: Vec<Vec<usize>> = vec![Vec::new(); loops.n_edges()];
    for (name, crossing) in all.iter().enumerate() {
        on_edges[crossing.edges[of]].push(name);
    }
    for on_edge in &mut on_edges {
        // A line is come to before it is left.
        on_edge.sort_by(|&one, &other| {
            let [one, other] = [one, other].map(|name| &all[name]);
            let order = one.along[of].total_cmp(&other.along[of]);
            order.then(other.enters.cmp(&one.enters))
        });
    }
    let mut after = vec![0; all.len()];
    for on_edge in &on_edges {
        for pair in on_edge.windows(2) {
            after[pair[0]] = pair[1];
        }
        let Some(&last) = on_edge.last() else {
            continue;
        };
        let mut edge = loops.next(all[last].edges[of]);
        while on_edges[edge].is_empty() {
            edge = loops.next(edge);
        }
        after[last] = on_edges[edge][0];
    }
    after
}
