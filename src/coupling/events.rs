//! Events: the user's handler hears of carriers and claimed bodies what the flexible stage did, and of all others rapier.
//!
//! Rapier announces what its narrow phase sees, in two steps of which one has no length. Three things would be wrong for
//! the user: contacts that close within the step end in the step without length and start again in the next one; a contact
//! that the flexible stage finds within a step is seen by rapier a step later, or never; and locked bodies keep the
//! impulses of an earlier step. So stops of the first step are held back until the second confirms them, contacts that press are
//! announced in the step in which they do, and forces are ours.

use super::claim::Claims;
use super::force_pair::ForcePairs;
use super::pair_name::{PairName, pair_name};
use super::pressed_point::PressedPoint;
use super::sets::RapierSets;
use crate::math::{HashMap, HashSet};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What the handler was told about pairs of carriers and claimed bodies.
#[derive(Debug, Default)]
pub(crate) struct EventBook {
    pub(super) heard: Mutex<Heard>,
    /// Pairs that pressed in the last step: whether above their threshold.
    pub(super) pressed: HashMap<PairName, bool>,
    /// Those of the step before.
    pressed_before: HashMap<PairName, bool>,
    points: Vec<PressedPoint>,
    names: Vec<PairName>,
}

/// What came from rapier, and what of it was passed on.
#[derive(Debug, Default)]
pub(super) struct Heard {
    /// Pairs that the user knows to touch and rapier has not announced.
    pub(super) ahead: HashSet<PairName>,
    /// Events not passed on yet, in rapier's order.
    pub(super) held: Vec<CollisionEvent>,
    /// Events of sensors that were left in the step without length, from there on.
    pub(super) left: Vec<CollisionEvent>,
    pairs: ForcePairs,
}

pub(super) fn lock(heard: &Mutex<Heard>) -> MutexGuard<'_, Heard> {
    heard.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The handler that rapier is given in place of the user's.
pub(crate) struct EventGate<'a> {
    pub(super) user: &'a dyn EventHandler,
    pub(super) book: &'a EventBook,
    /// The claim of this step; `None` in the detection step.
    pub(super) claims: Option<&'a Claims>,
}

impl EventBook {
    /// Whether there is nothing the user still has to hear of.
    pub fn is_empty(&self) -> bool {
        let heard = lock(&self.heard);
        heard.ahead.is_empty()
            && heard.held.is_empty()
            && heard.left.is_empty()
            && self.pressed.is_empty()
    }

