//! Rapier's own soft bodies, described as flexible bodies.
//!
//! A soft body of rapier is particles, of given masses, and what acts between them. Where that is elastic cells with moduli
//! ([`SoftBodyCellModel::Corotational`] and [`SoftBodyCellModel::NeoHookean`]), there is a body of the same triangles, moduli and mass, in plane
//! strain and 1 m thick. What has no counterpart is refused by its name.

use crate::body::{AttachmentBuilder, FlexBodyBuilder, FlexBodyHandle, Pin};
use crate::fe::material::Rayleigh;
use crate::fe::material::hyperelastic::{
    Corotated, Hyperelastic, HyperelasticSolid, StableNeoHookean,
};
use crate::fe::mesh::{CellKind, Mesh, MeshError};
use crate::math::Vec2;
use crate::rapier::prelude::*;
use std::sync::Arc;
use thiserror::Error;

/// Why a soft body of rapier has no flexible counterpart.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SoftBodyError {
    /// It has no cells.
    #[error(
        "the soft body has no cells, only particles and edges: give it cells (`SoftBodyBuilder::grid`, or `cells`), or build a strip or a polygon by `FlexBodyBuilder`"
    )]
    NoCells,
    /// Its cells are springs and areas, without moduli.
    #[error(
        "the cells of the soft body keep areas and distances and have no moduli: choose them by `cell_model(SoftBodyCellModel::Corotational)` or `NeoHookean`, and `young_modulus` and `poisson_ratio` of the material"
    )]
    NoModulus,
    /// Something of it has no counterpart in a continuum of these moduli.
    #[error("a flexible body has no counterpart of {what}: {cure}")]
    NoCounterpart {
        /// The setting, by its name in rapier.
        what: &'static str,
        /// What to do.
        cure: &'static str,
    },
    /// The particles have no mass, or no finite one.
    #[error("the particles weigh {0} kg together: give masses whose sum is positive and finite")]
    Mass(f64),
    /// The triangles make no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The cells cannot be of that kind.
    #[error("cells of a soft body are triangles, and {0:?} are not: choose `Tri3` or `Tri6`")]
    Kind(CellKind),
    /// A cell names a particle that is not there.
    #[error("a cell names particle {particle} of {n_particles}: use indices below {n_particles}")]
    Particle {
        /// The index.
        particle: u32,
        /// How many there are.
        n_particles: usize,
    },
}

impl FlexBodyBuilder {
    /// The flexible body that a soft body of rapier describes: its triangles where its particles are, of large strain, in plane strain and 1 m
    /// thick, with the law of its cells.
    ///
    /// - `kind`: [`CellKind::Tri3`] for nodes that are the particles, or [`CellKind::Tri6`] for nodes in the middle of edges besides, after
    ///   them: triangles of three nodes are stiff in bending.
    ///
    /// | of the soft body | becomes |
    /// |---|---|
    /// | `young_modulus`, `poisson_ratio` (to .499, as rapier takes it) | [`Corotated`] or [`StableNeoHookean`], by `cell_model` |
    /// | masses of the particles | the density that makes their sum; spread as the area is |
    /// | `elastic_damping_ratio` | stiffness damping: the mean over the area of what rapier gives each cell |
    /// | `linear_damping`, `gravity_scale`, `can_sleep`, `user_data` | the same |
    /// | pinned particles | pinned nodes, and those between them |
    /// | `collider_template` | friction, restitution, groups, hooks, events; none: a surface that meets nothing |
    /// | `particle_radius` | the contact skin, as in rapier |
    ///
    /// What holds particles to rigid bodies is told by [`AttachmentBuilder::of_soft_body`].
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// use foil2d::rapier::prelude::*;
    /// let mut blob = SoftBodyBuilder::grid(Vector::new(0.0, 1.0), Vector::new(0.5, 0.5), 6, 6)
    ///     .mass(50.0)
    ///     .cell_model(SoftBodyCellModel::NeoHookean);
    /// blob.material.young_modulus = 1e5;
    /// blob.material.poisson_ratio = 0.3;
    ///
    /// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
    /// let body = flex_bodies.insert(FlexBodyBuilder::from_soft_body(&blob, CellKind::Tri6)?, &mut world)?;
    /// assert!((flex_bodies[body].mass() - 50.0).abs() < 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the soft body has no cells, no moduli, or something that has no counterpart: springs between particles, a kept or changed area, shape
    /// matching, creep, tearing, damping of all deformation, dominance, contact of a skin; or if its triangles make no mesh of that kind.
    pub fn from_soft_body(
        soft_body: &SoftBodyBuilder,
        kind: CellKind,
    ) -> Result<Self, SoftBodyError> {
        refuse_what_has_no_counterpart(soft_body)?;
        let triangles = Triangles::of(soft_body)?;
        let settings = &soft_body.particle_settings;
        let (young, poisson) = moduli(&soft_body.material);
        let law: Arc<dyn Hyperelastic> = match soft_body.cell_model {
            SoftBodyCellModel::NeoHookean => {
                Arc::new(StableNeoHookean::plane_strain(young, poisson))
            }
            _ => Arc::new(Corotated::plane_strain(young, poisson)),
        };
        let rayleigh = Rayleigh {
            mass: f64::from(settings.linear_damping),
            stiffness: triangles.stiffness_damping(&soft_body.material),
        };
        let material = HyperelasticSolid::of(law)
            .with_density(triangles.density())
            .with_damping(rayleigh);
        let mesh = triangles.mesh(kind)?;
        let pinned = pinned(soft_body, &mesh);
        let body = Self::mesh(mesh)
            .material(material)
            .large_strain()
            .gravity_scale(f64::from(settings.gravity_scale))
            .can_sleep(settings.can_sleep)
            .user_data(soft_body.user_data);
        let pinned = pinned.into_iter();
        let body = pinned.fold(body, |body, node| body.pin(node, Pin::both()));
        let body = body.contact_skin(f64::from(soft_body.particle_radius));
        Ok(body.meeting_as(soft_body.collider_template.as_ref()))
    }

