//! Pressure in the holes of a body: constant, or that of a gas that is shut in.
//!
//! Of a gas whose pressure is `p0` above that outside, `po`, while its hole has the area `A0` that it has at rest,
//!
//! ```text
//! P = (po + p0) (A0/A)^γ,    Φ = ∫ (P - po) dA  from A to where P = po,    Φ >= 0
//! ```
//!
//! per thickness: γ = 1 where heat has time to come and go (isothermal), 1.4 for air where it has not (adiabatic). `Φ` is the work that the
//! gas can do until it is at the pressure outside.

use crate::math::{exp, exp_m1, ln, ln_1p};
use thiserror::Error;

/// Pressure of the air at sea level (Pa).
pub const ATMOSPHERE: f64 = 101_325.0;

/// Relative change of area below which the slope of the mean pressure is taken from the middle (-): the error is about its square, and its
/// rounding `ε` over it.
const SMALL: f64 = 1e-5;

/// What is wrong with an inner pressure.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PressureError {
    /// A number is not finite.
    #[error("the inner pressure is {0} Pa: give a finite number")]
    Pressure(f64),
    /// Of a gas that is shut in nothing is left.
    #[error(
        "a gas at {pressure} Pa above {outside} Pa outside has no pressure: give one above {}, which is a vacuum", -outside
    )]
    Vacuum {
        /// Above the pressure outside (Pa).
        pressure: f64,
        /// Outside (Pa).
        outside: f64,
    },
    /// Nothing presses against a gas.
    #[error(
        "the pressure outside is {0} Pa: give a positive finite number, or a constant inner pressure"
    )]
    Outside(f64),
    /// A gas that grows warm when it expands, or is no number.
    #[error("the exponent of the gas is {0}: give one of 1 (isothermal) to 10, 1.4 for air")]
    Exponent(f64),
    /// The body has no such hole.
    #[error(
        "hole {hole} of a body with {n_holes} holes has no inner pressure: use an index below {n_holes}, and a mesh with a hole, such as an annulus"
    )]
    Hole {
        /// Which hole.
        hole: usize,
        /// How many there are.
        n_holes: usize,
    },
    /// There is not one pressure per hole.
    #[error("{found} inner pressures were given for {n_holes} holes: give one each, or none")]
    Length {
        /// Pressures given.
        found: usize,
        /// Holes of the mesh.
        n_holes: usize,
    },
}

/// Pressure in a hole of a body of large strain, above the pressure outside.
///
/// A constant one is that of a large reservoir: its work is done from outside, as that of a load. A gas that is shut in stores energy; how much of
/// it there is, is told by the pressure that it would have in the hole as it is at rest.
///
/// ```
/// use foil2d::fe::finite_strain::InnerPressure;
/// let tyre = InnerPressure::isothermal(2e5).outside(1e5);
/// // At rest, and squeezed to half of the area.
/// assert_eq!(tyre.at(1.0), 2e5);
/// assert_eq!(tyre.at(0.5), 5e5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct InnerPressure {
    /// Above the pressure outside, of a gas in the hole at rest (Pa).
    pressure: f64,
    /// Outside (Pa).
    outside: f64,
    /// γ (-); none for a constant pressure.
    exponent: Option<f64>,
}

impl InnerPressure {
    /// No pressure, which a hole has by default.
    pub const NONE: Self = Self::constant(0.0);

    /// The same pressure above that outside whatever the hole does (Pa); a negative one sucks.
    pub const fn constant(pressure: f64) -> Self {
        Self {
            pressure,
            outside: ATMOSPHERE,
            exponent: None,
        }
    }

    /// A gas that keeps its temperature, `P A` constant, which would be at this pressure above that outside with the hole at rest (Pa).
    pub const fn isothermal(pressure: f64) -> Self {
        Self::adiabatic(pressure, 1.0)
    }

    /// A gas that exchanges no heat, `P A^γ` constant, which would be at this pressure above that outside with the hole at rest (Pa).
    pub const fn adiabatic(pressure: f64, exponent: f64) -> Self {
        Self {
            pressure,
            outside: ATMOSPHERE,
            exponent: Some(exponent),
        }
    }

