//! Annulus `r_i <= r <= r_o` about the origin, in even polar steps.

use std::f64::consts::TAU;

use super::{
    NODE_LIMIT, check_divisions, check_positive, check_size, polar, polar_midpoint, split,
};
use crate::fe::mesh::{CellKind, Mesh, MeshError};

/// Meshes an annulus about the origin with cells of about `target_edge` at its mean radius.
///
/// Numbering and errors are those of [`annulus_divided`].
///
/// - `inner`, `outer`: radii (m).
/// - `target_edge`: length of an edge between corners (m).
pub fn annulus(
    inner: f64,
    outer: f64,
    target_edge: f64,
    kind: CellKind,
) -> Result<Mesh, MeshError> {
    check_positive("annulus target edge", target_edge)?;
    check_radii(inner, outer)?;
    let around = (0.5 * TAU * (inner + outer) / target_edge).round().max(6.0);
    let through = ((outer - inner) / target_edge).round().max(1.0);
    check_size(around * (through + 1.0), NODE_LIMIT)?;
    annulus_divided(inner, outer, [around as usize, through as usize], kind)
}

/// Meshes an annulus about the origin with given numbers of cells.
///
/// Node `l n + p`, with `n` the divisions around, lies at the angle `2 pi p / n` on layer `l`, the
/// inner circle being layer 0. Quadrilateral `l n + p` reaches from that node outward and on;
/// triangles halve the quadrilaterals by alternating diagonals. Corners lie on the circles; so do the
/// midside nodes of [`CellKind::Tri6`] and [`CellKind::Quad8`] between neighbours on a circle, and its other midside nodes
/// lie half-way in polar coordinates.
///
/// - `inner`, `outer`: radii (m).
/// - `divisions`: cells around (at least 3) and through the thickness (at least 1).
///
/// # Errors
/// [`MeshError::InvalidArgument`] unless `0 < inner < outer` and the divisions suffice,
/// [`MeshError::TooManyNodes`], and [`MeshError::FoldedCell`] for curved cells much longer than thick.
pub fn annulus_divided(
    inner: f64,
    outer: f64,
    divisions: [usize; 2],
    kind: CellKind,
) -> Result<Mesh, MeshError> {
    check_radii(inner, outer)?;
    check_divisions("annulus divisions around", divisions[0], 3)?;
    check_divisions("annulus divisions through", divisions[1], 1)?;
    let [around, through] = divisions;
    check_size(around as f64 * (through as f64 + 1.0), NODE_LIMIT)?;

    let nodes = (0..=through).flat_map(|layer| {
        let t = layer as f64 / through as f64;
        let radius = inner * (1.0 - t) + outer * t;
        (0..around).map(move |p| polar(radius, TAU * p as f64 / around as f64))
    });
    let nodes: Vec<[f64; 2]> = nodes.collect();
    let quads = (0..through).flat_map(|layer| {
        (0..around).map(move |p| {
            let (here, ahead) = (layer * around + p, layer * around + (p + 1) % around);
            (
                [here, here + around, ahead + around, ahead],
                (layer + p) % 2 == 1,
            )
        })
    });
    let mesh = if kind.n_corners() == 4 {
        let cells: Vec<[usize; 4]> = quads.map(|(quad, _)| quad).collect();
        Mesh::from_cells(nodes, CellKind::Quad4, &cells)?
    } else {
        let cells = quads.flat_map(|(quad, flipped)| split(quad, flipped));
        let cells: Vec<[usize; 3]> = cells.collect();
        Mesh::from_cells(nodes, CellKind::Tri3, &cells)?
    };
    if !kind.is_quadratic() {
        return Ok(mesh);
    }
    mesh.to_quadratic_with(|a, b| polar_midpoint(mesh.nodes()[a], mesh.nodes()[b]))
}

fn check_radii(inner: f64, outer: f64) -> Result<(), MeshError> {
    check_positive("annulus inner radius", inner)?;
    check_positive("annulus outer radius", outer)?;
    if inner < outer {
        return Ok(());
    }
    Err(MeshError::InvalidArgument {
        name: "annulus inner radius",
        value: inner,
        requirement: "less than the outer radius",
    })
}
