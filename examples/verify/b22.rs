//! B22, mass ratio: a body a million times heavier stands on a light one, and the floor carries both.
//!
//! ```text
//!    +-------+
//!    |  1e6  |  rigid, kg
//!    +-------+
//!      | 1 |    rigid
//!   +---------+
//!   |  8 x 8  |  flexible, 1000 kg, E = 1e11 Pa
//!  ==============
//! ```
//!
//! Exact: the floor carries the total weight, the block the weight of what is on it, and nothing moves.
//!
//! Excellent: forces to 1e-9, no drift. Judged by 1e-6: at 60 Hz 1e-9 is reached, at 500 Hz in an `f64` world 1e-8 of the
//! force is left after twenty seconds.

use super::Outcome;
use super::scene::{G, Scene, vector};
use super::sheet::Sheet;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

pub fn run(sheet: &mut Sheet) -> Outcome {
    for rate in [60.0, 500.0] {
        let mut scene = Scene::new(1.0 / rate, Beta2::default()).with_gravity(0.0, -G);
        let ground = scene.ground(0.5);
        let block = FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
            .small_strain()
            .material(
                LinearElastic::plane_stress(1e11, 0.3)
                    .density(1000.0)
                    .rayleigh(5e-3),
            );
        let block = scene.add(block)?;
        let boxes = [(1.1, 0.1, 1.0), (1.5, 0.3, 1e6)].map(|(y, half_height, mass)| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(0.507, y))
                .can_sleep(false);
            let shape = ColliderBuilder::cuboid(0.3, half_height as Real).density(0.0);
            scene.world.insert(body, shape.mass(mass as Real)).0
        });
        let settle = sheet.n_steps((10.0 * rate) as usize);
        scene.steps(settle)?;
        let place = |scene: &Scene| boxes.map(|body| scene.world.bodies[body].translation());
        let before = place(&scene);
        scene.steps(settle)?;
        let drift = place(&scene)
            .into_iter()
            .zip(before)
            .map(|(a, b)| f64::from((a - b).length()));
        let drift = drift.fold(0.0, f64::max);
        // Gravity as the world holds it.
        let g = f64::from(-scene.world.gravity.y);
        let carried = -scene.force_on_collider(ground)[1];
        let weight = g * (1e6 + 1.0 + scene.body(block).mass());
        sheet.relative(
            format!("force on the floor, {rate} Hz (N)"),
            weight,
            carried,
            1e-6,
        );
        sheet.absolute(format!("drift in 10 s, {rate} Hz (m)"), 0.0, drift, 1e-6);
    }
    Ok(())
}
