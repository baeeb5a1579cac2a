//! `foil2d`: runs scenes described in TOML, and writes what other programs read.

mod at;
mod build;
mod doctor;
mod drop;
mod mesh;
mod output;
mod problem;
mod run;
mod scene;
mod shape;
mod source;

use clap::{Parser, Subcommand};
use problem::Problem;
use std::path::PathBuf;
use std::process::ExitCode;

/// Flexible bodies in a world of rigid ones: from a scene or an outline to pictures, replays and tables.
///
/// `foil2d drop outline.svg` is the shortest way to see something; `foil2d schema` describes scenes.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs a scene and writes what its `[output]` asks for, and a summary.
    Run(run::Options),
    /// Says what is likely a mistake in a scene, without running it.
    Doctor {
        /// The scene, in TOML.
        scene: PathBuf,
    },
    /// Meshes an outline and tells of the mesh; `--out` writes it for ParaView.
    Mesh(mesh::Options),
    /// Drops the shapes of an outline on a floor: a first look at what they do.
    Drop(drop::Options),
    /// Prints the JSON schema of scenes, for editors.
    Schema,
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Run(options) => run::run(&options),
        Command::Doctor { scene } => doctor::examine(&scene),
        Command::Mesh(options) => mesh::mesh(&options),
        Command::Drop(options) => drop::drop_outline(&options),
        Command::Schema => print_schema(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn print_schema() -> Result<(), Problem> {
    let schema = schemars::schema_for!(scene::SceneFile);
    let text = serde_json::to_string_pretty(&schema).map_err(Problem::plain)?;
    println!("{text}");
    Ok(())
}
