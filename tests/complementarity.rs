//! The complementarity solver against closed forms, enumeration, symmetry and its own residual.

#[path = "complementarity/condensed.rs"]
mod condensed;
#[path = "complementarity/contradiction.rs"]
mod contradiction;
#[path = "complementarity/enumeration.rs"]
mod enumeration;
#[path = "complementarity/hand_cases.rs"]
mod hand_cases;
#[path = "complementarity/invariances.rs"]
mod invariances;
#[path = "complementarity/redundancy.rs"]
mod redundancy;
#[path = "complementarity/robustness.rs"]
mod robustness;
#[path = "complementarity/support.rs"]
mod support;
#[path = "complementarity/work.rs"]
mod work;
