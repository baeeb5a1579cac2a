//! Plastic flow of metals at large strains: von Mises' yield condition with isotropic hardening.
//!
//! `F = Fe Fp` with Hencky's energy of `be = Fe Feᵀ` and the exponential map, whose return is that of small strains in the logarithms
//! (Weber and Anand 1990; Simo 1992): with the trial `F' Fp⁻¹` of a step and its logarithmic strains `ε`,
//!
//! ```text
//! e = √(2/3) |dev ε|,    3 μ (e - x) = Y(α + x),    x >= 0          von Mises' stress is 3 μ e
//! dev ε' = (1 - x/e) dev ε,    Fp'⁻¹ = Fp⁻¹ exp(-x/e dev ε),    α' = α + x
//! ```
//!
//! so that flow keeps the volume exactly. The *incremental potential*, elastic energy and what the flow dissipates in the step,
//!
//! ```text
//! Φ = K/2 θ² + ψ(m),    ψ(m) = min over x of 3/2 μ (e - x)² + ∫ Y dα = μ m - ℓ,    m = 3/2 e²
//! ```
//!
//! is a function of `t` and `J` of `Fe = F' Fp⁻¹` and of nothing else, as a hyperelastic law is. So is its pair between the beginning of a step, which
//! is elastic, and its end (see `logarithmic`): the stress `P = (2 a Fe½ + b cof Fe½) Fp⁻ᵀ` does exactly the work
//!
//! ```text
//! P : ΔF = ΔΦ = ΔW + ∫ Y dα,    ∫ Y dα >= 0
//! ```
//!
//! and turns nothing, however much flows in the step. At one state the pair is the gradient of `Φ`, the stress of the return mapping, with the symmetric
//! tangent that belongs to it.

use super::hardening::Hardening;
use super::logarithmic::{self, LogStrain, Pair, Slope, cosh, over_sinh};
use super::{ElasticConstants, Hencky, Hyperelastic, Invariants, Volumetric};
use crate::fe::material::MaterialError;
use crate::fe::record::LawRecord;

/// Von Mises plasticity with isotropic hardening, in plane strain: Hencky's law until the stress `√(3/2) |dev τ|` (of Kirchhoff, `τ = J σ`) is
/// the yield stress `Y(α) = Y0 + H α + S (1 - e^(-δ α))`.
///
/// All plastic work is dissipated; hardening stores none. As a [`Hyperelastic`] it is its elastic part, [`Hencky`]; a body of it is one of large
/// strain and keeps what has flowed, see [`FlexBody::plastic_strains`](crate::body::FlexBody::plastic_strains).
///
/// ```
/// use foil2d::fe::material::Material;
/// use foil2d::fe::material::hyperelastic::{HyperelasticSolid, J2Plasticity};
///
/// // Mild steel: yields at 250 MPa and hardens to 400.
/// let law = J2Plasticity::plane_strain(2.1e11, 0.3, 250e6).with_saturation(400e6, 15.0);
/// let steel = HyperelasticSolid::new(law).with_density(7850.0);
/// assert!(steel.validate().is_ok());
/// assert!((law.yield_stress_at(0.1) / 366.5e6 - 1.0).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct J2Plasticity {
    elastic: Hencky,
    hardening: Hardening,
}

/// What has flowed at one quadrature point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PlasticState {
    /// `Fp⁻¹` in the plane, `[xx, xy, yx, yy]` (-).
    pub inverse: [f64; 4],
    /// The elastic logarithmic strain out of the plane, minus the plastic one (-).
    pub lateral: f64,
    /// The accumulated plastic strain `α = ∫ √(2/3) |dp|` (-).
    pub strain: f64,
    /// What of the bending of a four-node cell has flowed (m); zero of others.
    pub bend: [f64; 2],
    /// The share of its plastic bending that a four-node cell has left beside its mean stress (-).
    pub bendable: f64,
}

