//! Where and how fast claimed rigid bodies end the step.

use crate::rapier::prelude::RigidBodyHandle;
use crate::system::{RigidBlock, RigidMotion, Step};

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
    /// Whether the step of its island is not finished: it has not come to rest, however still it is.
    pub is_unfinished: bool,
    /// Whether forces of contact act on from its acceleration in the next step.
    pub has_late_forces: bool,
}

impl Landing {
    /// Notes the end of a claimed body's step.
    pub fn new(
        handle: RigidBodyHandle,
        block: &RigidBlock,
        step: &Step,
        is_unfinished: bool,
    ) -> Self {
        Self {
            handle,
            motion: *block.current(),
            acceleration: block.smooth_end,
            drive: block.drive(),
            is_unfinished,
            has_late_forces: !step.is_within(),
        }
    }
}
