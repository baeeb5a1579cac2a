//! Flexible bodies of foil2d in an app of Bevy, beside the rigid ones of `bevy_rapier2d`.
//!
//! [`FlexPhysicsPlugin`] steps foil2d in [`PhysicsSet::StepSimulation`], where `bevy_rapier2d` would step rapier. All else of `bevy_rapier2d`
//! is as it was: components become bodies before the step and are written after it, and events are Bevy's messages.
//!
//! ```
//! use bevy::prelude::*;
//! use bevy_rapier2d::prelude::*;
//! use foil2d::prelude::*;
//! use foil2d_bevy::{FlexBodies, FlexPhysicsPlugin, NodePositions, rapier_without_its_step};
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, TransformPlugin))
//!     .insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
//!     .add_plugins((rapier_without_its_step(), FlexPhysicsPlugin))
//!     .add_systems(Startup, |mut flex_bodies: FlexBodies| -> Result {
//!         let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//!         let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber);
//!         flex_bodies.spawn(block)?;
//!         Ok(())
//!     });
//! app.finish();
//! app.update();
//! app.update();
//! let mut bodies = app.world_mut().query::<&NodePositions>();
//! assert_eq!(bodies.single(app.world())?.0.len(), 25);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! One metre of rapier is one unit of Bevy: leave `length_unit` at 1 and scale by the camera. Only the default context is stepped, and only in
//! [`SimulationMode::Full`]. Hooks ([`BevyPhysicsHooks`]) and handlers of [`RapierContextSimulation::set_event_handler`] are not asked, and
//! soft bodies do not tell of tears: `bevy_rapier2d` keeps these to itself. A step that fails is an error of its system, which goes to
//! Bevy's error handler.

mod events;
mod step;

use bevy::ecs::system::SystemParam;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;
use bevy_rapier2d::prelude::*;
use foil2d::prelude::*;
use std::collections::HashMap;

/// Steps foil2d in place of rapier; add it behind [`rapier_without_its_step`].
pub struct FlexPhysicsPlugin;

impl Plugin for FlexPhysicsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<FlexPhysics>();
        let systems = (step::remove_despawned, step::step, step::write_positions).chain();
        app.add_systems(PostUpdate, systems.in_set(PhysicsSet::StepSimulation));
    }
}

/// Rapier's plugin with all of its systems but the step.
pub fn rapier_without_its_step() -> RapierPhysicsPlugin<NoUserData> {
    let sets = [PhysicsSet::SyncBackend, PhysicsSet::Writeback];
    RapierPhysicsPlugin::default().with_physics_sets_systems(HashSet::from_iter(sets))
}

/// The flexible bodies of the default context and what steps them.
#[derive(Resource, Default)]
pub struct FlexPhysics {
    /// The bodies: loads and velocities are set, stresses and forces read here.
    pub bodies: FlexBodySet,
    /// What steps them: settings, and the report of the last step.
    pub pipeline: FlexPipeline,
    /// Bodies by their entities.
    handles: HashMap<Entity, FlexBodyHandle>,
    /// Colliders of the last step, whose entities are named when the colliders are gone.
    known: events::Known,
}

/// The flexible body of an entity; it is removed when the entity is despawned.
#[derive(Component, Clone, Copy, Debug)]
pub struct FlexibleBody(pub FlexBodyHandle);

/// Where the nodes of a flexible body are (m), written after every step.
#[derive(Component, Clone, Debug, Default)]
pub struct NodePositions(pub Vec<Vec2>);

/// Spawns flexible bodies.
#[derive(SystemParam)]
pub struct FlexBodies<'w, 's> {
    physics: ResMut<'w, FlexPhysics>,
    context: Query<
        'w,
        's,
        (
            &'static mut RapierRigidBodySet,
            &'static mut RapierContextColliders,
        ),
        With<DefaultRapierContext>,
    >,
    commands: Commands<'w, 's>,
}

impl FlexBodies<'_, '_> {
    /// Inserts a body into the default context and spawns its entity.
    ///
    /// # Errors
    /// If the description of the body is wrong, or there is no default context (`bevy_rapier2d` makes it in `PreStartup`).
    pub fn spawn(&mut self, builder: FlexBodyBuilder) -> Result<Entity> {
        let (mut rigid, mut colliders) = self.context.single_mut()?;
        let (rigid, colliders) = (&mut rigid.bodies, &mut colliders.colliders);
        let FlexPhysics {
            bodies, handles, ..
        } = &mut *self.physics;
        let handle = bodies.insert_with_sets(builder, rigid, colliders)?;
        let body = &bodies[handle];
        let positions = NodePositions(step::positions(body));
        let entity = self.commands.spawn((FlexibleBody(handle), positions)).id();
        handles.insert(entity, handle);
        // By these bits bevy_rapier2d knows whose body and collider they are.
        let bits = u128::from(entity.to_bits());
        if let Some(carrier) = rigid.get_mut(body.rigid_body_handle()) {
            carrier.user_data = bits;
        }
        if let Some(surface) = colliders.get_mut(body.collider_handle()) {
            surface.user_data = bits;
        }
        Ok(entity)
    }
}
