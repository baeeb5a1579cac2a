//! Where the nodes of a body are as it is built, and where they would be without stress.

use super::error::BuildError;
use crate::fe::mesh::Mesh;
use crate::math::{Vec2, is_held, rotation};

/// The nodes in the world's axes, interleaved (m), of the body that is the mesh when it is stretched so along the axes of the mesh.
///
/// - `pose`: turn of the mesh about its origin (rad), and where its origin is (m).
pub(super) fn placed(mesh: &Mesh, pose: (f64, Vec2), stretches: [f64; 2]) -> Vec<f64> {
    let about = middle(mesh.nodes());
    let turn = rotation(pose.0);
    let place = |node: &[f64; 2]| {
        // Not shrunk: to the last digit as it is drawn.
        let own =
            |axis: usize| node[axis] - (1.0 - 1.0 / stretches[axis]) * (node[axis] - about[axis]);
        let placed = turn * Vec2::new(own(0), own(1)) + pose.1;
        [placed.x, placed.y]
    };
    mesh.nodes().iter().flat_map(place).collect()
}

/// The middle of the box around points (m).
fn middle(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let along = points.iter().map(|point| point[axis]);
        let ends = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        0.5 * ends[0] + 0.5 * ends[1]
    })
}

/// Refuses nodes that rapier's precision cannot hold.
pub(super) fn check_places(placed: &[f64]) -> Result<(), BuildError> {
    let place = |node: usize| [placed[2 * node], placed[2 * node + 1]];
    let is_lost = |&node: &usize| !place(node).into_iter().all(is_held);
    match (0..placed.len() / 2).find(is_lost) {
        Some(node) => Err(BuildError::Place {
            node,
            place: place(node),
        }),
        None => Ok(()),
    }
}

/// Refuses stretches that leave a stress-free shape beyond what rapier's precision can hold.
pub(super) fn check_unstretched(rest: &[f64]) -> Result<(), BuildError> {
    match rest.iter().find(|x| !is_held(**x)) {
        Some(&value) => Err(BuildError::Number {
            name: "a coordinate of the stress-free shape",
            value,
            cure: "give a pre-stretch nearer to one",
        }),
        None => Ok(()),
    }
}
