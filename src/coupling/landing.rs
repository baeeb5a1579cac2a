//! Where and how fast claimed rigid bodies end the step.

use crate::kkt::LateForce;
use crate::rapier::prelude::RigidBodyHandle;
use crate::system::{RigidBlock, RigidMotion};

/// A claimed body on its way through rapier's step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Landing {
    /// The body.
    pub handle: RigidBodyHandle,
    /// Where and how fast it must end.
    pub motion: RigidMotion,
    /// Its smooth acceleration.
    pub acceleration: [f64; 3],
    /// What of it the user's forces and gravity give to the body alone.
    pub drive: [f64; 3],
    /// Its mass in x, y and inertia (kg, kg, kg m²).
    pub mass: [f64; 3],
    /// Whether the step of its island is not finished: it has not come to rest, however still it is.
    pub is_unfinished: bool,
    /// The forces of flexible bodies that these keep for the next step.
    pub late: LateForce,
}

impl Landing {
    /// Notes the end of a claimed body's step.
    pub fn new(
        handle: RigidBodyHandle,
        block: &RigidBlock,
        late: LateForce,
        is_unfinished: bool,
    ) -> Self {
        Self {
            handle,
            motion: *block.current(),
            acceleration: block.smooth_end,
            drive: block.drive(),
            mass: block.mass(),
            is_unfinished,
            late,
        }
    }
}
