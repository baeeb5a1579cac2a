//! B32, the pendulum: a hinged plate that swings far.
//!
//! ```text
//!      o        hinge: one node held; the body is flexible, and so stiff that it stretches by 1e-7
//!       \\
//!        \\     plate 0.1 × 1 m, theta0 = 1.5 rad
//!         \\
//! ```
//!
//! Exact: `T = 4 sqrt(I/(m g d)) K(sin theta0/2)`, with `I` about the hinge and `d = L/2`.
//!
//! Data: consistent mass, which has the inertia of the plate exactly; 1000 steps a second.
//!
//! Excellent: 1e-5. The trapezoidal rule lengthens the period by `(Ω dt)²/12`, 1e-6.

use super::Outcome;
use super::figure::Figure;
use super::scene::{G, Scene};
use super::sheet::Sheet;
use foil2d::prelude::*;
use std::f64::consts::FRAC_PI_2;

const START: f64 = 1.5;
const STEP: f64 = 5e-4;

/// The complete elliptic integral of the first kind, by the arithmetic-geometric mean.
fn elliptic_k(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut scene = Scene::new(STEP, Beta2::trapezoidal()).with_gravity(0.0, -G);
    let (width, length) = (0.1, 1.0);
    let builder = FlexBodyBuilder::rectangle([width, length], [2, 10])
        .small_strain()
        .material(LinearElastic::plane_stress(1e11, 0.3).density(1000.0))
        .mass_kind(MassKind::Consistent)
        .pin_where(|[x, y]| x == 0.5 * width && y == length, Pin::both())
        .rotation(START);
    let body = scene.add(builder)?;
    let hinge = scene.body(body).mesh().n_nodes() - 2;
    let arm = 0.5 * length;
    let inertia = (width * width + length * length) / 12.0 + arm * arm;
    let g = f64::from(-scene.world.gravity.y);
    let exact = 4.0 * (inertia / (g * arm)).sqrt() * elliptic_k((0.5 * START).sin());

    let place = scene.body(body).position(hinge);
    let energy = |scene: &Scene| {
        let body = scene.body(body);
        body.energy().kinetic
            + body.energy().elastic
            + g * body.mass() * (body.centre_of_mass()[1] - place[1] + arm)
    };
    let at_start = energy(&scene);
    let (mut passes, mut drift, mut before, mut angles) = (Vec::new(), 0.0f64, START, Vec::new());
    for step in 1..=sheet.n_steps((5.2 * exact / STEP) as usize) {
        scene.step()?;
        let angle = START + scene.body(body).angle();
        if before > 0.0 && angle <= 0.0 {
            passes.push((step as f64 - angle / (angle - before)) * scene.dt());
        }
        before = angle;
        drift = drift.max((energy(&scene) / at_start - 1.0).abs());
        angles.push([step as f64 * scene.dt(), angle]);
    }
    let span = passes
        .last()
        .zip(passes.first())
        .map_or(f64::NAN, |(last, first)| last - first);
    sheet.relative(
        "period of a flexible plate on a hinge (s)",
        exact,
        span / (passes.len() as f64 - 1.0),
        1e-5,
    );
    // The trapezoidal rule keeps a quadratic energy; that of gravity is not, and its error is of the second order.
    sheet.absolute(
        "largest change of energy over five periods (-)",
        0.0,
        drift,
        1e-5,
    );
    let moved = scene.body(body).position(hinge);
    sheet.absolute(
        "the hinge moves by (m)",
        0.0,
        (moved[0] - place[0]).hypot(moved[1] - place[1]),
        1e-12,
    );
    let turns = (0..=5).map(|k| [f64::from(k) * exact, START]).collect();
    sheet.figure(
        Figure::new(
            "b32_angle",
            "B32: angle of the pendulum",
            ["time (s)", "angle (rad)"],
        )
        .line("flexible plate", angles)
        .dots("exact turning points", turns),
    );
    Ok(())
}