    /// The gate for rapier's detection step, or with a claim for its full step.
    pub fn gate<'a>(
        &'a self,
        user: &'a dyn EventHandler,
        claims: Option<&'a Claims>,
    ) -> EventGate<'a> {
        EventGate {
            user,
            book: self,
            claims,
        }
    }

    /// Notes a point of contact, if either collider asks for events. Before rapier's full step, which changes what is read
    /// here of its last one.
    pub fn note(&mut self, mut point: PressedPoint, sets: &RapierSets<'_>) {
        let name = point.name();
        if listens(name, ActiveEvents::all(), sets.colliders) {
            point.was_above = !self.pressed.contains_key(&name) && was_above_in_rapier(name, sets);
            self.points.push(point);
        }
    }

    /// Forgets the points of a step that was not taken.
    pub fn discard_notes(&mut self) {
        self.points.clear();
    }

    /// Tells the user what a step without length changed.
    pub fn tell_detected(&mut self, sets: &RapierSets<'_>) {
        self.points.clear();
        self.tell_left(sets);
        self.tell_held(sets);
    }

    /// Tells the user what changed in the step, after everything has landed.
    pub fn tell(&mut self, sets: &RapierSets<'_>) {
        self.points.sort_by_key(|point| {
            let [one, other] = point.name();
            (one.into_raw_parts(), other.into_raw_parts())
        });
        self.tell_left(sets);
        self.tell_held(sets);
        self.tell_ahead(sets);
        self.tell_forces(sets);
        self.points.clear();
    }

    /// The points of a pair.
    fn points_of(&self, name: PairName) -> &[PressedPoint] {
        let first = self
            .points
            .partition_point(|point| is_before(point.name(), name));
        let count = self.points[first..].partition_point(|point| point.name() == name);
        &self.points[first..first + count]
    }

    fn is_closed(&self, name: PairName) -> bool {
        self.points_of(name).iter().any(|point| point.is_closed)
    }

    /// Passes on what rapier's two steps together changed.
    fn tell_held(&mut self, sets: &RapierSets<'_>) {
        let held = std::mem::take(&mut lock(&self.heard).held);
        for (index, first) in held.iter().enumerate() {
            let name = name_of(first);
            let same = |event: &&CollisionEvent| name_of(event) == name;
            if held[..index].iter().any(|event| same(&event)) {
                continue;
            }
            let last = held[index..].iter().rev().find(same).unwrap_or(first);
            let was_ahead = lock(&self.heard).ahead.remove(&name);
            let was_touching = was_ahead || first.stopped();
            let touches = last.started() || self.is_closed(name);
            if touches && !last.started() {
                lock(&self.heard).ahead.insert(name);
            }
            if touches != was_touching {
                self.tell_collision(name, touches, sets);
            }
        }
        let mut heard = lock(&self.heard);
        heard.held = held;
        heard.held.clear();
    }

    /// Tells of contacts that rapier does not see: those that press already, and those that did and have opened.
    fn tell_ahead(&mut self, sets: &RapierSets<'_>) {
        let mut names = std::mem::take(&mut self.names);
        names.clear();
        let closed = self.points.iter().filter(|point| point.is_closed);
        names.extend(closed.map(PressedPoint::name));
        names.dedup();
        for &name in &names {
            let is_listened_to = listens(name, ActiveEvents::COLLISION_EVENTS, sets.colliders);
            if is_listened_to
                && !is_seen_by_rapier(name, sets)
                && lock(&self.heard).ahead.insert(name)
            {
                self.tell_collision(name, true, sets);
            }
        }
        names.clear();
        names.extend(lock(&self.heard).ahead.iter());
        names.sort_unstable_by_key(|[one, other]| (one.into_raw_parts(), other.into_raw_parts()));
        for &name in &names {
            if self.is_closed(name) {
                continue;
            }
            lock(&self.heard).ahead.remove(&name);
            self.tell_collision(name, false, sets);
        }
        self.names = names;
    }

    fn tell_collision(&self, name: PairName, starts: bool, sets: &RapierSets<'_>) {
        let [one, other] = in_rapiers_order(name, sets);
        let lives = name.iter().all(|&handle| sets.colliders.contains(handle));
        let event = if starts {
            CollisionEvent::Started(one, other, CollisionEventFlags::empty())
        } else if lives {
            CollisionEvent::Stopped(one, other, CollisionEventFlags::empty())
        } else {
            CollisionEvent::Stopped(one, other, CollisionEventFlags::REMOVED)
        };
        let (bodies, colliders) = (&*sets.bodies, &*sets.colliders);
        let user = sets.events;
        let known = sets.narrow_phase.contact_pair(one, other);
        if let Some(pair) = known.filter(|pair| pair.has_any_active_contact() || !starts) {
            user.handle_collision_event(bodies, colliders, event, Some(pair));
            return;
        }
        let dt = f64::from(sets.integration_parameters.dt);
        let mut pairs = std::mem::take(&mut lock(&self.heard).pairs);
        let pair = pairs.fill([one, other], false, self.points_of(name), colliders, dt);
        user.handle_collision_event(bodies, colliders, event, Some(pair));
        lock(&self.heard).pairs = pairs;
    }

    /// Tells of forces above the threshold of their pair.
    fn tell_forces(&mut self, sets: &RapierSets<'_>) {
        let dt = f64::from(sets.integration_parameters.dt);
        let mut names = std::mem::take(&mut self.names);
        names.clear();
        names.extend(self.points.iter().map(PressedPoint::name));
        names.dedup();
        let mut pairs = std::mem::take(&mut lock(&self.heard).pairs);
        std::mem::swap(&mut self.pressed, &mut self.pressed_before);
        self.pressed.clear();
        for &name in &names {
            let Some(threshold) = threshold(name, sets.colliders) else {
                continue;
            };
            let points = self.points_of(name);
            let total: f64 = points.iter().map(|point| point.force[0]).sum();
            // What has opened for good has no force that is told, though what takes back its energy may press.
            let is_above = total > threshold && points.iter().any(|point| point.is_closed);
            if is_above {
                let order = in_rapiers_order(name, sets);
                let known = self.pressed_before.get(&name).copied();
                let was_above = known.unwrap_or_else(|| points.iter().any(|point| point.was_above));
                let pair = pairs.fill(order, was_above, points, sets.colliders, dt);
                let (bodies, colliders) = (&*sets.bodies, &*sets.colliders);
                let user = sets.events;
                user.handle_contact_force_event(dt as Real, bodies, colliders, pair, total as Real);
            }
            self.pressed.insert(name, is_above);
        }
        lock(&self.heard).pairs = pairs;
        self.names = names;
    }
}

fn is_before(one: PairName, other: PairName) -> bool {
    one.map(ColliderHandle::into_raw_parts) < other.map(ColliderHandle::into_raw_parts)
}

pub(super) fn name_of(event: &CollisionEvent) -> PairName {
    pair_name(event.collider1(), event.collider2())
}

/// The two colliders as rapier's pair has them, if it has one.
fn in_rapiers_order([one, other]: PairName, sets: &RapierSets<'_>) -> [ColliderHandle; 2] {
    let pair = sets.narrow_phase.contact_pair(one, other);
    pair.map_or([one, other], |pair| [pair.collider1, pair.collider2])
}

