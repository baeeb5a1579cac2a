//! Isotropic laws for large strains in the plane: `W(t, J)` with `t = |F|²` and `J = det F`.
//!
//! `F = dx/dX` is the gradient of deformation in the plane; out of it nothing stretches (plane strain), or the thickness `z` of a sheet
//! is the one of least energy, `σ_zz = 0` (plane stress), which makes it a law of the plane again. Every isotropic
//! law is a function of these two invariants, and its stress is
//!
//! ```text
//! P = dW/dF = 2 W_t F + W_J cof F,    cof F = dJ/dF = [F_yy, -F_yx; -F_xy, F_xx]
//! ```
//!
//! so that it is indifferent to rotations by its form: `P(Q F) = Q P(F)`. `J` has a sign, by which a law knows material that is
//! turned inside out; one of `C = FᵀF` does not.
//!
//! # The conserving pair
//!
//! Both invariants are quadratic in `F`, so between two states with the mean `F½ = (F + F')/2`
//!
//! ```text
//! t' - t = 2 F½ : (F' - F),    J' - J = cof F½ : (F' - F)          (exactly)
//! ```
//!
//! and a stress `P = 2 a F½ + b cof F½` with `a (t' - t) + b (J' - J) = W' - W` does exactly the work that the energy rises by,
//! while `P F½ᵀ` is symmetric, so that it turns nothing. [`Hyperelastic::conserving_pair`] gives `(a, b)` in closed form,
//! without quotients of differences that vanish together.
//!
//! | law | for what |
//! |---|---|
//! | [`StableNeoHookean`] | what is soft or crushed: recovers from being turned inside out |
//! | [`Corotated`] | what is stiff and bends far |
//! | [`NeoHookean`] | where `J > 0` must hold: the energy has a barrier there |
//! | [`MooneyRivlin`] | rubber, by two constants measured in two ways of pulling it |
//! | [`Gent`] | rubber that is pulled until its chains are straight |
//! | [`NeoHookeanSheet`] | thin sheets, free to change their thickness; `ν = 0.5` is allowed |
//! | [`MooneyRivlinSheet`] | thin sheets of rubber that keep their volume |
//! | [`Hencky`] | metals before they yield |
//! | [`J2Plasticity`] | metals that yield: what has flowed stays, see there |
//! | [`StVenantKirchhoff`] | comparisons: it softens when compressed below `1/√3` and stays inverted |
//!
//! # Beside rest
//!
//! What is stiff is strained little, and its stress is a small difference of moduli. Forces ask for [`Hyperelastic::conserving_sums`] and energies for
//! [`Hyperelastic::energy_of`], which take gradients and, where a law gives them in closed form ([`BesideRest`]), have the digits of the stress: of a plate of `E = 1e11 Pa`
//! that spins at 5 rad/s the energy is then kept to 1e-12 and the angular momentum to 1e-14, where 1e-8 and 1e-10 were known.
//!
//! Implementers are tested by [`conformance::check_law`].

mod beside_rest;
pub mod conformance;
mod constants;
mod corotated;
mod gent;
mod hardening;
mod hencky;
mod j2;
mod logarithmic;
mod mooney_rivlin;
mod neo_hookean;
mod neo_hookean_sheet;
mod quotient;
mod solid;
mod st_venant_kirchhoff;
mod stable_neo_hookean;
mod volumetric;

pub use beside_rest::BesideRest;
pub use constants::ElasticConstants;
pub use corotated::Corotated;
pub use gent::Gent;
pub use hardening::Hardening;
pub use hencky::Hencky;
pub use j2::{J2Plasticity, PlasticState};
pub use mooney_rivlin::{MooneyRivlin, MooneyRivlinSheet};
pub use neo_hookean::NeoHookean;
pub use neo_hookean_sheet::NeoHookeanSheet;
pub use solid::HyperelasticSolid;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub use stable_neo_hookean::StableNeoHookean;
pub use volumetric::Volumetric;

use super::{MaterialError, Plane};
use crate::fe::record::LawRecord;
use std::fmt::Debug;

/// The two invariants of a gradient of deformation in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invariants {
    /// `t = |F|² = tr FᵀF` (-), 2 at rest.
    pub t: f64,
    /// `J = det F` (-), 1 at rest; negative where the material is turned inside out.
    pub j: f64,
}

impl Invariants {
    /// Those of the undeformed material.
    pub const REST: Self = Self { t: 2.0, j: 1.0 };

    /// Those of a gradient `[F_xx, F_xy, F_yx, F_yy]` (-).
    #[inline]
    pub fn of(gradient: [f64; 4]) -> Self {
        let [xx, xy, yx, yy] = gradient;
        Self {
            t: xx * xx + xy * xy + yx * yx + yy * yy,
            j: xx * yy - xy * yx,
        }
    }

    /// The mean of both invariants.
    #[inline]
    pub fn mean(self, other: Self) -> Self {
        Self {
            t: 0.5 * (self.t + other.t),
            j: 0.5 * (self.j + other.j),
        }
    }
}

/// An isotropic law of stored energy `W(t, J)`, in plane strain unless it says otherwise.
pub trait Hyperelastic: Send + Sync + Debug {
    /// The name used in messages.
    fn name(&self) -> &'static str;

    /// The elastic constants at rest, which are those of linear elasticity in plane strain: of a sheet those with its moduli in the plane.
    fn constants(&self) -> ElasticConstants;

    /// The stored energy `W` per undeformed volume (J/m^3), zero at rest.
    fn energy_density(&self, at: Invariants) -> f64;

    /// `[W_t, W_J]` (Pa).
    fn gradient(&self, at: Invariants) -> [f64; 2];

