//! Impulses at velocity level: gathered, answered by one substitution for velocities and accelerations together, and added
//! to either as often as wanted.

use super::answer::Answer;
use super::iterate::Iterate;
use super::shape::Shape;
use crate::body::Frame;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, set_node_vec};
use crate::system::step::Response;

/// Impulses on the nodes, for the velocity (N s) or as forces for the acceleration (N), and the response to them.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    pub nodal: Vec<f64>,
    pub total: Vec2,
    /// Moment about the centre, by the levers they came with.
    pub moment: f64,
    /// Velocities in world axes, or second rates in the frame without their rigid part.
    pub response: Vec<f64>,
    pub is_used: bool,
}

impl Gathered {
    fn new(n_dofs: usize) -> Self {
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

/// Impulses for the velocity and for the acceleration.
#[derive(Clone, Debug)]
pub(super) struct Impulses {
    pub velocity: Gathered,
    pub acceleration: Gathered,
    /// Right-hand sides of both.
    columns: Vec<f64>,
}

impl Impulses {
    pub fn new(n_dofs: usize) -> Self {
        Self {
            velocity: Gathered::new(n_dofs),
            acceleration: Gathered::new(n_dofs),
            columns: vec![0.0; 2 * n_dofs],
        }
    }

    pub fn clear(&mut self) {
        self.velocity.clear();
        self.acceleration.clear();
    }

    /// Those of accelerations, or of velocities.
    pub fn of(&self, of: Response) -> &Gathered {
        match of {
            Response::Acceleration => &self.acceleration,
            _ => &self.velocity,
        }
    }

    /// Gathers an impulse at a node that acts at a lever from the centre (m).
    pub fn gather(&mut self, of: Response, node: usize, impulse: Vec2, lever: Vec2) {
        let gathered = match of {
            Response::Acceleration => &mut self.acceleration,
            _ => &mut self.velocity,
        };
        add_node_vec(&mut gathered.nodal, node, impulse);
        gathered.total += impulse;
        gathered.moment += cross(lever, impulse);
        gathered.is_used = true;
    }

    /// Finds the responses to both, in the frame, by one substitution; returns whether there are any.
    pub fn respond(&mut self, shape: &Shape, now: &Iterate, answer: &mut Answer) -> bool {
        let n = shape.n_dofs();
        let back = now.turn.transpose();
        let mut both = [&mut self.velocity, &mut self.acceleration];
        let mut n_columns = 0;
        for gathered in both.iter().filter(|gathered| gathered.is_used) {
            let column = &mut self.columns[n_columns * n..(n_columns + 1) * n];
            for node in 0..n / 2 {
                set_node_vec(column, node, back * node_vec(&gathered.nodal, node));
            }
            shape.clear_fixed(column);
            n_columns += 1;
        }
        match n_columns {
            0 => return false,
            1 => answer.factor.solve_in_place(&mut self.columns[..n]),
            _ => answer.factor.solve_many_in_place(&mut self.columns, 2),
        }
        answer.n_solves += n_columns as u64;
        let used = both.iter_mut().filter(|gathered| gathered.is_used);
        for (gathered, column) in used.zip(self.columns.chunks_exact(n)) {
            gathered.response.copy_from_slice(column);
        }
        true
    }

    /// Finds what the masses alone answer to both, in the frame; a consistent mass that no joint holds counts by its row sums. Nodes
    /// without mass must have no impulse.
    pub fn respond_by_mass(&mut self, shape: &Shape, now: &Iterate, answer: &mut Answer) {
        let back = now.turn.transpose();
        for gathered in [&mut self.velocity, &mut self.acceleration] {
            if !gathered.is_used {
                continue;
            }
            for node in 0..shape.arms.node_mass.len() {
                let impulse = back * node_vec(&gathered.nodal, node);
                let response = match answer.knows_masses() {
                    true => impulse,
                    false => shape.inverse_mass(node) * impulse,
                };
                set_node_vec(&mut gathered.response, node, response);
            }
            shape.clear_fixed(&mut gathered.response);
            answer.solve_masses(&mut gathered.response);
        }
    }

    /// Turns the velocity's response into world axes, moved and turned so that momentum and angular momentum gain exactly
    /// what the impulses give.
    ///
    /// - `mass`: what the centre moves by (kg).
    pub fn finish_velocity(&mut self, shape: &Shape, now: &Iterate, mass: f64) {
        let gathered = &mut self.velocity;
        if !gathered.is_used || shape.kind == Frame::Fixed {
            return;
        }
        let (turn, centre) = (now.turn, now.frame.centre);
        for node in 0..gathered.response.len() / 2 {
            let response = turn * node_vec(&gathered.response, node);
            set_node_vec(&mut gathered.response, node, response);
        }
        let gained = (shape.model.mass()).moment(centre, &now.position, &gathered.response);
        let spin = (gathered.moment - gained) / now.inertia;
        let drift = match shape.kind {
            Frame::Free => {
                let moved = &gathered.response;
                gathered.total / mass - shape.arms.centre(shape.kind, moved, Vec2::zeros())
            }
            _ => Vec2::zeros(),
        };
        for node in 0..gathered.response.len() / 2 {
            let swing = spin * perp(node_vec(&now.position, node) - centre);
            add_node_vec(&mut gathered.response, node, drift + swing);
        }
    }

    /// Moves the velocity's response so that momentum gains exactly what the impulses give: of bodies of large strain.
    ///
    /// - `mass`: what the centre moves by (kg).
    pub fn move_velocity(&mut self, shape: &Shape, mass: f64) {
        let gathered = &mut self.velocity;
        if !gathered.is_used || shape.kind != Frame::Free {
            return;
        }
        let response = &mut gathered.response;
        let moved = shape.arms.centre(shape.kind, response, Vec2::zeros());
        let missing = gathered.total / mass - moved;
        for node in 0..response.len() / 2 {
            add_node_vec(response, node, missing);
        }
    }
}
