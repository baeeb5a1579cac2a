//! Snapshots: a world with its flexible bodies at an instant, to go on from bit for bit.
//!
//! Saved is what the next step depends on: rapier's world, the state of the flexible bodies and the descriptions of their models,
//! attachments, multipliers, reference faces, what handlers and hooks know, and what the factors of sparse contact problems were made of, as the next
//! ones go on from them. What follows from it (matrices, factors, compliances, shapes) is computed anew and comes out the same.

mod checksum;
mod error;
mod wire;

pub use error::SnapshotError;

use super::flex_pipeline::FlexPipeline;
use super::islands::Solver;
use super::report::StepReport;
use super::settings::FlexParameters;
use crate::body::{FlexBodySet, SetRecord, SetRecordError};
use crate::constraint::contact::ContactMemory;
use crate::coupling::{CouplingRecord, PutTogether};
use crate::fe::record::KnownLaws;
use crate::kkt::KeptRecord;
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Raised with every change of what is written, rapier's own structures included.
const FORMAT: u32 = 22;

/// Bits of rapier's numbers.
const PRECISION: u8 = 8 * size_of::<Real>() as u8;

/// A world with its flexible bodies at an instant between two steps.
///
/// It is written and read by any serde format that keeps every bit of a float, infinite ones included: binary ones do, JSON does not.
/// The same version of the program with the same features then goes on as if nothing had happened, bit for bit. Islands of many contacts go on from
/// factors of the step before: what these were made of is saved, which doubles the size of a pile's snapshot, and they are made again when the island is solved. Handles stay valid; where the data is read by a program that has made sets of its own already, a handle of one of these may be taken for
/// one of the restored set.
///
/// Not part of it are hooks and event handlers, the thread pool and the counters of rapier's pipeline, and what rapier itself does
/// not save: joints that were inserted, removed or changed since the last step are joined to their islands in the next one, so take
/// the snapshot before such changes or a step after them.
///
/// Elements and materials of your own are saved by name, see [`KnownLaws`].
///
/// ```
/// use foil2d::pipeline::Snapshot;
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
/// let mut world = PhysicsWorld::new();
/// let mut flex_bodies = FlexBodySet::new();
/// let block = flex_bodies.insert(
///     FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
///         .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0)),
///     &mut world,
/// )?;
/// let mut flex = FlexPipeline::new();
/// flex.step(&mut world, &mut flex_bodies)?;
/// let saved = Snapshot::take(&world, &flex_bodies, &flex)?;
/// let expected = flex.step(&mut world, &mut flex_bodies)?.clone();
/// let (mut world, mut flex_bodies, mut flex) = saved.restore()?;
/// let report = flex.step(&mut world, &mut flex_bodies)?;
/// assert_eq!(report.momentum(), expected.momentum());
/// # let _ = block;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Snapshot {
    header: wire::Header,
    /// `None` where the header forbade to read on.
    data: Option<Box<Data>>,
}

impl fmt::Debug for Snapshot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Snapshot")
            .field("header", &self.header)
            .finish_non_exhaustive()
    }
}

#[derive(Clone, Serialize, Deserialize)]
struct Data {
    world: WorldRecord,
    flex_bodies: SetRecord,
    pipeline: PipelineRecord,
}

impl Snapshot {
    /// Copies all that the next step depends on.
    ///
    /// # Errors
    /// If an element or a material of the user's has no name.
    pub fn take(
        world: &PhysicsWorld,
        flex_bodies: &FlexBodySet,
        flex: &FlexPipeline,
    ) -> Result<Self, SnapshotError> {
        Ok(Self {
            header: wire::Header::own(),
            data: Some(Box::new(Data {
                world: WorldRecord::of(world),
                flex_bodies: SetRecord::of(flex_bodies)?,
                pipeline: PipelineRecord::of(flex, flex_bodies),
            })),
        })
    }

    /// A number that is the same for the same state, such as that of two programs that step the same world: of every bit that is
    /// written, but for the order of hash maps in rapier.
    ///
    /// # Errors
    /// If the data was not understood.
    pub fn checksum(&self) -> Result<u64, SnapshotError> {
        self.header.check()?;
        let data = self.data.as_ref().ok_or(SnapshotError::Damaged)?;
        checksum::checksum(data).map_err(|_| SnapshotError::Damaged)
    }

