//! The deformed surface of a flexible block as a target: the boundary polyline, material on its left.

use crate::math::{Vec2, cross, judged::Judged, perp, rounding};
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
///
/// Only a segment that faces the `cone` of the point pushes it: a corner that lies on the edge of the surface is as near to the
/// surface's other face, which its own body extends past.
pub fn closest_surface_point(
    block: &FlexBlock,
    segments: &[u32],
    [point, start]: [Vec2; 2],
    cone: Option<Cone>,
) -> Option<SurfacePoint> {
    entered_segment(block, segments, [point, start], cone)
        .or_else(|| nearest_segment(block, segments, point, cone))
}

/// The directions in which a corner points: between the outward unit normals of the faces that meet there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone(pub [Vec2; 2]);

impl Cone {
    /// That of a boundary node, at whose place `segment` starts.
    pub(super) fn of_node(block: &FlexBlock, segment: usize) -> Self {
        let boundary = block.model().mesh().boundary();
        Self(
            [segment, boundary.previous_segment(segment)].map(|segment| {
                let [a, b] = boundary.segments()[segment];
                -perp(block.position(b) - block.position(a)).normalize()
            }),
        )
    }

    /// Whether the corner can be pushed by a surface of this outward normal.
    fn faces(&self, normal: Vec2) -> bool {
        let Self([one, other]) = self;
        let mean = one + other;
        let is_within =
            -normal.dot(&mean) >= (1.0 + one.dot(other)) && mean.norm() > rounding::SHARE;
        is_within || one.dot(&normal).min(other.dot(&normal)) < -POINTING
    }
}

/// Least cosine between a surface and a direction of a corner that push each other: faces bulge by some degrees. The tests
/// hold from half of this value to 1.4 times; at twice, two of a thousand random shots go through.
const POINTING: Judged = Judged::new("constraint::POINTING", 0.25);

/// Depth, over the length of the segment, up to which a corner may have slipped over the edge of a surface; deeper it has been shot in.
/// The tests hold from half of this value to 1.4 times; at twice, one of a thousand random shots goes through.
const CORNER_DEPTH: Judged = Judged::new("constraint::CORNER_DEPTH", 0.25);

/// Depth, over the length of the segment, up to which a point that has come out beside a segment has only cut its corner. The
/// tests hold from half of this value to 2.5 times.
const CUT_DEPTH: Judged = Judged::new("constraint::CUT_DEPTH", 0.04);

/// The segment that a point crossed inwards during the step, the shallowest if there are several.
///
/// One that the point is still behind comes before one that it only passed through on its way: what flies on along the
/// surface is held by the line of the segment, at the place where it came in.
fn entered_segment(
    block: &FlexBlock,
    segments: &[u32],
    [point, start]: [Vec2; 2],
    cone: Option<Cone>,
) -> Option<SurfacePoint> {
    let boundary = block.model().mesh().boundary();
    let mut entered: Option<SurfacePoint> = None;
    let mut passed: Option<SurfacePoint> = None;
    for &segment in segments {
        let [a, b] = boundary.segments()[segment as usize];
        let (from, to) = (block.position(a), block.position(b));
        let along = to - from;
        let offset = point - from;
        let area = -perp(along).dot(&offset);
        if area >= 0.0 {
            continue;
        }
        let normal = -perp(along).normalize();
        let is_shallow = -area < CORNER_DEPTH * along.norm_squared();
        if is_shallow && cone.is_some_and(|cone| !cone.faces(normal)) {
            continue;
        }
        let (start_from, start_to) = (block.start_position(a), block.start_position(b));
        let start_along = start_to - start_from;
        let start_offset = start - start_from;
        let start_area = -perp(start_along).dot(&start_offset);
        if start_area < -ENTRY_SLOP * start_along.norm_squared() {
            continue;
        }
        let within = -ENTRY_SLOP..=1.0 + ENTRY_SLOP;
        let end_xi = offset.dot(&along) / along.norm_squared();
        let is_behind = within.contains(&end_xi);
        let is_cut = -area < CUT_DEPTH * along.norm_squared();
        if !is_behind && (is_cut || start_area <= ENTRY_SLOP * start_along.norm_squared()) {
            // What began on the line of a segment has not come through it beside its end, and what is hardly past it slid over the end:
            // pushed back, it would lie beside the body, where nothing pushes.
            continue;
        }
        let xi = if is_behind {
            end_xi
        } else {
            crossing([start_along, along], [start_offset, offset])
        };
        let best = if is_behind { &mut entered } else { &mut passed };
        let distance = area / along.norm();
        if within.contains(&xi) && best.is_none_or(|best| distance > best.distance) {
            *best = Some(SurfacePoint {
                segment: segment as usize,
                xi: xi.clamp(0.0, 1.0),
                normal,
                distance,
            });
        }
    }
    entered.or(passed)
}

