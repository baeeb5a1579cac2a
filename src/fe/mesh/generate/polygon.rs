//! Polygons with holes by constrained Delaunay refinement: every triangle keeps
//! `R / l_min <= 1 / (2 sin alpha_min)`, with `R` its circumradius and `l_min` its shortest side.
//!
//! Ruppert, J. Algorithms 18 (1995) 548–585, as implemented by the crate `spade`.

use crate::math::rounding;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, InsertionError, Point2, RefinementParameters,
    Triangulation,
};

use super::lattice::lattice;
use super::outline::oriented_rings;
use super::{check_positive, check_size};
use crate::fe::mesh::geometry::{bounds, distance, lerp, polygon_area};
use crate::fe::mesh::{CellKind, Mesh, MeshError};

type Triangles = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Largest area of a triangle, in units of the equilateral triangle on the target edge. Refinement
/// halves sides of the outline without need below 1.5, and leaves edges of 1.8 target edges at 2.
const AREA_LIMIT: f64 = 1.6;

/// Size and quality of the triangles of [`polygon`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolygonOptions {
    /// Length of an edge (m): sides of the outline are divided into equal parts no longer than this.
    pub target_edge: f64,
    /// Smallest angle of a triangle (deg), from 0 to 30. It is kept where no corner of the outline is
    /// sharper than 60 deg; near sharper ones some triangles stay below, see [`Mesh::quality`].
    pub min_angle: f64,
    /// Largest number of nodes.
    pub max_nodes: usize,
}

impl PolygonOptions {
    /// Triangles with edges of about `target_edge` (m), angles of at least 25 deg and at most
    /// 200 000 nodes.
    pub const fn new(target_edge: f64) -> Self {
        Self {
            target_edge,
            min_angle: 25.0,
            max_nodes: 200_000,
        }
    }

    fn check(&self) -> Result<(), MeshError> {
        check_positive("polygon target edge", self.target_edge)?;
        if (0.0..=30.0).contains(&self.min_angle) {
            return Ok(());
        }
        Err(MeshError::InvalidArgument {
            name: "polygon minimum angle",
            value: self.min_angle,
            requirement: "from 0 to 30 deg: refinement does not finish for more",
        })
    }
}

/// Meshes a polygon with holes by triangles of three nodes.
///
/// The points of the outline and of the holes become nodes, and so do points that divide its sides
/// evenly; refinement halves some of the parts where sides lie close together. Inside, edges are
/// mostly as long as the target edge and at most about 1.75 times as long. Nodes on the boundary
/// come first: outline, then holes, in the order given (reversed where the orientation is), then
/// those of the interior and of refinement.
///
/// - `outline`: corners (m), in either orientation, the first one not repeated.
/// - `holes`: corners of each hole (m), likewise.
///
/// # Errors
/// [`MeshError`] names the point, edge or hole that is wrong; [`MeshError::TooManyNodes`] and
/// [`MeshError::RefinementIncomplete`] tell that the options do not suit the polygon.
///
/// # Example
/// ```
/// # use foil2d::fe::mesh::generate::{PolygonOptions, polygon};
/// let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
/// let hole = vec![[0.9, 0.4], [1.1, 0.4], [1.0, 0.6]];
/// let mesh = polygon(&outline, &[hole], &PolygonOptions::new(0.1))?;
/// assert_eq!(mesh.boundary().loops().len(), 2);
/// assert!(mesh.quality().min_angle >= 25.0);
/// # Ok::<(), foil2d::fe::mesh::MeshError>(())
/// ```
pub fn polygon(
    outline: &[[f64; 2]],
    holes: &[Vec<[f64; 2]>],
    options: &PolygonOptions,
) -> Result<Mesh, MeshError> {
    options.check()?;
    let rings = oriented_rings(outline, holes)?;
    check_size(
        estimated_nodes(&rings, options.target_edge),
        options.max_nodes,
    )?;
    let (mut points, segments) = divide_sides(&rings, options.target_edge);
    points.extend(lattice(&points, &segments, options.target_edge));
    points.extend(frame(&points));

    let points: Vec<Point2<f64>> = points.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    let mut triangles = triangulate(points, segments)?;
    let n_spare = options.max_nodes.saturating_sub(triangles.num_vertices());
    let refined = triangles.refine(
        RefinementParameters::new()
            .exclude_outer_faces(true)
            .with_angle_limit(AngleLimit::from_deg(options.min_angle))
            .with_max_allowed_area(AREA_LIMIT * equilateral_area(options.target_edge))
            .with_max_additional_vertices(n_spare),
    );
    if !refined.refinement_complete {
        return Err(MeshError::RefinementIncomplete {
            limit: options.max_nodes,
            min_angle: options.min_angle,
        });
    }
    let mut is_outside = vec![false; triangles.num_all_faces()];
    for face in refined.excluded_faces {
        is_outside[face.index()] = true;
    }
    collect_mesh(&triangles, &is_outside)
}