impl PlasticState {
    /// Of material that has never flowed.
    pub const VIRGIN: Self = Self {
        inverse: [1.0, 0.0, 0.0, 1.0],
        lateral: 0.0,
        strain: 0.0,
        bend: [0.0; 2],
        bendable: 1.0,
    };

    /// Whether the numbers may be those of a body.
    pub fn is_sound(&self) -> bool {
        let [xx, xy, yx, yy] = self.inverse;
        let [along, across] = self.bend;
        let own = [self.lateral, self.strain, self.bendable, along, across];
        let mut all = [xx, xy, yx, yy].into_iter().chain(own);
        all.all(f64::is_finite) && xx * yy - xy * yx > 0.0 && self.strain >= 0.0
    }

    /// `F Fp⁻¹`.
    #[inline]
    pub(crate) fn elastic(&self, [xx, xy, yx, yy]: [f64; 4]) -> [f64; 4] {
        let [a, b, c, d] = self.inverse;
        [
            xx * a + xy * c,
            xx * b + xy * d,
            yx * a + yy * c,
            yx * b + yy * d,
        ]
    }

    /// `Fp⁻ᵀ ∇N`: the gradient by the intermediate placement.
    #[inline]
    pub(crate) fn gradient(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c, d] = self.inverse;
        [a * x + c * y, b * x + d * y]
    }
}

/// What a point is after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flow {
    /// Elastic energy (J/m³).
    pub stored: f64,
    /// What the flow of the step has dissipated (J/m³).
    pub dissipated: f64,
    /// Von Mises' stress over the yield stress (-).
    pub used: f64,
    pub state: PlasticState,
}

impl J2Plasticity {
    /// Perfect plasticity with Young's modulus `young` (Pa), Poisson's ratio `poisson` (-) and a yield stress (Pa) in simple tension.
    pub fn plane_strain(young: f64, poisson: f64, yield_stress: f64) -> Self {
        Self {
            elastic: Hencky::plane_strain(young, poisson),
            hardening: Hardening {
                yield_stress,
                modulus: 0.0,
                saturation: 0.0,
                rate: 0.0,
            },
        }
    }

    /// Adds linear hardening of a modulus `H` (Pa), the slope of the yield stress over the plastic strain.
    pub fn with_hardening(mut self, modulus: f64) -> Self {
        self.hardening.modulus = modulus;
        self
    }

    /// Adds hardening that brings the yield stress to `saturated` (Pa), less what linear hardening adds, at a rate `δ` (-): two thirds of the way
    /// within a plastic strain of `1/δ`.
    ///
    /// Source: Voce, J. Inst. Metals 74 (1948), 537–562.
    pub fn with_saturation(mut self, saturated: f64, rate: f64) -> Self {
        self.hardening.saturation = saturated - self.hardening.yield_stress;
        self.hardening.rate = rate;
        self
    }

    /// How the yield stress grows.
    pub fn hardening(&self) -> Hardening {
        self.hardening
    }

    /// The yield stress (Pa) after an accumulated plastic strain (-).
    pub fn yield_stress_at(&self, strain: f64) -> f64 {
        self.hardening.yield_stress_at(strain)
    }

    /// `3 μ` (Pa).
    fn stiffness(&self) -> f64 {
        3.0 * self.elastic.constants().mu()
    }

    /// What the root of twice the energy of the hourglass modes of a four-node cell may reach (√J): that of its fully plastic bending,
    /// one and a half times what brings its edges to `2/√3 Y`, so `√(V (1 - ν²)/E) Y`, and the share of it that is left beside the mean stress.
    pub(crate) fn bending_limit(&self, state: &PlasticState, volume: f64) -> f64 {
        let constants = self.elastic.constants();
        let (young, poisson) = (constants.young(), constants.poisson());
        let yields = self.hardening.yield_stress_at(state.strain);
        (volume * (1.0 - poisson * poisson) / young).sqrt() * yields * state.bendable
    }

