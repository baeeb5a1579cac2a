//! B42, a force that stays normal to the end of a clamped rod: it coils up.
//!
//! ```text
//!             ^ P         P L²/EI = 1, 2, 4, 8; the force turns with the end
//!  |==========
//! ```
//!
//! Such a force has no potential, and its tangent is not symmetric; the path takes all of it.
//!
//! Exact: by integrals of the rod's equation, which has the moment `EI θ'` as a function of the angle to the end.
//!
//! Excellent: places to half a per mille of the length, angles to as much of themselves.

use super::Outcome;
use super::figure::Figure;
use super::rods::{BAR, BENDING, MESHES, Strip, meshes};
use super::sheet::Sheet;
use foil2d::large::{FollowerForce, PathCase, PathEnd};

const EXACT: [(f64, [f64; 3]); 4] = [
    (1.0, [0.935645669, 0.320641995, 0.495884642]),
    (2.0, [0.767362192, 0.573839063, 0.968238803]),
    (4.0, [0.342745786, 0.786168426, 1.776435814]),
    (8.0, [-0.073862981, 0.633592114, 2.756554078]),
];

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut figure = Figure::new(
        "b42-follower",
        "a force normal to the end",
        ["x (m)", "y (m)"],
    );
    for (mesh, (kind, name, divisions)) in MESHES.into_iter().take(meshes(sheet)).enumerate() {
        let strip = Strip::new(kind, divisions, |_| 0.0)?;
        let line = strip.end();
        let followers = line.map(|node| FollowerForce {
            node,
            line,
            force: [0.5 * BENDING, 0.0],
        });
        let dead = PathCase::dead(vec![0.0; strip.rest.len()], strip.clamped(), &strip.rest);
        let mut path = strip.path(PathCase {
            followers: followers.to_vec(),
            ..dead
        })?;
        for (load, exact) in EXACT {
            path.follow(PathEnd::Factor(load))?;
            let [x, y, angle] = strip.tip(path.positions());
            if mesh > 0 {
                let quantity = format!("angle at PL²/EI = {load}, {name} (rad)");
                sheet.tell(quantity, exact[2], angle);
                continue;
            }
            let at = |what: &str| format!("{what} at PL²/EI = {load}, {name}");
            sheet.absolute(at("x/L of the end (-)"), exact[0], x, BAR);
            sheet.absolute(at("y/L of the end (-)"), exact[1], y, BAR);
            sheet.relative(at("angle (rad)"), exact[2], angle, BAR);
            figure = figure.line(&format!("PL²/EI = {load}"), strip.line(path.positions()));
        }
    }
    sheet.figure(figure);
    Ok(())
}
