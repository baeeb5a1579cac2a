//! Shape of the cells: a perfect cell has aspect 1 and scaled Jacobian 1.

use super::geometry::{cross, distance, dot, lerp, nodal_jacobians, polygon_area, sub};
use super::{Cell, CellKind, Mesh};

/// Measures of the shape of the cells of a mesh.
///
/// Angles, aspect and edges are those of the straight-sided cell between the corners. The definitions
/// are those of the Verdict library (Stimpson et al., SAND2007-1751), with this addition for
/// [`CellKind::Tri6`]: the scaled Jacobian is multiplied by the ratio of the least to the largest
/// Jacobian at its nodes, which is 1 for straight sides with the nodes in the middle; that of
/// [`CellKind::Quad8`] by the same of their ratios to those of the straight-sided cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Smallest angle at any corner (deg).
    pub min_angle: f64,
    /// Largest aspect: longest side times perimeter over the area, scaled so that equilateral
    /// triangles and squares have 1.
    pub max_aspect: f64,
    /// Smallest scaled Jacobian: the sine of the corner angles, scaled so that equilateral triangles
    /// and rectangles have 1.
    pub min_scaled_jacobian: f64,
    /// Mean over the cells of the scaled Jacobian.
    pub mean_scaled_jacobian: f64,
    /// Shortest side between two corners (m).
    pub min_edge: f64,
    /// Longest side between two corners (m).
    pub max_edge: f64,
}

impl Quality {
    pub(super) fn measure(mesh: &Mesh) -> Self {
        let mut quality = Self {
            min_angle: 180.0,
            max_aspect: 0.0,
            min_scaled_jacobian: f64::INFINITY,
            mean_scaled_jacobian: 0.0,
            min_edge: f64::INFINITY,
            max_edge: 0.0,
        };
        for cell in mesh.cells() {
            quality.add(cell, &cell.points(mesh.nodes()));
        }
        quality.mean_scaled_jacobian /= mesh.n_cells() as f64;
        quality
    }

    /// Takes in one cell, summing its scaled Jacobian.
    fn add(&mut self, cell: Cell<'_>, points: &[[f64; 2]; 8]) {
        let n = cell.kind.n_corners();
        let corners = &points[..n];
        let (mut perimeter, mut longest, mut scaled) = (0.0, 0.0_f64, f64::INFINITY);
        for corner in 0..n {
            let forward = sub(corners[(corner + 1) % n], corners[corner]);
            let backward = sub(corners[(corner + n - 1) % n], corners[corner]);
            let edge = distance(forward, [0.0; 2]);
            let lengths = edge * distance(backward, [0.0; 2]);
            let (sine, cosine) = (cross(forward, backward), dot(forward, backward));
            self.min_angle = self.min_angle.min(sine.atan2(cosine).to_degrees());
            self.min_edge = self.min_edge.min(edge);
            scaled = scaled.min(sine / lengths);
            longest = longest.max(edge);
            perimeter += edge;
        }
        self.max_edge = self.max_edge.max(longest);
        let ideal_aspect = if n == 3 { 4.0 * 3.0_f64.sqrt() } else { 4.0 };
        let aspect = longest * perimeter / (ideal_aspect * polygon_area(corners));
        self.max_aspect = self.max_aspect.max(aspect);
        if n == 3 {
            scaled *= 2.0 / 3.0_f64.sqrt();
        }
        if cell.kind == CellKind::Tri6 {
            let jacobians = nodal_jacobians(cell.kind, points);
            let jacobians = &jacobians[..cell.kind.n_nodes()];
            let least = jacobians.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = jacobians.iter().copied().fold(0.0, f64::max);
            scaled *= least / largest;
        }
        if cell.kind == CellKind::Quad8 {
            let mut straight = *points;
            for side in cell.kind.edges() {
                if let Some(midside) = side.midside {
                    straight[midside] = lerp(points[side.from], points[side.to], 0.5);
                }
            }
            let [own, flat] = [points, &straight].map(|at| nodal_jacobians(cell.kind, at));
            let ratios = own.iter().zip(flat).map(|(own, flat)| own / flat);
            let least = ratios.clone().fold(f64::INFINITY, f64::min);
            scaled *= least / ratios.fold(0.0, f64::max);
        }
        self.min_scaled_jacobian = self.min_scaled_jacobian.min(scaled);
        self.mean_scaled_jacobian += scaled;
    }
}
