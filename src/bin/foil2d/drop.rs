//! `foil2d drop`.

use super::build::build;
use super::output::Outputs;
use super::problem::Problem;
use super::run::take_steps;
use super::shape::outlines;
use super::source::Source;
use clap::Args;
use std::fmt::Write as _;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// An outline: SVG, or JSON as of maps.
    outline: PathBuf,
    /// Metres to a unit of the file (a pixel, of SVG).
    #[arg(long, default_value_t = 0.01)]
    scale: f64,
    /// Length of the cells' edges (m); a fifteenth of the largest shape without.
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
    /// The folder for files.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Shows no progress.
    #[arg(long)]
    quiet: bool,
}

/// Writes a scene of the shapes over a floor beside the other files, and runs it.
pub fn drop_outline(options: &Options) -> Result<(), Problem> {
    let scene = options.out.join("scene.toml");
    check(options)?;
    let text = scene_of(options)?;
    std::fs::create_dir_all(&options.out)
        .and_then(|()| std::fs::write(&scene, text))
        .map_err(|error| Problem::plain(format!("{}: {error}", scene.display())))?;
    let source = Source::read(&scene)?;
    let mut built = build(&source)?;
    let outputs = Outputs::new(&source, &built, Some(options.out.clone()))?;
    let n_steps = (options.duration * 60.0).round() as usize;
    let told = take_steps(&mut built, outputs, n_steps, options.quiet)?;
    println!("wrote {}", scene.display());
    print!("{told}");
    Ok(())
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
    match given.find(|(_, value)| !is_sound(*value)) {
        Some((name, value)) => Err(Problem::plain(format!(
            "--{name} is {value}: give a positive number"
        ))),
        None => Ok(()),
    }
}

/// The scene, in TOML.
fn scene_of(options: &Options) -> Result<String, Problem> {
    let read = |edge: f64| outlines(&options.outline, edge, options.scale);
    // How large the shapes are says how finely their curves are read.
    let found = read(1e3 * options.scale)?;
    let points = || found.iter().flat_map(|outline| &outline.outer);
    let bound = |axis: usize| {
        let all = points().map(move |at| at[axis]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let [[left, right], [low, high]] = [bound(0), bound(1)];
    let size = (right - left).max(high - low);
    let edge = options.edge.unwrap_or(size / 15.0);
    let height = options.height.unwrap_or(0.5 * size);
    let found = read(edge)?;
    let mut scene = format!(
        "[world]\nduration = {:?}\n\n[materials.soft]\nyoung = {:?}\npoisson = 0.4\ndensity = {:?}\nrayleigh = 2e-3\nlaw = \"stable_neo_hookean\"\n\n[[rigid]]\nname = \"floor\"\nkind = \"fixed\"\nshape.halfspace.normal = [0.0, 1.0]\ntranslation = [0.0, {:?}]\n",
        options.duration,
        options.young,
        options.density,
        low - height,
    );
    for (index, outline) in found.iter().enumerate() {
        let name = match outline.name.as_deref() {
            Some(name) => format!("{name} {index}"),
            None => format!("shape {index}"),
        };
        let _ = write!(
            scene,
            "\n[[flexible]]\nname = {name:?}\nmaterial = \"soft\"\nshape.polygon = {{ edge = {edge:?}, outline = {:?}, holes = {:?} }}\n",
            outline.outer, outline.holes
        );
    }
    Ok(scene)
}
