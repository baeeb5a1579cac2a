//! The lowest natural modes: a dense solver, closed forms, converged answers, multiplicities, and what must not matter.

#[path = "modes/beams.rs"]
mod beams;
#[path = "modes/dense.rs"]
mod dense;
#[path = "modes/exact.rs"]
mod exact;
#[path = "modes/plates.rs"]
mod plates;
#[path = "modes/prestress.rs"]
mod prestress;
#[path = "modes/rigid.rs"]
mod rigid;
#[path = "modes/support.rs"]
mod support;
