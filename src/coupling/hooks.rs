//! Hooks: what the user's hooks say of contacts that the flexible stage solves.
//!
//! Rapier asks the hooks about its own manifolds, in two steps of which the second shows locked bodies at velocities that
//! are none. For pairs of the flexible stage they are asked here, before anything is locked: every candidate is shown as
//! a manifold of one point, whose `user_data` lasts as long as the candidate does. Rapier is given the answers.

use super::claim::Claims;
use super::pair_name::{PairName, pair_name};
use super::reading::GatherError;
use super::sets::RapierSets;
use crate::constraint::contact::{
    Candidate, ContactKey, ContactLaw, Direction, Kinematics, Owner, Remembered, Scene,
};
use crate::kkt::Island;
use crate::math::{HashMap, from_rapier, to_rapier};
use crate::rapier::math::Real;
use crate::rapier::parry::shape::PackedFeatureId;
use crate::rapier::prelude::*;

/// What the hooks said of the contacts of the flexible stage.
#[derive(Debug, Default)]
pub(crate) struct HookBook {
    pub(super) last: HashMap<ContactKey, u32>,
    next: HashMap<ContactKey, u32>,
    /// Pairs the hooks were asked about: whether they left any contact.
    pub(super) left: HashMap<PairName, bool>,
    unseen: Vec<Candidate>,
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

