//! The committed motion of a body: what a snapshot saves.
//!
//! `x = c + R(θ) (X + u)`: a rigid motion of the frame and a displacement `u` in it. The mass sees no rigid part in `u`:
//! `Σ m u = 0` and `Σ m X × u = 0`, which makes the split unique.

use super::frame::{Arms, Frame};
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::material::hyperelastic::PlasticState;
use crate::fe::model::Model;
use crate::math::{Vec2, cross, node_vec, perp, rotation, set_node_vec};

/// Rigid motion of a body's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct FrameMotion {
    /// Centre `c` (m).
    pub centre: Vec2,
    /// Its velocity (m/s).
    pub velocity: Vec2,
    /// Its acceleration (m/s²).
    pub acceleration: Vec2,
    /// Angle θ (rad).
    pub angle: f64,
    /// Angular velocity (rad/s).
    pub spin: f64,
    /// Angular acceleration (rad/s²).
    pub spin_rate: f64,
}

/// Energy of a body (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyEnergy {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Elastic energy, and that of gases shut in holes: the work they can do until they are at the pressure outside.
    pub elastic: f64,
}

/// What acts on a body besides contact.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct AppliedLoad {
    /// Nodal forces, interleaved (N).
    pub force: Vec<f64>,
    /// Gravity and body force (m/s²).
    pub gravity: Vec2,
}

impl AppliedLoad {
    /// Takes over a load.
    pub fn assign(&mut self, force: &[f64], gravity: Vec2) {
        self.force.clear();
        self.force.extend_from_slice(force);
        self.gravity = gravity;
    }
}

/// What the stored accelerations of a body of small strain know of its loads. A step takes the mean of the accelerations at its beginning and
/// its end: of a load that has jumped it brings less than its time, as much as it brings beyond that in the step in which it is gone.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct KnownLoads {
    /// At the end of the last step; without forces where nothing is known.
    pub last: AppliedLoad,
    /// Of which nothing is late.
    pub base: AppliedLoad,
    /// They are late by `1 - β1` of a step of this length (s).
    pub lag: f64,
}

/// Where the tangent was taken by whose factor the last step of a body of large strain was solved: it may serve for the next.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Linearized {
    /// World positions, interleaved (m); empty where none may serve.
    pub position: Vec<f64>,
    /// Length of the step (s).
    pub dt: f64,
}

impl Linearized {
    /// Lets the next step take its own.
    pub fn forget(&mut self) {
        self.position.clear();
        self.dt = 0.0;
    }
}

/// The committed motion of a flexible body; nodal vectors are interleaved.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct FlexState {
    /// World positions (m).
    pub position: Vec<f64>,
    /// World velocities (m/s).
    pub velocity: Vec<f64>,
    /// Motion of the frame.
    pub frame: FrameMotion,
    /// Displacement in the frame (m).
    pub displacement: Vec<f64>,
    /// Its rate (m/s).
    pub rate: Vec<f64>,
    /// Its second rate (m/s²), without hard contact forces.
    pub acceleration: Vec<f64>,
    /// What the accelerations know of loads.
    pub loads: KnownLoads,
    /// Torque of all forces about the centre at the end of the step (N m).
    pub torque: f64,
    /// Kinetic energy (J).
    pub kinetic_energy: f64,
    /// Elastic energy (J).
    pub elastic_energy: f64,
    /// What has flowed at the quadrature points; nothing of a body whose law does not flow.
    pub flowed: Vec<PlasticState>,
    /// What plastic flow has dissipated since the body was built (J).
    pub flow_energy: f64,
    /// Where the tangent of the last step was taken.
    pub linearized: Linearized,
    /// What pins had to give in the last step beside the forces at its end, or in its mean, for the body to have their velocities (N); empty where these
    /// stayed what they were.
    pub pin_push: Vec<f64>,
}

