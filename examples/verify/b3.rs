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
//! Data: consistent mass, that of the nodes that meet moved to those behind; trapezoidal rule. A lumped mass slows the short waves of
//! 20 cells: it is told beside it, and leaves at .968 of the velocity. E = 206.8 GPa, rho = 7844.07 kg/m³, nu = 0, section (25.4 mm)², v0 = 5.13588 m/s, steps of 1 µs.
//!
//! Exact: force `rho c v0 A` from 49.46 µs for `2 L / c`; the bars exchange their velocities.
//!
//! Excellent: plateau to 0.5 %, exit velocity >= .99 of the exact one, energy to 0.5 %.

use super::Outcome;
use super::bars::Mass;
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use foil2d::prelude::*;
use std::error::Error;

const LENGTH: f64 = 0.254;
const SIDE: f64 = 0.0254;
const SPEED: f64 = 5.13588;
const GAP: f64 = 0.508e-3;
const YOUNG: f64 = 206.8e9;
const DENSITY: f64 = 7844.07;
const DT: f64 = 1e-6;
/// Begin and end of the contact (s): half the gap at v0, and twice the length at 5134.6 m/s later.
const TOUCH: f64 = 0.5 * GAP / SPEED;
const RELEASE: f64 = TOUCH + 2.0 * LENGTH / 5_134.575_4;
/// `rho c v0 A` (N).
const PLATEAU: f64 = DENSITY * 5_134.575_4 * SPEED * SIDE * SIDE;

/// A bar with its left end at `x`; `height` times thickness is the section of every bar.
fn bar(
    mass: Mass,
    n: usize,
    x: f64,
    height: f64,
    velocity: f64,
    contact_nodes: [usize; 2],
) -> FlexBodyBuilder {
    let (kind, inertia) = match mass {
        // One cell thick: all nodes are on the boundary, and only those that meet may give up their inertia.
        Mass::Redistributed => (
            MassKind::Lumped,
            ContactInertia::RedistributedAt(contact_nodes.to_vec()),
        ),
        Mass::ConsistentRedistributed => (
            MassKind::Consistent,
            ContactInertia::RedistributedAt(contact_nodes.to_vec()),
        ),
        Mass::Kept => (MassKind::Lumped, ContactInertia::Kept),
        Mass::Consistent => (MassKind::Consistent, ContactInertia::Kept),
    };
    FlexBodyBuilder::rectangle([LENGTH, height], [n, 1])
        .small_strain()
        .material(LinearElastic::plane_stress(YOUNG, 0.0).density(DENSITY))
        .thickness(SIDE * SIDE / height)
        .mass_kind(kind)
        .contact_inertia(inertia)
        .translation([x, -0.5 * height])
        .linvel([velocity, 0.0])
}

/// What a collision showed.
struct Collision {
    /// Time and force at the end of each step.
    forces: Vec<[f64; 2]>,
    exit: f64,
    energy_error: f64,
    momentum_error: f64,
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let collision = collide(Mass::ConsistentRedistributed, 20, DT, sheet)?;
    judge(sheet, &collision.forces);
    sheet.at_least("exit velocity, of the exact (-)", 0.99, collision.exit);
    sheet.absolute(
        "largest change of energy (-)",
        0.0,
        collision.energy_error,
        5e-3,
    );
    sheet.absolute(
        "momentum, of one bar's (-)",
        0.0,
        collision.momentum_error,
        1e-10,
    );
    for (name, mass) in [
        ("moved lumped", Mass::Redistributed),
        ("lumped", Mass::Kept),
        ("consistent", Mass::Consistent),
    ] {
        let collision = collide(mass, 20, DT, sheet)?;
        sheet.tell(
            format!("mean force of the plateau, {name} mass (N)"),
            PLATEAU,
            plateau(&collision.forces),
        );
        sheet.tell(
            format!("exit velocity, {name} mass, of the exact (-)"),
            1.0,
            collision.exit,
        );
        sheet.tell(
            format!("1 + largest change of energy, {name} mass (-)"),
            1.0,
            1.0 + collision.energy_error,
        );
    }
    let fine = collide(Mass::ConsistentRedistributed, 80, 0.25 * DT, sheet)?;
    sheet.tell(
        "exit velocity, 80 cells and a quarter of the step",
        1.0,
        fine.exit,
    );
    Ok(())
}

