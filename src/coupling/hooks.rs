//! Hooks: what the user's hooks say of contacts that the flexible stage solves.
//!
//! Rapier asks the hooks about its own manifolds, in two steps of which the second shows locked bodies at velocities that
//! are none. For pairs of the flexible stage they are asked here, before anything is locked: every candidate is shown as
//! a manifold of its own point, and of the one that is farthest behind its face where flexible bodies reach farther. Its `user_data`
//! lasts as long as the candidate does, and begins, of a flexible body, with that of the nearest one, or of any in the last step. Rapier is given the answers.

mod gate;
mod shown;

pub(crate) use gate::HookGate;

use super::pair_name::{PairName, pair_name};
use super::reading::GatherError;
use super::sets::RapierSets;
use crate::constraint::contact::{
    Candidate, ContactKey, ContactLaw, Direction, Kinematics, Owner, Remembered, Scene,
};
use crate::kkt::Island;
use crate::math::{HashMap, Vec2, from_rapier, to_rapier};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::Block;
use shown::Shown;

/// What the hooks said of the contacts of the flexible stage.
#[derive(Debug, Default)]
pub(crate) struct HookBook {
    pub(super) last: HashMap<ContactKey, u32>,
    next: HashMap<ContactKey, u32>,
    /// Pairs the hooks were asked about: whether they left any contact.
    pub(super) left: HashMap<PairName, bool>,
    seen: Vec<Seen>,
    unseen: Vec<Candidate>,
    /// How near the point of a candidate gets to any part (m).
    nearest: HashMap<(Owner, u32), f64>,
    /// The laws of a pair of which the hooks left every contact where it was, each with its place (m), for points of the first of the pair.
    pub(super) laws: Vec<(Vec2, ContactLaw)>,
    /// Whether the hooks have moved a contact of the pair, or turned it.
    moves: bool,
}

/// A candidate with what is shown of it.
#[derive(Clone, Copy, Debug)]
struct Seen {
    candidate: Candidate,
    kinematics: Kinematics,
    /// The gap when the step begins (m), and by how much the bodies reach farther behind its face than it does.
    gap: f64,
    reaches: f64,
}

/// A pair of colliders whose contacts the user may modify.
#[derive(Clone, Copy, Debug)]
pub(super) struct HookedPair {
    /// The colliders.
    pub colliders: [ColliderHandle; 2],
    /// Their names in contact keys.
    pub owners: [Owner; 2],
}

impl HookBook {
    /// Begins a step.
    pub fn begin(&mut self) {
        self.next.clear();
        self.left.clear();
    }

    /// Makes the user data of this step that of the last.
    pub fn turn_over(&mut self) {
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
    }

    /// Whether a collider of a pair wants its contacts shown.
    pub(super) fn asks(colliders: [ColliderHandle; 2], sets: &RapierSets<'_>) -> bool {
        let hooks = colliders.map(|handle| sets.colliders.get(handle).map(Collider::active_hooks));
        let wants = |hooks: ActiveHooks| hooks.contains(ActiveHooks::MODIFY_SOLVER_CONTACTS);
        hooks.into_iter().flatten().any(wants)
    }

