//! What a member that has left the box it was looked for in meets on its way, and was not kept apart from.
//!
//! Judged by boxes, and on the safe side: a pair counts as kept apart only where all of both was near enough to be listed when the step began.

use super::changes::Changes;
use super::claim_attachments::Attached;
use super::ends::{Ends, known, thrown_by};
use super::filter::Answers;
use super::hand_back::end_pose;
use super::landing::Landing;
use super::outlines::is_convex_piece;
use super::places::{loosened, placed_on, swept_box};
use super::roster::{ClaimedFlex, Roster};
use super::sets::RapierSets;
use super::sleep::reaches;
use super::strikes::Strikes;
use super::sweep::{farthest_travel, is_fixed_and_settled};
use super::walk::ClaimedPair;
use crate::math::to_rapier;
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// What a step was solved with.
pub(super) struct Listed<'a> {
    pub flex: &'a Roster,
    pub changes: &'a Changes,
    pub attached: &'a Attached,
    /// Pairs that were kept apart.
    pub pairs: &'a [ClaimedPair],
    /// By how much the boxes have grown in this step (m).
    pub excess: Real,
}

/// A collider of a member.
struct Traveller {
    collider: ColliderHandle,
    /// Box of where it has been in the step.
    way: Aabb,
    /// By how much it left the box that it was looked for in (m).
    out: Real,
}

