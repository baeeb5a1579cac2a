//! Impulses at velocity level: gathered, answered by one substitution for velocities and accelerations together, and added
//! to either as often as wanted.

use super::flex_block::FlexBlock;
use super::step::Response;
use crate::body::Frame;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, set_node_vec};

/// Impulses on the nodes, for the velocity (N s) or as forces for the acceleration (N), and the response to them.
#[derive(Clone, Debug, Default)]
pub(super) struct Impulses {
    pub(super) nodal: Vec<f64>,
    pub(super) total: Vec2,
    /// Moment about the centre, by the levers they came with.
    moment: f64,
    /// Velocities in world axes, or second rates in the frame without their rigid part.
    pub(super) response: Vec<f64>,
    pub(super) is_used: bool,
}

impl Impulses {
    pub fn new(n_dofs: usize) -> Self {
        Self {
            nodal: vec![0.0; n_dofs],
            response: vec![0.0; n_dofs],
            ..Self::default()
        }
    }

    fn clear(&mut self) {
        if self.is_used {
            self.nodal.fill(0.0);
            (self.total, self.moment, self.is_used) = (Vec2::zeros(), 0.0, false);
        }
    }
}

fn channel(of: Response) -> usize {
    usize::from(of == Response::Acceleration)
}

impl FlexBlock {
    /// Clears all gathered impulses.
    pub fn clear_impulses(&mut self) {
        self.impulses.iter_mut().for_each(Impulses::clear);
    }

    /// Gathers an impulse at a node that acts at a lever from the centre (m).
    pub fn gather_impulse(&mut self, of: Response, node: usize, impulse: Vec2, lever: Vec2) {
        let gathered = &mut self.impulses[channel(of)];
        add_node_vec(&mut gathered.nodal, node, impulse);
        gathered.total += impulse;
        gathered.moment += cross(lever, impulse);
        gathered.is_used = true;
    }

    /// Finds the responses to the gathered impulses: one substitution for both.
    pub fn respond(&mut self) {
        let n = self.n_dofs();
        let back = self.turn.transpose();
        let mut n_columns = 0;
        for impulses in self.impulses.iter().filter(|impulses| impulses.is_used) {
            let column = &mut self.columns[n_columns * n..(n_columns + 1) * n];
            for node in 0..n / 2 {
                set_node_vec(column, node, back * node_vec(&impulses.nodal, node));
            }
            for &dof in &self.fixed_dofs {
                column[dof] = 0.0;
            }
            n_columns += 1;
        }
        match n_columns {
            0 => return,
            1 => self.factor.solve_in_place(&mut self.columns[..n]),
            _ => self.factor.solve_many_in_place(&mut self.columns, 2),
        }
        self.n_solves += n_columns as u64;
        let mut next = 0;
        for of in [Response::Velocity, Response::Acceleration] {
            let slot = channel(of);
            if self.impulses[slot].is_used {
                let column = &self.columns[next * n..(next + 1) * n];
                self.impulses[slot].response.copy_from_slice(column);
                next += 1;
            }
        }
        if self.is_large() {
            self.finish_large_velocity();
            return;
        }
        self.finish_velocity();
        let Self {
            impulses,
            arms,
            kind,
            ..
        } = self;
        arms.split(*kind, &mut impulses[1].response);
    }

    /// Adds a multiple of a response to the end velocity or acceleration.
    pub fn add_response(&mut self, of: Response, scale: f64) {
        let slot = channel(of);
        // Bodies of large strain store no forces.
        if !self.impulses[slot].is_used || self.is_large() && of == Response::Acceleration {
            return;
        }
        let mean = scale * self.mean_response(slot);
        let impulses = &self.impulses[slot];
        let target = if of == Response::Acceleration {
            self.torque += scale * impulses.moment;
            self.shift += mean;
            &mut self.increment
        } else {
            if self.kind == Frame::Free {
                self.frame.velocity += mean;
            }
            if let Some(large) = &mut self.large {
                for (sum, response) in large.resolved.iter_mut().zip(&impulses.response) {
                    *sum += scale * response;
                }
            }
            &mut self.velocity
        };
        for (sum, response) in target.iter_mut().zip(&impulses.response) {
            *sum += scale * response;
        }
    }

    /// Moves the response of a body of large strain so that momentum gains exactly what the impulses give.
    fn finish_large_velocity(&mut self) {
        if !self.impulses[0].is_used || self.kind != Frame::Free {
            return;
        }
        let total = self.mean_response(0);
        let response = &mut self.impulses[0].response;
        let missing = total - self.arms.centre(self.kind, response, Vec2::zeros());
        for node in 0..response.len() / 2 {
            add_node_vec(response, node, missing);
        }
    }

    /// What the drag of the masses makes of a mass (-): bodies of large strain take it at the middle of the step, whatever the member.
    fn drag_share(&self) -> f64 {
        let late = match self.is_large() {
            true => 0.5 * self.step.dt,
            false => self.step.weights.b1,
        };
        1.0 + self.model.rayleigh().mass * late
    }

    /// Change of the centre's velocity or acceleration that the gathered impulses make.
    fn mean_response(&self, slot: usize) -> Vec2 {
        let damped = self.drag_share();
        self.impulses[slot].total / (self.arms.mass * damped)
    }

    /// Turns the velocity's response into world axes, moved and turned so that momentum and angular momentum gain exactly
    /// what the impulses give.
    pub(super) fn finish_velocity(&mut self) {
        if !self.impulses[0].is_used || self.kind == Frame::Fixed {
            return;
        }
        let (turn, centre) = (self.turn, self.frame.centre);
        let mean = self.mean_response(0);
        let impulses = &mut self.impulses[0];
        for node in 0..impulses.response.len() / 2 {
            let response = turn * node_vec(&impulses.response, node);
            set_node_vec(&mut impulses.response, node, response);
        }
        let mass = self.model.mass();
        let gained = mass.moment(centre, &self.position, &impulses.response);
        let spin = (impulses.moment - gained) / self.inertia;
        let drift = match self.kind {
            Frame::Free => {
                let zero = Vec2::zeros();
                mean - self.arms.centre(self.kind, &impulses.response, zero)
            }
            _ => Vec2::zeros(),
        };
        for node in 0..impulses.response.len() / 2 {
            let swing = spin * perp(node_vec(&self.position, node) - centre);
            add_node_vec(&mut impulses.response, node, drift + swing);
        }
    }
}