    /// A surface that meets others as a collider does, or that meets nothing.
    fn meeting_as(self, collider: Option<&ColliderBuilder>) -> Self {
        let Some(collider) = collider else {
            return self.collision_groups(InteractionGroups::none());
        };
        let body = self
            .friction(f64::from(collider.friction))
            .friction_combine_rule(collider.friction_combine_rule)
            .restitution(f64::from(collider.restitution))
            .restitution_combine_rule(collider.restitution_combine_rule)
            .collision_groups(collider.collision_groups)
            .solver_groups(collider.solver_groups)
            .active_collision_types(collider.active_collision_types)
            .active_hooks(collider.active_hooks)
            .active_events(collider.active_events)
            .contact_force_event_threshold(f64::from(collider.contact_force_event_threshold));
        if collider.is_sensor {
            body.sensor(true)
        } else {
            body
        }
    }
}

impl AttachmentBuilder {
    /// What holds the particles of a soft body of rapier to rigid bodies, as pins of the nodes of the flexible body made of it: pass them to
    /// [`FlexBodySet::attach`](crate::body::FlexBodySet::attach).
    pub fn of_soft_body(soft_body: &SoftBody, body: FlexBodyHandle) -> Vec<Self> {
        let all = soft_body.particle_attachments().iter();
        all.map(|attachment| {
            let at = attachment.local_anchor;
            Self::pin(body)
                .node(attachment.particle as usize)
                .to_rigid_body(attachment.body)
                .at_point([f64::from(at.x), f64::from(at.y)])
        })
        .collect()
    }
}

fn refuse_what_has_no_counterpart(soft_body: &SoftBodyBuilder) -> Result<(), SoftBodyError> {
    if soft_body.cells.is_empty() {
        return Err(SoftBodyError::NoCells);
    }
    if soft_body.cell_model == SoftBodyCellModel::Volume {
        return Err(SoftBodyError::NoModulus);
    }
    let material = &soft_body.material;
    let found = [
        (
            !(soft_body.edges.is_empty() && soft_body.bend_edges.is_empty()),
            "`edges` and `bend_edges` beside elastic cells",
            "leave the springs out and raise `young_modulus`",
        ),
        (
            soft_body.volume_factor != 1.0,
            "`volume_factor`",
            "leave it at 1",
        ),
        (
            soft_body.volume_preservation,
            "`volume_preservation`",
            "leave it out and bring `poisson_ratio` near .5",
        ),
        (
            soft_body.shape_matching,
            "`shape_matching`",
            "leave it out and raise `young_modulus`",
        ),
        (
            material.plastic_yield > 0.0,
            "`plastic_yield`, which creeps at any rate of its own",
            "leave it at 0",
        ),
        (
            material.tear_strain.is_some() || material.tear_force.is_some(),
            "`tear_strain` and `tear_force`",
            "leave them out: flexible bodies do not tear",
        ),
        (
            material.deformation_damping > 0.0,
            "`deformation_damping`",
            "leave it at 0 and raise `elastic_damping_ratio`",
        ),
        (
            soft_body.particle_settings.dominance_group != 0,
            "`dominance_group`",
            "leave it at 0, and set it on the rigid bodies that are to yield",
        ),
        (
            soft_body.skin.is_some() && soft_body.skin_collision,
            "`skin_collision`",
            "let the cells meet the world",
        ),
    ];
    match found.into_iter().find(|(is_set, ..)| *is_set) {
        Some((_, what, cure)) => Err(SoftBodyError::NoCounterpart { what, cure }),
        None => Ok(()),
    }
}

