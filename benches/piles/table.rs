//! What is printed of a pile.

use crate::scene::{Kind, Scene};
use crate::side::Seen;

/// Prints one scene: times, ratios to the second side, and what the first side's steps told.
pub fn print(scene: &Scene, n_steps: usize, seen: &[Seen]) {
    println!("\n{}", scene.name());
    println!(
        "  {:<16} {:>11} {:>11} {:>11} {:>8}   times {} (median, worst, at rest)",
        "us a step", "median", "worst", "at rest", "worst/m", seen[1].label
    );
    let reference = seen[1].times();
    for side in seen {
        let times = side.times();
        let ratios: Vec<f64> = times
            .iter()
            .zip(reference)
            .map(|(own, other)| own / other)
            .collect();
        let stopped = if side.n_steps() < n_steps {
            format!("   stopped at step {} of {n_steps}", side.n_steps())
        } else {
            String::new()
        };
        println!(
            "  {:<16} {:>11} {:>11} {:>11} {:>8}   {:>9} {:>9} {:>9}{stopped}",
            side.label,
            digits(times[0]),
            digits(times[1]),
            digits(times[2]),
            digits(times[1] / times[0]),
            digits(ratios[0]),
            digits(ratios[1]),
            digits(ratios[2]),
        );
    }
    let [mean, most, last] = seen[0].factorizations();
    println!(
        "  factorizations a step: {mean:.1}, at most {most:.0}, at rest {last:.1}; {} of {} steps not solved",
        seen[0].n_unsolved(),
        seen[0].n_steps()
    );
}

/// Prints the exponent with which the resting step grows from 100 boxes to 1,000, and from each size to the next.
pub fn print_growth(outcomes: &[(Scene, Vec<Seen>)]) {
    let piles: Vec<_> = outcomes
        .iter()
        .filter(|(scene, _)| scene.kind == Kind::Boxes)
        .collect();
    let exponents = |from: &(Scene, Vec<Seen>), to: &(Scene, Vec<Seen>)| {
        let by = (to.0.size as f64 / from.0.size as f64).ln();
        let growth = from.1.iter().zip(&to.1).map(|(from, to)| {
            let exponent = (to.times()[2] / from.times()[2]).ln() / by;
            // A side that stopped early was not at rest.
            let is_cut =
                to.n_steps() < to_longest(outcomes) || from.n_steps() < to_longest(outcomes);
            let note = if is_cut { " (stopped early)" } else { "" };
            format!("{} {exponent:.2}{note}", from.label)
        });
        growth.collect::<Vec<_>>().join(", ")
    };
    let of_size = |size: usize| piles.iter().find(|(scene, _)| scene.size == size);
    if let (Some(from), Some(to)) = (of_size(100), of_size(1000)) {
        println!(
            "\nExponent of the resting step from 100 to 1000 boxes: {}",
            exponents(from, to)
        );
    }
    for pair in piles.windows(2) {
        println!(
            "  from {} to {}: {}",
            pair[0].0.size,
            pair[1].0.size,
            exponents(pair[0], pair[1])
        );
    }
}

/// Steps of the longest run.
fn to_longest(outcomes: &[(Scene, Vec<Seen>)]) -> usize {
    let all = outcomes.iter().flat_map(|(_, seen)| seen);
    all.map(Seen::n_steps).max().unwrap_or(0)
}

/// Three digits.
fn digits(value: f64) -> String {
    match value {
        _ if value < 10.0 => format!("{value:.2}"),
        _ if value < 100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}
