//! Claiming along multibodies: with one link all of them are claimed.

use super::filter::is_movable;
use super::members::Members;
use super::multibody::free_axes;
use super::sets::RapierSets;
use crate::math::{HashMap, HashSet};
use crate::rapier::prelude::*;

/// The multibodies of claimed links.
#[derive(Debug, Default)]
pub(super) struct ClaimedMultibodies {
    /// In the order they were reached.
    taken: Vec<MultibodyIndex>,
    known: HashSet<MultibodyIndex>,
    /// What all motion that a coordinate makes weighs, of those with motors that count in it (kg or kg m²).
    weights: HashMap<MultibodyIndex, Vec<f64>>,
}

impl ClaimedMultibodies {
    /// Begins with none.
    pub fn clear(&mut self) {
        self.taken.clear();
        self.known.clear();
        self.weights.clear();
    }

    /// All of them, in the order they were reached.
    pub fn as_slice(&self) -> &[MultibodyIndex] {
        &self.taken
    }

    /// Claims the multibody of a claimed body, if it is a link.
    pub fn take_up(&mut self, sets: &RapierSets<'_>, body: RigidBodyHandle, members: &mut Members) {
        let joints = &*sets.multibody_joints;
        let Some(index) = joints.rigid_body_link(body).map(|link| link.multibody) else {
            return;
        };
        let Some(multibody) = joints.get_multibody(index) else {
            return;
        };
        if !self.known.insert(index) {
            return;
        }
        self.taken.push(index);
        // Rapier moves all coordinates of a multibody together, so its links are solved together, also where their root stands still.
        let first = members.claim(body);
        for link in multibody.links() {
            let handle = link.rigid_body_handle();
            // Whom it dominates it feels where another link of the same multibody does.
            if sets.bodies.get(handle).is_some_and(is_movable) {
                let member = members.claim(handle);
                members.unite(first, member);
            }
        }
    }

    /// Weighs the coordinates of multibodies whose motors count per what they move. What rapier has not stepped yet gets the coordinates that it will
    /// have: until then the root has some though it does not move.
    pub fn prepare(&mut self, sets: &mut RapierSets<'_>) {
        for &index in &self.taken {
            let Some(multibody) = sets.multibody_joints.get_multibody_mut_internal(index) else {
                continue;
            };
            if multibody.body_jacobian(0).ncols() != multibody.ndofs() {
                multibody.forward_kinematics(sets.bodies, true);
            }
            let counts = |link: &MultibodyLink| {
                let data = &link.joint().data;
                let mut axes = free_axes(link);
                axes.any(|(axis, _)| {
                    let is_on = data.motor_axes.bits() >> axis & 1 == 1;
                    is_on && data.motors[axis].model == MotorModel::AccelerationBased
                })
            };
            if multibody.links().any(counts) {
                let inverse = multibody.dof_inverse_inertia(sets.bodies);
                let weights = inverse.iter().map(|&value| 1.0 / f64::from(value));
                self.weights.insert(index, weights.collect());
            }
        }
    }

    /// What a coordinate weighs (kg or kg m²), zero if it was not weighed.
    pub fn weight(&self, index: MultibodyIndex, place: usize) -> f64 {
        let weights = self.weights.get(&index);
        let weight = weights.and_then(|weights| weights.get(place)).copied();
        weight.filter(|weight| weight.is_finite()).unwrap_or(0.0)
    }
}
