//! A picture of a step: stresses of flexible bodies, rigid bodies, forces of contact.

#[cfg(feature = "png")]
mod png;

#[cfg(feature = "png")]
pub use png::{still_png, write_still_png};

use super::output::{OutputError, write};
use super::scene::Scene;
use super::stress::world_stress;
use crate::body::FlexBody;
use crate::math::{Vec2, node_vec};
use crate::pipeline::Participant;
use std::fmt::Write as _;
use std::path::Path;

/// Width of the picture (px).
const WIDTH: f64 = 960.0;

/// Height of the line of words over it (px).
const HEAD: f64 = 34.0;

/// Room around the bodies, over the size of all of them.
const MARGIN: f64 = 0.15;

/// Length of the arrow of the largest force, over the size of the picture.
const ARROW: f64 = 0.12;

/// Colours from no stress to the largest, red, green and blue.
const COLOURS: [[f64; 3]; 6] = [
    [48.0, 60.0, 130.0],
    [44.0, 123.0, 182.0],
    [120.0, 198.0, 185.0],
    [232.0, 222.0, 110.0],
    [245.0, 150.0, 70.0],
    [190.0, 30.0, 45.0],
];

/// How the line of a collider that touches nothing is drawn.
const DASHED: &str = " stroke-dasharray=\"6 4\"";

/// Draws a step as SVG: flexible bodies with von Mises' stress, rigid ones as outlines, sensors dashed and empty, forces of contact as arrows: on the flexible body, or on the contactor of two.
///
/// ```
/// use foil2d::io::{Scene, still};
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
/// world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
/// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
/// flex_bodies.insert(FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber), &mut world)?;
/// let mut flex = FlexPipeline::new();
/// let report = flex.step(&mut world, &mut flex_bodies)?;
/// let picture = still(&Scene::of(&world, &flex_bodies, report))?;
/// assert!(picture.starts_with("<svg") && picture.matches("<polygon").count() >= 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If an element cannot evaluate its strain.
pub fn still(scene: &Scene<'_>) -> Result<String, OutputError> {
    let view = View::around(scene);
    let stresses: Vec<(&FlexBody, Vec<f64>)> = scene
        .flex_bodies
        .iter()
        .map(|(_, body)| {
            let stresses = world_stress(body)?;
            Ok((
                body,
                stresses.iter().map(|stress| stress.von_mises()).collect(),
            ))
        })
        .collect::<Result<_, OutputError>>()?;
    // A cell has the colour of the mean at its corners, and the scale ends with the largest of these.
    let mean = |values: &[f64], corners: &[usize]| {
        let sum: f64 = corners.iter().map(|&node| values[node]).sum();
        sum / corners.len() as f64
    };
    let all = stresses
        .iter()
        .flat_map(|(body, values)| body.mesh().cells().map(|cell| mean(values, cell.corners())));
    let largest = all.fold(0.0, f64::max);
    let mut picture = view.head(largest);
    for shape in scene.rigid_shapes() {
        for line in &shape.lines {
            let points = line.points.iter().map(|&at| shape.place(at).into());
            let points: Vec<Vec2> = points.collect();
            let tag = if line.is_closed {
                "polygon"
            } else {
                "polyline"
            };
            let fill = if line.is_closed && !shape.is_sensor {
                "#d5d9e0"
            } else {
                "none"
            };
            view.begin(&mut picture, tag, &points, fill, "#6b7686");
            let dashes = if shape.is_sensor { DASHED } else { "" };
            let _ = writeln!(picture, "{dashes}/>");
        }
    }
    for (body, values) in &stresses {
        for cell in body.mesh().cells() {
            let corners = cell.corners();
            let points = corners.iter().map(|&node| node_vec(body.positions(), node));
            let points: Vec<Vec2> = points.collect();
            let fill = colour(mean(values, corners) / largest.max(f64::MIN_POSITIVE));
            view.draw(&mut picture, "polygon", &points, &fill, &fill);
        }
        for &segment in body.mesh().boundary().segments() {
            let points = segment.map(|node| node_vec(body.positions(), node));
            view.draw(&mut picture, "polyline", &points, "none", "#1c2430");
        }
    }
    view.draw_forces(&mut picture, scene);
    picture.push_str("</g></svg>\n");
    Ok(picture)
}

/// Writes the picture of [`still`] to a file.
///
/// # Errors
/// As of [`still`], and if the file cannot be written.
pub fn write_still(path: impl AsRef<Path>, scene: &Scene<'_>) -> Result<(), OutputError> {
    write(path.as_ref().to_owned(), still(scene)?.as_bytes())
}

/// What part of the world is drawn.
struct View {
    low: Vec2,
    high: Vec2,
    /// Pixels to a metre.
    scale: f64,
}

