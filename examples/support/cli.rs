//! Arguments and output that all examples have in common.

use clap::Parser;
use foil2d::io::{OutputError, Replay, Scene};
use foil2d::prelude::{FlexBodySet, FlexPipeline};
use foil2d::rapier::prelude::PhysicsWorld;
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of an example; add more with `#[command(flatten)]`.
#[derive(Clone, Debug, Default, Parser)]
pub struct Options {
    /// Print the headline numbers as one JSON value on the last line.
    #[arg(long)]
    pub json: bool,
    /// Stop after this many steps.
    #[arg(long, value_name = "N")]
    pub steps: Option<usize>,
    /// Write a page that plays the run to this file, such as out/run.html.
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

impl Options {
    /// The number of steps to take: what `--steps` says, but at most `full`.
    pub fn n_steps(&self, full: usize) -> usize {
        self.steps.map_or(full, |steps| steps.min(full))
    }

    /// Says that `--replay` is not for this example.
    #[allow(dead_code, reason = "most examples have a replay")]
    pub fn refuse_replay(&self) -> Result<(), &'static str> {
        match self.replay {
            Some(_) => Err("this example writes no replay: try truck, rope or gripper"),
            None => Ok(()),
        }
    }

    /// What records a run for the page that `--replay` asks for, if it does.
    #[allow(dead_code, reason = "not every example has a world to show")]
    pub fn recorder(&self, title: &str) -> Recorder {
        Recorder(self.replay.clone().map(|path| (path, Replay::new(title))))
    }

    /// The same of one of several runs, whose name is put before the file's extension.
    #[allow(dead_code, reason = "most examples have one run")]
    pub fn recorder_of(&self, run: &str, title: &str) -> Recorder {
        let path = self.replay.clone().map(|path| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            path.with_file_name(format!("{stem}_{run}.html"))
        });
        Recorder(path.map(|path| (path, Replay::new(title))))
    }
}

/// Records a run if it is asked to.
#[allow(dead_code, reason = "not every example has a world to show")]
pub struct Recorder(Option<(PathBuf, Replay)>);

#[allow(dead_code, reason = "not every example has a world to show")]
impl Recorder {
    /// Records a step that ends at a time (s).
    pub fn record(
        &mut self,
        time: f64,
        world: &PhysicsWorld,
        flex_bodies: &FlexBodySet,
        pipeline: &FlexPipeline,
    ) -> Result<(), OutputError> {
        let Some((_, replay)) = &mut self.0 else {
            return Ok(());
        };
        replay.record(time, &Scene::of(world, flex_bodies, pipeline.report()))
    }

    /// Writes the page, and says where.
    pub fn write(self) -> Result<(), OutputError> {
        let Some((path, replay)) = self.0 else {
            return Ok(());
        };
        replay.write(&path)?;
        println!("replay: {}", path.display());
        Ok(())
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
