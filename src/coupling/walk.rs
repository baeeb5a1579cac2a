//! The walk: from every flexible body through the contact graph, over dynamic rigid bodies, along attachments and joints.
//!
//! All that are reached are claimed, of a multibody all links. Fixed and kinematic bodies are met but not passed through.

use super::claim_attachments::Attached;
use super::claim_joints::ClaimedJoints;
use super::claim_multibodies::ClaimedMultibodies;
use super::filter::{Answers, claimable_body, claimable_parent};
use super::members::Members;
use super::places::{loosened, order_of_colliders, reach_of, swept_box};
use super::roster::Roster;
use super::sets::RapierSets;
use super::sleep::reaches;
use super::sweep::Sweep;
use crate::math::HashSet;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::BoundingVolume;
use crate::rapier::prelude::*;

/// Who may touch whom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ClaimedPair {
    /// A flexible body (by its slot in the roster) and a collider that is no carrier.
    FlexRigid(usize, ColliderHandle),
    /// Two flexible bodies.
    FlexFlex(usize, usize),
    /// Two colliders, of which at least one belongs to a claimed rigid body.
    RigidRigid(ColliderHandle, ColliderHandle),
}

/// What the walk goes by.
pub(super) struct Map<'a> {
    pub flex: &'a Roster,
    pub sweep: &'a Sweep,
    pub attached: &'a Attached,
    pub bonds: &'a [(RigidBodyHandle, u32)],
    /// By how much the boxes have grown in this step (m).
    pub excess: Real,
}

/// What the walk has reached.
#[derive(Debug, Default)]
pub(super) struct Walk {
    pub members: Members,
    /// Pairs that may touch.
    pub pairs: Vec<ClaimedPair>,
    pub joints: ClaimedJoints,
    pub multibodies: ClaimedMultibodies,
    pub answers: Answers,
    /// Surfaces of flexible bodies that sleep, which claimed rigid bodies may touch.
    pub touched: Vec<ColliderHandle>,
    /// Pairs that have been asked about.
    seen: HashSet<(ColliderHandle, ColliderHandle)>,
    /// Colliders near the one that is looked at: scratch.
    near: Vec<ColliderHandle>,
}

impl Walk {
    /// Walks anew.
    pub fn begin(&mut self, map: &Map<'_>, sets: &RapierSets<'_>) {
        self.members.begin(map.flex.len());
        self.pairs.clear();
        self.joints.clear();
        self.multibodies.clear();
        self.answers.clear();
        self.touched.clear();
        self.seen.clear();
        map.attached.claim(sets, &mut self.members);
        self.claim_bound(map, sets);
        let mut near = std::mem::take(&mut self.near);
        for flex in 0..map.flex.len() {
            self.list_near_flex(map, sets, flex, &mut near);
            for &other in &near {
                self.add_flex_pair(map, sets, flex, other);
            }
        }
        let mut next = 0;
        while let Some(&handle) = self.members.rigid().get(next) {
            next += 1;
            let Some(body) = sets.bodies.get(handle) else {
                continue;
            };
            for &own in body.colliders() {
                list_sleepers(map, sets, own, &mut self.touched);
                list_near_rigid(map, sets, (body, own), &mut near);
                for &other in &near {
                    self.add_rigid_pair(sets, (handle, own), other);
                }
            }
            self.joints.take_up(sets, handle, &mut self.members);
            self.multibodies.take_up(sets, handle, &mut self.members);
        }
        self.near = near;
        self.members.settle();
    }

    /// Claims what stays with a flexible body for this step.
    fn claim_bound(&mut self, map: &Map<'_>, sets: &RapierSets<'_>) {
        for &(handle, index) in map.bonds {
            let mut flex = 0..map.flex.len();
            let partner = flex.find(|&slot| map.flex[slot].index == index);
            if let Some(partner) = partner.filter(|_| claimable_body(sets, handle)) {
                let member = self.members.claim(handle);
                self.members.unite(partner, member);
            }
        }
    }

    /// Lists the colliders near a flexible body that it may touch: those rapier lists and those the sweep met, each once, in order.
    fn list_near_flex(
        &mut self,
        map: &Map<'_>,
        sets: &RapierSets<'_>,
        flex: usize,
        near: &mut Vec<ColliderHandle>,
    ) {
        let own = map.flex[flex].collider;
        near.clear();
        near.extend(listed_with(sets, own).map(|(other, _)| other));
        near.extend(map.sweep.hits_of(flex));
        near.sort_unstable_by(|&one, &other| order_of_colliders(sets, one, other));
        near.dedup();
        near.retain(|&other| {
            self.answers.may_touch(sets, own, other)
                && !map.attached.forbids(sets, map.flex, flex, other)
        });
    }

    fn add_flex_pair(
        &mut self,
        map: &Map<'_>,
        sets: &RapierSets<'_>,
        flex: usize,
        other: ColliderHandle,
    ) {
        let own = &map.flex[flex];
        if let Some(target) = map.flex.slot_of(other) {
            // Met from both sides, or from one only: the pair counts once.
            let (low, high) = (flex.min(target), flex.max(target));
            let [first, second] = [low, high].map(|slot| &map.flex[slot]);
            let names = (first.collider, second.collider);
            let is_near = first.swept.intersects(&second.swept);
            let meets = is_near && first.solver_groups.test(second.solver_groups);
            if low < high && meets && self.seen.insert(names) {
                self.members.unite(low, high);
                self.pairs.push(ClaimedPair::FlexFlex(low, high));
            }
            return;
        }
        if map.flex.is_sleeping_surface(other) {
            return;
        }
        let Some(collider) = sets.colliders.get(other) else {
            return;
        };
        let swept = swept_box(sets, collider);
        let swept = loosened(swept, map.sweep.driven(other));
        if !swept.intersects(&own.swept) || !own.solver_groups.test(collider.solver_groups()) {
            return;
        }
        self.pairs.push(ClaimedPair::FlexRigid(flex, other));
        self.claim_met(sets, collider, flex);
    }

