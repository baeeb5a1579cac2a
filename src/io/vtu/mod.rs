//! Results for ParaView and other programs that read VTK's files.
//!
//! A [`VtuSeries`] writes the flexible bodies, the rigid ones and the contacts of every recorded step to files of their own, and an index
//! (`.pvd`) that says at what time each of them is. What stands in them, all in the world's axes:
//!
//! | file | at its points | at its cells |
//! |---|---|---|
//! | `…_flexible_000000.vtu`, a piece for each body | `displacement` (m), `velocity` (m/s), `cauchy_stress` (Pa), `von_mises` (Pa), `contact_force` (N), `reaction` (N), `node` | `body`, its index in the set |
//! | `…_rigid_000000.vtu`, a piece for each collider | `velocity` (m/s) | `collider`, its index; `contact_force` on all of it (N) |
//! | `…_contacts_000000.vtu`, a vertex for each contact | `force` on the contactor (N), `normal`, `gap` (m) | |

mod pieces;
mod series;
mod xml;

pub use series::VtuSeries;

use super::output::{OutputError, write};
use crate::body::FlexBody;
use std::path::Path;

/// How the numbers of a file are written. None is compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VtuEncoding {
    /// As text, with all digits.
    Ascii,
    /// As base64, within the XML.
    Base64,
    /// As bytes, behind the XML: the smallest and the fastest.
    #[default]
    Appended,
}

/// Writes one flexible body as it is, with the stress and the forces of the last step.
///
/// # Errors
/// If the file cannot be written, or an element cannot evaluate its strain.
///
/// ```no_run
/// # use foil2d::prelude::*;
/// # use foil2d::io::{VtuEncoding, write_vtu};
/// # fn save(body: &FlexBody) -> Result<(), foil2d::io::OutputError> {
/// write_vtu("out/beam.vtu", body, VtuEncoding::Ascii)
/// # }
/// ```
pub fn write_vtu(
    path: impl AsRef<Path>,
    body: &FlexBody,
    encoding: VtuEncoding,
) -> Result<(), OutputError> {
    let piece = pieces::flexible(body, 0)?;
    write(path.as_ref().to_owned(), &xml::document(&[piece], encoding))
}
