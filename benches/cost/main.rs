//! What a step costs beside rapier's own soft bodies: the same meshes, the same machine, the same run.
//!
//! ```text
//! cargo bench                        all scenes, about a minute
//! cargo bench -- 20x2 "in contact"   scenes whose name holds one of the words
//! cargo bench -- --test              a few steps of every scene, to see that they run
//! ```
//!
//! Every side builds its world, and steps it into the state to be timed, before the clock runs. Then all sides of a
//! scene take turns in short bursts: what disturbs the machine disturbs them alike, and a ratio is the median over the
//! turns of the ratio within a turn. Time spent waiting for a processor does not count, where the system tells.
//!
//! With `--features timing` the share of the flexible stage comes from the step report; without, the steps rapier took
//! are taken again in a world of its own and subtracted.

mod bars;
mod clock;
mod flexible;
mod measure;
mod scene;
mod soft;
mod soft_law;
mod table;

use clap::Parser;
use flexible::FlexSide;
use foil2d::fe::mesh::CellKind;
use measure::{Outcome, Plan, Side, compare};
use scene::Scene;
use soft::SoftSide;

#[derive(Parser)]
struct Arguments {
    /// Run only scenes whose name holds one of these words.
    words: Vec<String>,
    /// Take a few steps of every scene and judge nothing.
    #[arg(long)]
    test: bool,
    /// Passed by `cargo bench`, and missing under `cargo test`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> Outcome<()> {
    let arguments = Arguments::parse();
    let plan = if arguments.bench && !arguments.test {
        Plan::Measure
    } else {
        Plan::Glance
    };
    let wanted = |scene: &Scene| {
        let mut words = arguments.words.iter();
        arguments.words.is_empty() || words.any(|word| scene.name().contains(word))
    };
    let mut outcomes = Vec::new();
    for scene in scene::all().into_iter().filter(wanted) {
        eprintln!("running {}", scene.name());
        let sides = sides(&scene)?;
        let results = compare(&scene, sides, plan)?;
        if plan == Plan::Measure {
            table::print(&scene, &results);
        }
        outcomes.push((scene, results));
    }
    if plan == Plan::Measure {
        bars::print(&outcomes);
        table::print_reading();
    }
    Ok(())
}

fn sides(scene: &Scene) -> Outcome<Vec<Box<dyn Side>>> {
    let mut sides: Vec<Box<dyn Side>> = Vec::new();
    let first = if scene.is_large() {
        CellKind::Tri6
    } else {
        CellKind::Tri3
    };
    for kind in [first, CellKind::Quad4] {
        sides.push(Box::new(FlexSide::new(scene, kind)?));
    }
    for model in soft::models(scene) {
        sides.push(Box::new(SoftSide::new(scene, model)?));
    }
    Ok(sides)
}
