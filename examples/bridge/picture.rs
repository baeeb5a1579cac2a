//! Pictures of the scene: the deck in the colours of its stress, what stands on it, and the contact forces.

use super::chart::{Chart, Curve};
use super::film::{FORCE, Film, Legend, Panel, View, round_up};
use super::measure::{Outline, Placed};
use super::scene::{DAMPING_RATIO, DECK, STEEL, Scene};
use super::{Record, Run};
use foil2d::pipeline::Participant;

/// Displacements of the deck are drawn this many times larger.
const EXAGGERATION: f64 = 20.0;
/// Length of the arrow of a force (m/N), and of the longest arrow (m).
const ARROW: f64 = 2.0 / 2e5;
const LONGEST_ARROW: f64 = 4.0;

const PIER: &str = "fill=\"#9aa3ab\" stroke=\"#59636b\" stroke-width=\"0.8\"";
const TRUCK: &str =
    "fill=\"#c9d6e3\" fill-opacity=\"0.85\" stroke=\"#3d5266\" stroke-width=\"0.8\"";
const WHEEL: &str =
    "fill=\"#5b636b\" fill-opacity=\"0.85\" stroke=\"#22272b\" stroke-width=\"0.8\"";
const CRATE: &str = "fill=\"#dcc39c\" fill-opacity=\"0.9\" stroke=\"#6b5230\" stroke-width=\"0.9\"";
const MESH: &str = "stroke=\"#000\" stroke-opacity=\"0.28\" stroke-width=\"0.3\"";
const EDGE: &str = "fill=\"none\" stroke=\"#111\" stroke-width=\"0.9\"";

/// What a panel shows, copied out of the scene.
#[derive(Clone, Debug)]
pub struct Snapshot {
    time: f64,
    deflection: f64,
    /// Nodes of the deck: displaced position drawn (m), von Mises stress (Pa).
    nodes: Vec<[f64; 2]>,
    stress: Vec<f64>,
    cells: Vec<Vec<usize>>,
    boundary: Vec<usize>,
    piers: Vec<Vec<[f64; 2]>>,
    boxes: Vec<(Vec<[f64; 2]>, &'static str)>,
    /// Centre, radius, angle.
    discs: Vec<([f64; 2], f64, f64)>,
    /// Tip and force.
    forces: Vec<([f64; 2], [f64; 2])>,
}

/// How the exaggerated deck carries along what stands on it.
struct Sag {
    /// Axis of the deck: place and displacement (m), by place.
    axis: Vec<[f64; 3]>,
}

impl Sag {
    fn new(scene: &Scene) -> Self {
        let deck = scene.deck();
        let rest = deck.model().rest_positions();
        let mut axis: Vec<[f64; 3]> = (0..deck.n_nodes())
            .filter(|&node| (rest[2 * node + 1] - 0.5 * DECK[1]).abs() < 1e-9)
            .map(|node| {
                let [ux, uy] = deck.displacement(node);
                [rest[2 * node], ux, uy]
            })
            .collect();
        axis.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { axis }
    }

    /// Displacement (m) of the axis at a place, constant beyond the ends.
    fn at(&self, x: f64) -> [f64; 2] {
        let after = self.axis.partition_point(|point| point[0] < x);
        if after == 0 || after == self.axis.len() {
            let [_, ux, uy] = self.axis[after.min(self.axis.len() - 1)];
            return [ux, uy];
        }
        let [one, two] = [self.axis[after - 1], self.axis[after]];
        let part = (x - one[0]) / (two[0] - one[0]);
        [1, 2].map(|i| one[i] + part * (two[i] - one[i]))
    }

