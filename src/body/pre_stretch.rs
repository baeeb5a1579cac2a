//! Tension that a body has where it is built: how much longer it is there than where it is free of stress.
//!
//! A body that is drawn as `p` is free of stress as `p0 + (p - p0)/λ`, with the stretches `λ` along the axes of its mesh. Where stresses are asked
//! for instead, `λ` follows from the law by Newton's method, from rest on in stages:
//!
//! ```text
//! σ_x = P_x/(λ_y z),    σ_y = P_y/(λ_x z)          P nominal stresses, z the stretch of the thickness
//! ```

use super::error::BuildError;
use super::materials::large_law_of;
use crate::fe::material::Material;
use crate::fe::material::hyperelastic::{Hyperelastic, Invariants, PlasticState, principal_stress};
use crate::math::rounding;
use std::sync::Arc;

/// Stages in which what is asked for is reached, so that a law that softens is followed on the branch that begins at rest.
const STAGES: u32 = 32;

/// Iterations of a stage; some six are needed, and halvings of a step that leads where the law has no energy.
const MOST_ITERATIONS: u32 = 60;

/// How a body is stretched where it is built, along the axes of its mesh: for [`FlexBodyBuilder::pre_stretch`](super::FlexBodyBuilder::pre_stretch).
///
/// Moduli, density, thickness and the gas of an inner pressure are those of the stress-free shape, which is the mesh shrunk by the stretches: the mass is
/// that of the shrunk mesh. Displacements count from the mesh itself. What holds the tension is up to pins and attachments; a free body contracts.
///
/// ```
/// use foil2d::prelude::*;
/// let string = FlexBodyBuilder::rectangle([1.0, 0.005], [50, 1])
///     .material(LinearElastic::plane_stress(2e9, 0.0).density(1100.0))
///     .pre_stretch(PreStretch::along_x(1.02))
///     .pin_where(|[x, _]| x == 0.0 || x == 1.0, Pin::both())
///     .build()?;
/// // Neo-Hookean, without contraction: σ = E/2 (λ - 1/λ).
/// let tension = string.stress()?[60].xx;
/// assert!((tension / (1e9 * (1.02 - 1.0 / 1.02)) - 1.0).abs() < 1e-9);
/// // The note of such a string, and some bending: √(σ/ρ)/2L (Hz), the density ρ as it is stretched.
/// let lowest = string.natural_modes(1, 1e-8)?.frequencies()[0] / std::f64::consts::TAU;
/// assert!((lowest / (0.5 * (tension * 1.02 / 1100.0).sqrt()) - 1.0).abs() < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreStretch(Kind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Both([f64; 2]),
    Alone { axis: usize, stretch: f64 },
    Stress([f64; 2]),
}

impl From<[f64; 2]> for PreStretch {
    /// Stretches along x and y (-): length where it is built over length free of stress.
    fn from(stretches: [f64; 2]) -> Self {
        Self(Kind::Both(stretches))
    }
}

impl PreStretch {
    /// A stretch along x (-), with sides that are free: there is no stress along y, and the stretch along y is what the law makes of that.
    pub fn along_x(stretch: f64) -> Self {
        Self(Kind::Alone { axis: 0, stretch })
    }

    /// A stretch along y (-), without stress along x.
    pub fn along_y(stretch: f64) -> Self {
        Self(Kind::Alone { axis: 1, stretch })
    }

    /// Cauchy's stresses along x and y (Pa), tension positive: those that [`FlexBody::stress`](super::FlexBody::stress) tells of the body as it is
    /// built. A strip of height `h` pulls by `σ h t`, with the thickness `t` that it has when it is stretched. Laws whose stress per area as stretched has a
    /// largest value are refused beyond it.
    pub fn by_stress(stress: [f64; 2]) -> Self {
        Self(Kind::Stress(stress))
    }

