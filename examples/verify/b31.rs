//! B31, a cantilever: tip load, own weight, and the first two frequencies.
//!
//! Source: Timoshenko's beam, shear coefficient 5/6; frequencies by his equation as Huang (1961) writes it.
//!
//! ```text
//!  /|-----------------------------------+  P
//!  /|   L = 1 m, h = 0.1 m              |  |
//!  /|-----------------------------------+  v    E = 1 MPa, nu = 0.3, rho = 1000 kg/m³, plane stress
//! ```
//!
//! Exact: `P L³/3EI + P L/(5/6 G A)`; `w L⁴/8EI + w L²/(2 · 5/6 G A)`; frequencies: the roots below.
//!
//! Excellent: half a per cent, which is what beam theory leaves out at the clamp of a plane body this stout.

use super::Outcome;
use super::figure::Figure;
use super::scene::{Scene, node_at};
use super::sheet::Sheet;
use super::statics::{SETTLE, grid, loaded, still, traction};
use foil2d::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;

const YOUNG: f64 = 1e6;
const NU: f64 = 0.3;
const DENSITY: f64 = 1000.0;
const HEIGHT: f64 = 0.1;
const INERTIA: f64 = HEIGHT * HEIGHT * HEIGHT / 12.0;
/// `5/6 G A`.
const SHEAR: f64 = 5.0 / 6.0 * HEIGHT * YOUNG / (2.0 * (1.0 + NU));
/// The load, and the weight per length (N, N/m).
const LOAD: f64 = 1.0;

fn beam(
    kind: CellKind,
    n: [usize; 2],
) -> Result<(FlexBodyBuilder, Mesh), Box<dyn Error + Send + Sync>> {
    let mesh = grid(n, kind, |[s, t]| [s, HEIGHT * t])?;
    let builder = FlexBodyBuilder::mesh(mesh.clone())
        .small_strain()
        .material(LinearElastic::plane_stress(YOUNG, NU).density(DENSITY))
        .contact_inertia(ContactInertia::Kept)
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    Ok((builder, mesh))
}

/// Deflections under the tip load and under the weight (m).
fn deflections(
    kind: CellKind,
    n: [usize; 2],
    sheet: &Sheet,
) -> Result<[f64; 2], Box<dyn Error + Send + Sync>> {
    let (builder, mesh) = beam(kind, n)?;
    let forces = traction(&mesh, kind, [0.0, -LOAD / HEIGHT], |[x, _]| x > 1.0 - 1e-9);
    let weight = builder
        .clone()
        .body_force([0.0, -LOAD / (DENSITY * HEIGHT)]);
    let mut found = [0.0; 2];
    for (found, builder) in found.iter_mut().zip([loaded(builder, forces), weight]) {
        let mut scene = still(3.2)?;
        let body = scene.add(builder)?;
        scene.steps(sheet.n_steps(SETTLE))?;
        let body = scene.body(body);
        *found = -body.displacement(node_at(body, [1.0, 0.5 * HEIGHT]))[1];
    }
    Ok(found)
}

/// Timoshenko's frequency equation of a cantilever, zero at a natural frequency (rad/s).
fn huang(omega: f64) -> f64 {
    let b = omega * (DENSITY * HEIGHT / (YOUNG * INERTIA)).sqrt();
    let (r2, s2) = (INERTIA / HEIGHT, YOUNG * INERTIA / SHEAR);
    let root = ((r2 - s2).powi(2) + 4.0 / (b * b)).sqrt();
    let [alpha, beta] = [-1.0, 1.0].map(|sign| (0.5 * (sign * (r2 + s2) + root)).sqrt());
    2.0 + (b * b * (r2 - s2).powi(2) + 2.0) * (b * alpha).cosh() * (b * beta).cos()
        - b * (r2 + s2) / (1.0 - b * b * r2 * s2).sqrt() * (b * alpha).sinh() * (b * beta).sin()
}

/// The `k`-th root (Hz).
fn frequency(k: usize) -> f64 {
    let step = 0.01;
    let brackets = (1..)
        .map(|i| f64::from(i) * step)
        .filter(|&w| huang(w) * huang(w + step) < 0.0);
    let mut low = brackets.take(k + 1).last().unwrap_or(0.0);
    let mut high = low + step;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if huang(low) * huang(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high) / TAU
}

/// Frequency at which the part of the motion along Euler's `k`-th shape passes zero upwards (Hz).
fn measured(k: usize, sheet: &Sheet) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let wave = [1.875_104_07, 4.694_091_13][k];
    let share = [0.734_095_51, 1.018_467_32][k];
    let shape = |x: f64| {
        (wave * x).cosh() - (wave * x).cos() - share * ((wave * x).sinh() - (wave * x).sin())
    };
    let (builder, mesh) = beam(CellKind::Quad4, [40, 4])?;
    let velocities: Vec<[f64; 2]> = mesh
        .nodes()
        .iter()
        .map(|&[x, _]| [0.0, 1e-3 * shape(x)])
        .collect();
    let flat: Vec<f64> = velocities.iter().flatten().copied().collect();
    let mut scene = Scene::new(1.0 / (400.0 * frequency(k)), Beta2::trapezoidal());
    let body = scene.add(builder.velocities(velocities))?;
    let (mut passes, mut before) = (Vec::new(), 0.0);
    for step in 0..sheet.n_steps(400 * 10 + 100) {
        scene.step()?;
        let body = scene.body(body);
        let now = body.model().mass().inner(body.local_displacements(), &flat);
        if before < 0.0 && now >= 0.0 {
            passes.push((step as f64 - now / (now - before)) * scene.dt());
        }
        before = now;
    }
    let span = passes
        .last()
        .zip(passes.first())
        .map_or(f64::NAN, |(last, first)| last - first);
    Ok((passes.len() as f64 - 1.0) / span)
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let exact = [
        LOAD / (3.0 * YOUNG * INERTIA) + LOAD / SHEAR,
        LOAD / (8.0 * YOUNG * INERTIA) + LOAD / (2.0 * SHEAR),
    ];
    let mut figure = Figure::new(
        "b31_convergence",
        "B31: cantilever under a tip load, against the beam",
        ["cells along the beam (-)", "|error| (-)"],
    )
    .log();
    for (name, kind) in [
        ("QM6", CellKind::Quad4),
        ("T6", CellKind::Tri6),
        ("T3", CellKind::Tri3),
    ] {
        let mut errors = Vec::new();
        for n in [1, 2, 4] {
            let found = deflections(kind, [10 * n, n], sheet)?;
            errors.push([10.0 * n as f64, (found[0] / exact[0] - 1.0).abs()]);
            if n == 4 && kind != CellKind::Tri3 {
                sheet.relative(
                    format!("tip load, {name}, 40 x 4 (m)"),
                    exact[0],
                    found[0],
                    5e-3,
                );
                sheet.relative(
                    format!("own weight, {name}, 40 x 4 (m)"),
                    exact[1],
                    found[1],
                    5e-3,
                );
            } else if n == 4 {
                sheet.tell(
                    format!("tip load, {name}, 40 x 4: it locks (m)"),
                    exact[0],
                    found[0],
                );
            }
        }
        figure = figure.line(name, errors);
    }
    for (k, name) in ["first", "second"].into_iter().enumerate() {
        let found = measured(k, sheet)?;
        sheet.relative(
            format!("{name} frequency, QM6, 40 x 4 (Hz)"),
            frequency(k),
            found,
            5e-3,
        );
    }
    sheet.figure(figure);
    Ok(())
}
