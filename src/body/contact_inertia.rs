//! Whether the surface of a body has mass.

/// Whether the contact boundary of a body carries inertia.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ContactInertia {
    /// While something may touch a body of small strain, or a pin or weld holds it to the world or to a rigid body that is not lighter, in any of its motions, than the nodes held, the mass of its boundary is with the nodes inside (Khenous, Laborde,
    /// Renard 2008), so that an impact conserves energy; else it is where it belongs, and the body vibrates as without contact. It
    /// goes from one to the other with its momentum, its angular momentum about the centre of mass and its energy. In explicit
    /// steps it stays inside. A body without inside nodes, or with a consistent mass, keeps its inertia.
    #[default]
    Redistributed,
    /// Only these nodes give their mass away, which may be a consistent one: for bodies one element thick, and for impacts on a
    /// known part of the boundary. They make the body one of [small strain](super::FlexBodyBuilder::small_strain).
    RedistributedAt(Vec<usize>),
    /// Every node keeps its mass; contacts get impulses at velocity level.
    Kept,
}
