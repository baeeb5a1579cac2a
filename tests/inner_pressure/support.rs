//! Rings that several tests use.

use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, InnerPressure};
use foil2d::fe::material::hyperelastic::{NeoHookean, StableNeoHookean};
use foil2d::fe::mesh::CellKind;
use foil2d::fe::mesh::generate::annulus_divided;

pub const KINDS: [CellKind; 3] = [CellKind::Tri3, CellKind::Tri6, CellKind::Quad4];

/// An annulus of density 1000 kg/m³, .7 m thick out of the plane, Young's modulus 1e6 Pa.
pub fn ring(
    [inner, outer]: [f64; 2],
    divisions: [usize; 2],
    kind: CellKind,
    poisson: f64,
    pressure: InnerPressure,
) -> FiniteStrainModel {
    let mesh = annulus_divided(inner, outer, divisions, kind).expect("an annulus");
    let mut description =
        FiniteStrainDescription::new(mesh, NeoHookean::plane_strain(1e6, poisson), 1000.0);
    description.thickness = 0.7;
    description.pressures = vec![pressure];
    FiniteStrainModel::assemble(description).expect("the ring is a good body")
}

/// A thin ring of rubber of which energy is left for any deformation.
pub fn soft_ring(kind: CellKind, pressure: InnerPressure) -> FiniteStrainModel {
    let divisions = if kind == CellKind::Tri6 {
        [16, 1]
    } else {
        [32, 1]
    };
    let mesh = annulus_divided(0.3, 0.33, divisions, kind).expect("an annulus");
    let law = StableNeoHookean::plane_strain(1e6, 0.4);
    let mut description = FiniteStrainDescription::new(mesh, law, 1000.0);
    description.pressures = vec![pressure];
    FiniteStrainModel::assemble(description).expect("the ring is a good body")
}

/// Rest positions stretched, sheared and waved, about a centre.
pub fn deformed(model: &FiniteStrainModel, [xx, xy, yx, yy]: [f64; 4], wave: f64) -> Vec<f64> {
    let place = |pair: &[f64]| {
        let [x, y] = [pair[0], pair[1]];
        [
            2.0 + xx * x + xy * y + wave * (9.0 * x - 3.0 * y).sin(),
            -1.0 + yx * x + yy * y + wave * (4.0 * x + 8.0 * y).cos(),
        ]
    };
    let rest = model.rest_positions().chunks_exact(2);
    rest.flat_map(place).collect()
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}
