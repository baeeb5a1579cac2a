//! Claiming: which bodies are solved in one system, and which pairs of them may touch.
//!
//! A claim is made in stages, each with a room of its own that reads what the stages before it have found: what the user has changed
//! (`changes`), the flexible bodies of the step with the boxes they are looked for in (`roster`), what these boxes meet (`sweep`, with what is
//! struck into them, `strikes`), and who is reached from there through the contact graph (`walk`).

use super::changes::{Changes, WorldChange};
use super::claim_attachments::{Attached, ClaimedAttachment};
use super::claim_multibodies::ClaimedMultibodies;
use super::light_partners::is_lighter;
use super::pair_name::PairName;
use super::quarantine::is_out;
use super::roster::Roster;
use super::sets::RapierSets;
use super::strikes::Strikes;
use super::sweep::Sweep;
use super::waking::{wake_met, wake_surfaces};
use super::walk::{ClaimedPair, Map, Walk};
use crate::body::{AttachmentKind, FlexBody, FlexBodySet};
use crate::constraint::contact::Owner;
use crate::rapier::math::Real;
use crate::rapier::prelude::*;

/// The claim of a step. What is asked of it between two steps, by rapier's own steps and by snapshots, is that of the last.
#[derive(Debug, Default)]
pub(crate) struct Claims {
    /// The flexible bodies.
    pub flex: Roster,
    /// By how much members have left the boxes they were looked for in (m), when the step is solved again for that.
    pub(super) excess: Real,
    pub(super) changes: Changes,
    pub(super) walk: Walk,
    pub(super) attached: Attached,
    /// Rigid bodies that stay for a step with flexible ones, by their index.
    bonds: Vec<(RigidBodyHandle, u32)>,
    sweep: Sweep,
    pub(super) strikes: Strikes,
}

/// The stages, in their order.
impl Claims {
    /// Gathers what was changed since rapier's last step, and says whether it may concern what sleeps. Where nothing sleeps, nothing
    /// does.
    pub fn look_for_changes(
        &mut self,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) -> WorldChange {
        self.changes.look(sets, &self.flex, flex_bodies)
    }

    /// Whether all that could move sleeps, so that there is nothing to do.
    pub fn is_all_asleep(&self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) -> bool {
        let is_quiet = |body: &FlexBody| {
            is_out(body, sets.bodies) || !body.is_disturbed() && body.is_sleeping(sets.bodies)
        };
        self.changes.leave_at_rest(sets, &self.flex)
            && flex_bodies.iter().all(|(_, body)| is_quiet(body))
    }

    /// Notes what the next step is to be compared with.
    pub fn note_world(&mut self, sets: &RapierSets<'_>) {
        self.changes.note_world(sets);
    }

    /// Wakes sleepers beside which something was put or altered.
    pub fn wake_beside_changes(&self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.changes.wake_beside(sets, &self.flex, flex_bodies);
    }

    /// Gathers anew what is marked, after a detection step, which has taken all changes over.
    pub fn note_changes_taken_over(&mut self, sets: &RapierSets<'_>) {
        self.changes.gather(sets);
    }

    /// Notes which rigid bodies that are awake stay with flexible ones in this step, by their index.
    pub fn bind(
        &mut self,
        bonds: impl Iterator<Item = (RigidBodyHandle, u32)>,
        bodies: &RigidBodySet,
    ) {
        let is_awake = |handle| {
            let body: Option<&RigidBody> = bodies.get(handle);
            body.is_some_and(|body| !body.is_sleeping())
        };
        self.bonds.clear();
        self.bonds
            .extend(bonds.filter(|(handle, _)| is_awake(*handle)));
        self.bonds
            .sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
    }

    /// Looks ahead along the velocities of the flexible bodies, before the detection step.
    pub fn look_ahead(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.excess = 0.0;
        self.flex.list(sets, flex_bodies);
        self.attached.list(&self.flex, flex_bodies);
    }

    /// Wakes sleepers that something awake may meet in the step; returns whether one woke, so that the look-ahead has to begin anew.
    pub fn wake_met(&mut self, sets: &mut RapierSets<'_>) -> bool {
        let (flex, strikes) = (&self.flex, &mut self.strikes);
        wake_met(sets, flex, &self.changes, strikes, self.excess)
    }

    /// Meets the boxes of the flexible bodies with what is around them; returns whether anything was met of which only a detection step
    /// can tell more.
    pub fn needs_detection(&mut self, sets: &RapierSets<'_>) -> bool {
        self.sweep
            .needs_detection(sets, &self.flex, &self.changes, &mut self.strikes)
            || self.attached.has_rigid_bodies(sets)
            || !self.bonds.is_empty()
    }

    /// Finds what the boxes meet, with rapier's tree, after the detection step has taken over the user's changes.
    pub fn sweep(&mut self, sets: &RapierSets<'_>) {
        self.sweep
            .all(sets, &self.flex, &self.changes, &mut self.strikes);
    }

    /// Walks the contact graph from what the boxes have met. What rapier knows of the multibodies that are claimed is brought up to date, and their
    /// coordinates are weighed where motors count by that.
    pub fn walk(&mut self, sets: &mut RapierSets<'_>) {
        let map = Map {
            flex: &self.flex,
            sweep: &self.sweep,
            attached: &self.attached,
            bonds: &self.bonds,
            excess: self.excess,
        };
        self.walk.begin(&map, sets);
        self.walk.multibodies.prepare(sets);
    }

