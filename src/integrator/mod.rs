//! Time integration: weights and operators only, no matrix (methods of section C.4).

mod beta2;

pub use beta2::{Beta2, IntegratorError, Weights};
