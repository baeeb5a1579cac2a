//! B18, the rolling disc: friction turns it, and as much of it as rolling needs.
//!
//! ```text
//!       .--.      a = 2/3 g sin α               if mu >= tan α / 3
//!      (  o )-.   a = g (sin α - mu cos α),
//!       '--'   '-.   R ω' = 2 mu g cos α        else
//! ```
//!
//! Data: rigid disc of 0.3 m on a flexible slab of steel, 10 × 0.5 m, held below; 960 steps a second, 1 s.
//!
//! Excellent: 1e-6 of accelerations. With 240 steps a second a few millionths are missing, in either precision and on a slab
//! a hundred times stiffer too; they fall by thirty or more with a step a quarter as long.

use super::Outcome;
use super::scene::{G, Scene, vector};
use super::sheet::Sheet;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;

const RADIUS: f64 = 0.3;

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (angle, mu) in [(0.3f64, 0.5), (0.3, 0.05)] {
        let rolls = mu >= angle.tan() / 3.0;
        let name = if rolls { "rolls" } else { "slips" };
        let exact = if rolls {
            [2.0 / 3.0 * G * angle.sin(); 2]
        } else {
            [
                G * (angle.sin() - mu * angle.cos()),
                2.0 * mu * G * angle.cos(),
            ]
        };
        let coarse = accelerations(angle, mu, 240.0, sheet)?;
        let fine = accelerations(angle, mu, 960.0, sheet)?;
        for (k, quantity) in ["acceleration", "angular acceleration times R"]
            .into_iter()
            .enumerate()
        {
            sheet.tell(
                format!("{quantity}, {name}, 240 Hz (m/s²)"),
                exact[k],
                coarse[k],
            );
            sheet.relative(
                format!("{quantity}, {name}, 960 Hz (m/s²)"),
                exact[k],
                fine[k],
                1e-6,
            );
        }
    }
    Ok(())
}

/// Mean acceleration of the centre and of the rim over a second (m/s²).
fn accelerations(
    angle: f64,
    mu: f64,
    rate: f64,
    sheet: &Sheet,
) -> Result<[f64; 2], Box<dyn Error + Send + Sync>> {
    let mut scene = Scene::new(1.0 / rate, Beta2::default()).with_gravity(0.0, -G * angle.cos());
    let slab = FlexBodyBuilder::rectangle([10.0, 0.5], [100, 3])
        .small_strain()
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
    let n = sheet.n_steps(rate as usize);
    scene.steps(n)?;
    scene.world.gravity = vector(G * angle.sin(), -G * angle.cos());
    let motion = |scene: &Scene| {
        let body = &scene.world.bodies[disc];
        [
            f64::from(body.linvel().x),
            -RADIUS * f64::from(body.angvel()),
        ]
    };
    scene.steps(n / 10)?;
    let before = motion(&scene);
    scene.steps(n)?;
    let after = motion(&scene);
    Ok([0, 1].map(|k| (after[k] - before[k]) / (n as f64 * scene.dt())))
}
