//! Flexible bodies in rapier's testbed: the viewer is rapier's own, with its panels, its camera and its mouse; the loop steps
//! [`FlexPipeline`](foil2d::pipeline::FlexPipeline) where other examples step their world.
//!
//! ```text
//! cargo run --release            # in demos/testbed
//! ```
//!
//! Drag a body with the left button, the view with the right one; `T` stops and starts, `S` takes one step, `R` begins anew. The panel's
//! snapshots are rapier's own and do not know of flexible bodies: use `foil2d::pipeline::Snapshot` in a program of your own.

mod grab;
mod look;
mod scenes;

use look::Look;
use rapier_testbed2d::{ExampleEntry, TestbedViewer};
use scenes::{SCENES, Scene};
use std::error::Error;

#[kiss3d::main]
async fn main() {
    let entries = SCENES.map(|(name, _)| ExampleEntry::new("Flexible bodies", name));
    let mut viewer = TestbedViewer::new(entries.to_vec()).await;
    while !viewer.quitting() {
        viewer.clear_scene();
        let (name, build) = SCENES[viewer.selected()];
        if let Err(error) = show(&mut viewer, build).await {
            eprintln!("{name}: {error}");
            return;
        }
    }
}

/// Runs a scene until another one is chosen.
async fn show(
    viewer: &mut TestbedViewer,
    build: fn() -> Result<Scene, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let mut scene = build()?;
    viewer.set_world(&mut scene.world);
    viewer.look_at(scene.centre.into(), scene.zoom);
    let mut look = Look::new(viewer, &scene.flex_bodies);
    while viewer.render_frame(&mut scene.world).await {
        if viewer.simulating() {
            grab::hold_by_nodes(&mut scene)?;
            scene.flex.step(&mut scene.world, &mut scene.flex_bodies)?;
        }
        look.draw(viewer, &scene)?;
    }
    Ok(())
}
