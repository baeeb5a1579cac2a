//! The systems.

use crate::events::{Collector, known};
use crate::{FlexPhysics, FlexibleBody, NodePositions};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_rapier2d::prelude::*;
use foil2d::body::FlexBody;
use foil2d::rapier::pipeline::PhysicsHooks;

/// Where the nodes of a body are (m).
pub fn positions(body: &FlexBody) -> Vec<Vec2> {
    let nodes = 0..body.n_nodes();
    nodes
        .map(|node| Vec2::from(body.position(node).map(|x| x as f32)))
        .collect()
}

/// Removes bodies whose entities are gone.
pub fn remove_despawned(
    mut physics: ResMut<FlexPhysics>,
    mut gone: RemovedComponents<FlexibleBody>,
    mut context: Query<
        (
            &mut RapierContextSimulation,
            &mut RapierContextColliders,
            &mut RapierContextJoints,
            &mut RapierRigidBodySet,
        ),
        With<DefaultRapierContext>,
    >,
) -> Result {
    let FlexPhysics {
        bodies, handles, ..
    } = &mut *physics;
    for entity in gone.read() {
        let handle = handles.remove(&entity);
        let Some(handle) = handle.filter(|handle| bodies.get(*handle).is_some()) else {
            continue;
        };
        let (mut simulation, mut colliders, mut joints, mut rigid) = context.single_mut()?;
        let (joints, rigid) = (&mut *joints, &mut *rigid);
        bodies.remove_with_sets(
            handle,
            &mut simulation.islands,
            &mut rigid.bodies,
            &mut colliders.colliders,
            &mut joints.impulse_joints,
            &mut joints.multibody_joints,
            &mut rigid.soft_bodies,
        )?;
    }
    Ok(())
}

/// Steps of a frame.
struct Plan {
    /// Times that the step of [`TimestepMode`] is taken, its length (s), and the number of parts it is taken in.
    n_whole: usize,
    whole: f32,
    n_parts: usize,
    /// Length of a part (s).
    part: f32,
    is_interpolated: bool,
}

/// As `bevy_rapier2d` does it.
fn plan(mode: TimestepMode, time: &Time, ahead: &mut SimulationToRenderTime) -> Plan {
    let (n_whole, whole, n_parts, scale) = match mode {
        TimestepMode::Fixed { dt, substeps } => (1, dt, substeps, 1.0),
        TimestepMode::Variable {
            max_dt,
            time_scale,
            substeps,
        } => {
            let dt = (time.delta_secs() * time_scale).min(max_dt);
            (1, dt, substeps, 1.0)
        }
        TimestepMode::Interpolated {
            dt,
            time_scale,
            substeps,
        } => {
            ahead.diff += time.delta_secs();
            let n_whole = (ahead.diff / dt).ceil().max(0.0);
            ahead.diff -= n_whole * dt;
            (n_whole as usize, dt, substeps, time_scale)
        }
    };
    let part = whole / n_parts as f32 * scale;
    Plan {
        n_whole: if part > 0.0 { n_whole } else { 0 },
        whole,
        n_parts,
        part,
        is_interpolated: matches!(mode, TimestepMode::Interpolated { .. }),
    }
}

/// The parts of a context that a step needs.
type Context = (
    Entity,
    &'static mut RapierContextSimulation,
    &'static mut RapierContextColliders,
    &'static mut RapierContextJoints,
    &'static mut RapierRigidBodySet,
    &'static RapierConfiguration,
    &'static mut SimulationToRenderTime,
);

/// Messages that a step writes.
#[derive(SystemParam)]
pub struct StepMessages<'w> {
    collisions: MessageWriter<'w, CollisionEvent>,
    forces: MessageWriter<'w, ContactForceEvent>,
    quarantines: MessageWriter<'w, PhysicsQuarantineEvent>,
}

