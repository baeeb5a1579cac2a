//! What a run writes.

use super::build::Built;
use super::files::{check_writable, note};
use super::probe::{Probe, probes};
use super::problem::Problem;
use super::source::Source;
use foil2d::io::{History, OutputError, Replay, Scene, VtuSeries, write_still, write_still_png};
use std::path::PathBuf;

/// Width of the picture as PNG (px).
const PNG_WIDTH: u32 = 1920;

/// Frames of a replay of a short run, if there are as many steps.
const FEWEST_FRAMES: f64 = 300.0;

/// Files in the making.
pub struct Outputs {
    folder: PathBuf,
    every: usize,
    vtu: Option<VtuSeries>,
    replay: Option<Replay>,
    has_still: bool,
    has_png: bool,
    history: History,
    probes: Vec<Probe>,
    /// Of all bodies, after the first step and after the last (J).
    energy: [f64; 2],
}

/// A replay with a frame of every step that is recorded, or if the scene does not say which these are, some hundreds at the least.
fn replay_of(source: &Source) -> Replay {
    let rate = match source.scene.output.every.byte() {
        Some(_) => f64::INFINITY,
        None => f64::max(30.0, FEWEST_FRAMES / source.scene.world.duration.get()),
    };
    Replay::new(&source.title).with_rate(rate)
}

/// Kinetic, elastic and potential energy of all bodies, asleep or awake, in an island or not (J).
fn energies(built: &Built) -> [f64; 3] {
    let gravity = built.world.gravity;
    let gravity = [f64::from(gravity.x), f64::from(gravity.y)];
    let mut sum = [0.0; 3];
    for (_, body) in built.flex_bodies.iter() {
        let (own, [x, y]) = (body.energy(), body.centre_of_mass());
        let lifted = body.gravity_scale() * body.mass() * (gravity[0] * x + gravity[1] * y);
        for (sum, value) in sum.iter_mut().zip([own.kinetic, own.elastic, -lifted]) {
            *sum += value;
        }
    }
    let dynamic = built.world.bodies.iter().map(|(_, body)| body);
    for body in dynamic.filter(|body| body.is_dynamic()) {
        let centre = body.center_of_mass();
        let [x, y] = [f64::from(centre.x), f64::from(centre.y)];
        let weight = f64::from(body.gravity_scale()) * f64::from(body.mass());
        sum[0] += f64::from(body.kinetic_energy());
        sum[2] -= weight * (gravity[0] * x + gravity[1] * y);
    }
    sum
}

impl Outputs {
    /// Those that a scene asks for, in `folder` if one is given.
    ///
    /// # Errors
    /// If a history is of nothing, or a file cannot be written.
    pub fn new(source: &Source, built: &Built, folder: Option<PathBuf>) -> Result<Self, Problem> {
        let spec = &source.scene.output;
        let is_given = folder.is_some();
        let folder = folder.unwrap_or_else(|| source.beside(spec.folder.get()));
        let energies = ["kinetic_J", "elastic_J", "potential_J", "dissipated_J"];
        let mut columns = energies.map(String::from).to_vec();
        let probes = probes(source, built, &mut columns)?;
        let outputs = Self {
            every: *spec.every.get(),
            vtu: spec.vtu.then(|| VtuSeries::new(folder.join("scene"))),
            replay: spec.replay.then(|| replay_of(source)),
            has_still: spec.still,
            has_png: spec.png,
            history: History::new(columns),
            probes,
            energy: [0.0; 2],
            folder,
        };
        check_writable(&outputs.files()).map_err(|problem| match is_given {
            true => problem,
            false => source.problem(&spec.folder, problem),
        })?;
        Ok(outputs)
    }

    /// What is written at the end.
    fn files(&self) -> Vec<PathBuf> {
        let all = [
            (true, "history.csv"),
            (self.vtu.is_some(), "scene.pvd"),
            (self.replay.is_some(), "replay.html"),
            (self.has_still, "still.svg"),
            (self.has_png, "still.png"),
        ];
        let wanted = all.into_iter().filter(|(is_wanted, _)| *is_wanted);
        wanted.map(|(_, name)| self.folder.join(name)).collect()
    }

    /// Takes in a step.
    pub fn record(&mut self, step: usize, time: f64, built: &Built) -> Result<(), Problem> {
        let report = built.flex.report();
        let [kinetic, elastic, potential] = energies(built);
        self.energy[1] = kinetic + elastic + potential;
        if step == 0 {
            self.energy[0] = self.energy[1];
        }
        let mut row = vec![kinetic, elastic, potential, report.energy().dissipated];
        for probe in &mut self.probes {
            probe.read(built, &mut row)?;
        }
        self.history.record(time, row).map_err(Problem::plain)?;
        if !step.is_multiple_of(self.every) {
            return Ok(());
        }
        let scene = Scene::of(&built.world, &built.flex_bodies, report);
        if let Some(vtu) = &mut self.vtu {
            vtu.record(time, &scene).map_err(Problem::plain)?;
        }
        if let Some(replay) = &mut self.replay {
            replay.record(time, &scene).map_err(Problem::plain)?;
        }
        Ok(())
    }

    /// Energy of all bodies after the first step and after the last (J).
    pub fn energy(&self) -> [f64; 2] {
        self.energy
    }

    /// Writes what is complete at the end; returns the files.
    pub fn finish(self, built: &Built) -> Result<Vec<PathBuf>, Problem> {
        let mut files = self.files();
        self.history
            .write(self.folder.join("history.csv"))
            .map_err(Problem::plain)?;
        if let Some(vtu) = &self.vtu {
            vtu.finish().map_err(Problem::plain)?;
        }
        if let Some(replay) = &self.replay {
            replay
                .write(self.folder.join("replay.html"))
                .map_err(Problem::plain)?;
        }
        let scene = Scene::of(&built.world, &built.flex_bodies, built.flex.report());
        if self.has_still {
            write_still(self.folder.join("still.svg"), &scene).map_err(Problem::plain)?;
        }
        if self.has_png {
            let path = self.folder.join("still.png");
            match write_still_png(path, &scene, PNG_WIDTH) {
                // The page and the SVG show it all the same.
                Err(error @ OutputError::Unpaintable { .. }) => {
                    note(&format!("still.png is left out: {error}"));
                    files.retain(|file| !file.ends_with("still.png"));
                }
                written => written.map_err(Problem::plain)?,
            }
        }
        Ok(files)
    }
}
