//! A thick tube that flows from within, to its limit pressure.
//!
//! Source: Prager and Hodge, Theory of Perfectly Plastic Solids (1951); Hill, The Mathematical Theory of Plasticity (1950), §V.2.
//!
//! ```text
//!      .---.
//!     / .-. \        radii a = 1 and b = 2 m, von Mises, plane strain, E/Y = 1e4, no hardening;
//!    ( ( p ) )       the inner circle is widened, by a hundred times what first yields
//!     \ '-' /
//!      '---'
//! ```
//!
//! Exact: `p = 2/√3 Y ln(b/a)` of the radii as they are then.
//!
//! Excellent: 1 %.

use super::Outcome;
use super::sheet::{Sheet, Size};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::J2Plasticity;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{LargeSettings, LoadCase, LoadStepper};
use std::f64::consts::TAU;

const YIELD: f64 = 20.0;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let meshes = [
        (CellKind::Tri6, "T6, 32 x 4", [32, 4]),
        (CellKind::Quad4, "Q4, 64 x 12", [64, 12]),
        (CellKind::Tri3, "T3, 64 x 12", [64, 12]),
    ];
    let n = if matches!(sheet.size, Size::Steps(_)) {
        1
    } else {
        3
    };
    for (kind, name, divisions) in meshes.into_iter().take(n) {
        let mesh = generate::annulus_divided(1.0, 2.0, divisions, kind)?;
        let law = J2Plasticity::plane_strain(1e4 * YIELD, 0.3, YIELD);
        let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1.0))?;
        let rest = model.rest_positions().to_vec();
        let radius = |x: &[f64]| x[0].hypot(x[1]);
        let is_inner = |x: &[f64]| radius(x) < 1.0 + 1e-9;
        let is_held: Vec<bool> = (rest.chunks_exact(2))
            .flat_map(|x| [is_inner(x); 2])
            .collect();
        let settings = LargeSettings::conserving().with_tolerance(1e-8);
        let mut stepper = LoadStepper::new(model, settings)?;
        let mut positions = rest.clone();
        let none = vec![0.0; rest.len()];
        let mut scale = 1.0;
        for widening in [1e-4, 2e-4, 4e-4, 8e-4, 1.6e-3] {
            scale = 1.0 + widening;
            let places: Vec<f64> = rest.iter().map(|x| scale * x).collect();
            let case = LoadCase {
                from: &none,
                to: &none,
                is_held: &is_held,
                places: &places,
                n_increments: 2,
            };
            stepper.solve(case, &mut positions)?;
        }
        let reactions = stepper.reaction().chunks_exact(2).zip(rest.chunks_exact(2));
        let radial = reactions.map(|(f, x)| (f[0] * x[0] + f[1] * x[1]) / radius(x));
        let pressure = radial.sum::<f64>() / (TAU * scale);
        let outer = positions.chunks_exact(2).map(radius).fold(0.0, f64::max);
        let limit = 2.0 / 3f64.sqrt() * YIELD * (outer / scale).ln();
        sheet.relative(
            format!("limit pressure, {name} (Pa)"),
            limit,
            pressure,
            1e-2,
        );
    }
    Ok(())
}
