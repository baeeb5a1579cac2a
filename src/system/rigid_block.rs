//! A rigid body as a block: `[x, y, θ]` of the centre of mass, `A = b2 M + b1 C` with constant diagonal `M` and `C`.

mod response;
mod restart;

use super::rigid_load::RigidLoad;
use super::rigid_motion::RigidMotion;
use super::step::Step;
use crate::integrator::Weights;
use crate::math::{Vec2, perp};

/// A rigid body of an island: free (dynamic) or prescribed (fixed and kinematic).
#[derive(Clone, Debug)]
pub struct RigidBlock {
    /// Whether its motion is given, and it answers nothing.
    is_prescribed: bool,
    pub(super) start: RigidMotion,
    pub(super) current: RigidMotion,
    free: RigidMotion,
    /// Acceleration without hard contact forces, `[a_x, a_y, α]`, at the beginning and at the end of the step.
    pub smooth_start: [f64; 3],
    /// See [`RigidBlock::smooth_start`].
    pub smooth_end: [f64; 3],
    /// What [`RigidBlock::smooth_end`] is without contact.
    smooth_free: [f64; 3],
    inverse_mass: [f64; 3],
    pub(super) mass: [f64; 3],
    inverse_effective: [f64; 3],
    pub(super) force: [f64; 3],
    weights: Weights,
    /// How long damping at the end of the step acts (s).
    slowing: f64,
    pub(super) dt: f64,
    /// Stiffness against turning within the step (N m/rad), and the free angle and inverse inertia without it.
    twist: f64,
    untwisted: [f64; 2],
    /// The end velocity that damping was reckoned with (m/s, m/s, rad/s).
    damped_velocity: [f64; 3],
}

impl RigidBlock {
    /// A body whose motion over the step is given.
    pub fn prescribed(start: RigidMotion, end: RigidMotion) -> Self {
        Self {
            is_prescribed: true,
            start,
            current: start,
            free: end,
            smooth_start: [0.0; 3],
            smooth_end: [0.0; 3],
            smooth_free: [0.0; 3],
            inverse_mass: [0.0; 3],
            mass: [0.0; 3],
            inverse_effective: [0.0; 3],
            force: [0.0; 3],
            weights: Weights::default(),
            slowing: 0.0,
            dt: 0.0,
            twist: 0.0,
            untwisted: [0.0; 2],
            damped_velocity: [0.0; 3],
        }
    }