    /// Adds the pair of a collider of a claimed body and one that is near it.
    fn add_rigid_pair(
        &mut self,
        sets: &RapierSets<'_>,
        (body, own): (RigidBodyHandle, ColliderHandle),
        other: ColliderHandle,
    ) {
        let ordered = if order_of_colliders(sets, own, other).is_lt() {
            (own, other)
        } else {
            (other, own)
        };
        let both = [own, other].map(|handle| sets.colliders.get(handle));
        let [Some(own), Some(other)] = both else {
            return;
        };
        let solves = own.solver_groups().test(other.solver_groups());
        if !solves || !self.seen.insert(ordered) {
            return;
        }
        if !self.answers.may_touch(sets, ordered.0, ordered.1) {
            return;
        }
        self.pairs
            .push(ClaimedPair::RigidRigid(ordered.0, ordered.1));
        let member = self.members.claim(body);
        self.claim_met(sets, other, member);
    }

    /// Claims the body of a collider that a member meets, if it can be solved for.
    fn claim_met(&mut self, sets: &RapierSets<'_>, met: &Collider, member: usize) {
        if let Some(parent) = claimable_parent(sets, met) {
            let other = self.members.claim(parent);
            self.members.unite(member, other);
        }
    }
}

/// Lists the colliders near one of a claimed body, surfaces left out, each once, in order.
fn list_near_rigid(
    map: &Map<'_>,
    sets: &RapierSets<'_>,
    (body, own): (&RigidBody, ColliderHandle),
    near: &mut Vec<ColliderHandle>,
) {
    near.clear();
    let Some(collider) = sets.colliders.get(own) else {
        return;
    };
    let swept = loosened(swept_box(sets, collider), map.excess);
    for (other, pair) in listed_with(sets, own) {
        let touches = pair
            .manifolds()
            .iter()
            .any(|manifold| !manifold.points.is_empty());
        let is_near = sets
            .colliders
            .get(other)
            .is_some_and(|collider| swept_box(sets, collider).intersects(&swept));
        if (touches || is_near) && !map.flex.is_surface(other) {
            near.push(other);
        }
    }
    look_around(map, sets, (body, own), near);
    near.sort_unstable_by(|&one, &other| order_of_colliders(sets, one, other));
    near.dedup();
}

/// Lists the surfaces that sleep and that a collider of a claimed body may touch: nothing else carries it in this step.
fn list_sleepers(
    map: &Map<'_>,
    sets: &RapierSets<'_>,
    own: ColliderHandle,
    touched: &mut Vec<ColliderHandle>,
) {
    if map.flex.asleep().is_empty() {
        return;
    }
    let Some(collider) = sets.colliders.get(own) else {
        return;
    };
    let parameters = sets.integration_parameters;
    let around = map.excess + parameters.prediction_distance();
    let swept = loosened(swept_box(sets, collider), around);
    let listed = listed_with(sets, own).map(|(other, _)| other);
    touched.extend(
        listed.filter(|&other| map.flex.is_sleeping_surface(other) && reaches(sets, other, &swept)),
    );
}

/// Pairs that rapier lists of a collider, with the other one.
fn listed_with<'a>(
    sets: &'a RapierSets<'_>,
    own: ColliderHandle,
) -> impl Iterator<Item = (ColliderHandle, &'a ContactPair)> {
    let pairs = sets.narrow_phase.contact_pairs_with(own);
    pairs.map(move |pair| {
        let is_first = pair.collider1 == own;
        let other = if is_first {
            pair.collider2
        } else {
            pair.collider1
        };
        (other, pair)
    })
}

/// Adds to what is near a claimed collider what it will reach within the step: rapier lists a pair only when the boxes
/// nearly touch, and bodies of a few metres a second then are in each other at its end.
fn look_around(
    map: &Map<'_>,
    sets: &RapierSets<'_>,
    (body, own): (&RigidBody, ColliderHandle),
    near: &mut Vec<ColliderHandle>,
) {
    let Some(collider) = sets.colliders.get(own) else {
        return;
    };
    let farthest = map.sweep.farthest();
    let swept = loosened(swept_box(sets, collider), map.excess);
    if reach_of(body, sets) + farthest + map.excess
        <= sets.integration_parameters.prediction_distance()
    {
        return;
    }
    let mut meets_itself = false;
    let mut visit = |handle: ColliderHandle, other: &Collider| {
        if handle != own
            && !map.flex.is_surface(handle)
            && other.parent() != collider.parent()
            && swept_box(sets, other).intersects(&swept)
        {
            near.push(handle);
        }
    };
    let query = sets.broad_phase.as_query_pipeline(
        sets.narrow_phase.query_dispatcher(),
        sets.bodies,
        sets.colliders,
        QueryFilter::new(),
    );
    for (handle, other) in query.intersect_aabb_conservative(loosened(swept, farthest)) {
        meets_itself |= handle == own;
        visit(handle, other);
    }
    // A detection step may leave the tree empty: then all colliders are asked.
    if !meets_itself {
        sets.colliders
            .iter()
            .for_each(|(handle, other)| visit(handle, other));
    }
}
