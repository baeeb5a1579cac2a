//! Drawings as SVG, resolved by `usvg`: styles, transformations, symbols and basic shapes become paths, whose curves are divided into sides.
//!
//! With `m = max |B''|/6` of a cubic curve B, which its control points bound by the larger of `|p0 - 2 p1 + p2|` and `|p1 - 2 p2 + p3|`, `n` equal parts
//! leave a distance of at most `6 m / (8 n²)`; of a quadratic one `2 |p0 - 2 p1 + p2| / (8 n²)`.

use super::rings::{FillRule, outlines_of};
use super::{Outline, OutlineError};
use crate::math::hypot;
use usvg::roxmltree::{Document, ParsingOptions};
use usvg::tiny_skia_path::{PathSegment, Point};
use usvg::{Group, ImageHrefResolver, Node, Path, Tree};

/// Most points of one path.
const MOST_POINTS: usize = 100_000;

/// A CSS pixel is a 96th of an inch (m).
const PIXEL: f64 = 0.0254 / 96.0;

/// Strokes are no shapes, but their outlines are computed for boxes: one that is a million times as wide as its page takes minutes. Markers and filters are
/// not looked at either.
const FILLS_ALONE: &str =
    "* { stroke: none !important; marker: none !important; filter: none !important }";

/// Numbers beyond this are refused. `usvg` divides an arc into as many curves as the sixth root of its radius: without end, of a radius of 1e300.
const LARGEST: f64 = 1e9;

/// Attributes whose numbers say where a shape is.
const GEOMETRY: [&str; 15] = [
    "d", "points", "x", "y", "width", "height", "r", "rx", "ry", "cx", "cy", "x1", "y1", "x2", "y2",
];

/// How a drawing is read.
#[derive(Clone, Debug, PartialEq)]
pub struct SvgOptions {
    /// Largest distance of a side from the curve it stands for (m).
    pub tolerance: f64,
    /// Length of a pixel (m). By default that of CSS, so that a drawing 100 mm wide is 0.1 m wide; what has no unit is in pixels.
    pub pixel: f64,
    /// Ids of groups (layers) or shapes that are read; all if empty.
    pub layers: Vec<String>,
}

impl SvgOptions {
    /// Reads all of a drawing, with curves to a tolerance (m).
    pub const fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            pixel: PIXEL,
            layers: Vec::new(),
        }
    }
}

/// Reads the filled shapes of a drawing, in their order. The origin is the lower left corner of the page, and y points up.
///
/// A shape is named by its id, or by that of the innermost group around it that has one. A copy has the id of its `use`. Its parts and holes follow from its fill rule. Shapes without a fill
/// (and hidden ones) are left out, as are text and images.
///
/// # Errors
/// If the text is no SVG, an id in the options is not in it, coordinates are beyond 1e9, curves need too many points, subpaths of one path cross or touch
/// each other, or nothing is filled.
///
/// ```
/// use foil2d::io::{SvgOptions, outlines_from_svg};
///
/// let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">
///     <g id="plate"><path fill-rule="evenodd" d="M0 0H100V50H0Z M40 20H60V30H40Z"/></g></svg>"##;
/// let outlines = outlines_from_svg(text, &SvgOptions::new(1e-4))?;
/// assert_eq!(outlines[0].name.as_deref(), Some("plate"));
/// assert_eq!(outlines[0].holes.len(), 1);
/// # Ok::<(), foil2d::io::OutlineError>(())
/// ```
pub fn outlines_from_svg(text: &str, options: &SvgOptions) -> Result<Vec<Outline>, OutlineError> {
    for (name, value) in [("tolerance", options.tolerance), ("pixel", options.pixel)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(OutlineError::InvalidOption { name, value });
        }
    }
    let tree = tree_of(text)?;
    let mut reader = Reader {
        options,
        height: f64::from(tree.size().height()),
        seen: vec![false; options.layers.len()],
        outlines: Vec::new(),
    };
    reader.read_group(tree.root(), None, options.layers.is_empty())?;
    if let Some(missing) = reader.seen.iter().position(|&seen| !seen) {
        let name = options.layers[missing].clone();
        return Err(OutlineError::NoSuchElement { name });
    }
    if reader.outlines.is_empty() {
        return Err(OutlineError::NoShapes);
    }
    Ok(reader.outlines)
}

