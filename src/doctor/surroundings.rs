//! Bodies and what is beside them, or heavier.

use super::finding::Finding;
use crate::body::{FlexBody, FlexBodyHandle, FlexBodySet};
use crate::coupling::{DEEP, ReadSets, is_met, is_out, overlap, put_in};
use crate::pipeline::{InsertionNote, Participant};
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// Heavier over lighter from which the lighter one has next to no say: single precision holds seven digits.
const APART: f64 = 1e7;

pub(super) fn examine(
    world: &PhysicsWorld,
    flex_bodies: &FlexBodySet,
    findings: &mut Vec<Finding>,
) {
    let sets = ReadSets {
        bodies: &world.bodies,
        colliders: &world.colliders,
    };
    let present = flex_bodies.iter();
    let present: Vec<(FlexBodyHandle, &FlexBody)> = present
        .filter(|(_, body)| !is_out(body, sets.bodies))
        .collect();
    for (index, &(handle, body)) in present.iter().enumerate() {
        let Some(around) = box_of(body.collider_handle(), sets) else {
            continue;
        };
        let edge = |body: &FlexBody| DEEP * body.mesh().boundary().mean_segment_length();
        for &(other_handle, other) in &present[index + 1..] {
            let is_near = box_of(other.collider_handle(), sets)
                .is_some_and(|beside| beside.intersects(&around));
            let groups = [body, other].map(|body| body.contact_settings());
            let meets = groups[0].collision_groups.test(groups[1].collision_groups)
                && groups[0].solver_groups.test(groups[1].solver_groups)
                && !groups.iter().any(|settings| settings.is_sensor);
            let depth = edge(body).min(edge(other));
            if is_near && meets && overlap(body, other, depth) {
                findings.push(overlap_of(handle, Participant::Flex(other_handle)));
            }
        }
        for (rigid, collider) in sets.colliders.iter() {
            if !meets_rigid(body, collider) || flex_bodies.of_collider(rigid).is_some() {
                continue;
            }
            let with = Participant::Rigid(rigid);
            if !is_met(collider.shape()) {
                findings.push(Finding::NotMet { body: handle, with });
                continue;
            }
            let is_near = box_of(rigid, sets).is_some_and(|beside| beside.intersects(&around));
            if is_near && put_in(body, rigid, sets) > edge(body) {
                findings.push(overlap_of(handle, with));
            }
            let parent = collider.parent().and_then(|parent| sets.bodies.get(parent));
            if let Some(parent) = parent.filter(|parent| parent.is_dynamic()) {
                let ratio = f64::from(parent.mass()) / body.mass();
                let ratio = ratio.max(1.0 / ratio);
                if ratio > APART && ratio.is_finite() {
                    findings.push(Finding::MassRatio {
                        body: handle,
                        with,
                        ratio,
                    });
                }
            }
        }
    }
}

fn overlap_of(body: FlexBodyHandle, with: Participant) -> Finding {
    Finding::Insertion(InsertionNote::Overlap { body, with })
}

/// Whether a body is to push, or be pushed by, a rigid collider that it meets.
fn meets_rigid(body: &FlexBody, collider: &Collider) -> bool {
    let own = body.contact_settings();
    collider.is_enabled()
        && !collider.is_sensor()
        && !own.is_sensor
        && own.collision_groups.test(collider.collision_groups())
        && own.solver_groups.test(collider.solver_groups())
}

fn box_of(collider: ColliderHandle, sets: ReadSets<'_>) -> Option<Aabb> {
    sets.colliders.get(collider).map(Collider::compute_aabb)
}
