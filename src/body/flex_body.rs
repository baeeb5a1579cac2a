//! A flexible body: its model, its committed motion, its loads, and what the last step told about it.

use super::contact_settings::ContactSettings;
use super::frame::{Arms, Frame};
use super::kept_force::KeptForce;
use super::state::{BodyEnergy, FlexState};
use super::stillness::Stillness;
use super::surface_mass::{Measured, take_over};
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::mesh::Mesh;
use crate::fe::model::Model;
use crate::math::{Vec2, cross, node_vec, perp, set_node_vec};
use crate::rapier::prelude::{ColliderHandle, RigidBodyHandle};
use std::sync::{Arc, OnceLock};

/// A flexible body.
#[derive(Debug)]
pub struct FlexBody {
    pub(super) model: Arc<Model>,
    /// The one without mass on its surface while the body is stepped by one with it, and the other way round; none of bodies that change neither way.
    pub(super) other_model: Option<Arc<Model>>,
    pub(super) large: Option<Arc<FiniteStrainModel>>,
    pub(super) frame: Frame,
    pub(super) arms: Arms,
    pub(super) is_fixed: Vec<bool>,
    pub(super) prescribed: Vec<f64>,
    pub(super) nodal_force: Vec<f64>,
    /// Of the step to come (N s).
    pub(super) nodal_impulse: Vec<f64>,
    pub(super) body_force: Vec2,
    pub(super) gravity_scale: f64,
    pub(super) contact: ContactSettings,
    pub(super) carrier_contact: ContactSettings,
    /// Anything the user wants to keep with the body.
    pub user_data: u128,
    pub(super) state: FlexState,
    pub(super) is_started: bool,
    pub(super) contact_force: Vec<f64>,
    pub(super) reaction: Vec<f64>,
    pub(super) energy_reserve: f64,
    pub(super) kept_forces: Vec<KeptForce>,
    /// Steps on end that were not finished.
    pub(super) n_unfinished: u32,
    pub(super) stillness: Stillness,
    pub(super) frequency: OnceLock<f64>,
    pub(super) carrier: RigidBodyHandle,
    pub(super) collider: ColliderHandle,
    pub(super) is_disturbed: bool,
    pub(super) is_quarantined: bool,
    /// Whether no step has been taken with it since it came into the world, or was put where it is.
    pub(super) is_new: bool,
    /// Calls of `pin_where` that chose no node.
    pub(super) n_idle_pins: usize,
}

impl FlexBody {
    pub(super) fn new(
        (model, large): (Arc<Model>, Option<Arc<FiniteStrainModel>>),
        is_fixed: Vec<bool>,
        frame: Frame,
        contact: ContactSettings,
        user_data: u128,
    ) -> Self {
        let zeros = vec![0.0; model.n_dofs()];
        let arms = Arms::new(&model, frame);
        let state = FlexState::at_rest(&model, large.as_deref(), arms.origin);
        Self {
            frame,
            is_fixed,
            prescribed: zeros.clone(),
            nodal_force: zeros.clone(),
            nodal_impulse: zeros.clone(),
            body_force: Vec2::zeros(),
            gravity_scale: 1.0,
            contact,
            carrier_contact: contact,
            user_data,
            state: FlexState {
                flowed: large.as_ref().map_or_else(Vec::new, |large| large.virgin()),
                ..state
            },
            arms,
            is_started: false,
            contact_force: zeros.clone(),
            reaction: zeros,
            energy_reserve: 0.0,
            kept_forces: Vec::new(),
            n_unfinished: 0,
            stillness: Stillness::default(),
            frequency: OnceLock::new(),
            carrier: RigidBodyHandle::invalid(),
            collider: ColliderHandle::invalid(),
            is_disturbed: false,
            is_quarantined: false,
            is_new: true,
            n_idle_pins: 0,
            model,
            other_model: None,
            large,
        }
    }

    pub(super) fn set_initial_velocity(&mut self, velocity: &[f64]) {
        self.state.velocity.copy_from_slice(velocity);
        for (velocity, &is_fixed) in self.state.velocity.iter_mut().zip(&self.is_fixed) {
            if is_fixed {
                *velocity = 0.0;
            }
        }
        self.velocity_changed();
    }

    /// Brings the split and the kinetic energy up to date with the nodal velocities.
    pub(super) fn velocity_changed(&mut self) {
        // Not the old centre's: what was refused for its size would leave its rounding.
        let near = node_vec(&self.state.velocity, 0);
        self.state.frame.velocity = self.arms.centre(self.frame, &self.state.velocity, near);
        self.state.split_velocity(&self.arms, self.frame);
        let velocity = &self.state.velocity;
        self.state.kinetic_energy = 0.5 * self.model.mass().inner(velocity, velocity);
    }

