//! A column between hinges that bends, stretches and shears: Reissner's rod, by shooting.
//!
//! ```text
//! EI (θ' - κ0) = -P w,    κ0 = -b π² sin πs
//! x' = (1 + ε) cos θ - γ sin θ,    w' = (1 + ε) sin θ + γ cos θ,    ε = -P cos θ/EA,    γ = P sin θ/GA
//! ```
//!
//! bowed by `b sin πs` at rest, from a hinge, where `w = 0`, to the middle, where `θ = 0`. Source: Reissner, J. Appl. Math. Phys. 23 (1972), 795–804.

use super::rods::{BENDING, HEIGHT, YOUNG};
use std::f64::consts::PI;

/// What a column of length 1 m is like.
#[derive(Clone, Copy, Default)]
pub struct Rod {
    /// `[1/EA, 1/GA]` (1/N).
    pub compliances: [f64; 2],
    /// `b` (m).
    pub bow: f64,
}

impl Rod {
    /// That of the strips, which are 1 m thick and have `ν = 0`, bowed so far (m); of a rectangle 5/6 shears.
    pub fn strip(bow: f64) -> Self {
        let section = YOUNG * HEIGHT;
        Self {
            compliances: [1.0 / section, 1.0 / (5.0 / 12.0 * section)],
            bow,
        }
    }
}

/// A column as its ends are at a distance.
pub struct Column {
    /// `P/Pcr` (-), of Euler's load of a rod that neither stretches nor shears.
    pub factor: f64,
    /// Deflection in the middle (m).
    pub deflection: f64,
}

/// Steps of Runge and Kutta's method to the middle: some 1e-12.
const STEPS: usize = 400;

impl Column {
    /// The column whose ends are `chord` (m) apart, sought from an end slope (°) and a `P/Pcr` near by.
    ///
    /// # Errors
    /// If Newton's method ends without one.
    pub fn between(chord: f64, slope: f64, factor: f64, rod: Rod) -> Result<Self, &'static str> {
        let mut at = [slope.to_radians(), factor];
        let miss = |at: [f64; 2]| {
            let [angle, place, _] = middle(at, rod);
            [angle, 2.0 * place - chord]
        };
        for _ in 0..20 {
            let now = miss(at);
            let size = now[0].abs().max(now[1].abs());
            if size < 1e-13 {
                let [_, _, deflection] = middle(at, rod);
                return Ok(Self {
                    factor: at[1],
                    deflection,
                });
            }
            let h = 1e-6;
            let beside = [miss([at[0] + h, at[1]]), miss([at[0], at[1] + h])];
            let [[a, c], [b, d]] = beside.map(|there| [0, 1].map(|k| (there[k] - now[k]) / h));
            let determinant = a * d - b * c;
            at[0] -= (d * now[0] - b * now[1]) / determinant;
            at[1] -= (a * now[1] - c * now[0]) / determinant;
        }
        Err("no column was found between these ends")
    }
}

/// `[θ, x, w]` in the middle of a column of an end slope (rad) and a `P/Pcr`.
fn middle([slope, factor]: [f64; 2], rod: Rod) -> [f64; 3] {
    let force = factor * PI * PI * BENDING;
    let [stretch, shear] = rod.compliances;
    let rate = |s: f64, [angle, _, w]: [f64; 3]| {
        let (sin, cos) = angle.sin_cos();
        let (along, across) = (1.0 - force * cos * stretch, force * sin * shear);
        [
            -force * w / BENDING - rod.bow * PI * PI * (PI * s).sin(),
            along * cos - across * sin,
            along * sin + across * cos,
        ]
    };
    let h = 0.5 / STEPS as f64;
    let mut at = [slope, 0.0, 0.0];
    for step in 0..STEPS {
        let s = h * step as f64;
        let ahead = |by: f64, rate: [f64; 3]| [0, 1, 2].map(|k| at[k] + by * rate[k]);
        let first = rate(s, at);
        let second = rate(s + 0.5 * h, ahead(0.5 * h, first));
        let third = rate(s + 0.5 * h, ahead(0.5 * h, second));
        let fourth = rate(s + h, ahead(h, third));
        at = [0, 1, 2]
            .map(|k| at[k] + h / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]));
    }
    at
}
