//! Strikes: what flies past a flexible body, or rests beside it, is struck within the step and driven into it.
//!
//! A claim looks for what may be met along the velocities that the step begins with. Rapier's own step changes those of bodies that nobody
//! has claimed: what closes in on a body at `v` sends it off by less than `2 v`, at any ratio of masses and any restitution. So a body
//! that is about to be struck is looked for as far around its own way as twice what strikes it, or anything that it touches, closes in.
//! A row of bodies that touch, each lighter than the one before, hands a blow on faster than that: what it leaves in a flexible body is told
//! ([`super::trespassers`]).

use super::changes::Changes;
use super::filter::{claimable_body, claimable_parent};
use super::places::{loosened, swept_box, travel_vector};
use super::roster::Roster;
use super::sets::RapierSets;
use crate::math::HashMap;
use crate::rapier::math::{Real, Vector};
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// Velocity of what is struck over that at which it is struck, at most: a light body off a heavy one, without loss.
const THROWN: Real = 2.0;

/// A collider that moves.
#[derive(Clone, Copy, Debug)]
struct Mover {
    collider: ColliderHandle,
    body: RigidBodyHandle,
    swept: Aabb,
    /// Way of its body in the step (m).
    way: Vector,
    /// How far its farthest point turns in it (m).
    turn: Real,
}

/// What moves, and how hard it strikes: nothing of it outlives [`Strikes::meet`].
#[derive(Debug, Default)]
pub(super) struct Strikes {
    /// In the order of their left ends.
    movers: Vec<Mover>,
    /// Width of the widest (m).
    widest: Real,
    /// How far any two may close in on each other in the step (m).
    hardest: Real,
    /// By body, the slot of the bodies that it touches or is struck with.
    group_of: HashMap<RigidBodyHandle, usize>,
    /// How far the two of a group that close in the most do so in the step (m).
    blow_of: Vec<Real>,
    waiting: Vec<RigidBodyHandle>,
    /// Colliders beside a box.
    beside: Vec<ColliderHandle>,
}

impl Strikes {
    /// Visits what is about to be struck and may be driven into one of some boxes: the number of the box, the collider, and how far around
    /// its own way it may be driven (m).
    ///
    /// - `known`: the flexible bodies, whose surfaces strike by themselves, and what may move.
    pub fn meet(
        &mut self,
        sets: &RapierSets<'_>,
        (flex, changes): (&Roster, &Changes),
        boxes: impl Iterator<Item = Aabb>,
        mut visit: impl FnMut(usize, ColliderHandle, Real),
    ) {
        self.list_movers(sets, flex, changes);
        for (slot, around) in boxes.enumerate() {
            self.visit_struck(sets, flex, &around, |handle, reach| {
                visit(slot, handle, reach);
            });
        }
    }

    /// Lists what moves.
    fn list_movers(&mut self, sets: &RapierSets<'_>, flex: &Roster, changes: &Changes) {
        let dt = sets.integration_parameters.dt;
        self.movers.clear();
        self.group_of.clear();
        self.blow_of.clear();
        let (mut farthest, mut widest): (Real, Real) = (0.0, 0.0);
        for (handle, collider) in changes.unsettled(sets) {
            let parent = collider.parent();
            let body = parent.and_then(|parent| Some((parent, sets.bodies.get(parent)?)));
            let Some((parent, body)) = body else { continue };
            let moves = !body.is_fixed() && !body.is_sleeping() && body.is_enabled();
            if !moves || !collider.is_enabled() || collider.is_sensor() || flex.is_surface(handle) {
                continue;
            }
            let swept = swept_box(sets, collider);
            let (way, turn) = (travel_vector(body, dt), turn_of(body, &swept, dt));
            // What is no number rapier takes out.
            if !(way.length() + turn).is_finite() || !swept.mins.is_finite() {
                continue;
            }
            farthest = farthest.max(way.length() + turn);
            widest = widest.max(swept.extents().x);
            self.movers.push(Mover {
                collider: handle,
                body: parent,
                swept,
                way,
                turn,
            });
        }
        self.movers.sort_unstable_by(|one, other| {
            let left = one.swept.mins.x.total_cmp(&other.swept.mins.x);
            let handles = [one, other].map(|mover| mover.collider.into_raw_parts());
            left.then(handles[0].cmp(&handles[1]))
        });
        self.movers.dedup_by_key(|mover| mover.collider);
        (self.widest, self.hardest) = (widest, 2.0 * farthest);
    }

