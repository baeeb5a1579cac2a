//! What can be wrong with the description of a body, or with the handle that names it.

use super::handle::FlexBodyHandle;
use super::region::Region;
use crate::fe::finite_strain::FiniteStrainError;
use crate::fe::material::MaterialError;
use crate::fe::mesh::MeshError;
use crate::fe::model::ModelError;
use crate::math::is_held;
use thiserror::Error;

/// Why a body cannot be built. Nothing was changed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// The mesh is not that of a body.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A material parameter is out of range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// Stiffness or mass cannot be assembled.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The body of large strain cannot be assembled.
    #[error(transparent)]
    Large(#[from] FiniteStrainError),
    /// The material has no law for large strains, and the body has not been said to be one of small strain.
    #[error(
        "{}the material, {material}, has no law for large strains: choose `.small_strain()` for a body that bends and stretches little, take a `HyperelasticSolid`, or give a material of your own a `Material::large_law`",
        .region.map_or(String::new(), |region| format!("in region {region} "))
    )]
    NoLargeLaw {
        /// The material, as `Debug` writes it.
        material: String,
        /// The region it was given to, if it was not given to the whole body.
        region: Option<u32>,
    },
    /// A material that flows in a body of small strain.
    #[error(
        "`.small_strain()` has no plastic flow, and the material flows by the law `{law}`: leave it out, or take a `LinearElastic` material"
    )]
    FlowSmallStrain {
        /// Name of the law.
        law: &'static str,
    },
    /// A body that flows is to be made of a material that flows by another law, or not at all.
    #[error(
        "what has flowed in a body belongs to its law: keep the plastic law, with another density or damping if you like, or build another body"
    )]
    FlowChanged,
    /// A body of large strain with a consistent mass.
    #[error(
        "the masses of a body of large strain are lumped: leave `.mass_kind` at `MassKind::Lumped`, or choose `.small_strain()`"
    )]
    LargeConsistent,
    /// A body of large strain with nodes that are to have no mass.
    #[error(
        "the surface of a body of large strain carries its mass: leave `ContactInertia::RedistributedAt` out, or choose `.small_strain()`"
    )]
    LargeMassless,
    /// A body of small strain with an inner pressure.
    #[error("an inner pressure needs a body of large strain: leave `.small_strain()` out")]
    PressureSmallStrain,
    /// An inner pressure in a body without a hole.
    #[error(
        "the mesh has no hole for an inner pressure: take an annulus or a polygon with holes, or leave `.inner_pressure` out"
    )]
    NoHole,
    /// A body of small strain that is to be stretched where it is built.
    #[error(
        "a pre-stretch needs a body of large strain, whose stiffness knows of stress: leave `.small_strain()` out"
    )]
    PreStretchSmallStrain,
    /// The law has no state as stretched, or under as much stress, as asked for.
    #[error(
        "the law `{law}` has no state with the pre-stretch or stress {asked:?}: give less, or take a law that bears it"
    )]
    PreStretchBeyond {
        /// Name of the law.
        law: &'static str,
        /// Stretches (-) or stresses (Pa) along x and y; a stretch along one axis twice.
        asked: [f64; 2],
    },
    /// The material flows as stretched as asked for.
    #[error(
        "the material flows by the law `{law}` at the pre-stretches {stretches:?}: stay below its yield stress"
    )]
    PreStretchFlows {
        /// Name of the law.
        law: &'static str,
        /// Stretches along x and y (-).
        stretches: [f64; 2],
    },
    /// Regions of one body would be stretched in different ways.
    #[error(
        "under the stress of the pre-stretch, region {region} would have the stretches {:?} and others {:?}, which do not fit together: give both stretches, `.pre_stretch([x, y])`",
        .stretches[1], .stretches[0]
    )]
    PreStretchRegion {
        /// The region.
        region: u32,
        /// Stretches along x and y (-) of the rest of the body, and of the region.
        stretches: [[f64; 2]; 2],
    },
    /// No material was given.
    #[error(
        "the body has no material: call `.material(LinearElastic::plane_stress(E, nu).density(rho))`"
    )]
    NoMaterial,
    /// A material was given to a region that the mesh has not.
    #[error(
        "a material is for region {region}, and the mesh has the regions {known:?}: name one of them, or put cells into it by `Mesh::with_regions`"
    )]
    NoRegion {
        /// The region named.
        region: Region,
        /// Those of the mesh.
        known: Vec<u32>,
    },
    /// Some regions have a material, and this one has none.
    #[error(
        "region {region} has no material: call `.region_material({region}, ...)`, or `.material(...)` for all that have none of their own"
    )]
    RegionWithoutMaterial {
        /// The region.
        region: u32,
    },
    /// A number is not finite or out of its range.
    #[error("{name} is {value}: {cure}")]
    Number {
        /// Which setting.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// What to do.
        cure: &'static str,
    },
    /// What the body is made of leaves the range in which it can be computed.
    #[error(
        "the {name} of the body is {value:e}, and what can be stepped lies between 1e-36 and 1e36 and is finite: choose units or sizes nearer to one"
    )]
    OutOfRange {
        /// Which quantity.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A node lies where rapier's precision cannot hold it.
    #[error(
        "node {node} lies at {place:?} m, which rapier's precision cannot hold: make the body smaller or place it nearer to the origin"
    )]
    Place {
        /// The node.
        node: usize,
        /// Where it lies, in the world's axes (m).
        place: [f64; 2],
    },
    /// A setting names a node that does not exist.
    #[error(
        "{name} names node {node} of a mesh with {n_nodes} nodes: use an index below {n_nodes}"
    )]
    Node {
        /// Which setting.
        name: &'static str,
        /// The node named.
        node: usize,
        /// How many there are.
        n_nodes: usize,
    },
    /// A list does not have one entry per node.
    #[error("{name} has {found} entries for {n_nodes} nodes: give one per node")]
    Length {
        /// Which setting.
        name: &'static str,
        /// Entries given.
        found: usize,
        /// Nodes of the mesh.
        n_nodes: usize,
    },
    /// The pins leave a rotation that the body's single frame cannot follow.
    #[error(
        "the pins hold some displacement but leave the body free to rotate: pin one node in both directions (a hinge), or add a pin that holds the rotation"
    )]
    RotatingPins,
}

