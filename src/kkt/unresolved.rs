//! How much of an impact is shorter than the step.
//!
//! A contact through a surface without mass gives way by the springs of the surface and by the masses behind it,
//! `W = K_ss⁻¹/s + W_m`, `s = b0 + β b1`. The multiplier that ends an approach `v` within the step is `p = v dt/(b0 W)`; it changes
//! the velocity of these masses by
//!
//! ```text
//! b1 W_m p = v (b1 dt / b0) (W_m / W).
//! ```
//!
//! Up to `W_m/W = b0/(b1 dt)`, one half for the trapezoidal rule, they are slowed and the springs take their motion: the step resolves the
//! impact. Beyond that they are thrown back faster than anything stopped them, and as `1 - β1` of the force is still to act, up to
//! three times as fast as they came where the springs are stiff. There the velocity stage holds the contact.
//!
//! The masses next to the contact count, not those of the whole body: a board that is pinned has no rigid motion and resolves no impact of its
//! cells for that.

use super::island::{Island, SolveSettings};
use crate::constraint::contact::Kinematics;
use crate::math::Mat2;
use crate::system::Response;

/// Share of rigid mobility below which bodies meet by their elasticity, and above which as rigid ones.
const ELASTIC: f64 = 0.3;
const RIGID: f64 = 0.7;

impl Island {
    /// How much of a contact's mobility within the step is that of the masses behind the surface, and how much that of rigid bodies, both
    /// mapped to [0, 1].
    pub(super) fn unresolved_shares(
        &self,
        kinematics: &Kinematics,
        settings: &SolveSettings,
    ) -> [f64; 2] {
        let normal = kinematics.normal;
        let along = |of: Mat2| normal.dot(&(of * normal));
        let (mut rigid, mut actual, mut springs) = (0.0, 0.0, 0.0);
        for a in kinematics.attachments() {
            let block = &self.blocks[a.block];
            rigid += a.weight.abs() * block.rigid_mobility(a.grip, normal);
            for b in kinematics.attachments() {
                if a.block == b.block {
                    let weight = a.weight * b.weight;
                    actual += weight * along(block.compliance(a.grip, b.grip, Response::Velocity));
                    springs += weight * along(block.spring_compliance(a.grip, b.grip));
                }
            }
        }
        if actual <= 0.0 {
            return [0.0; 2];
        }
        let resolved = settings.b0 / (settings.b1 * settings.dt);
        [
            smooth_step(1.0 - springs / actual, [resolved, 1.0]),
            Self::share_of(rigid, actual),
        ]
    }

    /// Maps the share that rigid mobility has of a mobility to [0, 1].
    pub(super) fn share_of(rigid: f64, actual: f64) -> f64 {
        let share = if actual > 0.0 { rigid / actual } else { 0.0 };
        smooth_step(share, [ELASTIC, RIGID])
    }
}

/// From 0 up to the first bound to 1 from the second on, without a kink; 0 if the bounds leave no room.
fn smooth_step(value: f64, [from, to]: [f64; 2]) -> f64 {
    if from >= to {
        return 0.0;
    }
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
