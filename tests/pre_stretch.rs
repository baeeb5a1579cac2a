//! Bodies that are under tension, or compression, as they are built: beside the closed forms of their laws, strings, and bodies that are drawn apart.
//!
//! ```text
//!    ||=============================||
//!    ||<-- T = P(λ) h0 t0 -->       ||     free of stress it is shorter by λ, and thicker by what contracts
//!    ||=============================||
//! ```

#[path = "pre_stretch/forces.rs"]
mod forces;
#[path = "pre_stretch/motion.rs"]
mod motion;
#[path = "pre_stretch/refusals.rs"]
mod refusals;
#[path = "pre_stretch/support.rs"]
mod support;
