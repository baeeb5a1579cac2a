//! The `f64` motion of claimed rigid bodies, kept from step to step while rapier's copy is the one we wrote.

use super::landing::Landing;
use super::placed::Placed;
use crate::kkt::LateForce;
use crate::math::HashMap;
use crate::rapier::prelude::*;
use crate::system::RigidMotion;

/// What is kept of a claimed body.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Master {
    motion: RigidMotion,
    acceleration: [f64; 3],
    drive: [f64; 3],
    mass: [f64; 3],
    late: LateForce,
    placed: Placed,
}

impl Master {
    /// The acceleration that the step begins with; `None` if that of the applied forces does.
    fn acceleration_now(
        &self,
        drive: [f64; 3],
        inverse_mass: [f64; 3],
        is_within: bool,
    ) -> Option<[f64; 3]> {
        if is_within && self.late.is_stored {
            return None;
        }
        let withheld = |i: usize| match is_within || self.late.is_stored {
            true => 0.0,
            false => self.late.wrench[i],
        };
        Some(std::array::from_fn(|i| {
            let force = self.mass[i] * (self.acceleration[i] - self.drive[i]) + withheld(i);
            drive[i] + inverse_mass[i] * force
        }))
    }
}

/// Motions of all bodies claimed in the last step.
#[derive(Debug, Default)]
pub(crate) struct Masters {
    pub(super) last: HashMap<RigidBodyHandle, Master>,
    next: HashMap<RigidBodyHandle, Master>,
}

impl Masters {
    /// The motion of a body, and its smooth acceleration if it was claimed in the last step and not moved since: `drive` is what the
    /// applied forces give to it alone, now, and its masses are what they are now too.
    ///
    /// A force that was changed since then acts from the beginning of the step: otherwise it would start or end by a part of the step
    /// too late.
    ///
    /// - `is_within`: whether forces act wholly within the step now. Those that the step before has left to act on then do on nothing: what they press
    ///   against does not feel them either. Where it is no longer so, bodies of small strain have kept what acted, and what they press feels it too.
    pub fn motion(
        &self,
        handle: RigidBodyHandle,
        (body, placed): (&RigidBody, Placed),
        (drive, inverse_mass): ([f64; 3], [f64; 3]),
        is_within: bool,
    ) -> (RigidMotion, Option<[f64; 3]>) {
        if let Some(master) = self.last.get(&handle) {
            let acceleration = master.acceleration_now(drive, inverse_mass, is_within);
            if master.placed == placed {
                return (master.motion, acceleration);
            }
            if master.placed.pose == placed.pose {
                let read = placed.motion(body);
                let motion = RigidMotion {
                    velocity: read.velocity,
                    spin: read.spin,
                    ..master.motion
                };
                return (motion, acceleration);
            }
        }
        (placed.motion(body), None)
    }

    /// Bodies that forces of flexible ones are to act on in the next step, and one of these each, by its index.
    ///
    /// They stay with it that long, whatever has become of contact or joint: what they press feels the rest of the force in the parts that its step is
    /// solved in, and so must they.
    pub fn bonds(&self) -> impl Iterator<Item = (RigidBodyHandle, u32)> {
        let all = self.last.iter();
        all.filter_map(|(&handle, master)| Some((handle, master.late.partner?)))
    }

    /// Keeps a body's motion after the hand-back.
    pub fn keep(&mut self, landing: &Landing, motion: RigidMotion, placed: Placed) {
        let master = Master {
            motion,
            acceleration: landing.acceleration,
            drive: landing.drive,
            mass: landing.mass,
            late: landing.late,
            placed,
        };
        self.next.insert(landing.handle, master);
    }

    /// Makes the motions kept since the last call those of the last step. Those of bodies that sleep stay.
    pub fn turn_over(&mut self, bodies: &RigidBodySet) {
        for (handle, master) in &self.last {
            if bodies.get(*handle).is_some_and(RigidBody::is_sleeping) {
                self.next.entry(*handle).or_insert(*master);
            }
        }
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
    }
}

/// Largest turn of a body in a step (rad), unless it may turn faster: rapier's.
const LARGEST_TURN: f64 = std::f64::consts::FRAC_PI_4;

/// Keeps a motion within rapier's caps of speed, which it imposes on its own results.
pub(super) fn cap_speed(
    motion: &mut RigidMotion,
    body: &RigidBody,
    parameters: &IntegrationParameters,
) {
    let fastest = f64::from(parameters.max_linear_velocity());
    let speed = motion.velocity.norm();
    if speed > fastest {
        motion.velocity *= fastest / speed;
    }
    if !body.is_fast_rotation_allowed() {
        let fastest = LARGEST_TURN / f64::from(parameters.dt);
        motion.spin = motion.spin.clamp(-fastest, fastest);
    }
}
