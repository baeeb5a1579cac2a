//! Nodal forces that turn with a line of the body.

use crate::linalg::lu::Entry;
use crate::math::{Vec2, node_vec, perp};

/// A force on a node in axes that turn with the line between two nodes, as of a nozzle.
///
/// `f = a e + b n` with `e` along the line and `n` to the left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowerForce {
    /// The node it acts on.
    pub node: usize,
    /// From and to which node the line goes.
    pub line: [usize; 2],
    /// Along the line and to the left of it (N), at the load factor one.
    pub force: [f64; 2],
}

impl FollowerForce {
    fn axes(&self, positions: &[f64]) -> (Vec2, Vec2, f64) {
        let line = node_vec(positions, self.line[1]) - node_vec(positions, self.line[0]);
        let length = line.norm();
        let along = line / length;
        (along, perp(along), length)
    }

    /// The force at these positions (N); not finite where the line has no length.
    pub(super) fn at(&self, positions: &[f64]) -> Vec2 {
        let (along, across, _) = self.axes(positions);
        self.force[0] * along + self.force[1] * across
    }

    /// Lists `scale ∂f/∂x`: as `de = n (n·dd)/|d|` and `dn = -e (n·dd)/|d|`, it is `(a n - b e) (n·dd)/|d|`.
    pub(super) fn list_derivative(&self, scale: f64, positions: &[f64], entries: &mut Vec<Entry>) {
        let (along, across, length) = self.axes(positions);
        let turned = self.force[0] * across - self.force[1] * along;
        for (sign, end) in [(-1.0, self.line[0]), (1.0, self.line[1])] {
            for row in 0..2 {
                for column in 0..2 {
                    entries.push(Entry {
                        row: 2 * self.node + row,
                        column: 2 * end + column,
                        value: scale * sign * turned[row] * across[column] / length,
                    });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_derivative_is_that_of_the_force() {
        let follower = FollowerForce {
            node: 1,
            line: [2, 0],
            force: [1.3, -0.4],
        };
        let positions = [0.3, -0.2, 5.0, 6.0, 1.1, 0.7];
        let mut entries = Vec::new();
        follower.list_derivative(-2.0, &positions, &mut entries);
        for dof in 0..6 {
            let at = |step: f64| {
                let mut moved = positions;
                moved[dof] += step;
                follower.at(&moved)
            };
            let slope = -2.0 * (at(1e-5) - at(-1e-5)) / 2e-5;
            for axis in 0..2 {
                let listed = entries.iter();
                let listed = listed.filter(|e| (e.row, e.column) == (2 + axis, dof));
                let sum: f64 = listed.map(|e| e.value).sum();
                assert!((sum - slope[axis]).abs() < 1e-9, "{sum} {slope}");
            }
        }
        let size = follower.at(&positions).norm();
        assert!((size - 1.3f64.hypot(0.4)).abs() < 1e-15);
    }
}
