//! Measuring a candidate: which feature of the target faces the point, and the kinematics there.

use super::candidate::{Candidate, Pair};
use super::kinematics::Kinematics;
use super::law::Direction;
use super::memory::Remembered;
use super::rigid_pair::{crossing, point_on_face, vertex_on_part};
use super::scene::{PlacedPart, Scene, flex_of, rigid_of};
use super::surface::{
    Cone, SurfacePoint, closest_surface_point, faced_at_start, faces, facing_point,
};
use crate::constraint::geometry::{Feature, RESTING, faced_separation, separation};
use crate::math::{Vec2, perp, rotation};
use crate::system::{FlexBlock, Point, RigidBlock};

impl Candidate {
    /// Gap and rows in the current configuration, as the law counts them; `None` when the target is out of reach.
    pub fn evaluate(&self, scene: &Scene<'_>, remembered: &Remembered) -> Option<Kinematics> {
        let mut found = self.measure(scene, remembered)?;
        found.gap -= self.law.skin;
        if let Some(Direction { normal, gap }) = self.law.direction {
            // Geometry knows no gap along a direction of the user's: it changes as the points move.
            let moved = found.relative(scene.blocks, |block, grip| block.displacement(grip));
            found.normal = normal;
            found.gap = gap.map_or(found.gap, |gap| gap + normal.dot(&moved));
        }
        Some(found)
    }

    /// Whether the point of a pair with a flexible body was outside the surface that it is `found` at, by no less than `-slop`, when
    /// the step began. Unlike the motion since then it does not depend on the iterate.
    pub fn began_outside(&self, scene: &Scene<'_>, found: &Kinematics, slop: f64) -> bool {
        let start = |block: usize, point| scene.blocks[block].start_position(point);
        let (point, radius) = match self.pair {
            Pair::NodeOnPart { node, rigid, part } => {
                let (placed, Some(motion)) = (&scene.parts[part], rigid_of(scene, rigid)) else {
                    return false;
                };
                let arm = motion.start().arm(start(node.0, Point::Node(node.1)));
                let local = placed.pose.inverse_transform(arm);
                let before = separation(&placed.part, local, None, None);
                return before.distance - self.law.skin >= -slop;
            }
            Pair::VertexOnSurface {
                rigid, arm, radius, ..
            } => (start(rigid, Point::Arm(arm)), radius),
            Pair::NodeOnSurface { node, .. } => (start(node.0, Point::Node(node.1)), 0.0),
            _ => return false,
        };
        let [_, a, b] = found.attachments() else {
            return false;
        };
        let (from, to) = (start(a.block, a.grip.point), start(b.block, b.grip.point));
        let outward = -perp(to - from).normalize();
        outward.dot(&(point - from)) - radius - self.law.skin >= -slop
    }

    fn measure(&self, scene: &Scene<'_>, remembered: &Remembered) -> Option<Kinematics> {
        match self.pair {
            Pair::NodeOnPart { node, rigid, part } => {
                node_on_part(scene, node, rigid, &scene.parts[part], remembered.feature)
            }
            Pair::VertexOnSurface {
                rigid,
                arm,
                radius,
                cone,
                flex,
                segments,
            } => {
                let point = scene.blocks[rigid].position(Point::Arm(arm));
                let start = scene.blocks[rigid].start_position(Point::Arm(arm));
                // What is round has a candidate for each segment, or one for all if it begins inside.
                let is_of_one = radius > 0.0 && segments.1 == segments.0 + 1;
                let hit = if is_of_one {
                    facing_point(
                        flex_of(scene, flex)?,
                        &scene.segments[segments.0..segments.1],
                        point,
                        start,
                    )
                } else {
                    let turn = rotation(rigid_of(scene, rigid)?.current().angle);
                    let cone = cone.map(|Cone(normals)| Cone(normals.map(|normal| turn * normal)));
                    surface_of(scene, flex, segments, [point, start], cone)
                }?;
                let position = point - hit.distance * hit.normal;
                // The arm of the force ends where the force acts, on the flexible surface.
                let held = Point::Arm(rigid_of(scene, rigid)?.current().arm(position));
                Some(on_surface(
                    scene,
                    (rigid, held),
                    flex,
                    &hit,
                    radius,
                    position,
                ))
            }
            Pair::NodeOnSurface {
                node: (block, node, segment),
                flex,
                segments,
            } => {
                let point = scene.blocks[block].position(Point::Node(node));
                let start = scene.blocks[block].start_position(Point::Node(node));
                let cone = Cone::of_node(flex_of(scene, block)?, segment);
                let hit = surface_of(scene, flex, segments, [point, start], Some(cone))?;
                Some(on_surface(
                    scene,
                    (block, Point::Node(node)),
                    flex,
                    &hit,
                    0.0,
                    point,
                ))
            }
            Pair::PointOnFace {
                point,
                face,
                ends,
                radius,
            } => point_on_face(scene, point, face, ends, radius),
            Pair::VertexOnPart { .. } => vertex_on_part(scene, &self.pair),
            Pair::Crossing { blocks, parts } => crossing(scene, blocks, parts),
            Pair::Astray { point, target } => {
                let place = scene.blocks[point.0].position(point.1);
                let [one, other] = target.map(|(block, held, weight)| (block, held, -weight));
                let grips = [(point.0, point.1, 1.0), one, other];
                let n_held = if other.2 < 0.0 { 3 } else { 2 };
                // The law knows the direction.
                Some(Kinematics::new(
                    scene,
                    0.0,
                    Vec2::y(),
                    place,
                    &grips[..n_held],
                ))
            }
            // The path knows; what it lists no more is not near.
            Pair::Near { .. } => None,
        }
    }
}

