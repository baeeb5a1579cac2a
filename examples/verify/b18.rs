//! B18, the rolling disc: friction turns it, and as much of it as rolling needs.
//!
//! ```text
//!       .--.      a = 2/3 g sin α               if mu >= tan α / 3
//!      (  o )-.   a = g (sin α - mu cos α),
//!       '--'   '-.   R ω' = 2 mu g cos α        else
//! ```
//!
//! Data: rigid disc of 0.3 m on a flexible slab of steel, 10 × 0.5 m, held below; 240 steps a second, 1 s.
//!
//! Excellent: 1e-6 of accelerations once the disc presses evenly. The slab gives way by some 1e-7 m under the moving
//! contact, and its surface is a polygon of 100 segments; positions are rapier's.

use super::Outcome;
use super::scene::{G, Scene, vector};
use super::sheet::Sheet;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

const RADIUS: f64 = 0.3;

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (angle, mu) in [(0.3f64, 0.5), (0.3, 0.05)] {
        let mut scene =
            Scene::new(1.0 / 240.0, Beta2::default()).with_gravity(0.0, -G * angle.cos());
        let slab = FlexBodyBuilder::rectangle([10.0, 0.5], [100, 3])
            .material(
                LinearElastic::plane_stress(2e11, 0.3)
                    .density(7800.0)
                    .rayleigh(1e-3),
            )
            .friction(mu)
            .pin_where(|[_, y]| y == 0.0, Pin::both());
        scene.add(slab)?;
        let body = RigidBodyBuilder::dynamic()
            .translation(vector(1.0, 0.5 + RADIUS))
            .can_sleep(false);
        let ball = ColliderBuilder::ball(RADIUS as Real)
            .density(1000.0)
            .friction(mu as Real);
        let (disc, _) = scene.world.insert(body, ball);
        // At rest first, so that the contact is settled.
        scene.steps(sheet.n_steps(240))?;
        scene.world.gravity = vector(G * angle.sin(), -G * angle.cos());
        let motion = |scene: &Scene| {
            let body = &scene.world.bodies[disc];
            [
                f64::from(body.linvel().x),
                -RADIUS * f64::from(body.angvel()),
            ]
        };
        let lead = sheet.n_steps(24);
        scene.steps(lead)?;
        let before = motion(&scene);
        let n = sheet.n_steps(240);
        scene.steps(n)?;
        let after = motion(&scene);
        let rates = [0, 1].map(|k| (after[k] - before[k]) / (n as f64 * scene.dt()));
        let rolls = mu >= angle.tan() / 3.0;
        let exact = if rolls {
            [2.0 / 3.0 * G * angle.sin(); 2]
        } else {
            [
                G * (angle.sin() - mu * angle.cos()),
                2.0 * mu * G * angle.cos(),
            ]
        };
        let name = if rolls { "rolls" } else { "slips" };
        let tolerance = 1e-6;
        sheet.relative(
            format!("acceleration, {name} (m/s²)"),
            exact[0],
            rates[0],
            tolerance,
        );
        sheet.relative(
            format!("angular acceleration times R, {name} (m/s²)"),
            exact[1],
            rates[1],
            tolerance,
        );
    }
    Ok(())
}