fn collide(
    mass: Mass,
    n: usize,
    dt: f64,
    sheet: &Sheet,
) -> Result<Collision, Box<dyn Error + Send + Sync>> {
    let mut scene = Scene::new(dt, Beta2::trapezoidal());
    // The right bar is 1 % taller and as much thinner, so that the left one's corners meet its face inside the corners.
    let left = scene.add(bar(
        mass,
        n,
        -LENGTH - 0.5 * GAP,
        SIDE,
        SPEED,
        [n, 2 * n + 1],
    ))?;
    let right = scene.add(bar(mass, n, 0.5 * GAP, 1.01 * SIDE, -SPEED, [0, n + 1]))?;
    let total = |scene: &Scene| {
        let energies = [left, right].map(|bar| scene.body(bar).energy());
        energies.iter().map(|e| e.kinetic + e.elastic).sum::<f64>()
    };
    let at_start = total(&scene);
    let (mut forces, mut energy_error, mut momentum_error) = (Vec::new(), 0.0f64, 0.0f64);
    for step in 1..=sheet.n_steps((2e-4 / dt).round() as usize) {
        scene.step()?;
        forces.push([step as f64 * scene.dt(), scene.force_on(right)[0]]);
        energy_error = energy_error.max((total(&scene) / at_start - 1.0).abs());
        let sum = scene.body(left).momentum()[0] + scene.body(right).momentum()[0];
        momentum_error = momentum_error.max(sum.abs() / (scene.body(left).mass() * SPEED));
    }
    let exit = [left, right].map(|bar| scene.body(bar).linvel()[0].abs() / SPEED);
    Ok(Collision {
        forces,
        exit: exit[0].min(exit[1]),
        energy_error,
        momentum_error,
    })
}

/// Mean force between the fronts, which are a few cells wide: the middle half of the contact (N).
fn plateau(forces: &[[f64; 2]]) -> f64 {
    let margin = 0.25 * (RELEASE - TOUCH);
    let middle = forces
        .iter()
        .filter(|f| (TOUCH + margin..RELEASE - margin).contains(&f[0]));
    let (n, sum) = middle.fold((0.0, 0.0), |(n, sum), f| (n + 1.0, sum + f[1]));
    sum / n
}

fn judge(sheet: &mut Sheet, forces: &[[f64; 2]]) {
    sheet.relative(
        "mean force of the plateau (N)",
        PLATEAU,
        plateau(forces),
        5e-3,
    );
    let pressed: Vec<f64> = forces.iter().filter(|f| f[1] > 0.0).map(|f| f[0]).collect();
    let first = pressed.first().map_or(f64::NAN, |t| t - DT);
    let last = pressed.last().copied().unwrap_or(f64::NAN);
    // The force acts within the step in which the gap closes; a wave crosses a cell in 2.5 steps.
    sheet.absolute("first contact (s)", TOUCH, first, 2.5 * DT);
    sheet.absolute("last contact (s)", RELEASE, last, 2.5 * DT);
    let scaled = |[time, force]: [f64; 2]| [1e6 * time, 1e-3 * force];
    let exact = [
        [0.0, 0.0],
        [TOUCH, 0.0],
        [TOUCH, PLATEAU],
        [RELEASE, PLATEAU],
        [RELEASE, 0.0],
        [2e-4, 0.0],
    ];
    sheet.figure(
        Figure::new(
            "b3_force",
            "B3: force between two steel bars",
            ["time (µs)", "contact force (kN)"],
        )
        .exact("exact", exact.map(scaled).to_vec())
        .line(
            "trapezoidal, moved consistent mass",
            forces.iter().copied().map(scaled).collect(),
        ),
    );
}
