//! Persistent contact by plain (C.5): the multipliers of a constrained node with mass do what their roots say.
//!
//! Source: the amplification of a constrained degree of freedom under (C.5), `omega dt -> infinity`.
//!
//! ```text
//!   ///+-----+///     the upper nodes are held, the lower ones guided
//!      |     |
//!      +-----+        pressed on the floor by F, with a velocity of 1e-7 m/s left over
//!      v F   v F
//!   =============
//! ```
//!
//! Exact: a held position leaves `b0 Δa = -(x + dt v + dt²/2 a)`, and the error of the multiplier follows the roots of
//! `β0/2 z² + (β1 + 1/2 - β0) z + (1/2 - β1 + β0/2) = 0`:
//!
//! | member | roots | the error of the multiplier |
//! |---|---|---|
//! | trapezoidal | -1, -1 | alternates and grows linearly |
//! | linear acceleration | -3.732, -0.268 | grows by -3.732 a step |
//! | (1, 1/2) | ±i | stays bounded, with a period of four steps |
//!
//! It is compared with the bar of B1 too: an independent program of forty lines, one unknown a node, takes the same steps.
//!
//! Excellent: the growth to 1 %, measured while the contact lasts.

use super::Outcome;
use super::bars::{DENSITY, Drop, LENGTH, Mass, Scheme, YOUNG, drop_bar};
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use foil2d::prelude::*;
use std::error::Error;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n = sheet.n_steps(12);
    let linear = multiplier_errors(Beta2::linear_acceleration(), n)?;
    // The first steps still hold the other root, which falls by 14 each step.
    let growth = ratio(&linear, 6);
    sheet.relative(
        "growth, linear acceleration (-)",
        -2.0 - 3f64.sqrt(),
        growth,
        1e-2,
    );

    let trapezoidal = multiplier_errors(Beta2::trapezoidal(), sheet.n_steps(200))?;
    let alternates = trapezoidal
        .windows(2)
        .skip(3)
        .all(|pair| pair[0] * pair[1] < 0.0);
    sheet.absolute(
        "trapezoidal alternates (1: in every step)",
        1.0,
        f64::from(u8::from(alternates)),
        0.0,
    );
    let slope = |from: usize| {
        trapezoidal
            .get(from..from + 2)
            .map_or(f64::NAN, |p| p[1].abs() - p[0].abs())
    };
    sheet.relative(
        "trapezoidal: growth per step, late over early (-)",
        1.0,
        slope(190) / slope(10),
        1e-2,
    );

    let bounded = multiplier_errors(Beta2::new(1.0, 0.5)?, sheet.n_steps(200))?;
    let largest = |part: &[f64]| part.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    let late =
        largest(bounded.get(180..).unwrap_or(&[])) / largest(bounded.get(2..22).unwrap_or(&[]));
    sheet.relative("(1, 1/2): size, late over early (-)", 1.0, late, 1e-2);
    beside_one_dimension(sheet)?;
    let axes = ["step (-)", "|error of the multiplier| over the first (-)"];
    let curve = |errors: &[f64]| {
        let relative = errors.iter().map(|e| (e / errors[0]).abs());
        relative
            .enumerate()
            .map(|(k, e)| [k as f64 + 1.0, e])
            .take(12)
            .collect()
    };
    sheet.figure(
        Figure::new(
            "plain_growth",
            "multipliers of a node with mass in lasting contact, plain (C.5)",
            axes,
        )
        .log_upright()
        .exact(
            "3.732^n",
            (1..=12)
                .map(|k| [f64::from(k), (2.0 + 3f64.sqrt()).powi(k - 1)])
                .collect(),
        )
        .dots("linear acceleration", curve(&linear))
        .dots("trapezoidal", curve(&trapezoidal))
        .dots("(1, 1/2)", curve(&bounded)),
    );
    Ok(())
}

/// Quotient of two successive errors; NaN where there are none.
fn ratio(errors: &[f64], at: usize) -> f64 {
    errors
        .get(at..at + 2)
        .map_or(f64::NAN, |pair| pair[1] / pair[0])
}

/// Contact force less the static one, at the end of each step (N).
fn multiplier_errors(
    integrator: Beta2,
    n: usize,
) -> Result<Vec<f64>, Box<dyn Error + Send + Sync>> {
    const FORCE: f64 = 10.0;
    let mut scene = Scene::new(0.01, integrator).with_impact(ImpactTreatment::Plain);
    scene.ground(0.0);
    let builder = FlexBodyBuilder::rectangle([1.0, 1.0], [1, 1])
        .small_strain()
        .material(LinearElastic::plane_stress(1e3, 0.0).density(1.0))
        .contact_inertia(ContactInertia::Kept)
        // It would sleep at 1e-7 m/s.
        .can_sleep(false)
        .pin_where(|[_, y]| y == 1.0, Pin::both())
        .pin_where(|[_, y]| y == 0.0, Pin::x());
    let body = scene.add(builder)?;
    // The force comes when the body is there: one that is let go loaded begins with the acceleration of free fall.
    scene.step()?;
    for node in [0, 1] {
        scene.bodies[body].set_nodal_force(node, [0.0, -FORCE])?;
    }
    scene.step()?;
    let mut velocities = vec![0.0; 8];
    (velocities[1], velocities[3]) = (-1e-7, -1e-7);
    scene.bodies[body].set_velocities(&velocities)?;
    let mut errors = Vec::new();
    for _ in 0..n {
        scene.step()?;
        errors.push(scene.body(body).total_contact_force()[1] - 2.0 * FORCE);
    }
    Ok(errors)
}

