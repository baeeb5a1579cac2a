//! Candidates of an island: every point that may touch a target during the step, found by swept boxes.

use super::shapes::ShapePart;
use crate::constraint::contact::{
    Candidate, Cone, ContactKey, ContactLaw, Owner, Pair, PlacedPart, closest_surface_point,
};
use crate::constraint::geometry::Pose2;
use crate::kkt::Island;
use crate::math::{Vec2, atan2};
use crate::system::{Block, FlexBlock, RigidBlock, RigidMotion};

/// A box that grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: Vec2,
    high: Vec2,
}

impl Bounds {
    pub(super) fn of(points: &[Vec2]) -> Self {
        let mut bounds = Self {
            low: points[0],
            high: points[0],
        };
        for point in points {
            bounds.low = bounds.low.inf(point);
            bounds.high = bounds.high.sup(point);
        }
        bounds
    }

    pub(super) fn merged(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    pub(super) fn loosened(self, by: f64) -> Self {
        let margin = Vec2::new(by, by);
        Self {
            low: self.low - margin,
            high: self.high + margin,
        }
    }

    pub(super) fn middle(&self) -> Vec2 {
        0.5 * (self.low + self.high)
    }

    pub(super) fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    pub(super) fn intersects(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// Names of the two colliders or bodies of a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Names {
    /// First of the pair.
    pub one: Owner,
    /// Second of the pair.
    pub other: Owner,
}

/// Box of a boundary segment over the step.
fn segment_bounds(block: &FlexBlock, segment: usize) -> Bounds {
    let [a, b] = block.model().mesh().boundary().segments()[segment];
    Bounds::of(&[
        block.start_position(a),
        block.start_position(b),
        block.position(a),
        block.position(b),
        block.drift(a),
        block.drift(b),
    ])
}

/// World pose of a part on a body moving as `motion`.
pub(super) fn world_pose(motion: &RigidMotion, part: &PlacedPart) -> Pose2 {
    let angle = atan2(part.pose.sin, part.pose.cos) + motion.angle;
    Pose2::new(motion.point(part.pose.translation), angle)
}

pub(super) fn part_bounds(rigid: &RigidBlock, part: &PlacedPart) -> Bounds {
    let bounds = |motion: &RigidMotion| {
        let [low, high] = part.part.aabb(&world_pose(motion, part));
        Bounds { low, high }
    };
    let [start, drift, pulled] = rigid.places();
    bounds(&start)
        .merged(bounds(&drift))
        .merged(bounds(&pulled))
}

/// Adds the parts of a collider to the island; `offset` is the collider's pose about its body's centre of mass.
pub(super) fn add_parts(
    island: &mut Island,
    parts: &[ShapePart],
    offset: Pose2,
) -> std::ops::Range<usize> {
    let first = island.parts.len();
    for shape in parts {
        let turn = atan2(offset.sin, offset.cos) + atan2(shape.pose.sin, shape.pose.cos);
        let pose = Pose2::new(offset.transform(shape.pose.translation), turn);
        island.parts.push(PlacedPart {
            part: shape.part.clone(),
            pose,
        });
    }
    first..island.parts.len()
}

/// Candidates between a flexible block and the parts of a rigid one.
pub(super) fn flex_rigid(
    island: &mut Island,
    flex: usize,
    rigid: usize,
    parts: std::ops::Range<usize>,
    names: Names,
    law: ContactLaw,
    edge: f64,
) {
    let first_part = parts.start;
    for part in parts {
        let (Block::Flex(body), Block::Rigid(motion)) =
            (&island.blocks[flex], &island.blocks[rigid])
        else {
            return;
        };
        let placed = &island.parts[part];
        let near = part_bounds(motion, placed).loosened(0.5 * edge);
        let first = island.segments.len();
        let n_segments = body.model().mesh().boundary().segments().len();
        let mut surface: Option<Bounds> = None;
        for segment in 0..n_segments {
            let bounds = segment_bounds(body, segment);
            if bounds.intersects(&near) {
                island.segments.push(segment as u32);
                surface = Some(surface.map_or(bounds, |sum| sum.merged(bounds)));
            }
        }
        let segments = (first, island.segments.len());
        let Some(surface) = surface else {
            continue;
        };
        let ends = motion.places();
        let part_name = (part - first_part) as u32;
        let boundary = body.model().mesh().boundary();
        let first_node = boundary.segments()[island.segments[segments.0] as usize][0];
        let mut last_end = usize::MAX;
        for slot in segments.0..segments.1 {
            let [a, b] = boundary.segments()[island.segments[slot] as usize];
            // Segments come in loop order: a node shared with the one before, or with the first, is listed already.
            let closes = slot > segments.0 && b == first_node;
            let segment = island.segments[slot] as usize;
            let nodes = [
                (a != last_end).then_some((a, segment)),
                (!closes).then(|| (b, boundary.next_segment(segment))),
            ];
            last_end = b;
            for (node, starting) in nodes.into_iter().flatten() {
                let key = ContactKey {
                    contactor: names.one,
                    point: node as u32,
                    target: names.other,
                    part: part_name,
                };
                let pair = Pair::NodeOnPart {
                    node: (flex, node, starting),
                    rigid,
                    part,
                };
                island.candidates.push(Candidate { key, pair, law });
            }
        }
        let (part_data, pose, radius) = (placed.part.clone(), placed.pose, placed.part.radius());
        let normals = part_data.normals();
        for (vertex, &at) in part_data.vertices().iter().enumerate() {
            let key = ContactKey {
                contactor: names.other,
                point: (part_name << 12) | vertex as u32,
                target: names.one,
                part: 0,
            };
            let arm = pose.transform(at);
            // A corner of the ground far beside the body must not be measured against the piece of surface listed here.
            let path = Bounds::of(&ends.map(|motion| motion.point(arm)));
            if !path.loosened(radius + edge).intersects(&surface) {
                continue;
            }
            // Faces are numbered as the vertices they start at; a core of two vertices has no corners.
            let cone = (radius == 0.0 && normals.len() > 2).then(|| {
                let before = (vertex + normals.len() - 1) % normals.len();
                Cone([normals[vertex], normals[before]].map(|normal| pose.rotate(normal)))
            });
            let pair = |segments| Pair::VertexOnSurface {
                rigid,
                arm,
                radius,
                cone,
                flex,
                segments,
            };
            if radius == 0.0 || is_buried(island, flex, segments, ends[0].point(arm)) {
                let pair = pair(segments);
                island.candidates.push(Candidate { key, pair, law });
                continue;
            }
            // A round vertex may touch several segments at once; their nodes meet the part by themselves.
            for slot in segments.0..segments.1 {
                let key = ContactKey {
                    part: 1 + island.segments[slot],
                    ..key
                };
                let pair = pair((slot, slot + 1));
                island.candidates.push(Candidate { key, pair, law });
            }
        }
    }
}

/// Whether a point begins the step inside the surface of a flexible block, as the centre of a ball that was put there: it leaves by what is nearest, where
/// single segments and their nodes would let it go through, as it is behind all of them.
fn is_buried(island: &Island, flex: usize, segments: (usize, usize), point: Vec2) -> bool {
    let Block::Flex(block) = &island.blocks[flex] else {
        return false;
    };
    let listed = &island.segments[segments.0..segments.1];
    let nearest = closest_surface_point(block, listed, [point; 2], None);
    listed.len() > 1 && nearest.is_some_and(|nearest| nearest.distance < 0.0)
}

/// Candidates between two flexible blocks: nodes of the contactor, and sharp corners of the target, one-sided.
pub(super) fn flex_flex(
    island: &mut Island,
    contactor: usize,
    target: usize,
    names: Names,
    law: ContactLaw,
    edge: f64,
) {
    one_sided(island, contactor, target, names, law, edge, |_, _| true);
    let swapped = Names {
        one: names.other,
        other: names.one,
    };
    one_sided(
        island,
        target,
        contactor,
        swapped,
        law,
        edge,
        is_sharp_corner,
    );
}

fn one_sided(
    island: &mut Island,
    contactor: usize,
    target: usize,
    names: Names,
    law: ContactLaw,
    edge: f64,
    choose: impl Fn(&FlexBlock, usize) -> bool,
) {
    let (Block::Flex(points), Block::Flex(surface)) =
        (&island.blocks[contactor], &island.blocks[target])
    else {
        return;
    };
    let bounds_of = |block: &FlexBlock| {
        let n = block.model().mesh().boundary().segments().len();
        (0..n)
            .map(|segment| segment_bounds(block, segment))
            .reduce(Bounds::merged)
    };
    let (Some(points_box), Some(surface_box)) = (bounds_of(points), bounds_of(surface)) else {
        return;
    };
    let (points_box, surface_box) = (points_box.loosened(edge), surface_box.loosened(edge));
    let first = island.segments.len();
    for segment in 0..surface.model().mesh().boundary().segments().len() {
        if segment_bounds(surface, segment).intersects(&points_box) {
            island.segments.push(segment as u32);
        }
    }
    let segments = (first, island.segments.len());
    if segments.0 == segments.1 {
        return;
    }
    for (index, &node) in points.model().mesh().boundary().nodes().iter().enumerate() {
        let ends = [points.position(node), points.drift(node)];
        let bounds = Bounds::of(&[points.start_position(node), ends[0], ends[1]]);
        if bounds.intersects(&surface_box) && choose(points, index) {
            let key = ContactKey {
                contactor: names.one,
                point: node as u32,
                target: names.other,
                part: 0,
            };
            // Segment `index` starts at boundary node `index`.
            let pair = Pair::NodeOnSurface {
                node: (contactor, node, index),
                flex: target,
                segments,
            };
            island.candidates.push(Candidate { key, pair, law });
        }
    }
}

/// Whether the boundary turns left by more than 30 degrees at its `index`-th node.
fn is_sharp_corner(block: &FlexBlock, index: usize) -> bool {
    let boundary = block.model().mesh().boundary();
    // Segment `index` starts at boundary node `index`.
    let [at, after] = boundary.segments()[index];
    let [before, _] = boundary.segments()[boundary.previous_segment(index)];
    let (incoming, outgoing) = (
        block.start_position(at) - block.start_position(before),
        block.start_position(after) - block.start_position(at),
    );
    let sine = crate::math::cross(incoming, outgoing);
    sine > 0.0 && atan2(sine, incoming.dot(&outgoing)) > 30f64.to_radians()
}