/// A drawing without what no shape follows from: strokes, markers, filters and images, which may be files of any length.
fn tree_of(text: &str) -> Result<Tree, OutlineError> {
    let with_types = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document =
        Document::parse_with_options(text, with_types).map_err(|error| OutlineError::NoSvg {
            reason: error.to_string(),
        })?;
    for element in document.descendants() {
        let geometry = element
            .attributes()
            .filter(|attribute| GEOMETRY.contains(&attribute.name()));
        let mut numbers = geometry.flat_map(|attribute| numbers_of(attribute.value()));
        if let Some(value) = numbers.find(|value| value.abs() > LARGEST) {
            let name = element.attribute("id").unwrap_or_default().to_owned();
            return Err(OutlineError::TooLarge {
                name,
                value,
                limit: LARGEST,
            });
        }
    }
    let options = usvg::Options {
        style_sheet: Some(FILLS_ALONE.to_owned()),
        image_href_resolver: ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    };
    Tree::from_xmltree(&document, &options).map_err(|error| OutlineError::NoSvg {
        reason: error.to_string(),
    })
}

/// The numbers in a text, such as a path's data; what stands between them separates them.
fn numbers_of(text: &str) -> impl Iterator<Item = f64> {
    let bytes = text.as_bytes();
    let mut at = 0;
    let digits = move |from: usize| {
        let rest = bytes.get(from..).unwrap_or_default();
        from + rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    std::iter::from_fn(move || {
        let starts = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
        let start = at + bytes.get(at..)?.iter().position(starts)?;
        let mut end = digits(start);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let is_signed = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
            let exponent = end + 1 + usize::from(is_signed);
            // `1em` is a length.
            if digits(exponent) > exponent {
                end = digits(exponent);
            }
        }
        at = end;
        Some(text.get(start..end)?.parse().unwrap_or(0.0))
    })
}

struct Reader<'a> {
    options: &'a SvgOptions,
    /// Height of the page (px).
    height: f64,
    /// By layer asked for, whether it has been met.
    seen: Vec<bool>,
    outlines: Vec<Outline>,
}

