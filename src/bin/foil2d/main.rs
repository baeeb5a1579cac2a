//! `foil2d`: runs scenes described in TOML, and writes what other programs read.

mod at;
mod build;
mod doctor;
mod drop;
mod files;
mod mesh;
mod names;
mod outlines;
mod output;
mod probe;
mod problem;
mod run;
mod scene;
mod shape;
mod source;
mod words;

use clap::{Parser, Subcommand};
use problem::Problem;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Flexible bodies in a world of rigid ones: from a scene or an outline to pictures, replays and tables.
///
/// `foil2d drop outline.svg` is the shortest way to see something. `foil2d example > scene.toml` writes a scene to begin with, `foil2d run scene.toml` runs
/// it; every key of scenes is described by `foil2d schema`. Numbers are in SI units.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs a scene: by default writes a picture (still.svg), a page that plays it in a browser (replay.html) and a table (history.csv) to `out` beside it.
    Run(run::Options),
    /// Says what is likely a mistake in a scene, without running it.
    Doctor {
        /// The scene, in TOML.
        scene: PathBuf,
    },
    /// Meshes an outline and tells of the mesh; `--out` writes it for ParaView.
    Mesh(mesh::Options),
    /// Drops the shapes of a drawing on a floor: a first look at what they do. Writes a picture of the stresses at the end (still.svg), a page that plays the
    /// run in a browser (replay.html), energies (history.csv) and the scene, to be changed and run again (scene.toml).
    Drop(drop::Options),
    /// Prints a scene to begin with, in TOML, with comments.
    Example,
    /// Prints the JSON schema of scenes: every key, what it means, its unit and default; for editors, too.
    Schema,
}

/// A scene to begin with.
const EXAMPLE: &str = include_str!("example.toml");

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Run(options) => run::run(&options),
        Command::Doctor { scene } => doctor::examine(&scene),
        Command::Mesh(options) => mesh::mesh(&options),
        Command::Drop(options) => drop::drop_outline(&options),
        Command::Example => files::print(EXAMPLE),
        Command::Schema => print_schema(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            let _ = writeln!(std::io::stderr(), "error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn print_schema() -> Result<(), Problem> {
    let schema = schemars::schema_for!(scene::SceneFile);
    let text = serde_json::to_string_pretty(&schema).map_err(Problem::plain)?;
    files::print(&(text + "\n"))
}
