//! A flexible body as a block: what all of them have, and the method that steps it.
//!
//! Three methods answer the same questions: implicit steps of small strain in a co-rotating frame ([`SmallStrain`]), steps by central
//! difference ([`Explicit`]), and steps of large strain in world coordinates ([`LargeStrain`]).

use super::answer::Answer;
use super::compliance::Compliance;
use super::explicit::Explicit;
#[cfg(feature = "serde-serialize")]
use super::explicit_record::ExplicitRecord;
use super::large::LargeStrain;
use super::shape::Shape;
use super::shared::Shared;
use super::small::SmallStrain;
use crate::body::{FlexState, Frame};
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::material::Rayleigh;
use crate::fe::model::Model;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::Vec2;
use crate::system::rigid_way::RigidWay;
use crate::system::step::{FlexLoad, Step};
use std::sync::Arc;

/// What a block steps by.
#[derive(Debug)]
pub(super) enum Method {
    Small(Box<SmallStrain>),
    Explicit(Box<Explicit>),
    Large(Box<LargeStrain>),
}

/// The rebuildable half of a flexible body: factor, compliance and the vectors of one step.
#[derive(Debug)]
pub struct FlexBlock {
    pub(super) shared: Shared,
    pub(super) method: Method,
}

impl FlexBlock {
    /// Analyses the pattern of a model whose dofs in `is_fixed` are pinned.
    pub fn new(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let effective = model.stiffness().clone();
        let factor = BlockCholesky::analyze(&effective);
        let answer = Answer::new(effective, factor, Compliance::new(&model));
        let shape = Shape::new(model, is_fixed, kind);
        let method = Method::Small(Box::new(SmallStrain::new(&shape)));
        let shared = Shared::new(shape, answer);
        Self { shared, method }
    }

    /// A block for `β0 = 0`, of a body with lumped mass: the mesh is neither ordered nor factorized.
    pub fn explicit(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let shape = Shape::new(model, is_fixed, kind);
        let (explicit, stiffness) = Explicit::new(&shape);
        let factor = BlockCholesky::analyze(&stiffness);
        let answer = Answer::new(stiffness, factor, Compliance::default());
        Self {
            shared: Shared::new(shape, answer),
            method: Method::Explicit(Box::new(explicit)),
        }
    }

    /// A block of a body of large strain.
    pub fn large(
        model: Arc<Model>,
        large: Arc<FiniteStrainModel>,
        is_fixed: Vec<bool>,
        kind: Frame,
    ) -> Self {
        let (large, effective) = LargeStrain::new(large);
        let factor = BlockCholesky::analyze(&effective);
        let answer = Answer::new(effective, factor, Compliance::new(&model));
        Self {
            shared: Shared::new(Shape::new(model, is_fixed, kind), answer),
            method: Method::Large(Box::new(large)),
        }
    }

    /// Takes over a body of large strain of the same model, whose inner pressures may have changed; `false` if its matrix couples other nodes.
    pub fn take_large(&mut self, model: Option<&Arc<FiniteStrainModel>>) -> bool {
        match (&mut self.method, model) {
            (Method::Large(large), Some(model)) => large.take_over(model),
            (method, model) => model.is_none() && !matches!(method, Method::Large(_)),
        }
    }

    pub(super) fn large_strain(&self) -> Option<&LargeStrain> {
        match &self.method {
            Method::Large(large) => Some(large),
            _ => None,
        }
    }

    /// Whether the block steps by central difference.
    pub fn is_explicit(&self) -> bool {
        matches!(self.method, Method::Explicit(_))
    }

    /// Whether the body is one of large strain.
    pub fn is_large(&self) -> bool {
        matches!(self.method, Method::Large(_))
    }

    /// Whether a body of large strain may end the step in more ways than one under the same forces: the step is too long for it.
    pub fn is_ambiguous(&self) -> bool {
        self.large_strain().is_some_and(|large| large.is_ambiguous)
    }

    /// Whether the end of a step under given forces may be told not to be found once it is not found without detours.
    pub fn let_give_up(&mut self, may: bool) {
        if let Method::Large(large) = &mut self.method {
            large.may_give_up = may;
        }
    }

    /// The model the block was built for.
    pub fn model(&self) -> &Arc<Model> {
        &self.shared.shape.model
    }

    /// Size of the coordinates that round-off is relative to (m).
    pub fn extent(&self) -> f64 {
        self.shared.extent()
    }

