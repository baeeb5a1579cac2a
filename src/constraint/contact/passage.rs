//! Whether the middle of a body has come into, or through, what it must stay out of: the last word on a step that moves far.
//!
//! Contact points may be led astray where bodies move by several times their size; what is inside a body cannot, as nothing
//! that is solved right lets it touch.

use super::kinematics::PlacedPart;
use crate::constraint::geometry::Path;
use crate::math::{Vec2, cross, perp};
use crate::system::{FlexBlock, RigidBlock};

/// A point of the material near the middle of a flexible body, at the beginning of the step and now.
pub fn core_of(block: &FlexBlock) -> Path {
    let corners = block.middle_cell();
    let mean = |sum: Vec2| sum / corners.len() as f64;
    [
        mean(corners.iter().map(|&node| block.start_position(node)).sum()),
        mean(corners.iter().map(|&node| block.position(node)).sum()),
    ]
}

/// The middle of a rigid part at the beginning of the step and now; `None` for a half-space.
pub fn middle_of(rigid: &RigidBlock, placed: &PlacedPart) -> Option<Path> {
    let arm =
        (!placed.part.is_half_space()).then(|| placed.pose.transform(placed.part.middle()))?;
    Some([rigid.start().point(arm), rigid.current().point(arm)])
}

/// Whether a point has come in through the surface of a flexible body, wherever it is now.
///
/// Where cells are turned inside out the surface is met from behind: a point that leaves without having been inside has come in.
pub fn enters_surface(block: &FlexBlock, point: Path) -> bool {
    let n_segments = block.model().mesh().boundary().segments().len();
    (0..n_segments).any(|segment| {
        let mut met = met(block, segment, point).into_iter().flatten();
        met.any(|is_inward| is_inward || winding(block, point[0]) <= 0)
    })
}

/// Whether a point has come in through one of the listed segments and gone out through another that is not its neighbour: at a corner
/// a point may go round what its straight way cuts off.
pub fn pierces_surface(block: &FlexBlock, listed: &[u32], point: Path) -> bool {
    let boundary = block.model().mesh().boundary();
    let passed = |inward: bool| {
        let segments = listed.iter().map(|&segment| segment as usize);
        segments.filter(move |&segment| {
            let mut met = met(block, segment, point).into_iter().flatten();
            met.any(|is_inward| is_inward == inward)
        })
    };
    passed(true).any(|entry| {
        let near = [
            entry,
            boundary.previous_segment(entry),
            boundary.next_segment(entry),
        ];
        passed(false).any(|exit| !near.contains(&exit))
    })
}

/// The passages of a point through a boundary segment.
fn met(block: &FlexBlock, segment: usize, point: Path) -> [Option<bool>; 2] {
    let [a, b] = block.model().mesh().boundary().segments()[segment];
    let from: Path = [block.start_position(a), block.position(a)];
    let to: Path = [block.start_position(b), block.position(b)];
    let along = [0, 1].map(|time| to[time] - from[time]);
    let offset = [0, 1].map(|time| point[time] - from[time]);
    passages(along, offset)
}

/// The passages of a point at `offset` through a segment that goes `along`, up to two, and whether they lead inwards.
fn passages(along: Path, offset: Path) -> [Option<bool>; 2] {
    let outside = |one: Vec2, other: Vec2| -perp(one).dot(&other);
    let [start, end] = [0, 1].map(|time| outside(along[time], offset[time]));
    let mixed = outside(along[0], offset[1]) + outside(along[1], offset[0]);
    // `a t² + b t + start` is positive outside.
    let (a, b) = (start - mixed + end, mixed - 2.0 * start);
    let discriminant = b * b - 4.0 * a * start;
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [start / q, q / a].map(|time| {
        let along = along[0] + time * (along[1] - along[0]);
        let offset = offset[0] + time * (offset[1] - offset[0]);
        let xi = offset.dot(&along) / along.norm_squared();
        let is_met = time > 0.0 && time <= 1.0 && (0.0..=1.0).contains(&xi);
        is_met.then_some(2.0 * a * time + b < 0.0)
    })
}

/// How often the surface went round a point when the step began: 1 inside the body, 0 outside.
fn winding(block: &FlexBlock, point: Vec2) -> i32 {
    let segments = block.model().mesh().boundary().segments().iter();
    let turns = segments.map(|segment| {
        let [from, to] = segment.map(|node| block.start_position(node) - point);
        let is_left = cross(from, to) > 0.0;
        match (from.y <= 0.0, to.y <= 0.0) {
            (true, false) if is_left => 1,
            (false, true) if !is_left => -1,
            _ => 0,
        }
    });
    turns.sum()
}
