//! Bodies that are bent or stretched beyond what small strains describe: every equation of the step holds, but for another body.

use crate::body::{FlexBodyHandle, FlexBodySet};
use std::fmt;

/// Strain left out (-) from which a body is told of: lengths are wrong by a hundredth. That is a turn of 0.14 rad against the body's frame, as
/// at the end of a clamped beam that sags by a tenth of its length, or a stretch of 14 %.
const TOLD: f64 = 0.01;

/// A body that is bent or stretched beyond small strains.
///
/// Its motion is that of a body whose strains are linear in the displacements from its frame. It keeps its energy, but it grows as it bends,
/// and a strip between two pins sags without carrying as a string. Its `Display` says what to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overbent {
    /// The body.
    pub body: FlexBodyHandle,
    /// Largest strain that is left out: see [`FlexBody::neglected_strain`](crate::body::FlexBody::neglected_strain) (-).
    pub neglected_strain: f64,
}

impl fmt::Display for Overbent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:?} is bent or stretched so far that small strains leave out a strain of {:.3}: leave `.small_strain()` out, or make it stiffer",
            self.body, self.neglected_strain
        )
    }
}

/// Adds the bodies, of those at some slots of the set, that are beyond small strains.
pub(super) fn list_overbent(
    indices: impl Iterator<Item = u32>,
    flex_bodies: &FlexBodySet,
    found: &mut Vec<Overbent>,
) {
    for index in indices {
        let Some((handle, body)) = flex_bodies.at_index(index) else {
            continue;
        };
        if let Some(neglected_strain) = body.neglected_beyond(TOLD) {
            found.push(Overbent {
                body: handle,
                neglected_strain,
            });
        }
    }
}
