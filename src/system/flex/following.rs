//! Nodes without mass in an implicit step with stiffness damping: springs and dashpots between a contact and the masses.
//!
//! With `u_s = E u_m + e`, `E = -K_ss⁻¹ K_sm`, the energy falls apart into that of the masses, with the surface in balance, and `½ e·K_ss e`;
//! the power of the damping, `β u̇·K u̇`, into the same parts. The rows of (C.5) become, with `F_s` all forces on the surface,
//!
//! ```text
//! M ü_m + α M u̇_m + K̃ (u_m + β u̇_m) = f_m + Eᵀ F_s,    K̃ = K_mm + K_ms E
//! K_ss (e + β ė) = F_s
//! ```
//!
//! The first is of second order, and Beta-2 advances it. The second is of first order: nothing in it has an acceleration, and its only
//! history is where the surface was. Advanced by Beta-2 as if it had mass, `ė` was a state: after an impact, whose force `β K ė` has no limit
//! where `β` is long, it went on to deform the body when the contact had opened (2.4e6 J stored of 687 J brought). So it is
//! advanced by Euler's backward rule,
//!
//! ```text
//! K_ss (e' + κ (e' - e)) = F_s',    κ = β/dt
//! ```
//!
//! which holds at any `κ` and keeps no rate: `e` alone goes over into the next step, and decays by `κ/(1 + κ)` where nothing presses.
//! As forces act with the mean of a step's ends under the trapezoidal rule, the work on this part, `d = e' - e`, is
//!
//! ```text
//! ½ (F + F')·d = Δ(½ e·K_ss e) + κ/4 |d + d₋|² + Δ(κ/4 |d|²),    |d|² = d·K_ss d,  d₋ of the step before
//! ```
//!
//! so from rest on it never gives more than it was given. `A` and its factor are those of (C.5) as printed; what the stiffness acts on
//! is `w_m = u_m + β u̇_m` and `w_s = E w_m + e' + κ (e' - e)`, and where the surface is follows from `F_s' = (K w)_s`.

use super::massless_surface::MasslessSurface;
use super::shape::Shape;
use super::shared::Shared;
use crate::fe::model::Model;
use crate::integrator::Weights;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, node_vec, set_node_vec};
use crate::system::step::Step;

/// The massless nodes of a body, with the factor of `K_ss`. Those of a damped body follow the masses as above; those of an undamped one
/// balance at the end of the step by (C.5) itself.
#[derive(Debug)]
pub(super) struct FollowingSurface {
    nodes: MasslessSurface,
    factor: BlockCholesky,
    /// `K_ss e` at the beginning of the step, in the frame (N).
    start: Vec<f64>,
    /// `κ`, damping over the step length (-).
    lag: f64,
}

