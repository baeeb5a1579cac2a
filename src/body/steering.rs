//! What a user changes on a body between steps. All of it wakes the body, but for a load or a pin that is set to what it is.

use super::build::check_range;
use super::error::{BuildError, FlexBodyError, check_finite, check_held};
use super::flex_body::FlexBody;
use super::frame::Arms;
use super::materials::{missing_law, number_of};
use super::region::Region;
use super::state::FlexState;
use super::stillness::Stillness;
use crate::fe::finite_strain::{
    FiniteStrainDescription, FiniteStrainError, FiniteStrainModel, InnerPressure, PressureError,
};
use crate::fe::material::Material;
use crate::fe::model::ModelDescription;
use crate::math::{Vec2, node_vec, perp, rotation, set_node_vec};
use std::sync::{Arc, OnceLock};

impl FlexBody {
    /// Sets a constant force on a node (N), until it is set again.
    ///
    /// # Errors
    /// If the node does not exist or the force is not finite.
    pub fn set_nodal_force(&mut self, node: usize, force: [f64; 2]) -> Result<(), FlexBodyError> {
        self.check_node(node)?;
        check_finite("the force", &force)?;
        let own = &mut self.nodal_force[2 * node..2 * node + 2];
        self.is_disturbed |= *own != force;
        own.copy_from_slice(&force);
        Ok(())
    }

    /// Sets the force per mass besides gravity (m/s²).
    ///
    /// # Errors
    /// If it is not finite, or rapier's precision cannot hold it.
    pub fn set_body_force(&mut self, acceleration: [f64; 2]) -> Result<(), FlexBodyError> {
        check_held("the body force", &acceleration)?;
        self.is_disturbed |= self.body_force != Vec2::from(acceleration);
        self.body_force = acceleration.into();
        Ok(())
    }

    /// Sets the factor on the world's gravity (-).
    ///
    /// # Errors
    /// If it is not finite, or rapier's precision cannot hold it.
    pub fn set_gravity_scale(&mut self, scale: f64) -> Result<(), FlexBodyError> {
        check_held("the gravity scale", &[scale])?;
        self.is_disturbed |= self.gravity_scale != scale;
        self.gravity_scale = scale;
        Ok(())
    }

    /// Prescribes the displacement of a pinned node (m); directions that are not pinned are ignored.
    ///
    /// # Errors
    /// If the node does not exist, is not pinned, or rapier's precision cannot hold the displacement.
    pub fn set_pin_displacement(
        &mut self,
        node: usize,
        displacement: [f64; 2],
    ) -> Result<(), FlexBodyError> {
        self.check_node(node)?;
        if !(self.is_fixed[2 * node] || self.is_fixed[2 * node + 1]) {
            return Err(FlexBodyError::NotPinned(node));
        }
        check_held("the displacement", &displacement)?;
        let own = &mut self.prescribed[2 * node..2 * node + 2];
        self.is_disturbed |= *own != displacement;
        own.copy_from_slice(&displacement);
        Ok(())
    }

    /// Sets all nodal velocities, interleaved (m/s); pinned directions stay at rest.
    ///
    /// # Errors
    /// If the length is not two per node or rapier's precision cannot hold a velocity.
    pub fn set_velocities(&mut self, velocities: &[f64]) -> Result<(), FlexBodyError> {
        if velocities.len() != self.state.velocity.len() {
            return Err(FlexBodyError::Length {
                name: "the velocities",
                found: velocities.len(),
                n_nodes: self.n_nodes(),
            });
        }
        check_held("the velocities", velocities)?;
        for ((own, &new), &is_fixed) in self
            .state
            .velocity
            .iter_mut()
            .zip(velocities)
            .zip(&self.is_fixed)
        {
            *own = if is_fixed { 0.0 } else { new };
        }
        self.velocity_changed();
        self.is_disturbed = true;
        Ok(())
    }

