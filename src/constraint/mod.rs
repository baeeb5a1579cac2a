//! Constraint rows: which points may not pass which surfaces, how hard they grip, and what holds without touching.
//!
//! [`geometry`] measures distances between convex parts, [`contact`] turns them into rows of `G` (Eq. C.2), [`joint`] adds the
//! rows of joints and attachments. None knows a time step or a solver.

pub mod contact;
pub mod geometry;
pub mod joint;