    /// Adds the exaggeration to a body that stands on the deck at `x`: it goes down and turns with the deck.
    fn carry(&self, x: f64, reach: f64, [px, py]: [f64; 2]) -> [f64; 2] {
        let more = EXAGGERATION - 1.0;
        let [ux, uy] = self.at(x);
        let slope = (self.at(x + reach)[1] - self.at(x - reach)[1]) / (2.0 * reach);
        let angle = more * slope;
        let (sin, cos) = angle.sin_cos();
        let (dx, dy) = (px - x, py - 0.5 * DECK[1] - uy);
        [
            x + more * ux + cos * dx - sin * dy,
            0.5 * DECK[1] + (more + 1.0) * uy + sin * dx + cos * dy,
        ]
    }
}

impl Snapshot {
    /// Copies what is to be drawn.
    pub fn take(scene: &Scene, record: &Record) -> Result<Self, Box<dyn std::error::Error>> {
        let deck = scene.deck();
        let rest = deck.model().rest_positions();
        let nodes = (0..deck.n_nodes()).map(|node| {
            let [ux, uy] = deck.displacement(node);
            [
                rest[2 * node] + EXAGGERATION * ux,
                rest[2 * node + 1] + EXAGGERATION * uy,
            ]
        });
        let mut snapshot = Self {
            time: scene.time(),
            deflection: record.deflection,
            nodes: nodes.collect(),
            stress: deck.von_mises()?,
            cells: deck
                .mesh()
                .cells()
                .map(|cell| cell.nodes.to_vec())
                .collect(),
            boundary: deck.mesh().boundary().nodes().to_vec(),
            piers: Vec::new(),
            boxes: Vec::new(),
            discs: Vec::new(),
            forces: Vec::new(),
        };
        let sag = Sag::new(scene);
        for &pier in &scene.piers {
            let placed = Placed::new(&scene.world.colliders[pier]);
            snapshot.piers.push(placed.corners());
        }
        for member in &scene.members {
            let style = if member.name == "truck" { TRUCK } else { CRATE };
            let body = &scene.world.bodies[member.handle];
            let x = f64::from(body.translation().x);
            let reach = if member.name == "truck" { 1.9 } else { 0.5 };
            for &collider in body.colliders() {
                let placed = Placed::new(&scene.world.colliders[collider]);
                match placed.shape {
                    Outline::Disc(radius) => {
                        let centre = sag.carry(x, reach, placed.centre);
                        snapshot.discs.push((centre, radius, placed.angle));
                    }
                    Outline::Box(_) => {
                        let corners = placed.corners().into_iter();
                        let corners = corners.map(|corner| sag.carry(x, reach, corner));
                        snapshot.boxes.push((corners.collect(), style));
                    }
                }
            }
        }
        snapshot.take_forces(scene, &sag);
        Ok(snapshot)
    }

    /// Forces on the deck; between rigid bodies, on the lower one.
    fn take_forces(&mut self, scene: &Scene, sag: &Sag) {
        let deck = Participant::Flex(scene.deck);
        for contact in scene.flex.report().contacts() {
            let [nx, ny] = contact.normal;
            let (normal, tangential) = (contact.normal_force, contact.tangential_force);
            let mut force = [normal * nx - tangential * ny, normal * ny + tangential * nx];
            let on_contactor = if contact.target == deck {
                false
            } else {
                contact.contactor == deck || ny < 0.0
            };
            if !on_contactor {
                force = force.map(|f| -f);
            }
            let tip = sag.carry(contact.position[0], 0.5, contact.position);
            self.forces.push((tip, force));
        }
    }

