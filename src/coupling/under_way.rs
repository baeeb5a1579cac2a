//! A step in parts: where its members are between two of them, before anything is handed back.
//!
//! Rapier takes the whole step at once. What is given to it by the user or by rapier itself (kinematic bodies, moved pins, bodies that
//! are not claimed) goes from where it begins to where it ends in a straight line; a part sees its piece of that.

use crate::body::{FlexBody, FlexBodySet, KeptForce, KeptMotion};
use crate::constraint::contact::ContactMemory;
use crate::constraint::joint::JointMemory;
use crate::kkt::Island;
use crate::math::HashMap;
use crate::rapier::prelude::RigidBodyHandle;
use crate::system::{Block, RigidMotion};

/// A part of a step: where it begins and ends, of a whole of one (-).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    from: f64,
    to: f64,
}

impl Span {
    /// All of the step.
    pub const WHOLE: Self = Self { from: 0.0, to: 1.0 };

    /// Its halves, in their order. Fractions are binary: nothing is rounded.
    pub fn halves(self) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        [
            Self { to: middle, ..self },
            Self {
                from: middle,
                ..self
            },
        ]
    }

    /// Its length (-).
    pub fn share(self) -> f64 {
        self.to - self.from
    }

    /// Whether the step begins with it.
    pub fn is_first(self) -> bool {
        self.from == 0.0
    }

    /// Whether the step ends with it.
    pub fn is_last(self) -> bool {
        self.to == 1.0
    }

    fn is_whole(self) -> bool {
        self == Self::WHOLE
    }

    /// Its piece of a motion from `start` to `end` over the step.
    pub fn of(self, start: RigidMotion, end: RigidMotion) -> [RigidMotion; 2] {
        let at = |share: f64| RigidMotion {
            centre: start.centre + share * (end.centre - start.centre),
            angle: start.angle + share * (end.angle - start.angle),
            ..end
        };
        let first = if self.is_first() {
            start
        } else {
            at(self.from)
        };
        let last = if self.is_last() { end } else { at(self.to) };
        [first, last]
    }
}

/// What has acted on a flexible body in the parts of its step that are solved.
#[derive(Debug)]
struct PartImpulse {
    index: u32,
    /// How much of the step that is (-).
    share: f64,
    /// Contact forces and reactions of the parts, times their shares (N).
    sums: [Vec<f64>; 2],
}

/// Forces that flexible bodies keep, by their indices.
pub(crate) type KeptForces = [(u32, KeptForce)];

/// The members of an island between two parts of a step.
#[derive(Debug, Default)]
pub(crate) struct UnderWay {
    /// Flexible bodies as they were at the beginning of the step.
    flex: Vec<(u32, KeptMotion)>,
    /// Motions of claimed rigid bodies, and their smooth accelerations.
    rigid: HashMap<RigidBodyHandle, (RigidMotion, [f64; 3])>,
    /// What has acted on the flexible bodies in the parts that are over.
    impulses: Vec<PartImpulse>,
    /// Multipliers of the last part.
    pub contacts: ContactMemory,
    pub joints: JointMemory,
    /// Pivots of all that has been tried of the island's step.
    n_pivots: usize,
    /// Parts on end that were not finished, up to the last.
    n_unfinished: usize,
}

impl UnderWay {
    /// Begins with a step, of all islands.
    pub fn begin_step(&mut self) {
        self.impulses.clear();
    }

    /// Begins with an island whose whole step is still to come.
    pub fn begin(&mut self) {
        self.flex.clear();
        self.rigid.clear();
        self.contacts = ContactMemory::default();
        self.joints = JointMemory::default();
        (self.n_pivots, self.n_unfinished) = (0, 0);
    }

    /// Pivots of all that has been tried of the island's step.
    pub fn n_pivots(&self) -> usize {
        self.n_pivots
    }

    /// Notes the pivots of what has been tried.
    pub fn note_pivots(&mut self, n_pivots: usize) {
        self.n_pivots += n_pivots;
    }

    /// Parts on end that were not finished, up to the last.
    pub fn n_unfinished(&self) -> usize {
        self.n_unfinished
    }

    /// Notes whether a part that is over was finished.
    pub fn note_end(&mut self, is_finished: bool) {
        self.n_unfinished = match is_finished {
            true => 0,
            false => self.n_unfinished + 1,
        };
    }

    /// Keeps the motions that the step of the island begins with.
    pub fn keep(&mut self, island: &Island, flex_bodies: &FlexBodySet) {
        if self.flex.is_empty() {
            let members = island.flex_index.iter().flatten();
            let kept = members.filter_map(|&index| {
                let (_, body) = flex_bodies.at_index(index)?;
                Some((index, body.keep_motion()))
            });
            self.flex.extend(kept);
        }
    }