    /// Visits colliders of bodies that miss a box by their own motion, or sleep in it, and may be driven into it, with how far they may be
    /// driven (m).
    fn visit_struck(
        &mut self,
        sets: &RapierSets<'_>,
        flex: &Roster,
        around: &Aabb,
        mut visit: impl FnMut(ColliderHandle, Real),
    ) {
        let farthest = THROWN * self.hardest;
        if farthest > sets.integration_parameters.prediction_distance() {
            self.list_beside(&loosened(*around, farthest), sets, flex);
            for slot in 0..self.beside.len() {
                let handle = self.beside[slot];
                let Some(collider) = sets.colliders.get(handle) else {
                    continue;
                };
                let Some(body) = claimable_parent(sets, collider) else {
                    continue;
                };
                let away = apart(&swept_box(sets, collider), around);
                // What moves into the box by itself is found without this; what sleeps there does not move before it is struck.
                let sleeps = sets.bodies.get(body).is_some_and(RigidBody::is_sleeping);
                let is_beside = away > 0.0 || sleeps;
                if !is_beside || away > farthest || collider.is_sensor() {
                    continue;
                }
                let reach = self.reach_of(body, sets, flex);
                if reach > 0.0 && away <= reach {
                    visit(handle, reach);
                }
            }
        }
    }

