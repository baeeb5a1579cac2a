//! What flexible bodies look like in the testbed's window.

use crate::scenes::Scene;
use foil2d::body::{FlexBody, FlexBodyHandle};
use foil2d::pipeline::FlexDebugRender;
use foil2d::prelude::*;
use foil2d::rapier::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject};
use foil2d::rapier::prelude::Vector;
use kiss3d::prelude::*;
use rapier_testbed2d::TestbedViewer;
use std::error::Error;

/// Width of lines (px).
const LINE: f32 = 2.0;

/// Filled meshes that follow the bodies, and lines coloured by stress on them.
pub struct Look {
    filled: Vec<(FlexBodyHandle, SceneNode2d)>,
    lines: FlexDebugRender,
}

impl Look {
    /// Adds the meshes of all bodies to the viewer, after [`TestbedViewer::set_world`].
    pub fn new(viewer: &mut TestbedViewer, flex_bodies: &FlexBodySet) -> Self {
        let mut filled = Vec::new();
        for (handle, body) in flex_bodies.iter() {
            // The testbed draws surfaces as they were when it first saw them.
            let nothing = Color::new(0.0, 0.0, 0.0, 0.0);
            viewer.set_initial_collider_color(body.collider_handle(), nothing);
            let graphics = viewer.graphics_mut();
            let color = graphics.next_color();
            let mesh = GpuMesh2d::new(vertices(body), triangles(body), None, true);
            let scene = graphics.scene_mut();
            let mut node = scene.add_mesh(Rc::new(RefCell::new(mesh)), Vec2::ONE);
            node.set_color(color.with_alpha(0.35));
            filled.push((handle, node));
        }
        let lines = FlexDebugRender::default();
        Self { filled, lines }
    }

    /// Draws a frame.
    pub fn draw(
        &mut self,
        viewer: &mut TestbedViewer,
        scene: &Scene,
    ) -> Result<(), Box<dyn Error>> {
        for (handle, node) in &mut self.filled {
            if let Some(body) = scene.flex_bodies.get(*handle) {
                node.modify_vertices(&mut |places| *places = vertices(body));
            }
        }
        let mut lines = Lines(viewer.window_mut());
        let (report, colliders) = (scene.flex.report(), &scene.world.colliders);
        self.lines
            .render(&mut lines, &scene.flex_bodies, report, colliders)?;
        Ok(())
    }
}

/// Where the nodes are.
fn vertices(body: &FlexBody) -> Vec<Vec2> {
    let nodes = 0..body.n_nodes();
    nodes
        .map(|node| body.position(node).map(|x| x as f32).into())
        .collect()
}

/// Cells as triangles about their first corner.
fn triangles(body: &FlexBody) -> Vec<[u32; 3]> {
    let cells = body.mesh().cells();
    cells
        .flat_map(|cell| {
            let corners = cell.corners();
            let corner = |k: usize| corners[k] as u32;
            (1..corners.len() - 1)
                .map(|k| [corner(0), corner(k), corner(k + 1)])
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Lines of rapier's debug renderer in the testbed's window.
struct Lines<'a>(&'a mut Window);

impl DebugRenderBackend for Lines<'_> {
    fn draw_line(&mut self, _: DebugRenderObject<'_>, from: Vector, to: Vector, color: DebugColor) {
        let [from, to] = [from, to].map(|at| Vec2::new(at.x, at.y));
        self.0.draw_line_2d(from, to, rgba(color), LINE);
    }
}

/// The colour of a hue (degrees), a saturation and a lightness.
fn rgba([hue, saturation, lightness, alpha]: DebugColor) -> Color {
    let chroma = saturation * lightness.min(1.0 - lightness);
    let channel = |offset: f32| {
        let part = (offset + hue / 30.0).rem_euclid(12.0);
        lightness - chroma * (part - 3.0).min(9.0 - part).clamp(-1.0, 1.0)
    };
    Color::new(channel(0.0), channel(8.0), channel(4.0), alpha)
}