/// Where on a segment, which goes `along`, a point at `offset` from its first node comes to lie on its line, as all move straight
/// from the first to the second of each pair, from one side of the line to the other.
fn crossing(along: [Vec2; 2], offset: [Vec2; 2]) -> f64 {
    let area = |one: Vec2, other: Vec2| perp(one).dot(&other);
    // The area between both is `(1-t)² s + t (1-t) m + t² e`, which changes sign once.
    let end = area(along[1], offset[1]);
    let start = area(along[0], offset[0]);
    let start = if start * end < 0.0 { start } else { 0.0 };
    let mixed = area(along[0], offset[1]) + area(along[1], offset[0]);
    let (a, b) = (start - mixed + end, mixed - 2.0 * start);
    let q = 0.5 * ((b * b - 4.0 * a * start).max(0.0).sqrt().copysign(b) + b);
    let roots = [-start / q, -q / a];
    let time = roots
        .into_iter()
        .find(|time| (0.0..=1.0).contains(time))
        .unwrap_or(0.0);
    let along = along[0] + time * (along[1] - along[0]);
    let offset = offset[0] + time * (offset[1] - offset[0]);
    offset.dot(&along) / along.norm_squared()
}

/// Part of a segment's length by which a point may miss it and still count as having come in through it.
const ENTRY_SLOP: f64 = rounding::SHARE;

/// The closest of the listed boundary segments or of their nodes, but for those that the point is behind and does not face.
fn nearest_segment(
    block: &FlexBlock,
    segments: &[u32],
    point: Vec2,
    cone: Option<Cone>,
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
        let normal = -perp(along).normalize();
        let is_behind = normal.dot(&(point - a)) < 0.0;
        if is_behind && cone.is_some_and(|cone| !cone.faces(normal)) {
            continue;
        }
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
    // Closest to a node: measured along the direction from it, within the cone of its segments' normals. Where these are
    // parallel, or rounding decides on the direction, that is the normal of the surface.
    let other = if xi == 0.0 {
        boundary.previous_segment(segment)
    } else {
        boundary.next_segment(segment)
    };
    if !segments.contains(&(other as u32)) {
        // The list ends here: whatever is nearest lies beyond it.
        return None;
    }
    let mean = own + outward(other);
    let mean = if mean.norm() > rounding::SHARE {
        mean.normalize()
    } else {
        own
    };
    let offset = point - foot;
    let sign = if mean.dot(&offset) >= 0.0 { 1.0 } else { -1.0 };
    let distance = squared.sqrt();
    let direction = if distance > 0.0 {
        sign * offset / distance
    } else {
        mean
    };
    let mut normal = nearest_in_cone(direction, [own, outward(other)], mean);
    let is_met = |normal: &Vec2| cone.is_none_or(|cone| cone.faces(*normal));
    if normal.dot(&offset) < 0.0 && !is_met(&normal) {
        normal = [own, outward(other)].into_iter().find(is_met)?;
    }
    Some(SurfacePoint {
        segment,
        xi,
        normal,
        distance: normal.dot(&offset),
    })
}

