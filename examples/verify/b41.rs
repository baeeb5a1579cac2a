//! B41, the elastica under its own weight: `q = κ EI/L³` along a clamped rod.
//!
//! ```text
//!  |==========
//!  | v v v v v q        exact: the boundary value problem of θ'' = κ (1 - s) cos θ, integrated to ten digits
//! ```
//!
//! Excellent: half a per mille with fifty T6 along the rod, whose masses sit at its nodes.

use super::Outcome;
use super::rods::{BENDING, MESHES, Strip, meshes, put};
use super::sheet::Sheet;
use foil2d::large::{PathCase, PathEnd};

const EXACT: [(f64, [f64; 3]); 5] = [
    (1.0, [0.123471402, 0.008753605, 0.165115561]),
    (2.0, [0.238506583, 0.033107053, 0.321593798]),
    (5.0, [0.495905045, 0.153342820, 0.697004778]),
    (10.0, [0.700199716, 0.343646239, 1.052643117]),
    (20.0, [0.829881443, 0.554767948, 1.339501542]),
];

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (mesh, (kind, _, divisions)) in MESHES.into_iter().take(meshes(sheet)).enumerate() {
        let strip = Strip::new(kind, divisions, |_| 0.0)?;
        let masses = strip.model.masses();
        let whole: f64 = masses.iter().sum();
        let weight = masses
            .iter()
            .flat_map(|mass| [0.0, -BENDING * mass / whole]);
        let case = PathCase::dead(weight.collect(), strip.clamped(), &strip.rest);
        let mut path = strip.path(case)?;
        for (kappa, exact) in EXACT {
            path.follow(PathEnd::Factor(kappa))?;
            let [x, y, angle] = strip.tip(path.positions());
            let found = [-y, 1.0 - x, -angle];
            if mesh > 0 {
                put(
                    sheet,
                    mesh,
                    &format!("w/L at qL³/EI = {kappa} (-)"),
                    exact[0],
                    found[0],
                );
                continue;
            }
            for (k, name) in ["w/L", "u/L", "angle"].into_iter().enumerate() {
                let name = format!("{name} at qL³/EI = {kappa} (-)");
                put(sheet, mesh, &name, exact[k], found[k]);
            }
        }
    }
    Ok(())
}