    /// The plastic strain of a cell in whose bending so much has been dissipated (J/m³): in the mean that over the yield stress, and 4/3 of it where it counts by
    /// its lever, as the flow grows towards the edges.
    pub(crate) fn bending_strain(&self, state: &PlasticState, dissipated: f64) -> f64 {
        4.0 / 3.0 * dissipated / self.hardening.yield_stress_at(state.strain)
    }

    fn returned(&self, state: &PlasticState, m: f64) -> (f64, super::hardening::Return) {
        let trial = (m / 1.5).sqrt();
        let back = self.hardening.flow(self.stiffness(), state.strain, trial);
        (trial, back)
    }

    fn outside(&self, state: &PlasticState) -> [f64; 2] {
        [state.lateral, self.elastic.bulk()]
    }

    /// `ψ' = μ (1 - x/e)`, and `ψ'' = -μ (∂x/∂e - x/e)/2m`.
    fn slope_at(&self, state: &PlasticState, m: f64) -> Slope {
        let mu = self.elastic.constants().mu();
        let (trial, back) = self.returned(state, m);
        if back.flow == 0.0 {
            return Slope {
                value: mu,
                rise: 0.0,
            };
        }
        let share = back.flow / trial;
        Slope {
            value: mu * (1.0 - share),
            rise: -0.5 * mu * (back.rate - share) / m,
        }
    }

    /// `ψ̄ = μ - ℓ(m')/(m' - m)`: nothing flows at the beginning.
    fn slope_between(&self, state: &PlasticState, from: f64, to: f64) -> Slope {
        let mu = self.elastic.constants().mu();
        let (trial, back) = self.returned(state, to);
        let change = to - from;
        // What begins beyond the yield stress does so by rounding.
        if back.flow == 0.0 || change <= 0.0 {
            return Slope {
                value: mu,
                rise: 0.0,
            };
        }
        let share = back.flow / trial;
        let value = mu - back.loss / change;
        let rise = if change > SMALL * to {
            (mu * (1.0 - share) - value) / change
        } else {
            -0.25 * mu * (back.rate - share) / to
        };
        Slope { value, rise }
    }

    /// The pair between two elastic gradients, the second of which may flow, and twice its slopes.
    pub(crate) fn between(
        &self,
        state: &PlasticState,
        [from, to]: [[f64; 4]; 2],
    ) -> ([f64; 2], [f64; 3]) {
        let [from, to] = [from, to].map(LogStrain::of);
        let [before, after] = [&from, &to].map(|strain| strain.deviator(state.lateral));
        let slope = self.slope_between(state, before, after);
        let Pair { pair, slopes } = logarithmic::between(&from, &to, self.outside(state), slope);
        (pair, slopes.map(|slope| 2.0 * slope))
    }

    /// Gradient and Hessian of the incremental potential.
    pub(crate) fn at(&self, state: &PlasticState, at: [f64; 4]) -> ([f64; 2], [f64; 3]) {
        let strain = LogStrain::of(at);
        let slope = self.slope_at(state, strain.deviator(state.lateral));
        let Pair { pair, slopes } = logarithmic::at(&strain, self.outside(state), slope);
        (pair, slopes)
    }

    /// Kirchhoff's stress out of the plane (Pa).
    pub(crate) fn lateral_stress(&self, state: &PlasticState, at: [f64; 4]) -> f64 {
        let strain = LogStrain::of(at);
        let slope = self.slope_at(state, strain.deviator(state.lateral)).value;
        let pressure = self.elastic.bulk() * (strain.sum + state.lateral);
        pressure - 2.0 * slope * (strain.sum - 2.0 * state.lateral) / 3.0
    }

