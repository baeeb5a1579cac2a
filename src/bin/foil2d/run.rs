//! `foil2d run`.

use super::build::{Built, build};
use super::doctor::findings;
use super::output::Outputs;
use super::problem::Problem;
use super::source::Source;
use clap::Args;
use foil2d::doctor::Course;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The scene, in TOML.
    scene: PathBuf,
    /// The folder for files, instead of the scene's own.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Steps to take, instead of the scene's duration.
    #[arg(long)]
    steps: Option<usize>,
    /// Shows no progress and no findings.
    #[arg(long)]
    quiet: bool,
}

/// Runs a scene.
pub fn run(options: &Options) -> Result<(), Problem> {
    let source = Source::read(&options.scene)?;
    let mut built = build(&source)?;
    if !options.quiet {
        for finding in findings(&built) {
            eprintln!("note: {finding}");
        }
    }
    let world = source.scene.world.get();
    let by_duration = (world.duration / world.dt).round().max(0.0) as usize;
    let n_steps = options.steps.unwrap_or(by_duration);
    let outputs = Outputs::new(&source, &built, options.out.clone())?;
    let told = take_steps(&mut built, outputs, n_steps, options.quiet)?;
    print!("{told}");
    Ok(())
}

/// Steps a world to its end; what was written, and what the run was like.
pub fn take_steps(
    built: &mut Built,
    mut outputs: Outputs,
    n_steps: usize,
    is_quiet: bool,
) -> Result<String, Problem> {
    let dt = f64::from(built.world.integration_parameters.dt);
    let bar = match is_quiet {
        true => ProgressBar::hidden(),
        false => ProgressBar::new(n_steps as u64),
    };
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left");
    bar.set_style(style.map_err(Problem::plain)?);
    let mut course = Course::default();
    for step in 0..n_steps {
        let report = built
            .flex
            .step(&mut built.world, &mut built.flex_bodies)
            .map_err(|error| Problem::plain(format!("step {}: {error}", step + 1)))?;
        course.watch(report, &built.flex_bodies);
        outputs.record(step, (step + 1) as f64 * dt, built)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut told = course.report().to_string();
    for (name, handle) in &built.flexible {
        told = told.replace(&format!("{handle:?}"), &format!("`{name}`"));
    }
    for file in outputs.finish(built)? {
        told.push_str(&format!("wrote {}\n", file.display()));
    }
    Ok(told)
}
