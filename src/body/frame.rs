//! The one co-rotating frame of a body: `x = c + R(θ)(X + u)` with no rigid part in `u` as the mass sees it.
//!
//! The elastic force is `R K u`, completed by the torque that makes the internal forces free of a resultant moment.

use crate::fe::model::Model;
use crate::math::{Vec2, atan2, cross, node_vec, rounding};

/// What a body's frame may do, decided by its pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Frame {
    /// The pins hold the rotation: the frame keeps the orientation it was built with.
    Fixed,
    /// No pins: the frame follows the body's mass about its centre.
    Free,
    /// One node pinned in both directions: the frame turns about it.
    Hinged(usize),
}

/// Reference arms of a frame: `X` about its centre, `M X`, and the nodal masses `M 1`.
#[derive(Clone, Debug)]
pub struct Arms {
    /// Reference position about the frame's centre, interleaved (m).
    pub reference: Vec<f64>,
    /// `M X`, interleaved (kg m).
    pub mass_moment: Vec<f64>,
    /// `M 1` per node (kg).
    pub node_mass: Vec<f64>,
    /// Total mass (kg).
    pub mass: f64,
    /// `X·M X` (kg m²).
    pub polar: f64,
    /// Reference position of the centre (m).
    pub origin: Vec2,
}

impl Arms {
    /// Measures a model about the centre that `frame` turns about.
    pub fn new(model: &Model, frame: Frame) -> Self {
        let rest = model.placed_positions();
        let node_mass = model.mass().node_sums();
        let mass: f64 = node_mass.iter().sum();
        let origin = match frame {
            Frame::Fixed => Vec2::zeros(),
            Frame::Hinged(node) => node_vec(rest, node),
            Frame::Free => weighted_mean(&node_mass, mass, rest),
        };
        let reference: Vec<f64> = rest
            .chunks_exact(2)
            .flat_map(|p| [p[0] - origin.x, p[1] - origin.y])
            .collect();
        let mut mass_moment = vec![0.0; reference.len()];
        model.mass().multiply_add(1.0, &reference, &mut mass_moment);
        let polar = reference.iter().zip(&mass_moment).map(|(x, m)| x * m).sum();
        Self {
            reference,
            mass_moment,
            node_mass,
            mass,
            polar,
            origin,
        }
    }

    /// Centre of the frame for nodal positions (or velocities) `dofs`.
    ///
    /// - `near`: the centre as far as it is known; a mean of differences from it is exact where a mean of large
    ///   coordinates would drift by a rounding at every step.
    pub fn centre(&self, frame: Frame, dofs: &[f64], near: Vec2) -> Vec2 {
        match frame {
            Frame::Fixed => Vec2::zeros(),
            Frame::Hinged(node) => node_vec(dofs, node),
            Frame::Free => {
                let mut sum = Vec2::zeros();
                for (mass, p) in self.node_mass.iter().zip(dofs.chunks_exact(2)) {
                    sum += *mass * (Vec2::new(p[0], p[1]) - near);
                }
                near + sum / self.mass
            }
        }
    }

    /// Takes the mean that the mass sees out of a local vector of a free body.
    pub fn remove_mean(&self, frame: Frame, local: &mut [f64]) {
        if frame != Frame::Free {
            return;
        }
        let mean = weighted_mean(&self.node_mass, self.mass, local);
        for value in local.chunks_exact_mut(2) {
            value[0] -= mean.x;
            value[1] -= mean.y;
        }
    }

    /// The angle of the mass about `centre`, within half a turn of `near` (rad):
    /// `atan2(Σ m X × (x - c), Σ m X · (x - c))`.
    pub fn angle(&self, position: &[f64], centre: Vec2, near: f64) -> f64 {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (moment, x) in self
            .mass_moment
            .chunks_exact(2)
            .zip(position.chunks_exact(2))
        {
            let (moment, x) = (
                Vec2::new(moment[0], moment[1]),
                Vec2::new(x[0], x[1]) - centre,
            );
            sine += cross(moment, x);
            cosine += moment.dot(&x);
        }
        let angle = atan2(sine, cosine);
        angle + ((near - angle) / std::f64::consts::TAU).round() * std::f64::consts::TAU
    }