    /// Pressure outside (Pa), [`ATMOSPHERE`] by default: the less, the softer is a gas at the same pressure above it.
    pub const fn outside(self, outside: f64) -> Self {
        Self { outside, ..self }
    }

    /// Whether a gas is shut in.
    pub const fn is_gas(&self) -> bool {
        self.exponent.is_some()
    }

    /// Pressure above that outside (Pa) in a hole of the area `ratio` times that at rest (-); of a gas not a number where nothing is left of it.
    pub fn at(&self, ratio: f64) -> f64 {
        let Some(exponent) = self.exponent else {
            return self.pressure;
        };
        self.absolute(exponent, ratio) - self.outside
    }

    /// Pressure of a gas (Pa).
    fn absolute(&self, exponent: f64, ratio: f64) -> f64 {
        let full = self.outside + self.pressure;
        if ratio.is_nan() || ratio <= 0.0 {
            return f64::NAN;
        }
        match exponent {
            1.0 => full / ratio,
            _ => full * exp(-exponent * ln(ratio)),
        }
    }

    /// Energy of a gas per area at rest (J/m² and per thickness in m, that is Pa): the work it can do until it is at the pressure outside.
    /// Zero for a constant pressure.
    pub fn energy(&self, ratio: f64) -> f64 {
        let Some(exponent) = self.exponent else {
            return 0.0;
        };
        let absolute = self.absolute(exponent, ratio);
        let excess = (absolute - self.outside) / self.outside;
        // How far it expands, as a logarithm.
        let way = ln_1p(excess) / exponent;
        ratio * (absolute * expanded(exponent, way) - self.outside * exp_m1(way))
    }

    /// The mean pressure between two areas, `∫ p dA / ΔA` (Pa), and how it changes with the second one over that at rest (Pa).
    ///
    /// - `ratio`: the first area over that at rest (-).
    /// - `change`: the second less the first, over that at rest (-).
    pub(super) fn mean(&self, ratio: f64, change: f64) -> [f64; 2] {
        let Some(exponent) = self.exponent else {
            return [self.pressure, 0.0];
        };
        let start = self.absolute(exponent, ratio);
        let relative = change / ratio;
        let mean = match relative {
            0.0 => start,
            _ => start * expanded(exponent, ln_1p(relative)) / relative,
        };
        let slope = if relative.abs() < SMALL {
            let middle = ratio + 0.5 * change;
            -0.5 * exponent * self.absolute(exponent, middle) / middle
        } else {
            (self.absolute(exponent, ratio + change) - mean) / change
        };
        [mean - self.outside, slope]
    }

    /// The pressure (Pa) and how it changes with the area over that at rest (Pa).
    pub(super) fn slope(&self, ratio: f64) -> [f64; 2] {
        let Some(exponent) = self.exponent else {
            return [self.pressure, 0.0];
        };
        let absolute = self.absolute(exponent, ratio);
        [absolute - self.outside, -exponent * absolute / ratio]
    }

    /// Refuses what is no pressure.
    ///
    /// # Errors
    /// Which number is out of its range.
    pub fn validate(&self) -> Result<(), PressureError> {
        if !self.pressure.is_finite() {
            return Err(PressureError::Pressure(self.pressure));
        }
        let Some(exponent) = self.exponent else {
            return Ok(());
        };
        if !(self.outside > 0.0 && self.outside.is_finite()) {
            return Err(PressureError::Outside(self.outside));
        }
        if !(1.0..=10.0).contains(&exponent) {
            return Err(PressureError::Exponent(exponent));
        }
        if self.outside + self.pressure <= 0.0 {
            return Err(PressureError::Vacuum {
                pressure: self.pressure,
                outside: self.outside,
            });
        }
        Ok(())
    }
}

