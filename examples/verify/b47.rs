//! B47, a ring pressed between two plates without friction, to where it lies flat on them.
//!
//! Source: derived for this book, as an elastica of quarter of the ring; Frisch-Fay, Flexible Bars (1962) has the first branch.
//!
//! ```text
//!      ==========  ↓        R = 1, h = R/50, EI = 1; F is the force of a plate
//!        .-'-.
//!       (     )             a quarter of it, symmetric about both axes
//!        '-.-'
//!      ==========  ↑
//! ```
//!
//! Exact: small loads close the gap by .148778 FR³/EI; FR²/EI = .5 to 2.5 → gap/R 1.921201 to 1.507832. From F = 2.786407859 on, gap/R = 1.435540022, a part of the ring is flat, and
//! F = 5.742160088 EI/gap²; all of it acts at the two ends of the flat part.
//!
//! The ring is a strip of Tri6, pressed against a rigid half-plane by [`ContactStepper`]; gaps are those of middle lines.
//!
//! Excellent: 0.5 %.

use super::Outcome;
use super::figure::Figure;
use super::sheet::{Sheet, Size};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{ContactCase, ContactStepper, LargeSettings, LoadCase, Obstacle};
use std::f64::consts::FRAC_PI_2;

const HEIGHT: f64 = 0.02;

/// FR²/EI and gap/R while the ring touches at a point.
const POINT: [[f64; 2]; 5] = [
    [0.5, 1.921201],
    [1.0, 1.833056],
    [1.5, 1.734923],
    [2.0, 1.626471],
    [2.5, 1.507832],
];
/// `F gap²/EI` where it is flat.
const FLAT: f64 = 5.742160088;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n = sheet.choose(120, 60);
    let mesh = generate::rectangle([FRAC_PI_2, HEIGHT], [n, 1], CellKind::Tri6)?;
    let law = Corotated::plane_strain(12.0 / HEIGHT.powi(3), 0.0);
    let mut description = FiniteStrainDescription::new(mesh, law, 1.0);
    for p in description.rest_positions.chunks_exact_mut(2) {
        let (sin, cos) = p[0].sin_cos();
        let radius = 1.0 - 0.5 * HEIGHT + p[1];
        (p[0], p[1]) = (radius * sin, radius * cos);
    }
    let rest = description.rest_positions.clone();
    let model = FiniteStrainModel::assemble(description)?;
    let is_held: Vec<bool> = rest.iter().map(|x| x.abs() < 1e-12).collect();
    // Where both axes cut the ring it stays on them, to the last bit.
    let rest: Vec<f64> = (rest.iter().zip(&is_held))
        .map(|(x, held)| if *held { 0.0 } else { *x })
        .collect();
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut stepper = ContactStepper::new(model, settings)?;
    let mut ring = Ring {
        positions: rest.clone(),
        rest,
        is_held,
        gap: 2.0,
    };
    let mut points = vec![[2.0, 0.0]];
    let is_short = matches!(sheet.size, Size::Steps(_));
    let small = 1e-3;
    let force = ring.press(&mut stepper, 2.0 - 0.148778 * small)?.force;
    sheet.relative("force at a gap 1.5e-4 R less (EI/R²)", small, force, 5e-3);
    if is_short {
        return Ok(());
    }
    for [exact, gap] in POINT {
        let found = ring.press(&mut stepper, gap)?;
        points.push([gap, found.force]);
        let name = format!("force at a gap of {gap} R (EI/R²)");
        sheet.relative(name, exact, found.force, 5e-3);
    }
    for gap in [1.3, 1.1, 0.9] {
        let found = ring.press(&mut stepper, gap)?;
        points.push([gap, found.force]);
        let exact = FLAT / (gap * gap);
        let name = format!("force at a gap of {gap} R, flat (EI/R²)");
        sheet.relative(name, exact, found.force, 5e-3);
        let name = format!(
            "share of it within 2 h of the end of {:.3} R at {gap} R (-)",
            found.flat
        );
        sheet.at_least(name, 0.99, found.at_end);
    }
    let exact = (0..=60)
        .map(|k| 0.85 + 0.01 * f64::from(k))
        .filter(|gap| *gap < 1.4355);
    let mut exact: Vec<[f64; 2]> = exact.map(|gap| [gap, FLAT / (gap * gap)]).collect();
    exact.extend(POINT.iter().rev().map(|[force, gap]| [*gap, *force]));
    exact.push([2.0, 0.0]);
    sheet.figure(
        Figure::new(
            "b47-ring",
            "ring between plates",
            ["gap/R (-)", "FR²/EI (-)"],
        )
        .exact("elastica", exact)
        .dots("strip, h = R/50", points),
    );
    Ok(())
}

/// A quarter of the ring as it is.
struct Ring {
    rest: Vec<f64>,
    positions: Vec<f64>,
    is_held: Vec<bool>,
    gap: f64,
}

/// The force of a plate, how long the part is that touches, and the share of the force near its end.
struct Pressed {
    force: f64,
    flat: f64,
    at_end: f64,
}

impl Ring {
    /// Brings the plates to a gap.
    fn press(
        &mut self,
        stepper: &mut ContactStepper,
        gap: f64,
    ) -> Result<Pressed, foil2d::large::LargeError> {
        let none = vec![0.0; self.rest.len()];
        let plate = Obstacle::half_plane([0.0, 0.5 * (self.gap + HEIGHT)], [0.0, -1.0])
            .moving_by([0.0, 0.5 * (gap - self.gap)]);
        let load = LoadCase {
            from: &none,
            to: &none,
            is_held: &self.is_held,
            places: &self.rest,
            n_increments: 1 + (20.0 * (self.gap - gap)) as usize,
        };
        let obstacles = &[plate];
        stepper.solve(ContactCase { load, obstacles }, &mut self.positions)?;
        self.gap = gap;
        let contacts = stepper.contacts();
        let flat = contacts.iter().map(|c| c.position[0]).fold(0.0, f64::max);
        let sum = |from: f64| -> f64 {
            let chosen = contacts.iter().filter(|c| c.position[0] >= from);
            chosen.map(|c| c.normal_force).sum()
        };
        Ok(Pressed {
            force: 2.0 * sum(0.0),
            flat,
            at_end: sum(flat - 2.0 * HEIGHT) / sum(0.0),
        })
    }
}
