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

use super::compliance::Compliance;
use super::flex_block::FlexBlock;
use super::massless_surface::MasslessSurface;
use super::step::Response;
use crate::body::{FlexState, Frame};
use crate::fe::model::{MassMatrix, Model};
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};
use std::sync::Arc;

/// What an explicit block has beside an implicit one; empty in the latter.
#[derive(Clone, Debug, Default)]
pub(super) struct Explicit {
    pub(super) is_on: bool,
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

impl FlexBlock {
    /// A block for `β0 = 0`, of a body with lumped mass: the mesh is neither ordered nor factorized.
    pub fn explicit(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let (surface, stiffness) = MasslessSurface::new(&model, &is_fixed);
        let zeros = || vec![0.0; model.n_dofs()];
        let explicit = Explicit {
            is_on: true,
            surface,
            acceleration: zeros(),
            free_position: zeros(),
            start_displacement: zeros(),
            elastic: zeros(),
            internal: zeros(),
            late_force: zeros(),
            late_start: zeros(),
            kick: zeros(),
            ..Explicit::default()
        };
        let factor = BlockCholesky::analyze(&stiffness);
        let matrix = (stiffness, factor, Compliance::default());
        Self::with_matrix(model, is_fixed, kind, matrix, explicit)
    }

    /// Whether the block steps by central difference.
    pub fn is_explicit(&self) -> bool {
        self.explicit.is_on
    }

    /// Notes that the body has not moved yet: its massless nodes begin where the loads put them.
    pub(super) fn start_explicitly(&mut self, state: &mut FlexState) {
        state.acceleration.fill(0.0);
        self.explicit.is_known = false;
        self.explicit.is_new = true;
    }

    /// Writes the free positions, from the forces that act where the body is now.
    pub(super) fn predict_explicitly(&mut self, state: &FlexState) -> Result<(), CholeskyError> {
        if self.n_factorizations == 0 && !self.explicit.surface.nodes.is_empty() {
            self.factor.factorize(&self.effective)?;
            self.n_factorizations = 1;
        }
        let is_known = self.explicit.is_known && self.position == state.position;
        self.position.copy_from_slice(&state.position);
        self.velocity.copy_from_slice(&state.velocity);
        self.displacement.copy_from_slice(&state.displacement);
        self.rate.copy_from_slice(&state.rate);
        self.explicit
            .start_displacement
            .copy_from_slice(&state.displacement);
        self.frame = state.frame;
        self.turn = rotation(self.frame.angle);
        self.inertia = self.arms.polar;
        self.clear_contact_force();
        if self.kind != Frame::Fixed {
            let centre = self.frame.centre;
            self.start_momentum = self.angular_momentum(centre);
        }
        if !is_known {
            self.measure_internal_force();
        }
        self.accelerate(true);
        let dt = self.step.dt;
        let half = 0.5 * dt * dt;
        let rest = self.model.rest_positions();
        let explicit = &mut self.explicit;
        for (dof, free) in explicit.free_position.iter_mut().enumerate() {
            *free = if self.is_fixed[dof] {
                rest[dof] + self.prescribed[dof]
            } else {
                let acceleration = explicit.acceleration[dof];
                self.position[dof] + dt * self.velocity[dof] + half * acceleration
            };
        }
        Ok(())
    }

    /// Writes `K u` and `K (u + β u̇)` where no step has left them.
    fn measure_internal_force(&mut self) {
        let beta = self.model.rayleigh().stiffness;
        self.explicit.late_start.fill(0.0);
        self.explicit.kick.fill(0.0);
        for (sum, (u, rate)) in self
            .scratch
            .iter_mut()
            .zip(self.displacement.iter().zip(&self.rate))
        {
            *sum = u + beta * rate;
        }
        if self.explicit.is_new {
            self.relax_surface();
        }
        let (stiffness, explicit) = (self.model.stiffness(), &mut self.explicit);
        stiffness.multiply(&self.displacement, &mut explicit.elastic);
        stiffness.multiply(&self.scratch, &mut explicit.internal);
    }

    /// Writes `M⁻¹ (R - Q)`, and with `is_drag_known` less `α v`; zero without mass and where the body is pinned.
    pub(super) fn accelerate(&mut self, is_drag_known: bool) {
        let alpha = if is_drag_known {
            self.model.rayleigh().mass
        } else {
            0.0
        };
        let twist = self.frame_correction(&self.explicit.internal);
        let explicit = &mut self.explicit;
        let late = if is_drag_known {
            &explicit.late_start
        } else {
            &explicit.late_force
        };
        let MassMatrix::Lumped(mass) = self.model.mass() else {
            return;
        };
        for (node, &mass) in mass.iter().enumerate() {
            if mass <= 0.0 {
                continue;
            }
            let force = node_vec(&self.force, node) + node_vec(late, node)
                - self.turn * node_vec(&explicit.internal, node);
            // A resting contact has no velocity to drag: its missing half kick counts.
            let velocity = node_vec(&self.velocity, node) + node_vec(&explicit.kick, node);
            let mut acceleration = force / mass - alpha * velocity;
            if self.kind != Frame::Fixed {
                acceleration += twist * perp(self.turn * node_vec(&self.arms.reference, node));
            }
            set_node_vec(&mut explicit.acceleration, node, acceleration);
        }
        for &dof in &self.fixed_dofs {
            explicit.acceleration[dof] = 0.0;
        }
        let acceleration = &explicit.acceleration;
        let squared = self.model.mass().inner(acceleration, acceleration);
        let slot = usize::from(!is_drag_known);
        explicit.swing[slot] = 0.125 * self.step.dt * self.step.dt * squared;
    }

