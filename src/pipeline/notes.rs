//! What the user asked for and is likely a mistake, told in the report of the first step after it.

use super::participant::Participant;
use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::coupling::{ClaimedPair, Claims, PutTogether, RapierSets, overlaps_of_newcomers};
use std::fmt;

/// Something about a body that has just been inserted, or put where it is. Nothing is refused: the step was taken.
///
/// Its `Display` says what to do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum InsertionNote {
    /// Calls of `pin_where` that chose no node.
    NothingPinned {
        /// The body.
        body: FlexBodyHandle,
        /// How many such calls.
        n_calls: usize,
    },
    /// A body was put into another, or a rigid body, inserted, moved or altered, into it; they part by and by, where they can.
    Overlap {
        /// The body.
        body: FlexBodyHandle,
        /// What it overlaps.
        with: Participant,
    },
}

impl fmt::Display for InsertionNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingPinned { body, n_calls } => write!(
                f,
                "{n_calls} call(s) of `pin_where` for {body:?} chose no node: compare mesh coordinates with a tolerance, and before `translation` and `rotation`"
            ),
            Self::Overlap { body, with } => write!(
                f,
                "{body:?} and {with:?} were put into each other, and part by and by: put them apart, or let them not meet by `collision_groups`"
            ),
        }
    }
}

/// What is odd about bodies that take their first step where they are; overlaps are noted, to be measured until they are apart.
pub(super) fn notes_of_newcomers(
    claims: &Claims,
    sets: &RapierSets<'_>,
    flex_bodies: &FlexBodySet,
    put_together: &mut PutTogether,
) -> Vec<InsertionNote> {
    let mut notes = Vec::new();
    let handle = |flex: usize| {
        let index = claims.flex[flex].index;
        flex_bodies.at_index(index).map(|(handle, _)| handle)
    };
    for flex in &claims.flex {
        if let Some((body, found)) = flex_bodies.at_index(flex.index)
            && found.is_new()
            && found.n_idle_pins() > 0
        {
            notes.push(InsertionNote::NothingPinned {
                body,
                n_calls: found.n_idle_pins(),
            });
        }
    }
    let overlaps = overlaps_of_newcomers(claims, sets, flex_bodies);
    put_together.note(&overlaps, &claims.flex, flex_bodies);
    for pair in overlaps {
        let (body, with) = match pair {
            ClaimedPair::FlexRigid(flex, other) => (handle(flex), Some(Participant::Rigid(other))),
            ClaimedPair::FlexFlex(one, other) => {
                (handle(one), handle(other).map(Participant::Flex))
            }
            ClaimedPair::RigidRigid(..) => continue,
        };
        if let (Some(body), Some(with)) = (body, with) {
            notes.push(InsertionNote::Overlap { body, with });
        }
    }
    notes
}
