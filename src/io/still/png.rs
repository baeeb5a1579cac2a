//! The picture of a step as PNG: what `still` draws, rendered by resvg with a font of its own, so that it looks the same everywhere.

use super::{still, write};
use crate::io::output::OutputError;
use crate::io::scene::Scene;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::path::Path;
use std::sync::Arc;

/// How far beyond the picture something may reach (px): the rasterizer fails on coordinates that its numbers do not hold.
const FARTHEST: f64 = 1e7;

/// Draws a step as PNG of this width (px), as [`still`] does; the height follows from what is in it.
///
/// ```
/// use foil2d::io::{Scene, still_png};
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
/// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
/// flex_bodies.insert(FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber), &mut world)?;
/// let mut flex = FlexPipeline::new();
/// let report = flex.step(&mut world, &mut flex_bodies)?;
/// let picture = still_png(&Scene::of(&world, &flex_bodies, report), 1920)?;
/// assert!(picture.starts_with(b"\x89PNG"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If an element cannot evaluate its strain, or a picture of that width cannot be held.
pub fn still_png(scene: &Scene<'_>, width: u32) -> Result<Vec<u8>, OutputError> {
    let unpaintable = |reason: String| OutputError::Unpaintable { width, reason };
    let options = Options {
        fontdb: Arc::new(fonts()),
        ..Options::default()
    };
    let tree =
        Tree::from_str(&still(scene)?, &options).map_err(|error| unpaintable(error.to_string()))?;
    let scale = f64::from(width) / f64::from(tree.size().width());
    let height = (scale * f64::from(tree.size().height())).ceil();
    let reach = tree.root().abs_stroke_bounding_box();
    let sides = [reach.left(), reach.right(), reach.top(), reach.bottom()];
    let farthest = sides.map(|side| scale * f64::from(side).abs());
    let farthest = farthest.into_iter().fold(0.0, f64::max);
    if !farthest.is_finite() || farthest > FARTHEST {
        return Err(unpaintable(format!(
            "what is in it reaches {farthest:.0e} px beyond its edge: look at a smaller world, or take the SVG"
        )));
    }
    let mut picture = Pixmap::new(width, height as u32)
        .ok_or_else(|| unpaintable(format!("it would be {height:.0} px high")))?;
    let scale = Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, scale, &mut picture.as_mut());
    picture
        .encode_png()
        .map_err(|error| unpaintable(error.to_string()))
}

/// The font of all words, as fonts of the system would differ or be missing.
fn fonts() -> fontdb::Database {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts
        .faces()
        .find_map(|face| Some(face.families.first()?.0.clone()));
    if let Some(family) = family {
        fonts.set_sans_serif_family(family);
    }
    fonts
}

/// Writes the picture of [`still_png`] to a file.
///
/// # Errors
/// As of [`still_png`], and if the file cannot be written.
pub fn write_still_png(
    path: impl AsRef<Path>,
    scene: &Scene<'_>,
    width: u32,
) -> Result<(), OutputError> {
    write(path.as_ref().to_owned(), &still_png(scene, width)?)
}