    /// Wakes the flexible bodies that sleep under, or beside, rigid bodies that were claimed; returns whether one woke, so that the look-ahead has
    /// to begin anew. A rigid body that sleeps is claimed by what is awake beside it, and would fall into what carries it.
    pub fn wake_touched(&mut self, sets: &mut RapierSets<'_>) -> bool {
        wake_surfaces(sets, &self.walk.touched)
    }
}

/// What the stages have found.
impl Claims {
    /// Colliders that were marked since rapier's last step, or whose body was; some twice.
    pub fn marked_colliders(&self) -> &[ColliderHandle] {
        self.changes.colliders()
    }

    /// Whether the user has inserted, moved or altered a collider since rapier's last step.
    pub fn has_altered(&self, collider: ColliderHandle) -> bool {
        self.changes.has_altered(collider)
    }

    /// Claimed rigid bodies, in the order they were reached.
    pub fn rigid(&self) -> &[RigidBodyHandle] {
        self.walk.members.rigid()
    }

    /// Pairs that may touch.
    pub fn pairs(&self) -> &[ClaimedPair] {
        &self.walk.pairs
    }

    /// Impulse joints of claimed bodies, in the order they were reached.
    pub fn joints(&self) -> &[ImpulseJointHandle] {
        self.walk.joints.as_slice()
    }

    /// Multibodies of claimed links.
    pub(super) fn multibodies(&self) -> &ClaimedMultibodies {
        &self.walk.multibodies
    }

    /// Attachments, in the order of their bodies' places.
    pub fn attached(&self) -> &[ClaimedAttachment] {
        self.attached.as_slice()
    }

    /// Component that a flexible body belongs to.
    pub fn component_of_flex(&self, flex: usize) -> usize {
        self.walk.members.component_of_flex(flex)
    }

    /// Whether something may touch a flexible body in the step, or a pin or weld holds it to what is [not lighter](is_lighter) than the nodes held.
    pub fn may_press(&self, flex: usize, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) -> bool {
        let meets = |pair: &ClaimedPair| match *pair {
            ClaimedPair::FlexRigid(own, _) => own == flex,
            ClaimedPair::FlexFlex(one, other) => one == flex || other == flex,
            ClaimedPair::RigidRigid(..) => false,
        };
        let own = flex_bodies.at_index(self.flex[flex].index);
        let holds = |tie: &ClaimedAttachment| {
            let attachment = flex_bodies.attachments().get(tie.parts);
            let (Some(attachment), Some((_, body))) = (attachment, own) else {
                return false;
            };
            if matches!(attachment.kind(), AttachmentKind::Spring { .. }) || tie.other.is_some() {
                return false;
            }
            let rigid = tie.rigid.filter(|&handle| self.has(handle));
            let rigid = rigid.and_then(|handle| sets.bodies.get(handle));
            !rigid.is_some_and(|rigid| is_lighter(rigid, body, attachment))
        };
        let is_own = |tie: &&ClaimedAttachment| tie.flex == flex || tie.other == Some(flex);
        self.pairs().iter().any(meets) || self.attached().iter().filter(is_own).any(holds)
    }

    /// Component that a claimed rigid body belongs to, `None` if it was not claimed.
    pub fn component_of_rigid(&self, handle: RigidBodyHandle) -> Option<usize> {
        self.walk.members.component_of_rigid(handle)
    }

    /// Whether a rigid body was claimed.
    pub fn has(&self, handle: RigidBodyHandle) -> bool {
        self.walk.members.has(handle)
    }

    /// Whether a collider is a surface, or that of a claimed body.
    pub fn has_collider(&self, handle: ColliderHandle, colliders: &ColliderSet) -> bool {
        let parent = || colliders.get(handle).and_then(Collider::parent);
        self.flex.slot_of(handle).is_some() || parent().is_some_and(|parent| self.has(parent))
    }

    /// Whether what an owner's forces move takes part in the step: a flexible body, or a dynamic one that was claimed.
    pub fn moves(&self, owner: Owner, sets: &RapierSets<'_>) -> bool {
        match owner {
            Owner::Flex(index) => self.flex.iter().any(|flex| flex.index == index),
            Owner::Collider(index) => {
                let collider = sets.colliders.get_unknown_gen(index);
                let parent = collider.and_then(|(collider, _)| collider.parent());
                parent.is_some_and(|parent| {
                    self.has(parent) && sets.bodies.get(parent).is_some_and(RigidBody::is_dynamic)
                })
            }
        }
    }

    /// What the user's filter said of a pair in this step, if it was asked.
    pub fn answer(&self, name: PairName) -> Option<Option<SolverFlags>> {
        self.walk.answers.of(name)
    }

    /// Whether two colliders may push each other; the user's filter is asked if it has not been in this step.
    pub fn may_touch(
        &mut self,
        sets: &RapierSets<'_>,
        one: ColliderHandle,
        other: ColliderHandle,
    ) -> bool {
        self.walk.answers.may_touch(sets, one, other)
    }
}
