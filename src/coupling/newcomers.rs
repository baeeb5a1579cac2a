//! What a body that has just been put where it is overlaps: looked at once, in its first step there, when all that was inserted with it is there.

use super::claim::Claims;
use super::places::placed_on;
use super::quarantine::is_out;
use super::roster::Roster;
use super::sets::RapierSets;
use super::shapes;
use super::tangles;
use super::walk::ClaimedPair;
use crate::body::{FlexBody, FlexBodyHandle, FlexBodySet};
use crate::constraint::geometry;
use crate::math::{Vec2, from_rapier, judged::Judged, node_vec};
use crate::rapier::parry::query;
use crate::rapier::prelude::*;

/// Rapier's bodies and colliders, to be read.
#[derive(Clone, Copy)]
pub(crate) struct ReadSets<'a> {
    /// Bodies.
    pub bodies: &'a RigidBodySet,
    /// Colliders.
    pub colliders: &'a ColliderSet,
}

impl<'a> From<&'a RapierSets<'_>> for ReadSets<'a> {
    fn from(sets: &'a RapierSets<'_>) -> Self {
        Self {
            bodies: sets.bodies,
            colliders: sets.colliders,
        }
    }
}

/// Depth over the length of a boundary segment from which bodies count as overlapping: what has been put into each other, not what rests.
pub(crate) const DEEP: Judged = geometry::DEEP;

/// The pairs of this step in which a flexible body that has not been stepped before, or a rigid one that the user has inserted, moved or altered,
/// overlaps what it meets.
pub(crate) fn overlaps_of_newcomers(
    claims: &Claims,
    sets: &RapierSets<'_>,
    flex_bodies: &FlexBodySet,
) -> Vec<ClaimedPair> {
    let flex = &claims.flex;
    let body_of = |slot: usize| {
        let found = flex_bodies.at_index(flex[slot].index);
        found.map(|(_, body)| body)
    };
    let overlaps = |pair: &ClaimedPair| match *pair {
        ClaimedPair::FlexRigid(slot, other) => {
            let body = body_of(slot).filter(|body| body.is_new() || claims.has_altered(other));
            body.is_some_and(|body| put_in(body, other, sets.into()) > least_depth(flex, slot))
        }
        ClaimedPair::FlexFlex(one, other) => {
            let [Some(first), Some(second)] = [one, other].map(body_of) else {
                return false;
            };
            let depth = least_depth(flex, one).min(least_depth(flex, other));
            (first.is_new() || second.is_new()) && overlap(first, second, depth)
        }
        ClaimedPair::RigidRigid(..) => false,
    };
    claims.pairs().iter().copied().filter(overlaps).collect()
}

/// What was put into each other, until it is apart: rows of contact tell of the overlaps that they part, and may find no way out of deep ones.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct PutTogether {
    pairs: Vec<(FlexBodyHandle, Other)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
enum Other {
    Rigid(ColliderHandle),
    Flex(FlexBodyHandle),
}

impl PutTogether {
    /// Notes pairs of this step.
    pub fn note(&mut self, pairs: &[ClaimedPair], flex: &Roster, flex_bodies: &FlexBodySet) {
        let handle = |slot: usize| {
            let found = flex_bodies.at_index(flex[slot].index);
            found.map(|(handle, _)| handle)
        };
        for pair in pairs {
            let (one, other) = match *pair {
                ClaimedPair::FlexRigid(one, other) => (handle(one), Some(Other::Rigid(other))),
                ClaimedPair::FlexFlex(one, other) => (handle(one), handle(other).map(Other::Flex)),
                ClaimedPair::RigidRigid(..) => continue,
            };
            if let (Some(one), Some(other)) = (one, other)
                && !self.pairs.contains(&(one, other))
            {
                self.pairs.push((one, other));
            }
        }
    }

    /// The largest overlap that is left where a step ends (m); what is apart, or is let pass by now, is forgotten.
    pub fn measure(
        &mut self,
        claims: &mut Claims,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) -> f64 {
        let mut largest = 0.0_f64;
        self.pairs.retain(|&(one, other)| {
            let in_world = |handle| {
                let body = flex_bodies.get(handle);
                body.filter(|body| !is_out(body, sets.bodies))
            };
            let Some(body) = in_world(one) else {
                return false;
            };
            let surface = body.collider_handle();
            let edge = |body: &FlexBody| body.mesh().boundary().mean_segment_length();
            let (met, depth, edge, pushes) = match other {
                Other::Rigid(met) => {
                    let depth = put_in(body, met, sets.into());
                    (met, depth, edge(body), pushes(body, met, sets))
                }
                Other::Flex(other) => {
                    let Some(other) = in_world(other) else {
                        return false;
                    };
                    let met = other.collider_handle();
                    let depth = tangles::depth_in_body(body, other);
                    let groups = [body, other].map(|one| one.contact_settings().solver_groups);
                    let pushes = groups[0].test(groups[1]);
                    (met, depth, edge(body).min(edge(other)), pushes)
                }
            };
            let meets = pushes && depth > DEEP * edge && claims.may_touch(sets, surface, met);
            if meets {
                largest = largest.max(depth);
            }
            meets
        });
        largest
    }
}

