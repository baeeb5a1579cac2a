//! Bodies and states that several tests use.

use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::{
    Corotated, Hyperelastic, NeoHookean, StVenantKirchhoff, StableNeoHookean,
};
use foil2d::fe::mesh::{CellKind, generate::rectangle};
use std::sync::Arc;

pub const KINDS: [CellKind; 4] = [
    CellKind::Tri3,
    CellKind::Tri6,
    CellKind::Quad4,
    CellKind::Quad8,
];

/// The four laws of one Young's modulus (Pa) and Poisson's ratio.
pub fn laws(young: f64, poisson: f64) -> [Arc<dyn Hyperelastic>; 4] {
    [
        Arc::new(Corotated::plane_strain(young, poisson)),
        Arc::new(StVenantKirchhoff::plane_strain(young, poisson)),
        Arc::new(NeoHookean::plane_strain(young, poisson)),
        Arc::new(StableNeoHookean::plane_strain(young, poisson)),
    ]
}

/// A rectangle `[0, w] x [0, h]` (m) of density 1000 kg/m³, 1 m thick.
pub fn plate(
    size: [f64; 2],
    divisions: [usize; 2],
    kind: CellKind,
    law: Arc<dyn Hyperelastic>,
) -> FiniteStrainModel {
    let description = describe(size, divisions, kind, law);
    FiniteStrainModel::assemble(description).expect("the plate is a good body")
}

/// The same, its undeformed shape bent so that no cell is regular and the sides of Tri6 are curved.
pub fn warped_plate(kind: CellKind, law: Arc<dyn Hyperelastic>) -> FiniteStrainModel {
    let mut description = describe([1.0, 0.5], [4, 3], kind, law);
    for pair in description.rest_positions.chunks_exact_mut(2) {
        let [x, y] = [pair[0], pair[1]];
        pair[0] += 0.03 * (7.0 * x + 5.0 * y).sin();
        pair[1] += 0.03 * (6.0 * x - 8.0 * y).cos();
    }
    FiniteStrainModel::assemble(description).expect("the warped plate is a good body")
}

pub fn describe(
    size: [f64; 2],
    divisions: [usize; 2],
    kind: CellKind,
    law: Arc<dyn Hyperelastic>,
) -> FiniteStrainDescription {
    let mesh = rectangle(size, divisions, kind).expect("the plate can be meshed");
    let placeholder = Corotated::plane_strain(1.0, 0.0);
    let mut description = FiniteStrainDescription::new(mesh, placeholder, 1000.0);
    description.law = law;
    description
}

/// Rest positions under an affine map and a smooth disturbance of this size.
pub fn deformed(model: &FiniteStrainModel, [xx, xy, yx, yy]: [f64; 4], wave: f64) -> Vec<f64> {
    let place = |pair: &[f64]| {
        let [x, y] = [pair[0], pair[1]];
        [
            xx * x + xy * y + wave * (5.0 * x - 3.0 * y).sin(),
            yx * x + yy * y + wave * (4.0 * x + 6.0 * y).cos(),
        ]
    };
    model
        .rest_positions()
        .chunks_exact(2)
        .flat_map(place)
        .collect()
}

/// Nodes whose undeformed position is chosen.
pub fn nodes_where(model: &FiniteStrainModel, is_chosen: impl Fn([f64; 2]) -> bool) -> Vec<usize> {
    let rest = model.rest_positions();
    (0..model.n_nodes())
        .filter(|node| is_chosen([rest[2 * node], rest[2 * node + 1]]))
        .collect()
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}
