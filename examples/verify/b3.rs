//! B3, two bars: the collision that every impact code is shown.
//!
//! Source: Hughes, Taylor, Sackman, Curnier and Kanoknukulchai (1976), and many since.
//!
//! ```text
//!      v0 -->                  <-- v0          force
//!   +-----------------+    +-----------------+   |   +--------+  133.45 kN
//!   |     20 x 1      |    |     20 x 1      |   |   |        |
//!   +-----------------+    +-----------------+   +---+--------+----
//!          0.254 m   0.508 mm                       49.46  148.39 us
//! ```
//!
//! Data: E = 206.8 GPa, rho = 7844.07 kg/m³, nu = 0, section (25.4 mm)², v0 = 5.13588 m/s, steps of 1 µs.
//!
//! Exact: force `rho c v0 A` from 49.46 µs for `2 L / c`; the bars exchange their velocities.
//!
//! Excellent: plateau to 0.5 %, exit velocity >= .99 of the exact one, energy to 0.5 %.

use super::Outcome;
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use foil2d::prelude::*;

const LENGTH: f64 = 0.254;
const SIDE: f64 = 0.0254;
const SPEED: f64 = 5.13588;
const GAP: f64 = 0.508e-3;
const YOUNG: f64 = 206.8e9;
const DENSITY: f64 = 7844.07;
const DT: f64 = 1e-6;

/// A bar with its left end at `x`; `height` times thickness is the section of every bar.
fn bar(x: f64, height: f64, velocity: f64, contact_nodes: [usize; 2]) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([LENGTH, height], [20, 1])
        .material(LinearElastic::plane_stress(YOUNG, 0.0).density(DENSITY))
        .thickness(SIDE * SIDE / height)
        // One cell thick: all nodes are on the boundary, and only those that meet may give up their inertia.
        .contact_inertia(ContactInertia::RedistributedAt(contact_nodes.to_vec()))
        .translation([x, -0.5 * height])
        .linvel([velocity, 0.0])
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut scene = Scene::new(DT, Beta2::trapezoidal());
    // The right bar is 1 % taller and as much thinner, so that the left one's corners meet its face inside the corners.
    let left = scene.add(bar(-LENGTH - 0.5 * GAP, SIDE, SPEED, [20, 41]))?;
    let right = scene.add(bar(0.5 * GAP, 1.01 * SIDE, -SPEED, [0, 21]))?;
    let total = |scene: &Scene| {
        let energies = [left, right].map(|bar| scene.body(bar).energy());
        energies.iter().map(|e| e.kinetic + e.elastic).sum::<f64>()
    };
    let at_start = total(&scene);
    let (mut forces, mut drift, mut momentum) = (Vec::new(), 0.0f64, 0.0f64);
    for step in 1..=sheet.n_steps(200) {
        scene.step()?;
        forces.push([step as f64 * scene.dt(), scene.force_on(right)[0]]);
        drift = drift.max((total(&scene) / at_start - 1.0).abs());
        let sum = scene.body(left).momentum()[0] + scene.body(right).momentum()[0];
        momentum = momentum.max(sum.abs() / (scene.body(left).mass() * SPEED));
    }
    judge(sheet, &forces);
    let exit = [left, right].map(|bar| scene.body(bar).linvel()[0].abs() / SPEED);
    sheet.at_least("exit velocity, of the exact (-)", 0.99, exit[0].min(exit[1]));
    sheet.absolute("largest change of energy (-)", 0.0, drift, 5e-3);
    sheet.absolute("momentum, of one bar's (-)", 0.0, momentum, 1e-10);
    Ok(())
}

fn judge(sheet: &mut Sheet, forces: &[[f64; 2]]) {
    let wave = (YOUNG / DENSITY).sqrt();
    let plateau = DENSITY * wave * SPEED * SIDE * SIDE;
    let touch = 0.5 * GAP / SPEED;
    let release = touch + 2.0 * LENGTH / wave;
    // Fronts are a few cells wide, here a fifth of the plateau at each end.
    let margin = 0.2 * (release - touch);
    let middle = forces.iter().filter(|f| (touch + margin..release - margin).contains(&f[0]));
    let (n, sum) = middle.fold((0.0, 0.0), |(n, sum), f| (n + 1.0, sum + f[1]));
    sheet.relative("mean force of the plateau (N)", plateau, sum / n, 5e-3);
    let pressed: Vec<f64> = forces.iter().filter(|f| f[1] > 0.0).map(|f| f[0]).collect();
    let first = pressed.first().map_or(f64::NAN, |t| t - DT);
    let last = pressed.last().copied().unwrap_or(f64::NAN);
    // The force acts within the step in which the gap closes; a wave crosses a cell in 2.5 steps.
    sheet.absolute("first contact (s)", touch, first, 2.5 * DT);
    sheet.absolute("last contact (s)", release, last, 2.5 * DT);
    let exact = vec![[0.0, 0.0], [touch, 0.0], [touch, plateau], [release, plateau], [release, 0.0], [2e-4, 0.0]];
    sheet.figure(
        Figure::new("b3_force", "B3: force between two steel bars", ["time (s)", "contact force (N)"])
            .exact("exact", exact)
            .line("trapezoidal, redistributed mass", forces.to_vec()),
    );
}