    /// Largest side of the body at rest (m).
    pub fn size(&self) -> f64 {
        self.shared.shape.size
    }

    /// Least distance of the surface from itself at rest (m).
    pub fn clearance(&self) -> f64 {
        self.shared.shape.clearance
    }

    /// Whether some dofs are pinned.
    pub fn is_pinned(&self) -> bool {
        !self.shared.shape.fixed_dofs.is_empty()
    }

    /// Whether a node carries no mass.
    pub fn is_massless(&self, node: usize) -> bool {
        self.shared.shape.model.is_massless(node)
    }

    /// Whether the material damps.
    pub fn is_damped(&self) -> bool {
        let Rayleigh { mass, stiffness } = self.shared.shape.model.rayleigh();
        mass > 0.0 || stiffness > 0.0
    }

    /// Mass (kg) and polar inertia about the centre, at rest (kg m²).
    pub fn inertia(&self) -> (f64, f64) {
        (self.shared.shape.arms.mass, self.shared.shape.arms.polar)
    }

    /// Mass of the body (kg).
    pub fn mass(&self) -> f64 {
        self.shared.shape.arms.mass
    }

    /// Writes the accelerations that a new body's loads and spin give it from an unstrained start.
    ///
    /// They solve `A ü = f - C v + centripetal terms` instead of `M ü = ...`: the same to second order in the step for
    /// frequencies the step resolves, and nothing for those it does not, which would ring for ever.
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn start(
        &mut self,
        step: Step,
        state: &mut FlexState,
        load: &FlexLoad<'_>,
    ) -> Result<(), CholeskyError> {
        match &mut self.method {
            Method::Small(small) => small.start(&mut self.shared, step, state, load),
            Method::Explicit(explicit) => {
                explicit.start(state);
                Ok(())
            }
            // Their steps need no acceleration to begin with.
            Method::Large(_) => Ok(()),
        }
    }

    /// Takes over the motion of a body whose surface has just lost its mass.
    ///
    /// - `force`: on the nodes, interleaved (N).
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn lose_surface_mass(
        &mut self,
        step: Step,
        state: &mut FlexState,
        force: &[f64],
    ) -> Result<(), CholeskyError> {
        match &mut self.method {
            Method::Small(small) => small.lose_surface_mass(&mut self.shared, step, state, force),
            // The surface is balanced in each step, or keeps its mass.
            Method::Explicit(_) | Method::Large(_) => Ok(()),
        }
    }

    /// Begins a step: takes over the committed state and the loads, writes the operators and, if the weights are new,
    /// factorizes the effective matrix.
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn predict(
        &mut self,
        step: Step,
        state: &FlexState,
        load: &FlexLoad<'_>,
    ) -> Result<(), CholeskyError> {
        let shared = &mut self.shared;
        shared.begin(step, state, load);
        match &mut self.method {
            Method::Small(small) => small.predict(shared, state),
            Method::Explicit(explicit) => explicit.predict(shared, state),
            Method::Large(large) => large.predict(shared, state),
        }
    }

