//! Interior points of a polygon mesh: an equilateral lattice, `x = (i + (j mod 2) / 2) h`,
//! `y = j h sqrt(3) / 2`, kept clear of the boundary.
//!
//! Delaunay refinement alone spreads its points unevenly. Starting from the lattice, most triangles
//! are equilateral and refinement works on the rim only.

use std::ops::Range;

use super::outline::crossing_abscissa;
use crate::fe::mesh::geometry::{bounds, distance_to_segment};

/// Distance kept from the boundary, as a fraction of the spacing. More than one half, so that no
/// point lies in the diametral circle of a boundary segment, which would make refinement split it.
const CLEARANCE: f64 = 0.6;

/// Points of the lattice inside a closed boundary.
///
/// - `points`: ends of the boundary segments (m).
/// - `segments`: all around, none longer than `spacing`.
/// - `spacing`: side of the lattice triangles (m).
pub(super) fn lattice(points: &[[f64; 2]], segments: &[[usize; 2]], spacing: f64) -> Vec<[f64; 2]> {
    let [low, high] = bounds(points.iter().copied());
    let rows = Rows {
        low,
        spacing,
        rise: 0.5 * 3.0_f64.sqrt() * spacing,
    };
    let n_rows = ((high[1] - low[1]) / rows.rise).ceil() as usize;
    let mut near = vec![Vec::new(); n_rows];
    for &[a, b] in segments {
        let segment = [points[a], points[b]];
        for row in rows.reached_by(segment, n_rows) {
            near[row].push(segment);
        }
    }
    let mut inside = Vec::new();
    for (row, near) in near.iter().enumerate() {
        rows.fill(row, near, &mut inside);
    }
    inside
}

type Segment = [[f64; 2]; 2];

/// Rows of the lattice, from bottom to top; every other one is shifted by half a spacing.
struct Rows {
    /// Lower corner of the bounding box (m).
    low: [f64; 2],
    spacing: f64,
    /// Distance of the rows (m).
    rise: f64,
}

impl Rows {
    fn point(&self, row: usize, column: usize) -> [f64; 2] {
        // half a row off the lowest point, as horizontal sides are common
        let y = self.low[1] + (row as f64 + 0.5) * self.rise;
        [self.start(row) + column as f64 * self.spacing, y]
    }

    fn start(&self, row: usize) -> f64 {
        self.low[0] + 0.5 * (row % 2) as f64 * self.spacing
    }

    fn clearance(&self) -> f64 {
        CLEARANCE * self.spacing
    }

    /// Rows that a segment comes close to, or crosses.
    fn reached_by(&self, [a, b]: Segment, n_rows: usize) -> Range<usize> {
        let position = |y: f64| (y - self.low[1]) / self.rise - 0.5;
        let lowest = position(a[1].min(b[1]) - self.clearance()).ceil();
        let highest = position(a[1].max(b[1]) + self.clearance()).floor();
        // casts take what lies below the first row to it
        lowest as usize..((highest + 1.0) as usize).min(n_rows)
    }

    /// Columns of a row between two abscissas (m).
    fn columns(&self, row: usize, from: f64, to: f64) -> Range<usize> {
        let position = |x: f64| (x - self.start(row)) / self.spacing;
        position(from).ceil() as usize..(position(to).floor() + 1.0) as usize
    }

    /// Appends the points of a row that lie inside and clear of the segments near it.
    fn fill(&self, row: usize, near: &[Segment], inside: &mut Vec<[f64; 2]>) {
        let clearance = self.clearance();
        let mut blocked = Vec::new();
        let mut crossings = Vec::new();
        for &[a, b] in near {
            let (left, right) = (a[0].min(b[0]), a[0].max(b[0]));
            let columns = self.columns(row, left - clearance, right + clearance);
            blocked.extend(
                columns.filter(|&column| {
                    distance_to_segment(self.point(row, column), a, b) < clearance
                }),
            );
            crossings.extend(crossing_abscissa(a, b, self.point(row, 0)[1]));
        }
        blocked.sort_unstable();
        crossings.sort_unstable_by(f64::total_cmp);
        // the boundary is closed, so crossings come in pairs with the inside between
        for pair in crossings.chunks_exact(2) {
            let columns = self.columns(row, pair[0], pair[1]);
            let free = columns.filter(|column| blocked.binary_search(column).is_err());
            inside.extend(free.map(|column| self.point(row, column)));
        }
    }
}
