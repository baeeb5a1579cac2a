//! Projection of a contactor node on a target segment of a flexible boundary,
//! `xi = (p - a)·t / l`, `gap = n·(p - (1 - xi) a - xi b)`.

use crate::math::{Vec2, perp};

/// Where the projection of a point falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SegmentRegion {
    /// Between the ends, ends included.
    Interior,
    /// Beyond an end: the nearest point of the segment is its vertex.
    Vertex {
        /// 0 for the start of the segment, 1 for its end.
        end: usize,
        /// Distance to that vertex (m), not signed: the neighbouring segment decides whether it is inside.
        distance: f64,
        /// Unit vector from the vertex to the point; the segment's normal if they coincide.
        direction: Vec2,
    },
}

/// A point seen from a target segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentQuery {
    /// Position along the segment, within `[0, 1]`.
    pub xi: f64,
    /// Position along the line of the segment, not limited.
    pub xi_unclamped: f64,
    /// Signed distance to the line of the segment along `normal` (m), negative in the material. It is the gap while
    /// the region is the interior.
    pub gap: f64,
    /// Outward unit normal `(d_y, -d_x) / l`.
    pub normal: Vec2,
    /// Length `l` of the segment (m).
    pub length: f64,
    /// Where the projection falls.
    pub region: SegmentRegion,
}

/// Projects `point` on the segment from `a` to `b`, whose material is on its left.
///
/// A segment without length counts as a vertex at `a`, with the direction to the point as its normal (upward if they
/// coincide).
pub fn segment_query(point: Vec2, a: Vec2, b: Vec2) -> SegmentQuery {
    let offset = point - a;
    let length = (b - a).norm();
    if length < f64::MIN_POSITIVE.sqrt() {
        let normal = direction_or(offset, Vec2::y());
        let distance = offset.norm();
        return SegmentQuery {
            xi: 0.0,
            xi_unclamped: 0.0,
            gap: distance,
            normal,
            length: 0.0,
            region: SegmentRegion::Vertex {
                end: 0,
                distance,
                direction: normal,
            },
        };
    }
    let tangent = (b - a) / length;
    let normal = -perp(tangent);
    let xi_unclamped = tangent.dot(&offset) / length;
    let region = if (0.0..=1.0).contains(&xi_unclamped) {
        SegmentRegion::Interior
    } else {
        let end = usize::from(xi_unclamped > 0.5);
        let from_vertex = point - if end == 0 { a } else { b };
        SegmentRegion::Vertex {
            end,
            distance: from_vertex.norm(),
            direction: direction_or(from_vertex, normal),
        }
    };
    SegmentQuery {
        xi: xi_unclamped.clamp(0.0, 1.0),
        xi_unclamped,
        gap: normal.dot(&offset),
        normal,
        length,
        region,
    }
}

/// `v / |v|`, or `fallback` when `v` has no direction in floating point.
pub(super) fn direction_or(v: Vec2, fallback: Vec2) -> Vec2 {
    let norm = v.norm();
    // Below this the squares in the norm underflow.
    if norm > 1e-150 { v / norm } else { fallback }
}
