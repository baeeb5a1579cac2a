//! The part of a way on which bodies go as straight as what is known of them.

use super::{FeasiblePath, SurfacePoint, angle_of};
use crate::math::{Vec2, judged::Judged};
use crate::system::{Block, Point};

/// Turn of a member with near pairs within a pass (rad): rows are straight where arcs are not.
pub(super) const MOST_TURN: Judged = Judged::new("kkt::MOST_TURN", 0.5);

/// The part of the way on which no block with near pairs turns too far, and blocks of large strain may go.
pub(super) fn straight_part(path: &FeasiblePath, blocks: &[Block]) -> f64 {
    let mut part = part_of_cells(blocks);
    for near in &path.near {
        let way = &path.ways[near.pair];
        for member in way.members {
            if is_round(path, member) {
                continue;
            }
            let block = path.carriers[member].block;
            let turn = (angle_of(&blocks[block]) - path.base[block].angle()).abs();
            if turn > MOST_TURN {
                part = part.min(MOST_TURN / turn);
            }
        }
    }
    part
}

/// Whether turning changes nothing of a member: it is the centre of its body.
fn is_round(path: &FeasiblePath, member: usize) -> bool {
    let points = path.surfaces.members()[member].points.clone();
    let is_centre = |own: &SurfacePoint| match own.point {
        Point::Arm(arm) => arm == Vec2::zeros(),
        Point::Node(_) => false,
    };
    path.points[points].iter().all(is_centre)
}

/// The part of the way on which no cell of a block of large strain turns over, as far as it has looked.
fn part_of_cells(blocks: &[Block]) -> f64 {
    blocks.iter().fold(1.0, |part, block| match block {
        Block::Flex(body) => part.min(body.part_ahead()),
        Block::Rigid(_) => part,
    })
}