    /// Puts the members where the part ends that was solved.
    ///
    /// - `bodies`: claimed ones, by their blocks.
    /// - `kept`: forces that flexible bodies keep, by their indices.
    pub fn go_on(
        &mut self,
        island: &Island,
        (bodies, kept): (&[(usize, RigidBodyHandle)], &KeptForces),
        span: Span,
        flex_bodies: &mut FlexBodySet,
    ) {
        let members = island.blocks.iter().zip(&island.flex_index);
        for ((block, index), reserve) in members.zip(&island.reserves) {
            if let (Block::Flex(block), Some(index)) = (block, index)
                && let Some(body) = flex_bodies.at_index_mut(*index)
            {
                block.commit(body.state_mut());
                block.write_contact_force(body.contact_force_mut());
                block.write_reactions(body.reaction_mut());
                body.set_energy_reserve(*reserve);
                body.keep_forces(*index, kept);
                self.add_impulse(*index, span.share(), body);
            }
        }
        for &(block, handle) in bodies {
            if let Block::Rigid(block) = &island.blocks[block] {
                self.rigid
                    .insert(handle, (*block.current(), block.smooth_end));
            }
        }
        self.contacts.turn_over();
        self.joints.turn_over();
    }

    fn add_impulse(&mut self, index: u32, share: f64, body: &FlexBody) {
        let forces = [body.contact_forces(), body.reactions()];
        let known = self.impulses.iter_mut().find(|known| known.index == index);
        match known {
            Some(known) => {
                known.share += share;
                for (sums, forces) in known.sums.iter_mut().zip(forces) {
                    let pairs = sums.iter_mut().zip(forces);
                    pairs.for_each(|(sum, force)| *sum += share * force);
                }
            }
            None => self.impulses.push(PartImpulse {
                index,
                share,
                sums: forces.map(|forces| forces.iter().map(|force| share * force).collect()),
            }),
        }
    }

    /// Makes the contact forces and reactions of a body's last part those of its step.
    pub fn average(&self, index: u32, body: &mut FlexBody) {
        if let Some(known) = self.impulses.iter().find(|known| known.index == index) {
            let ([contact, reaction], last) = (&known.sums, 1.0 - known.share);
            for (force, sum) in body.contact_force_mut().iter_mut().zip(contact) {
                *force = sum + last * *force;
            }
            body.average_reactions(reaction, last);
        }
    }

    /// Puts the flexible bodies back to where the step begins: it is not committed yet.
    pub fn end(&mut self, flex_bodies: &mut FlexBodySet) {
        for (index, kept) in self.flex.drain(..) {
            if let Some(body) = flex_bodies.at_index_mut(index) {
                body.put_back(kept);
            }
        }
    }

    /// The motion of a claimed body where the next part begins, with its smooth acceleration.
    pub fn rigid(&self, handle: RigidBodyHandle) -> Option<(RigidMotion, Option<[f64; 3]>)> {
        let (motion, acceleration) = self.rigid.get(&handle)?;
        Some((*motion, Some(*acceleration)))
    }

    /// Displacements of a body's pins at the end of a part, interleaved (m): `None` where they are those at the end of the step.
    ///
    /// - `rest`: positions of its nodes without displacement.
    /// - `goal`: the displacements at the end of the step.
    pub fn pins(&self, index: u32, span: Span, rest: &[f64], goal: &[f64]) -> Option<Vec<f64>> {
        if span.is_whole() {
            return None;
        }
        let (_, kept) = self.flex.iter().find(|(own, _)| *own == index)?;
        let start = kept.state().position.iter().zip(rest);
        let between = start.zip(goal).map(|((position, rest), goal)| {
            let start = position - rest;
            start + span.to * (goal - start)
        });
        Some(between.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::Span;
    use crate::math::Vec2;
    use crate::system::RigidMotion;

    /// Halves of halves tile the step, and the pieces of a course join without a gap, to the last bit.
    #[test]
    fn parts_tile_the_step_and_pieces_of_a_course_join() {
        let mut spans = vec![Span::WHOLE];
        for _ in 0..4 {
            spans = spans.into_iter().flat_map(Span::halves).collect();
        }
        assert_eq!(spans.len(), 16);
        assert!(spans[0].is_first() && spans[15].is_last());
        assert_eq!(spans.iter().map(|span| span.share()).sum::<f64>(), 1.0);
        let start = RigidMotion {
            centre: Vec2::new(0.1, -0.7),
            angle: 0.3,
            ..RigidMotion::default()
        };
        let end = RigidMotion {
            centre: Vec2::new(1.3, 0.4),
            angle: -0.9,
            velocity: Vec2::new(72.0, 66.0),
            spin: -72.0,
        };
        let pieces: Vec<_> = spans.iter().map(|span| span.of(start, end)).collect();
        assert_eq!(pieces[0][0], start);
        assert_eq!(pieces[15][1], end);
        for pair in pieces.windows(2) {
            assert_eq!(pair[0][1], pair[1][0]);
        }
        assert_eq!(Span::WHOLE.of(start, end), [start, end]);
    }
}