/// The nodes of pinned particles, and those in the middle of edges between two of them.
fn pinned(soft_body: &SoftBodyBuilder, mesh: &Mesh) -> Vec<usize> {
    let mut is_pinned = vec![false; mesh.n_nodes()];
    let n_particles = soft_body.positions.len();
    for &particle in &soft_body.pinned {
        // Rapier passes over those that are not there.
        if (particle as usize) < n_particles {
            is_pinned[particle as usize] = true;
        }
    }
    for cell in mesh.cells() {
        for side in 0..cell.nodes.len().saturating_sub(3) {
            let [from, to] = [side, (side + 1) % 3].map(|corner| cell.nodes[corner]);
            is_pinned[cell.nodes[3 + side]] = is_pinned[from] && is_pinned[to];
        }
    }
    let all = is_pinned.into_iter().enumerate();
    all.filter(|(_, is_pinned)| *is_pinned)
        .map(|(node, _)| node)
        .collect()
}

/// Young's modulus (Pa) and Poisson's ratio (-) as rapier takes them.
fn moduli(material: &SoftBodyMaterial) -> (f64, f64) {
    let young = f64::from(material.young_modulus);
    (young, f64::from(material.poisson_ratio).clamp(0.0, 0.499))
}

/// The cells of a soft body, turned counter-clockwise.
struct Triangles {
    nodes: Vec<[f64; 2]>,
    cells: Vec<[usize; 3]>,
    masses: Vec<f64>,
    /// Twice the area of each cell (m²).
    doubled: Vec<f64>,
}

impl Triangles {
    fn of(soft_body: &SoftBodyBuilder) -> Result<Self, SoftBodyError> {
        let positions = soft_body.positions.iter();
        let nodes: Vec<[f64; 2]> = positions
            .map(|at| [f64::from(at.x), f64::from(at.y)])
            .collect();
        let n_particles = nodes.len();
        let masses: Vec<f64> = if soft_body.masses.len() == n_particles {
            soft_body.masses.iter().map(|&m| f64::from(m)).collect()
        } else {
            vec![f64::from(soft_body.particle_mass); n_particles]
        };
        let total: f64 = masses.iter().sum();
        if !(total.is_finite() && masses.iter().all(|&mass| mass > 0.0)) {
            return Err(SoftBodyError::Mass(total));
        }
        let mut all = soft_body.cells.iter().flatten();
        if let Some(&particle) = all.find(|&&particle| particle as usize >= n_particles) {
            return Err(SoftBodyError::Particle {
                particle,
                n_particles,
            });
        }
        let (mut cells, mut doubled) = (Vec::new(), Vec::new());
        for &cell in &soft_body.cells {
            let [a, b, c] = cell.map(|node| node as usize);
            let [origin, u, v] = [a, b, c].map(|node| Vec2::from(nodes[node]));
            let area = (u - origin).perp(&(v - origin));
            cells.push(if area < 0.0 { [a, c, b] } else { [a, b, c] });
            doubled.push(area.abs());
        }
        Ok(Self {
            nodes,
            cells,
            masses,
            doubled,
        })
    }

    /// The mesh of these cells, each of that kind.
    fn mesh(&self, kind: CellKind) -> Result<Mesh, SoftBodyError> {
        let mesh = Mesh::from_cells(self.nodes.clone(), CellKind::Tri3, &self.cells)?;
        match kind {
            CellKind::Tri3 => Ok(mesh),
            CellKind::Tri6 => Ok(mesh.to_tri6()?),
            _ => Err(SoftBodyError::Kind(kind)),
        }
    }

    /// Density that gives the mass of the particles (kg/m³).
    fn density(&self) -> f64 {
        self.masses.iter().sum::<f64>() / (0.5 * self.doubled.iter().sum::<f64>())
    }

    /// The mean over the area of `2 ζ / ω` (s), where `ω` is the mean of what rapier takes for the frequencies of a cell's three strains: those
    /// of its stiffness against each and of the masses at its corners.
    fn stiffness_damping(&self, material: &SoftBodyMaterial) -> f64 {
        let (young, poisson) = moduli(material);
        let shear = 0.5 * young / (1.0 + poisson);
        let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        let stiffness = [2.0 * shear + lame, 2.0 * shear + lame, 4.0 * shear];
        let (mut sum, mut whole) = (0.0, 0.0);
        for (cell, &doubled) in self.cells.iter().zip(&self.doubled) {
            let corners = cell.map(|node| Vec2::from(self.nodes[node]));
            let mut mobility = [0.0; 3];
            for (corner, &node) in cell.iter().enumerate() {
                // The gradient of the corner's shape function, times twice the area.
                let opposite = corners[(corner + 2) % 3] - corners[(corner + 1) % 3];
                let gradient = Vec2::new(-opposite.y, opposite.x) / doubled;
                let [x, y] = [gradient.x * gradient.x, gradient.y * gradient.y];
                for (mobility, square) in mobility.iter_mut().zip([x, y, 0.25 * (x + y)]) {
                    *mobility += square / self.masses[node];
                }
            }
            let both = stiffness.iter().zip(&mobility);
            let frequencies = both.map(|(k, w)| (0.5 * doubled * k * w).sqrt());
            let mean = frequencies.sum::<f64>() / 3.0;
            if mean > 0.0 {
                sum += doubled * 2.0 * f64::from(material.elastic_damping_ratio.max(0.0)) / mean;
                whole += doubled;
            }
        }
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}
