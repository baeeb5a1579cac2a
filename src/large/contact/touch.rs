//! What a node does at an obstacle, and the equations that take the place of its own.

use super::obstacle::{Beside, Obstacle};
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{Vec2, node_vec, perp};

/// Where a node is held by an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The node.
    pub node: usize,
    /// The obstacle, by its place in the list.
    pub obstacle: usize,
    /// Where the node is (m).
    pub position: [f64; 2],
    /// Out of the obstacle, of length one.
    pub normal: [f64; 2],
    /// Along the normal on the body (N).
    pub normal_force: f64,
    /// To the left of the normal on the body (N).
    pub friction_force: f64,
    /// Whether it has not slid in the last increment.
    pub sticks: bool,
}

/// How a node is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hold {
    Open,
    Sticks,
    /// The sign of its friction, to the left of the normal positive.
    Slides(f64),
}

/// A node of the surface and the obstacle next to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) node: usize,
    pub(super) obstacle: usize,
    pub(super) hold: Hold,
    /// Where the node was as the increment began (m), and how far the obstacle had gone.
    began: Vec2,
    began_gone: Vec2,
    /// The one direction in which a node that is held in the other is free.
    free_axis: Option<usize>,
}

/// A node beside its obstacle, with what holds it there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub(super) beside: Beside,
    /// To the left of the normal.
    pub(super) along: Vec2,
    /// `λ` and `t` (N).
    pub(super) force: f64,
    pub(super) friction: f64,
    /// The slip since the increment began (m), and its rate along the obstacle (-).
    slip: f64,
    slip_rate: f64,
}

impl Touch {
    /// A node of which these directions are held; none of those that cannot move.
    pub(super) fn new(node: usize, [x, y]: [bool; 2]) -> Option<Self> {
        let free_axis = match (x, y) {
            (true, true) => return None,
            (false, false) => None,
            (true, false) => Some(1),
            (false, true) => Some(0),
        };
        Some(Self {
            node,
            obstacle: 0,
            hold: Hold::Open,
            began: Vec2::zeros(),
            began_gone: Vec2::zeros(),
            free_axis,
        })
    }

    /// Notes where an increment begins, for the obstacle that is nearest there.
    pub(super) fn begin(&mut self, obstacles: &[Obstacle], positions: &[f64], share: f64) {
        self.began = node_vec(positions, self.node);
        self.choose(obstacles, positions, share);
        self.began_gone = obstacles
            .get(self.obstacle)
            .map_or(Vec2::zeros(), |one| one.gone(share));
    }

    /// An open node looks for the nearest obstacle.
    fn choose(&mut self, obstacles: &[Obstacle], positions: &[f64], share: f64) {
        if self.hold != Hold::Open {
            return;
        }
        let place = node_vec(positions, self.node);
        let gaps = obstacles
            .iter()
            .map(|one| one.beside(place, share).gap)
            .enumerate();
        if let Some((nearest, _)) = gaps.min_by(|a, b| a.1.total_cmp(&b.1)) {
            self.obstacle = nearest;
        }
    }

    /// The node at `positions`, with the residual there.
    pub(super) fn look(
        &self,
        obstacles: &[Obstacle],
        positions: &[f64],
        residual: &[f64],
        share: f64,
    ) -> Held {
        let place = node_vec(positions, self.node);
        let obstacle = &obstacles[self.obstacle];
        let beside = obstacle.beside(place, share);
        let along = perp(beside.normal);
        let left = node_vec(residual, self.node);
        let way = place - self.began - (obstacle.gone(share) - self.began_gone);
        let (force, friction) = match self.free_axis {
            // What is held across takes the rest of an oblique force.
            Some(axis) => (-left[axis] / beside.normal[axis], 0.0),
            None => (-beside.normal.dot(&left), -along.dot(&left)),
        };
        Held {
            beside,
            along,
            force,
            friction,
            slip: along.dot(&way),
            slip_rate: 1.0 - beside.curvature * beside.normal.dot(&way),
        }
    }

    /// Whether a node that is held in one direction can be kept out along the other: nearer to the normal than to the obstacle.
    fn is_kept_out(&self, normal: Vec2) -> bool {
        self.free_axis
            .is_none_or(|axis| normal[axis].abs() >= normal[1 - axis].abs())
    }