    /// What a point is after a step that ends at the elastic trial gradient `at`.
    pub(crate) fn flow(&self, state: &PlasticState, at: [f64; 4]) -> Flow {
        let strain = LogStrain::of(at);
        let m = strain.deviator(state.lateral);
        let (trial, back) = self.returned(state, m);
        let volume = strain.sum + state.lateral;
        let elastic = trial - back.flow;
        let stored = 0.5 * self.elastic.bulk() * volume * volume
            + 0.5 * self.stiffness() * elastic * elastic;
        let yields = self.yield_stress_at(state.strain + back.flow);
        let used = self.stiffness() * elastic / yields;
        if back.flow == 0.0 {
            return Flow {
                stored,
                used,
                dissipated: 0.0,
                state: *state,
            };
        }
        Flow {
            stored,
            used,
            dissipated: self.hardening.dissipated(state.strain, back.flow),
            state: flowed(state, &strain, at, (back.flow / trial, back.flow)),
        }
    }
}

/// Change of `m`, relative, up to which derivatives at the end are those of the mean slope (-).
const SMALL: f64 = 1e-8;

/// The state after the share `κ = x/e` of the deviator has become plastic.
///
/// In the plane `dev ε` is `p I` and `± d/2` along the axes of `C = FeᵀFe`, whose deviator has the eigenvalues `± J sinh d`, out of it `-2 p`:
///
/// ```text
/// exp(-κ dev ε) = e^(-κ p) [cosh(κ d/2) I - sinh(κ d/2)/(J sinh d) (C - t/2 I)]
/// ```
fn flowed(
    state: &PlasticState,
    strain: &LogStrain,
    [xx, xy, yx, yy]: [f64; 4],
    (share, flow): (f64, f64),
) -> PlasticState {
    let mean = (strain.sum - 2.0 * state.lateral) / 6.0;
    let half = 0.5 * share * strain.difference;
    // sinh(κ d/2)/sinh d = κ/2 c(d)/c(κ d/2), also where both vanish.
    let along = 0.5 * share * over_sinh(strain.difference) / over_sinh(half) / strain.j;
    let (scale, round) = (crate::math::exp(-share * mean), cosh(half));
    let deviator = 0.5 * (xx * xx + yx * yx - xy * xy - yy * yy);
    let shear = xx * xy + yx * yy;
    let map = [
        scale * (round - along * deviator),
        -scale * along * shear,
        scale * (round + along * deviator),
    ];
    let [a, b, c, d] = state.inverse;
    PlasticState {
        inverse: [
            a * map[0] + b * map[1],
            a * map[1] + b * map[2],
            c * map[0] + d * map[1],
            c * map[1] + d * map[2],
        ],
        lateral: state.lateral + 2.0 * share * mean,
        strain: state.strain + flow,
        bend: state.bend,
        bendable: state.bendable,
    }
}

impl Hyperelastic for J2Plasticity {
    fn name(&self) -> &'static str {
        "J2 plasticity"
    }

    fn constants(&self) -> ElasticConstants {
        self.elastic.constants()
    }

    fn record(&self) -> LawRecord {
        LawRecord::J2Plasticity(*self)
    }

    fn plasticity(&self) -> Option<&J2Plasticity> {
        Some(self)
    }

    fn volumetric(&self) -> Option<Volumetric> {
        self.elastic.volumetric()
    }

    fn energy_density(&self, at: Invariants) -> f64 {
        self.elastic.energy_density(at)
    }

    fn gradient(&self, at: Invariants) -> [f64; 2] {
        self.elastic.gradient(at)
    }

    fn hessian(&self, at: Invariants) -> [f64; 3] {
        self.elastic.hessian(at)
    }

    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
        self.elastic.conserving_pair(from, to)
    }

    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
        self.elastic.conserving_hessian(from, to)
    }

    fn admits(&self, at: Invariants) -> bool {
        at.j > 0.0
    }

    fn validate(&self) -> Result<(), MaterialError> {
        self.constants().validate()?;
        self.hardening.validate()
    }
}

#[cfg(test)]
mod tests;
