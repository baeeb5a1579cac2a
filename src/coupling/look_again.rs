//! Looking again: members that have left the boxes they were looked for in, because something has thrown them or let them go.
//!
//! What they meet there was not in the problem that was solved. The boxes grow by what was left of them, and the step is solved again.

use super::claim::Claims;
use super::landing::Landing;
use super::sets::RapierSets;
use crate::math::{Vec2, from_rapier, node_vec};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::FlexBlock;

/// By how much more the boxes grow than they were left by: with more members the motion is another one.
const MORE: Real = 1.5;

impl Claims {
    /// By how much members have left the boxes they were looked for in (m).
    pub fn excess(&self) -> f64 {
        f64::from(self.excess)
    }

    /// Grows the boxes that members have left within the step, as solved; returns whether there are any.
    ///
    /// - `block`: of a flexible body by its slot.
    /// - `landings`: where claimed rigid bodies end.
    pub fn widen<'a>(
        &mut self,
        block: impl Fn(u32) -> Option<&'a FlexBlock>,
        landings: &[Landing],
        sets: &RapierSets<'_>,
    ) -> bool {
        let mut excess: Real = 0.0;
        for flex in &self.flex {
            let Some(block) = block(flex.index) else {
                continue;
            };
            let (low, high) = (flex.swept.mins, flex.swept.maxs);
            for &node in block.model().mesh().boundary().nodes() {
                let end = node_vec(block.positions(), node);
                let (x, y) = (end.x as Real, end.y as Real);
                let out = (low.x - x).max(x - high.x).max(low.y - y).max(y - high.y);
                excess = excess.max(out);
            }
        }
        let known = sets.integration_parameters.prediction_distance() + self.excess;
        for landing in landings {
            let Some(body) = sets.bodies.get(landing.handle) else {
                continue;
            };
            let out = beyond(body, landing, sets) as Real;
            if out > known {
                excess = excess.max(out - self.excess);
            }
        }
        if excess <= 0.0 || !excess.is_finite() {
            return false;
        }
        let grown = MORE * excess;
        self.excess += grown;
        self.flex.grow(grown);
        true
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