fn is_seen_by_rapier([one, other]: PairName, sets: &RapierSets<'_>) -> bool {
    let pair = sets.narrow_phase.contact_pair(one, other);
    pair.is_some_and(ContactPair::has_any_active_contact)
}

fn was_above_in_rapier([one, other]: [ColliderHandle; 2], sets: &RapierSets<'_>) -> bool {
    let pair = sets.narrow_phase.contact_pair(one, other);
    let dt = sets.integration_parameters.dt;
    pair.is_some_and(|pair| !ContactForceEvent::from_contact_pair(dt, pair, 0.0).started)
}

fn listens(name: PairName, events: ActiveEvents, colliders: &ColliderSet) -> bool {
    let mut both = name.iter().filter_map(|&handle| colliders.get(handle));
    both.any(|collider| collider.active_events().intersects(events))
}

/// The lower threshold of the two colliders that ask for force events (N), as in rapier.
fn threshold(name: PairName, colliders: &ColliderSet) -> Option<f64> {
    let both = name.iter().filter_map(|&handle| colliders.get(handle));
    both.filter(|collider| {
        let events = collider.active_events();
        events.contains(ActiveEvents::CONTACT_FORCE_EVENTS)
    })
    .map(|collider| f64::from(collider.contact_force_event_threshold()))
    .reduce(f64::min)
}

impl EventGate<'_> {
    /// Tells that a pair which became a sensor's has stopped to touch, before it starts to intersect.
    fn end_contact(&self, name: PairName, bodies: &RigidBodySet, colliders: &ColliderSet) {
        let mut heard = lock(&self.book.heard);
        let held = heard.held.iter().find(|held| name_of(held) == name);
        let stop = held.copied().filter(|held| held.stopped());
        let is_ahead = heard.ahead.remove(&name);
        heard.held.retain(|held| name_of(held) != name);
        let [one, other] = match stop {
            Some(stop) => [stop.collider1(), stop.collider2()],
            None if is_ahead => name,
            None => return,
        };
        let mut pairs = std::mem::take(&mut heard.pairs);
        drop(heard);
        let pair = pairs.fill([one, other], false, &[], colliders, 0.0);
        let event = CollisionEvent::Stopped(one, other, CollisionEventFlags::empty());
        self.user
            .handle_collision_event(bodies, colliders, event, Some(pair));
        lock(&self.book.heard).pairs = pairs;
    }

    /// Whether the flexible stage solves a pair in this step.
    fn is_ours(&self, [one, other]: [ColliderHandle; 2], colliders: &ColliderSet) -> bool {
        let Some(claims) = self.claims else {
            return false;
        };
        [one, other]
            .iter()
            .any(|&handle| claims.has_collider(handle, colliders))
    }
}

impl EventHandler for EventGate<'_> {
    fn handle_collision_event(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        event: CollisionEvent,
        pair: Option<&ContactPair>,
    ) {
        let forward = || {
            self.user
                .handle_collision_event(bodies, colliders, event, pair);
        };
        let name = name_of(&event);
        if event.sensor() {
            self.end_contact(name, bodies, colliders);
            if self.holds_back(name, &event) {
                return;
            }
            return forward();
        }
        self.end_intersection(name, bodies, colliders);
        let mut heard = lock(&self.book.heard);
        if event.removed() {
            heard.ahead.remove(&name);
            drop(heard);
            return forward();
        }
        let is_ours = self.is_ours([event.collider1(), event.collider2()], colliders);
        if is_ours || (self.claims.is_none() && event.stopped()) {
            heard.held.push(event);
            return;
        }
        let n_held = heard.held.len();
        heard.held.retain(|held| name_of(held) != name);
        let lasts = heard.held.len() < n_held;
        let is_known = event.started() && (heard.ahead.remove(&name) || lasts);
        drop(heard);
        if !is_known {
            forward();
        }
    }

    fn handle_contact_force_event(
        &self,
        dt: Real,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
        force: Real,
    ) {
        if self.is_ours([pair.collider1, pair.collider2], colliders) {
            // Impulses of an earlier step.
            return;
        }
        let name = pair_name(pair.collider1, pair.collider2);
        let was_above = self.book.pressed.get(&name).copied().unwrap_or(false);
        if was_above && ContactForceEvent::from_contact_pair(dt, pair, force).started {
            let mut pairs = std::mem::take(&mut lock(&self.book.heard).pairs);
            let lasting = pairs.lasting(pair);
            self.user
                .handle_contact_force_event(dt, bodies, colliders, lasting, force);
            lock(&self.book.heard).pairs = pairs;
            return;
        }
        self.user
            .handle_contact_force_event(dt, bodies, colliders, pair, force);
    }

    fn handle_soft_body_tear_event(&self, soft_bodies: &SoftBodySet, event: &SoftBodyTearEvent) {
        self.user.handle_soft_body_tear_event(soft_bodies, event);
    }
}
