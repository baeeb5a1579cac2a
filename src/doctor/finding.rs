//! What is found, in words.

use crate::body::FlexBodyHandle;
use crate::pipeline::{InsertionNote, Participant};
use std::fmt;

/// Something about a body that is likely a mistake. Its `Display` says what to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finding {
    /// A cell is all but flat.
    Sliver {
        /// The body.
        body: FlexBodyHandle,
        /// The smallest angle of the mesh (deg).
        angle: f64,
    },
    /// Three-node triangles of a material that keeps its area: they lock.
    Locking {
        /// The body.
        body: FlexBodyHandle,
        /// Stiffness against a change of area over that against shear (-).
        ratio: f64,
    },
    /// A slender body has few cells of three nodes across: it is too stiff in bending.
    FewCells {
        /// The body.
        body: FlexBodyHandle,
        /// Cells across.
        across: usize,
        /// Length over thickness (-).
        slenderness: f64,
    },
    /// The lowest vibrations could not be computed, and neither damping nor sag were looked at.
    Unexamined {
        /// The body.
        body: FlexBodyHandle,
    },
    /// The lowest vibration is damped far beyond the critical ratio: the body creeps.
    Overdamped {
        /// The body.
        body: FlexBodyHandle,
        /// The lowest frequency above 0 (rad/s).
        frequency: f64,
        /// Damping ratio there (-).
        ratio: f64,
        /// How long it takes to go where a load takes it, but for 1/e of the way (s).
        time: f64,
    },
    /// The body is crushed by its own weight.
    Crushed {
        /// The body.
        body: FlexBodyHandle,
        /// Weight of a column of its height over its shear stiffness (-).
        ratio: f64,
    },
    /// A pinned body of small strain sags further than small strains describe.
    Sagging {
        /// The body.
        body: FlexBodyHandle,
        /// How far it sags under gravity, about (m).
        sag: f64,
        /// Its size (m).
        size: f64,
    },
    /// The explicit step is longer than the critical one: the pipeline refuses it.
    Unstable {
        /// The body.
        body: FlexBodyHandle,
        /// The critical step (s).
        critical: f64,
        /// The step (s).
        dt: f64,
    },
    /// The body moves by more than its own size in a step.
    Fast {
        /// The body.
        body: FlexBodyHandle,
        /// Sizes in a step (-).
        sizes: f64,
    },
    /// Where the body is rapier's numbers are as far apart as a part of a cell.
    FarAway {
        /// The body.
        body: FlexBodyHandle,
        /// Distance from the origin (m).
        distance: f64,
        /// The shortest edge (m).
        edge: f64,
    },
    /// The density is that of no solid.
    Density {
        /// The body.
        body: FlexBodyHandle,
        /// The density (kg/m³).
        density: f64,
    },
    /// What the first step will tell: pins that choose no node, bodies in each other.
    Insertion(InsertionNote),
    /// A collider that a flexible body would meet has a shape that it goes through.
    NotMet {
        /// The flexible body.
        body: FlexBodyHandle,
        /// The collider.
        with: Participant,
    },
    /// A rigid body that moves is very much heavier or lighter than a flexible one that it may meet.
    MassRatio {
        /// The flexible body.
        body: FlexBodyHandle,
        /// A collider of the rigid one.
        with: Participant,
        /// The heavier over the lighter (-).
        ratio: f64,
    },
}

impl Finding {
    /// The body that it is about.
    pub fn body(&self) -> FlexBodyHandle {
        match *self {
            Self::Sliver { body, .. }
            | Self::Locking { body, .. }
            | Self::FewCells { body, .. }
            | Self::Unexamined { body }
            | Self::Overdamped { body, .. }
            | Self::Crushed { body, .. }
            | Self::Sagging { body, .. }
            | Self::Unstable { body, .. }
            | Self::Fast { body, .. }
            | Self::FarAway { body, .. }
            | Self::Density { body, .. }
            | Self::Insertion(InsertionNote::NothingPinned { body, .. })
            | Self::Insertion(InsertionNote::Overlap { body, .. })
            | Self::NotMet { body, .. }
            | Self::MassRatio { body, .. } => body,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sliver { body, angle } => write!(
                f,
                "{body:?} has a cell with an angle of {angle:.2} degrees, which is stiff and badly conditioned: mesh it anew, or take a node of the outline away"
            ),
            Self::Locking { body, ratio } => write!(
                f,
                "{body:?} resists a change of area {ratio:.0} times as much as shear, and its three-node triangles lock: take `CellKind::Tri6` or `Quad4`, or a smaller Poisson's ratio"
            ),
            Self::FewCells {
                body,
                across,
                slenderness,
            } => write!(
                f,
                "{body:?} is {slenderness:.0} times as long as thick and has {across} three-node triangle(s) across, which are much too stiff in bending: take `CellKind::Tri6` or `Quad4`"
            ),
            Self::Unexamined { body } => write!(
                f,
                "the lowest vibrations of {body:?} cannot be computed, so that its damping and sag were not looked at: check its moduli and the shape of its cells"
            ),
            Self::Overdamped {
                body,
                frequency,
                ratio,
                time,
            } => write!(
                f,
                "{body:?} creeps to where a load takes it in {time:.2} s, as its lowest vibration, of {frequency:.3} rad/s, is damped with a ratio of {ratio:.1}: `rayleigh(2 ξ / {frequency:.3})` gives the ratio ξ"
            ),
            Self::Crushed { body, ratio } => write!(
                f,
                "the weight of {body:?} is {ratio:.1} times what its shear stiffness carries: it collapses; check its units, modulus and density"
            ),
            Self::Sagging { body, sag, size } => write!(
                f,
                "{body:?} of small strain sags by about {sag:.3} m of {size:.3} m, beyond what small strains describe: leave `.small_strain()` out, or take a stiffer material"
            ),
            Self::Unstable { body, critical, dt } => write!(
                f,
                "the explicit step of {dt:.3e} s is longer than the critical step of {body:?}, {critical:.3e} s, and will be refused: shorten it, or take an implicit integrator"
            ),
            Self::Fast { body, sizes } => write!(
                f,
                "{body:?} moves by {sizes:.1} times its size in a step: nothing is passed through, but an impact is one step; shorten it"
            ),
            Self::FarAway {
                body,
                distance,
                edge,
            } => write!(
                f,
                "{body:?} is {distance:.3e} m from the origin, where rapier's numbers are coarse beside its shortest edge of {edge:.3e} m: move the scene, or take the feature `f64`"
            ),
            Self::Density { body, density } => write!(
                f,
                "{body:?} has a density of {density:.3e} kg/m³, that of no solid: check its units"
            ),
            Self::Insertion(note) => note.fmt(f),
            Self::NotMet { body, with } => write!(
                f,
                "{body:?} goes through {with:?}, whose shape is of voxels or your own: take a polyline, a triangle mesh or a compound of convex shapes"
            ),
            Self::MassRatio { body, with, ratio } => write!(
                f,
                "the masses of {body:?} and {with:?} are {ratio:.1e} apart: steps hold, but the lighter one follows the heavier as if it had no mass"
            ),
        }
    }
}
