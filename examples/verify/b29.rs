//! B29, MacNeal and Harder's straight beam: six cells, straight or distorted.
//!
//! Source: MacNeal and Harder, Finite Elements in Analysis and Design 1 (1985).
//!
//! ```text
//!  /|----+----+----+----+----+----|     rectangles
//!  /|-------\    /--------\    /--|     trapezoids
//!  /|----/----/----/----/----/----|     parallelograms      6 × 0.2 × 0.1, E = 1e7, nu = 0.3
//! ```
//!
//! Exact: a unit load at the tip lengthens the beam by 3.0e-5 and bends it by 0.1081.
//!
//! Excellent: .99 for rectangles. On one layer of distorted four-node cells no element that passes the patch test bends
//! well (MacNeal 1987): published answers of others are .62 and .05; six-node triangles on the same walls are told beside.

use super::Outcome;
use super::scene::node_at;
use super::sheet::Sheet;
use super::statics::{SETTLE, grid, loaded, still, traction};
use foil2d::prelude::*;
use std::error::Error;

/// How far the upper end of wall `k` of seven leans, in units of half the height.
type Lean = fn(usize) -> f64;

const WALLS: [(&str, Lean); 3] = [
    ("rectangles", |_| 0.0),
    (
        "parallelograms",
        |wall| if wall % 6 == 0 { 0.0 } else { 1.0 },
    ),
    ("trapezoids", |wall| match wall % 6 {
        0 => 0.0,
        odd if odd % 2 == 1 => 1.0,
        _ => -1.0,
    }),
];

fn tip(
    kind: CellKind,
    lean: Lean,
    pull: [f64; 2],
    sheet: &Sheet,
) -> Result<[f64; 2], Box<dyn Error + Send + Sync>> {
    let mesh = grid([6, 1], kind, |[s, t]| {
        let wall = (6.0 * s).round() as usize;
        [6.0 * s + lean(wall) * 0.1 * (2.0 * t - 1.0), 0.2 * t]
    })?;
    let forces = traction(&mesh, kind, pull.map(|f| f / 0.2), |[x, _]| x > 6.0 - 1e-9);
    let mut scene = still(17.8)?;
    let builder = FlexBodyBuilder::mesh(mesh)
        .small_strain()
        .material(LinearElastic::plane_stress(1e7, 0.3).density(1.0))
        .thickness(0.1)
        .contact_inertia(ContactInertia::Kept)
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let body = scene.add(loaded(builder, forces))?;
    scene.steps(sheet.n_steps(SETTLE))?;
    let body = scene.body(body);
    let [low, high] = [0.0, 0.2].map(|y| body.displacement(node_at(body, [6.0, y])));
    Ok([0, 1].map(|axis| 0.5 * (low[axis] + high[axis])))
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (element, kind) in [("QM6", CellKind::Quad4), ("T6", CellKind::Tri6)] {
        for (name, lean) in WALLS {
            let stretch = tip(kind, lean, [1.0, 0.0], sheet)?[0];
            let bend = tip(kind, lean, [0.0, 1.0], sheet)?[1];
            // The clamp holds the contraction too, which stiffens the beam by half a per cent.
            sheet.relative(
                format!("extension, {element}, {name} (m)"),
                3.0e-5,
                stretch,
                1e-2,
            );
            if name == "rectangles" && kind == CellKind::Quad4 {
                sheet.at_least(
                    format!("bending, {element}, {name}, of 0.1081 (-)"),
                    0.99,
                    bend / 0.1081,
                );
            } else {
                sheet.tell(format!("bending, {element}, {name} (m)"), 0.1081, bend);
            }
        }
    }
    Ok(())
}
