//! Central difference (`β0 = 0`) with forward-increment multipliers (Carpenter, Taylor, Katona 1991).
//!
//! (C.5) is singular for `b0 = 0`. Here the forces of a contact act with the geometry of the next instant,
//!
//! ```text
//! M a_k + Q_k + G'ᵀλ = R_k,    G'(x' + D) = 0:    x' = x* - dt² M⁻¹ G'ᵀλ,    x* = x + dt v + dt²/2 M⁻¹ (R - Q),
//! ```
//!
//! and `v' = v + dt ((1 - β1) a_k + β1 a') - dt M⁻¹ G'ᵀλ` with the smooth accelerations `a = M⁻¹ (R - Q)`: the velocities of the
//! half steps, moved to the full ones. The mass is lumped, so a step multiplies by `K` once and solves nothing.
//!
//! **Massless nodes** follow quasi-statically (see `massless_surface`). A multiplier there is the force of a spring at
//! `t_{k+1}`: it moves the surface at once, and masses through `Q'`.
//!
//! **Turning bodies** are advanced in world coordinates. With `u = Rᵀ(x - c) - X` and the angle θ that the mass sees, the gradient
//! of `½ u·K u` is `R K u` less `τ m R J X / Σ m X·(X + u)`, `τ = Σ (X + u) × K u`: the resultant and the moment of
//! these forces vanish, so momentum and angular momentum are kept to rounding.
//!
//! **Damping** takes `u̇` from the half step before, `(u' - u) / dt`, which keeps the step explicit, is of first order
//! for the damping forces, and lowers the critical step to `2 (√(1 + ζ²) - ζ) / ω`.

mod end;

use super::massless_surface::MasslessSurface;
use super::shape::Shape;
use super::shared::Shared;
use crate::body::{FlexState, Frame};
use crate::fe::model::MassMatrix;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::CholeskyError;
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};
use crate::system::step::Response;

/// What a step by central difference needs beside what all blocks have.
#[derive(Clone, Debug, Default)]
pub(super) struct Explicit {
    pub(super) surface: MasslessSurface,
    /// `M⁻¹ (R - Q)` in world axes: at the beginning of the step, then at its end (m/s²).
    pub(super) acceleration: Vec<f64>,
    /// `x*` (m).
    pub(super) free_position: Vec<f64>,
    pub(super) start_displacement: Vec<f64>,
    /// `K u` and `K (u + β u̇)` in the body's frame, as last measured (N).
    pub(super) elastic: Vec<f64>,
    pub(super) internal: Vec<f64>,
    /// Forces of quasi-static contacts on masses, of the iterate and of the end of the last step (N).
    pub(super) late_force: Vec<f64>,
    pub(super) late_start: Vec<f64>,
    pub(super) has_late_force: bool,
    /// `dt/2 M⁻¹` times the impulsive forces of the last step: what its velocities lack at a contact that stays (m/s).
    pub(super) kick: Vec<f64>,
    /// `dt²/8 a·M a` at the beginning and at the end (J).
    pub(super) swing: [f64; 2],
    /// Whether `internal` is that of `position`.
    pub(super) is_known: bool,
    pub(super) is_new: bool,
}

impl Explicit {
    /// What a body of lumped mass needs, with the stiffness of its massless nodes: the mesh is neither ordered nor factorized.
    pub fn new(shape: &Shape) -> (Self, BlockMatrix) {
        let (surface, stiffness) = MasslessSurface::new(&shape.model, &shape.is_fixed);
        let zeros = || vec![0.0; shape.n_dofs()];
        let explicit = Self {
            surface,
            acceleration: zeros(),
            free_position: zeros(),
            start_displacement: zeros(),
            elastic: zeros(),
            internal: zeros(),
            late_force: zeros(),
            late_start: zeros(),
            kick: zeros(),
            ..Self::default()
        };
        (explicit, stiffness)
    }

    /// Notes that the body has not moved yet: its massless nodes begin where the loads put them.
    pub fn start(&mut self, state: &mut FlexState) {
        state.acceleration.fill(0.0);
        self.is_known = false;
        self.is_new = true;
    }

