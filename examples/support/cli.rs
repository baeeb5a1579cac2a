//! Arguments and output that all examples have in common.

use clap::Parser;
use serde::Serialize;

/// Arguments of an example; add more with `#[command(flatten)]`.
#[derive(Clone, Copy, Debug, Default, Parser)]
pub struct Options {
    /// Print the headline numbers as one JSON value on the last line.
    #[arg(long)]
    pub json: bool,
    /// Stop after this many steps.
    #[arg(long, value_name = "N")]
    pub steps: Option<usize>,
}

impl Options {
    /// The number of steps to take: what `--steps` says, but at most `full`.
    pub fn n_steps(&self, full: usize) -> usize {
        self.steps.map_or(full, |steps| steps.min(full))
    }
}

/// Prints a value as one line of JSON.
///
/// # Panics
/// If the value cannot be written as JSON, as a map with keys that are not strings.
pub fn print_json(value: &impl Serialize) {
    let line = serde_json::to_string(value).expect("headline numbers are plain numbers");
    println!("{line}");
}