impl FollowingSurface {
    /// Factorizes `K_ss`.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn new(model: &Model, is_fixed: &[bool]) -> Result<Self, CholeskyError> {
        let (nodes, stiffness) = MasslessSurface::new(model, is_fixed);
        let mut factor = BlockCholesky::analyze(&stiffness);
        factor.factorize(&stiffness)?;
        Ok(Self {
            start: vec![0.0; nodes.local.len()],
            lag: 0.0,
            nodes,
            factor,
        })
    }

    /// Begins a step of `dt` (s) where the nodes are displaced by so much in the frame (m).
    pub fn begin(&mut self, model: &Model, displacement: &[f64], dt: f64) {
        self.lag = model.rayleigh().stiffness / dt;
        if !self.follows() {
            return;
        }
        for (slot, &node) in self.nodes.nodes.iter().enumerate() {
            set_node_vec(&mut self.start, slot, spring(model, node, displacement));
        }
    }

    /// Whether the nodes follow the masses by the backward rule: only where there is damping.
    fn follows(&self) -> bool {
        self.lag > 0.0
    }

    /// By how much damping reduces what a force moves within the step, `1 + κ` (-).
    pub fn slowness(&self) -> f64 {
        1.0 + self.lag
    }

    /// Makes [`FollowingSurface::flexibility`] known from `node`.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool]) {
        self.nodes.prepare(node, is_fixed, &mut self.factor);
    }

    /// Displacement of one massless node by a force at another, in the frame, without damping (m/N); zero between others.
    pub fn flexibility(&self, at: usize, from: usize) -> Mat2 {
        self.nodes.flexibility(at, from)
    }

    /// Writes the entries of the massless nodes so that `force`, of a node and what it was at the beginning of the step, balances there, in
    /// the frame.
    fn relax(
        &mut self,
        model: &Model,
        is_fixed: &[bool],
        dofs: &mut [f64],
        force: impl Fn(usize, Vec2) -> Vec2,
    ) {
        for &node in &self.nodes.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !is_fixed[dof] {
                    dofs[dof] = 0.0;
                }
            }
        }
        for (slot, &node) in self.nodes.nodes.iter().enumerate() {
            let start = node_vec(&self.start, slot);
            let mut force = force(node, start) - spring(model, node, dofs);
            for axis in 0..2 {
                if is_fixed[2 * node + axis] {
                    force[axis] = 0.0;
                }
            }
            set_node_vec(&mut self.nodes.local, slot, force);
        }
        self.factor.solve_in_place(&mut self.nodes.local);
        for (slot, &node) in self.nodes.nodes.iter().enumerate() {
            add_node_vec(dofs, node, node_vec(&self.nodes.local, slot));
        }
    }
}

/// `K u` at a node.
fn spring(model: &Model, node: usize, dofs: &[f64]) -> Vec2 {
    let [x, y] = model.stiffness().multiply_node(node, dofs);
    Vec2::new(x, y)
}

/// The nodes without mass of an implicit body of small strain.
#[derive(Debug)]
pub(super) struct Following {
    /// Their dofs, ascending, where the body is damped by stiffness; none elsewhere.
    dofs: Vec<usize>,
    /// What they follow the others by, once factorized.
    surface: Option<FollowingSurface>,
}

impl Following {
    pub fn new(shape: &Shape) -> Self {
        let model = &shape.model;
        let is_damped = model.rayleigh().stiffness > 0.0;
        let follows = |dof: &usize| is_damped && model.is_massless(dof / 2);
        Self {
            dofs: (0..shape.n_dofs()).filter(follows).collect(),
            surface: None,
        }
    }

