//! What the examples share: arguments, output and pictures.

#![allow(dead_code, reason = "every example uses its own part")]

pub mod chart;
pub mod cli;
pub mod doctor;
pub mod film;
