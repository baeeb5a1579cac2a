//! Claiming: which bodies are solved in one system, and which pairs of them may touch.
//!
//! From every flexible body the contact graph is walked through dynamic rigid bodies; all that are reached belong to the
//! flexible stage for this step. Fixed and kinematic bodies are met but not passed through.

use super::sets::RapierSets;
use crate::body::FlexBodySet;
use crate::math::{from_rapier, node_vec, to_rapier};
use crate::rapier::math::{Real, Vector};
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
    /// Size of a boundary segment (m).
    pub edge: f64,
}

/// The result of a claim, with its buffers.
#[derive(Debug, Default)]
pub(crate) struct Claims {
    /// Flexible bodies, in the order of their slots.
    pub flex: Vec<ClaimedFlex>,
    /// Claimed rigid bodies, in the order they were reached.
    pub rigid: Vec<RigidBodyHandle>,
    /// Pairs that may touch.
    pub pairs: Vec<ClaimedPair>,
    /// Component of every member: flexible bodies first, then rigid ones.
    parent: Vec<usize>,
    rigid_index: HashMap<RigidBodyHandle, usize>,
    flex_of_collider: HashMap<ColliderHandle, usize>,
    seen: HashSet<(ColliderHandle, ColliderHandle)>,
    swept_hits: Vec<(usize, ColliderHandle)>,
    neighbours: Vec<ColliderHandle>,
    n_colliders: usize,
}

impl Claims {
    /// Component that a flexible body belongs to.
    pub fn component_of_flex(&mut self, flex: usize) -> usize {
        self.root(flex)
    }

    /// Component that a claimed rigid body belongs to, `None` if it was not claimed.
    pub fn component_of_rigid(&mut self, handle: RigidBodyHandle) -> Option<usize> {
        let index = *self.rigid_index.get(&handle)?;
        Some(self.root(self.flex.len() + index))
    }

    /// Looks ahead along the velocities with rapier's tree, before the detection step may rebuild it.
    pub fn look_ahead(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.gather_flex(sets, flex_bodies);
        self.swept_hits.clear();
        let dt = sets.integration_parameters.dt;
        let fastest = sets
            .bodies
            .iter()
            .filter(|(_, body)| !body.is_fixed() && !body.is_sleeping())
            .map(|(_, body)| body.linvel().length())
            .fold(0.0, Real::max);
        let tree_is_stale = self.n_colliders != sets.colliders.len();
        self.n_colliders = sets.colliders.len();
        for (index, flex) in self.flex.iter().enumerate() {
            let near = flex.swept.loosened(fastest * dt);
            let mut visit = |handle: ColliderHandle, collider: &Collider| {
                if handle != flex.collider
                    && swept_box(sets.bodies, collider, dt).intersects(&flex.swept)
                {
                    self.swept_hits.push((index, handle));
                }
            };
            if tree_is_stale {
                sets.colliders
                    .iter()
                    .for_each(|(handle, collider)| visit(handle, collider));
                continue;
            }
            let dispatcher = sets.narrow_phase.query_dispatcher();
            let filter = QueryFilter::new();
            let query =
                sets.broad_phase
                    .as_query_pipeline(dispatcher, sets.bodies, sets.colliders, filter);
            for (handle, collider) in query.intersect_aabb_conservative(near) {
                visit(handle, collider);
            }
        }
        // The order of the tree is not that of the handles.
        self.swept_hits
            .sort_unstable_by_key(|(index, handle)| (*index, handle.into_raw_parts()));
    }

    fn gather_flex(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let dt = f64::from(sets.integration_parameters.dt);
        self.flex.clear();
        self.flex_of_collider.clear();
        for (handle, body) in flex_bodies.iter() {
            let nodes = body.mesh().boundary().nodes();
            let mut swept = Aabb::new_invalid();
            let mut length = 0.0;
            let mut last = node_vec(body.positions(), nodes[nodes.len() - 1]);
            for &node in nodes {
                let position = node_vec(body.positions(), node);
                swept.take_point(to_rapier(position));
                swept.take_point(to_rapier(position + dt * node_vec(body.velocities(), node)));
                length += (position - last).norm();
                last = position;
            }
            let edge = length / nodes.len() as f64;
            let fall = from_rapier(sets.gravity).norm() * body.gravity_scale().abs() * dt * dt;
            let margin = 0.5 * edge + fall;
            let swept = swept.loosened(margin as Real);
            self.flex_of_collider
                .insert(body.collider_handle(), self.flex.len());
            let index = handle.into_raw_parts().0;
            self.flex.push(ClaimedFlex {
                index,
                collider: body.collider_handle(),
                swept,
                edge,
            });
        }
    }

