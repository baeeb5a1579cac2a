//! Flexible bodies as lines, for any backend of rapier's debug renderer.

use super::participant::{Held, Participant};
use super::report::StepReport;
use crate::body::{FlexBody, FlexBodySet};
use crate::fe::model::ModelError;
use crate::math::{Vec2, node_vec, perp, to_rapier};
use crate::rapier::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject};
use crate::rapier::prelude::ColliderSet;

/// Draws meshes, stresses and forces of flexible bodies; rapier's own pipeline draws their surfaces, as colliders.
///
/// Every line belongs to a collider, that of the flexible body or of the contactor, and `filter_object` is asked for it.
///
/// ```
/// use foil2d::fe::mesh::{CellKind, generate};
/// use foil2d::pipeline::FlexDebugRender;
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// struct Lines(usize);
/// impl DebugRenderBackend for Lines {
///     fn draw_line(&mut self, _: DebugRenderObject, _: Vector, _: Vector, _: DebugColor) {
///         self.0 += 1;
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = PhysicsWorld::new();
/// let mut bodies = FlexBodySet::new();
/// let mesh = generate::rectangle([1.0, 0.1], [10, 1], CellKind::Quad4)?;
/// let beam = FlexBodyBuilder::mesh(mesh).material(LinearElastic::plane_stress(1e7, 0.3).density(1e3));
/// bodies.insert(beam, &mut world)?;
/// let mut pipeline = FlexPipeline::new();
/// pipeline.step(&mut world, &mut bodies)?;
///
/// let mut lines = Lines(0);
/// FlexDebugRender::default().render(&mut lines, &bodies, pipeline.report(), &world.colliders)?;
/// assert_eq!(lines.0, 31);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FlexDebugRender {
    /// Whether the edges of all cells are drawn.
    pub draws_meshes: bool,
    /// Whether they are coloured by von Mises stress.
    pub draws_stresses: bool,
    /// Whether the forces on contactors are drawn.
    pub draws_contact_forces: bool,
    /// Whether the forces of attachments are drawn.
    pub draws_attachment_forces: bool,
    /// Stress of the loaded colour (Pa); `None` for the largest there is.
    pub full_stress: Option<f64>,
    /// Length of an arrow for a force (m/N); `None` for a quarter of the largest mesh for the largest force.
    pub metres_per_newton: Option<f64>,
    /// Colour without stress.
    pub slack_color: DebugColor,
    /// Colour of the full stress and beyond.
    pub loaded_color: DebugColor,
    /// Colour of contact forces.
    pub contact_color: DebugColor,
    /// Colour of the forces of attachments.
    pub attachment_color: DebugColor,
}

impl Default for FlexDebugRender {
    fn default() -> Self {
        Self {
            draws_meshes: true,
            draws_stresses: true,
            draws_contact_forces: true,
            draws_attachment_forces: true,
            full_stress: None,
            metres_per_newton: None,
            slack_color: [220.0, 0.8, 0.5, 1.0],
            loaded_color: [0.0, 1.0, 0.5, 1.0],
            contact_color: [330.0, 1.0, 0.4, 1.0],
            attachment_color: [280.0, 0.8, 0.5, 1.0],
        }
    }
}

impl FlexDebugRender {
    /// Draws all bodies and the forces of the last step.
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn render(
        &self,
        backend: &mut impl DebugRenderBackend,
        flex_bodies: &FlexBodySet,
        report: &StepReport,
        colliders: &ColliderSet,
    ) -> Result<(), ModelError> {
        if self.draws_meshes {
            let mut stresses = Vec::with_capacity(flex_bodies.len());
            let mut largest = 0.0f64;
            for (_, body) in flex_bodies.iter() {
                let stress = if self.draws_stresses {
                    body.von_mises()?
                } else {
                    vec![0.0; body.n_nodes()]
                };
                largest = stress.iter().fold(largest, |largest, &s| largest.max(s));
                stresses.push(stress);
            }
            let full = self.full_stress.unwrap_or(largest);
            for ((_, body), stress) in flex_bodies.iter().zip(&stresses) {
                self.render_mesh(backend, body, stress, full, colliders);
            }
        }
        self.render_forces(backend, flex_bodies, report, colliders);
        Ok(())
    }

