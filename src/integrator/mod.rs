//! Time integration: weights and operators only, no matrix (methods of section C.4).
//!
//! | module | owns |
//! |---|---|
//! | `beta2` | the method of (C.5), its named members |
//! | `beta_m` | the generalized family, for systems of first and second order |
//! | `amplification` | stability and accuracy of any member, from the test equation |
//! | `error` | why a member or a step is refused |

mod amplification;
mod beta2;
mod beta_m;
mod error;

pub use amplification::{Amplification, Mode, TestEquation};
pub use beta_m::{Beta1, Beta3, BetaM};
pub use beta2::{Beta2, Weights};
pub use error::IntegratorError;