    /// Asks the user's hook about the candidates of a pair, those from the `first` on, if a collider wants it. Returns whether it has kept, where they were, all
    /// that may be met in the step: then [`laws`](Self::laws) says all that it has changed.
    ///
    /// # Errors
    /// If the hook leaves numbers that are not finite.
    pub(super) fn modify(
        &mut self,
        pair: HookedPair,
        first: usize,
        (sets, dt): (&RapierSets<'_>, f64),
        island: &mut Island,
    ) -> Result<bool, GatherError> {
        if !Self::asks(pair.colliders, sets) {
            return Ok(false);
        }
        let is_flexible = |owner: &Owner| matches!(owner, Owner::Flex(_));
        let inherits = pair.owners.iter().any(is_flexible);
        self.look_at((first, inherits), island);
        let seen = std::mem::take(&mut self.seen);
        self.laws.clear();
        self.moves = false;
        let of_pair = self.of_pair(pair);
        let (mut opens, mut fault) = (false, None);
        let mut nearest: Option<(f64, Option<ContactLaw>)> = None;
        for one in &seen {
            let known = match inherits {
                true => self.known(one, &seen).unwrap_or(of_pair),
                false => self.last.get(&one.candidate.key).copied().unwrap_or(0),
            };
            let law = match self.ask(pair, one, known, (sets, dt)) {
                Ok(law) => law,
                Err(error) => {
                    fault = Some(error);
                    break;
                }
            };
            if nearest.is_none_or(|(least, _)| one.gap < least) {
                nearest = Some((one.gap, law));
            }
            if let Some(law) = law {
                self.note_law(pair, one, law);
                let candidate = one.candidate;
                island.candidates.push(Candidate { law, ..candidate });
            } else {
                // What would not be met in this step may be held off in it as well.
                opens |= one.gap.min(one.kinematics.gap) <= 0.0;
            }
        }
        self.seen = seen;
        if let Some(error) = fault {
            return Err(error);
        }
        // What the nearest one is let through, the others are that were not shown.
        let is_open = nearest.is_some_and(|(_, law)| law.is_none());
        if !is_open {
            self.keep_unseen(nearest.and_then(|(_, law)| law), island);
        }
        let [one, other] = pair.colliders;
        let is_left = island.candidates.len() > first;
        self.left.insert(pair_name(one, other), is_left);
        Ok(!self.laws.is_empty() && !opens && !self.moves)
    }

    /// Notes the law of a contact by its place.
    fn note_law(&mut self, pair: HookedPair, seen: &Seen, law: ContactLaw) {
        self.moves |= law.direction.is_some() || law.skin != seen.candidate.law.skin;
        let owns_first = seen.candidate.key.contactor == pair.owners[0];
        let carried = if owns_first {
            law.carried
        } else {
            -law.carried
        };
        let law = ContactLaw { carried, ..law };
        self.laws.push((seen.kinematics.position, law));
    }

    /// Takes the candidates of a pair, those from the `first` on, out of the island, with what can be shown of them: of every point the nearest part alone, if
    /// a body of the pair is flexible. The others would be met at their ends, which lie within the surface, from any side.
    fn look_at(&mut self, (first, by_point): (usize, bool), island: &mut Island) {
        self.seen.clear();
        self.unseen.clear();
        let scene = Scene {
            blocks: &island.blocks,
            parts: &island.parts,
            segments: &island.segments,
        };
        for candidate in &island.candidates[first..] {
            let Some(kinematics) = candidate.evaluate(&scene, &Remembered::default()) else {
                self.unseen.push(*candidate);
                continue;
            };
            let moved = kinematics.relative(scene.blocks, |block, grip| block.displacement(grip));
            self.seen.push(Seen {
                candidate: *candidate,
                kinematics,
                gap: kinematics.gap - kinematics.normal.dot(&moved),
                reaches: reaches(&island.blocks, &kinematics),
            });
        }
        island.candidates.truncate(first);
        if !by_point {
            return;
        }
        self.nearest.clear();
        let point = |seen: &Seen| (seen.candidate.key.contactor, seen.candidate.key.point);
        for seen in &self.seen {
            let least = self.nearest.entry(point(seen)).or_insert(f64::INFINITY);
            *least = least.min(seen.gap);
        }
        let (nearest, unseen) = (&self.nearest, &mut self.unseen);
        self.seen.retain(|seen| {
            let is_nearest = nearest.get(&point(seen)) == Some(&seen.gap);
            if !is_nearest {
                unseen.push(seen.candidate);
            }
            is_nearest
        });
    }

    /// The user data that the first candidate of a pair had in the last step, or zero.
    fn of_pair(&self, pair: HookedPair) -> u32 {
        let [one, other] = pair.owners;
        let of_pair = |key: &ContactKey| {
            let owners = [key.contactor, key.target];
            owners == [one, other] || owners == [other, one]
        };
        let known = self.last.iter().filter(|(key, _)| of_pair(key));
        let first = known.min_by_key(|(key, _)| **key);
        first.map_or(0, |(_, known)| *known)
    }

    /// The user data that a candidate begins the step with: its own, or of a flexible body those of the nearest one that has some, if there is one of those
    /// that face the same way. Corners of rigid shapes that are far off know nothing of it.
    fn known(&self, one: &Seen, seen: &[Seen]) -> Option<u32> {
        if let Some(own) = self.last.get(&one.candidate.key) {
            return Some(*own);
        }
        let others = seen.iter().filter_map(|other| {
            let known = self.last.get(&other.candidate.key)?;
            let way = other.kinematics.position - one.kinematics.position;
            let turned = other.kinematics.normal.dot(&one.kinematics.normal) < 0.5;
            Some((turned, way.norm_squared(), *known))
        });
        let nearest = others.reduce(|a, b| if (b.0, b.1) < (a.0, a.1) { b } else { a });
        nearest.map(|(_, _, known)| known)
    }

    /// Keeps what faces away now and may turn up within the step: under the law of the nearest contact that was shown.
    fn keep_unseen(&mut self, nearest: Option<ContactLaw>, island: &mut Island) {
        let unseen = self.unseen.drain(..).map(|candidate| {
            let law = nearest.unwrap_or(candidate.law);
            // The gap along a direction of the user's is that of the contact shown.
            let direction = law.direction.map(|direction| Direction {
                gap: None,
                ..direction
            });
            let law = ContactLaw { direction, ..law };
            Candidate { law, ..candidate }
        });
        island.candidates.extend(unseen);
    }

    /// Shows one candidate to the hook, with the user data that is `known` of it; returns its law if it is kept.
    fn ask(
        &mut self,
        pair: HookedPair,
        seen: &Seen,
        known: u32,
        (sets, dt): (&RapierSets<'_>, f64),
    ) -> Result<Option<ContactLaw>, GatherError> {
        let &Seen {
            candidate,
            kinematics,
            gap,
            reaches,
        } = seen;
        let owns_first = candidate.key.contactor == pair.owners[0];
        let [contactor, target] = if owns_first {
            pair.colliders
        } else {
            [pair.colliders[1], pair.colliders[0]]
        };
        let met = sets.narrow_phase.contact_pair(contactor, target);
        let [first, second] = met.map_or(pair_name(contactor, target), |pair| {
            [pair.collider1, pair.collider2]
        });
        // Rapier's normal points from the first collider to the second, ours from the target to the contactor.
        let sign = if contactor == first { -1.0 } else { 1.0 };
        let given = Shown {
            normal: to_rapier(sign * kinematics.normal),
            friction: candidate.law.friction as Real,
            restitution: candidate.law.restitution as Real,
            gap: gap as Real,
            belt: Vector::ZERO,
            user_data: known,
            is_kept: true,
        };
        if !given.is_finite() {
            // Centres that lie upon each other have no normal yet: nothing to show, and no mistake of the user's.
            return Ok(Some(candidate.law));
        }
        let at = [
            to_rapier(kinematics.position),
            to_rapier(kinematics.position - gap * kinematics.normal),
        ];
        let points = if contactor == first {
            at
        } else {
            [at[1], at[0]]
        };
        let answer = given.asked([first, second], (points, reaches as Real), sets);
        self.next.insert(candidate.key, answer.user_data);
        if !answer.is_kept {
            return Ok(None);
        }
        if !answer.is_finite() {
            return Err(GatherError::Hook([first, second]));
        }
        let mut law = candidate.law;
        if answer.friction != given.friction {
            law.friction = f64::from(answer.friction).max(0.0);
        }
        if answer.restitution != given.restitution {
            law.restitution = f64::from(answer.restitution).max(0.0);
        }
        // Rapier's law is for the velocity of the second collider against the first.
        law.carried = sign * dt * from_rapier(answer.belt);
        let farther = f64::from(answer.gap - given.gap);
        if answer.normal != given.normal {
            law.direction = Some(Direction {
                normal: sign * from_rapier(answer.normal).normalize(),
                gap: Some(gap + farther),
            });
        } else {
            law.skin -= farther;
        }
        Ok(Some(law))
    }
}

/// By how much the flexible bodies of a contact reach farther behind its face than its own points, along its normal, when the step begins (m).
fn reaches(blocks: &[Block], kinematics: &Kinematics) -> f64 {
    let normal = kinematics.normal;
    let (mut reaches, mut own) = (0.0, [None::<(usize, f64)>; 2]);
    for attachment in kinematics.attachments() {
        if let (Block::Flex(_), point) = (&blocks[attachment.block], attachment.grip.point) {
            let place = blocks[attachment.block].start_position(point);
            let side = &mut own[usize::from(attachment.weight < 0.0)];
            let along = side.map_or(0.0, |(_, along)| along);
            let share = attachment.weight * normal.dot(&place);
            *side = Some((attachment.block, along + share));
        }
    }
    for (side, sign) in own.into_iter().zip([1.0, -1.0]) {
        if let Some((block, along)) = side
            && let Block::Flex(block) = &blocks[block]
        {
            let nodes = block.start_positions().chunks_exact(2);
            let nodes = nodes.map(|at| sign * (normal.x * at[0] + normal.y * at[1]));
            reaches += along - nodes.fold(along, f64::min);
        }
    }
    reaches
}
