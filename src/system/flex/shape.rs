//! What of a flexible body never changes while its block lives: model, pins, masses in its frame, sizes.

use crate::body::{Arms, Frame, FrameMotion};
use crate::fe::model::Model;
use crate::math::{Mat2, Vec2, node_vec, perp, set_node_vec};
use crate::path::clearance;
use std::sync::Arc;

/// A flexible body at rest.
#[derive(Debug)]
pub(super) struct Shape {
    pub model: Arc<Model>,
    pub kind: Frame,
    pub arms: Arms,
    pub is_fixed: Vec<bool>,
    /// The pinned dofs, ascending.
    pub fixed_dofs: Vec<usize>,
    /// Largest coordinate of the reference placement (m).
    pub extent: f64,
    /// Largest side of the reference placement's box (m).
    pub size: f64,
    /// Least distance of the surface from itself at rest (m).
    pub clearance: f64,
}

impl Shape {
    /// Measures a model whose dofs in `is_fixed` are pinned.
    pub fn new(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let rest = model.placed_positions();
        Self {
            arms: Arms::new(&model, kind),
            kind,
            fixed_dofs: (0..model.n_dofs()).filter(|&dof| is_fixed[dof]).collect(),
            is_fixed,
            extent: rest.iter().fold(0.0f64, |extent, x| extent.max(x.abs())),
            size: size_of(rest),
            clearance: clearance_of(&model),
            model,
        }
    }

    pub fn n_dofs(&self) -> usize {
        self.is_fixed.len()
    }

    /// Sets the values of pinned dofs to zero.
    pub fn clear_fixed(&self, dofs: &mut [f64]) {
        for &dof in &self.fixed_dofs {
            dofs[dof] = 0.0;
        }
    }

    /// `I(u) ω + Σ m u × u̇` (N m s).
    pub fn angular_momentum_of(&self, frame: &FrameMotion, u: &[f64], rate: &[f64]) -> f64 {
        self.inertia_of(u) * frame.spin + self.model.mass().moment(Vec2::zeros(), u, rate)
    }

    /// `I(u) = Σ m (X + u)²` (kg m²).
    pub fn inertia_of(&self, u: &[f64]) -> f64 {
        let linear: f64 = self
            .arms
            .mass_moment
            .iter()
            .zip(u)
            .map(|(moment, u)| moment * u)
            .sum();
        self.arms.polar + 2.0 * linear + self.model.mass().inner(u, u)
    }

    /// `Σ m (x - c)²`, nodes by their row sums (kg m²).
    pub fn polar_inertia(&self, position: &[f64], centre: Vec2) -> f64 {
        let masses = self.arms.node_mass.iter().enumerate();
        masses
            .map(|(node, mass)| mass * (node_vec(position, node) - centre).norm_squared())
            .sum()
    }

    /// The mass centre of nodal positions from `centre` (m): zero for a free body.
    pub fn mass_offset(&self, position: &[f64], centre: Vec2) -> Vec2 {
        self.arms.centre(Frame::Free, position, centre) - centre
    }

    /// Velocity at a node with mass; the mean of those that carry a massless node's mass, and the spin times the lever from them to it.
    pub fn turned_on(&self, node: usize, spin: f64, [position, velocity]: [&[f64]; 2]) -> Vec2 {
        let support = self.carried(node, |node| node_vec(position, node));
        let offset = node_vec(position, node) - support;
        self.carried(node, |node| node_vec(velocity, node)) + spin * perp(offset)
    }

    /// A value at a node with mass, or its mean over the nodes that carry a massless node's mass.
    pub fn carried(&self, node: usize, value: impl Fn(usize) -> Vec2) -> Vec2 {
        match self.model.support_of(node) {
            [] => value(node),
            support => {
                let sum: Vec2 = support.iter().map(|&massive| value(massive)).sum();
                sum / support.len() as f64
            }
        }
    }

    /// `M⁻¹` of one node, none for one without mass or along its pins (1/kg).
    pub fn inverse_mass(&self, node: usize) -> Mat2 {
        let mass = self.arms.node_mass[node];
        let free = |axis: usize| {
            let moves = mass > 0.0 && !self.is_fixed[2 * node + axis];
            if moves { 1.0 / mass } else { 0.0 }
        };
        Mat2::new(free(0), 0.0, 0.0, free(1))
    }

    /// Gives massless nodes the mean acceleration of the nodes that carry their mass: their own is a remainder without
    /// inertia that the trapezoidal rule would amplify.
    pub fn spread_accelerations(&self, acceleration: &mut [f64]) {
        for (node, support) in self.model.massless_support() {
            if support.is_empty() {
                continue;
            }
            let sum: Vec2 = support
                .iter()
                .map(|&massive| node_vec(acceleration, massive))
                .sum();
            let mean = sum / support.len() as f64;
            let old = node_vec(acceleration, node);
            let kept = |axis: usize| {
                if self.is_fixed[2 * node + axis] {
                    old[axis]
                } else {
                    mean[axis]
                }
            };
            set_node_vec(acceleration, node, Vec2::new(kept(0), kept(1)));
        }
    }
}

/// Largest side of the box around nodal positions (m).
fn size_of(dofs: &[f64]) -> f64 {
    let side = |axis: usize| {
        let along = dofs.iter().skip(axis).step_by(2);
        let ends = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(*x), high.max(*x)]
        });
        ends[1] - ends[0]
    };
    side(0).max(side(1))
}

/// Least distance of a model's surface from itself at rest (m).
fn clearance_of(model: &Model) -> f64 {
    let boundary = model.mesh().boundary();
    let nodes = boundary.nodes().iter();
    let points: Vec<Vec2> = nodes
        .map(|&node| node_vec(model.placed_positions(), node))
        .collect();
    // Segment k starts at boundary node k.
    let edges: Vec<[u32; 2]> = (0..boundary.segments().len())
        .map(|segment| [segment as u32, boundary.next_segment(segment) as u32])
        .collect();
    clearance(&points, &edges)
}
