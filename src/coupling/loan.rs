//! The loan: what of rapier's bodies, colliders and joints is changed for the length of its full step, and put back after it.
//!
//! Claimed bodies are locked, links by their joints, and led to where the flexible stage has put them. A [`Loan`] has the sets as long as all this is
//! lent, and gives it back when it is dropped: also where a handler of the user's panics within rapier's step.

use super::claim::Claims;
use super::hand_back::{hand_back, keep, land};
use super::hooks::{HookBook, HookGate};
use super::landing::Landing;
use super::lent_multibodies::LentMultibodies;
use super::masters::Masters;
use super::sets::RapierSets;
use crate::rapier::prelude::*;

/// What is lent; empty but for the length of a [`Loan`].
#[derive(Debug, Default)]
pub(crate) struct Lent {
    /// Axes of claimed bodies that were locked before.
    axes: Vec<(RigidBodyHandle, LockedAxes)>,
    /// Joints of claimed multibodies.
    multibodies: LentMultibodies,
}

impl Lent {
    /// The hooks that rapier is given in place of the user's.
    ///
    /// - `is_full`: whether this is for its full step.
    pub fn gate<'a>(
        &'a self,
        user: &'a dyn PhysicsHooks,
        book: &'a HookBook,
        claims: &'a Claims,
        is_full: bool,
    ) -> HookGate<'a> {
        HookGate {
            user,
            book,
            claims,
            is_full,
        }
    }

    /// Puts everything back, to the last bit.
    fn give_back(&mut self, sets: &mut RapierSets<'_>) {
        for (handle, axes) in self.axes.drain(..) {
            if let Some(body) = sets.bodies.get_mut(handle) {
                body.set_locked_axes(axes, false);
            }
        }
        self.multibodies.give_back(sets.multibody_joints);
    }
}

/// Rapier's sets while something of them is lent.
pub(crate) struct Loan<'s, 'a> {
    sets: &'s mut RapierSets<'a>,
    lent: &'s mut Lent,
}

impl<'s, 'a> Loan<'s, 'a> {
    /// Lends what leads claimed bodies to where they end.
    pub fn new(lent: &'s mut Lent, landings: &[Landing], sets: &'s mut RapierSets<'a>) -> Self {
        let loan = Self { sets, lent };
        hand_back(landings, &mut loan.lent.axes, loan.sets);
        loan.lent.multibodies.lead(landings, loan.sets);
        loan
    }

    /// Rapier's full step.
    pub fn step(&mut self, book: &HookBook, claims: &Claims, events: &dyn EventHandler) {
        let gate = self.lent.gate(self.sets.hooks, book, claims, true);
        self.sets.step_through(&gate, events);
    }

    /// The sets meanwhile.
    pub fn sets(&mut self) -> &mut RapierSets<'a> {
        self.sets
    }

    /// Lands the claimed bodies after rapier's step, and gives everything back.
    pub fn land(self, landings: &[Landing], is_led: bool, masters: &mut Masters) {
        self.lent.multibodies.place(landings, self.sets);
        land(landings, is_led, self.sets);
        self.lent.multibodies.land(self.sets);
        keep(landings, self.sets, masters);
    }
}

impl Drop for Loan<'_, '_> {
    fn drop(&mut self) {
        self.lent.give_back(self.sets);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Beta2;
    use crate::kkt::LateForce;
    use crate::system::{RigidBlock, RigidLoad, RigidMotion, Step};

    /// Where a step ends early, as by a panic in a handler, the axes of claimed bodies come back with the sets, whatever was lent.
    #[test]
    fn what_is_lent_comes_back_when_the_loan_is_dropped() {
        let mut world = PhysicsWorld::new();
        let own = LockedAxes::TRANSLATION_LOCKED_X;
        let handle = world.insert_body(RigidBodyBuilder::dynamic().locked_axes(own));
        let step = Step::new(&Beta2::default(), 1.0 / 60.0);
        let load = RigidLoad {
            inverse_mass: [0.0, 1.0, 1.0],
            force: [0.0; 3],
            damping: [0.0; 3],
        };
        let block = RigidBlock::free(RigidMotion::default(), None, &load, &step);
        let landings = [Landing::new(handle, &block, LateForce::default(), false)];
        let mut lent = Lent::default();
        let mut sets = RapierSets::of_world(&mut world, &(), &());
        let mut loan = Loan::new(&mut lent, &landings, &mut sets);
        let all = LockedAxes::TRANSLATION_LOCKED | LockedAxes::ROTATION_LOCKED;
        assert_eq!(loan.sets().bodies[handle].locked_axes(), all);
        drop(loan);
        assert_eq!(sets.bodies[handle].locked_axes(), own);
        assert!(lent.axes.is_empty());
    }
}
