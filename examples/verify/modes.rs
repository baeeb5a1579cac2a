//! Natural modes: NAFEMS' tapered membrane FV32 and the cantilever of B31.
//!
//! ```text
//!  |----____                  10 m long, 5 m to 1 m deep, plane stress, E = 200 GPa, ν = .3, 8000 kg/m³
//!  |        ----____|
//!  |                |         NAFEMS: 44.623, 130.03, 162.70, 246.05, 379.90, 391.44 Hz
//!  |    ____----
//!  |----
//! ```
//!
//! Exact: polynomials of degree 7 (of the cantilever 5) on cells that shrink towards the corners of the clamp, seven digits.
//!
//! Excellent: two per mille in the ten lowest with 24 x 12 cells.

use super::Outcome;
use super::figure::Figure;
use super::sheet::Sheet;
use super::statics::grid;
use foil2d::fe::modes::Modes;
use foil2d::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;

/// Hz.
const TAPERED: [f64; 10] = [
    44.61702, 130.00945, 162.68874, 245.98580, 379.71702, 391.40418, 522.57927, 564.69847,
    606.78759, 660.69514,
];
/// rad/s; the fourth stretches.
const CANTILEVER: [f64; 6] = [3.188095, 19.12517, 49.72932, 50.37570, 91.54408, 139.6117];

const KINDS: [(CellKind, &str); 3] = [
    (CellKind::Tri6, "T6"),
    (CellKind::Quad4, "QM6"),
    (CellKind::Tri3, "T3"),
];

fn modes_of(
    mesh: &Mesh,
    material: LinearElastic,
    n_modes: usize,
) -> Result<Modes, Box<dyn Error + Send + Sync>> {
    let body = FlexBodyBuilder::mesh(mesh.clone())
        .small_strain()
        .material(material)
        .contact_inertia(ContactInertia::Kept)
        .pin_where(|[x, _]| x == 0.0, Pin::both())
        .build()?;
    Ok(body.natural_modes(n_modes, 1e-9)?)
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let steel = LinearElastic::plane_stress(200e9, 0.3).density(8000.0);
    let soft = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let mut figure = Figure::new(
        "modes-tapered",
        "FV32: the boundary in three modes",
        ["x (m)", "y (m)"],
    );
    for (kind, name) in KINDS {
        let mesh = grid([24, 12], kind, |[s, t]| {
            [10.0 * s, (t - 0.5) * (5.0 - 4.0 * s)]
        })?;
        let found = modes_of(&mesh, steel, 10)?;
        for (k, (mode, exact)) in found.modes.iter().zip(TAPERED).enumerate() {
            let quantity = format!("FV32, frequency {}, {name}, 24 x 12 (Hz)", k + 1);
            put(sheet, kind, quantity, exact, mode.frequency() / TAU);
        }
        if kind == CellKind::Tri6 {
            for k in [0, 1, 3] {
                let title = format!("mode {}, {:.1} Hz", k + 1, found.modes[k].frequency() / TAU);
                figure = figure.line(&title, outline(&mesh, &found.modes[k].shape));
            }
        }
        let mesh = grid([40, 4], kind, |[s, t]| [s, 0.1 * t])?;
        let found = modes_of(&mesh, soft, 6)?;
        for (k, (mode, exact)) in found.modes.iter().zip(CANTILEVER).enumerate() {
            let quantity = format!("cantilever, frequency {}, {name}, 40 x 4 (rad/s)", k + 1);
            put(sheet, kind, quantity, exact, mode.frequency());
        }
    }
    sheet.figure(figure);
    Ok(())
}

/// Judges six-node triangles, and tells of the others.
fn put(sheet: &mut Sheet, kind: CellKind, quantity: String, exact: f64, found: f64) {
    if kind == CellKind::Tri6 {
        sheet.relative(quantity, exact, found, 2e-3);
    } else {
        sheet.tell(quantity, exact, found);
    }
}

/// The boundary as a mode moves it, by half a metre at most.
fn outline(mesh: &Mesh, shape: &[f64]) -> Vec<[f64; 2]> {
    let largest = shape.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let boundary = mesh.boundary();
    let nodes = boundary.nodes().iter().chain(boundary.nodes().first());
    nodes
        .map(|&node| {
            let x = mesh.nodes()[node];
            [0, 1].map(|axis| x[axis] + 0.5 * shape[2 * node + axis] / largest)
        })
        .collect()
}
