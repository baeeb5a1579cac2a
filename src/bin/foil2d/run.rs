//! `foil2d run`.

use super::build::{Built, build, n_steps};
use super::doctor::findings;
use super::files::{note, print};
use super::output::Outputs;
use super::problem::Problem;
use super::source::Source;
use super::words::{of_course, of_step};
use clap::Args;
use foil2d::doctor::{Course, CourseReport};
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
    // What cannot be written is told before anything is computed.
    let outputs = Outputs::new(&source, &built, options.out.clone())?;
    let n_steps = options.steps.unwrap_or_else(|| n_steps(&source.scene));
    if !options.quiet {
        for finding in findings(&built, n_steps) {
            note(&finding);
        }
    }
    print(&take_steps(&mut built, outputs, n_steps, options.quiet)?)
}

/// Steps a world to its end; what was written, and what the run was like.
///
/// # Errors
/// If a step is not taken: what was recorded until then is written all the same.
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
    let mut failed = None;
    for step in 0..n_steps {
        match built.flex.step(&mut built.world, &mut built.flex_bodies) {
            Ok(report) => course.watch(report, &built.flex_bodies),
            Err(error) => {
                failed = Some(format!(
                    "step {}: {}",
                    step + 1,
                    of_step(&error, &built.names)
                ));
                break;
            }
        }
        outputs.record(step, (step + 1) as f64 * dt, built)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut told = of_course(course.report(), outputs.energy(), &built.names);
    for file in outputs.finish(built)? {
        told.push_str(&format!("wrote {}\n", file.display()));
    }
    match failed.or_else(|| nothing_finished(course.report())) {
        None => Ok(told),
        Some(what) => Err(Problem::plain(format!("{what}\nuntil then: {told}"))),
    }
}

/// What is wrong with a run of which no step was finished.
fn nothing_finished(course: &CourseReport) -> Option<String> {
    let is_nothing = course.n_steps > 0 && course.n_unfinished == course.n_steps;
    is_nothing.then(|| "no step was finished: look at loads and at what holds the bodies".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_fails_of_which_no_step_was_finished() {
        let of = |n_steps, n_unfinished| CourseReport {
            n_steps,
            n_unfinished,
            ..CourseReport::default()
        };
        assert!(nothing_finished(&of(3, 3)).is_some());
        for course in [of(0, 0), of(3, 0), of(3, 2)] {
            assert_eq!(nothing_finished(&course), None);
        }
    }
}