    /// Refuses what is no number, or no stretch.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        let (name, values, least, cure) = match self.0 {
            Kind::Both(stretches) => (
                "pre_stretch",
                stretches,
                0.0,
                "give a positive finite stretch, 1.05 for five per cent",
            ),
            Kind::Alone { stretch, .. } => (
                "pre_stretch",
                [stretch; 2],
                0.0,
                "give a positive finite stretch, 1.05 for five per cent",
            ),
            Kind::Stress(stress) => (
                "the stress of pre_stretch",
                stress,
                f64::NEG_INFINITY,
                "give a finite stress",
            ),
        };
        let is_bad = |value: &f64| !(value.is_finite() && *value > least);
        match values.into_iter().find(is_bad) {
            Some(value) => Err(BuildError::Number { name, value, cure }),
            None => Ok(()),
        }
    }

    /// The stretches of a body of this material, and of these in some regions.
    pub(super) fn stretches(
        self,
        material: &Arc<dyn Material>,
        regions: &[(u32, Arc<dyn Material>)],
    ) -> Result<[f64; 2], BuildError> {
        let stretches = self.stretches_of(large_law_of(None, material.as_ref())?.as_ref())?;
        for (region, own) in regions {
            let own = self.stretches_of(large_law_of(Some(*region), own.as_ref())?.as_ref())?;
            let is_same = |axis: usize| {
                (own[axis] - stretches[axis]).abs() <= rounding::SHARE * stretches[axis]
            };
            if !(0..2).all(is_same) {
                return Err(BuildError::PreStretchRegion {
                    region: *region,
                    stretches: [stretches, own],
                });
            }
        }
        Ok(stretches)
    }

    fn stretches_of(self, law: &dyn Hyperelastic) -> Result<[f64; 2], BuildError> {
        let asked = match self.0 {
            Kind::Both(stretches) => stretches,
            Kind::Alone { stretch, .. } => [stretch; 2],
            Kind::Stress(stress) => stress,
        };
        let stretches = self
            .found(law)
            .filter(|stretches| law.energy_of(diagonal(*stretches)).is_finite());
        let stretches = stretches.ok_or(BuildError::PreStretchBeyond {
            law: law.name(),
            asked,
        })?;
        let flows = law.plasticity().is_some_and(|plastic| {
            let flow = plastic.flow(&PlasticState::VIRGIN, diagonal(stretches));
            flow.dissipated > 0.0
        });
        match flows {
            true => Err(BuildError::PreStretchFlows {
                law: law.name(),
                stretches,
            }),
            false => Ok(stretches),
        }
    }

    /// The stretches that a law has, if there are any.
    fn found(self, law: &dyn Hyperelastic) -> Option<[f64; 2]> {
        let modulus = law.constants().lambda() + 2.0 * law.constants().mu();
        let nominal = |at: [f64; 2]| principal_stress(law, at).map(|stress| stress / modulus);
        let mut at = [1.0; 2];
        match self.0 {
            Kind::Both(stretches) => return admitted(law, stretches).then_some(stretches),
            Kind::Alone { axis, stretch } => {
                for stage in 1..=STAGES {
                    let share = f64::from(stage) / f64::from(STAGES);
                    // The last one is given to its last digit.
                    let given = if stage == STAGES {
                        stretch
                    } else {
                        1.0 + share * (stretch - 1.0)
                    };
                    at[axis] = given;
                    at = solve(at, |at| {
                        let mut residual = nominal(at);
                        residual[axis] = at[axis] - given;
                        admitted(law, at).then_some(residual)
                    })?;
                    at[axis] = given;
                }
            }
            Kind::Stress(stress) => {
                for stage in 1..=STAGES {
                    let share = f64::from(stage) / f64::from(STAGES);
                    at = solve(at, |at| {
                        let [x, y] = nominal(at);
                        let thickness = law.thickness_stretch(Invariants::of(diagonal(at)));
                        let asked = stress.map(|own| share * own / modulus * thickness);
                        let residual = [x - asked[0] * at[1], y - asked[1] * at[0]];
                        admitted(law, at).then_some(residual)
                    })?;
                }
            }
        }
        Some(at)
    }
}

fn diagonal([x, y]: [f64; 2]) -> [f64; 4] {
    [x, 0.0, 0.0, y]
}

fn admitted(law: &dyn Hyperelastic, at: [f64; 2]) -> bool {
    at.iter().all(|stretch| *stretch > 0.0) && law.admits(Invariants::of(diagonal(at)))
}

/// A root near `at` of two residuals of the order of strains, by Newton's method with slopes by differences; until rounding has the rest.
fn solve(mut at: [f64; 2], residual: impl Fn([f64; 2]) -> Option<[f64; 2]>) -> Option<[f64; 2]> {
    let mut last = f64::INFINITY;
    for _ in 0..MOST_ITERATIONS {
        let now = residual(at)?;
        let slope = |axis: usize| {
            let mut beside = at;
            beside[axis] *= 1.0 + f64::EPSILON.sqrt();
            let (there, by) = (residual(beside)?, beside[axis] - at[axis]);
            Some([(there[0] - now[0]) / by, (there[1] - now[1]) / by])
        };
        let ([a, c], [b, d]) = (slope(0)?, slope(1)?);
        let determinant = a * d - b * c;
        let step = [
            (b * now[1] - d * now[0]) / determinant,
            (c * now[0] - a * now[1]) / determinant,
        ];
        let size = (step[0] / at[0]).abs().max((step[1] / at[1]).abs());
        if !size.is_finite() {
            return None;
        }
        if size <= rounding::SOLVED && size >= 0.5 * last || size <= f64::EPSILON {
            return Some(at);
        }
        last = size;
        // No step takes more than half of a stretch.
        let mut share = (0.5 / size).min(1.0);
        let led = |share: f64| [at[0] + share * step[0], at[1] + share * step[1]];
        for _ in 0..MOST_ITERATIONS {
            if residual(led(share)).is_some() {
                break;
            }
            share *= 0.5;
        }
        at = led(share);
    }
    None
}