    fn draw(&self, panel: &mut Panel) {
        for pier in &self.piers {
            panel.polygon(pier.iter().copied(), PIER);
        }
        for cell in &self.cells {
            let mean = cell.iter().map(|&node| self.stress[node]).sum::<f64>() / cell.len() as f64;
            panel.cell(cell.iter().map(|&node| self.nodes[node]), mean / 1e6);
        }
        for cell in &self.cells {
            let style = format!("fill=\"none\" {MESH}");
            panel.polygon(cell.iter().map(|&node| self.nodes[node]), &style);
        }
        panel.polygon(self.boundary.iter().map(|&node| self.nodes[node]), EDGE);
        for (corners, style) in &self.boxes {
            panel.polygon(corners.iter().copied(), style);
        }
        for &([x, y], radius, angle) in &self.discs {
            panel.disc([x, y], radius, WHEEL);
            // Spokes show how it has turned.
            for turn in [0.0, 1.0, 2.0] {
                let (sin, cos) = (angle + turn * std::f64::consts::FRAC_PI_3).sin_cos();
                let [dx, dy] = [0.7 * radius * cos, 0.7 * radius * sin];
                panel.line(
                    [[x - dx, y - dy], [x + dx, y + dy]],
                    "stroke=\"#dde2e6\" stroke-width=\"0.8\"",
                );
            }
        }
        for &(tip, force) in &self.forces {
            panel.force(tip, force, FORCE);
        }
    }
}

/// The film strip of a run, with charts below.
pub fn film(run: &Run) -> Film {
    let largest = run
        .snapshots
        .iter()
        .flat_map(|snapshot| &snapshot.stress)
        .fold(1e3, |largest: f64, &stress| largest.max(stress));
    let legend = Legend {
        colours: "von Mises stress (MPa)".to_owned(),
        full: round_up(largest / 1e6),
        arrow: [ARROW, 2e5],
        longest: LONGEST_ARROW,
    };
    let [young, _, density, _] = STEEL;
    let [length, depth, width] = DECK;
    let notes = vec![
        format!(
            "Steel deck {length} × {depth} × {width} m, E = {:.0} GPa, ρ = {density} kg/m³, ζ₁ = {:.0} %; step {:.3} ms.",
            young / 1e9,
            100.0 * DAMPING_RATIO,
            1e3 * run.dt
        ),
        format!(
            "Displacements of the deck are drawn {EXAGGERATION} times larger; what is above it is moved and turned with it."
        ),
        format!(
            "Arrows: force on the deck, or on the lower of two rigid bodies, mean over the step; cut at {:.0} kN.",
            LONGEST_ARROW / ARROW / 1e3
        ),
    ];
    let view = View {
        x: [-12.6, 12.6],
        y: [-3.4, 5.0],
    };
    let title = "A truck brakes on a steel bridge while a crane lets go its load";
    let mut film = Film::new(title, notes, view, legend);
    for snapshot in &run.snapshots {
        let label = format!(
            "t = {:.2} s, mid-span deflection {:.1} mm",
            snapshot.time,
            1e3 * snapshot.deflection
        );
        snapshot.draw(film.panel(label));
    }
    for chart in charts(run) {
        film.chart(chart);
    }
    film
}

fn charts(run: &Run) -> Vec<Chart> {
    let records = &run.records;
    let at_rest = run.headline.midspan_deflection_beam_m;
    let times: Vec<f64> = records.iter().map(|record| record.time).collect();
    let curve = |name: &str, is_dashed: bool, value: &dyn Fn(&Record) -> f64| Curve {
        name: name.to_owned(),
        values: records.iter().map(value).collect(),
        is_dashed,
    };
    let last = records.last().map_or(1.0, |record| record.weight / 1e3);
    let deepest = records
        .iter()
        .map(|record| record.deflection)
        .fold(1e-4, f64::max);
    let stress = records
        .iter()
        .map(|record| record.max_von_mises)
        .fold(1e3, f64::max);
    vec![
        Chart {
            title: "Support forces (kN)".to_owned(),
            times: times.clone(),
            curves: vec![
                curve("left", false, &|record| record.support[0] / 1e3),
                curve("right", false, &|record| record.support[1] / 1e3),
                curve("weight", true, &|record| record.weight / 1e3),
            ],
            range: [0.0, round_up(1.1 * last)],
        },
        Chart {
            title: "Mid-span deflection (mm)".to_owned(),
            times: times.clone(),
            curves: vec![
                curve("finite elements", false, &|record| 1e3 * record.deflection),
                curve("beam theory, at rest", true, &|_| 1e3 * at_rest),
            ],
            range: [0.0, round_up(1.1e3 * deepest)],
        },
        Chart {
            title: "Largest von Mises stress (MPa)".to_owned(),
            times,
            curves: vec![curve("deck", false, &|record| record.max_von_mises / 1e6)],
            range: [0.0, round_up(stress / 1e6)],
        },
    ]
}