    /// Sets the velocity of the centre of mass (m/s): every node's changes by as much, and the body spins and vibrates as before. Pinned
    /// directions stay at rest, so that a pinned body reads back less.
    ///
    /// # Errors
    /// If rapier's precision cannot hold the velocity; nothing is then changed.
    pub fn set_linvel(&mut self, linvel: [f64; 2]) -> Result<(), FlexBodyError> {
        let change = Vec2::from(linvel) - Vec2::from(self.linvel());
        self.add_rigid_velocity("the velocity", change, 0.0)
    }

    /// Sets the angular velocity (rad/s), see [`FlexBody::angvel`]: the body turns about its centre of mass, which keeps its velocity, and
    /// vibrates as before. Pinned directions stay at rest.
    ///
    /// # Errors
    /// If rapier's precision cannot hold the velocity of a node; nothing is then changed.
    pub fn set_angvel(&mut self, angvel: f64) -> Result<(), FlexBodyError> {
        let change = angvel - self.angvel();
        self.add_rigid_velocity("the angular velocity", Vec2::zeros(), change)
    }

    /// Changes the linear momentum at once (N s), as [`RigidBody::apply_impulse`](crate::rapier::dynamics::RigidBody::apply_impulse) does: by the
    /// same velocity everywhere but in pinned directions, which stay at rest.
    ///
    /// # Errors
    /// If the impulse is not finite, or rapier's precision cannot hold the velocity; nothing is then changed.
    pub fn apply_impulse(&mut self, impulse: [f64; 2]) -> Result<(), FlexBodyError> {
        let change = Vec2::from(impulse) / self.mass();
        self.add_rigid_velocity("the impulse", change, 0.0)
    }

    /// Changes linear and angular momentum at once by an impulse (N s) along a line through a point of the world (m), as
    /// [`RigidBody::apply_impulse_at_point`](crate::rapier::dynamics::RigidBody::apply_impulse_at_point) does: the body moves as a whole, about
    /// its centre of mass, but for its pinned directions. [`FlexBody::apply_impulse_at_node`] deforms it.
    ///
    /// # Errors
    /// If a number is not finite, or rapier's precision cannot hold the velocity of a node; nothing is then changed.
    pub fn apply_impulse_at_point(
        &mut self,
        impulse: [f64; 2],
        point: [f64; 2],
    ) -> Result<(), FlexBodyError> {
        check_held("the point", &point)?;
        let arm = Vec2::from(point) - Vec2::from(self.centre_of_mass());
        let impulse = Vec2::from(impulse);
        let spin = perp(arm).dot(&impulse) / self.polar_moment();
        self.add_rigid_velocity("the impulse", impulse / self.mass(), spin)
    }

    /// Changes the angular momentum about the centre of mass at once (N m s): the body turns as a whole, but for its pinned directions.
    ///
    /// # Errors
    /// If the impulse is not finite, or rapier's precision cannot hold the velocity of a node; nothing is then changed.
    pub fn apply_torque_impulse(&mut self, torque_impulse: f64) -> Result<(), FlexBodyError> {
        let spin = torque_impulse / self.polar_moment();
        self.add_rigid_velocity("the impulse", Vec2::zeros(), spin)
    }

    /// Strikes a node with an impulse (N s): by a force all through the next step that the body takes part in, besides
    /// [`set_nodal_force`](FlexBody::set_nodal_force), from which waves run through the body. Several add up,
    /// [`nodal_impulses`](FlexBody::nodal_impulses) are those to come. A body that leaves the world for its numbers forgets them.
    ///
    /// # Errors
    /// If the node does not exist or the impulse is not finite; nothing is then changed.
    pub fn apply_impulse_at_node(
        &mut self,
        node: usize,
        impulse: [f64; 2],
    ) -> Result<(), FlexBodyError> {
        self.check_node(node)?;
        let own = &mut self.nodal_impulse[2 * node..2 * node + 2];
        let sum = [own[0] + impulse[0], own[1] + impulse[1]];
        check_finite("the impulse", &sum)?;
        own.copy_from_slice(&sum);
        self.is_disturbed = true;
        Ok(())
    }

