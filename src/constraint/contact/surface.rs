//! The deformed surface of a flexible block as a target: the boundary polyline, material on its left.

use crate::math::{Vec2, perp};
use crate::system::FlexBlock;

/// The point of a surface closest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Boundary segment.
    pub segment: usize,
    /// Natural coordinate on it, 0 at its first node (-).
    pub xi: f64,
    /// Unit normal from the surface to the point, outwards (m).
    pub normal: Vec2,
    /// Signed distance, negative inside the body (m).
    pub distance: f64,
}

/// Where the listed boundary segments meet `point`, which began the step at `start`; `None` if the list is empty.
///
/// A point that came in through a segment during the step is measured behind that segment, however thin the body and
/// wherever the nearest one is now; any other point to the nearest segment or node.
pub fn closest_surface_point(
    block: &FlexBlock,
    segments: &[u32],
    point: Vec2,
    start: Vec2,
) -> Option<SurfacePoint> {
    entered_segment(block, segments, point, start)
        .or_else(|| nearest_segment(block, segments, point))
}

/// The segment that a point crossed inwards during the step, the shallowest if there are several.
fn entered_segment(
    block: &FlexBlock,
    segments: &[u32],
    point: Vec2,
    start: Vec2,
) -> Option<SurfacePoint> {
    let boundary = block.model().mesh().boundary();
    let mut entered: Option<SurfacePoint> = None;
    for &segment in segments {
        let [a, b] = boundary.segments()[segment as usize];
        let (from, to) = (block.position(a), block.position(b));
        let along = to - from;
        let normal = -perp(along).normalize();
        let distance = normal.dot(&(point - from));
        let xi = (point - from).dot(&along) / along.norm_squared();
        if distance >= 0.0 || !(-ENTRY_SLOP..=1.0 + ENTRY_SLOP).contains(&xi) {
            continue;
        }
        let (from, to) = (block.start_position(a), block.start_position(b));
        let outward = -perp(to - from);
        let was_outside = outward.dot(&(start - from)) >= -ENTRY_SLOP * outward.norm_squared();
        if was_outside && entered.is_none_or(|best| distance > best.distance) {
            let xi = xi.clamp(0.0, 1.0);
            entered = Some(SurfacePoint {
                segment: segment as usize,
                xi,
                normal,
                distance,
            });
        }
    }
    entered
}

/// Part of a segment's length by which a point may miss it and still count as having come in through it.
const ENTRY_SLOP: f64 = 1e-9;

/// The closest of the listed boundary segments or of their nodes.
fn nearest_segment(block: &FlexBlock, segments: &[u32], point: Vec2) -> Option<SurfacePoint> {
    let boundary = block.model().mesh().boundary();
    let ends = |segment: usize| {
        let [a, b] = boundary.segments()[segment];
        (block.position(a), block.position(b))
    };
    let mut best: Option<(f64, usize, f64, Vec2)> = None;
    for &segment in segments {
        let (a, b) = ends(segment as usize);
        let along = b - a;
        let xi = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let foot = a + xi * along;
        let squared = (point - foot).norm_squared();
        if best.is_none_or(|(least, ..)| squared < least) {
            best = Some((squared, segment as usize, xi, foot));
        }
    }
    let (squared, segment, xi, foot) = best?;
    let outward = |segment: usize| {
        let (a, b) = ends(segment);
        -perp(b - a).normalize()
    };
    let own = outward(segment);
    if xi > 0.0 && xi < 1.0 {
        let distance = own.dot(&(point - foot));
        return Some(SurfacePoint {
            segment,
            xi,
            normal: own,
            distance,
        });
    }
    // Closest to a node: the sign comes from the mean normal of both its segments, the direction from the node itself.
    let other = if xi == 0.0 {
        boundary.previous_segment(segment)
    } else {
        boundary.next_segment(segment)
    };
    let mean = own + outward(other);
    let mean = if mean.norm() > 1e-9 {
        mean.normalize()
    } else {
        own
    };
    let distance = squared.sqrt();
    let (a, b) = ends(segment);
    if distance <= 1e-12 * (b - a).norm() {
        return Some(SurfacePoint {
            segment,
            xi,
            normal: mean,
            distance: 0.0,
        });
    }
    let sign = if mean.dot(&(point - foot)) >= 0.0 {
        1.0
    } else {
        -1.0
    };
    Some(SurfacePoint {
        segment,
        xi,
        normal: sign * (point - foot) / distance,
        distance: sign * distance,
    })
}
