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
    let reference = seen[1].times(n_steps);
    for side in seen {
        let times = side.times(n_steps);
        let ratio = |i: usize| Some(times[i]? / reference[i]?);
        let worst_to_median = times[1].zip(times[0]).map(|(worst, median)| worst / median);
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
            digits(worst_to_median),
            digits(ratio(0)),
            digits(ratio(1)),
            digits(ratio(2)),
        );
    }
    let counts = [
        ("passes", seen[0].count(|told| told.n_newton as u64)),
        (
            "factorizations (pivots) of contact problems",
            seen[0].count(|told| told.n_pivots as u64),
        ),
        (
            "factorizations of bodies",
            seen[0].count(|told| told.n_factorizations),
        ),
    ];
    for (what, [mean, most, last]) in counts {
        println!("  {what} a step: {mean:.1}, at most {most:.0}, in the last second {last:.1}");
    }
    let [cut, unfinished] = seen[0].n_unsolved();
    println!(
        "  of {} steps {cut} cut, {unfinished} unfinished",
        seen[0].n_steps()
    );
}

/// Prints the exponent with which the resting step grows from 100 boxes to 1,000, and from each size to the next.
pub fn print_growth(outcomes: &[(Scene, Vec<Seen>)], n_steps: usize) {
    let piles: Vec<_> = outcomes
        .iter()
        .filter(|(scene, _)| scene.kind == Kind::Boxes)
        .collect();
    let exponents = |from: &(Scene, Vec<Seen>), to: &(Scene, Vec<Seen>)| {
        let by = (to.0.size as f64 / from.0.size as f64).ln();
        let growth = from.1.iter().zip(&to.1).map(|(from, to)| {
            let ends = [from, to].map(|side| side.times(n_steps)[2]);
            let exponent = ends[0].zip(ends[1]).map(|(from, to)| (to / from).ln() / by);
            format!("{} {}", from.label, digits(exponent))
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

/// Three digits, or a dash for what was not reached.
fn digits(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(value) if value < 10.0 => format!("{value:.2}"),
        Some(value) if value < 100.0 => format!("{value:.1}"),
        Some(value) => format!("{value:.0}"),
    }
}
