//! A run as one page: an HTML file that plays what has been recorded, in any browser and without a network.
//!
//! The page plays, scrubs and zooms, colours the flexible bodies by von Mises stress, principal stress or displacement, draws contact forces, plots
//! energies and forces, and the history of a node that is clicked at.
//!
//! What is kept, and how it is rounded:
//!
//! | | as |
//! |---|---|
//! | displacements of nodes, at key frames (30 a second of the run; the page draws straight lines between) | 13 bits of the range that the body's have |
//! | von Mises stress | root of the part of the body's largest, 1/255 |
//! | components of Cauchy's stress, forces of contacts and attachments on nodes | the same, 1/40 and 1/127 |
//! | poses of rigid colliders | 16 bits of the box they move in, 10⁻⁴ rad |
//! | energies and the sum of contact forces, at every step | `f32` |
//!
//! Shapes of rigid colliders are those of the first frame they are seen in.

mod codec;
mod track;

use super::output::{OutputError, write};
use super::scene::Scene;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;
use track::{FlexTrack, RigidTrack, push_singles};

/// The page, with a mark where the data go.
const PAGE: &str = include_str!("page.html");
const MARK: &str = "@DATA@";
const TITLE: &str = "@TITLE@";

/// Curves at every step.
const CURVES: [&str; 5] = ["kinetic", "elastic", "potential", "total", "force"];

/// Records a run for a page that plays it.
///
/// All that is recorded is held in memory until it is written: some 32 bytes for each node at each key frame.
///
/// ```
/// use foil2d::io::{Replay, Scene};
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = PhysicsWorld::new();
/// let mut bodies = FlexBodySet::new();
/// let beam = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 1]).material(LinearElastic::plane_stress(1e7, 0.3).density(1e3));
/// bodies.insert(beam, &mut world)?;
/// let mut pipeline = FlexPipeline::new();
/// let mut replay = Replay::new("A beam falls");
/// for step in 1..=60 {
///     pipeline.step(&mut world, &mut bodies)?;
///     replay.record(f64::from(step) / 60.0, &Scene::of(&world, &bodies, pipeline.report()))?;
/// }
/// assert_eq!(replay.n_frames(), 30);
/// # let folder = std::env::temp_dir().join(format!("foil2d-replay-{}", std::process::id()));
/// replay.write(folder.join("beam.html"))?;
/// # std::fs::remove_dir_all(folder)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Replay {
    title: String,
    rate: f64,
    has_interior: bool,
    /// Times of the key frames (s).
    times: Vec<f64>,
    /// Times of all steps (s), and the curves at them.
    step_times: Vec<f64>,
    curves: [Vec<f64>; CURVES.len()],
    flexible: Vec<FlexTrack>,
    rigid: Vec<RigidTrack>,
    /// Where the tracks are, by index and generation.
    flex_track: HashMap<(u32, u32), usize>,
    rigid_track: HashMap<(u32, u32), usize>,
}

impl Replay {
    /// An empty recording, with the page's title.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            rate: 30.0,
            has_interior: true,
            times: Vec::new(),
            step_times: Vec::new(),
            curves: Default::default(),
            flexible: Vec::new(),
            rigid: Vec::new(),
            flex_track: HashMap::new(),
            rigid_track: HashMap::new(),
        }
    }

    /// Chooses how many key frames are kept of a second (1/s); 30 if not called. Infinity keeps every step.
    pub fn with_rate(mut self, rate: f64) -> Self {
        self.rate = rate;
        self
    }

    /// Keeps the nodes on the surface only: the page draws outlines in the colours of their nodes. For large meshes.
    pub fn surface_only(mut self) -> Self {
        self.has_interior = false;
        self
    }

    /// Number of key frames so far.
    pub fn n_frames(&self) -> usize {
        self.times.len()
    }

    /// Records a step that ends at a time (s): its energies and forces, and all bodies where a key frame is due.
    ///
    /// # Errors
    /// If an element cannot evaluate its strain.
    pub fn record(&mut self, time: f64, scene: &Scene<'_>) -> Result<(), OutputError> {
        let energy = scene.report.energy();
        let contacts = scene.report.contacts().iter();
        let force: f64 = contacts.map(|contact| contact.normal_force).sum();
        let values = [
            energy.kinetic,
            energy.elastic,
            energy.potential,
            energy.total(),
            force,
        ];
        self.step_times.push(time);
        for (curve, value) in self.curves.iter_mut().zip(values) {
            curve.push(value);
        }
        if self.is_due(time) {
            self.times.push(time);
            self.record_flexible(scene)?;
            self.record_rigid(scene);
        }
        Ok(())
    }

    /// Frames are due by their number, so that the rate holds whatever the step.
    fn is_due(&self, time: f64) -> bool {
        let Some(&first) = self.times.first() else {
            return true;
        };
        let due = first + self.times.len() as f64 / self.rate;
        time >= due - 1e-6 / self.rate
    }

    fn record_flexible(&mut self, scene: &Scene<'_>) -> Result<(), OutputError> {
        let frame = self.times.len() - 1;
        for (handle, body) in scene.flex_bodies.iter() {
            let name = handle.into_raw_parts();
            let track = *self.flex_track.entry(name).or_insert_with(|| {
                let track = FlexTrack::new(name.0, frame, body, self.has_interior);
                self.flexible.push(track);
                self.flexible.len() - 1
            });
            self.flexible[track].record(body)?;
        }
        Ok(())
    }

    fn record_rigid(&mut self, scene: &Scene<'_>) {
        let frame = self.times.len() - 1;
        for shape in scene.rigid_shapes() {
            let name = shape.collider.into_raw_parts();
            let track = *self.rigid_track.entry(name).or_insert_with(|| {
                self.rigid.push(RigidTrack::new(name.0, frame, &shape));
                self.rigid.len() - 1
            });
            self.rigid[track].record(&shape);
        }
    }

    /// The page.
    pub fn to_html(&self) -> String {
        let (before, after) = PAGE.split_once(MARK).unwrap_or((PAGE, ""));
        let mut html = before.replace(TITLE, &in_html(&self.title));
        self.write_data(&mut html);
        html.push_str(after);
        html
    }

    /// Writes the page to a file, and the folder it is to be in.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), OutputError> {
        write(path.as_ref().to_owned(), self.to_html().as_bytes())
    }

    fn write_data(&self, json: &mut String) {
        let _ = write!(json, "{{\"title\":{},\"times\":", in_json(&self.title));
        push_singles(json, &self.times);
        json.push_str(",\"steps\":");
        push_singles(json, &self.step_times);
        for (name, curve) in CURVES.iter().zip(&self.curves) {
            let _ = write!(json, ",\"{name}\":");
            push_singles(json, curve);
        }
        json.push_str(",\"flexible\":[");
        for (index, track) in self.flexible.iter().enumerate() {
            json.push_str(if index == 0 { "\n" } else { ",\n" });
            track.write(json);
        }
        json.push_str("],\"rigid\":[");
        for (index, track) in self.rigid.iter().enumerate() {
            json.push_str(if index == 0 { "\n" } else { ",\n" });
            track.write(json);
        }
        json.push_str("]}");
    }
}

fn in_html(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;")
}

/// A text as JSON, which may stand within an element `script`.
fn in_json(text: &str) -> String {
    let mut json = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => json.extend(['\\', c]),
            '<' | '>' | '&' => {
                let _ = write!(json, "\\u{:04x}", u32::from(c));
            }
            c if c.is_control() => {
                let _ = write!(json, "\\u{:04x}", u32::from(c));
            }
            c => json.push(c),
        }
    }
    json.push('"');
    json
}