fn node_on_part(
    scene: &Scene<'_>,
    (block, node, segment): (usize, usize, usize),
    rigid: usize,
    placed: &PlacedPart,
    reference: Option<Feature>,
) -> Option<Kinematics> {
    let motion = rigid_of(scene, rigid)?;
    let point = scene.blocks[block].position(Point::Node(node));
    let start = scene.blocks[block].start_position(Point::Node(node));
    let arm = motion.current().arm(point);
    let local = placed.pose.inverse_transform(arm);
    let local_start = placed.pose.inverse_transform(motion.start().arm(start));
    let body = flex_of(scene, block)?;
    let reference = reference.or_else(|| buried_face(placed, motion, body, local_start));
    let in_world = |normal: Vec2| rotation(motion.current().angle) * placed.pose.rotate(normal);
    let mut found = separation(&placed.part, local, reference, Some(local_start));
    let is_sharp_vertex =
        matches!(found.feature, Feature::Vertex(_)) && placed.part.radius() == 0.0;
    if !faces(body, segment, in_world(found.normal), is_sharp_vertex) {
        found = faced_separation(&placed.part, local, local_start, |normal| {
            faces(body, segment, in_world(normal), false)
        })?;
    }
    let normal = in_world(found.normal);
    if found.distance < 0.0 {
        // What comes through the body from behind has been met on its other side.
        let before = separation(&placed.part, local_start, reference, None);
        let towards = rotation(motion.start().angle) * placed.pose.rotate(before.normal);
        if before.distance > 0.0 && !faced_at_start(body, segment, towards) {
            return None;
        }
    }
    let grips = [
        (block, Point::Node(node), 1.0),
        (rigid, Point::Arm(arm), -1.0),
    ];
    let mut kinematics = Kinematics::new(scene, found.distance, normal, point, &grips);
    kinematics.feature = Some(found.feature);
    Some(kinematics)
}

/// The face by which a body that was put into a part leaves it: the nearest to the body's centre, one for all its nodes, or
/// they would be pulled apart. `None` for nodes that begin the step outside.
fn buried_face(
    placed: &PlacedPart,
    motion: &RigidBlock,
    body: &FlexBlock,
    node: Vec2,
) -> Option<Feature> {
    let before = separation(&placed.part, node, None, None);
    if before.distance > -RESTING * placed.part.width() {
        return None;
    }
    let centre = motion.start().arm(body.start_centre()?);
    let nearest = separation(
        &placed.part,
        placed.pose.inverse_transform(centre),
        None,
        None,
    );
    Some(nearest.feature).filter(|feature| matches!(feature, Feature::Face(_)))
}

fn surface_of(
    scene: &Scene<'_>,
    flex: usize,
    segments: (usize, usize),
    path: [Vec2; 2],
    cone: Option<Cone>,
) -> Option<SurfacePoint> {
    closest_surface_point(
        flex_of(scene, flex)?,
        &scene.segments[segments.0..segments.1],
        path,
        cone,
    )
}

fn on_surface(
    scene: &Scene<'_>,
    (block, held): (usize, Point),
    flex: usize,
    hit: &SurfacePoint,
    radius: f64,
    position: Vec2,
) -> Kinematics {
    let [first, second] = match flex_of(scene, flex) {
        Some(target) => target.model().mesh().boundary().segments()[hit.segment],
        None => [0, 0],
    };
    let point = (block, held, 1.0);
    let gap = hit.distance - radius;
    if hit.xi <= 0.0 || hit.xi >= 1.0 {
        let node = if hit.xi <= 0.0 { first } else { second };
        return Kinematics::new(
            scene,
            gap,
            hit.normal,
            position,
            &[point, (flex, Point::Node(node), -1.0)],
        );
    }
    let grips = [
        point,
        (flex, Point::Node(first), hit.xi - 1.0),
        (flex, Point::Node(second), -hit.xi),
    ];
    Kinematics::new(scene, gap, hit.normal, position, &grips)
}
