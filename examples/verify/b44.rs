//! B44, Lee's frame: pushed down near its corner it gives way, snaps, and pushes back.
//!
//! ```text
//!        24  | P                EI = 1440, both legs 120 long, both ends hinged
//!   .--------v-----------o
//!   |                           u, v: how far the loaded point goes right and down
//!   |          120
//!   o
//! ```
//!
//! Exact: rods that do not stretch, by shooting. The corner of a frame of plane legs gives way less than that of rods, by about their thickness
//! t: legs of t = L/75 and L/150 are told, and what they tend to if that is linear is judged. The second limit load lies on the way on which the
//! frame snaps.
//!
//! Excellent: half a per mille of the limit load; two of the others, where the parts of t² show.

use super::Outcome;
use super::figure::Figure;
use super::frame::frame;
use super::sheet::{Sheet, Size};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::large::{PathCase, PathEnd, PathSettings, PathStepper};
use std::error::Error;

/// Loads at v = 10, 20, 30, 40, the limit load, and the least one.
const EXACT: [(&str, f64); 6] = [
    ("load at v = 10", 0.96355),
    ("load at v = 20", 1.34579),
    ("load at v = 30", 1.59530),
    ("load at v = 40", 1.78078),
    ("limit load", 1.855876),
    ("least load", -0.942128),
];
/// Which of them is the one that the frame is known by.
const LIMIT: usize = 4;
/// Where the loaded point is at both limit loads, `[v, u]`.
const PLACES: [[f64; 2]; 2] = [[48.7412, 26.8891], [58.1999, 90.2115]];

struct Found {
    loads: Vec<f64>,
    places: Vec<[f64; 2]>,
    /// `[v, P]`.
    curve: Vec<[f64; 2]>,
    n_increments: usize,
}

/// The way of a frame of this thickness, to its first limit load alone or through both.
fn follow(
    thick: f64,
    n_sections: u32,
    is_short: bool,
) -> Result<Found, Box<dyn Error + Send + Sync>> {
    let law = Corotated::plane_strain(12.0 * 1440.0 / thick.powi(3), 0.0);
    let description = FiniteStrainDescription::new(frame(thick, n_sections)?, law, 1.0);
    let rest = description.rest_positions.clone();
    let model = FiniteStrainModel::assemble(description)?;
    let at = |x: f64, y: f64| {
        let near = |p: &[f64]| (p[0] - x).hypot(p[1] - y) < 1e-9;
        rest.chunks_exact(2)
            .position(near)
            .ok_or("the frame has a node there")
    };
    let (foot, end, loaded) = (at(0.0, 0.0)?, at(120.0, 120.0)?, at(24.0, 120.0)?);
    let mut is_held = vec![false; rest.len()];
    for node in [foot, end] {
        is_held[2 * node] = true;
        is_held[2 * node + 1] = true;
    }
    let mut load = vec![0.0; rest.len()];
    load[2 * loaded + 1] = -1.0;
    let settings = PathSettings {
        longest: 0.25,
        ..PathSettings::default()
    };
    let mut path = PathStepper::new(model, PathCase::dead(load, is_held, &rest), &rest, settings)?;
    let place = |x: &[f64]| [120.0 - x[2 * loaded + 1], x[2 * loaded] - 24.0];
    let mut found = Found {
        loads: Vec::new(),
        places: Vec::new(),
        curve: vec![[0.0, 0.0]],
        n_increments: 0,
    };
    for v in [10.0, 20.0, 30.0, 40.0] {
        let end = PathEnd::Place {
            dof: 2 * loaded + 1,
            place: 120.0 - v,
        };
        found.loads.push(path.follow(end)?.factor);
        found.curve.push([v, path.point().factor]);
    }
    let is_through = |path: &PathStepper| match is_short {
        true => !path.limit_points().is_empty(),
        false => path.limit_points().len() > 1 && path.point().factor > 2.0,
    };
    while !is_through(&path) && path.report().n_increments < 500 {
        let point = path.advance()?;
        found.curve.push([place(path.positions())[0], point.factor]);
    }
    for limit in path.limit_points() {
        found.loads.push(limit.factor);
        found.places.push(place(&limit.positions));
    }
    found.n_increments = path.report().n_increments;
    Ok(found)
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let is_short = matches!(sheet.size, Size::Steps(_));
    let n_sections = if is_short { 20 } else { sheet.choose(120, 60) };
    let thick = follow(1.6, n_sections, is_short)?;
    let thin = follow(0.8, n_sections, is_short)?;
    for (k, (name, exact)) in EXACT.into_iter().enumerate() {
        let (Some(thick), Some(thin)) = (thick.loads.get(k), thin.loads.get(k)) else {
            break;
        };
        for (load, of) in [(thick, "L/75"), (thin, "L/150")] {
            sheet.tell(format!("{name}, T6, t = {of} (N)"), exact, *load);
        }
        let limit = 2.0 * thin - thick;
        let bar = if k == LIMIT {
            sheet.choose(5e-4, 2e-3)
        } else {
            sheet.choose(2e-3, 3e-3)
        };
        sheet.relative(format!("{name}, T6, t -> 0 (N)"), exact, limit, bar);
    }
    let names = ["first limit load", "second limit load"];
    for (k, (name, exact)) in names.into_iter().zip(PLACES).enumerate() {
        let (Some(thick), Some(thin)) = (thick.places.get(k), thin.places.get(k)) else {
            break;
        };
        for (axis, letter) in ["v", "u"].into_iter().enumerate() {
            let limit = 2.0 * thin[axis] - thick[axis];
            let name = format!("{letter} at the {name}, T6, t -> 0");
            sheet.relative(name, exact[axis], limit, 2e-3);
        }
    }
    sheet.note(format!(
        "{} increments through both limit loads",
        thin.n_increments
    ));
    let marks = [10.0, 20.0, 30.0, 40.0, PLACES[0][0], PLACES[1][0]].into_iter();
    let marks = marks.zip(EXACT).map(|(v, (_, load))| [v, load]);
    sheet.figure(
        Figure::new(
            "b44-lee",
            "Lee's frame",
            ["way of the load down (m)", "load (N)"],
        )
        .dots("rods", marks.collect())
        .line("T6, t = L/150", thin.curve),
    );
    Ok(())
}
