//! Kinematics of two rigid parts: a point on a face that faced it when the step began, or a vertex on whatever face it came in
//! by.

use super::candidate::{Candidate, Pair};
use super::kinematics::Kinematics;
use super::scene::{Scene, rigid_of};
use crate::constraint::geometry::{
    Feature, PairContact, Pose2, crossing_overlap, entered_separation, start_separation,
};
use crate::math::{Vec2, atan2, judged::Judged, perp, rotation};
use crate::system::{Point, RigidBlock, RigidMotion};

/// Relative turn that counts as a straight piece of a vertex's path (rad).
const PIECE: Judged = Judged::new("constraint::PIECE", 0.15);

/// Most pieces of a path.
const MOST_PIECES: usize = 12;

impl Candidate {
    /// Gap of a pair of rigid parts at the beginning of the step (m); `None` where a flexible body takes part.
    pub fn start_gap(&self, scene: &Scene<'_>) -> Option<f64> {
        match self.pair {
            Pair::PointOnFace {
                point: (block, arm),
                face,
                ends,
                radius,
            } => {
                let point = scene.blocks[block].start_position(Point::Arm(arm));
                let motion = rigid_of(scene, face)?.start();
                gap_to_face(motion, point, ends).map(|(distance, _)| distance - radius)
            }
            Pair::VertexOnPart {
                point: (block, arm),
                radius,
                rigid,
                part,
                towards,
                ..
            } => {
                let placed = &scene.parts[part];
                let start = scene.blocks[block].start_position(Point::Arm(arm));
                let arm = rigid_of(scene, rigid)?.start().arm(start);
                let local = placed.pose.inverse_transform(arm);
                Some(start_separation(&placed.part, local, towards).distance - radius)
            }
            Pair::Crossing { blocks, parts } => {
                let crossed = deepest_crossing(scene, blocks, parts, RigidBlock::start)?;
                Some(crossed.distance)
            }
            _ => None,
        }
    }
}

/// A core vertex of a rigid part against another part.
pub(super) fn vertex_on_part(scene: &Scene<'_>, pair: &Pair) -> Option<Kinematics> {
    let &Pair::VertexOnPart {
        point: (block, arm),
        radius,
        rigid,
        part,
        towards,
        meets_vertices,
    } = pair
    else {
        return None;
    };
    let motion = rigid_of(scene, rigid)?;
    let placed = &scene.parts[part];
    let point = scene.blocks[block].position(Point::Arm(arm));
    let carrier = rigid_of(scene, block)?;
    let turn = |block: &RigidBlock| block.current().angle - block.start().angle;
    let pieces = ((turn(carrier) - turn(motion)).abs() / PIECE).ceil();
    let pieces = (pieces as usize).clamp(1, MOST_PIECES);
    let mut path = [Vec2::zeros(); MOST_PIECES + 1];
    for (piece, place) in path[..=pieces].iter_mut().enumerate() {
        let share = piece as f64 / pieces as f64;
        let at = between(carrier, share).point(arm);
        let arm = between(motion, share).arm(at);
        *place = placed.pose.inverse_transform(arm);
    }
    let found = entered_separation(&placed.part, &path[..=pieces], towards);
    if matches!(found.feature, Feature::Vertex(_)) && !meets_vertices {
        return None;
    }
    let normal = rotation(motion.current().angle) * placed.pose.rotate(found.normal);
    // Both arms end at the surface of the part, so that the pair of forces has no couple.
    let position = point - found.distance * normal;
    let own = rigid_of(scene, block)?.current().arm(position);
    let grips = [
        (block, Point::Arm(own), 1.0),
        (rigid, Point::Arm(motion.current().arm(position)), -1.0),
    ];
    let gap = found.distance - radius;
    Some(Kinematics::new(scene, gap, normal, position, &grips))
}

pub(super) fn point_on_face(
    scene: &Scene<'_>,
    (block, arm): (usize, Vec2),
    face: usize,
    ends: [Vec2; 2],
    radius: f64,
) -> Option<Kinematics> {
    let motion = rigid_of(scene, face)?.current();
    let point = scene.blocks[block].position(Point::Arm(arm));
    let (distance, normal) = gap_to_face(motion, point, ends)?;
    // Both arms end at the same world point, so that the pair of forces has no couple.
    let position = point - distance * normal;
    let gap = distance - radius;
    let own = rigid_of(scene, block)?.current().arm(position);
    let grips = [
        (block, Point::Arm(own), 1.0),
        (face, Point::Arm(motion.arm(position)), -1.0),
    ];
    Some(Kinematics::new(scene, gap, normal, position, &grips))
}

/// Distance of a world point to the line of a face, or to a point, of the core (m), and the unit normal towards it.
fn gap_to_face(motion: &RigidMotion, point: Vec2, ends: [Vec2; 2]) -> Option<(f64, Vec2)> {
    let [a, b] = ends.map(|end| motion.point(end));
    let along = b - a;
    if along.norm() > 0.0 {
        let normal = -perp(along).normalize();
        return Some((normal.dot(&(point - a)), normal));
    }
    let apart = point - a;
    let distance = apart.norm();
    (distance > 0.0).then(|| (distance, apart / distance))
}

/// The place of a block at a share of the step, if it moves evenly.
fn between(block: &RigidBlock, share: f64) -> RigidMotion {
    let (start, end) = (block.start(), block.current());
    if share >= 1.0 {
        return *end;
    }
    RigidMotion {
        centre: start.centre + share * (end.centre - start.centre),
        angle: start.angle + share * (end.angle - start.angle),
        ..*start
    }
}

/// Two parts whose edges cross, measured along the axis of least overlap; `None` where they do not overlap, or where a vertex in
/// the other part tells more.
pub(super) fn crossing(
    scene: &Scene<'_>,
    blocks: [usize; 2],
    parts: [usize; 2],
) -> Option<Kinematics> {
    let found = deepest_crossing(scene, blocks, parts, RigidBlock::current)?;
    let (point, face) = if found.point_on_b { (1, 0) } else { (0, 1) };
    let [carrier, target] = [
        rigid_of(scene, blocks[point])?,
        rigid_of(scene, blocks[face])?,
    ];
    let arm = scene.parts[parts[point]].pose.transform(found.point);
    let position = carrier.current().point(arm) - found.distance * found.normal;
    let held = |block: &RigidBlock| Point::Arm(block.current().arm(position));
    let grips = [
        (blocks[point], held(carrier), 1.0),
        (blocks[face], held(target), -1.0),
    ];
    Some(Kinematics::new(
        scene,
        found.distance,
        found.normal,
        position,
        &grips,
    ))
}

fn deepest_crossing(
    scene: &Scene<'_>,
    blocks: [usize; 2],
    parts: [usize; 2],
    at: impl Fn(&RigidBlock) -> &RigidMotion,
) -> Option<PairContact> {
    let pose = |side: usize| {
        let motion = at(rigid_of(scene, blocks[side])?);
        let own = &scene.parts[parts[side]].pose;
        let angle = atan2(own.sin, own.cos) + motion.angle;
        Some(Pose2::new(motion.point(own.translation), angle))
    };
    let [a, b] = parts.map(|part| &*scene.parts[part].part);
    crossing_overlap(a, &pose(0)?, b, &pose(1)?)
}
