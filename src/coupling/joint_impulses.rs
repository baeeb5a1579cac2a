//! Impulses that a step leaves on rapier's joints.

use super::joints::slot;
use super::sets::RapierSets;
use crate::rapier::math::Real;
use crate::rapier::prelude::*;

/// An impulse to leave on a joint of rapier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointImpulse {
    /// The joint.
    pub handle: ImpulseJointHandle,
    /// Which of its rows.
    pub row: u32,
    /// Whether it acted along an axis of the world instead of the first frame's.
    pub is_world: bool,
    /// Along the growing coordinate, over the whole step (N s or N m s).
    pub impulse: f64,
}

/// Leaves the impulses on rapier's joints as rapier would: of one substep, positive on the first body.
pub(crate) fn write_impulses(impulses: &[JointImpulse], sets: &mut RapierSets<'_>) {
    let n_substeps = sets.integration_parameters.num_solver_iterations.max(1) as f64;
    let mut last = None;
    for note in impulses {
        let Some(joint) = sets.impulse_joints.get_mut(note.handle, false) else {
            continue;
        };
        if last.replace(note.handle) != Some(note.handle) {
            joint.impulses = Default::default();
            joint
                .data
                .limits
                .iter_mut()
                .for_each(|limit| limit.impulse = 0.0);
            joint
                .data
                .motors
                .iter_mut()
                .for_each(|motor| motor.impulse = 0.0);
        }
        let value = -note.impulse / n_substeps;
        let (kind, axis) = (note.row / 4 * 4, (note.row % 4) as usize);
        match kind {
            slot::LOCKED if note.is_world => {
                let Some(body) = sets.bodies.get(joint.body1()) else {
                    continue;
                };
                let turn = (*body.rotation()) * joint.data.local_frame1.rotation;
                let axes = [turn * Vector::X, turn * Vector::Y];
                for (at, along) in axes.iter().enumerate() {
                    let part = if axis == 0 { along.x } else { along.y };
                    joint.impulses[at] += part * value as Real;
                }
            }
            slot::LOCKED => joint.impulses[axis] = value as Real,
            slot::MOTOR => joint.data.motors[axis].impulse = value as Real,
            _ => joint.data.limits[axis].impulse += value as Real,
        }
    }
}
