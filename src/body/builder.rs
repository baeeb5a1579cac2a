//! The description of a flexible body.

use super::contact_inertia::ContactInertia;
use super::contact_settings::ContactSettings;
use super::materials::Materials;
use super::pin::Pin;
use super::pre_stretch::PreStretch;
use super::region::Region;
use crate::fe::element::Element;
use crate::fe::finite_strain::InnerPressure;
use crate::fe::material::Material;
use crate::fe::mesh::generate::{self, PolygonOptions};
use crate::fe::mesh::{CellKind, Mesh, MeshError};
use crate::fe::model::MassKind;
use crate::math::Vec2;
use crate::rapier::prelude::{
    ActiveCollisionTypes, ActiveEvents, ActiveHooks, CoefficientCombineRule, InteractionGroups,
};
use std::sync::Arc;

/// Builds a [`FlexBody`](super::FlexBody).
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
    pub(super) mesh: Result<Arc<Mesh>, MeshError>,
    pub(super) elements: Vec<Arc<dyn Element>>,
    pub(super) materials: Materials,
    /// Whether the body is one of large strain, if the user has said so.
    pub(super) is_large: Option<bool>,
    pub(super) inner_pressure: Option<InnerPressure>,
    pub(super) pre_stretch: Option<PreStretch>,
    pub(super) thickness: f64,
    pub(super) mass_kind: MassKind,
    pub(super) contact_inertia: ContactInertia,
    pub(super) translation: Vec2,
    pub(super) rotation: f64,
    pub(super) linvel: Vec2,
    pub(super) angvel: f64,
    pub(super) velocities: Option<Vec<[f64; 2]>>,
    pub(super) pins: Vec<(usize, Pin)>,
    /// Calls of `pin_where` that chose no node.
    pub(super) n_idle_pins: usize,
    pub(super) body_force: Vec2,
    pub(super) nodal_forces: Vec<(usize, Vec2)>,
    pub(super) gravity_scale: f64,
    pub(super) contact: ContactSettings,
    pub(super) user_data: u128,
    pub(crate) can_sleep: bool,
}

impl FlexBodyBuilder {
    /// A body on a mesh of the user's own.
    pub fn mesh(mesh: impl Into<Arc<Mesh>>) -> Self {
        Self::from_result(Ok(mesh.into()))
    }

    /// A body from raw nodes (m) and cells of one kind, each a list of nodes, counter-clockwise. What is wrong with them is told by [`build`](Self::build).
    pub fn cells<C: AsRef<[usize]>>(nodes: Vec<[f64; 2]>, kind: CellKind, cells: &[C]) -> Self {
        Self::from_result(Mesh::from_cells(nodes, kind, cells).map(Arc::new))
    }

    /// A rectangle `[0, w] × [0, h]` (m) of `[nx, ny]` quadrilaterals (QM6, Taylor, Beresford and Wilson 1976: with two inner modes of bending); nodes are numbered along x, row by row.
    pub fn rectangle(size: [f64; 2], divisions: [usize; 2]) -> Self {
        Self::rectangle_of(size, divisions, CellKind::Quad4)
    }

    /// A rectangle `[0, w] × [0, h]` (m) of cells of any kind.
    pub fn rectangle_of(size: [f64; 2], divisions: [usize; 2], kind: CellKind) -> Self {
        Self::from_result(generate::rectangle(size, divisions, kind).map(Arc::new))
    }

    /// A disc about the origin, of six-node triangles with edges of about `target_edge` (m).
    pub fn disc(radius: f64, target_edge: f64) -> Self {
        Self::from_result(generate::disc(radius, target_edge, CellKind::Tri6).map(Arc::new))
    }

