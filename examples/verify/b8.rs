//! B8, an elastic disc dropped on a rigid floor: no closed form, but what must not change and what must converge.
//!
//! ```text
//!      .---.
//!     (     )  R = 0.5 m, six-node triangles, edges of R/n
//!      '---'   v0 = 1 m/s, no gravity
//!    =========
//! ```
//!
//! Data: E = 1 MPa, nu = 0.3, rho = 1000 kg/m³; 1200, 2400 and 4800 steps a second for n = 6, 12 and 24.
//!
//! Excellent: energy to 0.1 %, momentum to round-off, the rebound converges (less than 1 % from one mesh to the next).

use super::Outcome;
use super::figure::Figure;
use super::scene::{Scene, vector};
use super::sheet::Sheet;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;

const RADIUS: f64 = 0.5;
const SPEED: f64 = 1.0;

struct Impact {
    rebound: f64,
    energy_error: f64,
    sideways: f64,
    impulse_error: f64,
    force: Vec<[f64; 2]>,
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let divisions = sheet.choose(vec![6, 12, 24], vec![6, 12]);
    let mut figure = Figure::new(
        "b8_force",
        "B8: force under the dropped disc",
        ["time (s)", "contact force (N)"],
    );
    let (mut last, mut n_last) = (None::<Impact>, 0);
    for n in divisions {
        let impact = drop_disc(n, sheet)?;
        sheet.absolute(
            format!("R/{n}: largest change of energy (-)"),
            0.0,
            impact.energy_error,
            1e-3,
        );
        sheet.absolute(
            format!("R/{n}: sideways momentum, of m v0 (-)"),
            0.0,
            impact.sideways,
            1e-10,
        );
        sheet.absolute(
            format!("R/{n}: impulse over change of momentum, less 1 (-)"),
            0.0,
            impact.impulse_error,
            1e-3,
        );
        figure = figure.line(&format!("edges of R/{n}"), impact.force.clone());
        if let Some(coarse) = &last {
            sheet.relative(
                format!("rebound over v0, R/{n} against R/{n_last} (-)"),
                coarse.rebound,
                impact.rebound,
                1e-2,
            );
        }
        (last, n_last) = (Some(impact), n);
    }
    sheet.figure(figure);
    Ok(())
}

fn drop_disc(n: usize, sheet: &Sheet) -> Result<Impact, Box<dyn Error + Send + Sync>> {
    let rate = 200.0 * n as f64;
    let mut scene = Scene::new(1.0 / rate, Beta2::trapezoidal());
    let floor = ColliderBuilder::cuboid(5.0, 0.5)
        .translation(vector(0.0, -0.5))
        .friction(0.0);
    scene.world.insert_collider(floor, None);
    let disc = FlexBodyBuilder::disc(RADIUS, RADIUS / n as f64)
        .small_strain()
        .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
        .friction(0.0)
        // A node of every mesh is lowest; it touches at the end of a step.
        .rotation(-std::f64::consts::FRAC_PI_2)
        .translation([0.0, RADIUS + 0.02 * SPEED])
        .linvel([0.0, -SPEED]);
    let disc = scene.add(disc)?;
    let energy = |body: &FlexBody| body.energy().kinetic + body.energy().elastic;
    let (at_start, momentum) = (energy(scene.body(disc)), scene.body(disc).mass() * SPEED);
    let (mut force, mut impulse, mut energy_error, mut sideways) =
        (Vec::new(), 0.0, 0.0f64, 0.0f64);
    // Waves need 2 R / c = 32 ms to cross the disc; contact lasts 2 to 3 times that.
    for step in 1..=sheet.n_steps((0.2 * rate) as usize) {
        scene.step()?;
        let body = scene.body(disc);
        energy_error = energy_error.max((energy(body) / at_start - 1.0).abs());
        sideways = sideways.max(body.momentum()[0].abs() / momentum);
        let up = body.total_contact_force()[1];
        impulse += up * scene.dt();
        force.push([step as f64 * scene.dt(), up]);
    }
    let end = scene.body(disc).momentum()[1];
    Ok(Impact {
        rebound: end / momentum,
        energy_error,
        sideways,
        impulse_error: impulse / (end + momentum) - 1.0,
        force,
    })
}
