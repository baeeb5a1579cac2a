//! Claiming along impulse joints: what is joined to a claimed body is claimed with it.

use super::filter::claimable_body;
use super::members::Members;
use super::places::order_of_bodies;
use super::sets::RapierSets;
use crate::math::HashSet;
use crate::rapier::prelude::*;

/// The impulse joints of claimed bodies.
#[derive(Debug, Default)]
pub(super) struct ClaimedJoints {
    /// In the order they were reached.
    taken: Vec<ImpulseJointHandle>,
    known: HashSet<ImpulseJointHandle>,
    /// Joints of one body with what they lead to: scratch.
    partners: Vec<(RigidBodyHandle, ImpulseJointHandle)>,
}

impl ClaimedJoints {
    /// Begins with none.
    pub fn clear(&mut self) {
        self.taken.clear();
        self.known.clear();
    }

    /// All of them, in the order they were reached.
    pub fn as_slice(&self) -> &[ImpulseJointHandle] {
        &self.taken
    }

    /// Takes up the enabled joints of a claimed body, and claims what they lead to.
    pub fn take_up(&mut self, sets: &RapierSets<'_>, body: RigidBodyHandle, members: &mut Members) {
        if sets.impulse_joints.is_empty() {
            return;
        }
        self.partners.clear();
        for (one, other, handle, _) in sets.impulse_joints.attached_enabled_joints(body) {
            let partner = if one == body { other } else { one };
            self.partners.push((partner, handle));
        }
        // The order of insertion is not physics.
        self.partners.sort_unstable_by(|one, other| {
            order_of_bodies(sets, one.0, other.0)
                .then_with(|| one.1.0.into_raw_parts().cmp(&other.1.0.into_raw_parts()))
        });
        for &(partner, handle) in &self.partners {
            if !self.known.insert(handle) {
                continue;
            }
            self.taken.push(handle);
            if claimable_body(sets, partner) {
                let other = members.claim(partner);
                let own = members.claim(body);
                members.unite(own, other);
            }
        }
    }
}