    /// Lists the colliders near a box: those that move, and those that rapier's tree has there.
    fn list_beside(&mut self, near: &Aabb, sets: &RapierSets<'_>, flex: &Roster) {
        self.beside.clear();
        let first = self
            .movers
            .partition_point(|mover| mover.swept.mins.x < near.mins.x - self.widest);
        let moving = self.movers[first..].iter();
        let moving = moving.take_while(|mover| mover.swept.mins.x <= near.maxs.x);
        let beside = moving.filter(|mover| mover.swept.intersects(near));
        self.beside.extend(beside.map(|mover| mover.collider));
        let query = sets.broad_phase.as_query_pipeline(
            sets.narrow_phase.query_dispatcher(),
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        let in_tree = query.intersect_aabb_conservative(*near);
        let resting = in_tree.filter(|(handle, _)| !flex.is_surface(*handle));
        self.beside.extend(resting.map(|(handle, _)| handle));
        self.beside
            .sort_unstable_by_key(|handle| handle.into_raw_parts());
        self.beside.dedup();
    }

    /// How far a collider of a body in such a group may be driven (m).
    fn reach_of(&mut self, body: RigidBodyHandle, sets: &RapierSets<'_>, flex: &Roster) -> Real {
        let group = self.group_of.get(&body).copied();
        let group = group.unwrap_or_else(|| self.walk_group(body, sets, flex));
        THROWN * self.blow_of[group]
    }

    /// Walks from a body through what touches it or closes in on it; returns the slot of the group.
    fn walk_group(
        &mut self,
        first: RigidBodyHandle,
        sets: &RapierSets<'_>,
        flex: &Roster,
    ) -> usize {
        let group = self.blow_of.len();
        let mut blow: Real = 0.0;
        self.group_of.insert(first, group);
        self.waiting.push(first);
        while let Some(handle) = self.waiting.pop() {
            let Some(body) = sets.bodies.get(handle) else {
                continue;
            };
            for &own in body.colliders() {
                for pair in sets.narrow_phase.contact_pairs_with(own) {
                    if flex.is_surface(pair.collider1) || flex.is_surface(pair.collider2) {
                        continue;
                    }
                    let closing = closing_of(pair, sets);
                    blow = blow.max(closing.unwrap_or(0.0));
                    let is_first = pair.collider1 == own;
                    let other = if is_first {
                        pair.collider2
                    } else {
                        pair.collider1
                    };
                    let other = sets.colliders.get(other).and_then(Collider::parent);
                    if let (Some(_), Some(other)) = (closing, other) {
                        self.join(group, other, sets);
                    }
                }
                blow = blow.max(self.meet_movers((group, handle), own, sets));
            }
        }
        self.blow_of.push(blow);
        group
    }

    /// Adds what moves into the way of a collider to its group; returns how far the fastest closes in (m).
    fn meet_movers(
        &mut self,
        (group, body): (usize, RigidBodyHandle),
        own: ColliderHandle,
        sets: &RapierSets<'_>,
    ) -> Real {
        let dt = sets.integration_parameters.dt;
        let (Some(collider), Some(struck)) = (sets.colliders.get(own), sets.bodies.get(body))
        else {
            return 0.0;
        };
        let swept = swept_box(sets, collider);
        let way = travel_vector(struck, dt);
        let turn = turn_of(struck, &swept, dt);
        let mut blow: Real = 0.0;
        let first = self
            .movers
            .partition_point(|mover| mover.swept.mins.x < swept.mins.x - self.widest);
        for slot in first..self.movers.len() {
            let mover = self.movers[slot];
            if mover.swept.mins.x > swept.maxs.x {
                break;
            }
            let pushes = || {
                let other = sets.colliders.get(mover.collider);
                other.is_some_and(|other| {
                    other.collision_groups().test(collider.collision_groups())
                        && other.solver_groups().test(collider.solver_groups())
                })
            };
            if mover.body != body && mover.swept.intersects(&swept) && pushes() {
                blow = blow.max((mover.way - way).length() + mover.turn + turn);
                self.join(group, mover.body, sets);
            }
        }
        blow
    }

    /// Adds a body to a group, if blows pass through it.
    fn join(&mut self, group: usize, body: RigidBodyHandle, sets: &RapierSets<'_>) {
        if claimable_body(sets, body) && !self.group_of.contains_key(&body) {
            self.group_of.insert(body, group);
            self.waiting.push(body);
        }
    }
}

/// How far two colliders close in on each other where they touch in the step (m); `None` where they do not.
fn closing_of(pair: &ContactPair, sets: &RapierSets<'_>) -> Option<Real> {
    let dt = sets.integration_parameters.dt;
    let first = sets.colliders.get(pair.collider1)?;
    let bodies = [pair.collider1, pair.collider2].map(|handle| {
        let parent = sets.colliders.get(handle).and_then(Collider::parent);
        parent.and_then(|parent| sets.bodies.get(parent))
    });
    let mut closing = None;
    for manifold in pair.manifolds() {
        for point in &manifold.points {
            let at = *first.position() * point.local_p1;
            let [one, other] = bodies
                .map(|body| body.map_or(Vector::default(), |body| body.velocity_at_point(at)));
            let speed = (one - other).dot(manifold.data.normal).max(0.0);
            closing = Some((speed * dt).max(closing.unwrap_or(0.0)));
        }
    }
    closing
}

/// How far the farthest point of a box turns with its body in the step (m).
fn turn_of(body: &RigidBody, swept: &Aabb, dt: Real) -> Real {
    let lever = swept.half_extents().length();
    (body.angvel().abs() * dt).min(1.0) * lever
}

/// How far two boxes are apart along an axis (m): no more than their distance.
fn apart(one: &Aabb, other: &Aabb) -> Real {
    let (low, high) = (other.mins - one.maxs, one.mins - other.maxs);
    low.x.max(low.y).max(high.x).max(high.y)
}
