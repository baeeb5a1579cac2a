//! What must be so after every step.

use crate::common::*;
use crate::play::Play;
use foil2d::pipeline::{Held, Participant};
use std::sync::atomic::Ordering;

/// An overlap of the size of a body, undone within the shortest step, gives 1.5 m × 240 / s; beyond ten times that
/// something feeds on itself (m/s).
const FASTEST: f64 = 4e3;

impl Play {
    /// All bits of the motion of all bodies.
    pub fn bits(&self) -> Vec<u64> {
        motion_bits(&self.scene.world, &self.scene.bodies)
    }

    /// Rapier holds a carrier for every flexible body and a surface on it, and nothing else of ours.
    #[track_caller]
    pub fn assert_counted(&self) {
        let (scene, context) = (&self.scene, &self.context);
        let n_carriers = self.flexible.len() + self.empty_carriers.len();
        let counts = [
            scene.bodies.len(),
            scene.world.bodies.len(),
            scene.world.colliders.len(),
            scene.world.impulse_joints.len(),
            scene.bodies.iter_attachments().count(),
        ];
        let expected = [
            self.flexible.len(),
            n_carriers + self.rigid.len(),
            n_carriers + self.parts.len(),
            self.links.len(),
            self.ties.len(),
        ];
        assert_eq!(
            counts, expected,
            "{context}: flexible and rigid bodies, colliders, joints, attachments"
        );
        for &handle in &self.flexible {
            let body = &scene.bodies[handle];
            let carrier = scene.world.bodies.get(body.rigid_body_handle());
            let colliders = carrier.map_or(&[][..], RigidBody::colliders);
            assert_eq!(colliders, [body.collider_handle()], "{context}");
        }
        for &handle in &self.gone {
            assert!(scene.bodies.get(handle).is_none(), "{context}: {handle:?}");
        }
        let links = self.links.iter();
        let are_alive = links.map(|link| scene.world.impulse_joints.get(link.handle));
        assert!(are_alive.flatten().count() == self.links.len(), "{context}");
        for tie in &self.ties {
            assert!(scene.bodies.attachment(tie.handle).is_ok(), "{context}");
        }
    }

    #[track_caller]
    pub fn assert_finite(&mut self) {
        let context = &self.context;
        let mut fastest = 0.0f64;
        assert_eq!(sick_flexible(&self.scene.bodies), None, "{context}");
        assert_eq!(sick_rigid(&self.scene.world), None, "{context}");
        for (handle, body) in self.scene.bodies.iter() {
            let speeds = body.velocities().iter().map(|v| v.abs());
            let speed = speeds.fold(0.0, f64::max);
            assert!(speed < FASTEST, "{context}: {handle:?} at {speed:e} m/s");
            fastest = fastest.max(speed);
        }
        self.fastest = self.fastest.max(fastest);
    }

    /// The report names what lives, with numbers, and blames only what was spoiled.
    #[track_caller]
    pub fn assert_reported(&self) {
        let (scene, context) = (&self.scene, &self.context);
        let report = scene.report();
        let lives = |participant| match participant {
            Participant::Flex(body) => scene.bodies.get(body).is_some(),
            Participant::Rigid(collider) => scene.world.colliders.contains(collider),
        };
        for contact in report.contacts() {
            let [x, y] = contact.position;
            let numbers = [x, y, contact.gap, contact.normal_force];
            let is_right = lives(contact.contactor)
                && lives(contact.target)
                && numbers.iter().all(|x| x.is_finite())
                && contact.tangential_force.is_finite();
            assert!(is_right, "{context}: {contact:?}");
        }
        for joint in report.joints() {
            let lives = match joint.joint {
                Held::Joint(handle) => scene.world.impulse_joints.contains(handle),
                Held::MultibodyJoint(handle) => scene.world.multibody_joints.get(handle).is_some(),
                Held::Attachment(handle) => scene.bodies.attachment(handle).is_ok(),
            };
            let numbers = [joint.force[0], joint.force[1], joint.torque];
            let is_right = lives && numbers.iter().all(|x| x.is_finite());
            assert!(is_right, "{context}: {joint:?}");
        }
        for body in report.quarantined_flex_bodies() {
            let is_spoiled = self.spoiled.contains(body);
            assert!(is_spoiled, "{context}: {body:?} was well");
        }
        let energy = report.energy();
        let all = [energy.total(), energy.dissipated, report.energy_limited()];
        assert!(all.iter().all(|x| x.is_finite()), "{context}: {energy:?}");
        let by_rapier = (report.quarantined_bodies(), report.quarantined_colliders());
        assert!(
            by_rapier.0.is_empty() && by_rapier.1.is_empty(),
            "{context}: {by_rapier:?}"
        );
        let n_wrong = self.listener.n_wrong.load(Ordering::Relaxed);
        assert_eq!(n_wrong, 0, "{context}: events");
    }
}
