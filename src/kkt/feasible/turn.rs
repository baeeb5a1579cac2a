//! How normals turn within a step.

use super::FeasiblePath;
use crate::math::{Vec2, angle_between};
use crate::path::{NearPair, Target};
use crate::system::Block;

/// By how much the normal of a near pair has turned since the step began (rad): with the edge, or with the line between the points.
pub(in crate::kkt) fn turn(path: &FeasiblePath, near: &NearPair, blocks: &[Block]) -> f64 {
    let [own, met] = path.blocks_of(near).map(|block| &blocks[block]);
    let line = |[from, to]: [(&Block, usize); 2]| -> [Vec2; 2] {
        let [from, to] = [from, to].map(|(block, at)| {
            let point = path.points[at].point;
            [block.start_position(point), block.position(point)]
        });
        [to[0] - from[0], to[1] - from[1]]
    };
    let [before, after] = match near.target {
        Target::Edge(edge) => line(path.surfaces.edges()[edge].map(|end| (met, end as usize))),
        Target::Vertex(vertex) => line([(met, vertex), (own, near.point)]),
    };
    angle_between(before, after)
}

/// Where the points of a near pair are, of the first and of what it is near to (m); none of an edge.
pub(in crate::kkt) fn points_of(
    path: &FeasiblePath,
    near: &NearPair,
    blocks: &[Block],
) -> [Option<Vec2>; 2] {
    let [own, met] = path.blocks_of(near).map(|block| &blocks[block]);
    let place = |block: &Block, at: usize| block.position(path.points[at].point);
    let other = match near.target {
        Target::Vertex(vertex) => Some(place(met, vertex)),
        Target::Edge(_) => None,
    };
    [Some(place(own, near.point)), other]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{ContactLaw, Owner};
    use crate::kkt::feasible::Way;
    use crate::math::{perp, rotation};
    use crate::path::samples::Random;
    use crate::system::{RigidBlock, RigidMotion};

    const ROUND: f64 = 0.2;

    /// A ball at rest, and a rod whose corners or side are at a distance from it, before and after; the rod goes on half a turn about it.
    fn around_ball(turned: f64, from: f64, is_side: bool) -> (FeasiblePath, [Block; 2], Vec2) {
        let ball = RigidMotion::default();
        // Its place along the rod, from the middle of it.
        let foot = if is_side { 0.1 } else { 0.5 };
        let rod = |angle: f64| RigidMotion {
            centre: rotation(angle) * Vec2::new(-foot, ROUND),
            angle,
            ..RigidMotion::default()
        };
        let (start, end) = (rod(from), rod(from + turned));
        let moved = end.point(Vec2::new(foot, 0.0)) - start.point(Vec2::new(foot, 0.0));
        let mut turning = RigidBlock::prescribed(start, end);
        turning.set_position_increment([0.0; 3]);
        let blocks = [
            Block::Rigid(RigidBlock::prescribed(ball, ball)),
            Block::Rigid(turning),
        ];
        let none = Vec2::zeros();
        let ends = [-0.5, 0.5].map(|x| Vec2::new(x, 0.0));
        let mut path = FeasiblePath::default();
        let centre = path.rigid_member(0, &blocks, 0, [ROUND; 2], &[(0, none, none)], &[]);
        let ends = [(0, ends[0], none), (1, ends[1], none)];
        let rod = path.rigid_member(1, &blocks, 0, [0.0; 2], &ends, &[[0, 1]]);
        path.add_way(Way {
            members: [centre, rod],
            owners: [Owner::Collider(0), Owner::Collider(1)],
            law: ContactLaw::default(),
            places: (0, 0),
            closing: ROUND,
            margin: ROUND,
            reach: 0.1,
        });
        path.rest(&blocks);
        path.list_near();
        (path, blocks, moved)
    }

    /// What goes around a ball has gone along the tangent halfway: a force along the normal there does no work.
    #[test]
    fn along_the_normal_halfway_nothing_is_done_on_what_goes_around_a_ball() {
        let mut random = Random::new(5);
        for k in 0..200 {
            let (turned, from, is_side) = (random.within(1.0), random.within(3.0), k % 2 == 0);
            let (path, blocks, moved) = around_ball(turned, from, is_side);
            let is_met = |near: &&NearPair| matches!(near.target, Target::Edge(_)) == is_side;
            let Some(near) = path.near().iter().find(is_met) else {
                panic!("no near pair of {turned}, {from}, {is_side}");
            };
            let found = turn(&path, near, &blocks);
            assert!((found - turned).abs() < 1e-12, "{found} rad, not {turned}");
            // Towards the ball, from the rod at the end.
            let end = rotation(from + turned) * Vec2::new(0.0, -1.0);
            let halfway = rotation(-0.5 * found) * end;
            assert!(halfway.dot(&moved).abs() < 1e-12);
            assert!((perp(halfway).dot(&moved).abs() - moved.norm()).abs() < 1e-12);
        }
    }
}
