//! Into the library and out of it: meshes of other programs, results for them.
//!
//! - [`MshMesh`] reads meshes of gmsh, with their physical groups.
//! - [`Outline`]s are read of GeoJSON (feature `json`) and of SVG (feature `svg`), to be meshed.
//! - [`VtuSeries`] and [`write_vtu`] write results for ParaView, [`History`] tables of chosen numbers.
//! - [`write_still`] draws a step, as SVG, and `write_still_png` as PNG (feature `png`).
//! - [`Replay`] writes a page that plays a run in a browser.

mod base64;
mod history;
mod msh;
mod outline;
mod output;
mod replay;
mod rigid_lines;
mod scene;
mod still;
mod stress;
mod vtu;

pub use history::{History, HistoryError};
pub use msh::{MshError, MshMesh, MshPlace, NamedCells, NamedNodes};
#[cfg(feature = "json")]
pub use outline::outlines_from_json;
pub use outline::{Outline, OutlineError};
#[cfg(feature = "svg")]
pub use outline::{SvgOptions, outlines_from_svg};
pub use output::OutputError;
pub use replay::Replay;
pub use scene::Scene;
pub use still::{still, write_still};
#[cfg(feature = "png")]
pub use still::{still_png, write_still_png};
pub use vtu::{VtuEncoding, VtuSeries, write_vtu};
