//! Building: a description is checked, assembled and given its initial motion.

use super::builder::FlexBodyBuilder;
use super::contact_inertia::ContactInertia;
use super::error::BuildError;
use super::flex_body::FlexBody;
use super::frame::{Frame, frame_of};
use super::materials::check_large_laws;
use super::placing;
use crate::fe::finite_strain::{
    FiniteStrainDescription, FiniteStrainError, FiniteStrainModel, InnerPressure,
};
use crate::fe::material::Material;
use crate::fe::mesh::Mesh;
use crate::fe::model::{MassKind, Model, ModelDescription};
use crate::math::{Vec2, is_held, perp};
use std::sync::Arc;

impl FlexBodyBuilder {
    /// Checks everything and assembles the body, not yet in any world.
    ///
    /// # Errors
    /// [`BuildError`], naming what is wrong and the cure.
    pub fn build(self) -> Result<FlexBody, BuildError> {
        self.check_numbers()?;
        let mesh = self.mesh.clone()?;
        let (material, regions) = self.materials.clone().resolve(&mesh)?;
        let n_nodes = mesh.n_nodes();
        let is_fixed = self.fixed_dofs(n_nodes)?;
        let pose = (self.rotation, self.translation);
        let placed = placing::placed(&mesh, pose, [1.0; 2]);
        placing::check_places(&placed)?;
        let stretches = self.pre_stretches(&material, &regions)?;
        let rest = stretches.map(|stretches| placing::placed(&mesh, pose, stretches));
        if let Some(rest) = &rest {
            placing::check_unstretched(rest)?;
        }
        let (rest, placed_positions) = match rest {
            Some(rest) => (rest, placed.clone()),
            None => (placed.clone(), Vec::new()),
        };
        let large = self.large_description(&mesh, &rest, &material, &regions)?;
        let frame =
            frame_of(&placed, &is_fixed, large.is_some()).ok_or(BuildError::RotatingPins)?;
        let massless = match large {
            // What the two ends of a step share of its stress lets nodes without mass swing for ever.
            Some(_) => vec![false; n_nodes],
            None => self.massless_nodes(&mesh, &is_fixed, frame)?,
        };
        let model = Model::assemble(ModelDescription {
            rest_positions: rest,
            placed_positions,
            mesh,
            elements: self.elements.clone(),
            material,
            regions,
            thickness: self.thickness,
            mass_kind: self.mass_kind,
            massless,
            held: (0..n_nodes)
                .map(|node| is_fixed[2 * node] && is_fixed[2 * node + 1])
                .collect(),
        })?;
        check_range(&model)?;
        let large = large.map(FiniteStrainModel::assemble).transpose()?;
        let nodal_force = self.gather_nodal_forces(n_nodes)?;
        // Until something touches it, the surface has its mass.
        let is_lasting = matches!(self.contact_inertia, ContactInertia::RedistributedAt(_));
        let (model, touched) = match model.has_massless_nodes() && !is_lasting {
            true => (model.remade(|of| of.massless.fill(false))?, Some(model)),
            false => (model, None),
        };
        let mut body = FlexBody::new(
            (Arc::new(model), large.map(Arc::new)),
            is_fixed,
            frame,
            self.contact,
            self.user_data,
        );
        body.set_initial_velocity(&self.initial_velocity(&body, &placed)?);
        body.load(nodal_force, self.body_force, self.gravity_scale);
        body.n_idle_pins = self.n_idle_pins;
        body.other_model = touched.map(Arc::new);
        Ok(body)
    }

    /// How far the body is stretched where it is built; `None` if it is not.
    fn pre_stretches(
        &self,
        material: &Arc<dyn Material>,
        regions: &[(u32, Arc<dyn Material>)],
    ) -> Result<Option<[f64; 2]>, BuildError> {
        match self.pre_stretch {
            None => Ok(None),
            Some(_) if self.is_large == Some(false) => Err(BuildError::PreStretchSmallStrain),
            Some(asked) => {
                let stretches = asked.stretches(material, regions)?;
                Ok(Some(stretches).filter(|stretches| *stretches != [1.0; 2]))
            }
        }
    }