    /// The world, the flexible bodies and the pipeline again, if all elements and materials are built-in ones.
    ///
    /// # Errors
    /// [`SnapshotError`]: of another version, damaged, or with elements or materials that are not known.
    pub fn restore(self) -> Result<(PhysicsWorld, FlexBodySet, FlexPipeline), SnapshotError> {
        self.restore_with(&KnownLaws::new())
    }

    /// [`Snapshot::restore`] with elements and materials of the user's.
    ///
    /// # Errors
    /// As [`Snapshot::restore`].
    pub fn restore_with(
        self,
        laws: &KnownLaws,
    ) -> Result<(PhysicsWorld, FlexBodySet, FlexPipeline), SnapshotError> {
        self.header.check()?;
        let Data {
            world,
            flex_bodies,
            pipeline,
        } = *self.data.ok_or(SnapshotError::Damaged)?;
        let flex_bodies = flex_bodies.build(laws)?;
        let flex = pipeline.build(&flex_bodies)?;
        Ok((world.build(), flex_bodies, flex))
    }
}

impl From<SetRecordError> for SnapshotError {
    fn from(error: SetRecordError) -> Self {
        match error {
            SetRecordError::Body(body, source) => Self::Body { body, source },
            SetRecordError::Slots(what) => Self::Inconsistent(what),
        }
    }
}

/// Rapier's world without its pipelines, which hold nothing that lasts.
#[derive(Clone, Serialize, Deserialize)]
struct WorldRecord {
    gravity: Vector,
    integration_parameters: IntegrationParameters,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
}

impl WorldRecord {
    fn of(world: &PhysicsWorld) -> Self {
        Self {
            gravity: world.gravity,
            integration_parameters: world.integration_parameters,
            islands: world.islands.clone(),
            broad_phase: world.broad_phase.clone(),
            narrow_phase: world.narrow_phase.clone(),
            bodies: world.bodies.clone(),
            colliders: world.colliders.clone(),
            impulse_joints: world.impulse_joints.clone(),
            multibody_joints: world.multibody_joints.clone(),
            soft_bodies: world.soft_bodies.clone(),
        }
    }

    fn build(self) -> PhysicsWorld {
        PhysicsWorld {
            gravity: self.gravity,
            integration_parameters: self.integration_parameters,
            islands: self.islands,
            broad_phase: self.broad_phase,
            narrow_phase: self.narrow_phase,
            bodies: self.bodies,
            colliders: self.colliders,
            impulse_joints: self.impulse_joints,
            multibody_joints: self.multibody_joints,
            soft_bodies: self.soft_bodies,
            ..PhysicsWorld::new()
        }
    }
}

/// Settings and memory of a pipeline.
#[derive(Clone, Serialize, Deserialize)]
struct PipelineRecord {
    parameters: FlexParameters,
    memory: ContactMemory,
    coupling: CouplingRecord,
    kept: Vec<KeptRecord>,
    put_together: PutTogether,
    report: StepReport,
}

impl PipelineRecord {
    fn of(flex: &FlexPipeline, flex_bodies: &FlexBodySet) -> Self {
        let pool = flex.solver.pool();
        Self {
            parameters: flex.parameters,
            memory: flex.memory.contacts.clone(),
            coupling: CouplingRecord::of(&flex.claims, &flex.events, &flex.memory, pool),
            kept: flex.solver.kept_records(flex_bodies),
            put_together: flex.put_together.clone(),
            report: flex.report.clone(),
        }
    }

    fn build(self, flex_bodies: &FlexBodySet) -> Result<FlexPipeline, SnapshotError> {
        let coupling = self.coupling.build(self.memory, flex_bodies);
        let (claims, events, memory, pool) =
            coupling.ok_or(SnapshotError::Inconsistent("explicit bodies"))?;
        let mut flex = FlexPipeline::new();
        flex.parameters = self.parameters;
        flex.claims = claims;
        flex.events = events;
        flex.memory = memory;
        let solver = Solver::restored(pool, self.kept, flex_bodies);
        flex.solver = solver.ok_or(SnapshotError::Inconsistent("factors and bodies"))?;
        flex.put_together = self.put_together;
        flex.report = self.report;
        Ok(flex)
    }
}