    /// A body free to move under `load`; `acceleration` is its smooth acceleration at the beginning, if it was
    /// claimed in the last step too.
    pub fn free(
        start: RigidMotion,
        acceleration: Option<[f64; 3]>,
        load: &RigidLoad,
        step: &Step,
    ) -> Self {
        let Step {
            dt, weights, own, ..
        } = *step;
        let dofs_v = [start.velocity.x, start.velocity.y, start.spin];
        let drag_free = std::array::from_fn(|i| {
            load.inverse_mass[i] * load.force[i] - load.damping[i] * dofs_v[i]
        });
        let smooth_start = acceleration.unwrap_or(drag_free);
        let mut free = start;
        let mut smooth_end = [0.0; 3];
        let mut inverse_effective = [0.0; 3];
        let dofs_x = [start.centre.x, start.centre.y, start.angle];
        let (mut x, mut v) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let factor = 1.0 / (1.0 + own.b1 * load.damping[i]);
            inverse_effective[i] = load.inverse_mass[i] * factor;
            let q0 = dofs_x[i] + dt * dofs_v[i] + 0.5 * dt * dt * smooth_start[i];
            let q1 = dofs_v[i] + dt * smooth_start[i];
            let increment = factor
                * (load.inverse_mass[i] * load.force[i] - smooth_start[i] - load.damping[i] * q1);
            if load.inverse_mass[i] > 0.0 {
                x[i] = q0 + own.b0 * increment;
                v[i] = q1 + own.b1 * increment;
                smooth_end[i] = smooth_start[i] + increment;
            } else {
                // A locked axis keeps its velocity, as in rapier.
                x[i] = dofs_x[i] + dt * dofs_v[i];
                v[i] = dofs_v[i];
            }
        }
        free.centre = Vec2::new(x[0], x[1]);
        free.angle = x[2];
        free.velocity = Vec2::new(v[0], v[1]);
        free.spin = v[2];
        let mass = load
            .inverse_mass
            .map(|inverse| if inverse > 0.0 { 1.0 / inverse } else { 0.0 });
        Self {
            is_prescribed: false,
            start,
            current: start,
            free,
            smooth_start,
            smooth_end,
            smooth_free: smooth_end,
            inverse_mass: load.inverse_mass,
            mass,
            inverse_effective,
            force: load.force,
            weights,
            slowing: own.b1,
            dt,
            twist: 0.0,
            untwisted: [0.0; 2],
            damped_velocity: v,
        }
    }

    /// Motion at the beginning of the step.
    pub fn start(&self) -> &RigidMotion {
        &self.start
    }

    /// Motion at the current iterate: at the beginning of the step until the first correction.
    pub fn current(&self) -> &RigidMotion {
        &self.current
    }

    /// Where a free body's velocity, or the prescribed motion, takes the body.
    ///
    /// Not the free motion: under a heavy neighbour that misses the neighbour's force, and may be anywhere.
    pub fn drift(&self) -> RigidMotion {
        if self.is_prescribed() {
            return self.free;
        }
        RigidMotion {
            centre: self.start.centre + self.dt * self.start.velocity,
            angle: self.start.angle + self.dt * self.start.spin,
            ..self.start
        }
    }

    /// Where the body may be within the step if nothing holds it: where it begins, where its velocity takes it, and where its load does besides.
    pub fn places(&self) -> [RigidMotion; 3] {
        let drift = self.drift();
        let pull = |i: usize| self.dt * self.dt * self.inverse_mass[i] * self.force[i];
        let pulled = RigidMotion {
            centre: drift.centre + Vec2::new(pull(0), pull(1)),
            ..drift
        };
        [self.start, drift, pulled]
    }

    /// Whether the motion is given.
    pub fn is_prescribed(&self) -> bool {
        self.is_prescribed
    }

    /// Mass in x, y and inertia (kg, kg, kg m²); zero along locked axes and for prescribed bodies.
    pub fn mass(&self) -> [f64; 3] {
        self.mass
    }

    /// Velocity and spin at the current iterate (m/s, rad/s).
    pub fn rates(&self) -> [f64; 3] {
        let RigidMotion { velocity, spin, .. } = self.current;
        [velocity.x, velocity.y, spin]
    }

    /// Velocity at the end of a lever (m/s).
    pub fn velocity(&self, lever: Vec2) -> Vec2 {
        self.current.velocity + self.current.spin * perp(lever)
    }

    /// See [`super::Block::smooth_acceleration`]; the centripetal part is left out, as in `G a`.
    pub fn smooth_acceleration(&self, lever: Vec2) -> Vec2 {
        Vec2::new(self.smooth_end[0], self.smooth_end[1]) + self.smooth_end[2] * perp(lever)
    }

    /// What a multiplier is weighed with in positions (s²). With β0 = 0 it is an impulse at the forward increment.
    fn position_weight(&self) -> f64 {
        match self.weights.b0 > 0.0 {
            true => self.weights.b0,
            false => self.dt * self.dt,
        }
    }

    /// Moves the iterate away from the free motion by what a wrench does.
    pub fn set_position_increment(&mut self, wrench: [f64; 3]) {
        let b0 = self.position_weight();
        let moved = self.answer(wrench).map(|way| b0 * way);
        self.current = self.free;
        self.current.shift(moved);
    }

    /// What forces of position have moved the iterate by, from the free motion (m, m, rad).
    pub fn pushed(&self) -> [f64; 3] {
        let shift = self.current.centre - self.free.centre;
        [shift.x, shift.y, self.current.angle - self.free.angle]
    }

    /// Ends the step where the free motion leads with impulses that have acted for some time: the sum of their products (N s², N m s²).
    pub fn let_go_on(&mut self, moments: [f64; 3]) {
        let moved = self.answer(moments);
        let end = self.current;
        self.current = self.free;
        self.current.shift(moved);
        (self.current.velocity, self.current.spin) = (end.velocity, end.spin);
    }

    /// Motion of the centre and turn over the step (m, m, rad).
    pub fn moved(&self) -> [f64; 3] {
        let shift = self.current.centre - self.start.centre;
        [shift.x, shift.y, self.current.angle - self.start.angle]
    }

    /// The part of that along what no force of an island moves (m, m, rad): all of a driven body, and of another one its locked axes, along which it keeps the
    /// velocity that it has.
    pub fn led(&self) -> [f64; 3] {
        let (moves, moved) = (self.moves_along(), self.moved());
        [0, 1, 2].map(|axis| if moves[axis] { 0.0 } else { moved[axis] })
    }

    /// Whether it goes anywhere by that.
    pub fn is_led(&self) -> bool {
        self.is_prescribed || self.led() != [0.0; 3]
    }

    /// Displacement of the end of a lever over the step, linear in the dofs (m).
    pub fn displacement(&self, lever: Vec2) -> Vec2 {
        let turned = self.current.angle - self.start.angle;
        self.current.centre - self.start.centre + turned * perp(lever)
    }

    /// Sets velocity and smooth acceleration for the part of the contact forces that acts as (C.5) says.
    pub fn set_soft_force(&mut self, wrench: [f64; 3]) {
        let change = self.answer(wrench);
        let b1 = self.weights.b1;
        let lasts = self.weights != Weights::within(self.dt);
        self.current.velocity = self.free.velocity + b1 * Vec2::new(change[0], change[1]);
        self.current.spin = self.free.spin + b1 * change[2];
        if lasts {
            for (sum, change) in self.smooth_end.iter_mut().zip(change) {
                *sum += change;
            }
            self.damped_velocity = self.rates();
        }
    }

    /// Lets damping act on the end velocity as it has become, instead of what it would have been without joints.
    pub fn settle_damping(&mut self) {
        if self.is_prescribed() || self.inverse_effective == self.inverse_mass {
            return;
        }
        for (i, end) in self.rates().into_iter().enumerate() {
            if self.inverse_effective[i] > 0.0 {
                // inverse / effective = 1 + slowing c
                let slowed = self.inverse_mass[i] / self.inverse_effective[i] - 1.0;
                let damping = slowed / self.slowing;
                self.smooth_end[i] -= damping * (end - self.damped_velocity[i]);
            }
        }
    }

    /// Whether no damping acts and no axis is locked.
    pub(super) fn moves_freely(&self) -> bool {
        !self.is_prescribed()
            && self.inverse_effective == self.inverse_mass
            && self.inverse_mass.iter().all(|inverse| *inverse > 0.0)
    }

    /// Applied force and torque, gravity included (N, N, N m).
    pub fn force(&self) -> [f64; 3] {
        self.force
    }

    /// Adds a rigid motion to the end velocity (m/s, rad/s).
    pub(super) fn add_velocity(&mut self, velocity: Vec2, spin: f64) {
        self.current.velocity += velocity;
        self.current.spin += spin;
    }

    /// Adds an impulse (N s, N s, N m s) to the end velocity.
    pub fn add_impulse(&mut self, impulse: [f64; 3]) {
        let [x, y, turn] = self.answer(impulse);
        self.add_velocity(Vec2::new(x, y), turn);
    }

    /// Adds to the smooth end acceleration the response to a wrench.
    pub fn add_smooth_acceleration(&mut self, wrench: [f64; 3]) {
        let change = self.answer(wrench);
        for (sum, change) in self.smooth_end.iter_mut().zip(change) {
            *sum += change;
        }
    }

    /// Acceleration that the applied forces give to the body alone (m/s², rad/s²).
    pub fn drive(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.inverse_mass[i] * self.force[i])
    }

    /// Work of an impulse that acted over the step, at the mean velocity (J).
    pub fn work_of(&self, impulse: [f64; 3]) -> f64 {
        let start = [
            self.start.velocity.x,
            self.start.velocity.y,
            self.start.spin,
        ];
        let means = start
            .iter()
            .zip(self.rates())
            .map(|(v, end)| 0.5 * (v + end));
        means.zip(impulse).map(|(v, p)| v * p).sum()
    }

    /// Work of the applied forces over the step (J); what holds the locked axes takes theirs along these.
    pub fn applied_work(&self) -> f64 {
        let (moves, moved) = (self.moves_along(), self.moved());
        let works = [0, 1, 2].map(|axis| match moves[axis] {
            true => self.force[axis] * moved[axis],
            false => 0.0,
        });
        works.iter().sum()
    }

    /// Kinetic energy that the applied forces would give in the step to the body at rest (J).
    pub fn load_energy(&self) -> f64 {
        let terms = self.force.iter().zip(&self.mass);
        let moving = terms.filter(|(_, mass)| **mass > 0.0);
        moving
            .map(|(force, mass)| 0.5 * (self.dt * force).powi(2) / mass)
            .sum()
    }

    /// See [`super::Block::swing`].
    pub(super) fn swing(&self) -> [f64; 2] {
        [&self.smooth_start, &self.smooth_end].map(|acceleration| {
            let terms = self.mass.iter().zip(acceleration);
            let squared: f64 = terms.map(|(mass, a)| mass * a * a).sum();
            0.125 * self.dt * self.dt * squared
        })
    }

    /// Kinetic energy of a motion of this body (J).
    pub fn kinetic_energy(&self, motion: &RigidMotion) -> f64 {
        0.5 * (self.mass[0] * motion.velocity.x * motion.velocity.x
            + self.mass[1] * motion.velocity.y * motion.velocity.y
            + self.mass[2] * motion.spin * motion.spin)
    }
}