impl Reader<'_> {
    fn is_asked_for(&mut self, id: &str) -> bool {
        let found = self.options.layers.iter().position(|layer| layer == id);
        if let Some(layer) = found {
            self.seen[layer] = true;
        }
        found.is_some()
    }

    fn read_group(
        &mut self,
        group: &Group,
        name: Option<&str>,
        is_read: bool,
    ) -> Result<(), OutlineError> {
        let own = (!group.id().is_empty()).then(|| group.id());
        let is_read = self.is_asked_for(group.id()) || is_read;
        let name = own.or(name);
        for node in group.children() {
            match node {
                Node::Group(group) => self.read_group(group, name, is_read)?,
                Node::Path(path) => {
                    let own = (!path.id().is_empty()).then(|| path.id());
                    if self.is_asked_for(path.id()) || is_read {
                        self.read_path(path, own.or(name))?;
                    }
                }
                Node::Image(_) | Node::Text(_) => {}
            }
        }
        Ok(())
    }

    fn read_path(&mut self, path: &Path, name: Option<&str>) -> Result<(), OutlineError> {
        let Some(fill) = path.fill() else {
            return Ok(());
        };
        if !path.is_visible() {
            return Ok(());
        }
        let rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        let rings = self.rings(path, name)?;
        let found = outlines_of(rings, rule, name).map_err(|at| OutlineError::PartsMeet {
            name: name.unwrap_or_default().to_owned(),
            at,
        })?;
        self.outlines.extend(found);
        Ok(())
    }

    /// The closed curves of a path in the world (m); open ones are closed, as filling does.
    fn rings(&self, path: &Path, name: Option<&str>) -> Result<Vec<Vec<[f64; 2]>>, OutlineError> {
        let transform = path.abs_transform();
        let [sx, kx, ky, sy, tx, ty] = [
            transform.sx,
            transform.kx,
            transform.ky,
            transform.sy,
            transform.tx,
            transform.ty,
        ]
        .map(f64::from);
        let place = |point: Point| {
            let (x, y) = (f64::from(point.x), f64::from(point.y));
            let placed = [sx * x + kx * y + tx, self.height - (ky * x + sy * y + ty)];
            placed.map(|pixels| pixels * self.options.pixel)
        };
        let mut rings: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut n_points = 0;
        for segment in path.data().segments() {
            let curve: Vec<[f64; 2]> = match segment {
                PathSegment::MoveTo(to) => {
                    rings.push(vec![place(to)]);
                    continue;
                }
                PathSegment::Close => continue,
                PathSegment::LineTo(to) => vec![place(to)],
                PathSegment::QuadTo(a, to) => vec![place(a), place(to)],
                PathSegment::CubicTo(a, b, to) => vec![place(a), place(b), place(to)],
            };
            // After a curve has been closed, another may begin where it did.
            let Some(ring) = rings.last_mut() else {
                continue;
            };
            n_points += divide(ring, &curve, self.options.tolerance);
            if n_points > MOST_POINTS {
                return Err(OutlineError::TooManyPoints {
                    name: name.unwrap_or_default().to_owned(),
                    limit: MOST_POINTS,
                });
            }
        }
        rings.iter_mut().for_each(close);
        Ok(rings)
    }
}

/// Appends a line, or a quadratic or cubic curve in as many parts as a tolerance (m) asks for; returns how many, or more than are allowed.
fn divide(ring: &mut Vec<[f64; 2]>, curve: &[[f64; 2]], tolerance: f64) -> usize {
    let Some(&from) = ring.last() else {
        return 0;
    };
    let bend = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        hypot(a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1])
    };
    let second_derivative = match *curve {
        [a, to] => 2.0 * bend(from, a, to),
        [a, b, to] => 6.0 * bend(from, a, b).max(bend(a, b, to)),
        _ => 0.0,
    };
    let n_parts = (second_derivative / (8.0 * tolerance))
        .sqrt()
        .ceil()
        .max(1.0);
    if n_parts > MOST_POINTS as f64 {
        return MOST_POINTS + 1;
    }
    for part in 1..=n_parts as usize {
        let t = part as f64 / n_parts;
        let s = 1.0 - t;
        let point = |axis: usize| match curve {
            [to] => to[axis],
            [a, to] => s * s * from[axis] + 2.0 * s * t * a[axis] + t * t * to[axis],
            [a, b, to] => {
                s * s * (s * from[axis] + 3.0 * t * a[axis])
                    + t * t * (3.0 * s * b[axis] + t * to[axis])
            }
            _ => from[axis],
        };
        ring.push([point(0), point(1)]);
    }
    n_parts as usize
}

/// Leaves out points that repeat the one before, the first at the end included: drawings close curves by hand.
fn close(ring: &mut Vec<[f64; 2]>) {
    let size = ring
        .iter()
        .flatten()
        .fold(0.0f64, |size, x| size.max(x.abs()));
    // What `f32` holds of a coordinate.
    let is_same = |a: &[f64; 2], b: &[f64; 2]| {
        hypot(a[0] - b[0], a[1] - b[1]) <= 4.0 * f64::from(f32::EPSILON) * size
    };
    ring.dedup_by(|b, a| is_same(a, b));
    while let [first, .., last] = ring[..]
        && is_same(&first, &last)
    {
        ring.pop();
    }
}