/// The unit vector between two normals that is nearest to `direction`.
fn nearest_in_cone(direction: Vec2, [one, other]: [Vec2; 2], mean: Vec2) -> Vec2 {
    // Within the cone a vector is as near to the mean as the normals are.
    if direction.dot(&mean) >= one.dot(&mean) {
        direction
    } else if direction.dot(&one) >= direction.dot(&other) {
        one
    } else {
        other
    }
}

/// Whether the surface around a boundary node faces a target whose outward normal is `normal`, so that the target can push
/// it into the body. `segment` starts at the node.
///
/// A node that lies exactly under the corner of a box is as near to the side of the box as to its bottom; only the bottom
/// can push. With `exactly` the normal must be opposite to one in the node's cone: two vertices touch only there,
/// elsewhere the target's vertex touches a segment.
pub(super) fn faces(block: &FlexBlock, segment: usize, normal: Vec2, exactly: bool) -> bool {
    let boundary = block.model().mesh().boundary();
    let outward = |segment: usize| {
        let [a, b] = boundary.segments()[segment];
        -perp(block.position(b) - block.position(a)).normalize()
    };
    let normals = [
        outward(segment),
        outward(boundary.previous_segment(segment)),
    ];
    let mean = normals[0] + normals[1];
    let mean = if mean.norm() > rounding::SHARE {
        mean.normalize()
    } else {
        normals[0]
    };
    let is_within = -normal.dot(&mean) >= normals[0].dot(&mean) - rounding::SUM;
    let turns_left = cross(normals[1], normals[0]) > 0.0;
    if exactly {
        return is_within && turns_left;
    }
    is_within || normals.iter().any(|own| own.dot(&normal) < -FACING)
}

/// Whether a target was in front of the surface around a boundary node when the step began; `normal` pointed from it to
/// the node.
pub(super) fn faced_at_start(block: &FlexBlock, segment: usize, normal: Vec2) -> bool {
    let boundary = block.model().mesh().boundary();
    [segment, boundary.previous_segment(segment)]
        .into_iter()
        .any(|segment| {
            let [a, b] = boundary.segments()[segment];
            let along = block.start_position(b) - block.start_position(a);
            -perp(along).dot(&normal) < FACING * along.norm()
        })
}

/// Least cosine between a surface and a face that push each other.
const FACING: Judged = Judged::new("constraint::FACING", 0.05);

/// Where a round vertex meets one boundary segment: at a foot between the segment's nodes, on the side the vertex came
/// from; `None` elsewhere, as nodes meet the part by themselves.
pub(super) fn facing_point(
    block: &FlexBlock,
    segments: &[u32],
    point: Vec2,
    start: Vec2,
) -> Option<SurfacePoint> {
    if let Some(entered) = entered_segment(block, segments, [point, start], None) {
        // A point above a node belongs to the segment that starts there.
        return (entered.xi < 1.0).then_some(entered);
    }
    let &segment = segments.first()?;
    let [a, b] = block.model().mesh().boundary().segments()[segment as usize];
    let (from, to) = (block.position(a), block.position(b));
    let along = to - from;
    let normal = -perp(along).normalize();
    let distance = normal.dot(&(point - from));
    let xi = (point - from).dot(&along) / along.norm_squared();
    if !(distance > 0.0 && xi > 0.0 && xi < 1.0) {
        return None;
    }
    // What came through the body from behind has been met on its other side.
    let start_from = block.start_position(a);
    let start_along = block.start_position(b) - start_from;
    let start_offset = start - start_from;
    let was_behind =
        -perp(start_along).dot(&start_offset) < -ENTRY_SLOP * start_along.norm_squared();
    let came_through = was_behind
        && (0.0..=1.0).contains(&crossing(
            [start_along, along],
            [start_offset, point - from],
        ));
    (!came_through).then_some(SurfacePoint {
        segment: segment as usize,
        xi,
        normal,
        distance,
    })
}
