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

/// The closest of the listed boundary segments to `point`; `None` if the list is empty.
pub fn closest_surface_point(
    block: &FlexBlock,
    segments: &[u32],
    point: Vec2,
) -> Option<SurfacePoint> {
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
