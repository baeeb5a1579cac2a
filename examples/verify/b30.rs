//! B30, a beam that is spun up about its end.
//!
//! Source: Simo and Vu-Quoc (1986).
//!
//! ```text
//!   o=====================      L = 10, EA = 2.8e7, EI = 1.4e4, rho A = 1.2
//!   ↺ to 6 rad/s in 15 s        angle 6/15 (t²/2 + (15/2π)² (cos(2πt/15) - 1))
//! ```
//!
//! Exact: while it is spun up the end lags by at most .575 at 6.77 s; then it is longer by `ρA ω² L³/3EA` = 5.143e-4. A beam that bends little in a frame that turns,
//! with the stiffness of its centrifugal force, by Galerkin's method with eight functions, gives .5744 at 6.762 s.
//!
//! The strip is h = √(12 EI/EA) high and 1 thick, with ν = 0. Its mean length is taken over what is left of its vibration.
//!
//! Excellent: 0.5 %.

use super::Outcome;
use super::figure::Figure;
use super::sheet::Sheet;
use foil2d::body::Pin;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};
use std::f64::consts::TAU;

const LENGTH: f64 = 10.0;
const STRETCHING: f64 = 2.8e7;
const BENDING: f64 = 1.4e4;
/// Full speed (rad/s), and when it is reached (s).
const SPEED: f64 = 6.0;
const SPUN: f64 = 15.0;

fn angle(t: f64) -> f64 {
    if t > SPUN {
        return SPEED * (t - 0.5 * SPUN);
    }
    let period = SPUN / TAU;
    SPEED / SPUN * (0.5 * t * t + period * period * ((t / period).cos() - 1.0))
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let height = (12.0 * BENDING / STRETCHING).sqrt();
    let dt = sheet.choose(0.01, 0.02);
    let mesh = generate::rectangle([LENGTH, height], [20, 1], CellKind::Tri6)?;
    let law = Corotated::plane_strain(STRETCHING / height, 0.0);
    let mut description = FiniteStrainDescription::new(mesh, law, 1.2 / height);
    for p in description.rest_positions.chunks_exact_mut(2) {
        p[1] -= 0.5 * height;
    }
    let rest = description.rest_positions.clone();
    let near = |p: &[f64]| (p[0] - LENGTH).hypot(p[1]) < 1e-9;
    let tip = rest
        .chunks_exact(2)
        .position(near)
        .ok_or("the end has a middle")?;
    let model = FiniteStrainModel::assemble(description)?;
    let mut motion = WorldMotion::at_rest(&model);
    let load = vec![0.0; model.n_dofs()];
    let settings = LargeSettings::damped(0.9).with_tolerance(1e-8);
    let mut stepper = LargeStepper::new(model, settings)?;
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let root: Vec<usize> = (0..rest.len() / 2)
        .filter(|node| rest[2 * node] == 0.0)
        .collect();
    let (mut lag, mut lag_at) = (0.0f64, 0.0);
    let mut stretched = Vec::new();
    let mut curve = Vec::new();
    let n_steps = sheet.n_steps((25.0 / dt) as usize);
    for step in 1..=n_steps {
        let t = step as f64 * dt;
        let (sin, cos) = angle(t).sin_cos();
        for &node in &root {
            // Held nodes go where the velocity that they have leads them.
            let y = rest[2 * node + 1];
            for (axis, place) in [-sin * y, cos * y].into_iter().enumerate() {
                let dof = 2 * node + axis;
                motion.velocity[dof] = (place - motion.position[dof]) / dt;
            }
        }
        stepper.step(dt, &load, &mut motion)?;
        let [x, y] = [motion.position[2 * tip], motion.position[2 * tip + 1]];
        let [along, across] = [cos * x + sin * y - LENGTH, cos * y - sin * x];
        if across < lag {
            (lag, lag_at) = (across, t);
        }
        if t > SPUN {
            // What the bent middle line is shorter by, were it straight: its vibration is small.
            stretched.push(along);
        }
        if step % 5 == 0 {
            curve.push([t, across]);
        }
    }
    let mean = stretched.iter().sum::<f64>() / stretched.len().max(1) as f64;
    sheet.relative("largest lag of the end (m)", -0.575, lag, 5e-3);
    sheet.relative("when it lags most (s)", 6.77, lag_at, 5e-3);
    let steady = 1.2 * SPEED * SPEED * LENGTH.powi(3) / (3.0 * STRETCHING);
    sheet.relative("steady extension (m)", steady, mean, 5e-3);
    sheet.figure(
        Figure::new(
            "b30-lag",
            "spin-up beam: lag of the end",
            ["time (s)", "lag (m)"],
        )
        .dots("derived", vec![[6.77, -0.575]])
        .line("strip", curve),
    );
    Ok(())
}
