//! Generators: rectangles, discs and annuli with structured cells, polygons by Delaunay refinement.
//!
//! All of them are deterministic, check their arguments and give a checked [`Mesh`](super::Mesh).

mod annulus;
mod disc;
mod lattice;
mod outline;
mod polygon;
mod rectangle;

pub use annulus::{annulus, annulus_divided};
pub use disc::disc;
pub use polygon::{PolygonOptions, polygon};
pub use rectangle::rectangle;

use super::MeshError;
use super::geometry::length;
use crate::math::{cos, sin};

/// Largest number of nodes of a structured mesh: a slip in a unit should not exhaust the memory.
const NODE_LIMIT: usize = 4_000_000;

fn check_positive(name: &'static str, value: f64) -> Result<(), MeshError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(MeshError::InvalidArgument {
        name,
        value,
        requirement: "positive and finite",
    })
}

fn check_divisions(name: &'static str, value: usize, least: usize) -> Result<(), MeshError> {
    if value >= least {
        return Ok(());
    }
    Err(MeshError::InvalidArgument {
        name,
        value: value as f64,
        requirement: if least == 1 {
            "at least 1"
        } else {
            "at least 3"
        },
    })
}

/// Takes an estimate in floating point, since a tiny target edge overflows integers.
fn check_size(n_nodes: f64, limit: usize) -> Result<(), MeshError> {
    if n_nodes <= limit as f64 {
        return Ok(());
    }
    Err(MeshError::TooManyNodes {
        // saturates, which is good enough for a message
        n_nodes: n_nodes as usize,
        limit,
    })
}

/// Splits a counter-clockwise quadrilateral along 0-2, or along 1-3 if `flipped`.
fn split([a, b, c, d]: [usize; 4], flipped: bool) -> [[usize; 3]; 2] {
    if flipped {
        [[a, b, d], [b, c, d]]
    } else {
        [[a, b, c], [a, c, d]]
    }
}

/// Point half-way between two points in polar coordinates (m): mean radius, bisected angle.
fn polar_midpoint(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let (radius_a, radius_b) = (length(a), length(b));
    let direction = [0, 1].map(|axis| a[axis] / radius_a + b[axis] / radius_b);
    let scale = 0.5 * (radius_a + radius_b) / length(direction);
    [scale * direction[0], scale * direction[1]]
}

/// Point at a radius (m) and an angle (rad).
fn polar(radius: f64, angle: f64) -> [f64; 2] {
    [radius * cos(angle), radius * sin(angle)]
}
