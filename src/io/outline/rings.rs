//! From the closed curves of a path to outlines with holes, by the rule that fills it.
//!
//! A ring bounds what is filled if one of its sides is filled and the other is not. The winding number just outside is the sum of the directions of
//! all rings around it; just inside its own direction is added.

use super::Outline;
use robust::{Coord, orient2d};

/// What is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FillRule {
    /// What any rings go around in sum.
    NonZero,
    /// What an odd number of rings goes around.
    EvenOdd,
}

impl FillRule {
    fn fills(self, winding: i64, depth: usize) -> bool {
        match self {
            Self::NonZero => winding != 0,
            Self::EvenOdd => depth % 2 == 1,
        }
    }
}

/// The outlines of rings. What crosses itself is for meshing to refuse.
///
/// # Errors
/// A point near which two of the rings cross or touch: which of them is around the other has no answer then.
pub(super) fn outlines_of(
    rings: Vec<Vec<[f64; 2]>>,
    rule: FillRule,
    name: Option<&str>,
) -> Result<Vec<Outline>, [f64; 2]> {
    let rings: Vec<_> = rings.into_iter().filter(|ring| spans_area(ring)).collect();
    if let Some(place) = meeting(&rings) {
        return Err(place);
    }
    let boxes: Vec<_> = rings.iter().map(|ring| bounds(ring)).collect();
    let around: Vec<Vec<usize>> = (0..rings.len())
        .map(|inner| {
            let at = rings[inner][0];
            let goes_around = |outer: &usize| {
                let [low, high] = boxes[*outer];
                let is_near = (0..2).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]);
                *outer != inner && is_near && contains(&rings[*outer], at)
            };
            (0..rings.len()).filter(goes_around).collect()
        })
        .collect();
    let direction = |ring: usize| area(&rings[ring]).signum() as i64;
    // Whether it is filled outside and inside of each ring.
    let fills: Vec<[bool; 2]> = (0..rings.len())
        .map(|ring| {
            let depth = around[ring].len();
            let winding: i64 = around[ring].iter().map(|&outer| direction(outer)).sum();
            let inside = winding + direction(ring);
            [rule.fills(winding, depth), rule.fills(inside, depth + 1)]
        })
        .collect();
    let mut outlines: Vec<Outline> = Vec::new();
    let mut outline_of = vec![usize::MAX; rings.len()];
    for ring in (0..rings.len()).filter(|&ring| fills[ring] == [false, true]) {
        outline_of[ring] = outlines.len();
        outlines.push(Outline {
            name: name.map(str::to_owned),
            outer: rings[ring].clone(),
            holes: Vec::new(),
        });
    }
    for ring in (0..rings.len()).filter(|&ring| fills[ring] == [true, false]) {
        // The deepest outline around the hole is the one it is in.
        let outer = around[ring]
            .iter()
            .filter(|&&outer| outline_of[outer] != usize::MAX);
        if let Some(&outer) = outer.max_by_key(|&&outer| around[outer].len()) {
            outlines[outline_of[outer]].holes.push(rings[ring].clone());
        }
    }
    Ok(outlines)
}

/// A side of a ring.
#[derive(Clone, Copy)]
struct Side {
    ring: usize,
    ends: [[f64; 2]; 2],
    low: [f64; 2],
    high: [f64; 2],
}

/// Where sides of two rings cross or touch, if any do.
fn meeting(rings: &[Vec<[f64; 2]>]) -> Option<[f64; 2]> {
    if rings.len() < 2 {
        return None;
    }
    let mut sides: Vec<Side> = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        for (i, &from) in points.iter().enumerate() {
            let to = points[(i + 1) % points.len()];
            sides.push(Side {
                ring,
                ends: [from, to],
                low: [from[0].min(to[0]), from[1].min(to[1])],
                high: [from[0].max(to[0]), from[1].max(to[1])],
            });
        }
    }
    // From left to right, each is compared with those that begin before it ends.
    sides.sort_by(|one, other| one.low[0].total_cmp(&other.low[0]));
    for (i, one) in sides.iter().enumerate() {
        let reached = sides[i + 1..]
            .iter()
            .take_while(|other| other.low[0] <= one.high[0]);
        for other in reached {
            let is_beside = other.low[1] > one.high[1] || other.high[1] < one.low[1];
            if other.ring != one.ring && !is_beside && meet(one.ends, other.ends) {
                return Some([0, 1].map(|axis| {
                    let low = one.low[axis].max(other.low[axis]);
                    0.5 * (low + one.high[axis].min(other.high[axis]))
                }));
            }
        }
    }
    None
}

/// Whether two segments whose boxes overlap have a point in common.
fn meet(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> bool {
    let coord = |[x, y]: [f64; 2]| Coord { x, y };
    let parts = |[from, to]: [[f64; 2]; 2], ends: [[f64; 2]; 2]| {
        let [first, last] = ends.map(|end| orient2d(coord(from), coord(to), coord(end)));
        !(first > 0.0 && last > 0.0 || first < 0.0 && last < 0.0)
    };
    parts(one, other) && parts(other, one)
}

fn bounds(ring: &[[f64; 2]]) -> [[f64; 2]; 2] {
    ring.iter().fold([ring[0]; 2], |[low, high], &[x, y]| {
        [
            [low[0].min(x), low[1].min(y)],
            [high[0].max(x), high[1].max(y)],
        ]
    })
}

/// Whether points are not all on a line. What crosses itself may have no area in sum, and is for meshing to refuse.
fn spans_area(ring: &[[f64; 2]]) -> bool {
    let Some((&[x0, y0], others)) = ring.split_first() else {
        return false;
    };
    let mut pairs = others.windows(2);
    pairs.any(|pair| {
        let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
        (ax - x0) * (by - y0) - (bx - x0) * (ay - y0) != 0.0
    })
}

fn area(ring: &[[f64; 2]]) -> f64 {
    let n = ring.len();
    let [x0, y0] = ring[0];
    let cross = |i: usize| {
        let ([ax, ay], [bx, by]) = (ring[i], ring[(i + 1) % n]);
        (ax - x0) * (by - y0) - (bx - x0) * (ay - y0)
    };
    0.5 * (0..n).map(cross).sum::<f64>()
}

fn contains(ring: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let n = ring.len();
    let crossings = (0..n).filter(|&i| {
        let ([ax, ay], [bx, by]) = (ring[i], ring[(i + 1) % n]);
        (ay > y) != (by > y) && ax + (y - ay) / (by - ay) * (bx - ax) > x
    });
    crossings.count() % 2 == 1
}
