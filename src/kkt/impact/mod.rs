//! Impact treatments: what is done beyond (C.5) when bodies collide, each in its file behind one trait.
//!
//! All share the position stage: `g(x') >= 0`, `p >= 0`. They differ in what the multipliers do to velocities and to the
//! accelerations that the next step starts from.
//!
//! | treatment | velocities and accelerations |
//! |---|---|
//! | `Stabilized` | projected between masses; no energy from contact |
//! | `Projected` | projected between masses (Hughes et al. 1976; Laursen and Love 2002) |
//! | `ImplicitForces` | contact forces belong to the end of the step alone (Kane et al. 1999) |
//! | `Plain` | (C.5) as printed |
//!
//! Two further ones are chosen elsewhere: mass redistribution (Khenous, Laborde, Renard 2008) is a property of a body, see
//! [`ContactInertia`](crate::body::ContactInertia); multipliers at the forward increment (Carpenter, Taylor, Katona 1991) come
//! with `β0 = 0`.
//!
//! Left out, because they cannot be stated as what follows a position stage with `g(x') >= 0`:
//!
//! - *contact-stabilized* (Deuflhard, Krause, Ertel 2008) projects the predictor `x + dt v` before the forces are known, which changes
//!   `q0` of (C.5) itself;
//! - *energy-conserving* (Laursen, Chawla 1997) balances `p` against the gap's rate at mid-step instead of the gap, so that bodies
//!   overlap while they meet;
//! - *velocity level* (Moreau, Jean 1999) constrains `v'` instead of `x'`: its multipliers are impulses, and overlaps
//!   of a step's length remain.

mod forward;
mod implicit_forces;
mod plain;
mod projected;
mod stabilized;

use super::island::{Island, KktError, SolveSettings};
use super::summary::IslandSummary;

/// How impacts are treated. Whether a body's contact boundary carries inertia is chosen per body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum ImpactTreatment {
    /// Velocity impulses between masses and on impacts shorter than the step, and no energy from contact: stable at any
    /// step and mesh.
    #[default]
    Stabilized,
    /// (C.5) as printed, multipliers enter the stored acceleration. Unstable on impact: for comparison only.
    Plain,
    /// Velocities and accelerations of masses in contact are projected so that they stay in contact (Hughes et al. 1976;
    /// Laursen and Love 2002): [`Stabilized`](Self::Stabilized) without its energy stage.
    Projected,
    /// The contact forces of a step act on its end alone and are no part of the acceleration that the next step starts from
    /// (Kane et al. 1999): loses energy at impact and gains none afterwards. The velocity of a node that stays in contact
    /// changes sign with every step, and its force swings with it, without growing. Contacts through nodes without mass are
    /// quasi-static as ever.
    ImplicitForces,
}

/// What happens after the position stage.
pub(super) trait Treatment {
    /// Gives the blocks the velocities and accelerations that go with the multipliers.
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError>;

    /// Whether the energy stage follows.
    fn limits_energy(&self) -> bool {
        false
    }
}

impl SolveSettings {
    /// The treatment of this solve; with `β0 = 0` there is only one.
    pub(super) fn treatment(&self) -> &'static dyn Treatment {
        match self.impact {
            _ if self.is_explicit => &forward::Forward,
            ImpactTreatment::Stabilized => &stabilized::Stabilized,
            ImpactTreatment::Plain => &plain::Plain,
            ImpactTreatment::Projected => &projected::Projected,
            ImpactTreatment::ImplicitForces => &implicit_forces::ImplicitForces,
        }
    }
}
