//! `foil2d drop`.

use super::build::{Built, build, n_steps};
use super::files::{check_writable, note, print};
use super::outlines::{Wanted, note_left_out, outlines};
use super::output::Outputs;
use super::problem::Problem;
use super::run::take_steps;
use super::scene::{MOST_NODES, World};
use super::shape::mesh_of;
use super::source::{Source, stem_of};
use super::words::of_mesh;
use clap::Args;
use foil2d::doctor::{Finding, examine};
use foil2d::io::Outline;
use foil2d::pipeline::{InsertionNote, Participant};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Nodes of all shapes up to which a run of the default length takes some seconds, and how many there are to the square of an edge, about (-).
const MANY_NODES: f64 = 6000.0;
const NODES_BY_AREA: f64 = 5.0;

#[derive(Args)]
pub struct Options {
    /// A drawing: SVG, or GeoJSON (.json, .geojson).
    outline: PathBuf,
    /// Metres to a unit of the file (a pixel, of SVG).
    #[arg(long, default_value_t = 0.01)]
    scale: f64,
    /// Only the shapes of this id, or of a group (layer) of this id; may be given several times.
    #[arg(long)]
    layer: Vec<String>,
    /// Length of the cells' edges (m); a fifteenth of the largest shape without, longer where the shapes are many.
    #[arg(long)]
    edge: Option<f64>,
    /// Young's modulus (Pa).
    #[arg(long, default_value_t = 2e5)]
    young: f64,
    /// Density (kg/m³).
    #[arg(long, default_value_t = 1000.0)]
    density: f64,
    /// How far the shapes fall (m); half of the size of the largest without.
    #[arg(long)]
    height: Option<f64>,
    /// Length of the run (s).
    #[arg(long, default_value_t = 3.0)]
    duration: f64,
    /// Most nodes of all shapes together.
    #[arg(long, default_value_t = MOST_NODES)]
    most_nodes: usize,
    /// The folder for files.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Shows no progress.
    #[arg(long)]
    quiet: bool,
}

/// Writes a scene of the shapes over a floor beside the other files, and runs it.
pub fn drop_outline(options: &Options) -> Result<(), Problem> {
    check(options)?;
    let path = options.out.join("scene.toml");
    let mut drawing = Drawing::read(options)?;
    note_left_out(&options.outline);
    check_writable(std::slice::from_ref(&path))?;
    if std::fs::read_to_string(&path).is_ok_and(|before| is_changed(&before)) {
        let what = "somebody has changed this scene: run it by `foil2d run`, remove it, or choose another folder by --out";
        return Err(Problem::of_file(what, &path));
    }
    let (source, mut built) = loop {
        write(&path, &signed(&drawing.scene(options)))?;
        let mut source = Source::read(&path)?;
        source.title = stem_of(&options.outline);
        let built = build(&source)?;
        if !drawing.part(&built) {
            break (source, built);
        }
    };
    for shape in drawing.shapes.iter().filter(|shape| shape.lift > 0.0) {
        note(&format!(
            "`{}` lies on another shape of the drawing: it falls from {:.3} m higher",
            shape.name, shape.lift
        ));
    }
    let outputs = Outputs::new(&source, &built, Some(options.out.clone()))?;
    let n_steps = n_steps(&source.scene);
    let told = take_steps(&mut built, outputs, n_steps, options.quiet)?;
    print(&format!("wrote {}\n{told}", path.display()))
}

/// What stands before the sum of a scene's bytes, in its first line.
const SIGNED: &str = "# by `foil2d drop`, ";

/// A scene under a line that tells whether it has been changed.
fn signed(scene: &str) -> String {
    format!("{SIGNED}{:016x}\n{scene}", sum_of(scene))
}

/// Whether a scene is another one than was written.
fn is_changed(scene: &str) -> bool {
    let signed = scene
        .strip_prefix(SIGNED)
        .and_then(|rest| rest.split_once('\n'));
    !signed.is_some_and(|(sum, scene)| u64::from_str_radix(sum, 16) == Ok(sum_of(scene)))
}

/// FNV-1a of the bytes of a text.
fn sum_of(text: &str) -> u64 {
    let bytes = text.bytes();
    bytes.fold(0xcbf2_9ce4_8422_2325, |sum, byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

fn write(path: &Path, text: &str) -> Result<(), Problem> {
    std::fs::write(path, text).map_err(|error| Problem::of_file(error, path))
}

fn check(options: &Options) -> Result<(), Problem> {
    let given = [
        ("scale", Some(options.scale)),
        ("edge", options.edge),
        ("young", Some(options.young)),
        ("density", Some(options.density)),
        ("height", options.height),
        ("duration", Some(options.duration)),
    ];
    let is_sound = |value: f64| value > 0.0 && value <= 1e12;
    let mut given = given
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)));
    if let Some((name, value)) = given.find(|(_, value)| !is_sound(*value)) {
        let what = format!("--{name} is {value}: give a positive number");
        return Err(Problem::plain(what));
    }
    let least = 0.5 * *World::default().dt.get();
    match options.duration < least {
        true => Err(Problem::plain(format!(
            "--duration is {}: give {least:.3} s, half a step, or more",
            options.duration
        ))),
        false => Ok(()),
    }
}

/// A shape that falls.
struct Falling {
    name: String,
    outline: Outline,
    /// Its lowest and highest point, as drawn (m).
    low: f64,
    high: f64,
    /// By how much it is put higher than it is drawn (m).
    lift: f64,
}

