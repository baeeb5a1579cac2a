//! B24, weight: whatever rests on the floor presses with what it weighs.
//!
//! ```text
//!   +------+    .--.      +--+
//!   |      |   (    )     |  |     any step, mesh and material
//!   +------+    '--'      +--+
//!  ==============================
//! ```
//!
//! Exact: `Σ p = m g` at rest; contact forces have no other resultant.
//!
//! Excellent: 1e-6. Bodies are placed touching and damped by their material, so that rest comes in the time given.

use super::Outcome;
use super::scene::{G, Scene};
use super::sheet::Sheet;
use foil2d::prelude::*;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let soft = LinearElastic::plane_stress(1e6, 0.3)
        .density(1000.0)
        .rayleigh(5e-3);
    let steel = LinearElastic::plane_strain(2e11, 0.3)
        .density(7800.0)
        .rayleigh(1e-4);
    let block = |kind| FlexBodyBuilder::rectangle_of([1.0, 0.5], [8, 4], kind).small_strain();
    let disc = FlexBodyBuilder::disc(0.3, 0.06)
        .small_strain()
        .translation([0.0, 0.3]);
    let [quads, six_nodes, triangles] =
        [CellKind::Quad4, CellKind::Tri6, CellKind::Tri3].map(block);
    let cases = [
        ("soft block, QM6, 60 Hz", &quads, soft, 60.0),
        ("soft block, QM6, 500 Hz", &quads, soft, 500.0),
        ("soft block, T6, 60 Hz", &six_nodes, soft, 60.0),
        ("soft block, T3, 60 Hz", &triangles, soft, 60.0),
        ("steel block, QM6, 60 Hz", &quads, steel, 60.0),
        ("steel block, T6, 1000 Hz", &six_nodes, steel, 1000.0),
        ("soft disc, T6, 120 Hz", &disc, soft, 120.0),
    ];
    for (name, shape, material, rate) in cases {
        let mut scene = Scene::new(1.0 / rate, Beta2::default()).with_gravity(0.0, -G);
        scene.ground(0.5);
        let body = scene.add(shape.clone().material(material))?;
        scene.steps(sheet.n_steps((10.0 * rate) as usize))?;
        let g = f64::from(-scene.world.gravity.y);
        let weight = g * scene.body(body).mass();
        sheet.relative(
            format!("force of a {name} (N)"),
            weight,
            scene.force_on(body)[1],
            1e-6,
        );
    }
    Ok(())
}