/// Why a call that names a body failed. Nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FlexBodyError {
    /// The handle's body was removed.
    #[error("{0:?} names a flexible body that was removed: drop the handle")]
    Stale(FlexBodyHandle),
    /// The handle came from another set.
    #[error(
        "{0:?} comes from another FlexBodySet, or was never filled in: use the set that returned it"
    )]
    Foreign(FlexBodyHandle),
    /// A node index is out of range.
    #[error("node {node} of a body with {n_nodes} nodes: use an index below {n_nodes}")]
    Node {
        /// The node named.
        node: usize,
        /// How many there are.
        n_nodes: usize,
    },
    /// A list does not have two entries per node.
    #[error("{name} have {found} entries for {n_nodes} nodes: give two per node, x and y")]
    Length {
        /// Which list.
        name: &'static str,
        /// Entries given.
        found: usize,
        /// Nodes of the body.
        n_nodes: usize,
    },
    /// A node is not pinned.
    #[error("node {0} is not pinned: pin it in the builder before prescribing its displacement")]
    NotPinned(usize),
    /// The body is pinned where it is.
    #[error(
        "{0:?} is pinned, and its pins stay where they are: move them by `set_pin_displacement`, or hold the body by attachments instead"
    )]
    Pinned(FlexBodyHandle),
    /// The body is out of the world because its motion would not have been finite.
    #[error(
        "{0:?} is quarantined: mend what made its motion more than numbers can hold, and put it back by `FlexBodySet::reinstate`"
    )]
    Quarantined(FlexBodyHandle),
    /// A value is not finite, or too large for rapier's precision.
    #[error("{0} holds a number that is not finite or too large for rapier: nothing was changed")]
    NotFinite(&'static str),
    /// A coefficient or distance is negative.
    #[error("a contact setting is {0}: friction, restitution and skin must not be negative")]
    Negative(f64),
    /// The world does not hold the body's carrier.
    #[error(
        "the world given does not hold the carrier of {0:?} as it was left: use the world it was inserted into, leave the pose and shape of its carrier alone (put back at the identity, steps go on), remove the body from its set by `FlexBodySet::remove` rather than through rapier, and `FlexBodySet::forget` it if its carrier is gone"
    )]
    NoCarrier(FlexBodyHandle),
    /// The user has given the body's carrier a velocity or a force.
    #[error(
        "the carrier of {0:?} was given a velocity or a force, and carriers stay where they are: set it back to zero, and steer the body by `FlexBody::set_linvel` or by forces on it"
    )]
    CarrierDriven(FlexBodyHandle),
    /// The user has given the body's carrier another type, or another collider.
    #[error(
        "the carrier of {0:?} is no dynamic body with the body's surface alone any more: set its type back to dynamic (pins hold a flexible body, attachments drive it), and put other colliders on bodies of their own"
    )]
    CarrierChanged(FlexBodyHandle),
}

/// Refuses numbers that are not finite.
pub(super) fn check_finite(name: &'static str, values: &[f64]) -> Result<(), FlexBodyError> {
    let is_finite = values.iter().all(|value| value.is_finite());
    is_finite
        .then_some(())
        .ok_or(FlexBodyError::NotFinite(name))
}

/// Refuses numbers that rapier's precision cannot hold.
pub(super) fn check_held(name: &'static str, values: &[f64]) -> Result<(), FlexBodyError> {
    let is_held = values.iter().all(|&value| is_held(value));
    is_held.then_some(()).ok_or(FlexBodyError::NotFinite(name))
}