    /// An annulus about the origin, of quadrilaterals with edges of about `target_edge` (m) at its mean radius: outside they are longer.
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
            materials: Materials::default(),
            is_large: None,
            inner_pressure: None,
            pre_stretch: None,
            thickness: 1.0,
            mass_kind: MassKind::default(),
            contact_inertia: ContactInertia::default(),
            translation: Vec2::zeros(),
            rotation: 0.0,
            linvel: Vec2::zeros(),
            angvel: 0.0,
            velocities: None,
            pins: Vec::new(),
            n_idle_pins: 0,
            body_force: Vec2::zeros(),
            nodal_forces: Vec::new(),
            gravity_scale: 1.0,
            contact: ContactSettings::default(),
            user_data: 0,
            can_sleep: true,
        }
    }

    /// The constitutive law, with the density; required, unless every region of the mesh has its own.
    pub fn material(mut self, material: impl Material + 'static) -> Self {
        self.materials.main = Some(Arc::new(material));
        self
    }

    /// The material of a region of the mesh, by its number or its name; all regions must be damped alike.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// let strip = FlexBodyBuilder::rectangle([4.0, 0.2], [40, 2])
    ///     .regions_by(|[_, y]| u32::from(y > 0.1))
    ///     .region_material(0, LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0))
    ///     .region_material(1, LinearElastic::plane_stress(0.7e11, 0.3).density(2700.0))
    ///     .build()?;
    /// assert!((strip.mass() - 0.4 * (7800.0 + 2700.0)).abs() < 1e-9);
    /// # Ok::<(), foil2d::body::BuildError>(())
    /// ```
    pub fn region_material(
        mut self,
        region: impl Into<Region>,
        material: impl Material + 'static,
    ) -> Self {
        let regions = &mut self.materials.regions;
        regions.push((region.into(), Arc::new(material)));
        self
    }

    /// Puts every cell into a region, chosen by the mean of its corners in mesh coordinates (m).
    pub fn regions_by(mut self, choose: impl Fn([f64; 2]) -> u32) -> Self {
        let regions =
            |mesh: Arc<Mesh>| Arc::new(Arc::unwrap_or_clone(mesh).with_regions_by(choose));
        self.mesh = self.mesh.map(regions);
        self
    }

    /// Makes a body that bends, stretches and folds as far as it likes, of the material's [law for large strains](Material::large_law). Of
    /// [`LinearElastic`](crate::fe::material::LinearElastic) that is the neo-Hookean law which is Hooke's at rest.
    ///
    /// That is the default unless a consistent mass or [`ContactInertia::RedistributedAt`] is asked for, which only bodies of small strain have; said,
    /// these are errors. A material without such a law is refused unless one of these or [`small_strain`](Self::small_strain) is said. Such a body costs
    /// a factorization or some in every step; its surface always carries its mass, and explicit steps refuse it.
    pub fn large_strain(mut self) -> Self {
        self.is_large = Some(true);
        self
    }

    /// Makes a body that turns as far as it likes but bends and stretches little, by a hundredth of its lengths or so: the fastest, as one
    /// factorization serves for ever, and the only one of explicit steps, of a consistent mass and of surfaces without mass.
    /// [`StepReport::overbent`](crate::pipeline::StepReport::overbent) tells where it is taken beyond that. What flows plastically is refused.
    pub fn small_strain(mut self) -> Self {
        self.is_large = Some(false);
        self
    }

    /// Puts a pressure into every hole of the body, each by itself: a tyre, a balloon, a cushion. The body is one of large strain.
    ///
    /// It acts on the edges of the hole, whatever else may be in there: a rim that a tyre is to press is part of the mesh, or is welded or pinned to it,
    /// and a body that lies in the hole feels the walls alone. [`FlexBody::set_inner_pressure`](super::FlexBody::set_inner_pressure) changes it
    /// hole by hole.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// let rubber = LinearElastic::plane_strain(2e6, 0.45).density(1100.0);
    /// let tyre = FlexBodyBuilder::annulus(0.25, 0.3, 0.05)
    ///     .material(rubber)
    ///     .inner_pressure(InnerPressure::isothermal(2e4))
    ///     .thickness(0.2)
    ///     .build()?;
    /// assert!((tyre.gas_pressure(0)? - 2e4).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn inner_pressure(mut self, pressure: InnerPressure) -> Self {
        self.inner_pressure = Some(pressure);
        self
    }

    /// Builds the body under tension or compression: it is stretched so where its mesh is, see [`PreStretch`]. The body is one of large strain.
    pub fn pre_stretch(mut self, pre_stretch: impl Into<PreStretch>) -> Self {
        self.pre_stretch = Some(pre_stretch.into());
        self
    }

    /// Thickness out of the plane (m), free of stress; 1 by default.
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.thickness = thickness;
        self
    }

    /// An element to use for all cells of its node count, instead of the default one.
    pub fn element(mut self, element: impl Element + 'static) -> Self {
        self.elements.push(Arc::new(element));
        self
    }

    /// Lumped (the default) or consistent mass; a consistent mass keeps its contact boundary's inertia, and makes the body one of
    /// [small strain](Self::small_strain).
    pub fn mass_kind(mut self, kind: MassKind) -> Self {
        self.mass_kind = kind;
        self
    }

    /// Whether the contact boundary carries inertia; that of a body of large strain always does.
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

    /// Pins a node: its displacement is zero, or what [`set_pin_displacement`](super::FlexBody::set_pin_displacement) says.
    pub fn pin(mut self, node: usize, pin: Pin) -> Self {
        self.pins.push((node, pin));
        self
    }

    /// Pins all nodes chosen by their mesh coordinates (m).
    ///
    /// If it chooses none, the body is as free as without it, and the report of its first step says so:
    /// [`StepReport::insertion_notes`](crate::pipeline::StepReport::insertion_notes).
    pub fn pin_where(mut self, choose: impl Fn([f64; 2]) -> bool, pin: Pin) -> Self {
        if let Ok(mesh) = &self.mesh {
            let chosen = mesh
                .nodes()
                .iter()
                .enumerate()
                .filter(|(_, at)| choose(**at));
            let n_pins = self.pins.len();
            self.pins.extend(chosen.map(|(node, _)| (node, pin)));
            self.n_idle_pins += usize::from(self.pins.len() == n_pins);
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

    /// Which of the colliders it meets this body pushes.
    ///
    /// Rapier's collider keeps empty groups of its own; groups set there are taken over here by the next step. `InteractionGroups::none()` is
    /// what it has, so give groups that meet nothing here.
    pub fn solver_groups(mut self, groups: InteractionGroups) -> Self {
        self.contact.solver_groups = groups;
        self
    }

    /// Which types of rigid bodies this body meets; it counts as a dynamic one.
    pub fn active_collision_types(mut self, types: ActiveCollisionTypes) -> Self {
        self.contact.active_collision_types = types;
        self
    }

    /// Which of the user's hooks are asked about this body.
    pub fn active_hooks(mut self, hooks: ActiveHooks) -> Self {
        self.contact.active_hooks = hooks;
        self
    }

    /// Force of a pair (N) above which [`ActiveEvents::CONTACT_FORCE_EVENTS`] are reported.
    pub fn contact_force_event_threshold(mut self, threshold: f64) -> Self {
        self.contact.contact_force_event_threshold = threshold;
        self
    }

    /// Distance at which the surface touches (m), added to the skin of the other collider.
    pub fn contact_skin(mut self, skin: f64) -> Self {
        self.contact.contact_skin = skin;
        self
    }

    /// Makes the body a sensor: it reports what crosses its surface and touches nothing.
    ///
    /// What lies wholly inside crosses no surface, so rapier tells that it stopped to intersect.
    pub fn sensor(mut self, is_sensor: bool) -> Self {
        self.contact.is_sensor = is_sensor;
        self
    }

    /// Events rapier reports for the body's surface.
    pub fn active_events(mut self, events: ActiveEvents) -> Self {
        self.contact.active_events = events;
        self
    }

    /// Whether the body may fall asleep when it, and all that it touches, has come to rest: yes by default.
    ///
    /// It rests when no node moves by a millionth of the body's size in the time until sleep of its rapier body, half a second
    /// by default: a vibration that dies out falls asleep late, and one that does not never does. What rests is in equilibrium to some six
    /// digits; for more, or for queries that see the surface to the last digit, choose `false`.
    pub fn can_sleep(mut self, can_sleep: bool) -> Self {
        self.can_sleep = can_sleep;
        self
    }

    /// Anything the user wants to keep with the body; its collider and that one's rigid body have it too, for hooks and filters of queries.
    pub fn user_data(mut self, data: u128) -> Self {
        self.user_data = data;
        self
    }
}
