//! B43, a column between hinges, pressed beyond Euler's load until its ends have turned by 20° to 80°.
//!
//! ```text
//!  P -> o-----------o <- P        bowed at rest by 2e-5 of its length
//! ```
//!
//! Exact: elliptic integrals for `P/Pcr`, the distance of the ends and the deflection in the middle of a rod that neither stretches nor shears. A strip
//! is compressed by `P/EA = 8e-5`, and where its ends are as far apart as those of such a rod it is bent less: at 20°, where the ends have come nearer
//! by 3 %, its deflection is 1.35e-3 less, and its load 1.6e-4; its bow takes 1.8e-4 of the load there. So it is judged by a rod with its `EA`, `5/6 GA` (Reissner 1972)
//! and bow between the same ends, found by shooting, which without these is the exact one to all digits.
//!
//! Excellent: half a per mille of load and deflection. What is left is the mesh: on twice as many cells it is told, too. Eight-node cells from the straight
//! strip: one per mille of the load, half of one of the deflection.

use super::Outcome;
use super::column::{Column, Rod};
use super::figure::Figure;
use super::rods::{BAR, BENDING, HEIGHT, Strip};
use super::sheet::{Sheet, Size};
use foil2d::fe::mesh::CellKind;
use foil2d::large::{PathCase, PathEnd};
use std::error::Error;
use std::f64::consts::PI;

const EXACT: [(f64, [f64; 3]); 4] = [
    (20.0, [1.01539687, 0.969730907, 0.109706521]),
    (40.0, [1.06366327, 0.881203512, 0.211120170]),
    (60.0, [1.15171962, 0.741019606, 0.296603823]),
    (80.0, [1.29388932, 0.559395919, 0.359748552]),
];

/// What a strip of so many cells is where its ends have come as near as those of the exact columns: `[P/Pcr, deflection]`.
struct Found {
    places: Vec<[f64; 2]>,
    /// `[deflection, P/Pcr]`, for the picture.
    points: Vec<[f64; 2]>,
    n_limit_points: usize,
    note: String,
}

fn follow(n_cells: usize) -> Result<Found, Box<dyn Error + Send + Sync>> {
    let rise = |x: f64| BOW * (PI * x).sin();
    let strip = Strip::new(CellKind::Tri6, [n_cells, 1], rise)?;
    let find = |x: f64| strip.node(x, rise(x)).ok_or("the middle line has nodes");
    let (left, middle, right) = (find(0.0)?, find(0.5)?, find(1.0)?);
    let critical = PI * PI * BENDING;
    let mut load = vec![0.0; strip.rest.len()];
    load[2 * right] = -critical;
    let mut is_held = vec![false; strip.rest.len()];
    for dof in [2 * left, 2 * left + 1, 2 * right + 1] {
        is_held[dof] = true;
    }
    let mut path = strip.path(PathCase::dead(load, is_held, &strip.rest))?;
    let mut points = vec![[0.0, 0.0]];
    for part in [0.5, 0.9, 0.98, 0.995] {
        path.follow(PathEnd::Factor(part))?;
        points.push([path.positions()[2 * middle + 1], part]);
    }
    let mut places = Vec::new();
    for (_, [_, chord, _]) in EXACT {
        let dof = 2 * right;
        // In parts, for the picture.
        let from = path.positions()[dof];
        for part in 1..=5 {
            let place = from + (chord - from) * f64::from(part) / 5.0;
            let found = path.follow(PathEnd::Place { dof, place })?;
            points.push([path.positions()[2 * middle + 1], found.factor]);
        }
        places.push([path.point().factor, path.positions()[2 * middle + 1]]);
    }
    Ok(Found {
        places,
        points,
        n_limit_points: path.limit_points().len(),
        note: format!(
            "h/L = {HEIGHT}; {} increments, {} iterations",
            path.report().n_increments,
            path.report().n_iterations
        ),
    })
}

/// How far the strip is bowed at rest (m).
const BOW: f64 = 2e-5;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let found = follow(50)?;
    let is_short = matches!(sheet.size, Size::Steps(_));
    let fine = if is_short { None } else { Some(follow(100)?) };
    for (k, (angle, [factor, chord, deflection])) in EXACT.into_iter().enumerate() {
        let slender = Column::between(chord, angle, factor, Rod::default())?;
        let name = format!("the rod without EA at {angle}°: P/Pcr (-)");
        sheet.relative(name, factor, slender.factor, 1e-7);
        let own = Column::between(chord, angle, factor, Rod::strip(BOW))?;
        let [load, bent] = found.places[k];
        let name = format!("P/Pcr at an end slope of {angle}°, T6, 50 x 1 (-)");
        sheet.relative(name, own.factor, load, BAR);
        let name = format!("deflection over L at {angle}°, T6, 50 x 1 (-)");
        sheet.relative(name, own.deflection, bent, BAR);
        let name = format!("deflection over L at {angle}°, against a rod without EA (-)");
        sheet.tell(name, deflection, bent);
        if let Some([load, bent]) = fine.as_ref().map(|fine| fine.places[k]) {
            let name = format!("P/Pcr at {angle}°, T6, 100 x 1 (-)");
            sheet.tell(name, own.factor, load);
            let name = format!("deflection over L at {angle}°, T6, 100 x 1 (-)");
            sheet.tell(name, own.deflection, bent);
        }
    }
    straight(sheet)?;
    let n_limit_points = found.n_limit_points as f64;
    sheet.at_most("limit points on the way (-)", 0.0, n_limit_points);
    let exact = EXACT.map(|(_, [factor, _, deflection])| [deflection, factor]);
    sheet.figure(
        Figure::new(
            "b43-column",
            "column between hinges",
            ["deflection in the middle over L (-)", "P/Pcr (-)"],
        )
        .dots("elastica", exact.to_vec())
        .line("strip, h = L/100", found.points),
    );
    sheet.note(found.note);
    Ok(())
}

/// Without any imperfection: to the critical load of the straight strip, over to the path that crosses there, and along it.
fn straight(sheet: &mut Sheet) -> Outcome {
    // Triangles that lean one way would be an imperfection.
    let strip = Strip::new(CellKind::Quad8, [50, 1], |_| 0.0)?;
    let find = |x: f64| strip.node(x, 0.0).ok_or("the middle line has nodes");
    let (left, middle, right) = (find(0.0)?, find(0.5)?, find(1.0)?);
    let mut load = vec![0.0; strip.rest.len()];
    load[2 * right] = -PI * PI * BENDING;
    let mut is_held = vec![false; strip.rest.len()];
    for dof in [2 * left, 2 * left + 1, 2 * right + 1] {
        is_held[dof] = true;
    }
    let mut path = strip.path(PathCase::dead(load, is_held, &strip.rest))?;
    let branch = path.follow_to_branch()?;
    sheet.relative(
        "critical load of the straight strip over Pcr (-)",
        1.0,
        branch.factor,
        1e-3,
    );
    path.switch(&branch, 0.02)?;
    for (angle, [factor, chord, _]) in EXACT {
        let dof = 2 * right;
        let found = path.follow(PathEnd::Place { dof, place: chord })?;
        let own = Column::between(chord, angle, factor, Rod::strip(0.0))?;
        let name = format!("P/Pcr at an end slope of {angle}°, from the straight strip (-)");
        sheet.relative(name, own.factor, found.factor, 1e-3);
        let found = path.positions()[2 * middle + 1].abs();
        let name = format!("deflection over L at {angle}°, from the straight strip (-)");
        sheet.relative(name, own.deflection, found, BAR);
    }
    Ok(())
}
