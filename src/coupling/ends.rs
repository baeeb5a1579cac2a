//! Ends: where the members of a step end, as solved, and by how much that is out of where they were looked for.

use super::landing::Landing;
use super::pool::FlexPool;
use super::roster::{ClaimedFlex, Roster};
use super::sets::RapierSets;
use crate::math::{Vec2, from_rapier, node_vec, to_rapier};
use crate::rapier::math::Real;
use crate::rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use crate::rapier::prelude::*;

/// Where the members of a step end, as solved.
pub(crate) struct Ends<'a> {
    /// Blocks of the flexible bodies.
    pub pool: &'a FlexPool,
    /// Of claimed rigid bodies.
    pub landings: &'a [Landing],
}

impl Ends<'_> {
    /// By how much members have left the boxes that they were looked for in; zero if none has (m).
    ///
    /// - `grown`: by how much the boxes have grown in this step (m).
    pub(super) fn left_by(&self, flex: &Roster, grown: Real, sets: &RapierSets<'_>) -> Real {
        let flexible = flex.iter().filter_map(|own| Some(self.of_flex(own)?.1));
        let landings = self.landings.iter();
        let rigid = landings.map(|landing| thrown_by(landing, grown, sets));
        // What is no number has been refused by name before.
        flexible
            .chain(rigid)
            .filter(|out| out.is_finite())
            .fold(0.0, Real::max)
    }

    /// Box of a flexible body's surface at the end, and by how much that is out of the one that it was looked for in (m).
    pub(super) fn of_flex(&self, own: &ClaimedFlex) -> Option<(Aabb, Real)> {
        let block = self.pool.block(own.index)?;
        let nodes = block.model().mesh().boundary().nodes().iter();
        let points = nodes.map(|&node| to_rapier(node_vec(block.positions(), node)));
        let end = points.map(|at| Aabb::new(at, at));
        let end = end.reduce(|one, other| one.merged(&other))?;
        let (low, high) = (own.swept.mins - end.mins, end.maxs - own.swept.maxs);
        let out = low.x.max(low.y).max(high.x).max(high.y);
        Some((end, out.max(0.0)))
    }
}

/// How far around where their velocities take them rigid bodies are kept apart anyway, when the boxes have grown by so much (m).
pub(super) fn known(grown: Real, sets: &RapierSets<'_>) -> Real {
    sets.integration_parameters.prediction_distance() + grown
}

/// By how much a rigid body has left the place that it was looked for in, beyond by how much the boxes have grown; zero if it has not (m).
pub(super) fn thrown_by(landing: &Landing, grown: Real, sets: &RapierSets<'_>) -> Real {
    let Some(body) = sets.bodies.get(landing.handle) else {
        return 0.0;
    };
    let out = beyond(body, landing, sets) as Real;
    if out > known(grown, sets) {
        out - grown
    } else {
        0.0
    }
}

/// How far a rigid body has moved from where its velocity would have taken it, at any time of the step (m).
fn beyond(body: &RigidBody, landing: &Landing, sets: &RapierSets<'_>) -> f64 {
    let dt = f64::from(sets.integration_parameters.dt);
    let start = from_rapier(body.center_of_mass());
    let (gone, drift): (Vec2, Vec2) = (
        landing.motion.centre - start,
        dt * from_rapier(body.linvel()),
    );
    let square = drift.norm_squared();
    let share = if square > 0.0 {
        (gone.dot(&drift) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (gone - share * drift).norm()
}
