//! A truck brakes on a flexible steel bridge while a crane lets go its load.
//!
//! The deck lies on two fixed piers, a rough bearing on the left and a sliding one on the right. At t = 0 its falsework is
//! removed and it swings under its own weight; the truck, two wheels and a body that rubs on them, comes to rest; crates
//! fall on the deck, on each other and on the truck. Everything that touches is solved as one system.
//!
//! Writes a film strip (SVG) and a history (CSV) to `out/`:
//!
//! ```text
//! cargo run --release --example bridge
//! ```
//!
//! The integrator is Beta-2 with `rho_infinity = 0.9`, as one takes for impacts on structures: they excite vibrations
//! far above what the step resolves, which the trapezoidal rule keeps for ever and this member removes within some tens
//! of steps. To the first mode it adds a damping ratio of `(β1 - 1/2) ω dt / 2`, 0.2 % here, beside 5 % of its own.

#[path = "bridge/measure.rs"]
pub mod measure;
#[path = "bridge/picture.rs"]
pub mod picture;
#[path = "bridge/scene.rs"]
pub mod scene;
mod support;

use clap::Parser;
use foil2d::prelude::*;
use indicatif::{ProgressBar, ProgressStyle};
use scene::{Scene, Setup};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use support::{chart, cli, doctor, film};

type Failure = Box<dyn std::error::Error>;

/// Time (s) of the pictures of a full run.
const PICTURES: [f64; 8] = [0.15, 0.6, 1.2, 1.75, 2.55, 4.5, 5.4, 12.0];
/// Length of a full run (s).
const DURATION: f64 = 12.0;
/// Time at the end over which forces are averaged (s).
const AVERAGED: f64 = 1.0;

/// A truck and falling crates on a flexible steel bridge.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    options: cli::Options,
    /// Folder for the film strip and the history.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

/// One line of the history, in SI units.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    pub time: f64,
    pub support: [f64; 2],
    pub weight: f64,
    pub deflection: f64,
    pub max_von_mises: f64,
    pub kinetic: f64,
    pub elastic: f64,
    pub potential: f64,
    pub dissipated: f64,
    pub truck_speed: f64,
    pub largest_speed: f64,
    pub penetration: f64,
}

/// The headline numbers.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Headline {
    /// Vertical force of the piers over the weight of everything, mean over the last second (-).
    pub weight_ratio: f64,
    /// Standard deviation of the same ratio (-).
    pub weight_ratio_deviation: f64,
    /// Largest overlap of any two bodies in any step, by the report and by geometry (m).
    pub max_penetration_m: f64,
    /// Largest speed of any body or node at the end (m/s).
    pub end_speed_m_per_s: f64,
    /// Whether every number stayed finite.
    pub finite: bool,
    /// Steps taken.
    pub n_steps: usize,
    /// Time simulated (s).
    pub time_s: f64,
    /// Weight of deck, truck and crates at the end (N).
    pub weight_n: f64,
    /// Deflection of the deck's axis at mid-span at the end (m).
    pub midspan_deflection_m: f64,
    /// The same by beam theory (m).
    pub midspan_deflection_beam_m: f64,
    /// Bending stress at the lower edge at mid-span at the end (Pa).
    pub midspan_stress_pa: f64,
    /// The same by beam theory (Pa).
    pub midspan_stress_beam_pa: f64,
    /// Largest deflection on the way (m).
    pub max_deflection_m: f64,
    /// Largest von Mises stress anywhere on the way (MPa).
    pub max_von_mises_mpa: f64,
    /// Largest von Mises stress at the end (MPa).
    pub end_von_mises_mpa: f64,
    /// Place where the truck's body stopped (m from mid-span).
    pub truck_position_m: f64,
    /// Most Newton iterations in a step.
    pub max_newton: usize,
    /// Largest residual of the contact problem (-).
    pub max_solver_residual: f64,
}

