//! A body's motion kept while a step is tried, and put back.

use super::flex_body::FlexBody;
use super::state::FlexState;

/// What a step changes of a body.
#[derive(Clone, Debug)]
pub(crate) struct KeptMotion {
    state: FlexState,
    is_started: bool,
    contact_force: Vec<f64>,
    reaction: Vec<f64>,
    energy_reserve: f64,
}

impl KeptMotion {
    /// The motion that was kept.
    pub fn state(&self) -> &FlexState {
        &self.state
    }
}

impl FlexBody {
    /// Keeps the body's motion.
    pub(crate) fn keep_motion(&self) -> KeptMotion {
        KeptMotion {
            state: self.state.clone(),
            is_started: self.is_started,
            contact_force: self.contact_force.clone(),
            reaction: self.reaction.clone(),
            energy_reserve: self.energy_reserve,
        }
    }

    /// Puts a kept motion back.
    pub(crate) fn put_back(&mut self, kept: KeptMotion) {
        let KeptMotion {
            state,
            is_started,
            contact_force,
            reaction,
            energy_reserve,
        } = kept;
        self.state = state;
        self.is_started = is_started;
        self.contact_force = contact_force;
        self.reaction = reaction;
        self.energy_reserve = energy_reserve;
    }
}
