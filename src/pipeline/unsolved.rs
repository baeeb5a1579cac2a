//! What was not solved, as the report tells of it.

use super::names::Names;
use super::participant::Participant;
use super::quality::{Quality, Unsolved};
use super::solved::SolvedPart;
use crate::body::FlexBodySet;
use crate::coupling::{Claims, Trespasser};
use crate::kkt::Island;

impl Unsolved {
    /// A part of an island's step that was not solved in one piece; `None` of one that was.
    pub(super) fn of_part(part: &SolvedPart<'_>, names: Names<'_, '_>) -> Option<Self> {
        let quality = part.summary.quality();
        (quality > Quality::Solved).then(|| Self {
            quality,
            bodies: members_of(part.island, names),
            overlap: part.summary.gap_violation,
        })
    }

    /// Members have left the boxes they were looked for in for good: what they meet there is not known.
    ///
    /// - `overlap`: the largest that is known (m).
    pub(super) fn unseen(claims: &Claims, flex_bodies: &FlexBodySet, overlap: f64) -> Self {
        let claimed = claims.flex.iter();
        let flexible = claimed.filter_map(|flex| flex_bodies.at_index(flex.index));
        let bodies = flexible.map(|(handle, _)| Participant::Flex(handle));
        Self {
            quality: Quality::Unfinished,
            bodies: bodies.collect(),
            overlap,
        }
    }
}

impl From<&Trespasser> for Unsolved {
    /// What rapier's own step has left in a flexible body: nothing was solved there, and the step has been taken.
    fn from(found: &Trespasser) -> Self {
        let (flexible, collider) = (found.body, found.collider);
        Self {
            quality: Quality::Unfinished,
            bodies: vec![Participant::Flex(flexible), Participant::Rigid(collider)],
            overlap: found.depth,
        }
    }
}

/// The flexible bodies of an island, and whose its worst contact is.
fn members_of(island: &Island, names: Names<'_, '_>) -> Vec<Participant> {
    let flexible = island.flex_index.iter().flatten();
    let flexible = flexible.filter_map(|&index| names.flex_bodies.at_index(index));
    let mut bodies: Vec<Participant> = flexible
        .map(|(handle, _)| Participant::Flex(handle))
        .collect();
    let depth = |slot: &usize| -island.contacts[*slot].gap();
    let worst = (0..island.contacts.len()).max_by(|a, b| depth(a).total_cmp(&depth(b)));
    if let Some(slot) = worst {
        let key = island.candidates[island.contacts[slot].candidate].key;
        for owner in key.owners() {
            let participant = names.participant(owner);
            bodies.extend(participant.filter(|one| !bodies.contains(one)));
        }
    }
    bodies
}