    /// Asks the user's hook about the candidates of a pair, those from the `first` on, if a collider wants it.
    ///
    /// # Errors
    /// If the hook leaves numbers that are not finite.
    pub(super) fn modify(
        &mut self,
        pair: HookedPair,
        first: usize,
        (sets, dt): (&RapierSets<'_>, f64),
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let [one, other] = pair.colliders.map(|handle| sets.colliders.get(handle));
        let (Some(one), Some(other)) = (one, other) else {
            return Ok(());
        };
        let hooks = one.active_hooks() | other.active_hooks();
        if !hooks.contains(ActiveHooks::MODIFY_SOLVER_CONTACTS) {
            return Ok(());
        }
        let mut kept = first;
        self.unseen.clear();
        let mut removes = false;
        let mut nearest: Option<(f64, ContactLaw)> = None;
        for index in first..island.candidates.len() {
            let mut candidate = island.candidates[index];
            let scene = Scene {
                blocks: &island.blocks,
                parts: &island.parts,
                segments: &island.segments,
            };
            let Some(kinematics) = candidate.evaluate(&scene, &Remembered::default()) else {
                self.unseen.push(candidate);
                continue;
            };
            let moved = kinematics.relative(scene.blocks, |block, grip| block.displacement(grip));
            let gap = kinematics.gap - kinematics.normal.dot(&moved);
            if self.ask(pair, &mut candidate, &kinematics, gap, (sets, dt))? {
                island.candidates[kept] = candidate;
                kept += 1;
                if nearest.is_none_or(|(least, _)| gap < least) {
                    nearest = Some((gap, candidate.law));
                }
            } else {
                removes = true;
            }
        }
        island.candidates.truncate(kept);
        if !removes {
            self.keep_unseen(nearest.map(|(_, law)| law), island);
        }
        let [one, other] = pair.colliders;
        let is_left = island.candidates.len() > first;
        self.left.insert(pair_name(one, other), is_left);
        Ok(())
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

    /// Shows one candidate to the hook; returns whether it is kept.
    fn ask(
        &mut self,
        pair: HookedPair,
        candidate: &mut Candidate,
        kinematics: &Kinematics,
        gap: f64,
        (sets, dt): (&RapierSets<'_>, f64),
    ) -> Result<bool, GatherError> {
        let owns_first = candidate.key.contactor == pair.owners[0];
        let [contactor, target] = if owns_first {
            pair.colliders
        } else {
            [pair.colliders[1], pair.colliders[0]]
        };
        let known = sets.narrow_phase.contact_pair(contactor, target);
        let [first, second] = known.map_or(pair_name(contactor, target), |pair| {
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
            user_data: self.last.get(&candidate.key).copied().unwrap_or(0),
            is_kept: true,
        };
        if !given.is_finite() {
            // Centres that lie upon each other have no normal yet: nothing to show, and no mistake of the user's.
            return Ok(true);
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
        let answer = given.asked([first, second], points, sets);
        self.next.insert(candidate.key, answer.user_data);
        if !answer.is_kept {
            return Ok(false);
        }
        if !answer.is_finite() {
            return Err(GatherError::Hook([first, second]));
        }
        let law = &mut candidate.law;
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
        Ok(true)
    }
}

/// A contact as the hook sees it and leaves it.
#[derive(Clone, Copy, Debug)]
struct Shown {
    normal: Vector,
    friction: Real,
    restitution: Real,
    gap: Real,
    /// The velocity along the contact that friction leads to (m/s).
    belt: Vector,
    user_data: u32,
    is_kept: bool,
}

impl Shown {
    /// What the user's hook makes of it.
    fn asked(
        self,
        [collider1, collider2]: [ColliderHandle; 2],
        [anchor1, anchor2]: [Vector; 2],
        sets: &RapierSets<'_>,
    ) -> Self {
        let mut answer = self;
        let parent = |handle| sets.colliders.get(handle).and_then(Collider::parent);
        let pose = |handle| {
            sets.colliders
                .get(handle)
                .map(|collider| *collider.position())
        };
        let (pose1, pose2) = (
            pose(collider1).unwrap_or_default(),
            pose(collider2).unwrap_or_default(),
        );
        let mut manifold = ContactManifold::with_data(0, 0, ContactManifoldData::default());
        manifold.local_n1 = pose1.rotation.inverse() * self.normal;
        manifold.local_n2 = pose2.rotation.inverse() * -self.normal;
        manifold.data.normal = self.normal;
        manifold.data.rigid_body1 = parent(collider1);
        manifold.data.rigid_body2 = parent(collider2);
        manifold.data.friction = self.friction;
        manifold.data.restitution = self.restitution;
        manifold.data.user_data = self.user_data;
        manifold.points.push(Contact::new(
            pose1.inverse_transform_point(anchor1),
            pose2.inverse_transform_point(anchor2),
            PackedFeatureId::UNKNOWN,
            PackedFeatureId::UNKNOWN,
            self.gap,
        ));
        let mut solver_contacts = SolverContacts::new();
        solver_contacts.push(SolverContact {
            anchor1,
            anchor2,
            dist: self.gap,
            tangent_velocity: self.belt,
            contact_id: [0],
        });
        sets.hooks
            .modify_solver_contacts(&mut ContactModificationContext {
                bodies: sets.bodies,
                colliders: sets.colliders,
                collider1,
                collider2,
                rigid_body1: parent(collider1),
                rigid_body2: parent(collider2),
                contacts: ModifiableContacts::Rigid(ModifiableManifold {
                    manifold: &manifold,
                    solver_contacts: &mut solver_contacts,
                    normal: &mut answer.normal,
                    friction: &mut answer.friction,
                    restitution: &mut answer.restitution,
                    user_data: &mut answer.user_data,
                }),
            });
        answer.is_kept = !solver_contacts.is_empty();
        if let Some(contact) = solver_contacts.first() {
            (answer.gap, answer.belt) = (contact.dist, contact.tangent_velocity);
        }
        answer
    }

    fn is_finite(&self) -> bool {
        let numbers = [self.friction, self.restitution, self.gap];
        numbers.iter().all(|number| number.is_finite())
            && self.normal.is_finite()
            && self.belt.is_finite()
            && self.normal.length() > 0.0
    }
}

/// The hooks that rapier is given in place of the user's.
pub(crate) struct HookGate<'a> {
    /// The user's.
    pub user: &'a dyn PhysicsHooks,
    /// What they said of our contacts.
    pub book: &'a HookBook,
    /// Carriers and claimed bodies.
    pub claims: &'a Claims,
    /// Whether this is the full step, in which claimed bodies are locked.
    pub is_full: bool,
}

impl HookGate<'_> {
    /// Whether the flexible stage asks the user itself.
    fn is_ours(&self, handles: [ColliderHandle; 2], colliders: &ColliderSet) -> bool {
        handles.iter().any(|&handle| {
            self.claims.flex.is_surface(handle)
                || (self.is_full && self.claims.has_collider(handle, colliders))
        })
    }
}

impl PhysicsHooks for HookGate<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let [one, other] = [context.collider1, context.collider2];
        let name = pair_name(one, other);
        let answered = self.claims.answer(name);
        match answered.filter(|_| self.is_full) {
            Some(answer) => answer,
            None => self.user.filter_contact_pair(context),
        }
    }

    fn filter_intersection_pair(&self, context: &PairFilterContext) -> bool {
        self.user.filter_intersection_pair(context)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let handles = [context.collider1, context.collider2];
        if !self.is_ours(handles, context.colliders) {
            return self.user.modify_solver_contacts(context);
        }
        let [one, other] = handles;
        let is_left = self.book.left.get(&pair_name(one, other));
        if let (Some(rigid), false) = (context.rigid_mut(), is_left.copied().unwrap_or(false)) {
            // What touches nothing must not start a collision.
            rigid.solver_contacts.clear();
        }
    }
}
