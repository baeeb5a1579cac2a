//! What rapier must leave alone in its full step, because links have had it from the flexible stage: their contacts and impulse joints
//! with claimed bodies.
//!
//! For the step, colliders of such links ask the pair filter, where our gate takes the forces out and leaves the contacts; joints hold
//! no axis. Both get back what they had.

use super::claim::Claims;
use super::links::Push;
use super::pair_name::{PairName, pair_name};
use super::sets::RapierSets;
use super::walk::ClaimedPair;
use crate::math::HashSet;
use crate::rapier::prelude::*;

/// What was taken for the length of rapier's full step.
#[derive(Debug, Default)]
pub(crate) struct Borrowed {
    hooks: Vec<(ColliderHandle, ActiveHooks)>,
    /// Joints with their locked, limited and driven axes.
    joints: Vec<(ImpulseJointHandle, [JointAxesMask; 3])>,
    pairs: HashSet<PairName>,
}

impl Borrowed {
    /// Takes contacts and joints of links with claimed bodies out of rapier's hands.
    pub fn take(&mut self, claims: &Claims, pushes: &[Push], sets: &mut RapierSets<'_>) {
        let is_pushed = |body| pushes.iter().any(|push| push.handle == body);
        for pair in claims.pairs() {
            if let ClaimedPair::RigidRigid(one, other) = *pair {
                for handle in [one, other] {
                    let parent = sets.colliders.get(handle).and_then(Collider::parent);
                    if parent.is_some_and(is_pushed) {
                        self.pairs.insert(pair_name(one, other));
                        self.hook(handle, sets);
                    }
                }
            }
        }
        for &handle in claims.joints() {
            let joint = sets.impulse_joints.get(handle);
            let bodies = joint.map(|joint| [joint.body1(), joint.body2()]);
            let holds_link = bodies.is_some_and(|all| all.into_iter().any(is_pushed));
            if holds_link && let Some(joint) = sets.impulse_joints.get_mut(handle, false) {
                let data = &mut joint.data;
                let axes = [
                    &mut data.locked_axes,
                    &mut data.limit_axes,
                    &mut data.motor_axes,
                ];
                let taken = axes.map(|axes| std::mem::replace(axes, JointAxesMask::empty()));
                self.joints.push((handle, taken));
            }
        }
    }

    fn hook(&mut self, handle: ColliderHandle, sets: &mut RapierSets<'_>) {
        if self.hooks.iter().any(|(known, _)| *known == handle) {
            return;
        }
        if let Some(collider) = sets.colliders.get_mut(handle) {
            let hooks = collider.active_hooks();
            self.hooks.push((handle, hooks));
            collider.set_active_hooks(hooks | ActiveHooks::FILTER_CONTACT_PAIRS);
        }
    }

    /// Gives everything back.
    pub fn give_back(&mut self, sets: &mut RapierSets<'_>) {
        for (handle, hooks) in self.hooks.drain(..) {
            if let Some(collider) = sets.colliders.get_mut(handle) {
                collider.set_active_hooks(hooks);
            }
        }
        for (handle, [locked, limited, driven]) in self.joints.drain(..) {
            if let Some(joint) = sets.impulse_joints.get_mut(handle, false) {
                joint.data.locked_axes = locked;
                joint.data.limit_axes = limited;
                joint.data.motor_axes = driven;
            }
        }
        self.pairs.clear();
    }

    /// Whether the user wants to be asked about a pair: all do whose hooks we have not touched.
    pub fn asks_user(&self, pair: PairName, colliders: &ColliderSet) -> bool {
        if self.hooks.is_empty() {
            return true;
        }
        let own = |handle: &ColliderHandle| {
            let known = self.hooks.iter().find(|(known, _)| known == handle);
            let current = || colliders.get(*handle).map(Collider::active_hooks);
            let hooks = known.map(|(_, hooks)| *hooks).or_else(current);
            hooks.is_some_and(|hooks| hooks.contains(ActiveHooks::FILTER_CONTACT_PAIRS))
        };
        pair.iter().any(own)
    }

    /// Whether the forces of a pair are ours.
    pub fn holds(&self, pair: PairName) -> bool {
        self.pairs.contains(&pair)
    }
}