/// A finished run.
pub struct Run {
    pub headline: Headline,
    pub records: Vec<Record>,
    pub snapshots: Vec<picture::Snapshot>,
    pub dt: f64,
    /// Name, position (m) and speed (m/s) of the rigid bodies at the end.
    pub members: Vec<(&'static str, [f64; 2], f64)>,
}

/// The setup of a full run.
pub fn full() -> Result<Setup, Failure> {
    Ok(Setup {
        divisions: [88, 6],
        dt: 1.0 / 240.0,
        integrator: Beta2::damped(0.9)?,
    })
}

/// Runs the scene for `n_steps`; `progress` is called after every step.
///
/// # Errors
/// If a step fails.
pub fn run(setup: &Setup, n_steps: usize, progress: impl Fn(&Record)) -> Result<Run, Failure> {
    let mut scene = Scene::new(setup)?;
    doctor::require_sound(&scene.world, &scene.flex_bodies, &scene.flex)?;
    let mut records = Vec::with_capacity(n_steps);
    let mut snapshots = Vec::new();
    let (mut max_newton, mut max_solver_residual) = (0, 0.0f64);
    // A shortened run shows the same number of pictures.
    let stretch = n_steps as f64 * setup.dt / DURATION;
    for step in 1..=n_steps {
        scene.step()?;
        let record = record(&scene)?;
        progress(&record);
        records.push(record);
        let report = scene.flex.report();
        max_newton = max_newton.max(report.n_newton());
        max_solver_residual = max_solver_residual.max(report.solver_residual());
        let is_due = |time: f64| (stretch * time / setup.dt).round() as usize == step;
        if PICTURES.into_iter().any(is_due) {
            snapshots.push(picture::Snapshot::take(&scene, &record)?);
        }
    }
    let mut headline = headline(&scene, &records)?;
    headline.max_newton = max_newton;
    headline.max_solver_residual = max_solver_residual;
    let members = scene.members.iter().map(|member| {
        let at = scene.world.bodies[member.handle].translation();
        let at = [f64::from(at.x), f64::from(at.y)];
        (member.name, at, scene.speed(member))
    });
    Ok(Run {
        headline,
        members: members.collect(),
        records,
        snapshots,
        dt: setup.dt,
    })
}

fn record(scene: &Scene) -> Result<Record, Failure> {
    let report = scene.flex.report();
    let stress = scene.deck().von_mises()?;
    let energy = report.energy();
    let truck = &scene.world.bodies[scene.members[0].handle];
    Ok(Record {
        time: scene.time(),
        support: scene.support_forces(),
        weight: scene.weight(),
        deflection: measure::finite_elements(scene)?.deflection,
        max_von_mises: stress.into_iter().fold(0.0, f64::max),
        kinetic: energy.kinetic,
        elastic: energy.elastic,
        potential: energy.potential,
        dissipated: energy.dissipated,
        truck_speed: f64::from(truck.linvel().x),
        largest_speed: scene.largest_speed(),
        penetration: report.gap_violation().max(measure::largest_overlap(scene)),
    })
}

fn headline(scene: &Scene, records: &[Record]) -> Result<Headline, Failure> {
    let last = records.last().ok_or("take at least one step")?;
    let late: Vec<f64> = records
        .iter()
        .filter(|record| record.time > last.time - AVERAGED)
        .map(|record| (record.support[0] + record.support[1]) / record.weight)
        .collect();
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    let variance = late.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / late.len() as f64;
    let largest = |value: fn(&Record) -> f64| records.iter().map(value).fold(0.0, f64::max);
    let (found, beam) = (
        measure::finite_elements(scene)?,
        measure::beam_theory(scene),
    );
    let truck = &scene.world.bodies[scene.members[0].handle];
    Ok(Headline {
        weight_ratio: mean,
        weight_ratio_deviation: variance.sqrt(),
        max_penetration_m: largest(|record| record.penetration),
        end_speed_m_per_s: last.largest_speed,
        finite: scene.is_finite() && records.iter().all(is_finite),
        n_steps: records.len(),
        time_s: last.time,
        weight_n: last.weight,
        midspan_deflection_m: found.deflection,
        midspan_deflection_beam_m: beam.deflection,
        midspan_stress_pa: found.stress,
        midspan_stress_beam_pa: beam.stress,
        max_deflection_m: largest(|record| record.deflection),
        max_von_mises_mpa: largest(|record| record.max_von_mises) / 1e6,
        end_von_mises_mpa: last.max_von_mises / 1e6,
        truck_position_m: f64::from(truck.translation().x),
        max_newton: 0,
        max_solver_residual: 0.0,
    })
}

fn is_finite(record: &Record) -> bool {
    let numbers = [
        record.support[0],
        record.support[1],
        record.deflection,
        record.max_von_mises,
        record.kinetic,
        record.elastic,
        record.potential,
        record.dissipated,
        record.largest_speed,
        record.penetration,
    ];
    numbers.iter().all(|x| x.is_finite())
}

/// The history as comma-separated values, one line per step.
pub fn csv(records: &[Record]) -> String {
    let mut text = String::from(
        "time_s,support_left_n,support_right_n,weight_n,midspan_deflection_m,\
         max_von_mises_pa,kinetic_j,elastic_j,potential_j,dissipated_j,truck_speed_m_per_s,largest_speed_m_per_s,\
         penetration_m\n",
    );
    for r in records {
        let _ = writeln!(
            text,
            "{:.6},{:.3},{:.3},{:.3},{:.9},{:.1},{:.6},{:.6},{:.6},{:.6},{:.9},{:.9},{:.3e}",
            r.time,
            r.support[0],
            r.support[1],
            r.weight,
            r.deflection,
            r.max_von_mises,
            r.kinetic,
            r.elastic,
            r.potential,
            r.dissipated,
            r.truck_speed,
            r.largest_speed,
            r.penetration
        );
    }
    text
}

fn write_files(folder: &Path, run: &Run) -> Result<[PathBuf; 2], Failure> {
    std::fs::create_dir_all(folder)?;
    let film = folder.join("bridge.svg");
    let history = folder.join("bridge.csv");
    std::fs::write(&film, picture::film(run).to_svg())?;
    std::fs::write(&history, csv(&run.records))?;
    Ok([film, history])
}

fn print_summary(run: &Run) {
    let h = &run.headline;
    let percent = |found: f64, expected: f64| 100.0 * (found / expected - 1.0);
    println!("After {:.1} s ({} steps):", h.time_s, h.n_steps);
    println!(
        "  the piers carry {:.4} of the weight of {:.1} kN (deviation {:.1e} over the last second)",
        h.weight_ratio,
        h.weight_n / 1e3,
        h.weight_ratio_deviation
    );
    println!(
        "  the deck sags {:.2} mm at mid-span; beam theory says {:.2} mm ({:+.2} %); at most it was {:.2} mm",
        1e3 * h.midspan_deflection_m,
        1e3 * h.midspan_deflection_beam_m,
        percent(h.midspan_deflection_m, h.midspan_deflection_beam_m),
        1e3 * h.max_deflection_m
    );
    println!(
        "  its lower edge is stressed to {:.2} MPa there; beam theory says {:.2} MPa ({:+.2} %)",
        h.midspan_stress_pa / 1e6,
        h.midspan_stress_beam_pa / 1e6,
        percent(h.midspan_stress_pa, h.midspan_stress_beam_pa)
    );
    println!(
        "  the largest von Mises stress was {:.1} MPa, {:.0} % of yield",
        h.max_von_mises_mpa,
        1e8 * h.max_von_mises_mpa / scene::STEEL[3]
    );
    println!(
        "  nothing overlaps by more than {:.1e} m, and the fastest point moves at {:.1e} m/s",
        h.max_penetration_m, h.end_speed_m_per_s
    );
    for (name, [x, y], speed) in &run.members {
        println!("    {name:<13} at ({x:+7.3}, {y:6.3}) m, {speed:.1e} m/s");
    }
}

#[allow(dead_code, reason = "tests call `run` instead")]
fn main() -> Result<(), Failure> {
    let arguments = Arguments::parse();
    arguments.options.refuse_replay()?;
    let setup = full()?;
    let n_steps = arguments
        .options
        .n_steps((DURATION / setup.dt).round() as usize);
    let bar = ProgressBar::new(n_steps as u64).with_style(ProgressStyle::with_template(
        "{bar:40} {pos}/{len} steps, {eta} left  {msg}",
    )?);
    let finished = run(&setup, n_steps, |record| {
        bar.inc(1);
        if bar.position().is_multiple_of(16) {
            bar.set_message(format!("t = {:.2} s", record.time));
        }
    })?;
    bar.finish_and_clear();
    let files = write_files(&arguments.out, &finished)?;
    print_summary(&finished);
    for file in files {
        println!("  wrote {}", file.display());
    }
    if arguments.options.json {
        cli::print_json(&finished.headline);
    }
    Ok(())
}