    /// Writes the free positions, from the forces that act where the body is now.
    pub fn predict(&mut self, shared: &mut Shared, state: &FlexState) -> Result<(), CholeskyError> {
        if shared.answer.n_factorizations == 0 && !self.surface.nodes.is_empty() {
            shared.answer.factor.factorize(&shared.answer.effective)?;
            shared.answer.n_factorizations = 1;
        }
        let is_known = self.is_known && shared.now.position == state.position;
        shared.now.position.copy_from_slice(&state.position);
        shared.now.velocity.copy_from_slice(&state.velocity);
        shared.now.displacement.copy_from_slice(&state.displacement);
        shared.now.rate.copy_from_slice(&state.rate);
        self.start_displacement.copy_from_slice(&state.displacement);
        shared.now.frame = state.frame;
        shared.now.turn = rotation(shared.now.frame.angle);
        shared.now.inertia = shared.shape.arms.polar;
        self.clear_late_force();
        shared.contact.clear();
        if shared.shape.kind != Frame::Fixed {
            let centre = shared.now.frame.centre;
            shared.start.momentum = shared.now.angular_momentum(&shared.shape, centre);
        }
        if !is_known {
            self.measure_internal_force(shared);
        }
        self.accelerate(shared, true);
        let dt = shared.step.dt;
        let half = 0.5 * dt * dt;
        let rest = shared.shape.model.placed_positions();
        for (dof, free) in self.free_position.iter_mut().enumerate() {
            *free = if shared.shape.is_fixed[dof] {
                rest[dof] + shared.loads.prescribed[dof]
            } else {
                let acceleration = self.acceleration[dof];
                shared.now.position[dof] + dt * shared.now.velocity[dof] + half * acceleration
            };
        }
        Ok(())
    }

    /// Writes `K u` and `K (u + β u̇)` where no step has left them.
    fn measure_internal_force(&mut self, shared: &mut Shared) {
        let beta = shared.shape.model.rayleigh().stiffness;
        self.late_start.fill(0.0);
        self.kick.fill(0.0);
        for (sum, (u, rate)) in shared
            .scratch
            .iter_mut()
            .zip(shared.now.displacement.iter().zip(&shared.now.rate))
        {
            *sum = u + beta * rate;
        }
        if self.is_new {
            self.relax_surface(shared);
        }
        let stiffness = shared.shape.model.stiffness();
        stiffness.multiply(&shared.now.displacement, &mut self.elastic);
        stiffness.multiply(&shared.scratch, &mut self.internal);
    }

    /// Writes `M⁻¹ (R - Q)`, and with `is_drag_known` less `α v`; zero without mass and where the body is pinned.
    pub fn accelerate(&mut self, shared: &Shared, is_drag_known: bool) {
        let alpha = if is_drag_known {
            shared.shape.model.rayleigh().mass
        } else {
            0.0
        };
        let twist = frame_correction(shared, &self.internal);
        let late = if is_drag_known {
            &self.late_start
        } else {
            &self.late_force
        };
        let MassMatrix::Lumped(mass) = shared.shape.model.mass() else {
            return;
        };
        for (node, &mass) in mass.iter().enumerate() {
            if mass <= 0.0 {
                continue;
            }
            let force = node_vec(&shared.loads.force, node) + node_vec(late, node)
                - shared.now.turn * node_vec(&self.internal, node);
            // A resting contact has no velocity to drag: its missing half kick counts.
            let velocity = node_vec(&shared.now.velocity, node) + node_vec(&self.kick, node);
            let mut acceleration = force / mass - alpha * velocity;
            if shared.shape.kind != Frame::Fixed {
                acceleration +=
                    twist * perp(shared.now.turn * node_vec(&shared.shape.arms.reference, node));
            }
            set_node_vec(&mut self.acceleration, node, acceleration);
        }
        shared.shape.clear_fixed(&mut self.acceleration);
        let acceleration = &self.acceleration;
        let squared = shared.shape.model.mass().inner(acceleration, acceleration);
        let slot = usize::from(!is_drag_known);
        self.swing[slot] = 0.125 * shared.step.dt * shared.step.dt * squared;
    }

    /// Moves the masses by the multipliers that are impulses, then the massless nodes to where they balance.
    pub fn solve(&mut self, shared: &mut Shared) {
        let weight = shared.step.dt * shared.step.dt;
        let MassMatrix::Lumped(mass) = shared.shape.model.mass() else {
            return;
        };
        shared.now.position.copy_from_slice(&self.free_position);
        if shared.contact.is_used {
            for (dof, position) in shared.now.position.iter_mut().enumerate() {
                if mass[dof / 2] > 0.0 && !shared.shape.is_fixed[dof] {
                    *position += weight / mass[dof / 2] * shared.contact.nodal[dof];
                }
            }
        }
        if shared.shape.kind != Frame::Fixed {
            let start = shared.start.frame;
            let centre =
                shared
                    .shape
                    .arms
                    .centre(shared.shape.kind, &shared.now.position, start.centre);
            shared.now.frame.centre = centre;
            shared.now.frame.angle =
                shared
                    .shape
                    .arms
                    .angle(&shared.now.position, centre, start.angle);
            shared.now.turn = rotation(shared.now.frame.angle);
        }
        shared.now.displace(&shared.shape);
        self.place_surface(shared);
    }

