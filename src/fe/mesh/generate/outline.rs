//! Checks of an outline with holes: simple rings, apart from each other, holes inside.

use crate::fe::mesh::MeshError;
use crate::fe::mesh::crossing;
use crate::fe::mesh::geometry::{distance, polygon_area, tolerance};

/// The outline, counter-clockwise, followed by the holes, clockwise, as [`MeshError`] counts rings.
///
/// # Errors
/// The first thing found wrong with them.
pub(super) fn oriented_rings(
    outline: &[[f64; 2]],
    holes: &[Vec<[f64; 2]>],
) -> Result<Vec<Vec<[f64; 2]>>, MeshError> {
    let mut rings = vec![outline.to_vec()];
    rings.extend_from_slice(holes);
    for (index, ring) in rings.iter().enumerate() {
        check_points(index, ring)?;
    }
    check_simple(&rings)?;
    check_nesting(&rings)?;
    for (index, ring) in rings.iter_mut().enumerate() {
        let is_outline = index == 0;
        if (polygon_area(ring) > 0.0) != is_outline {
            ring.reverse();
        }
    }
    Ok(rings)
}

fn check_points(ring: usize, points: &[[f64; 2]]) -> Result<(), MeshError> {
    if points.len() < 3 {
        return Err(MeshError::TooFewPoints {
            ring,
            n_points: points.len(),
        });
    }
    for (point, &at) in points.iter().enumerate() {
        if !at.iter().all(|x| x.is_finite()) {
            return Err(MeshError::NonFinitePoint { ring, point, at });
        }
    }
    let closest = tolerance(points.iter().copied());
    let n = points.len();
    match (0..n).find(|&i| distance(points[i], points[(i + 1) % n]) <= closest) {
        Some(before) => Err(MeshError::RepeatedPoint {
            ring,
            point: (before + 1) % n,
        }),
        None => Ok(()),
    }
}

fn check_simple(rings: &[Vec<[f64; 2]>]) -> Result<(), MeshError> {
    let points: Vec<[f64; 2]> = rings.iter().flatten().copied().collect();
    let mut segments = Vec::with_capacity(points.len());
    let mut owners = Vec::with_capacity(points.len());
    for (index, ring) in rings.iter().enumerate() {
        let (start, n) = (segments.len(), ring.len());
        segments.extend((0..n).map(|i| [start + i, start + (i + 1) % n]));
        owners.extend((0..n).map(|edge| (index, edge)));
    }
    let closest = tolerance(points.iter().copied());
    match crossing::find_crossing(&points, &segments, closest) {
        Some(found) => Err(MeshError::OutlineCrossing {
            rings: [owners[found.first].0, owners[found.second].0],
            edges: [owners[found.first].1, owners[found.second].1],
            at: found.at,
        }),
        None => Ok(()),
    }
}

/// Rings that do not meet lie inside or outside each other as a whole, so one point tells.
fn check_nesting(rings: &[Vec<[f64; 2]>]) -> Result<(), MeshError> {
    let holes = &rings[1..];
    for (hole, ring) in holes.iter().enumerate() {
        if !contains(&rings[0], ring[0]) {
            return Err(MeshError::HoleOutside { hole });
        }
        for (outer, other) in holes.iter().enumerate() {
            if outer != hole && contains(other, ring[0]) {
                return Err(MeshError::NestedHole { inner: hole, outer });
            }
        }
    }
    Ok(())
}

/// Whether a point, not on the ring, lies inside it: a ray to the right crosses it an odd number of
/// times.
fn contains(ring: &[[f64; 2]], point: [f64; 2]) -> bool {
    let n = ring.len();
    let crossings = (0..n).filter(|&i| {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        crossing_abscissa(a, b, point[1]).is_some_and(|x| x > point[0])
    });
    crossings.count() % 2 == 1
}

/// Where an edge crosses the line at height `y` (m); the lower end counts as above the line, so that
/// an end on the line is counted once.
pub(super) fn crossing_abscissa(a: [f64; 2], b: [f64; 2], y: f64) -> Option<f64> {
    let crosses = (a[1] > y) != (b[1] > y);
    crosses.then(|| a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
}
