//! Outlines of SVG and JSON files.

use super::files::{note, read_text};
use super::names::no_such;
use super::problem::Problem;
use foil2d::io::{Outline, OutlineError, SvgOptions, outlines_from_json, outlines_from_svg};
use std::path::Path;
use usvg::roxmltree::{Document, Node, ParsingOptions};

/// A distance of curves from the sides that stand for them, over the length of an edge.
const FLATTENING: f64 = 0.02;

/// What is wanted of a file.
pub struct Wanted<'a> {
    /// Length of the cells' edges (m): how finely curves are divided follows from it.
    pub edge: f64,
    /// Metres to a unit of the file.
    pub scale: f64,
    /// Ids of groups or shapes, or names of features; all if empty.
    pub names: &'a [String],
}

/// Why there are no outlines.
pub enum Refused {
    /// A name is not in the file.
    Name(String),
    File(Problem),
}

impl From<Refused> for Problem {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Name(what) => Self::plain(what),
            Refused::File(problem) => problem,
        }
    }
}

/// The outlines of an SVG or JSON file.
pub fn outlines(path: &Path, wanted: &Wanted<'_>) -> Result<Vec<Outline>, Refused> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    let other = match ending {
        Some("msh") => Some("this is a mesh: name it in a scene, `shape.msh.file = \"...\"`"),
        Some("toml") => Some("this is a scene: run it by `foil2d run`"),
        _ => None,
    };
    if let Some(what) = other {
        return Err(Refused::File(Problem::of_file(what, path)));
    }
    let text = read_text(path).map_err(Refused::File)?;
    let is_json = ending
        .is_some_and(|ending| ["json", "geojson"].contains(&ending.to_ascii_lowercase().as_str()));
    let found = match is_json {
        true => of_json(&text, wanted)?,
        false => of_svg(&text, wanted)?,
    };
    found.map_err(|error| Refused::File(Problem::of_file(words(&error), path)))
}

/// Tells what of a drawing is no filled shape, as far as its elements say so themselves.
pub fn note_left_out(path: &Path) {
    let found = read_text(path).ok().and_then(|text| left_out(&text));
    if let Some(what) = found {
        note(&format!("left out of {}: {what}", path.display()));
    }
}

/// Elements in which nothing is drawn where it stands.
const UNDRAWN: [&str; 6] = ["defs", "clipPath", "mask", "pattern", "marker", "symbol"];

const SHAPES: [&str; 7] = [
    "path", "rect", "circle", "ellipse", "polygon", "polyline", "line",
];

fn left_out(text: &str) -> Option<String> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).ok()?;
    let is_drawn = |one: &Node<'_, '_>| {
        let mut around = one.ancestors();
        !around.any(|outer| UNDRAWN.contains(&outer.tag_name().name()))
    };
    let has_no_fill = |one: &Node<'_, '_>| {
        let style: String = one
            .attribute("style")
            .unwrap_or_default()
            .split(' ')
            .collect();
        one.tag_name().name() == "line"
            || one.attribute("fill") == Some("none")
            || style.split(';').any(|one| one == "fill:none")
    };
    let mut counts = [0; 3];
    for one in document.descendants().filter(is_drawn) {
        match one.tag_name().name() {
            "text" => counts[0] += 1,
            "image" => counts[1] += 1,
            name if SHAPES.contains(&name) && has_no_fill(&one) => counts[2] += 1,
            _ => {}
        }
    }
    let names = ["text(s)", "image(s)", "line(s) without a fill"];
    let told = counts.into_iter().zip(names).filter(|(n, _)| *n > 0);
    let told: Vec<String> = told.map(|(n, name)| format!("{n} {name}")).collect();
    let cure = "convert text to paths, and strokes to outlines";
    (!told.is_empty()).then(|| format!("{}: {cure}", told.join(", ")))
}

type Read = Result<Vec<Outline>, OutlineError>;

fn of_json(text: &str, wanted: &Wanted<'_>) -> Result<Read, Refused> {
    let all = match outlines_from_json(text) {
        Ok(all) => all,
        Err(error) => return Ok(Err(error)),
    };
    for name in wanted.names {
        if !all.iter().any(|one| one.name.as_ref() == Some(name)) {
            return Err(Refused::Name(no_such("outline", name, names(&all))));
        }
    }
    let is_wanted = |one: &Outline| {
        let own = one.name.as_ref();
        wanted.names.is_empty() || own.is_some_and(|own| wanted.names.contains(own))
    };
    let chosen = all.into_iter().filter(is_wanted);
    Ok(Ok(chosen.map(|one| scaled(one, wanted.scale)).collect()))
}

fn of_svg(text: &str, wanted: &Wanted<'_>) -> Result<Read, Refused> {
    let options = SvgOptions {
        pixel: wanted.scale,
        layers: wanted.names.to_vec(),
        ..SvgOptions::new(FLATTENING * wanted.edge)
    };
    let found = outlines_from_svg(text, &options);
    let Err(OutlineError::NoSuchElement { name }) = &found else {
        return Ok(found);
    };
    let all = SvgOptions {
        layers: Vec::new(),
        ..options
    };
    let all = outlines_from_svg(text, &all).unwrap_or_default();
    let what = no_such("group or shape with the id", name, names(&all));
    Err(Refused::Name(what))
}

fn words(error: &OutlineError) -> String {
    match error {
        OutlineError::TooManyPoints { name, limit } => {
            let of = match name.as_str() {
                "" => String::new(),
                name => format!(" of `{name}`"),
            };
            format!("the curves{of} need more than {limit} points: take longer edges of cells")
        }
        error => error.to_string(),
    }
}

fn scaled(mut outline: Outline, scale: f64) -> Outline {
    let rings = std::iter::once(&mut outline.outer).chain(&mut outline.holes);
    rings.flatten().flatten().for_each(|x| *x *= scale);
    outline
}

/// Names of outlines, each once.
pub fn names(outlines: &[Outline]) -> Vec<&str> {
    let all = outlines.iter();
    let mut names: Vec<&str> = all.filter_map(|outline| outline.name.as_deref()).collect();
    names.sort_unstable();
    names.dedup();
    names
}