    /// Looks which equations hold, up to a force (N) and a way (m) that count for nothing; returns whether others do than before.
    ///
    /// Without these a flat part that lies on an obstacle and presses nowhere would open and close by rounding for ever. Where forces tell nothing yet,
    /// `no_force` without end, what touches is held: the obstacle may be all that holds the body.
    pub(super) fn revise(
        &mut self,
        obstacles: &[Obstacle],
        positions: &[f64],
        residual: &[f64],
        share: f64,
        [no_force, no_way]: [f64; 2],
    ) -> bool {
        self.choose(obstacles, positions, share);
        let held = self.look(obstacles, positions, residual, share);
        let friction = obstacles[self.obstacle].friction();
        let slides = self.free_axis.is_some() || friction == 0.0;
        let most = friction * held.force.max(0.0) + no_force;
        let touching = if no_force.is_finite() {
            -no_way
        } else {
            no_way
        };
        let closes = held.beside.gap < touching;
        let next = match self.hold {
            Hold::Open if closes && self.is_kept_out(held.beside.normal) => match slides {
                true => Hold::Slides(0.0),
                // What has come along slides on: held back to where it came from it would pull, let go and close again for ever.
                false if no_force.is_finite() && held.slip.abs() > no_way => {
                    Hold::Slides(-held.slip.signum())
                }
                false => Hold::Sticks,
            },
            Hold::Open => Hold::Open,
            // What sticks pulls as long as it is held where it came from: whether it would press where it could slide to is seen there.
            Hold::Sticks if held.friction.abs() > most => Hold::Slides(held.friction.signum()),
            _ if held.force < -no_force => Hold::Open,
            Hold::Slides(sign) if sign * held.slip > no_way => Hold::Sticks,
            other => other,
        };
        let has_changed = next != self.hold;
        self.hold = next;
        has_changed
    }

    /// What is out of balance at a node that is held: the force (N) and the gap or slip (m).
    pub(super) fn residual(&self, held: &Held, friction: f64) -> [f64; 2] {
        match self.hold {
            Hold::Open => [0.0; 2],
            Hold::Sticks => [0.0, held.beside.gap.abs().max(held.slip.abs())],
            Hold::Slides(_) if self.free_axis.is_some() => [0.0, held.beside.gap.abs()],
            Hold::Slides(sign) => {
                let left = held.friction - sign * friction * held.force;
                [left.abs(), held.beside.gap.abs()]
            }
        }
    }

    /// Puts the equations of a held node in the place of its own: in its rows of the matrix, and in the right-hand side.
    pub(super) fn write(
        &self,
        held: &Held,
        friction: f64,
        matrix: &mut BlockMatrix,
        right: &mut [f64],
    ) {
        let sign = match self.hold {
            Hold::Open => return,
            Hold::Sticks => 0.0,
            Hold::Slides(sign) => sign,
        };
        let (normal, along) = (held.beside.normal, held.along);
        let node = self.node;
        // Conditions on places are as large as the stiffness of the node.
        let own = matrix.block(node, node).copied().unwrap_or_default();
        let scale = own[0].abs() + own[3].abs();
        let out = [scale * normal.x, scale * normal.y, -scale * held.beside.gap];
        if let Some(axis) = self.free_axis {
            replace(matrix, node, axis, None, [out[0], out[1]]);
            right[2 * node + axis] = out[2];
            return;
        }
        let (direction, second) = match self.hold {
            Hold::Sticks => {
                let rate = scale * held.slip_rate;
                let row = [rate * along.x, rate * along.y];
                (None, (row, -scale * held.slip))
            }
            _ => {
                // h = (τ + c n)·r with the turning of both along the obstacle.
                let share = -sign * friction;
                let direction = along + share * normal;
                let turning = held.beside.curvature * (held.force - share * held.friction);
                let row = [-turning * along.x, -turning * along.y];
                let left = direction.dot(&node_vec(right, node));
                (Some(direction), (row, left))
            }
        };
        replace(matrix, node, 1, direction, second.0);
        replace(matrix, node, 0, None, [out[0], out[1]]);
        right[2 * node] = out[2];
        right[2 * node + 1] = second.1;
    }
}

/// Makes a row of a node the combination of both by a direction, or nothing, and adds to it at the node itself.
fn replace(
    matrix: &mut BlockMatrix,
    node: usize,
    row: usize,
    direction: Option<Vec2>,
    own: [f64; 2],
) {
    for place in 0..matrix.neighbours(node).len() {
        let other = matrix.neighbours(node)[place] as usize;
        if let Some(block) = matrix.block_mut(node, other) {
            for column in 0..2 {
                let mixed =
                    direction.map_or(0.0, |d| d.x * block[column] + d.y * block[2 + column]);
                block[2 * row + column] = mixed;
                if other == node {
                    block[2 * row + column] += own[column];
                }
            }
        }
    }
}