/// Whether what a body meets at a rigid collider is to be solved for.
pub(super) fn pushes(body: &FlexBody, collider: ColliderHandle, sets: &RapierSets<'_>) -> bool {
    let groups = sets.colliders.get(collider).map(Collider::solver_groups);
    groups.is_some_and(|groups| body.contact_settings().solver_groups.test(groups))
}

/// Depth from which a body overlaps (m).
fn least_depth(flex: &Roster, slot: usize) -> f64 {
    DEEP * flex[slot].edge
}

/// Whether the surfaces cross, or a piece of material of one lies in the other.
pub(crate) fn overlap(one: &FlexBody, other: &FlexBody, depth: f64) -> bool {
    one.contains(inner_point(other).into())
        || other.contains(inner_point(one).into())
        || tangles::depth_in_body(one, other) > depth
}

/// How deep a collider and a flexible body have been put into each other (m): as [`depth_in`] finds it, and as far as what is on the wrong side of
/// the other's surface has to go.
pub(crate) fn put_in(body: &FlexBody, other: ColliderHandle, sets: ReadSets<'_>) -> f64 {
    let Some(collider) = sets.colliders.get(other) else {
        return 0.0;
    };
    let pose = shapes::pose_of(&pose_of(collider, sets));
    let astray = tangles::depth_in_shape(body, collider.shape(), &pose);
    astray.max(depth_in(body, other, sets))
}

/// How deep a collider is in a flexible body (m), zero where it is not: at the surface, or by half its width if its middle is in there.
pub(super) fn depth_in(body: &FlexBody, other: ColliderHandle, sets: ReadSets<'_>) -> f64 {
    let Some(collider) = sets.colliders.get(other) else {
        return 0.0;
    };
    let local = collider.shape().compute_local_aabb();
    let is_solid = collider.shape().contains_local_point(local.center());
    let middle = pose_of(collider, sets) * local.center();
    let at_surface = crossing(body.collider_handle(), other, sets);
    let half = local.half_extents();
    let half = f64::from(half.x.min(half.y));
    // What is larger than the body is not in it, whatever is where its middle is: a half-space has one at its surface.
    if is_solid && half <= size_of(body) && body.contains(from_rapier(middle).into()) {
        at_surface.max(half)
    } else {
        at_surface
    }
}

/// The larger side of the box that a body's surface is in (m).
fn size_of(body: &FlexBody) -> f64 {
    let nodes = body.mesh().boundary().nodes().iter();
    let none = [Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)];
    let [low, high] = nodes.fold(none, |[low, high], &node| {
        let place = node_vec(body.positions(), node);
        [low.inf(&place), high.sup(&place)]
    });
    (high - low).max()
}

/// The middle of a cell: a point in the material, off the surface.
fn inner_point(body: &FlexBody) -> Vec2 {
    let nodes = body
        .mesh()
        .cells()
        .next()
        .map_or(&[][..], |cell| cell.nodes);
    let sum: Vec2 = nodes
        .iter()
        .map(|&node| node_vec(body.positions(), node))
        .sum();
    sum / nodes.len().max(1) as f64
}

/// How deep rapier finds the shapes of two colliders in each other (m), zero where they are not, or it has no answer.
fn crossing(one: ColliderHandle, other: ColliderHandle, sets: ReadSets<'_>) -> f64 {
    let both = [one, other].map(|handle| sets.colliders.get(handle));
    let [Some(one), Some(other)] = both else {
        return 0.0;
    };
    // Rapier asks for distances of shapes that have a size only; others are refused where they are met.
    let is_bounded = |collider: &Collider| {
        let local = collider.shape().compute_local_aabb();
        local.mins.is_finite() && local.maxs.is_finite()
    };
    if ![one, other].into_iter().all(is_bounded) {
        return 0.0;
    }
    let poses = [one, other].map(|collider| pose_of(collider, sets));
    if let (Some(surface), Some(half_space)) =
        (one.shape().as_polyline(), other.shape().as_halfspace())
    {
        // Parry 0.31 takes a half-space beside a polyline for its image in the origin.
        let normal = poses[1].rotation * half_space.normal;
        let at = |vertex: &Vector| poses[0] * *vertex - poses[1].translation;
        let heights = surface
            .vertices()
            .iter()
            .map(|vertex| at(vertex).dot(normal));
        return heights.fold(0.0, |deepest, height| deepest.max(f64::from(-height)));
    }
    let found = query::contact(&poses[0], one.shape(), &poses[1], other.shape(), 0.0);
    let contact = found.ok().flatten();
    contact.map_or(0.0, |contact| f64::from(-contact.dist).max(0.0))
}

fn pose_of(collider: &Collider, sets: ReadSets<'_>) -> Pose {
    let parent = collider.parent().and_then(|parent| sets.bodies.get(parent));
    parent.map_or(*collider.position(), |body| placed_on(body, collider))
}
