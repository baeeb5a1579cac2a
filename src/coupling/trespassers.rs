//! Trespassers: what nobody has claimed, and rapier's own step has left in a flexible body.
//!
//! A claim looks for what the motion that a step begins with, and the strikes in it, may bring. What moves otherwise, as a body that a
//! motor or a joint flings, is met in the next step only: until then it lies where nothing was solved, and that is told.

use super::claim::Claims;
use super::newcomers::{DEEP, depth_in, pushes};
use super::quarantine::is_out;
use super::sets::RapierSets;
use crate::body::{FlexBody, FlexBodyHandle, FlexBodySet};
use crate::math::is_held;
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

/// Trespassers of a step, with the boxes of the flexible surfaces where it ends.
#[derive(Debug, Default)]
pub(crate) struct Trespassers {
    surfaces: Vec<(FlexBodyHandle, Aabb)>,
    found: Vec<Trespasser>,
}

impl Trespassers {
    /// Finds what moves, was not claimed and ends in a flexible body, by more than `known` (m); surfaces and bodies are where the step
    /// ends. The user's filter is asked about pairs that it has not been asked about in this step.
    pub fn find(
        &mut self,
        claims: &mut Claims,
        sets: &RapierSets<'_>,
        flex_bodies: &FlexBodySet,
        known: f64,
    ) -> &[Trespasser] {
        self.found.clear();
        self.surfaces.clear();
        self.surfaces.extend(
            flexible_in_world(flex_bodies, sets.bodies)
                .filter_map(|(handle, body)| Some((handle, box_of(body.collider_handle(), sets)?))),
        );
        let boxes = self.surfaces.iter().map(|(_, surface)| *surface);
        let Some(around) = boxes.reduce(|one, other| one.merged(&other)) else {
            return &self.found;
        };
        for handle in sets.islands.active_bodies() {
            let body = sets.bodies.get(handle).filter(|body| body.is_dynamic());
            let Some(body) = body.filter(|_| !claims.has(handle)) else {
                continue;
            };
            for &collider in body.colliders() {
                let own = box_of(collider, sets).filter(|own| own.intersects(&around));
                let Some(own) = own.filter(|_| !claims.flex.is_surface(collider)) else {
                    continue;
                };
                let met = self
                    .surfaces
                    .iter()
                    .filter(|(_, surface)| surface.intersects(&own));
                for &(body, _) in met {
                    let Some(flexible) = flex_bodies.get(body) else {
                        continue;
                    };
                    let surface = flexible.collider_handle();
                    let least = DEEP * flexible.mesh().boundary().mean_segment_length();
                    let depth = depth_in(flexible, collider, sets.into());
                    let mut may_touch = || claims.may_touch(sets, surface, collider);
                    if depth > known.max(least) && pushes(flexible, collider, sets) && may_touch() {
                        self.found.push(Trespasser {
                            body,
                            collider,
                            depth,
                        });
                    }
                }
            }
        }
        &self.found
    }
}

fn flexible_in_world<'a>(
    flex_bodies: &'a FlexBodySet,
    bodies: &'a RigidBodySet,
) -> impl Iterator<Item = (FlexBodyHandle, &'a FlexBody)> {
    let all = flex_bodies.iter();
    all.filter(|(_, body)| !is_out(body, bodies))
}

/// Box of a collider where the step ends, if rapier's queries can reckon with it.
fn box_of(handle: ColliderHandle, sets: &RapierSets<'_>) -> Option<Aabb> {
    let aabb = sets.colliders.get(handle)?.compute_aabb();
    let corners = [aabb.mins.x, aabb.mins.y, aabb.maxs.x, aabb.maxs.y];
    let is_representable = corners.iter().all(|&value| is_held(f64::from(value)));
    is_representable.then_some(aabb)
}