fn equilateral_area(edge: f64) -> f64 {
    0.25 * 3.0_f64.sqrt() * edge * edge
}

/// Boundary nodes from the perimeter plus interior nodes from the area, two triangles for each.
fn estimated_nodes(rings: &[Vec<[f64; 2]>], edge: f64) -> f64 {
    let area: f64 = rings.iter().map(|ring| polygon_area(ring)).sum();
    let on_boundary: f64 = sides(rings).map(|(a, b)| n_parts(a, b, edge)).sum();
    on_boundary + 0.5 * area / equilateral_area(edge)
}

fn sides(rings: &[Vec<[f64; 2]>]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    rings.iter().flat_map(|ring| {
        let n = ring.len();
        (0..n).map(move |i| (ring[i], ring[(i + 1) % n]))
    })
}

/// Number of parts of a side; a part may exceed the target edge by rounding.
fn n_parts(a: [f64; 2], b: [f64; 2], edge: f64) -> f64 {
    (distance(a, b) / edge * (1.0 - rounding::SHARE))
        .ceil()
        .max(1.0)
}

/// Points of the rings with each side divided evenly, and the segments between them.
fn divide_sides(rings: &[Vec<[f64; 2]>], edge: f64) -> (Vec<[f64; 2]>, Vec<[usize; 2]>) {
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    for ring in rings {
        let start = points.len();
        for (a, b) in sides(std::slice::from_ref(ring)) {
            let n = n_parts(a, b, edge);
            points.extend((0..n as usize).map(|part| lerp(a, b, part as f64 / n)));
        }
        segments.extend((start..points.len()).map(|point| [point, point + 1]));
        if let Some(last) = segments.last_mut() {
            last[1] = start;
        }
    }
    (points, segments)
}

/// Corners of a box around all points, twice as large.
///
/// Divided sides are straight up to rounding only. Where they are hollow by that much, the convex hull
/// would bridge them with flat triangles, and the refinement does not split a segment next to such
/// a one. The corners take their place: flat triangles have huge circumcircles, which contain them.
fn frame(points: &[[f64; 2]]) -> [[f64; 2]; 4] {
    let [low, high] = bounds(points.iter().copied());
    let margin = 0.5 * distance(low, high);
    let (x, y) = (
        [low[0] - margin, high[0] + margin],
        [low[1] - margin, high[1] + margin],
    );
    [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

fn triangulate(
    points: Vec<Point2<f64>>,
    segments: Vec<[usize; 2]>,
) -> Result<Triangles, MeshError> {
    let n_points = points.len();
    let refuse = |reason: String| MeshError::Triangulation { reason };
    let mut n_conflicts = 0;
    let triangles = Triangles::try_bulk_load_cdt(points, segments, |_| n_conflicts += 1)
        .map_err(|error: InsertionError| refuse(error.to_string()))?;
    if n_conflicts > 0 || triangles.num_vertices() != n_points {
        return Err(refuse(format!(
            "{n_conflicts} sides cross and {} points coincide within rounding",
            n_points - triangles.num_vertices()
        )));
    }
    Ok(triangles)
}

/// Keeps the faces inside and the vertices they use.
fn collect_mesh(triangles: &Triangles, is_outside: &[bool]) -> Result<Mesh, MeshError> {
    let mut cells: Vec<[usize; 3]> = triangles
        .inner_faces()
        .filter(|face| !is_outside[face.index()])
        .map(|face| face.vertices().map(|vertex| vertex.index()))
        .collect();
    let mut is_used = vec![false; triangles.num_vertices()];
    cells
        .iter()
        .flatten()
        .for_each(|&node| is_used[node] = true);

    let mut number = vec![0; is_used.len()];
    let mut nodes = Vec::with_capacity(is_used.len());
    for vertex in triangles
        .vertices()
        .filter(|vertex| is_used[vertex.index()])
    {
        number[vertex.index()] = nodes.len();
        let at = vertex.position();
        nodes.push([at.x, at.y]);
    }
    for node in cells.iter_mut().flatten() {
        *node = number[*node];
    }
    Mesh::from_cells(nodes, CellKind::Tri3, &cells)
}
