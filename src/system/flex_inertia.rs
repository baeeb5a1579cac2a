//! What the masses of a flexible block alone answer, `M⁻¹` in the place of `A⁻¹`.

use super::compliance::Compliance;
use super::flex_block::FlexBlock;
use super::pin_rates::RigidRates;
use crate::fe::model::MassMatrix;
use crate::linalg::cholesky::BlockCholesky;
use crate::math::{Mat2, node_vec, set_node_vec};

impl FlexBlock {
    /// Writes over `local` how velocities jump with a rigid motion `j` of the pins within a step, `j - κ A⁻¹ M j`, `κ = 1 + α b1`: by all of it where the
    /// body is stiff, at the pins alone where the step resolves its vibrations. `A j = κ M j`, as rigid motion strains nothing.
    pub(super) fn answer_jump(&mut self, jump: &RigidRates, position: &[f64], kept: f64) {
        for node in 0..self.model.n_nodes() {
            set_node_vec(&mut self.scratch, node, jump.at(node_vec(position, node)));
        }
        self.local.fill(0.0);
        self.model
            .mass()
            .multiply_add(kept, &self.scratch, &mut self.local);
        for &dof in &self.fixed_dofs {
            self.local[dof] = 0.0;
        }
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        for (answer, own) in self.local.iter_mut().zip(&self.scratch) {
            *answer = own - *answer;
        }
    }

    /// Lets a pinned body of small strain begin the step with the velocities that its pins have in it.
    ///
    /// Displacements that are given to the pins would be reached by accelerations of twice what they need, and a stiff body would swing about the
    /// velocity of its pins from step to step.
    pub(super) fn take_up_jump(&mut self) {
        let dt = self.step.dt;
        let (rest, start) = (self.model.rest_positions(), &self.start_position);
        let jump = |dof: usize| {
            (rest[dof] + self.prescribed[dof] - start[dof]) / dt - self.start_velocity[dof]
        };
        let found = RigidRates::of_pins(&self.fixed_dofs, start, jump);
        self.jump_work = 0.0;
        let Some(jump) = found else {
            return;
        };
        let before = self
            .model
            .mass()
            .inner(&self.start_velocity, &self.start_velocity);
        let kept = 1.0 + self.model.rayleigh().mass * self.step.weights.b1;
        let start = std::mem::take(&mut self.start_position);
        self.answer_jump(&jump, &start, kept);
        self.start_position = start;
        for (velocity, answer) in self.start_velocity.iter_mut().zip(&self.local) {
            *velocity += answer;
        }
        for &dof in &self.fixed_dofs {
            self.start_acceleration[dof] = 0.0;
        }
        let after = self
            .model
            .mass()
            .inner(&self.start_velocity, &self.start_velocity);
        self.jump_work = 0.5 * (after - before);
    }

    /// Makes [`super::Response::ByMass`] known from a node: nothing to do for nodal masses, one factorization for ever for a consistent
    /// mass.
    pub fn prepare_inertia(&mut self, node: usize) {
        if self.mass_factor.is_none()
            && let MassMatrix::Consistent(mass) = self.model.mass()
        {
            let mut mass = mass.clone();
            let massless = |dof: usize| self.model.is_massless(dof / 2);
            let idle: Vec<bool> = (0..self.n_dofs())
                .map(|dof| self.is_fixed[dof] || massless(dof))
                .collect();
            mass.constrain(&idle);
            let mut factor = BlockCholesky::analyze(&mass);
            if factor.factorize(&mass).is_err() {
                return;
            }
            self.n_factorizations += 1;
            self.mass_factor = Some((factor, Compliance::new(&self.model)));
        }
        if let Some((factor, compliance)) = &mut self.mass_factor
            && compliance.prepare(node, &self.is_fixed, factor)
        {
            self.n_solves += 2;
        }
    }

    /// Velocity at one node per impulse at another if nothing but their masses resisted (1/kg).
    pub(super) fn mass_response(&self, at: usize, from: usize) -> Mat2 {
        if let Some((_, compliance)) = &self.mass_factor {
            let local = compliance.get(at, from);
            return self.turn * local * self.turn.transpose();
        }
        if at == from {
            self.inverse_mass(at)
        } else {
            Mat2::zeros()
        }
    }

    /// Finds what the masses alone answer to the gathered impulses; a consistent mass that no joint holds counts by its row sums. Nodes
    /// without mass must have no impulse.
    pub fn respond_by_mass(&mut self) {
        let back = self.turn.transpose();
        for channel in 0..self.impulses.len() {
            if !self.impulses[channel].is_used {
                continue;
            }
            for node in 0..self.arms.node_mass.len() {
                let impulse = back * node_vec(&self.impulses[channel].nodal, node);
                let response = match self.mass_factor {
                    Some(_) => impulse,
                    None => self.inverse_mass(node) * impulse,
                };
                set_node_vec(&mut self.impulses[channel].response, node, response);
            }
            let response = &mut self.impulses[channel].response;
            for &dof in &self.fixed_dofs {
                response[dof] = 0.0;
            }
            if let Some((factor, _)) = &mut self.mass_factor {
                factor.solve_in_place(response);
                self.n_solves += 1;
            }
        }
        self.finish_velocity();
        if self.is_large() {
            return;
        }
        self.arms.split(self.kind, &mut self.impulses[1].response);
    }

    /// `M⁻¹` of one node, none for one without mass or along its pins (1/kg).
    fn inverse_mass(&self, node: usize) -> Mat2 {
        let mass = self.arms.node_mass[node];
        let free = |axis: usize| {
            let moves = mass > 0.0 && !self.is_fixed[2 * node + axis];
            if moves { 1.0 / mass } else { 0.0 }
        };
        Mat2::new(free(0), 0.0, 0.0, free(1))
    }
}
