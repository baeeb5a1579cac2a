//! How the yield stress grows with the plastic strain, and how far a point flows.

use crate::fe::material::MaterialError;
use crate::math::{exp, exp_m1};

/// `Y(α) = Y0 + H α + S (1 - e^(-δ α))`, with the accumulated plastic strain `α` (-): linear hardening, and what saturates (Voce 1955).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Hardening {
    /// `Y0` (Pa).
    pub yield_stress: f64,
    /// `H` (Pa).
    pub modulus: f64,
    /// `S` (Pa).
    pub saturation: f64,
    /// `δ` (-).
    pub rate: f64,
}

/// What a point does whose elastic strain would be `e` if nothing flowed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Return {
    /// Plastic strain `x` that comes (-).
    pub flow: f64,
    /// `ℓ = 3/2 μ x² + ∫ (α - α0) dY`: by how much elastic and dissipated energy are less than the elastic one without flow would be (J/m³).
    pub loss: f64,
    /// `∂x/∂e` (-).
    pub rate: f64,
}

/// Newton iterations at most; from below they rise to the root of a convex function and double their digits.
const MOST_ITERATIONS: usize = 60;

impl Hardening {
    /// The yield stress (Pa) after a plastic strain (-).
    pub fn yield_stress_at(&self, strain: f64) -> f64 {
        let saturated = -self.saturation * exp_m1(-self.rate * strain);
        self.yield_stress + self.modulus * strain + saturated
    }

    /// `∫ Y dα` over a flow from a plastic strain on (J/m³).
    pub(super) fn dissipated(&self, strain: f64, flow: f64) -> f64 {
        let linear = self.yield_stress + self.modulus * (strain + 0.5 * flow);
        let mut sum = linear * flow;
        if self.saturation > 0.0 && self.rate > 0.0 {
            let left = -exp_m1(-self.rate * flow) * exp(-self.rate * strain) / self.rate;
            sum += self.saturation * (flow - left);
        }
        sum
    }

    /// Solves `3 μ (e - x) = Y(α + x)` for `x`; nothing flows where `3 μ e <= Y(α)`.
    ///
    /// - `stiffness`: `3 μ` (Pa).
    /// - `trial`: `e`, of which `3 μ e` is von Mises' stress (-).
    pub(super) fn flow(&self, stiffness: f64, strain: f64, trial: f64) -> Return {
        let excess = stiffness * trial - self.yield_stress_at(strain);
        if excess <= 0.0 {
            return Return::default();
        }
        let left = self.saturation * exp(-self.rate * strain);
        let slope_at = |x: f64| self.modulus + left * self.rate * exp(-self.rate * x);
        let constant = stiffness + self.modulus;
        let mut flow = excess / constant;
        if left * self.rate > 0.0 {
            flow = 0.0;
            for _ in 0..MOST_ITERATIONS {
                let missing = excess - constant * flow + left * exp_m1(-self.rate * flow);
                let step = missing / (stiffness + slope_at(flow));
                flow += step;
                if step.abs() <= f64::EPSILON * flow {
                    break;
                }
            }
        }
        let saturating = if self.rate > 0.0 {
            left / self.rate * lag(self.rate * flow)
        } else {
            0.0
        };
        Return {
            flow,
            loss: 0.5 * constant * flow * flow + saturating,
            rate: stiffness / (stiffness + slope_at(flow)),
        }
    }

    /// Whether stresses and moduli make sense: what softens has no equilibrium that does not depend on the mesh.
    ///
    /// # Errors
    /// The first parameter out of its range.
    pub(super) fn validate(&self) -> Result<(), MaterialError> {
        let value = self.yield_stress;
        if !(value > 0.0 && value.is_finite()) {
            return Err(MaterialError::YieldStress { value });
        }
        for (name, value) in [
            ("modulus", self.modulus),
            ("saturation", self.saturation),
            ("rate", self.rate),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(MaterialError::Hardening { name, value });
            }
        }
        Ok(())
    }
}

/// `1 - e^(-z) - z e^(-z)`, by its series `Σ (-1)^n (n - 1) z^n/n!` where it cancels.
fn lag(z: f64) -> f64 {
    if z >= 0.5 {
        return -exp_m1(-z) - z * exp(-z);
    }
    let (mut sum, mut power) = (0.0, -z);
    for n in 2..16 {
        power *= -z / f64::from(n);
        sum += f64::from(n - 1) * power;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const VOCE: Hardening = Hardening {
        yield_stress: 2.0,
        modulus: 5.0,
        saturation: 3.0,
        rate: 20.0,
    };

    /// The condition itself, and the loss as what it is called, by a sum over the way of the flow.
    #[test]
    fn a_point_flows_until_its_stress_is_the_yield_stress() {
        for hardening in [
            VOCE,
            Hardening {
                saturation: 0.0,
                ..VOCE
            },
        ] {
            for (strain, trial) in [(0.0, 0.011), (0.0, 0.02), (0.03, 0.5), (0.4, 3.0)] {
                let (stiffness, e) = (300.0, trial);
                let Return { flow, loss, rate } = hardening.flow(stiffness, strain, e);
                let left = stiffness * (e - flow) - hardening.yield_stress_at(strain + flow);
                assert!(left.abs() < 1e-13 * stiffness * e, "{left:e}");
                let elastic = 0.5 * stiffness * (e - flow) * (e - flow);
                let whole = 0.5 * stiffness * e * e;
                let due = whole - elastic - hardening.dissipated(strain, flow);
                assert!((loss - due).abs() < 1e-14 * whole, "{loss:e} {due:e}");
                let step = 1e-6;
                let [above, below] =
                    [step, -step].map(|step| hardening.flow(stiffness, strain, e + step).flow);
                assert!((rate - (above - below) / (2.0 * step)).abs() < 1e-7);
            }
            assert_eq!(hardening.flow(300.0, 0.0, 0.006), Return::default());
        }
    }

    #[test]
    fn dissipation_is_the_integral_of_the_yield_stress() {
        let n = 4000;
        let (strain, flow) = (0.05, 0.2);
        let middle = |k: usize| strain + flow * (k as f64 + 0.5) / n as f64;
        let sum: f64 = (0..n).map(|k| VOCE.yield_stress_at(middle(k))).sum();
        let due = sum * flow / n as f64;
        // The midpoint rule errs by Y'' flow³/(24 n²) < 1e-8.
        assert!((VOCE.dissipated(strain, flow) - due).abs() < 1e-8);
        let branches = [lag(0.5 - 1e-12), lag(0.5 + 1e-12)];
        assert!((branches[0] - branches[1]).abs() < 1e-12);
    }
}
