//! Joints that the user has changed, put in or taken out where bodies sleep.
//!
//! Rapier wakes these bodies at the beginning of its next step, which is too late for what rests on them: they would have moved by themselves then. Whom it is to
//! wake it tells nobody, so that joints are compared with what they were; where one differs, rapier's detection step wakes whom it would.

use super::sets::RapierSets;
use crate::rapier::prelude::*;

/// A joint as it was: its handle, its bodies, and its data without the impulses that steps write to it.
pub(super) type NotedJoint = (ImpulseJointHandle, [RigidBodyHandle; 2], GenericJoint);

/// What the joints of the next step are compared with, in rapier's order.
#[derive(Debug, Default)]
pub(super) struct KnownJoints {
    noted: Vec<NotedJoint>,
}

impl KnownJoints {
    /// Notes all joints.
    pub fn note(&mut self, sets: &RapierSets<'_>) {
        self.noted.clear();
        let joints = sets.impulse_joints.iter();
        self.noted
            .extend(joints.map(|(handle, joint)| (handle, bodies_of(joint), settings_of(joint))));
    }

    /// Whether a joint of a body that sleeps is new, gone, or another than noted.
    pub fn have_changed(&self, sets: &RapierSets<'_>) -> bool {
        let sleeps = |bodies: [RigidBodyHandle; 2]| {
            let mut found = bodies.into_iter().filter_map(|body| sets.bodies.get(body));
            found.any(RigidBody::is_sleeping)
        };
        let is_gone = |(handle, bodies, _): &NotedJoint| {
            !sets.impulse_joints.contains(*handle) && sleeps(*bodies)
        };
        let mut noted = self.noted.iter().peekable();
        let mut is_other = |handle: ImpulseJointHandle, joint: &ImpulseJoint| {
            // Rapier lists what remains in the order of before.
            let place = |handle: &ImpulseJointHandle| handle.into_raw_parts().0;
            while noted
                .next_if(|before| place(&before.0) < place(&handle))
                .is_some()
            {}
            let before = noted.next_if(|before| before.0 == handle);
            sleeps(bodies_of(joint))
                && before.is_none_or(|(_, bodies, data)| {
                    (*bodies, *data) != (bodies_of(joint), settings_of(joint))
                })
        };
        let mut now = sets.impulse_joints.iter();
        now.any(|(handle, joint)| is_other(handle, joint)) || self.noted.iter().any(is_gone)
    }
}

/// What a snapshot writes.
#[cfg(feature = "serde-serialize")]
impl KnownJoints {
    /// The joints as they were noted.
    pub fn noted(&self) -> &[NotedJoint] {
        &self.noted
    }

    /// Joints that were noted.
    pub fn remembered(noted: Vec<NotedJoint>) -> Self {
        Self { noted }
    }
}

fn bodies_of(joint: &ImpulseJoint) -> [RigidBodyHandle; 2] {
    [joint.body1(), joint.body2()]
}

/// The data of a joint without the impulses that steps write to it.
fn settings_of(joint: &ImpulseJoint) -> GenericJoint {
    let mut data = joint.data;
    for motor in &mut data.motors {
        motor.impulse = 0.0;
    }
    for limit in &mut data.limits {
        limit.impulse = 0.0;
    }
    data
}
