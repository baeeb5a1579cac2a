//! How well a step was solved: the one place where a user sees that something was cut short.

use super::accounts::SolvedPart;
use super::names::Names;
use super::report::{Participant, StepReport};
use crate::body::FlexBodySet;
use crate::coupling::{Claims, Trespasser};
use crate::kkt::{Island, IslandSummary};

/// How well a step, or an island of it, was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Quality {
    /// The laws of contact hold at its end.
    #[default]
    Solved,
    /// The whole of the step was taken along a feasible path, with forces under which gaps miss the laws by up to the offset of the surfaces,
    /// a hundredth of an edge; or a contact has slid off what it pressed on within the step, and its force has acted to the end.
    Cut,
    /// Its budget ran out, in the smallest parts that it may be cut into. Surfaces on a feasible path are apart where it was stopped, velocities
    /// come from the last forces; what lies on no path (pairs shown to hooks, what was put into each other) may overlap. Or rapier's own step has
    /// left in a flexible body what nothing foretold would reach it, as a body that a motor flings: it is solved for from the next step on.
    Unfinished,
}

/// An island that was not solved in one piece.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Unsolved {
    /// What became of it.
    pub quality: Quality,
    /// Its flexible bodies, and the colliders and bodies that its worst contact belongs to.
    pub bodies: Vec<Participant>,
    /// Largest overlap at its contacts (m).
    pub overlap: f64,
}

impl IslandSummary {
    /// How well the island was solved.
    pub(super) fn quality(&self) -> Quality {
        if self.is_stopped || self.is_linearized || self.is_held {
            Quality::Unfinished
        } else if self.is_cut {
            Quality::Cut
        } else {
            Quality::Solved
        }
    }
}

impl StepReport {
    /// Tells that members have left the boxes they were looked for in for good: what they meet there is not known.
    pub(super) fn tell_unseen(&mut self, claims: &Claims, flex_bodies: &FlexBodySet) {
        let claimed = claims.flex.iter();
        let flexible = claimed.filter_map(|flex| flex_bodies.at_index(flex.index));
        self.quality = Quality::Unfinished;
        self.unsolved.push(Unsolved {
            quality: Quality::Unfinished,
            bodies: flexible
                .map(|(handle, _)| Participant::Flex(handle))
                .collect(),
            overlap: self.gap_violation,
        });
    }

    /// Tells what rapier's own step has left in a flexible body: nothing was solved there, and the step has been taken.
    pub(super) fn tell_trespasser(&mut self, one: &Trespasser) {
        self.quality = Quality::Unfinished;
        self.gap_violation = self.gap_violation.max(one.depth);
        self.unsolved.push(Unsolved {
            quality: Quality::Unfinished,
            bodies: vec![
                Participant::Flex(one.body),
                Participant::Rigid(one.collider),
            ],
            overlap: one.depth,
        });
    }

    /// Tells of a part of an island's step that was not solved in one piece; an island is told of once, whatever the number of its parts.
    pub(super) fn tell_quality(
        &mut self,
        part: &SolvedPart<'_>,
        names: Names<'_, '_>,
        is_told: &mut bool,
    ) {
        let (island, summary) = (part.island, part.summary);
        let quality = summary.quality();
        self.quality = self.quality.max(quality);
        if quality == Quality::Solved {
            return;
        }
        let bodies = members_of(island, names);
        let was_told = std::mem::replace(is_told, true);
        if let Some(before) = self.unsolved.last_mut().filter(|_| was_told) {
            before.quality = before.quality.max(quality);
            before.overlap = before.overlap.max(summary.gap_violation);
            let new = bodies
                .into_iter()
                .filter(|one| !before.bodies.contains(one));
            let new: Vec<Participant> = new.collect();
            before.bodies.extend(new);
            return;
        }
        self.unsolved.push(Unsolved {
            quality,
            bodies,
            overlap: summary.gap_violation,
        });
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
