//! Constraint rows: which points may not pass which surfaces, and how hard they grip.
//!
//! [`geometry`] measures distances between convex parts, [`contact`] turns them into rows of `G` (Eq. C.2). Neither
//! knows a time step or a solver.

pub mod contact;
pub mod geometry;
