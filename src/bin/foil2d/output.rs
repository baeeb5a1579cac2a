//! What a run writes.

use super::build::{Built, nearest};
use super::problem::Problem;
use super::scene::Quantity;
use super::source::Source;
use foil2d::io::{History, Replay, Scene, VtuSeries, write_still};
use foil2d::prelude::*;
use std::path::PathBuf;

/// One column, or two, of the table of histories.
struct Probe {
    body: FlexBodyHandle,
    what: Quantity,
    node: Option<usize>,
}

/// Files in the making.
pub struct Outputs {
    folder: PathBuf,
    every: usize,
    vtu: Option<VtuSeries>,
    replay: Option<Replay>,
    has_still: bool,
    history: History,
    probes: Vec<Probe>,
}

impl Outputs {
    /// Those that a scene asks for, in `folder` if one is given.
    pub fn new(source: &Source, built: &Built, folder: Option<PathBuf>) -> Result<Self, Problem> {
        let spec = &source.scene.output;
        let folder = folder.unwrap_or_else(|| source.beside(&spec.folder));
        let mut names: Vec<String> = ["kinetic_J", "elastic_J", "potential_J", "dissipated_J"]
            .map(String::from)
            .to_vec();
        let mut probes = Vec::new();
        for probe in &spec.history {
            let body = built.flexible_named(source, &probe.body)?;
            let name = probe.body.get();
            names.extend(
                columns(probe.what)
                    .iter()
                    .map(|column| format!("{name}_{column}")),
            );
            let mesh = built.flex_bodies[body].mesh();
            probes.push(Probe {
                body,
                what: probe.what,
                node: probe.near.map(|point| nearest(mesh, point)),
            });
        }
        Ok(Self {
            every: spec.every,
            vtu: spec.vtu.then(|| VtuSeries::new(folder.join("scene"))),
            replay: spec.replay.then(|| Replay::new("foil2d")),
            has_still: spec.still,
            history: History::new(names),
            probes,
            folder,
        })
    }

    /// Takes in a step.
    pub fn record(&mut self, step: usize, time: f64, built: &Built) -> Result<(), Problem> {
        let report = built.flex.report();
        let energy = report.energy();
        let mut row = vec![
            energy.kinetic,
            energy.elastic,
            energy.potential,
            energy.dissipated,
        ];
        for probe in &self.probes {
            probe.read(&built.flex_bodies[probe.body], &mut row)?;
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

    /// Writes what is complete at the end; returns the files.
    pub fn finish(self, built: &Built) -> Result<Vec<PathBuf>, Problem> {
        let mut files = vec![self.folder.join("history.csv")];
        self.history.write(&files[0]).map_err(Problem::plain)?;
        if let Some(vtu) = &self.vtu {
            files.push(vtu.finish().map_err(Problem::plain)?);
        }
        if let Some(replay) = &self.replay {
            files.push(self.folder.join("replay.html"));
            replay
                .write(self.folder.join("replay.html"))
                .map_err(Problem::plain)?;
        }
        if self.has_still {
            let path = self.folder.join("still.svg");
            let scene = Scene::of(&built.world, &built.flex_bodies, built.flex.report());
            write_still(&path, &scene).map_err(Problem::plain)?;
            files.push(path);
        }
        Ok(files)
    }
}

impl Probe {
    fn read(&self, body: &FlexBody, row: &mut Vec<f64>) -> Result<(), Problem> {
        match (self.what, self.node) {
            (Quantity::Position, Some(node)) => row.extend(body.position(node)),
            (Quantity::Position, None) => row.extend(body.centre_of_mass()),
            (Quantity::Velocity, Some(node)) => row.extend(body.velocity(node)),
            (Quantity::Velocity, None) => row.extend(body.linvel()),
            (Quantity::ContactForce, Some(node)) => row.extend(body.contact_force(node)),
            (Quantity::ContactForce, None) => row.extend(body.total_contact_force()),
            (Quantity::Reaction, Some(node)) => row.extend(body.reaction(node)),
            (Quantity::Reaction, None) => row.extend(body.total_reaction()),
            (Quantity::VonMises, node) => {
                let stresses = body.von_mises().map_err(Problem::plain)?;
                let largest = || stresses.iter().copied().fold(0.0, f64::max);
                row.push(node.map_or_else(largest, |node| stresses[node]));
            }
        }
        Ok(())
    }
}

fn columns(what: Quantity) -> &'static [&'static str] {
    match what {
        Quantity::Position => &["x_m", "y_m"],
        Quantity::Velocity => &["vx_m_per_s", "vy_m_per_s"],
        Quantity::ContactForce => &["contact_x_N", "contact_y_N"],
        Quantity::Reaction => &["reaction_x_N", "reaction_y_N"],
        Quantity::VonMises => &["von_mises_Pa"],
    }
}
