//! Search for two segments that meet: `a + s (b - a) = c + t (d - c)` with `s, t` in `[0, 1]`.
//!
//! A tree of bounding boxes keeps the search near `n log n`, however uneven the segments are.

use super::geometry::{cross, distance_to_segment, lerp, sub};

/// Segments in a leaf of the tree; below this a plain double loop is faster.
const LEAF: usize = 4;

/// Two segments that meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// Lower segment.
    pub(super) first: usize,
    /// Higher segment.
    pub(super) second: usize,
    /// Where they meet (m).
    pub(super) at: [f64; 2],
}

/// Finds two segments that cross or come closer than `tolerance` (m).
///
/// Segments that share a node may meet there, but may not fold back onto each other.
pub(super) fn find_crossing(
    points: &[[f64; 2]],
    segments: &[[usize; 2]],
    tolerance: f64,
) -> Option<Crossing> {
    if segments.is_empty() {
        return None;
    }
    let mut tree = Tree::new(points, segments, tolerance);
    let root = tree.build(0, segments.len());
    let mut pairs = vec![(root, root)];
    while let Some((a, b)) = pairs.pop() {
        if !tree.boxes[a].overlaps(&tree.boxes[b]) {
            continue;
        }
        match (tree.children[a], tree.children[b]) {
            (Some([left, right]), _) if a == b => {
                pairs.extend([(left, left), (right, right), (left, right)]);
            }
            (Some([left, right]), _) => pairs.extend([(left, b), (right, b)]),
            (None, Some([left, right])) => pairs.extend([(a, left), (a, right)]),
            (None, None) => {
                if let Some(crossing) = tree.meet_in_leaves(a, b) {
                    return Some(crossing);
                }
            }
        }
    }
    None
}

#[derive(Debug, Clone, Copy)]
struct Box2 {
    low: [f64; 2],
    high: [f64; 2],
}

impl Box2 {
    fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    fn merge(&self, other: &Self) -> Self {
        Self {
            low: [0, 1].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1].map(|axis| self.high[axis].max(other.high[axis])),
        }
    }
}

struct Tree<'a> {
    points: &'a [[f64; 2]],
    segments: &'a [[usize; 2]],
    tolerance: f64,
    /// Box of each segment, widened by the tolerance.
    bounds: Vec<Box2>,
    /// Segments, sorted so that each tree node owns a range.
    order: Vec<usize>,
    /// Box, range and children of each tree node; leaves have no children.
    boxes: Vec<Box2>,
    ranges: Vec<[usize; 2]>,
    children: Vec<Option<[usize; 2]>>,
}

impl<'a> Tree<'a> {
    fn new(points: &'a [[f64; 2]], segments: &'a [[usize; 2]], tolerance: f64) -> Self {
        let bounds = segments.iter().map(|&[a, b]| {
            let (a, b) = (points[a], points[b]);
            Box2 {
                low: [0, 1].map(|axis| a[axis].min(b[axis]) - tolerance),
                high: [0, 1].map(|axis| a[axis].max(b[axis]) + tolerance),
            }
        });
        Self {
            points,
            segments,
            tolerance,
            bounds: bounds.collect(),
            order: (0..segments.len()).collect(),
            boxes: Vec::new(),
            ranges: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Builds the tree node that owns a non-empty range of `order` and returns its index.
    fn build(&mut self, start: usize, end: usize) -> usize {
        let bounds = &self.bounds;
        let range = &mut self.order[start..end];
        let whole = range[1..].iter().fold(bounds[range[0]], |whole, &segment| {
            whole.merge(&bounds[segment])
        });
        let children = if end - start > LEAF {
            let width = sub(whole.high, whole.low);
            let axis = if width[0] >= width[1] { 0 } else { 1 };
            let centre = |segment: usize| bounds[segment].low[axis] + bounds[segment].high[axis];
            let half = range.len() / 2;
            range.select_nth_unstable_by(half, |&a, &b| centre(a).total_cmp(&centre(b)));
            let middle = start + half;
            Some([self.build(start, middle), self.build(middle, end)])
        } else {
            None
        };
        self.boxes.push(whole);
        self.ranges.push([start, end]);
        self.children.push(children);
        self.boxes.len() - 1
    }

    fn meet_in_leaves(&self, a: usize, b: usize) -> Option<Crossing> {
        let range = |leaf: usize| &self.order[self.ranges[leaf][0]..self.ranges[leaf][1]];
        for &one in range(a) {
            for &other in range(b) {
                if (a == b && one >= other) || !self.bounds[one].overlaps(&self.bounds[other]) {
                    continue;
                }
                let (first, second) = (one.min(other), one.max(other));
                if let Some(at) = self.meet(self.segments[first], self.segments[second]) {
                    return Some(Crossing { first, second, at });
                }
            }
        }
        None
    }

    /// Where two segments meet, other than at a shared node (m).
    fn meet(&self, [a, b]: [usize; 2], [c, d]: [usize; 2]) -> Option<[f64; 2]> {
        let p = |node: usize| self.points[node];
        let ends = [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])];
        for (end, other) in ends {
            let is_shared = other.contains(&end);
            if !is_shared && distance_to_segment(p(end), p(other[0]), p(other[1])) <= self.tolerance
            {
                return Some(p(end));
            }
        }
        let side =
            |from: usize, to: usize, at: usize| cross(sub(p(to), p(from)), sub(p(at), p(from)));
        let (c_side, d_side) = (side(a, b, c), side(a, b, d));
        let crosses = c_side * d_side < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
        let is_linked = a == c || a == d || b == c || b == d;
        (crosses && !is_linked).then(|| lerp(p(c), p(d), c_side / (c_side - d_side)))
    }
}