impl Listed<'_> {
    /// Whether a member that has left its box meets something on the way that was not in the problem.
    ///
    /// - `answers`, `strikes`: what the user's filter has said, and who strikes whom.
    pub fn lacks_what_is_met(
        &self,
        ends: &Ends<'_>,
        sets: &RapierSets<'_>,
        (answers, strikes): (&mut Answers, &mut Strikes),
    ) -> bool {
        let travellers = self.travellers(ends, sets);
        let leavers = || travellers.iter().filter(|own| own.out > 0.0);
        leavers().any(|own| {
            self.meets_traveller(own, &travellers, sets, answers)
                || self.meets_other(own, &travellers, sets, answers)
        }) || self.meets_driven(leavers(), sets, (answers, strikes))
    }

    /// Where the colliders of members have been.
    fn travellers(&self, ends: &Ends<'_>, sets: &RapierSets<'_>) -> Vec<Traveller> {
        let flexible = self.flex.iter().filter_map(|own| {
            let (end, out) = ends.of_flex(own)?;
            Some(Traveller {
                collider: own.collider,
                way: own.swept.merged(&loosened(end, own.slack)),
                out,
            })
        });
        let mut travellers: Vec<Traveller> = flexible.collect();
        for landing in ends.landings {
            let Some(body) = sets.bodies.get(landing.handle) else {
                continue;
            };
            let out = thrown_by(landing, self.excess, sets);
            for &handle in body.colliders() {
                let Some(collider) = sets.colliders.get(handle) else {
                    continue;
                };
                travellers.push(Traveller {
                    collider: handle,
                    way: self.way_of(body, collider, (landing, out), sets),
                    out,
                });
            }
        }
        travellers
    }

    /// Box of where a collider of a claimed rigid body has been.
    fn way_of(
        &self,
        body: &RigidBody,
        collider: &Collider,
        (landing, out): (&Landing, Real),
        sets: &RapierSets<'_>,
    ) -> Aabb {
        let swept = swept_box(sets, collider);
        let skin = collider.contact_skin();
        let offset = collider.position_wrt_parent().copied().unwrap_or_default();
        let end = collider
            .shape()
            .compute_aabb(&(end_pose(body, landing) * offset));
        let way = swept.merged(&loosened(end, skin));
        if out == 0.0 {
            return loosened(way, known(self.excess, sets));
        }
        // What is thrown may turn in any way on its own.
        let start = collider.shape().compute_aabb(&placed_on(body, collider));
        let centre = body.center_of_mass();
        let farthest = (start.maxs - centre).abs().max((start.mins - centre).abs());
        let to = to_rapier(landing.motion.centre);
        let centres = Aabb::new(centre.min(to), centre.max(to));
        way.merged(&loosened(centres, farthest.length() + skin))
    }

    /// Whether a member that has left its box has met another member that it was not kept apart from.
    fn meets_traveller(
        &self,
        own: &Traveller,
        travellers: &[Traveller],
        sets: &RapierSets<'_>,
        answers: &mut Answers,
    ) -> bool {
        let parent = parent_of(own.collider, sets);
        let mut others = travellers.iter().filter(|other| {
            let is_own = other.collider == own.collider
                || parent.is_some() && parent_of(other.collider, sets) == parent;
            !is_own && other.way.intersects(&own.way)
        });
        others.any(|other| {
            let names = [own.collider, other.collider];
            !self.is_listed(names, own.out + other.out, sets)
                && self.may_press(names, sets, answers)
        })
    }

    /// Whether a member that has left its box has met what is no member, or no member on that way.
    fn meets_other(
        &self,
        own: &Traveller,
        travellers: &[Traveller],
        sets: &RapierSets<'_>,
        answers: &mut Answers,
    ) -> bool {
        let is_member = |handle| travellers.iter().any(|one| one.collider == handle);
        let mut meets = |handle: ColliderHandle, other: &Collider| {
            if is_member(handle) {
                return false;
            }
            if self.flex.is_sleeping_surface(handle) {
                return reaches(sets, handle, &own.way)
                    && answers.may_touch(sets, own.collider, handle);
            }
            let names = [own.collider, handle];
            swept_box(sets, other).intersects(&own.way)
                && may_reach(&own.way, other, sets)
                && !self.is_listed(names, own.out, sets)
                && self.may_press(names, sets, answers)
        };
        let query = sets.broad_phase.as_query_pipeline(
            sets.narrow_phase.query_dispatcher(),
            sets.bodies,
            sets.colliders,
            QueryFilter::new(),
        );
        let near = loosened(own.way, farthest_travel(sets, self.flex));
        let mut meets_itself = false;
        for (handle, other) in query.intersect_aabb_conservative(near) {
            meets_itself |= handle == own.collider;
            if meets(handle, other) {
                return true;
            }
        }
        // A detection step may leave the tree empty: then all colliders are asked.
        !meets_itself
            && sets
                .colliders
                .iter()
                .any(|(handle, other)| meets(handle, other))
    }

    /// Whether something may be driven into a flexible body where it has left its box.
    fn meets_driven<'a>(
        &self,
        leavers: impl Iterator<Item = &'a Traveller>,
        sets: &RapierSets<'_>,
        (answers, strikes): (&mut Answers, &mut Strikes),
    ) -> bool {
        let is_flexible = |own: &&Traveller| self.flex.slot_of(own.collider).is_some();
        let leavers: Vec<&Traveller> = leavers.filter(is_flexible).collect();
        if leavers.is_empty() {
            return false;
        }
        let boxes = leavers.iter().map(|own| own.way);
        let mut driven = Vec::new();
        strikes.meet(
            sets,
            (self.flex, self.changes),
            boxes,
            |slot, handle, reach| {
                driven.push((leavers[slot], handle, reach));
            },
        );
        driven.iter().any(|&(own, handle, reach)| {
            let names = [own.collider, handle];
            !self.is_listed(names, own.out + reach, sets) && self.may_press(names, sets, answers)
        })
    }

    /// Whether two colliders that together have left their boxes by `out` were kept apart all the same.
    ///
    /// What is not led along a path is listed along its own motion, and would be listed no better if the step were solved again.
    fn is_listed(&self, names: [ColliderHandle; 2], out: Real, sets: &RapierSets<'_>) -> bool {
        let is_pair = |one, other| names == [one, other] || names == [other, one];
        self.pairs.iter().any(|pair| match *pair {
            // All of both is led.
            ClaimedPair::FlexFlex(one, other) => {
                is_pair(self.flex[one].collider, self.flex[other].collider)
            }
            // Of a rigid one the pieces near the surface are.
            ClaimedPair::FlexRigid(flex, collider) => {
                let own = &self.flex[flex];
                is_pair(own.collider, collider) && self.was_led(own, collider, out, sets)
            }
            ClaimedPair::RigidRigid(one, other) => {
                let near = known(self.excess, sets);
                is_pair(one, other) && self.were_near([one, other], near, sets)
            }
        })
    }

    /// Whether all was led of a rigid collider that a flexible body has met where both have left their boxes by `out` (m).
    fn was_led(
        &self,
        own: &ClaimedFlex,
        collider: ColliderHandle,
        out: Real,
        sets: &RapierSets<'_>,
    ) -> bool {
        // Its box is where it was, grown by travel and slack; pieces are led that are as near as travel, edge and fall.
        let is_within = own.slack + out + known(self.excess, sets) <= (own.edge + own.fall) as Real;
        let near = own.reach() as Real - known(self.excess, sets);
        is_within || self.were_near([own.collider, collider], near, sets)
    }

    /// Whether two colliders were within a distance (m) of each other when the step began, those of rigid bodies in one piece each: then
    /// they were kept apart wherever they went.
    fn were_near(&self, pair: [ColliderHandle; 2], near: Real, sets: &RapierSets<'_>) -> bool {
        let boxes = pair.map(|handle| {
            let collider = sets.colliders.get(handle)?;
            let body = collider.parent().and_then(|parent| sets.bodies.get(parent));
            let pose = body.map_or(*collider.position(), |body| placed_on(body, collider));
            let is_whole = self.flex.is_surface(handle) || is_convex_piece(collider.shape());
            is_whole.then(|| collider.shape().compute_aabb(&pose))
        });
        match boxes {
            [Some(one), Some(other)] => loosened(one, near).intersects(&other),
            _ => false,
        }
    }

    /// Whether two colliders may press each other.
    fn may_press(
        &self,
        names: [ColliderHandle; 2],
        sets: &RapierSets<'_>,
        answers: &mut Answers,
    ) -> bool {
        let groups = names.map(|name| match self.flex.slot_of(name) {
            Some(flex) => Some(self.flex[flex].solver_groups),
            None => Some(sets.colliders.get(name)?.solver_groups()),
        });
        let [Some(one), Some(other)] = groups else {
            return false;
        };
        let forbids = |[flex, other]: [ColliderHandle; 2]| {
            let slot = self.flex.slot_of(flex);
            slot.is_some_and(|slot| self.attached.forbids(sets, self.flex, slot, other))
        };
        let [own, met] = names;
        one.test(other)
            && answers.may_touch(sets, own, met)
            && !forbids([own, met])
            && !forbids([met, own])
    }
}

/// Whether a box may meet a collider that its box meets: shapes that stay where they are tell exactly.
fn may_reach(way: &Aabb, other: &Collider, sets: &RapierSets<'_>) -> bool {
    if !is_fixed_and_settled(sets, other) {
        return true;
    }
    let way = loosened(*way, other.contact_skin());
    let at = Pose::from_translation(way.center());
    let cuboid = Cuboid::new(way.half_extents());
    let dispatcher = sets.narrow_phase.query_dispatcher();
    let between = at.inverse() * *other.position();
    dispatcher
        .intersection_test(&between, &cuboid, other.shape())
        .map_or(true, |met| met.intersecting)
}

fn parent_of(handle: ColliderHandle, sets: &RapierSets<'_>) -> Option<RigidBodyHandle> {
    sets.colliders.get(handle).and_then(Collider::parent)
}