    /// Splits a local vector `δ = δ_t + δ_θ J X + δ_u` as the mass sees it; `local` keeps `δ_u`.
    ///
    /// A frame that cannot translate or turn leaves those parts in `δ_u`.
    pub fn split(&self, frame: Frame, local: &mut [f64]) -> (Vec2, f64) {
        if frame == Frame::Fixed {
            return (Vec2::zeros(), 0.0);
        }
        let shift = match frame {
            Frame::Free => weighted_mean(&self.node_mass, self.mass, local),
            _ => Vec2::zeros(),
        };
        let turn = self.turn_of(local);
        for (value, reference) in local
            .chunks_exact_mut(2)
            .zip(self.reference.chunks_exact(2))
        {
            value[0] -= shift.x - turn * reference[1];
            value[1] -= shift.y + turn * reference[0];
        }
        (shift, turn)
    }

    /// `Σ m X × δ / Σ m X²`.
    pub fn turn_of(&self, local: &[f64]) -> f64 {
        let pairs = self.mass_moment.chunks_exact(2).zip(local.chunks_exact(2));
        let sum: f64 = pairs
            .map(|(moment, value)| moment[0] * value[1] - moment[1] * value[0])
            .sum();
        sum / self.polar
    }
}

fn weighted_mean(weight: &[f64], total: f64, dofs: &[f64]) -> Vec2 {
    let mut sum = Vec2::zeros();
    for (weight, p) in weight.iter().zip(dofs.chunks_exact(2)) {
        sum += *weight * Vec2::new(p[0], p[1]);
    }
    sum / total
}

/// The frame that a set of pinned dofs leaves to the body.
///
/// `is_fixed` has one entry per dof. A rotation is free if some rigid motion `v = t + ω J (X - c)` satisfies every
/// pinned dof with `ω ≠ 0`.
fn frame_of_pins(rest: &[f64], is_fixed: &[bool]) -> Option<Frame> {
    let pinned: Vec<usize> = (0..rest.len() / 2)
        .filter(|&node| is_fixed[2 * node] || is_fixed[2 * node + 1])
        .collect();
    match pinned.as_slice() {
        [] => Some(Frame::Free),
        [node] if is_fixed[2 * node] && is_fixed[2 * node + 1] => Some(Frame::Hinged(*node)),
        _ if holds_rotation(rest, is_fixed) => Some(Frame::Fixed),
        _ => None,
    }
}

/// The frame of a body under pins; one of large strain, which is stepped in the world's axes, may have any.
pub fn frame_of(rest: &[f64], is_fixed: &[bool], is_large: bool) -> Option<Frame> {
    frame_of_pins(rest, is_fixed).or(is_large.then_some(Frame::Fixed))
}

/// Whether the pinned dofs leave no rigid rotation about any centre.
fn holds_rotation(rest: &[f64], is_fixed: &[bool]) -> bool {
    // Rows [1, 0, -y] and [0, 1, x] act on (t_x, t_y, ω): the rotation is held when all x-rows do not share one y,
    // or all y-rows do not share one x, up to a billionth of the body's size and the rounding of its coordinates.
    let spread = |axis: usize, counts: &dyn Fn(usize) -> bool| {
        let nodes = (0..rest.len() / 2).filter(|&node| counts(node));
        let ends = nodes.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], node| {
            let at = rest[2 * node + axis];
            [low.min(at), high.max(at)]
        });
        ends[1] - ends[0]
    };
    let size = spread(0, &|_| true).max(spread(1, &|_| true));
    let far = rest.iter().fold(0.0f64, |far, x| far.max(x.abs()));
    let least = rounding::SHARE * size + 4.0 * f64::EPSILON * far;
    (0..2).any(|axis| spread(1 - axis, &|node| is_fixed[2 * node + axis]) > least)
}
