//! Plates that flow, and the return mapping of principal logarithmic strains, written for itself.

use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::J2Plasticity;
use foil2d::fe::mesh::{CellKind, generate::rectangle};

pub const KINDS: [CellKind; 4] = [
    CellKind::Tri3,
    CellKind::Tri6,
    CellKind::Quad4,
    CellKind::Quad8,
];

/// A rectangle `[0, w] x [0, h]` (m) of density 1000 kg/m³, 1 m thick.
pub fn plate(
    size: [f64; 2],
    divisions: [usize; 2],
    kind: CellKind,
    law: J2Plasticity,
) -> FiniteStrainModel {
    let mesh = rectangle(size, divisions, kind).expect("the plate can be meshed");
    FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))
        .expect("the plate is a good body")
}

/// Yield stress `y + h α` (Pa), Young's modulus (Pa) and Poisson's ratio.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    pub young: f64,
    pub poisson: f64,
    pub y: f64,
    pub h: f64,
}

impl Metal {
    pub fn law(&self) -> J2Plasticity {
        J2Plasticity::plane_strain(self.young, self.poisson, self.y).with_hardening(self.h)
    }

    pub fn mu(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    pub fn bulk(&self) -> f64 {
        self.young / (3.0 - 6.0 * self.poisson)
    }
}

/// A point in principal axes that do not turn: plastic strains along them, and `α`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    pub plastic: [f64; 3],
    pub alpha: f64,
}

impl Point {
    /// Kirchhoff's stresses (Pa) at logarithmic strains, and the point afterwards: the flow is found by bisection of the yield condition.
    pub fn go(&self, metal: &Metal, strain: [f64; 3]) -> ([f64; 3], Self) {
        let elastic: [f64; 3] = std::array::from_fn(|k| strain[k] - self.plastic[k]);
        let volume: f64 = elastic.iter().sum();
        let trial = elastic.map(|e| 2.0 * metal.mu() * (e - volume / 3.0));
        let mises = (1.5 * trial.iter().map(|s| s * s).sum::<f64>()).sqrt();
        let beyond = |x: f64| mises - 3.0 * metal.mu() * x - metal.y - metal.h * (self.alpha + x);
        let (mut low, mut high) = (0.0, mises / (3.0 * metal.mu()));
        if beyond(0.0) > 0.0 {
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                match beyond(middle) > 0.0 {
                    true => low = middle,
                    false => high = middle,
                }
            }
        }
        let direction = trial.map(|s| 1.5 * s / mises.max(f64::MIN_POSITIVE));
        let stress = std::array::from_fn(|k| {
            metal.bulk() * volume + trial[k] - 2.0 * metal.mu() * low * direction[k]
        });
        let after = Self {
            plastic: std::array::from_fn(|k| self.plastic[k] + low * direction[k]),
            alpha: self.alpha + low,
        };
        (stress, after)
    }

    /// The same with the strain across the pull (y) such that nothing acts there, and none out of the plane: Kirchhoff's stress along x, the strain
    /// across, and the point.
    pub fn pull(&self, metal: &Metal, strain: f64) -> (f64, f64, Self) {
        let across = |e: f64| self.go(metal, [strain, e, 0.0]).0[1];
        let (mut low, mut high) = (-2.0, 2.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            match across(middle) > 0.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        let (stress, after) = self.go(metal, [strain, low, 0.0]);
        (stress[0], low, after)
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