    /// The body of large strain, unless the user has chosen small strain, or asked for what bodies of small strain alone have and for nothing
    /// that only the others have.
    ///
    /// A material without a law for large strains decides nothing by itself: what a body does would depend on what its material lacks.
    fn large_description(
        &self,
        mesh: &Arc<Mesh>,
        rest: &[f64],
        material: &Arc<dyn Material>,
        regions: &[(u32, Arc<dyn Material>)],
    ) -> Result<Option<FiniteStrainDescription>, BuildError> {
        let pressures = self.pressures(mesh)?;
        if self.is_large == Some(false) {
            let mut all = regions.iter().map(|(_, own)| own).chain([material]);
            let flowing = all.find_map(|one| {
                let law = one.hyperelastic()?;
                law.plasticity().is_some().then(|| law.name())
            });
            return match flowing {
                Some(law) => Err(BuildError::FlowSmallStrain { law }),
                None if pressures.is_empty() => Ok(None),
                None => Err(BuildError::PressureSmallStrain),
            };
        }
        let mut materials = regions.iter().map(|(_, own)| own).chain([material]);
        let is_asked = self.is_large == Some(true)
            || materials.any(|own| own.hyperelastic().is_some())
            || !pressures.is_empty()
            || self.pre_stretch.is_some();
        let refusal = match (self.mass_kind, &self.contact_inertia) {
            (MassKind::Consistent, _) => Some(BuildError::LargeConsistent),
            (_, ContactInertia::RedistributedAt(_)) => Some(BuildError::LargeMassless),
            _ => None,
        };
        match refusal {
            Some(_) if !is_asked => return Ok(None),
            Some(refusal) => return Err(refusal),
            None => check_large_laws(material.as_ref(), regions)?,
        }
        let description = FiniteStrainDescription::of_material(
            Arc::clone(mesh),
            rest.to_vec(),
            &self.elements,
            material.as_ref(),
            self.thickness,
        );
        let mut description =
            description.and_then(|description| description.with_region_materials(regions));
        if let Some(description) = &mut description {
            description.pressures = pressures;
        }
        Ok(description)
    }

    /// Pressures in the holes of the mesh, if there is to be one.
    fn pressures(&self, mesh: &Mesh) -> Result<Vec<InnerPressure>, BuildError> {
        let Some(pressure) = self.inner_pressure else {
            return Ok(Vec::new());
        };
        pressure.validate().map_err(FiniteStrainError::from)?;
        match mesh.boundary().loops().len() {
            0 | 1 => Err(BuildError::NoHole),
            n_loops => Ok(vec![pressure; n_loops - 1]),
        }
    }

    fn check_numbers(&self) -> Result<(), BuildError> {
        if let Some(pre_stretch) = &self.pre_stretch {
            pre_stretch.check()?;
        }
        let finite = "give a finite number";
        let positive = "give zero or a positive finite number";
        let numbers = [
            ("translation.x", self.translation.x),
            ("translation.y", self.translation.y),
            ("rotation", self.rotation),
            ("linvel.x", self.linvel.x),
            ("linvel.y", self.linvel.y),
            ("angvel", self.angvel),
            ("body_force.x", self.body_force.x),
            ("body_force.y", self.body_force.y),
            ("gravity_scale", self.gravity_scale),
        ];
        for (name, value) in numbers {
            if !value.is_finite() {
                return Err(BuildError::Number {
                    name,
                    value,
                    cure: finite,
                });
            }
        }
        let contact = [
            ("friction", self.contact.friction),
            ("restitution", self.contact.restitution),
            ("contact_skin", self.contact.contact_skin),
        ];
        for (name, value) in contact {
            if !(value.is_finite() && value >= 0.0) {
                return Err(BuildError::Number {
                    name,
                    value,
                    cure: positive,
                });
            }
        }
        if self.contact.contact_force_event_threshold.is_nan() {
            return Err(BuildError::Number {
                name: "contact_force_event_threshold",
                value: f64::NAN,
                cure: "give a number, or infinity for no events",
            });
        }
        // In rapier's precision a large number, or its square, may be infinite.
        let held = [
            ("translation.x", self.translation.x),
            ("translation.y", self.translation.y),
            ("rotation", self.rotation),
            ("linvel.x", self.linvel.x),
            ("linvel.y", self.linvel.y),
            ("angvel", self.angvel),
            ("body_force.x", self.body_force.x),
            ("body_force.y", self.body_force.y),
            ("gravity_scale", self.gravity_scale),
            ("friction", self.contact.friction),
            ("restitution", self.contact.restitution),
            ("contact_skin", self.contact.contact_skin),
        ];
        for (name, value) in held {
            if !is_held(value) {
                return Err(BuildError::Number {
                    name,
                    value,
                    cure: "give a number that rapier's precision can hold",
                });
            }
        }
        Ok(())
    }

