//! How far apart surfaces without thickness stay.

use super::FlexBody;
use crate::fe::model::Model;
use crate::math::{REAL_EPSILON, node_vec};

/// Offset between a flexible surface and what it touches, relative to its shortest edge at rest: far above rounding, far below what
/// the mesh resolves. Between two hundredths and a thousandth of an edge no result depends on it but by its own size.
const OFFSET: f64 = 1e-2;

/// Spacings of rapier's numbers, at the coordinates of the body, that an offset is never below: rapier holds poses in it.
const SPACINGS: f64 = 8.0;

/// The offset of a flexible body's surface, with the largest of its coordinates (m).
pub(crate) fn contact_offset(model: &Model, extent: f64) -> f64 {
    let spacing = SPACINGS * REAL_EPSILON * extent;
    (OFFSET * shortest_edge(model)).max(spacing)
}

/// Shortest boundary segment at rest (m).
fn shortest_edge(model: &Model) -> f64 {
    let rest = model.rest_positions();
    let segments = model.mesh().boundary().segments().iter();
    let lengths = segments.map(|[a, b]| (node_vec(rest, *b) - node_vec(rest, *a)).norm_squared());
    lengths.fold(f64::INFINITY, f64::min).sqrt()
}

impl FlexBody {
    /// Distance at which the surface closes with itself and with terrain that has no thickness (m): a hundredth of its shortest edge, more only where rapier's
    /// numbers hold no such distance. Other flexible bodies, and rigid ones with an inside, it touches; these are drawn inwards by as much for
    /// the path that keeps them apart.
    pub fn contact_offset(&self) -> f64 {
        let positions = self.positions();
        let extent = positions.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        contact_offset(self.model(), extent)
    }
}
