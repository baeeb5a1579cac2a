//! Claiming: which bodies are solved in one system, and which pairs of them may touch.
//!
//! From every flexible body the contact graph is walked through dynamic rigid bodies; all that are reached belong to the
//! flexible stage for this step. Fixed and kinematic bodies and links of multibodies are met but
//! not passed through; what meets links of one multibody is solved together.

use super::changes::Changes;
use super::claim_attachments::ClaimedAttachment;
use super::events::PairName;
use super::filter::{claimable_parent, may_touch};
use super::places::{loosened, order_of_boxes, order_of_colliders, swept_box, swept_surface};
use super::sets::RapierSets;
use super::sleep::Sleeper;
use super::strikes::Strikes;
use crate::body::{FlexBodyHandle, FlexBodySet, FlexState};
use crate::math::from_rapier;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;
use std::collections::{HashMap, HashSet};

/// Who may touch whom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ClaimedPair {
    /// A flexible body (by its index among the claimed) and a collider that is no carrier.
    FlexRigid(usize, ColliderHandle),
    /// Two flexible bodies.
    FlexFlex(usize, usize),
    /// Two colliders, of which at least one belongs to a claimed rigid body.
    RigidRigid(ColliderHandle, ColliderHandle),
}

/// A flexible body taking part in the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClaimedFlex {
    /// Slot in the set.
    pub index: u32,
    /// Its surface in rapier.
    pub collider: ColliderHandle,
    /// Box of its surface over the step.
    pub swept: Aabb,
    /// How far its fastest node goes in the step (m).
    pub travel: Real,
    /// Size of a boundary segment (m).
    pub edge: f64,
    /// What it pushes; its surface in rapier pushes nothing.
    pub solver_groups: InteractionGroups,
}

impl ClaimedFlex {
    /// How far around where its velocity takes it the body may get in the step (m).
    pub fn reach(&self) -> f64 {
        self.edge + f64::from(self.travel)
    }
}

/// The result of a claim, with its buffers.
#[derive(Debug, Default)]
pub(crate) struct Claims {
    /// Flexible bodies, in the order of their places.
    pub flex: Vec<ClaimedFlex>,
    /// Claimed rigid bodies, in the order they were reached.
    pub rigid: Vec<RigidBodyHandle>,
    /// Pairs that may touch.
    pub pairs: Vec<ClaimedPair>,
    /// Impulse joints of claimed bodies, in the order they were reached.
    pub joints: Vec<ImpulseJointHandle>,
    /// Attachments, in the order of their bodies' places.
    pub attached: Vec<ClaimedAttachment>,
    pub(super) seen_joints: HashSet<ImpulseJointHandle>,
    pub(super) partners: Vec<(RigidBodyHandle, ImpulseJointHandle)>,
    /// Component of every member: flexible bodies first, then rigid ones.
    parent: Vec<usize>,
    /// Multibodies that are met, with one of the members that meet them.
    multibodies: Vec<(MultibodyIndex, usize)>,
    pub(super) rigid_index: HashMap<RigidBodyHandle, usize>,
    pub(super) flex_of_collider: HashMap<ColliderHandle, usize>,
    seen: HashSet<(ColliderHandle, ColliderHandle)>,
    /// What the swept boxes meet, by flexible body.
    pub(super) swept_hits: Vec<(usize, ColliderHandle)>,
    pub(super) neighbours: Vec<ColliderHandle>,
    /// How far the fastest body goes in the step (m).
    pub(super) farthest: Real,
    /// By how much members have left the boxes they were looked for in (m), when the step is solved again for that.
    pub(super) excess: Real,
    /// Flexible bodies that sleep, and take no part, in the order of their slots.
    pub(super) asleep: Vec<Sleeper>,
    /// Their surfaces.
    pub(super) sleeping_surfaces: HashSet<ColliderHandle>,
    pub(super) woken: Vec<RigidBodyHandle>,
    pub(super) changes: Changes,
    /// What may be struck into a flexible body by what nobody has claimed.
    pub(super) strikes: Strikes,
    /// What the user's filter said of pairs that it was asked about.
    pub(super) answers: HashMap<PairName, Option<SolverFlags>>,
    /// Boxes of the flexible surfaces where the step ends.
    pub(super) surface_boxes: Vec<(FlexBodyHandle, Aabb)>,
}

