//! B43, a column between hinges, pressed beyond Euler's load until its ends have turned by 20° to 80°.
//!
//! ```text
//!  P -> o-----------o <- P        bowed at rest by 2e-5 of its length
//! ```
//!
//! Exact: elliptic integrals for `P/Pcr`, the distance of the ends and the deflection in the middle. The path is that of the load.
//!
//! Excellent: half a per mille of the load, two of the deflection: at 20° the compression 8e-5 takes three per mille of the way of the ends.

use super::Outcome;
use super::figure::Figure;
use super::rods::{BAR, BENDING, HEIGHT, Strip};
use super::sheet::Sheet;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{PathCase, PathEnd};
use std::f64::consts::PI;

const EXACT: [(f64, [f64; 3]); 4] = [
    (20.0, [1.01539687, 0.969730907, 0.109706521]),
    (40.0, [1.06366327, 0.881203512, 0.211120170]),
    (60.0, [1.15171962, 0.741019606, 0.296603823]),
    (80.0, [1.29388932, 0.559395919, 0.359748552]),
];

pub fn run(sheet: &mut Sheet) -> Outcome {
    let strip = Strip::new(CellKind::Tri6, [50, 1], |x| 2e-5 * (PI * x).sin())?;
    let rise = |x: f64| 2e-5 * (PI * x).sin();
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
    for (angle, [factor, chord, deflection]) in EXACT {
        let dof = 2 * right;
        // In parts, for the picture.
        let from = path.positions()[dof];
        for part in 1..=5 {
            let place = from + (chord - from) * f64::from(part) / 5.0;
            let found = path.follow(PathEnd::Place { dof, place })?;
            points.push([path.positions()[2 * middle + 1], found.factor]);
        }
        let found = path.point();
        let name = format!("P/Pcr at an end slope of {angle}°, T6, 50 x 1 (-)");
        sheet.relative(name, factor, found.factor, BAR);
        let name = format!("deflection over L at {angle}°, T6, 50 x 1 (-)");
        sheet.relative(name, deflection, path.positions()[2 * middle + 1], 2e-3);
    }
    straight(sheet)?;
    sheet.at_most(
        "limit points on the way (-)",
        0.0,
        path.limit_points().len() as f64,
    );
    let exact = EXACT.map(|(_, [factor, _, deflection])| [deflection, factor]);
    sheet.figure(
        Figure::new(
            "b43-column",
            "column between hinges",
            ["deflection in the middle over L (-)", "P/Pcr (-)"],
        )
        .dots("elastica", exact.to_vec())
        .line("strip, h = L/100", points),
    );
    sheet.note(format!(
        "h/L = {HEIGHT}; {} increments, {} iterations",
        path.report().n_increments,
        path.report().n_iterations
    ));
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
    for (angle, [factor, chord, deflection]) in EXACT {
        let dof = 2 * right;
        let found = path.follow(PathEnd::Place { dof, place: chord })?;
        let name = format!("P/Pcr at an end slope of {angle}°, from the straight strip (-)");
        sheet.relative(name, factor, found.factor, 1e-3);
        let found = path.positions()[2 * middle + 1].abs();
        let name = format!("deflection over L at {angle}°, from the straight strip (-)");
        sheet.relative(name, deflection, found, 2e-3);
    }
    Ok(())
}
