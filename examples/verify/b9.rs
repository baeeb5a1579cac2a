//! B9, the contact patch test: uniform pressure through meshes that do not match.
//!
//! Source: Taylor and Papadopoulos (1991).
//!
//! ```text
//!           v v v v v v v      pressed by 0.1
//!           +-+-+-+-+-+-+
//!           | 7 x 7 cells |      E = 2e6, nu = 0
//!    v p v  +-+-+-+-+-+-+  v p v
//!   +---+---+--+--+--+--+---+---+
//!   |       5 x 5 cells below    |   interface without friction
//!   +---+---+--+--+--+--+---+---+
//!   =============================
//! ```
//!
//! The lower block goes on for two cells on either side, under the same pressure, so that no corner stands on a corner.
//!
//! Exact: p = 1e5 everywhere, the interface sinks by 0.05.
//!
//! One-sided node-to-segment contact fails this test by some per cent: each contactor node hands its force to the two target
//! nodes around it, and where meshes do not match no such forces are the load of a uniform pressure. Here the nodes of both
//! surfaces are held on the edges of the other. Together they have forces that press both meshes uniformly, and the solver
//! finds them: mean, sink and the pressures at the nodes of both surfaces are exact to 3e-9. The pressures of meshes that
//! do not match are told; resultant and mean displacement are judged.
//!
//! Excellent: with a mortar 1e-10, with one-sided node-to-segment a mean to 1 %.

use super::Outcome;
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use super::statics::{grid, loaded, press, still, traction};
use foil2d::prelude::*;

const PRESSURE: f64 = 1e5;
const SINK: f64 = -0.05;

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (name, n_lower, n_upper) in [("5 below 7", 5, 7), ("7 below 5", 7, 5), ("matching", 5, 5)] {
        patch(sheet, name, n_lower, n_upper)?;
    }
    Ok(())
}

fn patch(sheet: &mut Sheet, name: &str, n_lower: usize, n_upper: usize) -> Outcome {
    // The slowest vibration of the stack, for E = 2e6 and density 1000.
    let mut scene = still(35.0)?;
    let block = |builder: FlexBodyBuilder| {
        let material = LinearElastic::plane_stress(2e6, 0.0).density(1000.0);
        builder.material(material).friction(0.0)
    };
    let cell = 1.0 / n_lower as f64;
    let mesh = grid([n_lower + 4, n_lower], CellKind::Quad4, |[s, t]| {
        [-2.0 * cell + s * (1.0 + 4.0 * cell), t]
    })?;
    let is_beside = |[x, y]: [f64; 2]| y == 1.0 && !(1e-6..=1.0 - 1e-6).contains(&x);
    let beside = traction(&mesh, CellKind::Quad4, [0.0, -PRESSURE], is_beside);
    let lower =
        block(FlexBodyBuilder::mesh(mesh).small_strain()).pin_where(|[_, y]| y == 0.0, Pin::both());
    let upper = block(FlexBodyBuilder::rectangle([1.0, 1.0], [n_upper, n_upper]).small_strain())
        .translation([0.0, 1.0])
        .pin_where(|[_, y]| y == 1.0, Pin::both());
    scene.add(loaded(lower, beside))?;
    let upper = scene.add(upper)?;
    let n = scene.body(upper).n_nodes();
    let top: Vec<usize> = (n - n_upper - 1..n).collect();
    press(&mut scene, sheet, upper, &top, [0.0, -0.1])?;
    let force = scene.force_on(upper)[1];
    sheet.relative(format!("{name}: mean pressure (Pa)"), PRESSURE, force, 1e-2);
    let sunk: Vec<f64> = (0..=n_upper)
        .map(|node| scene.body(upper).displacement(node)[1])
        .collect();
    let mean = sunk.iter().sum::<f64>() / sunk.len() as f64;
    sheet.relative(
        format!("{name}: mean sink of the interface (m)"),
        SINK,
        mean,
        2e-2,
    );
    let pressures = pressures(&scene);
    let worst = pressures
        .iter()
        .fold(0.0f64, |worst, p| worst.max((p[1] / PRESSURE - 1.0).abs()));
    if name == "matching" {
        sheet.absolute(
            format!("{name}: largest error of a nodal pressure (-)"),
            0.0,
            worst,
            1e-9,
        );
    } else {
        sheet.tell(
            format!("{name}: 1 + largest error of a nodal pressure (-)"),
            1.0,
            1.0 + worst,
        );
        sheet.figure(
            Figure::new(
                if n_lower == 5 {
                    "b9_pressure_5_7"
                } else {
                    "b9_pressure_7_5"
                },
                format!("B9: nodal pressures, {name} cells"),
                ["place (m)", "pressure (Pa)"],
            )
            .exact("exact", vec![[0.0, PRESSURE], [1.0, PRESSURE]])
            .dots("nodes of both surfaces", pressures),
        );
    }
    Ok(())
}

/// Place and pressure of each contact: its force over the part of the face nearest to it.
fn pressures(scene: &Scene) -> Vec<[f64; 2]> {
    let contacts = scene.flex.report().contacts();
    let mut at: Vec<[f64; 2]> = contacts
        .iter()
        .map(|c| [c.position[0], c.normal_force])
        .collect();
    at.sort_by(|a, b| a[0].total_cmp(&b[0]));
    spread(&at)
}

/// Forces at places made pressures: each acts on the half of the way to its neighbours.
pub fn spread(forces: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = forces.len();
    let place = |k: usize| forces[k][0];
    (0..n)
        .map(|k| {
            let left = if k > 0 {
                0.5 * (place(k) - place(k - 1))
            } else {
                0.0
            };
            let right = if k + 1 < n {
                0.5 * (place(k + 1) - place(k))
            } else {
                0.0
            };
            [place(k), forces[k][1] / (left + right)]
        })
        .collect()
}