    /// Factorizes what the nodes follow by, where there are any.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn factorize(&mut self, shape: &Shape) -> Result<(), CholeskyError> {
        if self.surface.is_none() && shape.model.massless_support().next().is_some() {
            self.surface = Some(FollowingSurface::new(&shape.model, &shape.is_fixed)?);
        }
        Ok(())
    }

    /// Begins a step of `dt` (s): nodes that follow have no history but where they are.
    pub fn begin(
        &mut self,
        shape: &Shape,
        displacement: &[f64],
        dt: f64,
        [u, rate]: [&mut [f64]; 2],
    ) {
        for &dof in &self.dofs {
            u[dof] = displacement[dof];
            rate[dof] = 0.0;
        }
        if let Some(surface) = &mut self.surface {
            surface.begin(&shape.model, displacement, dt);
        }
    }

    /// Goes back to where the step began, at `u`.
    pub fn restart(&self, u: &[f64], [displacement, rate]: [&mut [f64]; 2]) {
        for &dof in &self.dofs {
            (displacement[dof], rate[dof]) = (u[dof], 0.0);
        }
    }

    /// Makes their flexibility known from `node`.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool]) {
        if let Some(surface) = &mut self.surface {
            surface.prepare(node, is_fixed);
        }
    }

    /// Whether a dof follows others.
    pub fn has(&self, dof: usize) -> bool {
        self.dofs.binary_search(&dof).is_ok()
    }

    /// Displacement per increment where a massless node moves as far as its row tells: `u + β (u - u_q)/dt = w` (s²).
    pub fn reach(step: &Step, damping: f64) -> f64 {
        let Weights { b0, b1 } = step.weights;
        (b0 + damping * b1) / (1.0 + damping / step.dt)
    }

    /// Writes how far the nodes are from where their springs balance forces (m), in the frame, and zero at all others.
    ///
    /// - `displacement`: of all nodes, in the frame (m).
    /// - `force`: at a node, in the frame (N).
    pub fn write_imbalance(
        &mut self,
        shape: &Shape,
        displacement: &[f64],
        force: impl Fn(usize) -> Vec2,
        imbalance: &mut [f64],
    ) {
        imbalance.fill(0.0);
        if let Some(surface) = &mut self.surface {
            imbalance.copy_from_slice(displacement);
            surface.relax(&shape.model, &shape.is_fixed, imbalance, |node, _| {
                force(node)
            });
            for (balanced, displaced) in imbalance.iter_mut().zip(displacement) {
                *balanced -= displaced;
            }
        }
    }

    /// Moves the nodes by the increments, then to where they balance under the forces of the iterate.
    ///
    /// - `u`: displacements before the increment (m).
    pub fn advance(&mut self, shared: &mut Shared, u: &[f64], increment: &[f64]) {
        let (shape, now) = (&shared.shape, &mut shared.now);
        let reach = Self::reach(&shared.step, shape.model.rayleigh().stiffness);
        for &dof in &self.dofs {
            let moved = reach * increment[dof];
            now.displacement[dof] = u[dof] + moved;
            now.rate[dof] = moved / shared.step.dt;
        }
        let Some(surface) = self.surface.as_mut().filter(|surface| surface.follows()) else {
            return;
        };
        let (back, forces) = (
            now.turn.transpose(),
            [&shared.loads.force, &shared.contact.nodal],
        );
        let (lag, slowness) = (surface.lag, surface.slowness());
        let displacement = &mut now.displacement;
        surface.relax(
            &shape.model,
            &shape.is_fixed,
            displacement,
            |node, start| {
                let [applied, contact] = forces.map(|force| node_vec(force, node));
                let end = back * (applied + contact);
                (end + lag * start) / slowness
            },
        );
    }

    /// Gives the nodes of a damped body the rates `E u̇_m + (e' - e)/dt`.
    pub fn follow_rates(&mut self, shared: &mut Shared) {
        let (shape, now) = (&shared.shape, &mut shared.now);
        if let Some(surface) = self.surface.as_mut().filter(|surface| surface.follows()) {
            let model = &shape.model;
            let (displacement, dt) = (&now.displacement, shared.step.dt);
            surface.relax(model, &shape.is_fixed, &mut now.rate, |node, start| {
                (spring(model, node, displacement) - start) / dt
            });
        }
    }

    /// What the flexibility of the nodes adds to what `A⁻¹` has of it, which is damped by the weights of the masses, in the frame (1/kg).
    pub fn beyond_answer(&self, shared: &Shared, at: usize, from: usize) -> Option<Mat2> {
        let surface = self.surface.as_ref().filter(|_| !self.dofs.is_empty())?;
        let b0 = shared.step.weights.b0;
        let share = 1.0 / (b0 * surface.slowness()) - 1.0 / damped_reach(shared);
        Some(share * surface.flexibility(at, from))
    }

    /// What the springs between surface and masses give of the compliance of velocities, `K_ss⁻¹/(b0 + β b1)`, in world axes (1/kg): the
    /// rest is what the masses give that the surface rests on. Zero but between nodes without mass.
    pub fn spring_compliance(&self, shared: &Shared, at: usize, from: usize) -> Mat2 {
        let Some(surface) = &self.surface else {
            return Mat2::zeros();
        };
        let local = surface.flexibility(at, from) / damped_reach(shared);
        shared.now.turn * local * shared.now.turn.transpose()
    }
}

/// `b0 + β b1` (s²).
fn damped_reach(shared: &Shared) -> f64 {
    let Weights { b0, b1 } = shared.step.weights;
    b0 + shared.shape.model.rayleigh().stiffness * b1
}