    /// Walks the contact graph of the detection step.
    pub fn walk(&mut self, sets: &RapierSets<'_>) {
        self.rigid.clear();
        self.rigid_index.clear();
        self.pairs.clear();
        self.seen.clear();
        self.parent.clear();
        self.parent.extend(0..self.flex.len());
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
            if self.passes_filters(sets, own.collider, handle) {
                self.neighbours.push(handle);
            }
        }
        self.neighbours
            .sort_unstable_by_key(|handle| handle.into_raw_parts());
        self.neighbours.dedup();
    }

    /// What rapier's narrow phase would ask of a pair it does not list yet.
    fn passes_filters(
        &self,
        sets: &RapierSets<'_>,
        own: ColliderHandle,
        other: ColliderHandle,
    ) -> bool {
        let (Some(own), Some(other)) = (sets.colliders.get(own), sets.colliders.get(other)) else {
            return false;
        };
        other.is_enabled()
            && !own.is_sensor()
            && !other.is_sensor()
            && own.collision_groups().test(other.collision_groups())
    }

    fn add_flex_pair(&mut self, sets: &RapierSets<'_>, flex: usize, other: ColliderHandle) {
        if let Some(&target) = self.flex_of_collider.get(&other) {
            if self.flex[flex].swept.intersects(&self.flex[target].swept) && flex < target {
                self.unite(flex, target);
                self.pairs.push(ClaimedPair::FlexFlex(flex, target));
            }
            return;
        }
        let Some(collider) = sets.colliders.get(other) else {
            return;
        };
        let swept = swept_box(sets.bodies, collider, sets.integration_parameters.dt);
        if collider.is_sensor() || !swept.intersects(&self.flex[flex].swept) {
            return;
        }
        self.pairs.push(ClaimedPair::FlexRigid(flex, other));
        if let Some(parent) = claimable_parent(sets, collider) {
            let member = self.claim(parent);
            self.unite(flex, member);
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
        let own_box = swept_box(sets.bodies, own_collider, dt);
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
            if (touches || near) && !self.flex_of_collider.contains_key(&other) {
                self.neighbours.push(other);
            }
        }
        self.neighbours
            .sort_unstable_by_key(|handle| handle.into_raw_parts());
        self.neighbours.dedup();
        for slot in 0..self.neighbours.len() {
            let other = self.neighbours[slot];
            let is_ordered = own.into_raw_parts() < other.into_raw_parts();
            let ordered = if is_ordered {
                (own, other)
            } else {
                (other, own)
            };
            let Some(collider) = sets.colliders.get(other) else {
                continue;
            };
            let solves = own_collider.solver_groups().test(collider.solver_groups());
            if !solves || collider.is_sensor() || !self.seen.insert(ordered) {
                continue;
            }
            self.pairs
                .push(ClaimedPair::RigidRigid(ordered.0, ordered.1));
            if let Some(parent) = claimable_parent(sets, collider) {
                let other_member = self.claim(parent);
                let own_member = self.claim(body);
                self.unite(own_member, other_member);
            }
        }
    }

    /// Member index of a rigid body, claimed now if it was not.
    fn claim(&mut self, handle: RigidBodyHandle) -> usize {
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

    fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    fn unite(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        // The smaller index stays the root, so that components do not depend on the order of unions.
        self.parent[one.max(other)] = one.min(other);
    }
}

/// The dynamic rigid body of a collider, if the flexible stage can solve for it.
pub(crate) fn claimable_parent(
    sets: &RapierSets<'_>,
    collider: &Collider,
) -> Option<RigidBodyHandle> {
    let parent = collider.parent()?;
    let body = sets.bodies.get(parent)?;
    let is_free = body.is_dynamic() && body.is_enabled() && !body.is_soft_frame();
    let is_link = sets.multibody_joints.rigid_body_link(parent).is_some();
    (is_free && !is_link).then_some(parent)
}

/// Box of a collider from where it is to where its velocity takes it.
pub(crate) fn swept_box(bodies: &RigidBodySet, collider: &Collider, dt: Real) -> Aabb {
    let aabb = collider.compute_aabb();
    let Some(body) = collider.parent().and_then(|parent| bodies.get(parent)) else {
        return aabb;
    };
    if body.is_fixed() {
        return aabb;
    }
    let extents = aabb.half_extents();
    let turn = (body.angvel().abs() * dt).min(1.0) * extents.length();
    let shift: Vector = body.linvel() * dt;
    let moved = Aabb::new(aabb.mins + shift, aabb.maxs + shift);
    aabb.merged(&moved).loosened(turn + 0.01 * extents.length())
}
