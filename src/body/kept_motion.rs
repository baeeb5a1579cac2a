//! What a step keeps of a body: its motion, put back if it is only tried, and notes.

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

    /// Whether no step has been taken with the body since it came into the world.
    pub(crate) fn is_new(&self) -> bool {
        self.is_new
    }

    /// Notes that the body is out of the world: when it comes back, others may be where it is.
    pub(crate) fn be_new(&mut self) {
        self.is_new = true;
    }

    /// Notes that a step has been taken with it, which what struck it was for.
    pub(crate) fn greet(&mut self) {
        self.is_new = false;
        self.n_idle_pins = 0;
        self.nodal_impulse.fill(0.0);
    }

    /// How many calls of `pin_where` chose no node.
    pub(crate) fn n_idle_pins(&self) -> usize {
        self.n_idle_pins
    }

    /// Whether the user has changed something since the last step.
    pub(crate) fn is_disturbed(&self) -> bool {
        self.is_disturbed
    }

    pub(crate) fn clear_disturbance(&mut self) {
        self.is_disturbed = false;
    }

    pub(crate) fn energy_reserve(&self) -> f64 {
        self.energy_reserve
    }

    pub(crate) fn set_energy_reserve(&mut self, reserve: f64) {
        self.energy_reserve = reserve;
    }

    pub(crate) fn n_unfinished(&self) -> u32 {
        self.n_unfinished
    }

    /// How long it has stayed where it is (s).
    pub(crate) fn time_still(&self) -> f64 {
        self.stillness.time()
    }

    /// Looks whether it has stayed where it is in a step, to some tolerance (s, m).
    pub(crate) fn look_whether_still(&mut self, dt: f64, tolerance: f64) {
        let state = &self.state;
        self.stillness
            .look([&state.position, &state.velocity], dt, tolerance);
    }

    /// Counts a step, as finished or not.
    pub(crate) fn count_step(&mut self, is_unfinished: bool) {
        self.n_unfinished = match is_unfinished {
            true => self.n_unfinished.saturating_add(1),
            false => 0,
        };
    }
}