/// `∫ P dA / (P A)` over an expansion whose logarithm is `way`: `(1 - e^{-(γ - 1) way})/(γ - 1)`, `way` itself at γ = 1.
fn expanded(exponent: f64, way: f64) -> f64 {
    let excess = exponent - 1.0;
    if excess == 0.0 {
        way
    } else {
        -exp_m1(-excess * way) / excess
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gases() -> [InnerPressure; 4] {
        [
            InnerPressure::isothermal(2e5),
            InnerPressure::adiabatic(3e3, 1.4),
            InnerPressure::adiabatic(-4e4, 1.4).outside(5e4),
            InnerPressure::isothermal(10.0),
        ]
    }

    /// Simpson's rule on 2,000 intervals, whose error is the fourth power of their length.
    fn integral(gas: &InnerPressure, from: f64, to: f64) -> f64 {
        let n = 2000;
        let step = (to - from) / f64::from(n);
        let inner = (1..n).map(|k| {
            let weight = if k % 2 == 1 { 4.0 } else { 2.0 };
            weight * gas.at(from + step * f64::from(k))
        });
        step / 3.0 * (gas.at(from) + gas.at(to) + inner.sum::<f64>())
    }

    #[test]
    fn the_energy_is_the_work_until_the_pressure_is_that_outside() {
        for gas in gases() {
            let exponent = gas.exponent.unwrap_or(1.0);
            let free = ((gas.outside + gas.pressure) / gas.outside).powf(1.0 / exponent);
            assert!(gas.at(free).abs() < 1e-9 * gas.outside);
            for ratio in [0.4, 0.9, 1.0, 1.7, 4.0] {
                let expected = integral(&gas, ratio, free);
                let found = gas.energy(ratio);
                assert!(found >= 0.0);
                let error = (found - expected).abs();
                assert!(
                    error < 1e-9 * gas.outside.max(expected),
                    "{gas:?} {ratio}: {error:e}"
                );
            }
        }
    }

    #[test]
    fn the_mean_pressure_does_the_work_that_the_energy_falls_by() {
        for gas in gases() {
            for (from, to) in [(1.0, 1.5), (1.3, 0.6), (1.0, 1.0 + 3e-4), (0.8, 0.8 - 1e-9)] {
                let [mean, _] = gas.mean(from, to - from);
                let expected = integral(&gas, from, to) / (to - from);
                assert!((mean - expected).abs() < 1e-11 * gas.outside);
                let fall = gas.energy(from) - gas.energy(to);
                let error = (mean * (to - from) - fall).abs();
                assert!(error < 1e-14 * gas.outside, "{gas:?}: {error:e}");
            }
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        for gas in gases() {
            for (from, to) in [(1.0, 1.5), (1.3, 0.6), (1.0, 1.0 + 3e-6), (0.9, 0.9)] {
                let mean = |to: f64| gas.mean(from, to - from)[0];
                let h = 1e-4;
                let expected = (mean(to + h) - mean(to - h)) / (2.0 * h);
                let found = gas.mean(from, to - from)[1];
                assert!(found < 0.0);
                assert!(
                    (found / expected - 1.0).abs() < 2e-5,
                    "{gas:?}: {found} {expected}"
                );
                let [at, slope] = gas.slope(to);
                assert_eq!(at, gas.at(to));
                let expected = (gas.at(to + h) - gas.at(to - h)) / (2.0 * h);
                assert!((slope / expected - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn what_is_no_pressure_is_refused() {
        let refused = [
            InnerPressure::constant(f64::NAN),
            InnerPressure::isothermal(f64::INFINITY),
            InnerPressure::isothermal(-2e5),
            InnerPressure::isothermal(1.0).outside(0.0),
            InnerPressure::adiabatic(1.0, 0.9),
            InnerPressure::adiabatic(1.0, f64::NAN),
        ];
        for pressure in refused {
            assert!(pressure.validate().is_err(), "{pressure:?}");
        }
        assert!(InnerPressure::constant(-1e9).validate().is_ok());
        assert!(InnerPressure::isothermal(1.0).at(0.0).is_nan());
    }
}
