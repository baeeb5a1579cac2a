//! B45, homogeneous large strain: a neo-Hookean block in plane strain between rollers, its sides free.
//!
//! ```text
//!   o|--------|o->
//!   o|        |o        W = μ/2 (I1 - 3) - μ ln J + λ/2 ln² J, E = 1, ν = .3: P/E at the stretch λ1
//!   o|--------|o->
//! ```
//!
//! Excellent: eight digits with every element, as all of them hold homogeneous strain exactly.

use super::Outcome;
use super::sheet::Sheet;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::NeoHookean;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{LargeSettings, LoadCase, LoadStepper};
use std::error::Error;

/// Stretch along x, nominal stress over E, and where it is given the stretch along y.
const EXACT: [(f64, f64, Option<f64>); 4] = [
    (0.5, -1.084407463, Some(1.288304972)),
    (0.7, -0.4584239232, None),
    (1.3, 0.2672962551, None),
    (2.0, 0.6745973555, None),
];

/// The nominal stress (Pa) of a unit block of this stretch along x, and its stretch along y.
fn pull(kind: CellKind, stretch: f64) -> Result<[f64; 2], Box<dyn Error + Send + Sync>> {
    let mesh = generate::rectangle([1.0, 1.0], [3, 3], kind)?;
    let law = NeoHookean::plane_strain(1.0, 0.3);
    let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1.0))?;
    let mut positions = model.rest_positions().to_vec();
    let nodes = || positions.chunks_exact(2);
    let is_held = nodes().flat_map(|p| [p[0] == 0.0 || p[0] == 1.0, p[1] == 0.0]);
    let is_held: Vec<bool> = is_held.collect();
    let places = nodes().flat_map(|p| [stretch * p[0], p[1]]);
    let places: Vec<f64> = places.collect();
    let right = nodes().enumerate().filter(|(_, p)| p[0] == 1.0);
    let right: Vec<usize> = right.map(|(node, _)| node).collect();
    let upper = nodes()
        .position(|p| p[1] == 1.0)
        .ok_or("a block has a top")?;
    let zeros = vec![0.0; positions.len()];
    let settings = LargeSettings::conserving().with_tolerance(1e-11);
    let mut solver = LoadStepper::new(model, settings)?;
    let case = LoadCase {
        from: &zeros,
        to: &zeros,
        is_held: &is_held,
        places: &places,
        n_increments: 4,
    };
    solver.solve(case, &mut positions)?;
    let force = right.iter().map(|node| solver.reaction()[2 * node]).sum();
    Ok([force, positions[2 * upper + 1]])
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    for (kind, name) in [
        (CellKind::Tri3, "T3"),
        (CellKind::Tri6, "T6"),
        (CellKind::Quad4, "Q4"),
    ] {
        for (stretch, stress, side) in EXACT {
            let found = pull(kind, stretch)?;
            let quantity = format!("P/E at a stretch of {stretch}, {name} (-)");
            sheet.relative(quantity, stress, found[0], 1e-8);
            if let Some(side) = side {
                let quantity = format!("stretch across at {stretch}, {name} (-)");
                sheet.relative(quantity, side, found[1], 1e-8);
            }
        }
    }
    Ok(())
}
