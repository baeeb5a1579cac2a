//! Trespassers: what nobody has claimed, and rapier's own step has left in a flexible body.
//!
//! A claim looks for what the motion that a step begins with, and the strikes in it, may bring. What moves otherwise, as a body that a
//! motor or a joint flings, is met in the next step only: until then it lies where nothing was solved, and that is told.

use super::claim::Claims;
use super::filter::may_touch;
use super::newcomers::{DEEP, depth_in};
use super::sets::RapierSets;
use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// A collider that nobody has solved for, in a flexible body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trespasser {
    /// The flexible body.
    pub body: FlexBodyHandle,
    /// What is in it.
    pub collider: ColliderHandle,
    /// How deep (m).
    pub depth: f64,
}

impl Claims {
    /// Lists what moves, was not claimed and ends in a flexible body, by more than `known` (m); surfaces and bodies are where the step ends.
    pub fn list_trespassers(
        &mut self,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
        known: f64,
        found: &mut Vec<Trespasser>,
    ) {
        let surface_of =
            |handle: ColliderHandle| sets.colliders.get(handle).map(Collider::compute_aabb);
        let bodies = || {
            flex_bodies
                .iter()
                .filter(|(_, body)| !body.is_quarantined())
        };
        let boxes = bodies().filter_map(|(_, body)| surface_of(body.collider_handle()));
        let Some(around) = boxes.reduce(|one: Aabb, other| one.merged(&other)) else {
            return;
        };
        let awake = sets.islands.active_bodies();
        let mut answers = std::mem::take(&mut self.answers);
        for handle in awake.filter(|handle| !self.rigid_index.contains_key(handle)) {
            let Some(rigid) = sets.bodies.get(handle).filter(|body| body.is_dynamic()) else {
                continue;
            };
            for &collider in rigid.colliders() {
                let Some(own) = surface_of(collider).filter(|own| own.intersects(&around)) else {
                    continue;
                };
                if self.is_surface(collider) {
                    continue;
                }
                for (body, flexible) in bodies() {
                    let surface = flexible.collider_handle();
                    if !surface_of(surface).is_some_and(|surface| surface.intersects(&own)) {
                        continue;
                    }
                    let edge = flexible.mesh().boundary().mean_segment_length();
                    let depth = depth_in(flexible, collider, sets);
                    if depth > known.max(DEEP * edge)
                        && may_touch(sets, surface, collider, &mut answers)
                    {
                        found.push(Trespasser {
                            body,
                            collider,
                            depth,
                        });
                    }
                }
            }
        }
        self.answers = answers;
    }
}
