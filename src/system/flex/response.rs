//! What a flexible block answers: to forces at its nodes, to impulses, and by its masses alone.

use super::block::{FlexBlock, Method};
use super::small::SmallStrain;
use crate::body::Frame;
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{Mat2, Vec2, cross};
use crate::system::step::Response;

impl FlexBlock {
    /// `A` in the frame, pinned dofs taken out.
    pub fn effective(&self) -> &BlockMatrix {
        &self.shared.answer.effective
    }

    /// Numeric factorizations so far.
    pub fn n_factorizations(&self) -> u64 {
        self.shared.answer.n_factorizations
    }

    /// Back-substitutions so far.
    pub fn n_solves(&self) -> u64 {
        self.shared.answer.n_solves
    }

    /// Operations of one factorization of `A`, roughly.
    pub fn factor_operations(&self) -> f64 {
        let n_dofs = self.shared.shape.n_dofs();
        self.shared.answer.factor_operations(n_dofs)
    }

    /// A direction at a node in the frame, without what pins hold.
    pub fn local_row(&self, node: usize, direction: Vec2) -> [f64; 2] {
        let local = self.shared.now.turn.transpose() * direction;
        [0, 1].map(|axis| {
            if self.shared.shape.is_fixed[2 * node + axis] {
                0.0
            } else {
                local[axis]
            }
        })
    }