    /// `[W_tt, W_tJ, W_JJ]` (Pa).
    fn hessian(&self, at: Invariants) -> [f64; 3];

    /// The pair `(a, b)` (Pa) with `a (t' - t) + b (J' - J) = W' - W`, to rounding; the gradient where both states are one.
    ///
    /// Symmetric in its arguments.
    fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2];

    /// `[2 a + b, 2 a - b]` of that pair (Pa) between two gradients, or of [`gradient`](Self::gradient) where both are one: what stands before
    /// both parts of the mean gradient in the stress, see [`BesideRest`].
    ///
    /// Overridden where `2 a + b`, which is zero at rest, has a form that does not cancel there.
    fn conserving_sums(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 2] {
        let [a, b] = self.conserving_pair(Invariants::of(from), Invariants::of(to));
        [2.0 * a + b, 2.0 * a - b]
    }

    /// The stored energy per undeformed volume (J/m^3) of a gradient; overridden where it has a form that does not cancel at rest.
    fn energy_of(&self, gradient: [f64; 4]) -> f64 {
        self.energy_density(Invariants::of(gradient))
    }

    /// `2 [∂a/∂t', (∂a/∂J' + ∂b/∂t')/2, ∂b/∂J']` of that pair (Pa), by which a step finds its end; the Hessian where both states are one.
    ///
    /// The Hessian in the middle is no substitute: where `J` falls from .2 to .02 the barrier of [`NeoHookean`] is six times as stiff.
    fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3];

    /// Whether the law has an energy there.
    fn admits(&self, at: Invariants) -> bool {
        let _ = at;
        true
    }

    /// The [`energy_of`](Self::energy_of) each of four gradients: cells stand side by side, and ask together.
    fn energies_of(&self, gradients: &[[f64; 4]; 4]) -> [f64; 4] {
        gradients.map(|gradient| self.energy_of(gradient))
    }

    /// The [`conserving_sums`](Self::conserving_sums) of each of four pairs of gradients.
    fn conserving_sums_of(&self, from: &[[f64; 4]; 4], to: &[[f64; 4]; 4]) -> [[f64; 2]; 4] {
        std::array::from_fn(|k| self.conserving_sums(from[k], to[k]))
    }

    /// The [`gradient`](Self::gradient) at each of four places.
    fn gradients(&self, at: &[Invariants; 4]) -> [[f64; 2]; 4] {
        at.map(|at| self.gradient(at))
    }

    /// The [`hessian`](Self::hessian) at each of four places.
    fn hessians(&self, at: &[Invariants; 4]) -> [[f64; 3]; 4] {
        at.map(|at| self.hessian(at))
    }

    /// The [`conserving_pair`](Self::conserving_pair) of each of four places.
    fn conserving_pairs(&self, from: &[Invariants; 4], to: &[Invariants; 4]) -> [[f64; 2]; 4] {
        std::array::from_fn(|k| self.conserving_pair(from[k], to[k]))
    }

    /// The [`conserving_hessian`](Self::conserving_hessian) of each of four places.
    fn conserving_hessians(&self, from: &[Invariants; 4], to: &[Invariants; 4]) -> [[f64; 3]; 4] {
        std::array::from_fn(|k| self.conserving_hessian(from[k], to[k]))
    }

    /// Whether the law has an energy at all of four places.
    fn admits_all(&self, at: &[Invariants; 4]) -> bool {
        at.iter().all(|at| self.admits(*at))
    }

    /// What happens normal to the plane: nothing stretches unless overridden.
    fn plane(&self) -> Plane {
        Plane::Strain
    }

    /// The stretch of the thickness (-): one in plane strain.
    fn thickness_stretch(&self, at: Invariants) -> f64 {
        let _ = at;
        1.0
    }

    /// Cauchy's stress `σ_zz` (Pa) normal to the plane, zero in plane stress.
    ///
    /// Unless overridden it is Hooke's share `ν` of the sum in the plane, exact at small strains; of material that is turned inside out that of
    /// the area it covers, `|J|`.
    fn out_of_plane_stress(&self, at: Invariants) -> f64 {
        let [a, b] = self.gradient(at);
        let area = at.j.abs().max(f64::MIN_POSITIVE);
        self.constants().poisson() * 2.0 * (a * at.t + b * at.j) / area
    }

    /// A part of the energy that depends on `J` alone and holds what grows beyond bounds as `ν` tends to one half; what is left of the energy must be
    /// bounded below beside it. Cells that would lock take this part from a smoothed `J`, see [`Quad8`](crate::fe::element::Quad8); none unless
    /// overridden, and of laws that resist a change of volume by other terms.
    fn volumetric(&self) -> Option<Volumetric> {
        None
    }

    /// The plastic flow of a law that has one: its bodies keep what has flowed, and the functions here are those of material that never has.
    fn plasticity(&self) -> Option<&J2Plasticity> {
        None
    }

    /// What a snapshot writes of the law; bodies of one that is [`LawRecord::Unknown`] cannot be saved.
    fn record(&self) -> LawRecord {
        LawRecord::Unknown
    }

    /// Whether the parameters make sense; called once, when a body is assembled.
    ///
    /// # Errors
    /// The first parameter out of its range, with its value and the cure.
    fn validate(&self) -> Result<(), MaterialError> {
        self.constants().validate()
    }
}

/// The nominal stresses (Pa) along the principal axes of a material of principal stretches `σ` (-), one of which may be negative.
pub fn principal_stress(law: &dyn Hyperelastic, [first, second]: [f64; 2]) -> [f64; 2] {
    let [a, b] = law.gradient(Invariants::of([first, 0.0, 0.0, second]));
    [2.0 * a * first + b * second, 2.0 * a * second + b * first]
}
