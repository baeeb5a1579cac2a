//! Contacts that joints hold: bodies that are fixed to each other cannot press each other.
//!
//! Where joints leave two bodies no relative motion, forces of any size at their contacts change nothing, and rounding decides: of two welded
//! boxes in a tower 10⁹ N were found, and 10¹¹ m/s² in the stored accelerations. Such contacts are left out of the problem; the joint keeps
//! the bodies where they are.
//!
//! Whether there is such a motion is asked of joints that are closed: anchors that are apart, as they are within a step, would give the
//! motion of their distance.

use super::ActiveJoint;
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, JointLaw, unit_wrench};
use crate::math::{Vec2, cross, rounding};
use crate::system::Block;

/// Share of its own mobility below which a row is held by others already (-): exact rows leave rounding, and what moves at all moves by levers
/// of the size of the bodies.
const DEPENDENT: f64 = rounding::SHARE;

/// Wrenches on the two bodies of a contact.
type Pair = [[f64; 3]; 2];

/// Joints and what they hold on to.
pub(super) struct JointHold<'a> {
    pub blocks: &'a [Block],
    pub ties: &'a [ActiveJoint],
    pub grips: &'a [JointGrip],
}

impl JointHold<'_> {
    /// Whether joints leave the two rigid bodies of a contact no motion against each other.
    pub fn holds(&self, row: &Kinematics) -> bool {
        if self.ties.is_empty() {
            return false;
        }
        let mut bodies = [None; 2];
        // A force along the normal, one across it, and a couple: all that can be between two bodies.
        let mut between = [Pair::default(); 3];
        let point = self.middle(row.attachments().iter().map(|a| (a.block, a.grip.lever)));
        for a in row.attachments() {
            let Block::Rigid(block) = &self.blocks[a.block] else {
                return false;
            };
            if block.is_prescribed() {
                continue;
            }
            let is_its = |body: &Option<usize>| body.is_none_or(|body| body == a.block);
            let Some(slot) = bodies.iter().position(is_its) else {
                return false;
            };
            bodies[slot] = Some(a.block);
            let forces = [row.normal, row.tangent()].map(|along| a.weight * along);
            let lever = point - self.blocks[a.block].centre();
            let wrenches = [
                [forces[0].x, forces[0].y, cross(lever, forces[0])],
                [forces[1].x, forces[1].y, cross(lever, forces[1])],
                [0.0, 0.0, a.weight],
            ];
            for (pair, wrench) in between.iter_mut().zip(wrenches) {
                for (sum, value) in pair[slot].iter_mut().zip(wrench) {
                    *sum += value;
                }
            }
        }
        // Two bodies move in six ways.
        let mut held: [Pair; 6] = Default::default();
        let mut n_held = 0;
        for index in 0..self.ties.len() {
            let is_rigid = matches!(self.ties[index].row.law, JointLaw::Rigid { .. });
            if n_held == held.len() || !is_rigid || !self.ties[index].is_movable {
                continue;
            }
            if let Some(wrench) = self.joint_wrench(index, &bodies)
                && let Some(unit) = self.independent(&bodies, wrench, &held[..n_held])
            {
                held[n_held] = unit;
                n_held += 1;
            }
        }
        let is_left = |wrench| self.independent(&bodies, wrench, &held[..n_held]).is_some();
        n_held > 0 && !between.into_iter().any(is_left)
    }

    /// What others do not hold of a wrench, of unit mobility; `None` if that is rounding.
    fn independent(
        &self,
        bodies: &[Option<usize>; 2],
        mut wrench: Pair,
        others: &[Pair],
    ) -> Option<Pair> {
        let whole = self.mobility_of(bodies, &wrench, &wrench);
        // What rounding leaves of the others goes the second time.
        for other in others.iter().chain(others) {
            let part = self.mobility_of(bodies, &wrench, other);
            for (value, other) in wrench.iter_mut().flatten().zip(other.iter().flatten()) {
                *value -= part * other;
            }
        }
        let left = self.mobility_of(bodies, &wrench, &wrench);
        let unit = 1.0 / left.sqrt();
        (left > DEPENDENT * whole).then(|| wrench.map(|body| body.map(|value| unit * value)))
    }

    /// The middle of places on blocks, which levers lead to from their centres (m).
    fn middle(&self, levers: impl ExactSizeIterator<Item = (usize, Vec2)>) -> Vec2 {
        let n = levers.len().max(1) as f64;
        let places = levers.map(|(block, lever)| self.blocks[block].centre() + lever);
        places.sum::<Vec2>() / n
    }

    /// The wrench of a joint row on two bodies once it is closed; `None` if it holds anything else that moves.
    fn joint_wrench(&self, tie: usize, bodies: &[Option<usize>; 2]) -> Option<Pair> {
        let tie = &self.ties[tie];
        let is_turn = tie.row.measure.is_turn();
        let mut sum = Pair::default();
        let grips = &self.grips[tie.row.grips.0..tie.row.grips.1];
        let point = self.middle(grips.iter().map(|grip| (grip.block, grip.lever)));
        for grip in grips {
            if let Some(slot) = bodies.iter().position(|body| *body == Some(grip.block)) {
                let lever = point - self.blocks[grip.block].centre();
                let closed = JointGrip { lever, ..*grip };
                let wrench = unit_wrench(&closed, tie.direction, is_turn);
                for (sum, value) in sum[slot].iter_mut().zip(wrench) {
                    *sum += value;
                }
            } else if !matches!(&self.blocks[grip.block], Block::Rigid(block) if block.is_prescribed())
            {
                return None;
            }
        }
        Some(sum)
    }

    /// What one pair of unit wrenches moves along another (1/kg).
    fn mobility_of(&self, bodies: &[Option<usize>; 2], one: &Pair, other: &Pair) -> f64 {
        let moved = bodies.iter().zip(one.iter().zip(other));
        let terms = moved.map(
            |(body, (one, other))| match body.map(|at| &self.blocks[at]) {
                Some(Block::Rigid(block)) => block.mobility_between(*one, *other),
                _ => 0.0,
            },
        );
        terms.sum()
    }
}
