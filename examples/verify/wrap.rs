//! A strip that is bent over a rigid cylinder by loads on its ends.
//!
//! ```text
//!            ___-----___
//!        _.-'   .-'-.   '-._        half of it, symmetric about the top
//!       ↓ P    (  R  )    P ↓
//!               '---'
//! ```
//!
//! Exact, for a rod that does not stretch: it touches at the top until `M = EI/R` there, and lies on an arc `Rφ` afterwards. There its moment is constant, so it has no shear force, and the
//! tension `P sin φ` presses with `P sin φ/R`; at the end of the arc a force `P cos φ` takes the shear force. From there on it is an elastica: with the slope `θ` below the horizontal and `k = P/EI`,
//!
//! ```text
//! θ'² = 1/R² - 2 k (sin θ - sin φ),    θ' = 0 at the end:    sin θe = sin φ + 1/(2 k R²)
//! L - R φ = ∫ dθ/θ'
//! ```
//!
//! For `φ` and `θe` given these are `k` and `L`; the load of a rod of length 1 on an arc that is bent to `θe` follows by bisection. The middle line of the strip is bent to `R + h/2`.
//!
//! Excellent: 0.5 %.

use super::Outcome;
use super::sheet::{Sheet, Size};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{ContactCase, ContactStepper, LargeSettings, LoadCase, Obstacle};

const HEIGHT: f64 = 0.01;
const RADIUS: f64 = 0.5;

/// What a load does to a rod.
#[derive(Clone, Copy)]
struct Rod {
    /// `P L²/EI`.
    load: f64,
    /// The angle of the arc (rad).
    arc: f64,
    /// How far the end is below the top of the middle line (m).
    drop: f64,
}

/// The rod of length 1 over an arc of this radius that touches along an angle.
fn rod(radius: f64, arc: f64) -> Rod {
    // The free length and its drop for the slope of the end, by the substitution θ = θe - u²: the root of the end is taken out of it.
    let free = |end: f64| {
        let k = 0.5 / (radius * radius * (end.sin() - arc.sin()));
        let n = 2000;
        let most = (end - arc).sqrt();
        let (mut length, mut drop) = (0.0, 0.0);
        for step in 0..n {
            let u = most * (f64::from(step) + 0.5) / f64::from(n);
            let theta = end - u * u;
            let rate = (2.0 * k * (end.sin() - theta.sin())).sqrt();
            let part = 2.0 * u / rate * most / f64::from(n);
            length += part;
            drop += part * theta.sin();
        }
        (k, length, drop)
    };
    let (mut low, mut high) = (arc + 1e-9, std::f64::consts::FRAC_PI_2);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let (_, length, _) = free(middle);
        // A longer free part turns farther.
        if radius * arc + length < 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (k, _, drop) = free(low);
    Rod {
        load: k,
        arc,
        drop: radius * (1.0 - arc.cos()) + drop,
    }
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n = sheet.choose(100, 50);
    let mesh = generate::rectangle([1.0, HEIGHT], [n, 1], CellKind::Tri6)?;
    let law = Corotated::plane_strain(12.0 / HEIGHT.powi(3), 0.0);
    let mut description = FiniteStrainDescription::new(mesh, law, 1.0);
    for p in description.rest_positions.chunks_exact_mut(2) {
        p[1] -= 0.5 * HEIGHT;
    }
    let rest = description.rest_positions.clone();
    let model = FiniteStrainModel::assemble(description)?;
    // A plane of symmetry: what holds it up is the cylinder alone, which it touches from the first.
    let is_held: Vec<bool> = rest
        .chunks_exact(2)
        .flat_map(|p| [p[0] == 0.0, false])
        .collect();
    let end = |p: &[f64]| (p[0] - 1.0).hypot(p[1]) < 1e-9;
    let end = rest
        .chunks_exact(2)
        .position(end)
        .ok_or("the end has a middle")?;
    let disc = [Obstacle::disc(
        [0.0, -(0.5 - 1e-7) * HEIGHT - RADIUS],
        RADIUS,
    )];
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut stepper = ContactStepper::new(model, settings)?;
    let mut positions = rest.clone();
    let mut from = vec![0.0; rest.len()];
    let arcs = [0.2, 0.4, 0.6];
    let short = matches!(sheet.size, Size::Steps(_));
    for arc in arcs.into_iter().take(if short { 1 } else { 3 }) {
        let exact = rod(RADIUS + 0.5 * HEIGHT, arc);
        let mut to = from.clone();
        // Simpson's shares of the end.
        for (node, p) in rest
            .chunks_exact(2)
            .enumerate()
            .filter(|(_, p)| p[0] == 1.0)
        {
            let share = if p[1].abs() < 1e-9 { 4.0 } else { 1.0 };
            to[2 * node + 1] = -exact.load * share / 6.0;
        }
        let load = LoadCase {
            from: &from,
            to: &to,
            is_held: &is_held,
            places: &rest,
            n_increments: 10,
        };
        let obstacles = &disc;
        stepper.solve(ContactCase { load, obstacles }, &mut positions)?;
        from = to;
        let found = -positions[2 * end + 1];
        let name = format!("drop of the end at PL²/EI = {:.4} (m)", exact.load);
        sheet.relative(name, exact.drop, found, 5e-3);
        let contacts = stepper.contacts();
        let whole: f64 = contacts.iter().map(|c| c.normal_force).sum();
        let (sin, cos) = exact.arc.sin_cos();
        let name = format!("sum of the pressing forces over P on an arc of {arc} (-)");
        sheet.relative(name, cos + arc * sin, whole / exact.load, 5e-3);
        let turned = contacts
            .iter()
            .map(|c| c.normal_force * c.normal[0].atan2(c.normal[1]));
        let moment = turned.sum::<f64>() / exact.load;
        let name = format!("sum of forces times angles over P on an arc of {arc} (rad)");
        sheet.relative(name, arc * (cos + 0.5 * arc * sin), moment, 1e-2);
    }
    Ok(())
}