    /// Makes the whole body of another material, its damping included; places and velocities stay. A deformed body has another elastic energy
    /// from then on, and one of another density another momentum.
    ///
    /// # Errors
    /// If the material is out of range, has no law for a body of large strain, flows by another law than the body, or makes the body one that cannot
    /// be computed; nothing is then changed.
    pub fn set_material(&mut self, material: impl Material + 'static) -> Result<(), BuildError> {
        material.validate()?;
        let material: Arc<dyn Material> = Arc::new(material);
        self.remake(|description| {
            description.material = Arc::clone(&material);
            description.regions.clear();
        })
    }

    /// Makes a region of the body of another material, as [`set_material`](Self::set_material) does all of it.
    ///
    /// # Errors
    /// As there, and if the mesh has no such region, or the material is damped in another way than the rest of the body.
    pub fn set_region_material(
        &mut self,
        region: impl Into<Region>,
        material: impl Material + 'static,
    ) -> Result<(), BuildError> {
        material.validate()?;
        let region = number_of(&region.into(), self.mesh())?;
        let material: Arc<dyn Material> = Arc::new(material);
        self.remake(|description| {
            description.regions.retain(|(own, _)| *own != region);
            description.regions.push((region, Arc::clone(&material)));
        })
    }

    /// Makes the body as thick (m); places and velocities stay.
    ///
    /// # Errors
    /// If the thickness is not positive, or makes the body one that cannot be computed; nothing is then changed.
    pub fn set_thickness(&mut self, thickness: f64) -> Result<(), BuildError> {
        self.remake(|description| description.thickness = thickness)
    }

    /// Puts another pressure into a hole (holes are numbered from zero, by their lowest corner); returns the work of the pump (J): by how much
    /// the stored energy rises. That of a constant pressure is none, it works in the steps to come.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// let mut tyre = FlexBodyBuilder::annulus(0.25, 0.3, 0.05)
    ///     .material(LinearElastic::plane_strain(2e6, 0.45).density(1100.0))
    ///     .build()?;
    /// let work = tyre.set_inner_pressure(0, InnerPressure::isothermal(2e4))?;
    /// assert!(work > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the body is one of small strain, has no such hole, or a number is out of its range; nothing is then changed.
    pub fn set_inner_pressure(
        &mut self,
        hole: usize,
        pressure: InnerPressure,
    ) -> Result<f64, BuildError> {
        let large = self.large.as_ref();
        let large = large.ok_or(BuildError::PressureSmallStrain)?;
        let stored = |large: &FiniteStrainModel| {
            let state = &self.state;
            large.energy_after(&state.position, &state.flowed).stored
        };
        let before = stored(large);
        let large = large.with_pressure(hole, pressure)?;
        self.state.elastic_energy = stored(&large);
        self.large = Some(Arc::new(large));
        self.stillness = Stillness::default();
        self.is_disturbed = true;
        Ok(self.state.elastic_energy - before)
    }

    /// Area of a hole (m²), and of which pressure (Pa) above that outside its gas is there; the latter is none in a body of small strain.
    fn hole(&self, hole: usize) -> Result<[f64; 2], BuildError> {
        let at = &self.state.position;
        let large = self.large.as_ref();
        let large = large.ok_or(BuildError::PressureSmallStrain)?;
        let found = large.hole_area(hole, at).zip(large.hole_pressure(hole, at));
        let n_holes = large.n_holes();
        let missing = FiniteStrainError::from(PressureError::Hole { hole, n_holes });
        found.map(<[f64; 2]>::from).ok_or(missing.into())
    }

    /// Area of a hole of a body of large strain as it is deformed (m²).
    ///
    /// # Errors
    /// If the body is one of small strain, or has no such hole.
    pub fn inner_area(&self, hole: usize) -> Result<f64, BuildError> {
        self.hole(hole).map(|[area, _]| area)
    }