impl Claims {
    /// What the user's filter said of a pair in this step, if it was asked.
    pub fn answer(&self, name: PairName) -> Option<Option<SolverFlags>> {
        self.answers.get(&name).copied()
    }

    /// Component that a flexible body belongs to.
    pub fn component_of_flex(&mut self, flex: usize) -> usize {
        self.root(flex)
    }

    /// Component that a claimed rigid body belongs to, `None` if it was not claimed.
    pub fn component_of_rigid(&mut self, handle: RigidBodyHandle) -> Option<usize> {
        let index = *self.rigid_index.get(&handle)?;
        Some(self.root(self.flex.len() + index))
    }

    /// Whether a collider is a surface, or that of a claimed body.
    pub fn holds(&self, handle: ColliderHandle, colliders: &ColliderSet) -> bool {
        let parent = || colliders.get(handle).and_then(Collider::parent);
        self.flex_of_collider.contains_key(&handle)
            || parent().is_some_and(|parent| self.rigid_index.contains_key(&parent))
    }

    /// Looks ahead along the velocities of the flexible bodies, before the detection step.
    pub fn look_ahead(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let dt = f64::from(sets.integration_parameters.dt);
        self.excess = 0.0;
        self.flex.clear();
        self.flex_of_collider.clear();
        self.asleep.clear();
        self.sleeping_surfaces.clear();
        for (handle, body) in flex_bodies
            .iter()
            .filter(|(_, body)| !body.is_quarantined())
        {
            if let Some(sleeper) = Sleeper::new(handle.into_raw_parts().0, body, sets) {
                self.sleeping_surfaces.insert(sleeper.collider);
                self.asleep.push(sleeper);
                continue;
            }
            let edge = body.mesh().boundary().mean_segment_length();
            let (swept, travel) = swept_surface(body, dt);
            let fall = from_rapier(sets.gravity).norm() * body.gravity_scale().abs() * dt * dt;
            let skin = body.contact_settings().contact_skin;
            let recoil = recoil(body.state(), body.mass()) * dt;
            let edge = edge + 2.0 * recoil;
            let swept = loosened(swept, (0.5 * edge + fall + skin) as Real);
            let index = handle.into_raw_parts().0;
            self.flex.push(ClaimedFlex {
                index,
                collider: body.collider_handle(),
                swept,
                travel: travel + recoil as Real,
                edge,
                solver_groups: body.contact_settings().solver_groups,
            });
        }
        // The order of insertion is not physics.
        self.flex.sort_unstable_by(|one, other| {
            order_of_boxes(&one.swept, &other.swept).then(one.index.cmp(&other.index))
        });
        for (slot, flex) in self.flex.iter().enumerate() {
            self.flex_of_collider.insert(flex.collider, slot);
        }
        self.list_attachments(flex_bodies);
    }