    /// Makes [`FlexBlock::compliance`] known from `node`.
    pub fn prepare_compliance(&mut self, node: usize) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.prepare(shared, node),
            Method::Explicit(explicit) => explicit.prepare(shared, node),
            Method::Large(_) => shared.answer.prepare(node, &shared.shape.is_fixed),
        }
    }

    /// See [`Block::compliance`](crate::system::Block::compliance).
    pub fn compliance(&self, at: (usize, Vec2), from: (usize, Vec2), of: Response) -> Mat2 {
        let shared = &self.shared;
        match &self.method {
            Method::Explicit(explicit) => explicit.compliance(shared, at.0, from.0, of),
            _ if of == Response::ByMass => {
                let turn = shared.now.turn;
                shared.answer.of_masses(&shared.shape, turn, at.0, from.0)
            }
            Method::Small(small) => small.compliance(shared, at, from, of),
            Method::Large(_) => shared.answer.compliance.get(at.0, from.0),
        }
    }

    /// The couples of a force at a node: by its lever, and by the reference arm of the node (N m).
    pub fn couples(&self, (node, lever): (usize, Vec2), force: Vec2) -> [f64; 2] {
        [cross(lever, force), self.shared.turn_arm(node).dot(&force)]
    }

    /// How a node moves under the couples of forces beyond what `A⁻¹` answers to these: see [`FlexBlock::compliance`].
    pub fn turned(&self, at: (usize, Vec2), couples: [f64; 2], of: Response) -> Vec2 {
        match &self.method {
            Method::Small(_) => SmallStrain::turned(&self.shared, at, couples, of),
            _ => Vec2::zeros(),
        }
    }

    /// Share of its size by which a turn of the frame that [`solve`](Self::solve) has found changes the places that it found (-).
    ///
    /// Forces have turned against the displacements, as far as these reach, and the spin has changed with the turn by `2 δθ/dt`: what it
    /// presses outwards by answers within `dt²/4 · 2 ω 2δθ/dt · r = dt ω δθ r`, with Coriolis' forces by less than four times that.
    pub fn turning_share(&self) -> f64 {
        match &self.method {
            Method::Large(_) => 1.0,
            _ => SmallStrain::turning_share(&self.shared),
        }
    }

    /// What the springs between surface and masses give of the [compliance](FlexBlock::compliance) of velocities, in world axes (1/kg): the
    /// rest is what the masses give that the surface rests on. Zero but between nodes without mass.
    pub fn spring_compliance(&self, at: usize, from: usize) -> Mat2 {
        match &self.method {
            Method::Small(small) => small.spring_compliance(&self.shared, at, from),
            _ => Mat2::zeros(),
        }
    }

    /// Mobility of the whole body moving rigidly, `n·M⁻¹·n` at a node (1/kg); zero when its pins hold it.
    pub fn rigid_mobility(&self, node: usize, direction: Vec2) -> f64 {
        let shared = &self.shared;
        shared.now.rigid_mobility(&shared.shape, node, direction)
    }

    /// Makes [`Response::ByMass`] known from a node: nothing to do for nodal masses, one factorization for ever for a consistent
    /// mass.
    pub fn prepare_inertia(&mut self, node: usize) {
        let shared = &mut self.shared;
        shared.answer.prepare_masses(&shared.shape, node);
    }

    /// Clears all gathered impulses.
    pub fn clear_impulses(&mut self) {
        self.shared.impulses.clear();
    }

    /// Gathers an impulse at a node that acts at a lever from the centre (m).
    pub fn gather_impulse(&mut self, of: Response, node: usize, impulse: Vec2, lever: Vec2) {
        self.shared.impulses.gather(of, node, impulse, lever);
    }

    /// Finds the responses to the gathered impulses: one substitution for both.
    pub fn respond(&mut self) {
        let mass = self.damped_mass();
        let shared = &mut self.shared;
        let (shape, now) = (&shared.shape, &shared.now);
        let impulses = &mut shared.impulses;
        if !impulses.respond(shape, now, &mut shared.answer) {
            return;
        }
        if let Method::Large(_) = self.method {
            impulses.move_velocity(shape, mass);
            return;
        }
        impulses.finish_velocity(shape, now, mass);
        let response = &mut impulses.acceleration.response;
        shape.arms.split(shape.kind, response);
    }

    /// Finds what the masses alone answer to the gathered impulses; a consistent mass that no joint holds counts by its row sums. Nodes
    /// without mass must have no impulse.
    pub fn respond_by_mass(&mut self) {
        let mass = self.damped_mass();
        let shared = &mut self.shared;
        let (shape, now) = (&shared.shape, &shared.now);
        let impulses = &mut shared.impulses;
        impulses.respond_by_mass(shape, now, &mut shared.answer);
        impulses.finish_velocity(shape, now, mass);
        if let Method::Large(_) = self.method {
            return;
        }
        let response = &mut impulses.acceleration.response;
        shape.arms.split(shape.kind, response);
    }

    /// Adds a multiple of a response to the end velocity or acceleration.
    pub fn add_response(&mut self, of: Response, scale: f64) {
        let mass = self.damped_mass();
        let shared = &mut self.shared;
        let gathered = shared.impulses.of(of);
        if !gathered.is_used {
            return;
        }
        let mean = scale * (gathered.total / mass);
        if of == Response::Acceleration {
            // Others store no forces.
            if let Method::Small(small) = &mut self.method {
                small.add_acceleration(gathered, mean, scale);
            }
            return;
        }
        if shared.shape.kind == Frame::Free {
            shared.now.frame.velocity += mean;
        }
        if let Method::Large(large) = &mut self.method {
            for (sum, response) in large.resolved.iter_mut().zip(&gathered.response) {
                *sum += scale * response;
            }
        }
        for (sum, response) in shared.now.velocity.iter_mut().zip(&gathered.response) {
            *sum += scale * response;
        }
    }

    /// Mass with what its drag makes of it (kg): bodies of large strain take it at the middle of the step, whatever the member.
    fn damped_mass(&self) -> f64 {
        let shared = &self.shared;
        let late = match self.method {
            Method::Large(_) => 0.5 * shared.step.dt,
            _ => shared.step.weights.b1,
        };
        shared.shape.arms.mass * (1.0 + shared.shape.model.rayleigh().mass * late)
    }

    /// Writes the velocities that the gathered impulses give (m/s): those at massless nodes reach the masses
    /// through the stiffness, as forces there do. Explicit steps only.
    pub fn respond_to_surface_impulse(&mut self) {
        if let Method::Explicit(explicit) = &mut self.method {
            explicit.respond(&mut self.shared);
        }
    }

    /// Adds that response to the end velocity.
    pub fn add_surface_response(&mut self, scale: f64) {
        let shared = &mut self.shared;
        let gathered = &shared.impulses.velocity;
        if !gathered.is_used {
            return;
        }
        for (velocity, response) in shared.now.velocity.iter_mut().zip(&gathered.response) {
            *velocity += scale * response;
        }
        if shared.shape.kind == Frame::Free {
            shared.now.frame.velocity += scale * gathered.total / shared.shape.arms.mass;
        }
    }
}