/// B1 with a consistent mass, beside the one-dimensional program.
fn beside_one_dimension(sheet: &mut Sheet) -> Outcome {
    let scheme = Scheme {
        name: "trapezoidal",
        integrator: Beta2::trapezoidal(),
        impact: ImpactTreatment::Plain,
        mass: Mass::Consistent,
        contact: ContactMethod::Lagrange,
    };
    // 166 steps to the wall, and 15 in which the multipliers of both programs jump between 0 and twice the exact one.
    // Later, either one amplifies its round-off.
    let drop = Drop {
        n_cells: 100,
        dt: 0.003,
        gravity: 0.0,
        gap: 5.0,
        speed: 10.0,
        n_steps: sheet.n_steps(182),
    };
    let ours = drop_bar(&scheme, &drop)?;
    let dt = ours.times.first().copied().unwrap_or(drop.dt);
    let theirs = one_dimensional(&Drop { dt, ..drop });
    let pairs = ours.pressure.iter().zip(&theirs);
    let worst = pairs.fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()));
    sheet.absolute(
        "B1, largest difference to a program in 1-D, of 300 Pa (-)",
        0.0,
        worst / 300.0,
        1e-3,
    );
    let highest = theirs.iter().fold(0.0f64, |a, &b| a.max(b));
    sheet.relative(
        "B1, highest multiplier of those steps over 300 Pa (-)",
        highest / 300.0,
        ours.pressure.iter().fold(0.0f64, |a, &b| a.max(b)) / 300.0,
        1e-3,
    );
    Ok(())
}

/// Plain (C.5) for a bar of two-node elements with consistent mass, by the trapezoidal rule; pressure per step (Pa).
fn one_dimensional(drop: &Drop) -> Vec<f64> {
    let (n, h, dt) = (drop.n_cells + 1, LENGTH / drop.n_cells as f64, drop.dt);
    let (mass, spring) = (DENSITY * h / 6.0, YOUNG / h);
    let (b0, b1) = (0.25 * dt * dt, 0.5 * dt);
    // Tridiagonal: [diagonal of the end nodes, of the others twice that, off-diagonal].
    let times = |[end, off]: [f64; 2], x: &[f64]| -> Vec<f64> {
        let entry = |i: usize| if i == 0 || i == n - 1 { end } else { 2.0 * end };
        let next = |i: usize| if i + 1 < n { x[i + 1] } else { 0.0 };
        let last = |i: usize| if i > 0 { x[i - 1] } else { 0.0 };
        (0..n)
            .map(|i| entry(i) * x[i] + off * (last(i) + next(i)))
            .collect()
    };
    let (m, k) = ([2.0 * mass, mass], [spring, -spring]);
    let a = [m[0] + b0 * k[0], m[1] + b0 * k[1]];
    let solve = |mut x: Vec<f64>| -> Vec<f64> {
        let mut upper = vec![0.0; n];
        for i in 0..n {
            let (above, before) = if i > 0 {
                (upper[i - 1], x[i - 1])
            } else {
                (0.0, 0.0)
            };
            let own = if i == 0 || i == n - 1 {
                a[0]
            } else {
                2.0 * a[0]
            };
            let pivot = own - a[1] * above;
            upper[i] = a[1] / pivot;
            x[i] = (x[i] - a[1] * before) / pivot;
        }
        for i in (0..n - 1).rev() {
            x[i] -= upper[i] * x[i + 1];
        }
        x
    };
    let mut unit = vec![0.0; n];
    unit[0] = 1.0;
    let response = solve(unit);
    let (mut x, mut v, mut acceleration) = (vec![0.0; n], vec![-drop.speed; n], vec![0.0; n]);
    let mut pressures = Vec::new();
    for _ in 0..drop.n_steps {
        for i in 0..n {
            x[i] += dt * v[i] + 0.5 * dt * dt * acceleration[i];
            v[i] += dt * acceleration[i];
        }
        let inertia = times(m, &acceleration);
        let elastic = times(k, &x);
        let mut increment = solve((0..n).map(|i| -inertia[i] - elastic[i]).collect());
        let gap = drop.gap + x[0] + b0 * increment[0];
        let pressure = (-gap / (b0 * response[0])).max(0.0);
        for i in 0..n {
            increment[i] += pressure * response[i];
            x[i] += b0 * increment[i];
            v[i] += b1 * increment[i];
            acceleration[i] += increment[i];
        }
        pressures.push(pressure);
    }
    pressures
}