    /// Finds what the swept boxes meet, with rapier's tree, after the detection step has taken over the user's changes.
    pub fn sweep(&mut self, sets: &RapierSets<'_>) {
        self.swept_hits.clear();
        let dt = sets.integration_parameters.dt;
        let farthest = self.farthest_travel(sets);
        self.farthest = farthest;
        let dispatcher = sets.narrow_phase.query_dispatcher();
        let query = sets.broad_phase.as_query_pipeline(
            dispatcher,
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        for (index, flex) in self.flex.iter().enumerate() {
            let near = loosened(flex.swept, farthest);
            let mut meets_itself = false;
            let (flex_of_collider, all_flex) = (&self.flex_of_collider, &self.flex);
            let hits = &mut self.swept_hits;
            let mut visit = |handle: ColliderHandle, collider: &Collider| {
                let other = match flex_of_collider.get(&handle) {
                    Some(&other) => all_flex[other].swept,
                    None => swept_box(sets.bodies, collider, dt),
                };
                if handle != flex.collider && other.intersects(&flex.swept) {
                    hits.push((index, handle));
                }
            };
            for (handle, collider) in query.intersect_aabb_conservative(near) {
                meets_itself |= handle == flex.collider;
                visit(handle, collider);
            }
            // A detection step may leave the tree empty: then all colliders are asked.
            if !meets_itself {
                sets.colliders
                    .iter()
                    .for_each(|(handle, collider)| visit(handle, collider));
            }
        }
        self.meet_struck(sets);
        self.swept_hits.sort_unstable_by_key(|(index, _)| *index);
    }

    /// Walks the contact graph from what the swept boxes met.
    pub fn walk(&mut self, sets: &RapierSets<'_>) {
        self.rigid.clear();
        self.rigid_index.clear();
        self.multibodies.clear();
        self.pairs.clear();
        self.joints.clear();
        self.seen_joints.clear();
        self.seen.clear();
        self.answers.clear();
        self.parent.clear();
        self.parent.extend(0..self.flex.len());
        self.claim_attached(sets);
        for flex in 0..self.flex.len() {
            self.collect_neighbours(sets, flex);
            for slot in 0..self.neighbours.len() {
                self.add_flex_pair(sets, flex, self.neighbours[slot]);
            }
        }
        let mut next = 0;
        while next < self.rigid.len() {
            let handle = self.rigid[next];
            next += 1;
            let Some(body) = sets.bodies.get(handle) else {
                continue;
            };
            for &collider in body.colliders() {
                self.add_rigid_pairs(sets, handle, collider);
            }
            self.add_joints(sets, handle);
        }
    }

    /// Colliders near a flexible body: those rapier lists and those the look-ahead met, each once, in order.
    fn collect_neighbours(&mut self, sets: &RapierSets<'_>, flex: usize) {
        let own = self.flex[flex];
        self.neighbours.clear();
        for pair in sets.narrow_phase.contact_pairs_with(own.collider) {
            let other = if pair.collider1 == own.collider {
                pair.collider2
            } else {
                pair.collider1
            };
            self.neighbours.push(other);
        }
        let first = self.swept_hits.partition_point(|(index, _)| *index < flex);
        for &(index, handle) in &self.swept_hits[first..] {
            if index != flex {
                break;
            }
            self.neighbours.push(handle);
        }
        self.neighbours
            .sort_unstable_by(|&one, &other| order_of_colliders(sets, one, other));
        self.neighbours.dedup();
        let mut neighbours = std::mem::take(&mut self.neighbours);
        let mut answers = std::mem::take(&mut self.answers);
        neighbours.retain(|&other| {
            may_touch(sets, own.collider, other, &mut answers)
                && !self.attachment_forbids(sets, flex, other)
        });
        (self.neighbours, self.answers) = (neighbours, answers);
    }

    fn add_flex_pair(&mut self, sets: &RapierSets<'_>, flex: usize, other: ColliderHandle) {
        if let Some(&target) = self.flex_of_collider.get(&other) {
            // Met from both sides, or from one only: the pair counts once.
            let (low, high) = (flex.min(target), flex.max(target));
            let names = (self.flex[low].collider, self.flex[high].collider);
            let is_near = self.flex[low].swept.intersects(&self.flex[high].swept);
            let groups = [low, high].map(|flex| self.flex[flex].solver_groups);
            let meets = is_near && groups[0].test(groups[1]);
            if low < high && meets && self.seen.insert(names) {
                self.unite(low, high);
                self.pairs.push(ClaimedPair::FlexFlex(low, high));
            }
            return;
        }
        if self.is_sleeping_surface(other) {
            return;
        }
        let Some(collider) = sets.colliders.get(other) else {
            return;
        };
        let swept = swept_box(sets.bodies, collider, sets.integration_parameters.dt);
        let driven = self.strikes.reach.get(&other).copied();
        let swept = loosened(swept, driven.unwrap_or(0.0));
        let groups = [self.flex[flex].solver_groups, collider.solver_groups()];
        if !swept.intersects(&self.flex[flex].swept) || !groups[0].test(groups[1]) {
            return;
        }
        self.pairs.push(ClaimedPair::FlexRigid(flex, other));
        if let Some(parent) = claimable_parent(sets, collider) {
            let member = self.claim(parent);
            self.unite(flex, member);
        } else {
            self.meet_link(sets, collider.parent(), flex);
        }
    }

    fn add_rigid_pairs(
        &mut self,
        sets: &RapierSets<'_>,
        body: RigidBodyHandle,
        own: ColliderHandle,
    ) {
        let Some(own_collider) = sets.colliders.get(own) else {
            return;
        };
        let dt = sets.integration_parameters.dt;
        let own_box = loosened(swept_box(sets.bodies, own_collider, dt), self.excess);
        self.neighbours.clear();
        for pair in sets.narrow_phase.contact_pairs_with(own) {
            let other = if pair.collider1 == own {
                pair.collider2
            } else {
                pair.collider1
            };
            let touches = pair
                .manifolds()
                .iter()
                .any(|manifold| !manifold.points.is_empty());
            let near = sets
                .colliders
                .get(other)
                .is_some_and(|collider| swept_box(sets.bodies, collider, dt).intersects(&own_box));
            if (touches || near) && !self.is_surface(other) {
                self.neighbours.push(other);
            }
        }
        self.look_around(sets, body, own);
        self.neighbours
            .sort_unstable_by(|&one, &other| order_of_colliders(sets, one, other));
        self.neighbours.dedup();
        for slot in 0..self.neighbours.len() {
            let other = self.neighbours[slot];
            let ordered = if order_of_colliders(sets, own, other).is_lt() {
                (own, other)
            } else {
                (other, own)
            };
            let Some(collider) = sets.colliders.get(other) else {
                continue;
            };
            let solves = own_collider.solver_groups().test(collider.solver_groups());
            if !solves || !self.seen.insert(ordered) {
                continue;
            }
            if !may_touch(sets, ordered.0, ordered.1, &mut self.answers) {
                continue;
            }
            self.pairs
                .push(ClaimedPair::RigidRigid(ordered.0, ordered.1));
            if let Some(parent) = claimable_parent(sets, collider) {
                let other_member = self.claim(parent);
                let own_member = self.claim(body);
                self.unite(own_member, other_member);
            } else {
                let own_member = self.claim(body);
                self.meet_link(sets, collider.parent(), own_member);
            }
        }
    }

    /// Member index of a rigid body, claimed now if it was not.
    pub(super) fn claim(&mut self, handle: RigidBodyHandle) -> usize {
        let n_flex = self.flex.len();
        if let Some(&index) = self.rigid_index.get(&handle) {
            return n_flex + index;
        }
        let index = self.rigid.len();
        self.rigid.push(handle);
        self.rigid_index.insert(handle, index);
        self.parent.push(n_flex + index);
        n_flex + index
    }

    /// Unites a member with all others that meet links of the same multibody.
    pub(super) fn meet_link(
        &mut self,
        sets: &RapierSets<'_>,
        body: Option<RigidBodyHandle>,
        member: usize,
    ) {
        let link = body.and_then(|body| sets.multibody_joints.rigid_body_link(body));
        let Some(index) = link.map(|link| link.multibody) else {
            return;
        };
        let met = self.multibodies.iter().find(|(one, _)| *one == index);
        match met.map(|(_, other)| *other) {
            Some(other) => self.unite(member, other),
            None => self.multibodies.push((index, member)),
        }
    }

    fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    pub(super) fn unite(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        // The smaller index stays the root, so that components do not depend on the order of unions.
        self.parent[one.max(other)] = one.min(other);
    }
}

/// Speed (m/s) that a body held for a step, or woken, may have by the end of the next: neither its velocity nor its acceleration
/// tells of the energy that it stores.
fn recoil(state: &FlexState, mass: f64) -> f64 {
    let is_stopped = state.kinetic_energy == 0.0 && state.frame.acceleration.norm_squared() == 0.0;
    if is_stopped {
        (2.0 * state.elastic_energy.max(0.0) / mass).sqrt()
    } else {
        0.0
    }
}
