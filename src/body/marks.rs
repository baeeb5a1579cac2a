//! What steps note of a body beside its motion.

use super::flex_body::FlexBody;

impl FlexBody {
    /// Whether no step has been taken with the body.
    pub(crate) fn is_new(&self) -> bool {
        self.is_new
    }

    /// Notes that a step has been taken with it.
    pub(crate) fn greet(&mut self) {
        self.is_new = false;
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

    /// Counts a step, as finished or not.
    pub(crate) fn count_step(&mut self, is_unfinished: bool) {
        self.n_unfinished = match is_unfinished {
            true => self.n_unfinished.saturating_add(1),
            false => 0,
        };
    }
}
