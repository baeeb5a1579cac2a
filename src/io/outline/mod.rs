//! Outlines with holes, drawn elsewhere: from JSON as of maps, and from drawings as SVG.

mod error;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "svg")]
mod rings;
#[cfg(feature = "svg")]
mod svg;

pub use error::OutlineError;
#[cfg(feature = "json")]
pub use json::outlines_from_json;
#[cfg(feature = "svg")]
pub use svg::{SvgOptions, outlines_from_svg};

use crate::fe::mesh::generate::{PolygonOptions, polygon};
use crate::fe::mesh::{Mesh, MeshError};

/// A polygon with holes, and its name.
///
/// ```
/// use foil2d::fe::mesh::generate::PolygonOptions;
/// use foil2d::io::Outline;
///
/// let square = |half: f64| vec![[-half, -half], [half, -half], [half, half], [-half, half]];
/// let outline = Outline { name: Some("frame".to_owned()), outer: square(1.0), holes: vec![square(0.5)] };
/// let mesh = outline.mesh(&PolygonOptions::new(0.25))?;
/// assert!((mesh.area() - 3.0).abs() < 1e-12);
/// # Ok::<(), foil2d::fe::mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// The name, such as that of a layer, if there is one.
    pub name: Option<String>,
    /// Corners (m), in either direction, the first not repeated.
    pub outer: Vec<[f64; 2]>,
    /// Corners of the holes (m).
    pub holes: Vec<Vec<[f64; 2]>>,
}

impl Outline {
    /// Meshes it with triangles, as [`polygon`] does.
    ///
    /// # Errors
    /// As [`polygon`].
    pub fn mesh(&self, options: &PolygonOptions) -> Result<Mesh, MeshError> {
        polygon(&self.outer, &self.holes, options)
    }
}
