//! The description of a flexible body, checked when it is built.

use super::error::BuildError;
use super::flex_body::{ContactSettings, FlexBody};
use super::frame::frame_of_pins;
use super::pin::Pin;
use crate::fe::element::Element;
use crate::fe::material::Material;
use crate::fe::mesh::generate::{self, PolygonOptions};
use crate::fe::mesh::{CellKind, Mesh, MeshError};
use crate::fe::model::{MassKind, Model, ModelDescription};
use crate::math::{Vec2, perp, rotation};
use crate::rapier::prelude::{ActiveEvents, CoefficientCombineRule, InteractionGroups};
use std::sync::Arc;

/// Whether the contact boundary of a body carries inertia.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ContactInertia {
    /// The mass of the boundary moves to the nodes inside (Khenous, Laborde, Renard 2008), so that an impact conserves
    /// energy. A body without inside nodes keeps its inertia.
    #[default]
    Redistributed,
    /// Only these nodes give their mass away: for bodies one element thick.
    RedistributedAt(Vec<usize>),
    /// Every node keeps its mass; contacts get impulses at velocity level.
    Kept,
}

/// Builds a [`FlexBody`].
///
/// Lengths are in m, and mesh coordinates are placed by `rotation` and then `translation`.
///
/// ```
/// use foil2d::prelude::*;
/// let beam = FlexBodyBuilder::rectangle([4.0, 0.2], [40, 2])
///     .material(LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0))
///     .thickness(0.1)
///     .pin_where(|[x, _]| x == 0.0, Pin::both())
///     .build()?;
/// assert!((beam.mass() - 624.0).abs() < 1e-9);
/// # Ok::<(), foil2d::body::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FlexBodyBuilder {
    mesh: Result<Arc<Mesh>, MeshError>,
    elements: Vec<Arc<dyn Element>>,
    material: Option<Arc<dyn Material>>,
    thickness: f64,
    mass_kind: MassKind,
    contact_inertia: ContactInertia,
    translation: Vec2,
    rotation: f64,
    linvel: Vec2,
    angvel: f64,
    velocities: Option<Vec<[f64; 2]>>,
    pins: Vec<(usize, Pin)>,
    body_force: Vec2,
    nodal_forces: Vec<(usize, Vec2)>,
    gravity_scale: f64,
    contact: ContactSettings,
    user_data: u128,
}

impl FlexBodyBuilder {
    /// A body on a mesh of the user's own.
    pub fn mesh(mesh: impl Into<Arc<Mesh>>) -> Self {
        Self::from_result(Ok(mesh.into()))
    }

    /// A body from raw nodes and cells of one kind.
    pub fn cells<C: AsRef<[usize]>>(nodes: Vec<[f64; 2]>, kind: CellKind, cells: &[C]) -> Self {
        Self::from_result(Mesh::from_cells(nodes, kind, cells).map(Arc::new))
    }

    /// A rectangle `[0, w] × [0, h]` of `[nx, ny]` quadrilaterals (QM6).
    pub fn rectangle(size: [f64; 2], divisions: [usize; 2]) -> Self {
        Self::rectangle_of(size, divisions, CellKind::Quad4)
    }

    /// A rectangle `[0, w] × [0, h]` of cells of any kind.
    pub fn rectangle_of(size: [f64; 2], divisions: [usize; 2], kind: CellKind) -> Self {
        Self::from_result(generate::rectangle(size, divisions, kind).map(Arc::new))
    }

    /// A disc about the origin, of six-node triangles with edges of about `target_edge` (m).
    pub fn disc(radius: f64, target_edge: f64) -> Self {
        Self::from_result(generate::disc(radius, target_edge, CellKind::Tri6).map(Arc::new))
    }

    /// An annulus about the origin, of quadrilaterals with edges of about `target_edge` (m).
    pub fn annulus(inner: f64, outer: f64, target_edge: f64) -> Self {
        Self::from_result(
            generate::annulus(inner, outer, target_edge, CellKind::Quad4).map(Arc::new),
        )
    }

