//! What piles cost: rigid boxes on a flexible plank beside rapier alone, and soft blocks beside rapier's own soft bodies
//! and beside what `FlexBodyBuilder::from_soft_body` makes of these.
//!
//! ```text
//! cargo bench --bench piles                                     all scenes, some minutes
//! cargo bench --bench piles -- boxes --sizes 10,20,40           scenes whose name holds one of the words, of these sizes
//! cargo bench --bench piles -- soft --sizes 5 --seconds 2       two seconds of the world's time
//! cargo bench --bench piles -- --limit 10                       at most ten seconds of steps for a side of a scene
//! cargo bench --bench piles -- --test                           a few steps of the small scenes, to see that they run
//! ```
//!
//! All sides of a scene take their steps in turns, one by one, so that what disturbs the machine disturbs them alike. Time spent
//! waiting for a processor does not count, where the system tells. A side that has spent its limit says where it stopped.

#[path = "../cost/clock.rs"]
mod clock;
mod scene;
mod side;
#[path = "../cost/soft_law.rs"]
mod soft_law;
mod table;

use clap::Parser;
use clock::Clock;
use scene::Scene;
use side::{Outcome, Seen, Side};

#[derive(Parser)]
struct Arguments {
    /// Run only scenes whose name holds one of these words.
    words: Vec<String>,
    /// Boxes of a pile, or blocks along a side of a pile of soft ones; all sizes if none are named.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<usize>,
    /// Time of the world (s).
    #[arg(long, default_value_t = 5.0)]
    seconds: f64,
    /// Time that the steps of one side may take (s).
    #[arg(long, default_value_t = 60.0)]
    limit: f64,
    /// Take a few steps of the small scenes and judge nothing.
    #[arg(long)]
    test: bool,
    /// Passed by `cargo bench`, and missing under `cargo test`.
    #[arg(long, hide = true)]
    bench: bool,
}

impl Arguments {
    fn wants(&self, scene: &Scene) -> bool {
        let has_word = self.words.iter().any(|word| scene.name().contains(word));
        (self.words.is_empty() || has_word)
            && (self.sizes.is_empty() || self.sizes.contains(&scene.size))
    }
}

fn main() -> Outcome<()> {
    let arguments = Arguments::parse();
    let is_measured = arguments.bench && !arguments.test;
    let n_steps = if is_measured {
        (arguments.seconds / scene::DT).round() as usize
    } else {
        2
    };
    let wanted = |scene: &Scene| arguments.wants(scene) && (is_measured || scene.size <= 10);
    let mut outcomes = Vec::new();
    for scene in scene::all().into_iter().filter(wanted) {
        eprintln!("running {}", scene.name());
        let seen = run(&scene, n_steps, arguments.limit)?;
        if is_measured {
            table::print(&scene, n_steps, &seen);
        }
        outcomes.push((scene, seen));
    }
    if is_measured {
        table::print_growth(&outcomes, n_steps);
    }
    Ok(())
}

/// Steps all sides of a scene in turns.
fn run(scene: &Scene, n_steps: usize, limit: f64) -> Outcome<Vec<Seen>> {
    let clock = Clock::exact();
    let mut sides: Vec<Box<dyn Side>> = scene.sides()?;
    let mut seen: Vec<Seen> = sides.iter().map(|side| Seen::of(side.label())).collect();
    for _ in 0..n_steps {
        for (side, seen) in sides.iter_mut().zip(&mut seen) {
            if seen.spent() > 1e6 * limit {
                continue;
            }
            let (time, outcome) = clock.time(|| side.step());
            seen.take(time, outcome?);
        }
    }
    Ok(seen)
}
