//! `foil2d doctor`.

use super::build::{Built, build, n_steps};
use super::files::print;
use super::problem::Problem;
use super::source::Source;
use super::words::of_finding;
use foil2d::doctor::{self, ExpectedCost};
use std::path::Path;

/// Says what is likely a mistake in a scene.
pub fn examine(path: &Path) -> Result<(), Problem> {
    let source = Source::read(path)?;
    let built = build(&source)?;
    match findings(&built, n_steps(&source.scene)).as_slice() {
        [] => print("nothing is likely a mistake\n"),
        found => print(&(found.join("\n") + "\n")),
    }
}

/// Length of a step within which what people watch is over (s).
const LONG_STEP: f64 = 0.1;

/// What a core does in a second (operations), and a run that is worth a word (s).
const SPEED: f64 = 2e9;
const LONG_RUN: f64 = 3600.0;

/// Steps times dofs below which no run is long: what a step costs takes a while to find out.
const SHORT_RUN: f64 = 1e8;

/// What the doctor finds, with the names that the scene gives its bodies.
pub fn findings(built: &Built, n_steps: usize) -> Vec<String> {
    let found = doctor::examine(&built.world, &built.flex_bodies, &built.flex.parameters);
    let told = found.iter();
    let told = told.map(|finding| of_finding(finding, &built.names));
    told.chain(long_step(built))
        .chain(long_run(built, n_steps))
        .collect()
}

fn long_step(built: &Built) -> Option<String> {
    let dt = f64::from(built.world.integration_parameters.dt);
    (dt > LONG_STEP).then(|| {
        format!("a step of {dt:.3} s is long: falls, impacts and vibrations are over within it; 1/60 s is usual for `dt`")
    })
}

fn long_run(built: &Built, n_steps: usize) -> Option<String> {
    let bodies = built.flex_bodies.iter();
    let n_dofs: usize = bodies.map(|(_, body)| 2 * body.n_nodes()).sum();
    if n_steps as f64 * (n_dofs as f64) < SHORT_RUN {
        return None;
    }
    let step = ExpectedCost::of(&built.flex_bodies).step(0.25) / SPEED;
    let run = step * n_steps as f64;
    (run > LONG_RUN).then(|| {
        format!(
            "{n_steps} steps of about {step:.1e} s each, where a quarter of all surfaces touches, take some {:.1e} hours: shorten `duration`, lengthen `dt`, or take longer edges of cells",
            run / 3600.0
        )
    })
}
