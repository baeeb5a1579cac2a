//! B46, a free plate 1 x .5 m that spins at 5 rad/s and is being stretched at .08 /s, 60 Hz, without decay.
//!
//! ```text
//!     .---------.        the trapezoidal rule in world coordinates explodes within 51 steps at E = 1e9;
//!    /  5 rad/s /        the energy-momentum form keeps energy and angular momentum for ever
//!   '---------'
//! ```
//!
//! At E = 1e11 the rounding of positions, 1e-16 of a metre, is 1e-5 N at every node, which no step can resolve; it turns nothing and does no work.
//!
//! Excellent: energy within 1e-9 of the first, angular momentum within 1e-11 over 6000 steps.

use super::Outcome;
use super::sheet::Sheet;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (kind, name, divisions) in [
        (CellKind::Tri6, "T6", [4, 2]),
        (CellKind::Tri3, "T3", [8, 4]),
        (CellKind::Quad4, "Q4", [8, 4]),
    ] {
        let n_steps = match kind {
            CellKind::Tri6 => sheet.n_steps(sheet.choose(6000, 600)),
            _ => sheet.n_steps(600),
        };
        for young in [1e6, 1e9, 1e11] {
            let mesh = generate::rectangle([1.0, 0.5], divisions, kind)?;
            let law = Corotated::plane_strain(young, 0.3);
            let description = FiniteStrainDescription::new(mesh, law, 1000.0);
            let model = FiniteStrainModel::assemble(description)?;
            let mut motion = WorldMotion::at_rest(&model);
            let places = motion.position.chunks_exact(2);
            for (p, v) in places.zip(motion.velocity.chunks_exact_mut(2)) {
                let (x, y) = (p[0] - 0.5, p[1] - 0.25);
                v[0] = -5.0 * y + 0.08 * x;
                v[1] = 5.0 * x - 0.04 * y;
            }
            let load = vec![0.0; model.n_dofs()];
            let settings = LargeSettings::conserving().with_tolerance(1e-11);
            let mut stepper = LargeStepper::new(model.clone(), settings)?;
            let (energy, angular) = (motion.energy(&model), motion.angular_momentum(&model));
            let (mut off, mut turned) = (0.0f64, 0.0f64);
            for _ in 0..n_steps {
                stepper.step(1.0 / 60.0, &load, &mut motion)?;
                off = off.max((motion.energy(&model) / energy - 1.0).abs());
                turned = turned.max((motion.angular_momentum(&model) / angular - 1.0).abs());
            }
            let of = format!("{name}, E = {young:.0e} Pa, {n_steps} steps (-)");
            let rows = [("energy", 1e-9, off), ("angular momentum", 1e-11, turned)];
            for (what, bar, found) in rows {
                let quantity = format!("change of {what}, {of}");
                sheet.at_most(quantity, bar, found);
            }
        }
    }
    Ok(())
}