/// The shapes of a drawing, the lowest first.
struct Drawing {
    shapes: Vec<Falling>,
    /// Length of the cells' edges (m).
    edge: f64,
    /// Where the floor is (m).
    floor: f64,
}

impl Drawing {
    fn read(options: &Options) -> Result<Self, Problem> {
        let read = |edge: f64| {
            let wanted = Wanted {
                edge,
                scale: options.scale,
                names: &options.layer,
            };
            outlines(&options.outline, &wanted)
        };
        // How large the shapes are says how finely their curves are read.
        let coarse = read(1e3 * options.scale)?;
        let size = coarse.iter().map(size_of).fold(0.0, f64::max);
        let area: f64 = coarse.iter().map(area_of).sum();
        let affordable = (NODES_BY_AREA * area / MANY_NODES).sqrt();
        let edge = options.edge.unwrap_or(affordable.max(size / 15.0));
        let mut shapes: Vec<Falling> = Vec::new();
        let mut nodes_left = options.most_nodes;
        for (index, outline) in read(edge)?.into_iter().enumerate() {
            let name = name_of(&shapes, outline.name.as_deref(), index);
            match mesh_of(&outline, edge, nodes_left) {
                Ok(mesh) => nodes_left = nodes_left.saturating_sub(mesh.n_nodes()),
                Err(error) => {
                    let what = of_mesh(&error).1;
                    note(&format!("`{name}` is left out: {what}"));
                    continue;
                }
            }
            let [low, high] = extent(&outline, 1);
            shapes.push(Falling {
                name,
                outline,
                low,
                high,
                lift: 0.0,
            });
        }
        if shapes.is_empty() {
            let what = "no shape of the drawing can be meshed";
            return Err(Problem::of_file(what, &options.outline));
        }
        shapes.sort_by(|one, other| one.low.total_cmp(&other.low));
        let height = options.height.unwrap_or(0.5 * size);
        Ok(Self {
            floor: shapes[0].low - height,
            shapes,
            edge,
        })
    }

    /// Puts shapes that overlap above those that were lower, and says whether any was moved. As a shape gives way only to those before it in the order,
    /// this comes to an end.
    fn part(&mut self, built: &Built) -> bool {
        let found = examine(&built.world, &built.flex_bodies, &built.flex.parameters);
        let mut has_moved = false;
        for finding in found {
            let Finding::Insertion(InsertionNote::Overlap { body, with }) = finding else {
                continue;
            };
            let Participant::Flex(with) = with else {
                continue;
            };
            let index = |handle| {
                let is_it = |one: &Falling| built.names.flexible.get(&one.name) == Some(&handle);
                self.shapes.iter().position(is_it)
            };
            let (Some(one), Some(other)) = (index(body), index(with)) else {
                continue;
            };
            let (lower, upper) = (one.min(other), one.max(other));
            let top = self.shapes[lower].high + self.shapes[lower].lift;
            let shape = &mut self.shapes[upper];
            let lift = top + self.edge - shape.low;
            // What is above and is told to overlap all the same, by rounding, is left to the run.
            if lift > shape.lift {
                shape.lift = lift;
                has_moved = true;
            }
        }
        has_moved
    }

    /// The scene, in TOML.
    fn scene(&self, options: &Options) -> String {
        let mut scene = format!(
            "[world]\nduration = {:?}\nmost_nodes = {}\n\n[materials.soft]\nyoung = {:?}\npoisson = 0.4\ndensity = {:?}\nrayleigh = 2e-3\nlaw = \"stable_neo_hookean\"\n\n[[rigid]]\nname = \"floor\"\nkind = \"fixed\"\nshape.halfspace.normal = [0.0, 1.0]\ntranslation = [0.0, {:?}]\n",
            options.duration, options.most_nodes, options.young, options.density, self.floor,
        );
        for shape in &self.shapes {
            // TOML's quotes are not Rust's.
            let name = toml::Value::String(shape.name.clone());
            let _ = write!(
                scene,
                "\n[[flexible]]\nname = {name}\nmaterial = \"soft\"\ntranslation = [0.0, {:?}]\nshape.polygon = {{ edge = {:?}, outline = {:?}, holes = {:?} }}\n",
                shape.lift, self.edge, shape.outline.outer, shape.outline.holes
            );
        }
        scene
    }
}

/// The name of an outline, or another one if it is taken.
fn name_of(taken: &[Falling], own: Option<&str>, index: usize) -> String {
    let own = own.filter(|own| !own.trim().is_empty() && *own != "floor");
    let is_taken = |name: &str| taken.iter().any(|shape| shape.name == name);
    match own {
        Some(own) if !is_taken(own) => own.to_owned(),
        own => {
            let stem = own.unwrap_or("shape");
            let mut numbers = index + 1..;
            let free = numbers.find(|number| !is_taken(&format!("{stem} {number}")));
            format!("{stem} {}", free.unwrap_or(index))
        }
    }
}

/// The lowest and the highest coordinate along an axis (m).
fn extent(outline: &Outline, axis: usize) -> [f64; 2] {
    let all = outline.outer.iter().map(|at| at[axis]);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

/// What is inside the outline (m²).
fn area_of(outline: &Outline) -> f64 {
    let area = |ring: &Vec<[f64; 2]>| {
        let next = ring.iter().cycle().skip(1);
        let cross = ring
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
        0.5 * cross.sum::<f64>().abs()
    };
    area(&outline.outer) - outline.holes.iter().map(area).sum::<f64>()
}

fn size_of(outline: &Outline) -> f64 {
    let sides = [0, 1].map(|axis| {
        let [low, high] = extent(outline, axis);
        high - low
    });
    sides[0].max(sides[1])
}