    /// Goes back to where the step began.
    pub fn restart(&self, shared: &mut Shared) {
        shared.now.position.copy_from_slice(&shared.start.position);
        shared
            .now
            .displacement
            .copy_from_slice(&self.start_displacement);
        shared.now.frame = shared.start.frame;
        shared.now.turn = rotation(shared.now.frame.angle);
    }

    /// Ends the step where it began, with no velocity but what the forces there give in half a step.
    pub fn hold(&mut self, shared: &mut Shared) {
        self.clear_late_force();
        shared.contact.clear();
        self.restart(shared);
        shared.now.velocity.fill(0.0);
        self.acceleration.fill(0.0);
    }

    /// Moves the massless nodes to where they balance under the contact forces.
    fn place_surface(&mut self, shared: &mut Shared) {
        let lag = lag(shared);
        for (sum, (u, before)) in shared
            .scratch
            .iter_mut()
            .zip(shared.now.displacement.iter().zip(&self.start_displacement))
        {
            *sum = (1.0 + lag) * u - lag * before;
        }
        self.relax_surface(shared);
        for &node in &self.surface.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !shared.shape.is_fixed[dof] {
                    let before = self.start_displacement[dof];
                    shared.now.displacement[dof] =
                        (shared.scratch[dof] + lag * before) / (1.0 + lag);
                }
            }
            let arm = node_vec(&shared.shape.arms.reference, node)
                + node_vec(&shared.now.displacement, node);
            let position = shared.now.frame.centre + shared.now.turn * arm;
            set_node_vec(&mut shared.now.position, node, position);
        }
    }

    /// Writes the massless entries of `scratch`, which holds `u + β u̇` of the others, so that forces balance there.
    fn relax_surface(&mut self, shared: &mut Shared) {
        let surface = &mut self.surface;
        if surface.nodes.is_empty() {
            return;
        }
        let back = shared.now.turn.transpose();
        for &node in &surface.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !shared.shape.is_fixed[dof] {
                    shared.scratch[dof] = 0.0;
                }
            }
        }
        for (slot, &node) in surface.nodes.iter().enumerate() {
            let force = node_vec(&shared.loads.force, node) + node_vec(&shared.contact.nodal, node);
            let [x, y] = shared
                .shape
                .model
                .stiffness()
                .multiply_node(node, &shared.scratch);
            let mut force = back * force - Vec2::new(x, y);
            for axis in 0..2 {
                if shared.shape.is_fixed[2 * node + axis] {
                    force[axis] = 0.0;
                }
            }
            set_node_vec(&mut surface.local, slot, force);
        }
        shared.answer.solve(&mut surface.local);
        for (slot, &node) in surface.nodes.iter().enumerate() {
            add_node_vec(&mut shared.scratch, node, node_vec(&surface.local, slot));
        }
    }

    pub fn prepare(&mut self, shared: &mut Shared, node: usize) {
        let surface = &mut self.surface;
        if surface.prepare(node, &shared.shape.is_fixed, &mut shared.answer.factor) {
            shared.answer.n_solves += 2;
        }
    }

    /// `x'` per multiplier over `dt²`: `M⁻¹` of a mass, the flexibility of massless nodes (1/kg).
    pub fn compliance(&self, shared: &Shared, at: usize, from: usize, of: Response) -> Mat2 {
        let mass = shared.shape.arms.node_mass[at];
        if at == from && mass > 0.0 {
            let free = |axis: usize| f64::from(!shared.shape.is_fixed[2 * at + axis]) / mass;
            return Mat2::new(free(0), 0.0, 0.0, free(1));
        }
        if of != Response::Position {
            return Mat2::zeros();
        }
        let weight = shared.step.dt * shared.step.dt * (1.0 + lag(shared));
        let flexibility = self.surface.flexibility(at, from);
        shared.now.turn * (flexibility / weight) * shared.now.turn.transpose()
    }
}

/// Angular acceleration `τ / Σ m X·(X + u)` that takes the moment out of internal forces (rad/s²).
fn frame_correction(shared: &Shared, internal: &[f64]) -> f64 {
    if shared.shape.kind == Frame::Fixed {
        return 0.0;
    }
    let (mut moment, mut inertia) = (0.0, shared.shape.arms.polar);
    for node in 0..shared.shape.model.n_nodes() {
        let u = node_vec(&shared.now.displacement, node);
        let arm = node_vec(&shared.shape.arms.reference, node) + u;
        moment += cross(arm, node_vec(internal, node));
        inertia += node_vec(&shared.shape.arms.mass_moment, node).dot(&u);
    }
    moment / inertia
}

/// Ratio `β / dt` of the damping term (-).
fn lag(shared: &Shared) -> f64 {
    shared.shape.model.rayleigh().stiffness / shared.step.dt
}