impl View {
    /// All bodies that forces move, with room around.
    fn around(scene: &Scene<'_>) -> Self {
        let (mut low, mut high) = (Vec2::repeat(f64::INFINITY), Vec2::repeat(-f64::INFINITY));
        for (_, body) in scene.flex_bodies.iter() {
            for node in 0..body.n_nodes() {
                let at = node_vec(body.positions(), node);
                (low, high) = (low.inf(&at), high.sup(&at));
            }
        }
        for shape in scene.rigid_shapes().iter().filter(|shape| shape.moves) {
            for point in shape.lines.iter().flat_map(|line| &line.points) {
                let at = Vec2::from(shape.place(*point));
                if at.x.is_finite() && at.y.is_finite() {
                    (low, high) = (low.inf(&at), high.sup(&at));
                }
            }
        }
        if low.x > high.x {
            (low, high) = (Vec2::repeat(-1.0), Vec2::repeat(1.0));
        }
        let margin = Vec2::repeat(MARGIN * (high - low).max());
        let (low, high) = (low - margin, high + margin);
        Self {
            scale: WIDTH / (high - low).x,
            low,
            high,
        }
    }

    fn place(&self, at: Vec2) -> [f64; 2] {
        let down = self.scale * (self.high.y - at.y);
        [self.scale * (at.x - self.low.x), HEAD + down]
    }

    fn head(&self, largest: f64) -> String {
        let height = HEAD + self.scale * (self.high - self.low).y;
        let mut picture = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" viewBox=\"0 0 {WIDTH} {height:.0}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#1c2430\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        let part = 22.0;
        for step in 0..10 {
            let (x, fill) = (
                150.0 + part * f64::from(step),
                colour(f64::from(step) / 9.0),
            );
            let _ = writeln!(
                picture,
                "<rect x=\"{x}\" y=\"10\" width=\"{part}\" height=\"12\" fill=\"{fill}\"/>"
            );
        }
        let end = 158.0 + 10.0 * part;
        let _ = writeln!(
            picture,
            "<text x=\"8\" y=\"21\">von Mises stress  0</text><text x=\"{end}\" y=\"21\">{largest:.3e} Pa</text>\n<clipPath id=\"view\"><rect y=\"{HEAD}\" width=\"100%\" height=\"100%\"/></clipPath>\n<g clip-path=\"url(#view)\" stroke-width=\"1\" stroke-linejoin=\"round\">"
        );
        picture
    }

    fn draw(&self, picture: &mut String, tag: &str, points: &[Vec2], fill: &str, stroke: &str) {
        self.begin(picture, tag, points, fill, stroke);
        picture.push_str("/>\n");
    }

    /// All of an element but its end.
    fn begin(&self, picture: &mut String, tag: &str, points: &[Vec2], fill: &str, stroke: &str) {
        let _ = write!(picture, "<{tag} points=\"");
        for &point in points {
            let [x, y] = self.place(point);
            let _ = write!(picture, "{x:.1},{y:.1} ");
        }
        let _ = write!(picture, "\" fill=\"{fill}\" stroke=\"{stroke}\"");
    }

    fn draw_forces(&self, picture: &mut String, scene: &Scene<'_>) {
        let contacts = scene.report.contacts().iter();
        let arrows = contacts.map(|contact| {
            let [at, force] = [contact.position, contact.force()].map(Vec2::from);
            // On the flexible one.
            match (contact.contactor, contact.target) {
                (Participant::Rigid(_), Participant::Flex(_)) => [at, -force],
                _ => [at, force],
            }
        });
        let arrows: Vec<[Vec2; 2]> = arrows.collect();
        let largest = arrows
            .iter()
            .map(|[_, force]| force.norm())
            .fold(0.0, f64::max);
        let length = ARROW * (self.high - self.low).min();
        for [at, force] in arrows {
            let way = force * (length / largest.max(f64::MIN_POSITIVE));
            if way.norm() < 0.05 * length {
                continue;
            }
            let (head, across) = (0.25 * way, 0.1 * Vec2::new(-way.y, way.x));
            let (from, neck) = (at - way, at - head);
            self.draw(picture, "polyline", &[from, neck], "none", "#b5005a");
            let tip = [at, neck + across, neck - across];
            self.draw(picture, "polygon", &tip, "#b5005a", "none");
        }
    }
}

/// The colour of a share of the largest stress.
fn colour(share: f64) -> String {
    let at = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let below = (at as usize).min(COLOURS.len() - 2);
    let part = at - below as f64;
    let [red, green, blue] = [0, 1, 2].map(|channel| {
        let (from, to) = (COLOURS[below][channel], COLOURS[below + 1][channel]);
        from + part * (to - from)
    });
    format!("#{:02x}{:02x}{:02x}", red as u8, green as u8, blue as u8)
}