    /// Pressure in a hole of a body of large strain above that outside (Pa), zero where there is none.
    ///
    /// # Errors
    /// If the body is one of small strain, or has no such hole.
    pub fn gas_pressure(&self, hole: usize) -> Result<f64, BuildError> {
        self.hole(hole).map(|[_, pressure]| pressure)
    }

    fn remake(&mut self, change: impl Fn(&mut ModelDescription)) -> Result<(), BuildError> {
        let model = self.model.remade(&change)?;
        check_range(&model)?;
        let other = self.other_model.as_ref();
        let other = other.map(|other| other.remade(&change)).transpose()?;
        let large = match &self.large {
            None => None,
            Some(before) => {
                let description = FiniteStrainDescription::of_model(&model);
                let mut description = description.ok_or_else(|| missing_law(&model))?;
                description.pressures = before.pressures().to_vec();
                Some(Arc::new(FiniteStrainModel::assemble(description)?))
            }
        };
        if let (Some(old), Some(new)) = (&self.large, &large)
            && !new.flows_as(old)
        {
            return Err(BuildError::FlowChanged);
        }
        let before = self.mass();
        self.arms = Arms::new(&model, self.frame);
        (self.model, self.large) = (Arc::new(model), large);
        self.other_model = other.map(Arc::new);
        self.frequency = OnceLock::new();
        self.state.elastic_energy = self.energy().elastic;
        self.velocity_changed();
        self.state.share_accelerations(before / self.mass());
        self.stillness = Stillness::default();
        self.is_disturbed = true;
        Ok(())
    }

    /// Adds a rigid motion to the velocities of all nodes.
    ///
    /// - `change`: of the centre of mass (m/s).
    /// - `spin`: about it (rad/s).
    fn add_rigid_velocity(
        &mut self,
        name: &'static str,
        change: Vec2,
        spin: f64,
    ) -> Result<(), FlexBodyError> {
        let centre = Vec2::from(self.centre_of_mass());
        let mut velocity = self.state.velocity.clone();
        for node in 0..self.n_nodes() {
            let arm = node_vec(&self.state.position, node) - centre;
            let own = node_vec(&velocity, node) + change + spin * perp(arm);
            set_node_vec(&mut velocity, node, own);
        }
        check_held(name, &velocity)?;
        self.set_velocities(&velocity)
    }

    /// Puts the body's centre of mass and its angle elsewhere, as it is: linear and angular velocity stay, deformation and vibrations turn
    /// along.
    pub(crate) fn place(&mut self, centre: Vec2, angle: f64) -> Result<(), FlexBodyError> {
        check_held("the angle", &[angle])?;
        let [from, mean] = [self.centre_of_mass(), self.linvel()].map(Vec2::from);
        let turn = rotation(angle - self.state.frame.angle);
        let mut positions = self.state.position.clone();
        for node in 0..self.n_nodes() {
            let place = centre + turn * (node_vec(&positions, node) - from);
            set_node_vec(&mut positions, node, place);
        }
        check_held("the position", &positions)?;
        let FlexState {
            position,
            velocity,
            frame,
            ..
        } = &mut self.state;
        *position = positions;
        for node in 0..velocity.len() / 2 {
            let own = mean + turn * (node_vec(velocity, node) - mean);
            set_node_vec(velocity, node, own);
        }
        frame.centre = centre + turn * (frame.centre - from);
        frame.angle = angle;
        self.velocity_changed();
        self.stillness = Stillness::default();
        (self.is_new, self.is_disturbed) = (true, true);
        Ok(())
    }

    /// Wakes the body, and with it all that it touches, at the next step.
    ///
    /// `IslandManager::wake_up` with [`FlexBody::rigid_body_handle`] does it at once.
    pub fn wake_up(&mut self) {
        self.is_disturbed = true;
    }

    fn check_node(&self, node: usize) -> Result<(), FlexBodyError> {
        let n_nodes = self.n_nodes();
        if node < n_nodes {
            Ok(())
        } else {
            Err(FlexBodyError::Node { node, n_nodes })
        }
    }
}
