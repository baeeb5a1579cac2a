//! Claiming along impulse joints: what is joined to a claimed body is claimed with it.

use super::claim::Claims;
use super::filter::claimable_body;
use super::places::order_of_bodies;
use super::sets::RapierSets;
use crate::rapier::prelude::*;

impl Claims {
    /// Takes up the enabled joints of a claimed body, and claims what they lead to.
    pub(super) fn add_joints(&mut self, sets: &RapierSets<'_>, body: RigidBodyHandle) {
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
        for slot in 0..self.partners.len() {
            let (partner, handle) = self.partners[slot];
            if !self.seen_joints.insert(handle) {
                continue;
            }
            self.joints.push(handle);
            if claimable_body(sets, partner) {
                let other = self.claim(partner);
                let own = self.claim(body);
                self.unite(own, other);
            } else {
                let own = self.claim(body);
                self.meet_link(sets, Some(partner), own);
            }
        }
    }

    /// A joint of the user's to the carrier of a flexible body, if there is one.
    pub fn joint_to_carrier(&self, sets: &RapierSets<'_>) -> Option<ImpulseJointHandle> {
        if sets.impulse_joints.is_empty() {
            return None;
        }
        let carriers = self.flex.iter().filter_map(|flex| {
            let collider = sets.colliders.get(flex.collider)?;
            collider.parent()
        });
        let mut joints =
            carriers.flat_map(|carrier| sets.impulse_joints.attached_enabled_joints(carrier));
        joints.next().map(|(_, _, handle, _)| handle)
    }
}
