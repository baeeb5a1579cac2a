//! B40, the elastica: a clamped rod under a dead load `P = α EI/L²` across its end.
//!
//! ```text
//!  |==========  P        w, u: how far the end goes down and back; theta: how far it turns
//!  |          \ v        exact: elliptic integrals
//! ```
//!
//! Excellent: half a per mille with fifty T6 along the rod.

use super::Outcome;
use super::rods::{BENDING, MESHES, Strip, meshes, put};
use super::sheet::Sheet;
use foil2d::large::{PathCase, PathEnd};

const EXACT: [(f64, [f64; 3]); 6] = [
    (0.5, [0.162143576, 0.015918962, 0.244533647]),
    (1.0, [0.301720774, 0.056433236, 0.461351950]),
    (2.0, [0.493457480, 0.160641721, 0.781749832]),
    (5.0, [0.713791524, 0.387628361, 1.215368118]),
    (10.0, [0.810609025, 0.554995598, 1.430285539]),
    (20.0, [0.868695898, 0.683885568, 1.532934956]),
];

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (mesh, (kind, _, divisions)) in MESHES.into_iter().take(meshes(sheet)).enumerate() {
        let strip = Strip::new(kind, divisions, |_| 0.0)?;
        let load = strip.load([0.0, -BENDING]);
        let mut path = strip.path(PathCase::dead(load, strip.clamped(), &strip.rest))?;
        for (alpha, exact) in EXACT {
            path.follow(PathEnd::Factor(alpha))?;
            let [x, y, angle] = strip.tip(path.positions());
            let found = [-y, 1.0 - x, -angle];
            if mesh > 0 {
                put(
                    sheet,
                    mesh,
                    &format!("w/L at PL²/EI = {alpha} (-)"),
                    exact[0],
                    found[0],
                );
                continue;
            }
            for (k, name) in ["w/L", "u/L", "angle"].into_iter().enumerate() {
                let name = format!("{name} at PL²/EI = {alpha} (-)");
                put(sheet, mesh, &name, exact[k], found[k]);
            }
        }
    }
    Ok(())
}