/// Steps the default context.
pub fn step(
    mut physics: ResMut<FlexPhysics>,
    mut context: Query<Context, With<DefaultRapierContext>>,
    mode: Res<TimestepMode>,
    time: Res<Time>,
    mut messages: StepMessages,
    mut interpolated: Query<(&RapierRigidBodyHandle, &mut TransformInterpolation)>,
    mut commands: Commands,
) -> Result {
    let (entity, simulation, colliders, joints, rigid, configuration, mut ahead) =
        context.single_mut()?;
    let (simulation, colliders) = (simulation.into_inner(), colliders.into_inner());
    let (joints, rigid) = (joints.into_inner(), rigid.into_inner());
    let is_active = configuration.physics_pipeline_active
        && configuration.simulation_mode == SimulationMode::Full;
    let plan = is_active.then(|| plan(*mode, &time, &mut ahead));
    let Some(plan) = plan.filter(|plan| plan.n_whole > 0) else {
        rigid.propagate_modified_body_positions_to_colliders(colliders);
        return Ok(());
    };
    let FlexPhysics {
        bodies,
        pipeline,
        known: names,
        ..
    } = &mut *physics;
    let collector = Collector::new(names);
    simulation.set_num_threads(configuration.num_threads);
    simulation.integration_parameters.dt = plan.whole;
    let mut parameters = simulation.integration_parameters;
    parameters.dt = plan.part;
    let mut quarantine = PhysicsQuarantineEvent {
        context: entity,
        bodies: Vec::new(),
        colliders: Vec::new(),
        soft_bodies: Vec::new(),
    };
    for part in 0..plan.n_whole * plan.n_parts {
        if plan.is_interpolated && part == (plan.n_whole - 1) * plan.n_parts {
            start_interpolation(rigid, &mut interpolated);
        }
        pipeline.step_split(
            bodies,
            &mut simulation.pipeline,
            configuration.gravity,
            &parameters,
            &mut simulation.islands,
            &mut simulation.broad_phase,
            &mut simulation.narrow_phase,
            &mut rigid.bodies,
            &mut colliders.colliders,
            &mut joints.impulse_joints,
            &mut joints.multibody_joints,
            &mut rigid.soft_bodies,
            &mut simulation.ccd_solver,
            &() as &dyn PhysicsHooks,
            &collector,
        )?;
        add_quarantined(&mut quarantine, simulation, colliders, rigid);
    }
    let (collisions, forces) = collector.into_messages();
    messages.collisions.write_batch(collisions);
    messages.forces.write_batch(forces);
    known(&colliders.colliders, names);
    disable(&quarantine, &mut commands);
    if !(quarantine.bodies.is_empty()
        && quarantine.colliders.is_empty()
        && quarantine.soft_bodies.is_empty())
    {
        messages.quarantines.write(quarantine);
    }
    Ok(())
}

/// Where rigid bodies are before the last whole step of a frame.
fn start_interpolation(
    rigid: &RapierRigidBodySet,
    interpolated: &mut Query<(&RapierRigidBodyHandle, &mut TransformInterpolation)>,
) {
    for (handle, mut interpolation) in interpolated {
        if let Some(body) = rigid.bodies.get(handle.0) {
            interpolation.start = Some(*body.position());
            interpolation.end = None;
        }
    }
}

/// Adds what rapier took out of the world in the last step.
fn add_quarantined(
    event: &mut PhysicsQuarantineEvent,
    simulation: &RapierContextSimulation,
    colliders: &RapierContextColliders,
    rigid: &RapierRigidBodySet,
) {
    let all = simulation.pipeline.quarantine();
    let bodies = all.bodies().iter();
    let surfaces = all.colliders().iter();
    let soft = all.soft_bodies().iter();
    event
        .bodies
        .extend(bodies.filter_map(|handle| rigid.rigid_body_entity(*handle)));
    event
        .colliders
        .extend(surfaces.filter_map(|handle| colliders.collider_entity(*handle)));
    event
        .soft_bodies
        .extend(soft.filter_map(|handle| rigid.soft_body_entity(*handle)));
}

/// Says on the entities what rapier took out of the world: removing the component puts it back.
fn disable(event: &PhysicsQuarantineEvent, commands: &mut Commands) {
    for entity in &event.bodies {
        commands.entity(*entity).try_insert(RigidBodyDisabled);
    }
    for entity in &event.colliders {
        commands.entity(*entity).try_insert(ColliderDisabled);
    }
    for entity in &event.soft_bodies {
        commands.entity(*entity).try_insert(SoftBodyDisabled);
    }
}

/// Writes where nodes are.
pub fn write_positions(
    physics: Res<FlexPhysics>,
    mut entities: Query<(&FlexibleBody, &mut NodePositions)>,
) {
    for (handle, mut places) in &mut entities {
        if let Some(body) = physics.bodies.get(handle.0) {
            places.0 = positions(body);
        }
    }
}
