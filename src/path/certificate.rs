//! The certificate of a placement: in exact arithmetic, no two edges share a point and no member lies inside another.
//!
//! Signs of `det [b - a, c - a]` are exact (Shewchuk's adaptive predicates). If no edges of two members meet, each connected
//! part of one lies as a whole inside or outside the other, so one point of it decides, by how often the other's edges go
//! round it.

#[cfg(test)]
use super::MemberPair;
use super::bounds::Bounds;
use super::distance::square_distance;
use super::search::{Extent, Search};
use super::{Path, Surfaces};
use crate::math::Vec2;
use robust::{Coord, orient2d};

/// How a member pair overlaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// Two edges cross.
    Crossing,
    /// Two edges share a point, but do not go through each other there.
    Touching,
    /// A part of one lies inside the other.
    Contained,
}

// What a step ends with is checked by the tests; a step of its own does not pay for it yet.
/// What is true of a placement.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Pairs of edges that cross.
    pub n_crossings: usize,
    /// Pairs of edges that share a point without crossing; also where a vertex lies on the other's edge.
    pub n_touching: usize,
    /// Connected parts of members inside the solid member of their pair; not asked where edges meet.
    pub n_contained: usize,
    /// The first offending member pair.
    pub first: Option<(usize, Overlap)>,
    /// Least distance of cores beyond closing, `(d - closing) / margin`: -0.8 at the guard; infinite if no pair is within
    /// `closing + margin`.
    pub least_gap: f64,
}

#[cfg(test)]
impl Certificate {
    /// Whether nothing overlaps or touches.
    pub fn is_valid(&self) -> bool {
        self.first.is_none()
    }
}

impl Path {
    /// Checks a placement.
    #[cfg(test)]
    pub fn certificate(&mut self, surfaces: &Surfaces, pairs: &[MemberPair]) -> Certificate {
        let mut certificate = Certificate {
            n_crossings: 0,
            n_touching: 0,
            n_contained: 0,
            first: None,
            least_gap: f64::INFINITY,
        };
        self.search.refresh(Extent::of(surfaces));
        for (index, pair) in pairs.iter().enumerate() {
            let found = check(
                &mut self.search,
                surfaces,
                [pair.one, pair.other],
                pair.closing + pair.margin,
            );
            certificate.n_crossings += found.n_crossings;
            certificate.n_touching += found.n_touching;
            certificate.n_contained += found.n_contained;
            if certificate.first.is_none() {
                certificate.first = found.overlap().map(|overlap| (index, overlap));
            }
            if found.distance <= pair.closing + pair.margin {
                let gap = (found.distance - pair.closing) / pair.margin;
                certificate.least_gap = certificate.least_gap.min(gap);
            }
        }
        certificate
    }

    /// The distance of two members that are apart, which share no point and neither of which lies inside the other; infinite if it
    /// is more than `reach` (m).
    pub fn apart(&mut self, surfaces: &Surfaces, members: [usize; 2], reach: f64) -> Option<f64> {
        self.search.refresh_members(Extent::of(surfaces), members);
        let found = check(&mut self.search, surfaces, members, reach);
        found.overlap().is_none().then_some(found.distance)
    }
}

struct Found {
    n_crossings: usize,
    n_touching: usize,
    n_contained: usize,
    /// Least distance of the edges looked at (m), infinite if there are none.
    distance: f64,
}

impl Found {
    fn overlap(&self) -> Option<Overlap> {
        if self.n_crossings > 0 {
            Some(Overlap::Crossing)
        } else if self.n_touching > 0 {
            Some(Overlap::Touching)
        } else {
            (self.n_contained > 0).then_some(Overlap::Contained)
        }
    }
}