    pub(super) fn load(&mut self, nodal_force: Vec<f64>, body_force: Vec2, gravity_scale: f64) {
        self.nodal_force = nodal_force;
        self.body_force = body_force;
        self.gravity_scale = gravity_scale;
    }

    /// The assembled body of large strain, if its material has a law for that; [`model`](Self::model) is it at rest then.
    pub fn large(&self) -> Option<&Arc<FiniteStrainModel>> {
        self.large.as_ref()
    }

    /// The assembled model. Bodies of small strain have one whose surface has no mass while something may touch or holds them, see
    /// [`ContactInertia::Redistributed`](super::ContactInertia::Redistributed).
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Whether its surface has mass at some times and none at others.
    pub(crate) fn changes_mass(&self) -> bool {
        self.other_model.is_some()
    }

    /// The model while nothing touches the body.
    pub(crate) fn free_model(&self) -> &Arc<Model> {
        let other = self.other_model.as_ref();
        other
            .filter(|_| self.model.has_massless_nodes())
            .unwrap_or(&self.model)
    }

    /// The model while something touches the body, and in explicit steps.
    pub(crate) fn touched_model(&self) -> &Arc<Model> {
        let other = self.other_model.as_ref();
        other
            .filter(|_| !self.model.has_massless_nodes())
            .unwrap_or(&self.model)
    }

    /// Whether a model is one of the body's.
    pub(crate) fn has_model(&self, model: &Arc<Model>) -> bool {
        let mut both = self.other_model.iter().chain([&self.model]);
        both.any(|own| Arc::ptr_eq(own, model))
    }

    /// Lets the surface have no mass, or its own, if the body is one that changes between these and its motion can go on so.
    ///
    /// - `insists`: whether it has to.
    ///
    /// Returns whether it has changed.
    pub(crate) fn set_touched(&mut self, is_touched: bool, insists: bool) -> bool {
        if self.model.has_massless_nodes() == is_touched {
            return false;
        }
        let Some(other) = &self.other_model else {
            return false;
        };
        let arms = Arms::new(other, self.frame);
        let measured = [(&self.model, &self.arms), (other, &arms)]
            .map(|(model, arms)| Measured { model, arms });
        let goes_on = take_over(
            &mut self.state,
            self.frame,
            &self.is_fixed,
            measured,
            insists,
        );
        if goes_on {
            self.other_model = Some(std::mem::replace(&mut self.model, Arc::clone(other)));
            self.arms = arms;
        }
        goes_on
    }

    /// The mesh, in its own coordinates.
    pub fn mesh(&self) -> &Mesh {
        self.model.mesh()
    }

    /// The rigid body that carries the surface in rapier.
    pub fn rigid_body_handle(&self) -> RigidBodyHandle {
        self.carrier
    }

    /// The collider that is the surface in rapier.
    pub fn collider_handle(&self) -> ColliderHandle {
        self.collider
    }

    /// How the surface meets others.
    pub fn contact_settings(&self) -> &ContactSettings {
        &self.contact
    }

    /// How the body's frame moves.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Which dofs are pinned, interleaved.
    pub fn fixed_dofs(&self) -> &[bool] {
        &self.is_fixed
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.model.n_nodes()
    }

    /// Position of a node in the world (m).
    ///
    /// # Panics
    /// If the node does not exist, as the other accessors by node.
    pub fn position(&self, node: usize) -> [f64; 2] {
        node_vec(&self.state.position, node).into()
    }

    /// Positions of all nodes, interleaved (m).
    pub fn positions(&self) -> &[f64] {
        &self.state.position
    }

    /// Displacement of a node from where it was built (m).
    pub fn displacement(&self, node: usize) -> [f64; 2] {
        (node_vec(&self.state.position, node) - node_vec(self.model.placed_positions(), node))
            .into()
    }

    /// Velocity of a node (m/s).
    pub fn velocity(&self, node: usize) -> [f64; 2] {
        node_vec(&self.state.velocity, node).into()
    }

    /// Velocities of all nodes, interleaved (m/s).
    pub fn velocities(&self) -> &[f64] {
        &self.state.velocity
    }

    /// The committed motion.
    pub fn state(&self) -> &FlexState {
        &self.state
    }

    /// Angle of the co-rotating frame from where the body was built (rad).
    pub fn angle(&self) -> f64 {
        self.state.frame.angle
    }

    /// Mass (kg).
    pub fn mass(&self) -> f64 {
        self.arms.mass
    }

    /// Centre of mass (m).
    pub fn centre_of_mass(&self) -> [f64; 2] {
        self.mean(&self.state.position).into()
    }

