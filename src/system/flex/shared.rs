//! What blocks of all kinds of flexible bodies have, whatever they step by.

use super::answer::Answer;
use super::contact_forces::ContactForces;
use super::impulse::Impulses;
use super::iterate::Iterate;
use super::loads::Loads;
use super::shape::Shape;
use crate::body::{FlexState, FrameMotion};
use crate::math::{Vec2, node_vec, perp, rotation};
use crate::system::step::{FlexLoad, Step};

/// Where a step begins.
#[derive(Clone, Debug)]
pub(super) struct Start {
    /// World positions (m) and velocities (m/s).
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    /// `ü` (m/s²).
    pub acceleration: Vec<f64>,
    pub frame: FrameMotion,
    pub torque: f64,
    /// Angular momentum (N m s).
    pub momentum: f64,
    /// Reactions of the pins (N).
    pub reaction: Vec<f64>,
}

impl Start {
    fn new(n_dofs: usize) -> Self {
        let zeros = || vec![0.0; n_dofs];
        Self {
            position: zeros(),
            velocity: zeros(),
            acceleration: zeros(),
            frame: FrameMotion::default(),
            torque: 0.0,
            momentum: 0.0,
            reaction: zeros(),
        }
    }

    /// Where the velocity and acceleration of a node would take it within `dt` (m).
    pub fn drift(&self, node: usize, dt: f64) -> Vec2 {
        let own = rotation(self.frame.angle) * node_vec(&self.acceleration, node);
        let acceleration = self.frame.acceleration + own;
        let start = node_vec(&self.position, node);
        start + dt * node_vec(&self.velocity, node) + 0.5 * dt * dt * acceleration
    }
}

/// Energies of a step (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Energies {
    /// Kinetic and elastic energy at the beginning.
    pub start: [f64; 2],
    /// Elastic energy at the end, and what plastic flow has dissipated in the step.
    pub elastic: f64,
    pub flow: f64,
    /// Work of the pins in the jumps of their motion.
    pub jump_work: f64,
}

/// The body, its step and its answers.
#[derive(Debug)]
pub(super) struct Shared {
    pub shape: Shape,
    pub step: Step,
    pub start: Start,
    pub loads: Loads,
    pub contact: ContactForces,
    pub now: Iterate,
    pub energy: Energies,
    pub impulses: Impulses,
    pub answer: Answer,
    /// Room for what is solved for, and for what goes into it.
    pub local: Vec<f64>,
    pub scratch: Vec<f64>,
    /// What the pins give in the step for the body to have their velocities (N), see [`FlexState::pin_push`].
    pub pin_push: Vec<f64>,
}

impl Shared {
    pub fn new(shape: Shape, answer: Answer) -> Self {
        let n = shape.n_dofs();
        Self {
            step: Step::default(),
            start: Start::new(n),
            loads: Loads::new(n),
            contact: ContactForces::new(n),
            now: Iterate::new(n),
            energy: Energies::default(),
            impulses: Impulses::new(n),
            local: vec![0.0; n],
            scratch: vec![0.0; n],
            pin_push: Vec::with_capacity(n),
            shape,
            answer,
        }
    }

    /// Takes over the committed state and the loads of a step.
    pub fn begin(&mut self, step: Step, state: &FlexState, load: &FlexLoad<'_>) {
        self.step = step;
        let start = &mut self.start;
        start.position.copy_from_slice(&state.position);
        start.velocity.copy_from_slice(&state.velocity);
        start.acceleration.copy_from_slice(&state.acceleration);
        (start.frame, start.torque) = (state.frame, state.torque);
        for &dof in &self.shape.fixed_dofs {
            let push = state.pin_push.get(dof).copied().unwrap_or(0.0);
            start.reaction[dof] = load.reaction[dof] - push;
        }
        self.pin_push.clear();
        self.energy.jump_work = 0.0;
        self.energy.start = [state.kinetic_energy, state.elastic_energy];
        self.loads.begin(&self.shape, load, state.loads.lag);
    }

    /// Puts held dofs where they are at the end of the step.
    pub fn place_pins(&mut self) {
        for &dof in &self.shape.fixed_dofs {
            let rest = self.shape.model.placed_positions()[dof];
            self.now.position[dof] = rest + self.loads.prescribed[dof];
        }
    }

    /// Size of the coordinates that round-off is relative to (m).
    pub fn extent(&self) -> f64 {
        self.shape.extent.max(self.now.frame.centre.amax())
    }

    /// Kinetic energy of the iterate (J).
    pub fn kinetic_energy(&self) -> f64 {
        self.now.kinetic_energy(&self.shape)
    }

    /// How a node moves as the body turns by the reference arms.
    pub fn turn_arm(&self, node: usize) -> Vec2 {
        perp(self.now.turn * node_vec(&self.shape.arms.reference, node))
    }

    /// Writes over `local` how velocities jump with a rigid motion `j` of the pins within a step, `j - κ A⁻¹ M j`, `κ = 1 + α b1`: by all of it where the
    /// body is stiff, at the pins alone where the step resolves its vibrations. `A j = κ M j`, as rigid motion strains nothing. `scratch` holds `j`.
    pub fn answer_jump(&mut self, kept: f64) {
        self.local.fill(0.0);
        let mass = self.shape.model.mass();
        mass.multiply_add(kept, &self.scratch, &mut self.local);
        self.shape.clear_fixed(&mut self.local);
        self.answer.solve(&mut self.local);
        for (answer, own) in self.local.iter_mut().zip(&self.scratch) {
            *answer = own - *answer;
        }
    }
}