    /// Any polygon with holes, of six-node triangles with edges of about `target_edge` (m).
    pub fn polygon(outline: &[[f64; 2]], holes: &[Vec<[f64; 2]>], target_edge: f64) -> Self {
        let mesh = generate::polygon(outline, holes, &PolygonOptions::new(target_edge));
        Self::from_result(mesh.and_then(|mesh| mesh.to_tri6()).map(Arc::new))
    }

    fn from_result(mesh: Result<Arc<Mesh>, MeshError>) -> Self {
        Self {
            mesh,
            elements: Vec::new(),
            material: None,
            thickness: 1.0,
            mass_kind: MassKind::default(),
            contact_inertia: ContactInertia::default(),
            translation: Vec2::zeros(),
            rotation: 0.0,
            linvel: Vec2::zeros(),
            angvel: 0.0,
            velocities: None,
            pins: Vec::new(),
            body_force: Vec2::zeros(),
            nodal_forces: Vec::new(),
            gravity_scale: 1.0,
            contact: ContactSettings::default(),
            user_data: 0,
        }
    }

    /// The constitutive law; required.
    pub fn material(mut self, material: impl Material + 'static) -> Self {
        self.material = Some(Arc::new(material));
        self
    }

    /// Thickness out of the plane (m); 1 by default.
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.thickness = thickness;
        self
    }

    /// An element to use for all cells of its node count, instead of the default one.
    pub fn element(mut self, element: impl Element + 'static) -> Self {
        self.elements.push(Arc::new(element));
        self
    }

    /// Lumped (the default) or consistent mass; a consistent mass keeps its contact boundary's inertia.
    pub fn mass_kind(mut self, kind: MassKind) -> Self {
        self.mass_kind = kind;
        self
    }

    /// Whether the contact boundary carries inertia.
    pub fn contact_inertia(mut self, inertia: ContactInertia) -> Self {
        self.contact_inertia = inertia;
        self
    }

    /// Moves the mesh's origin there (m).
    pub fn translation(mut self, translation: [f64; 2]) -> Self {
        self.translation = translation.into();
        self
    }

    /// Turns the mesh about its origin (rad).
    pub fn rotation(mut self, angle: f64) -> Self {
        self.rotation = angle;
        self
    }

    /// Initial velocity of the centre of mass (m/s).
    pub fn linvel(mut self, velocity: [f64; 2]) -> Self {
        self.linvel = velocity.into();
        self
    }

    /// Initial angular velocity about the centre of mass (rad/s).
    pub fn angvel(mut self, angvel: f64) -> Self {
        self.angvel = angvel;
        self
    }

    /// Initial nodal velocities (m/s), added to the rigid ones; one per node, in the world's axes.
    pub fn velocities(mut self, velocities: Vec<[f64; 2]>) -> Self {
        self.velocities = Some(velocities);
        self
    }

    /// Pins a node: its displacement is zero, or what [`FlexBody::set_pin_displacement`] says.
    pub fn pin(mut self, node: usize, pin: Pin) -> Self {
        self.pins.push((node, pin));
        self
    }

    /// Pins all nodes chosen by their mesh coordinates (m).
    pub fn pin_where(mut self, choose: impl Fn([f64; 2]) -> bool, pin: Pin) -> Self {
        if let Ok(mesh) = &self.mesh {
            let chosen = mesh
                .nodes()
                .iter()
                .enumerate()
                .filter(|(_, at)| choose(**at));
            self.pins.extend(chosen.map(|(node, _)| (node, pin)));
        }
        self
    }

    /// A constant force per mass besides gravity (m/s²), in the world's axes.
    pub fn body_force(mut self, acceleration: [f64; 2]) -> Self {
        self.body_force = acceleration.into();
        self
    }

    /// A constant force on a node (N), in the world's axes; several on one node add up.
    pub fn nodal_force(mut self, node: usize, force: [f64; 2]) -> Self {
        self.nodal_forces.push((node, force.into()));
        self
    }

    /// Factor on the world's gravity (-); 1 by default.
    pub fn gravity_scale(mut self, scale: f64) -> Self {
        self.gravity_scale = scale;
        self
    }

    /// Coulomb's coefficient μ (-), combined with the other collider's by rapier's rules; rapier's default of 0.5.
    pub fn friction(mut self, coefficient: f64) -> Self {
        self.contact.friction = coefficient;
        self
    }

    /// Rule to combine friction coefficients.
    pub fn friction_combine_rule(mut self, rule: CoefficientCombineRule) -> Self {
        self.contact.friction_combine_rule = rule;
        self
    }

    /// Newton's coefficient of restitution (-), for impacts shorter than the step; 0 by default. Resolved impacts rebound
    /// by their elasticity.
    pub fn restitution(mut self, coefficient: f64) -> Self {
        self.contact.restitution = coefficient;
        self
    }

    /// Rule to combine coefficients of restitution.
    pub fn restitution_combine_rule(mut self, rule: CoefficientCombineRule) -> Self {
        self.contact.restitution_combine_rule = rule;
        self
    }

    /// Which colliders this body meets.
    pub fn collision_groups(mut self, groups: InteractionGroups) -> Self {
        self.contact.collision_groups = groups;
        self
    }

    /// Events rapier reports for the body's surface.
    pub fn active_events(mut self, events: ActiveEvents) -> Self {
        self.contact.active_events = events;
        self
    }

    /// Anything the user wants to keep with the body.
    pub fn user_data(mut self, data: u128) -> Self {
        self.user_data = data;
        self
    }

    /// Checks everything and assembles the body, not yet in any world.
    ///
    /// # Errors
    /// [`BuildError`], naming what is wrong and the cure.
    pub fn build(self) -> Result<FlexBody, BuildError> {
        self.check_numbers()?;
        let mesh = self.mesh.clone()?;
        let material = self.material.clone().ok_or(BuildError::NoMaterial)?;
        material.validate()?;
        let n_nodes = mesh.n_nodes();
        let is_fixed = self.fixed_dofs(n_nodes)?;
        let turn = rotation(self.rotation);
        let rest: Vec<f64> = mesh
            .nodes()
            .iter()
            .flat_map(|&node| {
                let placed = turn * Vec2::from(node) + self.translation;
                [placed.x, placed.y]
            })
            .collect();
        let frame = frame_of_pins(&rest, &is_fixed).ok_or(BuildError::RotatingPins)?;
        let massless = self.massless_nodes(&mesh, &is_fixed)?;
        let model = Model::assemble(ModelDescription {
            rest_positions: rest.clone(),
            mesh,
            elements: self.elements.clone(),
            material,
            thickness: self.thickness,
            mass_kind: self.mass_kind,
            massless,
            held: (0..n_nodes)
                .map(|node| is_fixed[2 * node] && is_fixed[2 * node + 1])
                .collect(),
        })?;
        let nodal_force = self.gather_nodal_forces(n_nodes)?;
        let mut body = FlexBody::new(
            Arc::new(model),
            is_fixed,
            frame,
            self.contact,
            self.user_data,
        );
        body.set_initial_velocity(&self.initial_velocity(&body, &rest)?);
        body.load(nodal_force, self.body_force, self.gravity_scale);
        Ok(body)
    }

    fn check_numbers(&self) -> Result<(), BuildError> {
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

    fn massless_nodes(&self, mesh: &Mesh, is_fixed: &[bool]) -> Result<Vec<bool>, BuildError> {
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
        // Without a free node inside there is nothing to carry the mass: the boundary keeps it.
        let is_idle =
            |node: usize| massless[node] || (is_fixed[2 * node] && is_fixed[2 * node + 1]);
        if (0..n_nodes).all(is_idle) {
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

    fn initial_velocity(&self, body: &FlexBody, rest: &[f64]) -> Result<Vec<f64>, BuildError> {
        let n_nodes = rest.len() / 2;
        let centre: Vec2 = body.centre_of_mass().into();
        let mut velocity = Vec::with_capacity(rest.len());
        for point in rest.chunks_exact(2) {
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
        Ok(velocity)
    }
}
