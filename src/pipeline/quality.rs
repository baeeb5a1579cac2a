//! How well a step was solved: the one place where a user sees that something was cut short.

use super::participant::Participant;
use crate::kkt::IslandSummary;

/// How well a step, or an island of it, was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Quality {
    /// The laws of contact hold at its end, and at those of its [parts](super::StepReport::n_parts), if it was taken in several.
    #[default]
    Solved,
    /// The whole of the step was taken along a feasible path, with forces under which gaps miss the laws by up to the offset of the surfaces,
    /// a hundredth of an edge; or a contact has slid off what it pressed on within the step, and its force has acted to the end; or joints and
    /// attachments contradict each other, and were left open.
    Cut,
    /// Its budget ran out, in the smallest parts that it may be cut into. Surfaces on a feasible path are apart where it was stopped, velocities
    /// come from the last forces; what lies on no path (pairs whose contacts hooks take away or move, what was put into each other) may overlap. Or rapier's own step has
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
        if self.is_stopped {
            Quality::Unfinished
        } else if self.is_cut || self.joint_violation > 0.0 {
            Quality::Cut
        } else {
            Quality::Solved
        }
    }
}

impl Unsolved {
    /// Adds what is told of another part of the same island.
    pub(super) fn join(&mut self, part: Self) {
        self.quality = self.quality.max(part.quality);
        self.overlap = self.overlap.max(part.overlap);
        let known = self.bodies.len();
        for body in part.bodies {
            if !self.bodies[..known].contains(&body) {
                self.bodies.push(body);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Participant, Quality, Unsolved};
    use crate::rapier::prelude::ColliderHandle;

    fn unsolved(quality: Quality, colliders: &[u32], overlap: f64) -> Unsolved {
        let handle = |&index: &u32| ColliderHandle::from_raw_parts(index, 0);
        let bodies = colliders.iter().map(handle).map(Participant::Rigid);
        Unsolved {
            quality,
            bodies: bodies.collect(),
            overlap,
        }
    }

    /// The parts of an island's step are told of as one: the worst of them, and every body once.
    #[test]
    fn parts_of_an_island_are_told_of_as_one() {
        let mut told = unsolved(Quality::Cut, &[1, 2], 2e-3);
        told.join(unsolved(Quality::Unfinished, &[2, 3], 1e-3));
        assert_eq!(told, unsolved(Quality::Unfinished, &[1, 2, 3], 2e-3));
    }
}