    /// Solves for the end of the step under the contact forces given, in the frame and with the inertial terms of the
    /// current iterate.
    ///
    /// Returns how far the frame's angle moved (rad), or that part of it that matters: a frame that hardly spins turns only
    /// the displacements.
    pub fn solve(&mut self) -> f64 {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.solve(shared),
            Method::Explicit(explicit) => {
                explicit.solve(shared);
                0.0
            }
            Method::Large(large) => large.solve(shared),
        }
    }

    /// Clears the contact forces of the iterate.
    pub fn clear_contact_force(&mut self) {
        if let Method::Explicit(explicit) = &mut self.method {
            explicit.clear_late_force();
        }
        self.shared.contact.clear();
    }

    /// Adds a contact force at a node (N) that acts at a lever from the centre (m).
    pub fn add_contact_force(&mut self, node: usize, force: Vec2, lever: Vec2) {
        self.shared.contact.add(node, force, lever);
    }

    /// Adds a contact force at a node (N). In an explicit step a force on a mass is an impulse at the forward increment;
    /// if `is_late`, that of a quasi-static contact, it accelerates the mass from the end of the step on.
    pub fn add_stage_force(&mut self, node: usize, force: Vec2, lever: Vec2, is_late: bool) {
        let is_late = is_late && !self.is_massless(node);
        match &mut self.method {
            Method::Explicit(explicit) if is_late => explicit.add_late_force(node, force),
            _ => self.shared.contact.add(node, force, lever),
        }
    }

    /// Adds to what the forces at hand stretch the body by, `Σ lever·force` (N m): a body of small strain is turned back by that.
    pub fn stretch_by(&mut self, stretch: f64) {
        self.shared.contact.stretch += stretch;
    }

    /// Puts the iterate back to the beginning of the step.
    pub fn restart(&mut self) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.restart(shared),
            Method::Explicit(explicit) => explicit.restart(shared),
            Method::Large(large) => large.restart(shared),
        }
    }

    /// Ends the step where it began, without velocities.
    pub fn hold(&mut self) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.hold(shared),
            Method::Explicit(explicit) => explicit.hold(shared),
            Method::Large(large) => large.move_on(shared, Vec2::zeros(), 0.0),
        }
    }

    /// Ends the step where it began, moving as a rigid body with this velocity of its centre (m/s) and spin (rad/s); implicit steps only.
    pub fn move_on(&mut self, velocity: Vec2, spin: f64) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.move_on(shared, velocity, spin),
            Method::Explicit(explicit) => explicit.hold(shared),
            Method::Large(large) => large.move_on(shared, velocity, spin),
        }
    }

    /// Ends the step as a rigid motion leads it, undeformed further; free bodies in implicit steps only.
    pub fn carry_on(&mut self, way: &RigidWay) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.carry_on(shared, way),
            Method::Explicit(explicit) => explicit.hold(shared),
            Method::Large(large) => large.carry_on(shared, way),
        }
    }

    /// Puts the nodes where the step could go (m), with the velocities and accelerations that its forces lead to.
    pub fn stop_at(&mut self, positions: &[f64]) {
        match &mut self.method {
            Method::Large(large) => large.stop_at(&mut self.shared, positions),
            _ => SmallStrain::stop_at(&mut self.shared, positions),
        }
    }

    /// Tells where the base of the path is (m); what is led goes on from there. Returns how far that is, relative to the body's size.
    ///
    /// - `leads`: whether the body is to be led from now on, if this is the last part of a step.
    pub fn set_base(&mut self, positions: &[f64], leads: bool) -> f64 {
        match &mut self.method {
            Method::Large(large) => large.set_base(&mut self.shared, positions, leads),
            _ => 0.0,
        }
    }

    /// Whether the iterate is what one Newton step from the base finds.
    pub fn is_led(&self) -> bool {
        self.large_strain().is_some_and(LargeStrain::is_led)
    }

    /// Share of the way from the base to the iterate that may be gone (-).
    pub fn part_ahead(&self) -> f64 {
        self.large_strain().map_or(1.0, LargeStrain::part_ahead)
    }

    /// Puts what is led to the base, a place that was looked at.
    pub fn end_at_base(&mut self) {
        if let Method::Large(large) = &mut self.method {
            large.end_at_base(&mut self.shared);
        }
    }

    /// World velocities of the last iterate: nothing asks for them before.
    pub fn place_velocities(&mut self) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.place_velocities(shared),
            Method::Explicit(_) => {}
            // They have followed the positions.
            Method::Large(large) => large.place_velocities(shared),
        }
    }

    /// Measures the elastic energy of the iterate, before anything but positions has been corrected.
    pub fn measure_elastic_energy(&mut self) {
        let shared = &mut self.shared;
        match &mut self.method {
            Method::Small(small) => small.measure_elastic_energy(shared),
            // One product gives this energy and the forces of the end.
            Method::Explicit(explicit) => explicit.finish(shared),
            Method::Large(large) => large.measure_elastic_energy(shared),
        }
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, state: &mut FlexState) {
        let shared = &self.shared;
        match &self.method {
            Method::Small(small) => small.commit(shared, state),
            Method::Explicit(explicit) => explicit.commit(shared, state),
            Method::Large(large) => large.commit(shared, state),
        }
    }

    /// The memory of a block that steps by central difference.
    #[cfg(feature = "serde-serialize")]
    pub(crate) fn explicit_record(&self) -> Option<ExplicitRecord> {
        match &self.method {
            Method::Explicit(explicit) => Some(ExplicitRecord::of(explicit, &self.shared)),
            _ => None,
        }
    }

    /// Gives a new block the memory of another one; returns whether it fits.
    #[cfg(feature = "serde-serialize")]
    pub(crate) fn recall(&mut self, record: ExplicitRecord) -> bool {
        match &mut self.method {
            Method::Explicit(explicit) => record.recall(explicit, &mut self.shared),
            _ => false,
        }
    }
}
