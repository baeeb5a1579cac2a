//! Whether the surface of a body has mass.

/// Whether the contact boundary of a body carries inertia.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ContactInertia {
    /// The mass of the boundary moves to the nodes inside (Khenous, Laborde, Renard 2008), so that an impact conserves
    /// energy. A body without inside nodes, or with a consistent mass, keeps its inertia.
    #[default]
    Redistributed,
    /// Only these nodes give their mass away, which may be a consistent one: for bodies one element thick, and for impacts on a
    /// known part of the boundary. They make the body one of [small strain](super::FlexBodyBuilder::small_strain).
    RedistributedAt(Vec<usize>),
    /// Every node keeps its mass; contacts get impulses at velocity level.
    Kept,
}