    /// Draws every edge of the mesh once.
    fn render_mesh(
        &self,
        backend: &mut impl DebugRenderBackend,
        body: &FlexBody,
        stress: &[f64],
        full: f64,
        colliders: &ColliderSet,
    ) {
        let handle = body.collider_handle();
        let Some(collider) = colliders.get(handle) else {
            return;
        };
        let object = DebugRenderObject::Collider(handle, collider);
        if !backend.filter_object(object) {
            return;
        }
        for [a, b] in body.mesh().edges() {
            let [start, end] = [a, b].map(|node| to_rapier(node_vec(body.positions(), node)));
            let color = self.color(0.5 * (stress[a] + stress[b]), full);
            backend.draw_line(object, start, end, color);
        }
    }

    fn color(&self, stress: f64, full: f64) -> DebugColor {
        let share = if full > 0.0 {
            (stress / full).min(1.0)
        } else {
            0.0
        } as f32;
        std::array::from_fn(|k| {
            let (slack, loaded) = (self.slack_color[k], self.loaded_color[k]);
            slack + share * (loaded - slack)
        })
    }

    fn render_forces(
        &self,
        backend: &mut impl DebugRenderBackend,
        flex_bodies: &FlexBodySet,
        report: &StepReport,
        colliders: &ColliderSet,
    ) {
        let contacts = report
            .contacts()
            .iter()
            .filter(|_| self.draws_contact_forces);
        let contacts = contacts.filter_map(|contact| {
            let collider = match contact.contactor {
                Participant::Flex(body) => flex_bodies.get(body)?.collider_handle(),
                Participant::Rigid(collider) => collider,
            };
            let normal = Vec2::from(contact.normal);
            let force = contact.normal_force * normal + contact.tangential_force * perp(normal);
            Some((collider, contact.position, force, self.contact_color))
        });
        let held = report
            .joints()
            .iter()
            .filter(|_| self.draws_attachment_forces);
        let held = held.filter_map(|joint| {
            let Held::Attachment(attachment) = joint.joint else {
                return None;
            };
            let body = flex_bodies.attachment(attachment).ok()?.body();
            let collider = flex_bodies.get(body)?.collider_handle();
            let force = Vec2::from(joint.force);
            Some((collider, joint.position, force, self.attachment_color))
        });
        let arrows: Vec<_> = contacts.chain(held).collect();
        let largest = arrows
            .iter()
            .fold(0.0f64, |most, arrow| most.max(arrow.2.norm()));
        if largest == 0.0 {
            return;
        }
        let longest = 0.25 * largest_extent(flex_bodies, colliders);
        let scale = self.metres_per_newton.unwrap_or(longest / largest);
        for (handle, at, force, color) in arrows {
            if let Some(collider) = colliders.get(handle) {
                let object = DebugRenderObject::Collider(handle, collider);
                draw_arrow(backend, object, at.into(), scale * force, color);
            }
        }
    }
}

/// Draws an arrow whose tip is where the force acts.
fn draw_arrow(
    backend: &mut impl DebugRenderBackend,
    object: DebugRenderObject<'_>,
    tip: Vec2,
    shaft: Vec2,
    color: DebugColor,
) {
    if !backend.filter_object(object) {
        return;
    }
    let barbs = [1.0, -1.0].map(|side| tip - 0.2 * shaft + 0.08 * side * perp(shaft));
    for start in [tip - shaft, barbs[0], barbs[1]] {
        backend.draw_line(object, to_rapier(start), to_rapier(tip), color);
    }
}

/// The longest side of the boxes around flexible bodies (m).
fn largest_extent(flex_bodies: &FlexBodySet, colliders: &ColliderSet) -> f64 {
    let surfaces = flex_bodies
        .iter()
        .filter_map(|(_, body)| colliders.get(body.collider_handle()));
    let sides = surfaces.map(|surface| f64::from(surface.compute_aabb().extents().max_element()));
    sides.fold(0.0, f64::max)
}
