//! What a step takes from a body and leaves on it: its loads, its motion, put back if it is only tried, and notes.

use super::flex_body::FlexBody;
use super::kept_force::KeptForce;
use super::state::FlexState;
use super::stillness::{Rest, unbalance};
use crate::math::Vec2;
use crate::rapier::prelude::{ColliderHandle, RigidBodyHandle};
use std::borrow::Cow;

/// What a step changes of a body.
#[derive(Clone, Debug)]
pub(crate) struct KeptMotion {
    state: FlexState,
    is_started: bool,
    contact_force: Vec<f64>,
    reaction: Vec<f64>,
    energy_reserve: f64,
    kept_forces: Vec<KeptForce>,
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
            kept_forces: self.kept_forces.clone(),
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
            kept_forces,
        } = kept;
        self.state = state;
        self.is_started = is_started;
        self.contact_force = contact_force;
        self.reaction = reaction;
        self.energy_reserve = energy_reserve;
        self.kept_forces = kept_forces;
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

    /// Contact forces on driven bodies that act on in the next step.
    pub(crate) fn kept_forces(&self) -> &[KeptForce] {
        &self.kept_forces
    }

    /// Keeps what a step has left on driven bodies of the forces of the body at this index, among those of others.
    pub(crate) fn keep_forces(&mut self, index: u32, all: &[(u32, KeptForce)]) {
        let own = all.iter().filter(|(flex, _)| *flex == index);
        self.kept_forces.clear();
        self.kept_forces.extend(own.map(|(_, kept)| *kept));
    }

    pub(crate) fn n_unfinished(&self) -> u32 {
        self.n_unfinished
    }

    /// How long it has stayed where it is (s).
    pub(crate) fn time_still(&self) -> f64 {
        self.stillness.time()
    }

    /// Looks whether it has stayed where it is in a step, in equilibrium.
    pub(crate) fn look_whether_still(&mut self, rest: Rest) {
        let state = &self.state;
        self.stillness
            .look([&state.position, &state.velocity], rest);
    }

    /// Acceleration that is at most left of its loads at rest: of gravity, and of the forces on nodes, which press it though they may cancel (m/s²).
    pub(crate) fn unbalance_at_rest(&self, gravity: Vec2) -> f64 {
        let own = self.gravity_scale * gravity + self.body_force;
        let forces = [&self.contact_force, &self.nodal_force].map(|dofs| {
            let nodes = dofs.chunks_exact(2);
            nodes
                .map(|f| (f[0] * f[0] + f[1] * f[1]).sqrt())
                .sum::<f64>()
        });
        unbalance(own.norm() + forces.iter().sum::<f64>() / self.mass())
    }

    /// Counts a step, as finished or not.
    pub(crate) fn count_step(&mut self, is_unfinished: bool) {
        self.n_unfinished = match is_unfinished {
            true => self.n_unfinished.saturating_add(1),
            false => 0,
        };
    }

    pub(crate) fn bind(&mut self, carrier: RigidBodyHandle, collider: ColliderHandle) {
        self.carrier = carrier;
        self.collider = collider;
    }

    pub(crate) fn set_quarantined(&mut self, is_quarantined: bool) {
        self.is_quarantined = is_quarantined;
        self.is_disturbed = true;
        // What it was struck with may be what it is sick of.
        self.nodal_impulse.fill(0.0);
    }

    /// Takes what motion is left when the body falls asleep.
    pub(crate) fn stop(&mut self) {
        self.state.stop();
    }

    /// Forces on nodes in a step of length `dt` (s), what strikes them in it included, interleaved (N).
    pub(crate) fn forces_over(&self, dt: f64) -> Cow<'_, [f64]> {
        if self.nodal_impulse.iter().all(|impulse| *impulse == 0.0) {
            return Cow::Borrowed(&self.nodal_force);
        }
        let pairs = self.nodal_force.iter().zip(&self.nodal_impulse);
        pairs.map(|(force, impulse)| force + impulse / dt).collect()
    }

    pub(crate) fn prescribed(&self) -> &[f64] {
        &self.prescribed
    }

    /// The motion, to commit a step to it; from then on the body is started.
    pub(crate) fn state_mut(&mut self) -> &mut FlexState {
        self.is_started = true;
        &mut self.state
    }

    pub(crate) fn is_started(&self) -> bool {
        self.is_started
    }

    /// Lets the first step give the body its initial accelerations, from its nodal forces and prescribed displacements.
    /// `give` returns whether it could. They last if the step is committed: one that fails starts the body anew.
    pub(crate) fn start_with(
        &mut self,
        give: impl FnOnce(&mut FlexState, &[f64], &[f64], &[f64]) -> bool,
    ) {
        if !give(
            &mut self.state,
            &self.nodal_force,
            &self.prescribed,
            &self.reaction,
        ) || !self.state.has_finite_accelerations()
        {
            self.state.clear_accelerations();
        }
    }

    /// Takes back what [`FlexBody::start_with`] gave, if no step has been committed since.
    pub(crate) fn forget_start(&mut self) {
        if !self.is_started {
            self.state.clear_accelerations();
        }
    }

    pub(crate) fn contact_forces(&self) -> &[f64] {
        &self.contact_force
    }

    pub(crate) fn contact_force_mut(&mut self) -> &mut [f64] {
        &mut self.contact_force
    }

    pub(crate) fn reactions(&self) -> &[f64] {
        &self.reaction
    }

    /// Makes the reactions of the last part of a step those of all of it: `sums` of the parts before, and the last one's share of the step (-).
    pub(crate) fn average_reactions(&mut self, sums: &[f64], last: f64) {
        if !self.is_fixed.contains(&true) {
            return;
        }
        let push = &mut self.state.pin_push;
        push.resize(sums.len(), 0.0);
        for ((told, push), sum) in self.reaction.iter_mut().zip(push).zip(sums) {
            let mean = sum + last * *told;
            // The next step begins with the forces at the end of this one.
            *push += mean - *told;
            *told = mean;
        }
    }

    pub(crate) fn reaction_mut(&mut self) -> &mut [f64] {
        &mut self.reaction
    }
}