/// Looks at all edges of two members whose boxes are within `reach` (m) of each other.
fn check(search: &mut Search, surfaces: &Surfaces, [one, other]: [usize; 2], reach: f64) -> Found {
    let mut found = Found {
        n_crossings: 0,
        n_touching: 0,
        n_contained: 0,
        distance: 0.0,
    };
    let mut square = f64::INFINITY;
    search.edges_and_edges(
        Extent::of(surfaces),
        [one, other],
        reach,
        |first, second| {
            let [ends, others] = [first, second].map(|edge| surfaces.edges()[edge]);
            // Within one member each pair once.
            if one == other && second <= first {
                return;
            }
            let are_neighbours = one == other && ends.iter().any(|end| others.contains(end));
            let (ends, others) = (surfaces.ends(first), surfaces.ends(second));
            if are_neighbours {
                match fold([first, second], surfaces) {
                    Some(distance) => square = square.min(distance),
                    None => found.n_touching += 1,
                }
                return;
            }
            match meet(ends, others) {
                Some(Overlap::Crossing) => found.n_crossings += 1,
                Some(_) => found.n_touching += 1,
                None => {
                    // Edges that do not meet are closest at an end of one of them.
                    for end in ends {
                        square = square.min(square_distance(end, others));
                    }
                    for end in others {
                        square = square.min(square_distance(end, ends));
                    }
                }
            }
        },
    );
    found.distance = if found.n_crossings + found.n_touching > 0 {
        0.0
    } else {
        square.sqrt()
    };
    if found.n_crossings + found.n_touching == 0 && one != other {
        for [of, around] in [[one, other], [other, one]] {
            found.n_contained += n_parts_inside(search, surfaces, of, around);
        }
    }
    found
}

fn n_parts_inside(search: &Search, surfaces: &Surfaces, of: usize, around: usize) -> usize {
    if !surfaces.members()[around].solid {
        return 0;
    }
    let points = surfaces
        .parts(of)
        .iter()
        .map(|&point| surfaces.points()[point as usize]);
    points
        .filter(|&p| search.contains(surfaces, around, p) && winding(surfaces, around, p) != 0)
        .count()
}

/// The square of the distance from the ends that two neighbours do not share to the other edge (m²); `None` where such an end lies on it:
/// neighbours share their common end, and must not lie on each other.
fn fold([one, other]: [usize; 2], surfaces: &Surfaces) -> Option<f64> {
    let mut square = f64::INFINITY;
    for [of, on] in [[one, other], [other, one]] {
        let ends = surfaces.ends(on);
        let met = surfaces.edges()[on];
        for end in surfaces.edges()[of] {
            if met.contains(&end) {
                continue;
            }
            let point = surfaces.points()[end as usize];
            if side(ends[0], ends[1], point) == 0.0 && Bounds::of(ends).contains(point) {
                return None;
            }
            square = square.min(square_distance(point, ends));
        }
    }
    Some(square)
}

/// How often the edges of a member go round a point that lies on none of them, counter-clockwise.
fn winding(surfaces: &Surfaces, member: usize, point: Vec2) -> i64 {
    let mut winding = 0;
    for edge in surfaces.members()[member].edges.clone() {
        let [a, b] = surfaces.ends(edge);
        // An end on the ray's line counts as below it, for both edges that meet there.
        let upward = a.y <= point.y && b.y > point.y;
        let downward = b.y <= point.y && a.y > point.y;
        if upward && side(a, b, point) > 0.0 {
            winding += 1;
        } else if downward && side(a, b, point) < 0.0 {
            winding -= 1;
        }
    }
    winding
}

/// Positive if `c` lies on the left of the line from `a` to `b`, negative on the right, zero on it: exactly.
#[inline]
fn side(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|point| Coord {
        x: point.x,
        y: point.y,
    });
    orient2d(a, b, c)
}

/// Whether two edges, their ends included, share a point.
fn meet([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> Option<Overlap> {
    if !Bounds::of([a, b]).meets(&Bounds::of([c, d])) {
        return None;
    }
    let of_others = [side(a, b, c), side(a, b, d)];
    if of_others[0] * of_others[1] > 0.0 {
        return None;
    }
    let of_own = [side(c, d, a), side(c, d, b)];
    let opposite =
        |[one, other]: [f64; 2]| (one < 0.0 && other > 0.0) || (one > 0.0 && other < 0.0);
    if opposite(of_others) && opposite(of_own) {
        return Some(Overlap::Crossing);
    }
    let on = |side: f64, edge: [Vec2; 2], p: Vec2| side == 0.0 && Bounds::of(edge).contains(p);
    let touching = on(of_others[0], [a, b], c)
        || on(of_others[1], [a, b], d)
        || on(of_own[0], [c, d], a)
        || on(of_own[1], [c, d], b);
    touching.then_some(Overlap::Touching)
}

#[cfg(test)]
mod tests;
