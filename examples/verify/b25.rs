//! B25, Cook's membrane: skewed cells in bending and shear at once.
//!
//! Source: Cook (1974); the values are converged solutions of plane elasticity.
//!
//! ```text
//!                 . (48, 60)
//!            .    |
//!  (0, 44)        | ^ F = 1, spread evenly
//!   |             | |
//!   |             . (48, 44)
//!   |        .           clamped at x = 0, thickness 1, E = 1, nu = 1/3
//!  (0, 0)
//! ```
//!
//! Exact: the middle of the loaded side rises by 23.968 (plane stress). Told besides: plane strain (E = 70, traction 6.25:
//! corner 32.24) and nearly incompressible plane strain (E = 240.565, nu = .4999, F = 100: 7.695 in the middle).
//!
//! Excellent: .99 with 16 × 16 cells.

use super::Outcome;
use super::figure::Figure;
use super::scene::node_at;
use super::sheet::Sheet;
use super::statics::{SETTLE, grid, loaded, still, traction};
use foil2d::prelude::*;
use std::error::Error;

const EXACT: f64 = 23.968;

/// Upward displacement of the node at a place.
fn rise(
    kind: CellKind,
    n: usize,
    material: LinearElastic,
    pull: f64,
    place: [f64; 2],
    sheet: &Sheet,
) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let mesh = grid([n, n], kind, |[s, t]| {
        [48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s)]
    })?;
    let forces = traction(&mesh, kind, [0.0, pull], |[x, _]| x > 48.0 - 1e-9);
    // Tip load over deflection, against a quarter of the mass of density 1.
    let mut scene = still((material.young() / (24.0 * 360.0)).sqrt())?;
    let builder = FlexBodyBuilder::mesh(mesh)
        .small_strain()
        .material(material)
        .contact_inertia(ContactInertia::Kept)
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let body = scene.add(loaded(builder, forces))?;
    scene.steps(sheet.n_steps(SETTLE))?;
    let body = scene.body(body);
    Ok(body.displacement(node_at(body, place))[1])
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let stress = LinearElastic::plane_stress(1.0, 1.0 / 3.0).density(1.0);
    let elements = [
        ("QM6", CellKind::Quad4),
        ("T6", CellKind::Tri6),
        ("T3", CellKind::Tri3),
    ];
    let mut figure = Figure::new(
        "b25_convergence",
        "B25: Cook's membrane, error of the rise",
        ["cells along a side (-)", "|error| (-)"],
    )
    .log();
    for (name, kind) in elements {
        let mut errors = Vec::new();
        for n in [2, 4, 8, 16] {
            let found = rise(kind, n, stress, 1.0 / 16.0, [48.0, 52.0], sheet)?;
            errors.push([n as f64, (found / EXACT - 1.0).abs()]);
            if n == 16 && kind != CellKind::Tri3 {
                sheet.at_least(
                    format!("rise, {name}, 16 x 16, of the exact (-)"),
                    0.99,
                    found / EXACT,
                );
            } else if n == 16 {
                sheet.tell(format!("rise, {name}, 16 x 16 (m)"), EXACT, found);
            }
        }
        let order = (errors[1][1] / errors[2][1]).log2();
        // Re-entrant stress at the clamped corner holds the order below the elements' own of two.
        sheet.tell(
            format!("order of convergence from 4 to 8, {name} (2: smooth)"),
            2.0,
            order,
        );
        figure = figure.line(name, errors);
    }
    let strain = LinearElastic::plane_strain(70.0, 1.0 / 3.0).density(1.0);
    let nearly = LinearElastic::plane_strain(240.565, 0.4999).density(1.0);
    for (name, kind) in [("QM6", CellKind::Quad4), ("T6", CellKind::Tri6)] {
        let corner = rise(kind, 16, strain, 6.25, [48.0, 60.0], sheet)?;
        sheet.tell(format!("plane strain, corner, {name} (m)"), 32.24, corner);
        let corner = rise(kind, 16, nearly, 6.25, [48.0, 52.0], sheet)?;
        sheet.tell(format!("nu = .4999, middle, {name} (m)"), 7.695, corner);
    }
    sheet.figure(figure);
    Ok(())
}
