//! What is written of a step: the bodies, and what the step told.

use super::rigid_lines::{RigidLine, lines_of};
use crate::body::FlexBodySet;
use crate::math::{Vec2, atan2, from_rapier};
use crate::pipeline::{Participant, StepReport};
use crate::rapier::prelude::{ColliderHandle, ColliderSet, PhysicsWorld, RigidBodySet};

/// The sets after a step, borrowed together with its report.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Flexible bodies.
    pub flex_bodies: &'a FlexBodySet,
    /// Rapier's bodies.
    pub bodies: &'a RigidBodySet,
    /// Rapier's colliders.
    pub colliders: &'a ColliderSet,
    /// What the step told.
    pub report: &'a StepReport,
}

impl<'a> Scene<'a> {
    /// The sets of a whole world.
    pub fn of(
        world: &'a PhysicsWorld,
        flex_bodies: &'a FlexBodySet,
        report: &'a StepReport,
    ) -> Self {
        Self {
            flex_bodies,
            bodies: &world.bodies,
            colliders: &world.colliders,
            report,
        }
    }

    /// Colliders that are not the surface of a flexible body.
    pub(super) fn rigid_shapes(&self) -> Vec<RigidShape> {
        let mut surfaces: Vec<ColliderHandle> = self
            .flex_bodies
            .iter()
            .map(|(_, body)| body.collider_handle())
            .collect();
        surfaces.sort_unstable_by_key(|handle| handle.into_raw_parts());
        let is_surface = |handle: ColliderHandle| {
            surfaces
                .binary_search_by_key(&handle.into_raw_parts(), |one| one.into_raw_parts())
                .is_ok()
        };
        let rigid = self
            .colliders
            .iter()
            .filter(|(handle, _)| !is_surface(*handle));
        rigid
            .map(|(handle, collider)| {
                let pose = collider.position();
                let rotation = [pose.rotation.re, pose.rotation.im].map(f64::from);
                let parent = collider.parent().and_then(|parent| self.bodies.get(parent));
                let (centre, linvel, angvel) = parent.map_or_else(Default::default, |body| {
                    let centre = from_rapier(body.center_of_mass());
                    (centre, from_rapier(body.linvel()), f64::from(body.angvel()))
                });
                RigidShape {
                    collider: handle,
                    lines: lines_of(collider.shape()),
                    translation: from_rapier(pose.translation).into(),
                    rotation,
                    moves: parent.is_some_and(|body| body.is_dynamic()),
                    is_sensor: collider.is_sensor(),
                    centre,
                    linvel,
                    angvel,
                    force: self.report.force_on(Participant::Rigid(handle)),
                }
            })
            .collect()
    }
}

/// A rigid collider: its lines, where it is and how it moves.
pub(super) struct RigidShape {
    pub(super) collider: ColliderHandle,
    /// In the collider's coordinates (m).
    pub(super) lines: Vec<RigidLine>,
    /// Where the collider is (m).
    pub(super) translation: [f64; 2],
    /// Cosine and sine of its angle.
    pub(super) rotation: [f64; 2],
    /// Whether forces move it.
    pub(super) moves: bool,
    /// Whether it touches nothing.
    pub(super) is_sensor: bool,
    centre: Vec2,
    linvel: Vec2,
    angvel: f64,
    /// Contact force on it in the step (N).
    pub(super) force: [f64; 2],
}

impl RigidShape {
    /// Angle of the collider (rad).
    pub(super) fn angle(&self) -> f64 {
        let [cos, sin] = self.rotation;
        atan2(sin, cos)
    }

    /// A point of the collider in the world (m).
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.rotation;
        let [at_x, at_y] = self.translation;
        [at_x + cos * x - sin * y, at_y + sin * x + cos * y]
    }

    /// Velocity of a point of the world that moves with the body (m/s).
    pub(super) fn velocity(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let arm = Vec2::new(x, y) - self.centre;
        [
            self.linvel.x - self.angvel * arm.y,
            self.linvel.y + self.angvel * arm.x,
        ]
    }
}