    /// Angular acceleration `τ / Σ m X·(X + u)` that takes the moment out of internal forces (rad/s²).
    pub(super) fn frame_correction(&self, internal: &[f64]) -> f64 {
        if self.kind == Frame::Fixed {
            return 0.0;
        }
        let (mut moment, mut inertia) = (0.0, self.arms.polar);
        for node in 0..self.model.n_nodes() {
            let u = node_vec(&self.displacement, node);
            let arm = node_vec(&self.arms.reference, node) + u;
            moment += cross(arm, node_vec(internal, node));
            inertia += node_vec(&self.arms.mass_moment, node).dot(&u);
        }
        moment / inertia
    }

    /// Moves the masses by the multipliers that are impulses, then the massless nodes to where they balance.
    pub(super) fn solve_explicitly(&mut self) {
        let weight = self.step.dt * self.step.dt;
        let MassMatrix::Lumped(mass) = self.model.mass() else {
            return;
        };
        self.position.copy_from_slice(&self.explicit.free_position);
        if self.has_contact_force {
            for (dof, position) in self.position.iter_mut().enumerate() {
                if mass[dof / 2] > 0.0 && !self.is_fixed[dof] {
                    *position += weight / mass[dof / 2] * self.contact_force[dof];
                }
            }
        }
        if self.kind != Frame::Fixed {
            let start = self.start_frame;
            let centre = self.arms.centre(self.kind, &self.position, start.centre);
            self.frame.centre = centre;
            self.frame.angle = self.arms.angle(&self.position, centre, start.angle);
            self.turn = rotation(self.frame.angle);
        }
        let back = self.turn.transpose();
        for node in 0..self.model.n_nodes() {
            let arm = back * (node_vec(&self.position, node) - self.frame.centre);
            let u = arm - node_vec(&self.arms.reference, node);
            set_node_vec(&mut self.displacement, node, u);
        }
        self.place_surface();
    }

    /// Goes back to where the step began.
    pub(super) fn restart_explicitly(&mut self) {
        self.position.copy_from_slice(&self.start_position);
        self.displacement
            .copy_from_slice(&self.explicit.start_displacement);
        self.frame = self.start_frame;
        self.turn = rotation(self.frame.angle);
    }

    /// Ends the step where it began, with no velocity but what the forces there give in half a step.
    pub(super) fn hold_explicitly(&mut self) {
        self.clear_contact_force();
        self.restart_explicitly();
        self.velocity.fill(0.0);
        self.explicit.acceleration.fill(0.0);
    }

    /// Ratio `β / dt` of the damping term (-).
    pub(super) fn lag(&self) -> f64 {
        self.model.rayleigh().stiffness / self.step.dt
    }

    /// Moves the massless nodes to where they balance under the contact forces.
    fn place_surface(&mut self) {
        let lag = self.lag();
        for (sum, (u, before)) in self.scratch.iter_mut().zip(
            self.displacement
                .iter()
                .zip(&self.explicit.start_displacement),
        ) {
            *sum = (1.0 + lag) * u - lag * before;
        }
        self.relax_surface();
        let explicit = &mut self.explicit;
        for &node in &explicit.surface.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !self.is_fixed[dof] {
                    let before = explicit.start_displacement[dof];
                    self.displacement[dof] = (self.scratch[dof] + lag * before) / (1.0 + lag);
                }
            }
            let arm = node_vec(&self.arms.reference, node) + node_vec(&self.displacement, node);
            let position = self.frame.centre + self.turn * arm;
            set_node_vec(&mut self.position, node, position);
        }
    }

    /// Writes the massless entries of `scratch`, which holds `u + β u̇` of the others, so that forces balance there.
    fn relax_surface(&mut self) {
        let surface = &mut self.explicit.surface;
        if surface.nodes.is_empty() {
            return;
        }
        let back = self.turn.transpose();
        for &node in &surface.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !self.is_fixed[dof] {
                    self.scratch[dof] = 0.0;
                }
            }
        }
        for (slot, &node) in surface.nodes.iter().enumerate() {
            let force = node_vec(&self.force, node) + node_vec(&self.contact_force, node);
            let [x, y] = self.model.stiffness().multiply_node(node, &self.scratch);
            let mut force = back * force - Vec2::new(x, y);
            for axis in 0..2 {
                if self.is_fixed[2 * node + axis] {
                    force[axis] = 0.0;
                }
            }
            set_node_vec(&mut surface.local, slot, force);
        }
        self.factor.solve_in_place(&mut surface.local);
        self.n_solves += 1;
        for (slot, &node) in surface.nodes.iter().enumerate() {
            add_node_vec(&mut self.scratch, node, node_vec(&surface.local, slot));
        }
    }

    pub(super) fn prepare_explicitly(&mut self, node: usize) {
        let surface = &mut self.explicit.surface;
        if surface.prepare(node, &self.is_fixed, &mut self.factor) {
            self.n_solves += 2;
        }
    }

    /// `x'` per multiplier over `dt²`: `M⁻¹` of a mass, the flexibility of massless nodes (1/kg).
    pub(super) fn explicit_compliance(&self, at: usize, from: usize, of: Response) -> Mat2 {
        let mass = self.arms.node_mass[at];
        if at == from && mass > 0.0 {
            let free = |axis: usize| f64::from(!self.is_fixed[2 * at + axis]) / mass;
            return Mat2::new(free(0), 0.0, 0.0, free(1));
        }
        if of != Response::Position {
            return Mat2::zeros();
        }
        let weight = self.step.dt * self.step.dt * (1.0 + self.lag());
        let flexibility = self.explicit.surface.flexibility(at, from);
        self.turn * (flexibility / weight) * self.turn.transpose()
    }
}
