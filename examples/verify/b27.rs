//! B27, a rod bent to a full circle by the moment `2π EI/L` at its end.
//!
//! ```text
//!                 __
//!  |==========)  M     ->    |(  )     the end comes back to the clamp, turned by 2π
//!                             ‾‾
//! ```
//!
//! The moment is a couple of forces normal to the end, which turn with it.
//!
//! Excellent: the place to 5e-4 of the length, the angle to 5e-4 of itself.

use super::Outcome;
use super::figure::Figure;
use super::rods::{BAR, BENDING, HEIGHT, MESHES, Strip, meshes};
use super::sheet::Sheet;
use foil2d::large::{FollowerForce, PathCase, PathEnd};
use std::f64::consts::TAU;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut figure = Figure::new("b27-circle", "bent to a circle", ["x (m)", "y (m)"]);
    for (mesh, (kind, name, divisions)) in MESHES.into_iter().take(meshes(sheet)).enumerate() {
        let strip = Strip::new(kind, divisions, |_| 0.0)?;
        let [low, high] = strip.end();
        let force = TAU * BENDING / HEIGHT;
        let couple = [(low, 1.0), (high, -1.0)].map(|(node, sign)| FollowerForce {
            node,
            line: [low, high],
            // To the left of the line that goes up the end is against the axis of the rod.
            force: [0.0, -sign * force],
        });
        let dead = PathCase::dead(vec![0.0; strip.rest.len()], strip.clamped(), &strip.rest);
        let mut path = strip.path(PathCase {
            followers: couple.to_vec(),
            ..dead
        })?;
        let parts = if mesh == 0 { 4 } else { 1 };
        for part in 1..=parts {
            path.follow(PathEnd::Factor(f64::from(part) / f64::from(parts)))?;
            if mesh == 0 {
                let points = strip.line(path.positions());
                figure = figure.line(&format!("M = {part}/4 of 2π EI/L"), points);
            }
        }
        let [x, y, angle] = strip.tip(path.positions());
        // The angle of the end is known but for full turns, and is about one.
        let turned = TAU + (angle + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        if mesh == 0 {
            sheet.absolute(format!("x of the end over L, {name} (-)"), 0.0, x, BAR);
            sheet.absolute(format!("y of the end over L, {name} (-)"), 0.0, y, BAR);
            sheet.relative(format!("angle, {name} (rad)"), TAU, turned, BAR);
        } else {
            sheet.tell(
                format!("distance of the end over L plus one, {name} (-)"),
                1.0,
                1.0 + x.hypot(y),
            );
        }
    }
    sheet.figure(figure);
    Ok(())
}
