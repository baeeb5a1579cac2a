//! A scene whose events are collected as rapier's users do, through channels.

pub use crate::common::*;
pub use foil2d::rapier::math::{Real, Rotation};
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, channel};

/// All kinds of events.
pub const ALL: ActiveEvents = ActiveEvents::all();

/// What rapier's own collector received.
pub struct Listener {
    pub collector: ChannelEventCollector,
    collisions: Receiver<CollisionEvent>,
    forces: Receiver<ContactForceEvent>,
}

impl Default for Listener {
    fn default() -> Self {
        let (send_collision, collisions) = channel();
        let (send_force, forces) = channel();
        // Nobody listens to torn soft bodies.
        let (send_tear, _) = channel();
        let collector = ChannelEventCollector::new(send_collision, send_force, send_tear);
        Self {
            collector,
            collisions,
            forces,
        }
    }
}

impl Listener {
    pub fn collisions(&self) -> Vec<CollisionEvent> {
        self.collisions.try_iter().collect()
    }

    pub fn forces(&self) -> Vec<ContactForceEvent> {
        self.forces.try_iter().collect()
    }
}

/// The events of one step.
pub struct Heard {
    pub collisions: Vec<CollisionEvent>,
    pub forces: Vec<ContactForceEvent>,
}

impl Scene {
    /// One step, with its events.
    pub fn hear(&mut self, listener: &Listener) -> Heard {
        self.hear_with(&(), listener)
    }

    /// One step under the user's hooks, with its events.
    pub fn hear_with(&mut self, hooks: &dyn PhysicsHooks, listener: &Listener) -> Heard {
        self.flex
            .step_with_events(
                &mut self.world,
                &mut self.bodies,
                hooks,
                &listener.collector,
            )
            .expect("the step can be taken");
        Heard {
            collisions: listener.collisions(),
            forces: listener.forces(),
        }
    }
}

/// Two colliders, whichever comes first.
pub fn pair(one: ColliderHandle, other: ColliderHandle) -> [(u32, u32); 2] {
    let mut names = [one.into_raw_parts(), other.into_raw_parts()];
    names.sort_unstable();
    names
}

/// Which pairs touch, by what was heard: every start and stop must change that.
#[derive(Default)]
pub struct Touching {
    pairs: BTreeMap<[(u32, u32); 2], bool>,
    pub n_starts: usize,
    pub n_stops: usize,
}

impl Touching {
    pub fn take(&mut self, events: &[CollisionEvent], context: &str) {
        for event in events {
            let name = pair(event.collider1(), event.collider2());
            let was = self.pairs.insert(name, event.started()).unwrap_or(false);
            assert_ne!(was, event.started(), "{context}: {event:?} again");
            self.n_starts += usize::from(event.started());
            self.n_stops += usize::from(event.stopped());
        }
    }

    pub fn is_touching(&self, name: [(u32, u32); 2]) -> bool {
        self.pairs.get(&name).copied().unwrap_or(false)
    }
}

/// A block of 1 m and 1000 kg that comes to rest within a second.
pub fn block() -> FlexBodyBuilder {
    soft_block(2e-2).active_events(ALL)
}

pub const DT: f64 = 1.0 / 60.0;