    fn fixed_dofs(&self, n_nodes: usize) -> Result<Vec<bool>, BuildError> {
        let mut is_fixed = vec![false; 2 * n_nodes];
        for &(node, pin) in &self.pins {
            if node >= n_nodes {
                return Err(BuildError::Node {
                    name: "pin",
                    node,
                    n_nodes,
                });
            }
            is_fixed[2 * node] |= pin.x;
            is_fixed[2 * node + 1] |= pin.y;
        }
        Ok(is_fixed)
    }

    fn massless_nodes(
        &self,
        mesh: &Mesh,
        is_fixed: &[bool],
        frame: Frame,
    ) -> Result<Vec<bool>, BuildError> {
        let n_nodes = mesh.n_nodes();
        let chosen = match (&self.contact_inertia, self.mass_kind) {
            (ContactInertia::Kept, _) | (ContactInertia::Redistributed, MassKind::Consistent) => {
                &[][..]
            }
            (ContactInertia::Redistributed, _) => mesh.boundary().nodes(),
            (ContactInertia::RedistributedAt(nodes), _) => nodes,
        };
        let mut massless = vec![false; n_nodes];
        for &node in chosen {
            if node >= n_nodes {
                return Err(BuildError::Node {
                    name: "contact_inertia",
                    node,
                    n_nodes,
                });
            }
            massless[node] = !(is_fixed[2 * node] && is_fixed[2 * node + 1]);
        }
        // The mass needs a free node inside to carry it, and a body that may turn about its centre two of them, or its
        // rotation would have no inertia. Without them the boundary keeps its mass.
        let carries =
            |node: &usize| !(massless[*node] || (is_fixed[2 * node] && is_fixed[2 * node + 1]));
        let needed = if frame == Frame::Free { 2 } else { 1 };
        if (0..n_nodes).filter(carries).count() < needed {
            massless.fill(false);
        }
        Ok(massless)
    }

    fn gather_nodal_forces(&self, n_nodes: usize) -> Result<Vec<f64>, BuildError> {
        let mut force = vec![0.0; 2 * n_nodes];
        for &(node, value) in &self.nodal_forces {
            if node >= n_nodes {
                return Err(BuildError::Node {
                    name: "nodal_force",
                    node,
                    n_nodes,
                });
            }
            for axis in 0..2 {
                if !value[axis].is_finite() {
                    return Err(BuildError::Number {
                        name: "nodal_force",
                        value: value[axis],
                        cure: "give a finite force",
                    });
                }
                force[2 * node + axis] += value[axis];
            }
        }
        Ok(force)
    }

    fn initial_velocity(&self, body: &FlexBody, placed: &[f64]) -> Result<Vec<f64>, BuildError> {
        let n_nodes = placed.len() / 2;
        let centre: Vec2 = body.centre_of_mass().into();
        let mut velocity = Vec::with_capacity(placed.len());
        for point in placed.chunks_exact(2) {
            let v = self.linvel + self.angvel * perp(Vec2::new(point[0], point[1]) - centre);
            velocity.extend([v.x, v.y]);
        }
        if let Some(own) = &self.velocities {
            if own.len() != n_nodes {
                return Err(BuildError::Length {
                    name: "velocities",
                    found: own.len(),
                    n_nodes,
                });
            }
            for (v, own) in velocity.chunks_exact_mut(2).zip(own) {
                for axis in 0..2 {
                    if !own[axis].is_finite() {
                        return Err(BuildError::Number {
                            name: "velocities",
                            value: own[axis],
                            cure: "give finite velocities",
                        });
                    }
                    v[axis] += own[axis];
                }
            }
        }
        if let Some(&value) = velocity.iter().find(|&&value| !is_held(value)) {
            return Err(BuildError::Number {
                name: "the velocity of a node",
                value,
                cure: "give a linvel, angvel and velocities that come to no more than 1e18 m/s at any node",
            });
        }
        Ok(velocity)
    }
}

/// Mass (kg) and trace of the stiffness (N/m) beyond which products of theirs overflow, or vanish.
const RANGE: std::ops::RangeInclusive<f64> = 1e-36..=1e36;

/// Refuses a body whose mass or stiffness is zero, infinite or near to either.
pub(super) fn check_range(model: &Model) -> Result<(), BuildError> {
    let mass: f64 = model.mass().node_sums().iter().sum();
    let own = |node| model.stiffness().block(node, node);
    let traces = (0..model.n_nodes()).map(|node| own(node).map_or(0.0, |b| b[0] + b[3]));
    for (name, value) in [("mass", mass), ("stiffness", traces.sum())] {
        if !RANGE.contains(&value) {
            return Err(BuildError::OutOfRange { name, value });
        }
    }
    Ok(())
}