impl FlexState {
    /// A body that does not move where it was built; it has energy where it is stretched there, and where gases are shut in.
    pub(super) fn at_rest(model: &Model, large: Option<&FiniteStrainModel>, centre: Vec2) -> Self {
        let placed = model.placed_positions();
        let energy = |large: &FiniteStrainModel| match model.is_placed_at_rest() {
            true => large.rest_energy(),
            false => large.energy_after(placed, &large.virgin()).stored,
        };
        let zeros = vec![0.0; placed.len()];
        Self {
            position: placed.to_vec(),
            velocity: zeros.clone(),
            frame: FrameMotion {
                centre,
                ..FrameMotion::default()
            },
            displacement: zeros.clone(),
            rate: zeros.clone(),
            acceleration: zeros,
            loads: KnownLoads::default(),
            torque: 0.0,
            kinetic_energy: 0.0,
            elastic_energy: large.map_or(0.0, energy),
            flowed: Vec::new(),
            flow_energy: 0.0,
            linearized: Linearized::default(),
            pin_push: Vec::new(),
        }
    }

    /// Whether all accelerations are numbers.
    pub(super) fn has_finite_accelerations(&self) -> bool {
        let FrameMotion {
            acceleration,
            spin_rate,
            ..
        } = self.frame;
        let frame = [acceleration.x, acceleration.y, spin_rate, self.torque];
        let all = self.acceleration.iter().chain(&frame);
        all.into_iter().all(|x| x.is_finite())
    }

    /// Forgets all accelerations.
    pub(super) fn clear_accelerations(&mut self) {
        self.acceleration.fill(0.0);
        self.frame.acceleration = Vec2::zeros();
        self.frame.spin_rate = 0.0;
        self.torque = 0.0;
    }

    /// Takes over that the mass has grown by the factor `1/share`: forces of the last step that are still to come are as large as they were, and
    /// gravity has grown with it.
    pub(super) fn share_accelerations(&mut self, share: f64) {
        self.acceleration.iter_mut().for_each(|a| *a *= share);
        let gravity = self.loads.last.gravity;
        self.frame.acceleration = gravity + share * (self.frame.acceleration - gravity);
        self.frame.spin_rate *= share;
    }

    /// Forgets all velocities and accelerations.
    pub(super) fn stop(&mut self) {
        self.velocity.fill(0.0);
        self.rate.fill(0.0);
        (self.frame.velocity, self.frame.spin) = (Vec2::zeros(), 0.0);
        self.kinetic_energy = 0.0;
        self.clear_accelerations();
    }

    /// Splits world positions into the placement of the frame, whose centre is known, and displacements in it.
    ///
    /// Round-off would otherwise leave a rigid part in `u`, which a spinning frame would fling outwards.
    pub fn split_position(&mut self, arms: &Arms, kind: Frame) {
        if kind == Frame::Fixed {
            return;
        }
        let centre = self.frame.centre;
        let angle = arms.angle(&self.position, centre, self.frame.angle);
        self.frame.angle = angle;
        let back = rotation(-angle);
        for node in 0..self.position.len() / 2 {
            let u =
                back * (node_vec(&self.position, node) - centre) - node_vec(&arms.reference, node);
            set_node_vec(&mut self.displacement, node, u);
        }
        arms.remove_mean(kind, &mut self.displacement);
    }

    /// Splits world velocities into the motion of the frame, whose centre's velocity is known, and the rates
    /// `u̇ = Rᵀ(v - ċ) - ω J (X + u)` left in it.
    ///
    /// The centre keeps its own velocity to the last digit: the mean of fast vibrations is rounding, and would add up.
    pub fn split_velocity(&mut self, arms: &Arms, kind: Frame) {
        if kind == Frame::Fixed {
            self.rate.copy_from_slice(&self.velocity);
            (self.frame.velocity, self.frame.spin) = (Vec2::zeros(), 0.0);
            return;
        }
        let (position, velocity) = (&self.position, &self.velocity);
        let frame = &mut self.frame;
        let back = rotation(-frame.angle);
        let (mut momentum, mut inertia) = (0.0, 0.0);
        for (node, moment) in arms.mass_moment.chunks_exact(2).enumerate() {
            let moment = Vec2::new(moment[0], moment[1]);
            momentum += cross(moment, back * (node_vec(velocity, node) - frame.velocity));
            inertia += moment.dot(&(back * (node_vec(position, node) - frame.centre)));
        }
        frame.spin = momentum / inertia;
        for node in 0..velocity.len() / 2 {
            let arm = back * (node_vec(position, node) - frame.centre);
            let own = back * (node_vec(velocity, node) - frame.velocity) - frame.spin * perp(arm);
            set_node_vec(&mut self.rate, node, own);
        }
        arms.remove_mean(kind, &mut self.rate);
    }
}
