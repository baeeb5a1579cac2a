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
use super::settings::ImpactTreatment;
use super::summary::IslandSummary;

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