    /// Velocity of the centre of mass (m/s).
    pub fn linvel(&self) -> [f64; 2] {
        self.mean(&self.state.velocity).into()
    }

    /// Angular velocity (rad/s): that of a rigid body of the same masses and places with the same angular momentum about the centre of mass.
    pub fn angvel(&self) -> f64 {
        self.angular_momentum(self.centre_of_mass()) / self.polar_moment()
    }

    /// Moment of inertia about the centre of mass, as the body is deformed (kg m²).
    pub fn polar_moment(&self) -> f64 {
        let centre = self.mean(&self.state.position);
        let mut turning = vec![0.0; self.model.n_dofs()];
        for node in 0..self.n_nodes() {
            let arm = node_vec(&self.state.position, node) - centre;
            set_node_vec(&mut turning, node, perp(arm));
        }
        let mass = self.model.mass();
        mass.moment(centre, &self.state.position, &turning)
    }

    fn mean(&self, dofs: &[f64]) -> Vec2 {
        let masses = self.arms.node_mass.iter().enumerate();
        let sum: Vec2 = masses
            .map(|(node, mass)| *mass * node_vec(dofs, node))
            .sum();
        sum / self.arms.mass
    }

    /// Linear momentum (N s).
    pub fn momentum(&self) -> [f64; 2] {
        (self.arms.mass * self.mean(&self.state.velocity)).into()
    }

    /// Angular momentum about a point (N m s).
    pub fn angular_momentum(&self, about: [f64; 2]) -> f64 {
        self.model
            .mass()
            .moment(about.into(), &self.state.position, &self.state.velocity)
    }

    /// Displacements in the body's frame, interleaved (m): deformation without rigid motion for a free body.
    pub fn local_displacements(&self) -> &[f64] {
        &self.state.displacement
    }

    /// Kinetic and elastic energy (J).
    pub fn energy(&self) -> BodyEnergy {
        BodyEnergy {
            kinetic: 0.5
                * self
                    .model
                    .mass()
                    .inner(&self.state.velocity, &self.state.velocity),
            elastic: self.elastic_energy(),
        }
    }

    /// Force of contacts and attachments on a node in the last step (N).
    pub fn contact_force(&self, node: usize) -> [f64; 2] {
        node_vec(&self.contact_force, node).into()
    }

    /// Sum of the forces of contacts and attachments in the last step (N): what a contact presses with and an attachment holds it against sums up to
    /// zero. Each by itself is in [`StepReport::contacts`](crate::pipeline::StepReport::contacts) and
    /// [`joints`](crate::pipeline::StepReport::joints).
    pub fn total_contact_force(&self) -> [f64; 2] {
        sum_of_nodes(&self.contact_force).into()
    }

    /// Force that a pinned node's support exerts on the body (N): of bodies of large strain its mean over the last step, of others that at its end, with
    /// what pins that speed up give beside it in the step. Of a step that was cut it is the mean of its parts.
    pub fn reaction(&self, node: usize) -> [f64; 2] {
        node_vec(&self.reaction, node).into()
    }

    /// Sum of all support forces (N).
    pub fn total_reaction(&self) -> [f64; 2] {
        sum_of_nodes(&self.reaction).into()
    }

    /// Moment of all support forces about a point (N m).
    pub fn reaction_moment(&self, about: [f64; 2]) -> f64 {
        (0..self.n_nodes())
            .map(|node| {
                let arm = node_vec(&self.state.position, node) - Vec2::from(about);
                cross(arm, node_vec(&self.reaction, node))
            })
            .sum()
    }

    /// Whether the body is out of the world because its motion would not have been finite: it waits as the last sound step left it, until
    /// it is mended and [`FlexBodySet::reinstate`](super::FlexBodySet::reinstate) is called.
    pub fn is_quarantined(&self) -> bool {
        self.is_quarantined
    }

    /// Factor on the world's gravity (-).
    pub fn gravity_scale(&self) -> f64 {
        self.gravity_scale
    }

    /// Force per mass besides gravity (m/s²).
    pub fn body_force(&self) -> [f64; 2] {
        self.body_force.into()
    }

    /// Forces on nodes, interleaved (N).
    pub fn nodal_forces(&self) -> &[f64] {
        &self.nodal_force
    }

    /// Impulses that strike nodes in the next step, interleaved (N s).
    pub fn nodal_impulses(&self) -> &[f64] {
        &self.nodal_impulse
    }
}

fn sum_of_nodes(dofs: &[f64]) -> Vec2 {
    dofs.chunks_exact(2)
        .map(|value| Vec2::new(value[0], value[1]))
        .sum()
}
