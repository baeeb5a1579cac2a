//! What a snapshot writes of the border with rapier: whatever the next step, or the next event, depends on. All else is found anew
//! in every step.

use super::changes::Changes;
use super::claim::Claims;
use super::events::EventBook;
use super::filter::Answers;
use super::hooks::HookBook;
use super::joint_changes::{KnownJoints, NotedJoint};
use super::masters::Master;
use super::members::Members;
use super::memory::Memory;
use super::pair_name::PairName;
use super::pool::FlexPool;
use super::references::References;
use super::roster::Roster;
use super::sleep::Sleeper;
use crate::body::FlexBodySet;
use crate::constraint::contact::{ContactKey, ContactMemory};
use crate::constraint::joint::JointMemory;
use crate::math::HashMap;
use crate::rapier::prelude::*;
use crate::system::ExplicitRecord;
use serde::{Deserialize, Serialize};
use std::sync::PoisonError;

/// Handles as numbers, to sort by.
trait Numbered: Copy {
    fn number(self) -> [u32; 4];
}

impl Numbered for ColliderHandle {
    fn number(self) -> [u32; 4] {
        let (index, generation) = self.into_raw_parts();
        [index, generation, 0, 0]
    }
}

impl Numbered for RigidBodyHandle {
    fn number(self) -> [u32; 4] {
        let (index, generation) = self.into_raw_parts();
        [index, generation, 0, 0]
    }
}

impl Numbered for PairName {
    fn number(self) -> [u32; 4] {
        let [one, other] = self.map(ColliderHandle::into_raw_parts);
        [one.0, one.1, other.0, other.1]
    }
}

/// The entries of a map in the order of their handles.
fn listed<K: Numbered, V: Clone>(map: &HashMap<K, V>) -> Vec<(K, V)> {
    let all = map.iter().map(|(key, value)| (*key, value.clone()));
    let mut all: Vec<(K, V)> = all.collect();
    all.sort_unstable_by_key(|(key, _)| key.number());
    all
}

/// The claim of the last step, as far as events and hooks ask for it in a step without a claim.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct ClaimRecord {
    surfaces: Vec<(ColliderHandle, usize)>,
    claimed: Vec<(RigidBodyHandle, usize)>,
    asleep: Vec<Sleeper>,
    n_colliders: usize,
    gravity: Vector,
    joints: Vec<NotedJoint>,
    answers: Vec<(PairName, Option<u32>)>,
}

impl ClaimRecord {
    fn of(claims: &Claims) -> Self {
        let answers = listed(claims.walk.answers.all()).into_iter();
        let (n_colliders, gravity) = claims.changes.noted();
        Self {
            surfaces: listed(claims.flex.slots()),
            claimed: listed(claims.walk.members.places()),
            asleep: claims.flex.asleep().to_vec(),
            n_colliders,
            gravity,
            joints: claims.changes.joints.noted().to_vec(),
            answers: answers
                .map(|(name, answer)| (name, answer.map(|flags| flags.bits())))
                .collect(),
        }
    }

    fn build(self) -> Claims {
        let answers = self.answers.into_iter();
        let answers = answers.map(|(name, bits)| (name, bits.map(SolverFlags::from_bits_truncate)));
        let mut claims = Claims::default();
        claims.flex = Roster::remembered(self.surfaces, self.asleep);
        claims.changes = Changes::since(
            self.n_colliders,
            self.gravity,
            KnownJoints::remembered(self.joints),
        );
        claims.walk.members = Members::remembered(self.claimed);
        claims.walk.answers = Answers::remembered(answers);
        claims
    }
}

/// What the user's handler knows and still has to hear.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct EventRecord {
    ahead: Vec<PairName>,
    held: Vec<EventEntry>,
    left: Vec<EventEntry>,
    pressed: Vec<(PairName, bool)>,
}

impl EventRecord {
    fn of(book: &EventBook) -> Self {
        let heard = book.heard.lock().unwrap_or_else(PoisonError::into_inner);
        let mut ahead: Vec<PairName> = heard.ahead.iter().copied().collect();
        ahead.sort_unstable_by_key(|name| name.number());
        Self {
            ahead,
            held: heard.held.iter().map(entry_of).collect(),
            left: heard.left.iter().map(entry_of).collect(),
            pressed: listed(&book.pressed),
        }
    }

    fn build(self) -> EventBook {
        let mut book = EventBook::default();
        book.pressed = self.pressed.into_iter().collect();
        let mut heard = book.heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.ahead = self.ahead.into_iter().collect();
        heard.held = self.held.into_iter().map(event_of).collect();
        heard.left = self.left.into_iter().map(event_of).collect();
        drop(heard);
        book
    }
}

/// The two colliders, whether they started to touch, and rapier's flags.
type EventEntry = (PairName, bool, u32);

fn entry_of(event: &CollisionEvent) -> EventEntry {
    match *event {
        CollisionEvent::Started(one, other, flags) => ([one, other], true, flags.bits()),
        CollisionEvent::Stopped(one, other, flags) => ([one, other], false, flags.bits()),
    }
}

fn event_of(([one, other], starts, bits): EventEntry) -> CollisionEvent {
    let flags = CollisionEventFlags::from_bits_truncate(bits);
    if starts {
        CollisionEvent::Started(one, other, flags)
    } else {
        CollisionEvent::Stopped(one, other, flags)
    }
}

/// What the user's hooks said.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct HookRecord {
    user_data: Vec<(ContactKey, u32)>,
    left: Vec<(PairName, bool)>,
}

impl HookRecord {
    fn of(book: &HookBook) -> Self {
        let user_data = book.last.iter().map(|(key, data)| (*key, *data));
        let mut user_data: Vec<_> = user_data.collect();
        user_data.sort_unstable();
        Self {
            user_data,
            left: listed(&book.left),
        }
    }

    fn build(self) -> HookBook {
        let mut book = HookBook::default();
        book.last = self.user_data.into_iter().collect();
        book.left = self.left.into_iter().collect();
        book
    }
}

/// The border with rapier as a snapshot writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct CouplingRecord {
    claims: ClaimRecord,
    events: EventRecord,
    hooks: HookRecord,
    masters: Vec<(RigidBodyHandle, Master)>,
    references: References,
    joint_memory: JointMemory,
    explicit: Vec<(u32, ExplicitRecord)>,
}

impl CouplingRecord {
    /// The record of what a pipeline holds.
    pub fn of(claims: &Claims, events: &EventBook, memory: &Memory, pool: &FlexPool) -> Self {
        Self {
            claims: ClaimRecord::of(claims),
            events: EventRecord::of(events),
            hooks: HookRecord::of(&memory.hooks),
            masters: listed(&memory.masters.last),
            references: memory.references.clone(),
            joint_memory: memory.joints.clone(),
            explicit: pool.explicit_records(),
        }
    }

    /// All of it again, `None` if it does not fit the bodies.
    ///
    /// - `contacts`: the memory of contacts, which has a record of its own.
    pub fn build(
        self,
        contacts: ContactMemory,
        flex_bodies: &FlexBodySet,
    ) -> Option<(Claims, EventBook, Memory, FlexPool)> {
        let pool = FlexPool::remembered(self.explicit, flex_bodies)?;
        let mut memory = Memory {
            contacts,
            joints: self.joint_memory,
            references: self.references,
            hooks: self.hooks.build(),
            ..Memory::default()
        };
        memory.contacts.list_owners();
        memory.masters.last = self.masters.into_iter().collect();
        Some((self.claims.build(), self.events.build(), memory, pool))
    }
}
