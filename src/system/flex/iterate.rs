//! Where a flexible body is at the current iterate of a step, and how it moves there.

use super::shape::Shape;
use crate::body::{Frame, FrameMotion};
use crate::fe::model::MassMatrix;
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};

/// Energy of one motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Elastic energy (J).
    pub elastic: f64,
}

/// Momentum of one motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum (N s).
    pub linear: Vec2,
    /// Angular momentum about the origin (N m s).
    pub angular: f64,
    /// First moment of mass, `Σ m x` (kg m).
    pub first_moment: Vec2,
}

/// The motion of a body at the end of the step, as far as it has been found.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    /// World positions (m) and velocities (m/s), interleaved.
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    /// `u`, `u̇` in the frame; not of bodies of large strain.
    pub displacement: Vec<f64>,
    pub rate: Vec<f64>,
    pub frame: FrameMotion,
    /// Rotation matrix of the frame.
    pub turn: Mat2,
    /// `I(u)` (kg m²).
    pub inertia: f64,
}

impl Iterate {
    pub fn new(n_dofs: usize) -> Self {
        let zeros = || vec![0.0; n_dofs];
        Self {
            position: zeros(),
            velocity: zeros(),
            displacement: zeros(),
            rate: zeros(),
            frame: FrameMotion::default(),
            turn: Mat2::identity(),
            inertia: 0.0,
        }
    }

    /// Writes the world positions of displacements in the frame.
    pub fn place(&mut self, shape: &Shape) {
        if shape.kind == Frame::Fixed {
            let rest = shape.model.placed_positions();
            let places = self.position.iter_mut().zip(rest);
            for ((x, rest), u) in places.zip(&self.displacement) {
                *x = rest + u;
            }
            return;
        }
        self.turn = rotation(self.frame.angle);
        for node in 0..shape.model.n_nodes() {
            let place = self.frame.centre + self.turn * self.arm(shape, node);
            set_node_vec(&mut self.position, node, place);
        }
    }

    /// Where a node is in the frame, `X + u` (m).
    pub fn arm(&self, shape: &Shape, node: usize) -> Vec2 {
        node_vec(&shape.arms.reference, node) + node_vec(&self.displacement, node)
    }

    /// Writes the displacements in the frame that the nodes have where they are.
    pub fn displace(&mut self, shape: &Shape) {
        let back = self.turn.transpose();
        for node in 0..shape.model.n_nodes() {
            let arm = back * (node_vec(&self.position, node) - self.frame.centre);
            let u = arm - node_vec(&shape.arms.reference, node);
            set_node_vec(&mut self.displacement, node, u);
        }
    }

    /// Writes centre, its velocity and the inertia about it, of the positions and velocities at hand.
    ///
    /// - `near`: motion of the frame that they are measured from.
    pub fn follow_centre(&mut self, shape: &Shape, near: &FrameMotion) {
        if shape.kind == Frame::Fixed {
            return;
        }
        let Shape { arms, kind, .. } = shape;
        self.frame.centre = arms.centre(*kind, &self.position, near.centre);
        self.frame.velocity = arms.centre(*kind, &self.velocity, near.velocity);
        self.inertia = shape.polar_inertia(&self.position, self.frame.centre);
        self.frame.spin = self.angular_momentum(shape, self.frame.centre) / self.inertia;
    }

    /// Kinetic energy (J).
    pub fn kinetic_energy(&self, shape: &Shape) -> f64 {
        0.5 * shape.model.mass().inner(&self.velocity, &self.velocity)
    }

    /// Angular momentum about a point (N m s).
    pub fn angular_momentum(&self, shape: &Shape, about: Vec2) -> f64 {
        let mass = shape.model.mass();
        mass.moment(about, &self.position, &self.velocity)
    }

    /// Momentum, that of rotation about the origin.
    pub fn momentum(&self, shape: &Shape) -> Momentum {
        let mut sums = Momentum::default();
        for (node, mass) in shape.arms.node_mass.iter().enumerate() {
            let position = node_vec(&self.position, node);
            let momentum = *mass * node_vec(&self.velocity, node);
            sums.linear += momentum;
            sums.first_moment += *mass * position;
            sums.angular += cross(position, momentum);
        }
        if let MassMatrix::Consistent(_) = shape.model.mass() {
            sums.angular = self.angular_momentum(shape, Vec2::zeros());
        }
        sums
    }

    /// Writes the velocities less their rigid part, `Σ m v` and `Σ m (x - c) × v` removed.
    pub fn write_vibration(&self, shape: &Shape, vibration: &mut [f64]) {
        vibration.copy_from_slice(&self.velocity);
        if shape.kind == Frame::Fixed {
            return;
        }
        let Shape { arms, kind, .. } = shape;
        let centre = arms.centre(*kind, &self.position, self.frame.centre);
        let drift = arms.centre(*kind, &self.velocity, self.frame.velocity);
        let offset = shape.mass_offset(&self.position, centre);
        let spin = self.angular_momentum(shape, centre) - arms.mass * cross(offset, drift);
        let spin = spin / shape.polar_inertia(&self.position, centre);
        for node in 0..shape.model.n_nodes() {
            let rigid = drift + spin * perp(node_vec(&self.position, node) - centre);
            add_node_vec(vibration, node, -rigid);
        }
    }

    /// Mobility of the whole body moving rigidly, `n·M⁻¹·n` at a node (1/kg); zero when its pins hold it.
    pub fn rigid_mobility(&self, shape: &Shape, node: usize, direction: Vec2) -> f64 {
        let arm = node_vec(&self.position, node) - self.frame.centre;
        let lever = cross(arm, direction);
        let arms = &shape.arms;
        match shape.kind {
            Frame::Fixed => 0.0,
            Frame::Hinged(_) => lever * lever / arms.polar,
            Frame::Free => 1.0 / arms.mass + lever * lever / arms.polar,
        }
    }
}
