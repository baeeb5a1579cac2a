//! What the examples share: arguments and output.

#![allow(dead_code, reason = "every example uses its own part")]

pub mod cli;
