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
//! Exact: rods by shooting. They do not stretch or shear; what stretching and shearing takes of the loads of legs of t = L/75 and L/150, some t², is that of
//! rods with their `EA` and `5/6 GA` (Reissner's), likewise by shooting. The corner of a frame of plane legs gives way less than that of rods, by about their
//! thickness: what both frames differ from rods of their own by is drawn on to none, linearly, and judged. The second limit load lies on the way on which
//! the frame snaps.
//!
//! Published digits of the loads at v = 10 to 40, .96355, 1.34579, 1.59530 and 1.78078, are those of rods that stretch as A = 6 and I = 2 do.
//!
//! Excellent: half a per mille, of the least load one.

use super::Outcome;
use super::figure::Figure;
use super::frame::frame;
use super::sheet::{Sheet, Size};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::large::{PathCase, PathEnd, PathSettings, PathStepper};
use std::error::Error;

/// Loads at v = 10, 20, 30, 40, the limit load, and the least one, of rods that neither stretch nor shear, and of rods as stiff as legs of both
/// thicknesses.
const EXACT: [(&str, f64, [f64; 2]); 6] = [
    ("load at v = 10", 0.9644022, [0.9634058, 0.9641531]),
    ("load at v = 20", 1.3462017, [1.3453909, 1.3459989]),
    ("load at v = 30", 1.5955290, [1.5947249, 1.5953279]),
    ("load at v = 40", 1.7809534, [1.7801432, 1.7807508]),
    ("limit load", 1.855875, [1.855144, 1.855692]),
    ("least load", -0.942129, [-0.940609, -0.941749]),
];
/// Which of them lies behind the snap: what the corner adds there is four times as large, and so are its parts of t².
const LEAST: usize = 5;
/// Where the loaded point is at both limit loads, `[v, u]`, of the same three.
const PLACES: [[[f64; 2]; 3]; 2] = [
    [
        [48.73946, 26.88685],
        [48.74610, 26.88173],
        [48.74112, 26.88557],
    ],
    [
        [58.20047, 90.21191],
        [58.21492, 90.19233],
        [58.20408, 90.20702],
    ],
];

/// What frames tend to that differ by so much from the rods of their own, thick ones first, and these from the exact ones.
fn drawn_on(exact: f64, rods: [f64; 2], found: [f64; 2]) -> f64 {
    exact + 2.0 * (found[1] - rods[1]) - (found[0] - rods[0])
}

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
    for (k, (name, exact, rods)) in EXACT.into_iter().enumerate() {
        let (Some(&thick), Some(&thin)) = (thick.loads.get(k), thin.loads.get(k)) else {
            break;
        };
        for (load, rod, of) in [(thick, rods[0], "L/75"), (thin, rods[1], "L/150")] {
            let name = format!("{name}, T6, t = {of} (N), against rods of its stiffness");
            sheet.tell(name, rod, load);
        }
        let limit = drawn_on(exact, rods, [thick, thin]);
        let bar = match k {
            LEAST => sheet.choose(1e-3, 2e-3),
            _ => sheet.choose(5e-4, 1e-3),
        };
        sheet.relative(format!("{name}, T6, t -> 0 (N)"), exact, limit, bar);
    }
    let names = ["first limit load", "second limit load"];
    for (k, (name, rods)) in names.into_iter().zip(PLACES).enumerate() {
        let (Some(thick), Some(thin)) = (thick.places.get(k), thin.places.get(k)) else {
            break;
        };
        for (axis, letter) in ["v", "u"].into_iter().enumerate() {
            let [exact, of_thick, of_thin] = rods.map(|place| place[axis]);
            let limit = drawn_on(exact, [of_thick, of_thin], [thick[axis], thin[axis]]);
            let name = format!("{letter} at the {name}, T6, t -> 0");
            sheet.relative(name, exact, limit, 2e-3);
        }
    }
    sheet.note(format!(
        "{} increments through both limit loads",
        thin.n_increments
    ));
    let marks = [10.0, 20.0, 30.0, 40.0, PLACES[0][0][0], PLACES[1][0][0]].into_iter();
    let marks = marks.zip(EXACT).map(|(v, (_, load, _))| [v, load]);
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
