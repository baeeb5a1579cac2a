//! The part of a law that resists a change of volume alone, `U(J)`: what cells may take from a smoothed `J` instead of that of a point.

use super::quotient::{rise_of_slope_of_ln, slope_of_ln};
use crate::math::ln_1p;

/// An energy `U(J)` per undeformed volume (J/m³), zero and free of stress at rest. Volumes are told by `e = J - 1`, which keeps the digits of small
/// strains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Volumetric {
    /// `κ/2 ln² J`, for `J > 0` only.
    Logarithmic {
        /// `κ` (Pa).
        modulus: f64,
    },
    /// `κ/2 (J - 1)²`.
    Quadratic {
        /// `κ` (Pa).
        modulus: f64,
    },
}

impl Volumetric {
    /// The logarithmic one, if its modulus (Pa) is positive: a law that resists a change of volume less than its shear modulus makes it do has
    /// nothing to be smoothed.
    pub fn logarithmic(modulus: f64) -> Option<Self> {
        (modulus > 0.0).then_some(Self::Logarithmic { modulus })
    }

    /// The quadratic one, likewise.
    pub fn quadratic(modulus: f64) -> Option<Self> {
        (modulus > 0.0).then_some(Self::Quadratic { modulus })
    }

    /// Whether there is an energy at `e = J - 1` (-).
    pub fn admits(self, e: f64) -> bool {
        match self {
            Self::Logarithmic { .. } => e > -1.0,
            Self::Quadratic { .. } => e.is_finite(),
        }
    }

    /// `U` (J/m³) at `e = J - 1` (-).
    pub fn energy(self, e: f64) -> f64 {
        match self {
            Self::Logarithmic { modulus } => 0.5 * modulus * ln_1p(e) * ln_1p(e),
            Self::Quadratic { modulus } => 0.5 * modulus * e * e,
        }
    }

    /// `[U', U'']` (Pa) at `e = J - 1` (-).
    pub fn slopes(self, e: f64) -> [f64; 2] {
        match self {
            Self::Logarithmic { modulus } => {
                let (j, log) = (1.0 + e, ln_1p(e));
                [modulus * log / j, modulus * (1.0 - log) / (j * j)]
            }
            Self::Quadratic { modulus } => [modulus * e, modulus],
        }
    }

    /// `[ΔU/ΔJ, ∂(ΔU/ΔJ)/∂J']` (Pa) from `e` to `e'` (-), without cancellation; `[U', U''/2]` where both are one.
    pub fn conserving(self, from: f64, to: f64) -> [f64; 2] {
        match self {
            // ΔU = κ/2 (ln J + ln J') Δ ln J.
            Self::Logarithmic { modulus } => {
                let (a, b) = (1.0 + from, 1.0 + to);
                let sum = 0.5 * modulus * (ln_1p(from) + ln_1p(to));
                let slope = slope_of_ln(a, b);
                let rise = rise_of_slope_of_ln(a, b) * sum + 0.5 * slope * modulus / b;
                [slope * sum, rise]
            }
            Self::Quadratic { modulus } => [0.5 * modulus * (from + to), 0.5 * modulus],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Volumetric; 2] = [
        Volumetric::Logarithmic { modulus: 3e6 },
        Volumetric::Quadratic { modulus: 3e6 },
    ];

    /// Against the energy by the standard library's logarithm, and derivatives by central differences over 1e-5: truncation of some 1e-9.
    #[test]
    fn slopes_are_those_of_the_energy() {
        for part in BOTH {
            for e in [-0.9, -0.3, 0.0, 1e-3, 0.5, 4.0f64] {
                let exact = match part {
                    Volumetric::Logarithmic { modulus } => 0.5 * modulus * (1.0 + e).ln().powi(2),
                    Volumetric::Quadratic { modulus } => 0.5 * modulus * e * e,
                };
                assert!((part.energy(e) - exact).abs() <= 1e-12 * exact);
                let h = 1e-5 * (1.0 + e);
                let [slope, rise] = part.slopes(e);
                let found = (part.energy(e + h) - part.energy(e - h)) / (2.0 * h);
                assert!((found - slope).abs() < 1e-7 * 3e6 / (1.0 + e), "{e}");
                let found = (part.slopes(e + h)[0] - part.slopes(e - h)[0]) / (2.0 * h);
                assert!((found / rise - 1.0).abs() < 1e-7, "{e}: {found} {rise}");
            }
        }
        let [log, square] = BOTH.map(|part| part.admits(-1.5));
        assert!(!log && square);
    }

    /// The quotient times the change of volume is the change of energy, to rounding of the larger energy; its slope by differences.
    #[test]
    fn quotients_do_the_work_of_the_energy() {
        for part in BOTH {
            for (from, to) in [(0.0, 0.3), (-0.5, 2.0), (0.1, 0.1 + 1e-9), (0.2, 0.2)] {
                let [quotient, rise] = part.conserving(from, to);
                let change = part.energy(to) - part.energy(from);
                let size = part.energy(to) + part.energy(from);
                assert!((quotient * (to - from) - change).abs() <= 1e-14 * size);
                let h = 1e-5;
                let at = |to: f64| part.conserving(from, to)[0];
                let found = (at(to + h) - at(to - h)) / (2.0 * h);
                assert!((found / rise - 1.0).abs() < 1e-7, "{from} {to}");
                if from == to {
                    let [slope, second] = part.slopes(to);
                    assert!((quotient / slope - 1.0).abs() < 1e-14);
                    assert!((2.0 * rise / second - 1.0).abs() < 1e-12);
                }
            }
        }
    }
}
