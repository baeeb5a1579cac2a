//! Stress from displacement: principal values, von Mises, and smoothing from quadrature points to nodes.
//!
//! Nodal stress is `sum_c A_c s_c(x_a) / sum_c A_c` over the cells c around node a, where `s_c` is the
//! least-squares polynomial through the stresses at the cell's quadrature points.

use super::element::{Element, ElementError, MAX_NODES, MAX_POINTS};
use super::material::Material;
use crate::math::{atan2, hypot, rounding, sin_cos};

/// The stress at a point (Pa).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    /// Normal stress along x (Pa), positive in tension.
    pub xx: f64,
    /// Normal stress along y (Pa).
    pub yy: f64,
    /// In-plane shear stress (Pa).
    pub xy: f64,
    /// Normal stress across the plane (Pa): zero in plane stress.
    pub zz: f64,
}

impl Stress {
    /// The stress of a material at a strain `[e_xx, e_yy, g_xy]` (-).
    pub fn of(material: &dyn Material, strain: [f64; 3]) -> Self {
        let [xx, yy, xy] = material.stress(strain);
        let zz = material.out_of_plane_stress(strain);
        Self { xx, yy, xy, zz }
    }

    /// The same with a pressure (Pa) added, tension positive.
    pub(super) fn under(self, pressure: f64) -> Self {
        Self {
            xx: self.xx + pressure,
            yy: self.yy + pressure,
            zz: self.zz + pressure,
            ..self
        }
    }

    /// The von Mises stress (Pa), `sqrt(3/2 s:s)` with s the deviator, all four components counted.
    pub fn von_mises(&self) -> f64 {
        let square = |x: f64| x * x;
        let normal =
            square(self.xx - self.yy) + square(self.yy - self.zz) + square(self.zz - self.xx);
        (0.5 * normal + 3.0 * square(self.xy)).sqrt()
    }

    /// The in-plane principal stresses `(s1, s2, angle)`: s1 >= s2 (Pa), and the angle (rad) from x to s1.
    ///
    /// The angle lies in (-pi/2, pi/2] and is 0 where the two are equal.
    pub fn principal(&self) -> (f64, f64, f64) {
        let mean = 0.5 * (self.xx + self.yy);
        let half = 0.5 * (self.xx - self.yy);
        let radius = hypot(half, self.xy);
        (mean + radius, mean - radius, 0.5 * atan2(self.xy, half))
    }

    /// The same stress where its axes have turned by an angle (rad).
    pub fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = sin_cos(angle);
        let shear = 2.0 * sin * cos * self.xy;
        let (cos_2, sin_2) = (cos * cos, sin * sin);
        Self {
            xx: cos_2 * self.xx + sin_2 * self.yy - shear,
            yy: sin_2 * self.xx + cos_2 * self.yy + shear,
            xy: sin * cos * (self.xx - self.yy) + (cos_2 - sin_2) * self.xy,
            zz: self.zz,
        }
    }

    fn components(&self) -> [f64; 4] {
        [self.xx, self.yy, self.xy, self.zz]
    }

    fn add_scaled(&mut self, factor: f64, [xx, yy, xy, zz]: [f64; 4]) {
        self.xx += factor * xx;
        self.yy += factor * yy;
        self.xy += factor * xy;
        self.zz += factor * zz;
    }
}

/// How far a point is stretched along the axes: the left stretch tensor `V` of `F = V R`, in the world's axes, and the thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// `V_xx` (-), one at rest.
    pub xx: f64,
    /// `V_yy` (-).
    pub yy: f64,
    /// `V_xy` (-).
    pub xy: f64,
    /// Stretch of the thickness (-): one in plane strain.
    pub thickness: f64,
}

impl Stretch {
    /// That of a gradient of deformation `[F_xx, F_xy, F_yx, F_yy]` (-), with a stretch of the thickness (-).
    ///
    /// With `b = F Fᵀ` it is `V = (b + |J| I)/√(tr b + 2 |J|)`; of a point that is turned inside out that of its mirror image.
    pub fn of_gradient([xx, xy, yx, yy]: [f64; 4], thickness: f64) -> Self {
        let area = (xx * yy - xy * yx).abs();
        let (b_xx, b_yy) = (xx * xx + xy * xy, yx * yx + yy * yy);
        let scale = (b_xx + b_yy + 2.0 * area).sqrt().max(f64::MIN_POSITIVE);
        Self {
            xx: (b_xx + area) / scale,
            yy: (b_yy + area) / scale,
            xy: (xx * yx + xy * yy) / scale,
            thickness,
        }
    }

    /// The principal stretches in the plane `(l1, l2, angle)`: l1 >= l2 (-), and the angle (rad) from x to l1, in (-pi/2, pi/2].
    pub fn principal(&self) -> (f64, f64, f64) {
        self.as_stress().principal()
    }

    /// Volume over that at rest (-).
    pub fn volume(&self) -> f64 {
        (self.xx * self.yy - self.xy * self.xy) * self.thickness
    }

    /// The same components, as smoothing takes them.
    pub(crate) fn as_stress(&self) -> Stress {
        Stress {
            xx: self.xx,
            yy: self.yy,
            xy: self.xy,
            zz: self.thickness,
        }
    }

    pub(crate) fn from_stress(Stress { xx, yy, xy, zz }: Stress) -> Self {
        Self {
            xx,
            yy,
            xy,
            thickness: zz,
        }
    }
}

/// What a quadrature point of a body bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointState {
    /// The gradient of deformation `[F_xx, F_xy, F_yx, F_yy]` (-); the first index is of the world as it is, the second of the undeformed
    /// body where it was built.
    pub gradient: [f64; 4],
    /// How far it is stretched.
    pub stretch: Stretch,
    /// Cauchy's stress (Pa), in the world's axes.
    pub stress: Stress,
}

/// Writes the stresses (Pa) at the element's stiffness quadrature points, shape `(n_points)`.
///
/// `displacement` (m) is that of the cell's nodes, interleaved, shape `(2n)`.
///
/// # Errors
/// An inverted cell; see [`ElementError`].
pub fn point_stresses(
    element: &dyn Element,
    nodes: &[[f64; 2]],
    material: &dyn Material,
    displacement: &[f64],
    stresses: &mut [Stress],
) -> Result<(), ElementError> {
    assert_eq!(
        stresses.len(),
        element.quadrature().len(),
        "one stress per quadrature point"
    );
    assert!(
        stresses.len() <= MAX_POINTS,
        "an element has at most {MAX_POINTS} quadrature points"
    );
    let mut buffer = [[0.0; 3]; MAX_POINTS];
    let strains = &mut buffer[..stresses.len()];
    element.point_strains(nodes, material, displacement, strains)?;
    for (stress, &mut strain) in stresses.iter_mut().zip(strains) {
        *stress = Stress::of(material, strain);
    }
    Ok(())
}

/// The stresses of one cell, as [`smooth_to_nodes`] takes them.
#[derive(Clone, Copy, Debug)]
pub struct CellStress<'a> {
    /// The cell's nodes, by their numbers in the mesh.
    pub nodes: &'a [usize],
    /// The cell's element.
    pub element: &'a dyn Element,
    /// The stresses (Pa) at the element's quadrature points.
    pub stresses: &'a [Stress],
    /// The cell's say in the average at its nodes: its area (m^2).
    pub weight: f64,
}

/// Writes smoothed nodal stresses (Pa): extrapolated in each cell, then averaged over cells by weight.
///
/// Cells with one point give a constant, with four corners and four or more points a bilinear function of
/// natural coordinates, otherwise a linear one. Nodes of no cell get zero.
///
/// - `weights`: scratch, shape `(n_nodes)`, left holding the weight around each node (m^2).
/// - `nodal`: overwritten, shape `(n_nodes)`.
///
/// # Panics
/// If slices disagree in length or a node is out of range.
pub fn smooth_to_nodes<'a>(
    cells: impl IntoIterator<Item = CellStress<'a>>,
    weights: &mut [f64],
    nodal: &mut [Stress],
) {
    assert_eq!(weights.len(), nodal.len(), "one weight per node");
    weights.fill(0.0);
    nodal.fill(Stress::default());
    let mut buffer = [Stress::default(); MAX_NODES];
    for cell in cells {
        let at_nodes = &mut buffer[..cell.nodes.len()];
        extrapolate(cell.element, cell.stresses, at_nodes);
        for (&node, stress) in cell.nodes.iter().zip(at_nodes) {
            nodal[node].add_scaled(cell.weight, stress.components());
            weights[node] += cell.weight;
        }
    }
    for (stress, &weight) in nodal.iter_mut().zip(weights.iter()) {
        if weight > 0.0 {
            let sum = stress.components();
            *stress = Stress::default();
            stress.add_scaled(1.0 / weight, sum);
        }
    }
}

/// Writes the stresses (Pa) at a cell's nodes from those at its quadrature points, by least squares.
///
/// # Panics
/// If there is not one stress per quadrature point and one output per node.
pub fn extrapolate(element: &dyn Element, points: &[Stress], at_nodes: &mut [Stress]) {
    let rule = element.quadrature();
    assert_eq!(points.len(), rule.len(), "one stress per quadrature point");
    assert_eq!(at_nodes.len(), element.n_nodes(), "one stress per node");
    let n_terms = match (points.len(), element.n_corners()) {
        (4.., 4) => 4,
        (3.., _) => 3,
        _ => 1,
    };
    // Normal equations (P^T P) c = P^T s, with terms 1, xi, eta, xi eta: well conditioned at this size.
    let mut normal = [[0.0; 4]; 4];
    let mut right = [[0.0; 4]; 4];
    for (point, stress) in rule.iter().zip(points) {
        let terms = polynomial(point.at);
        for row in 0..n_terms {
            for column in 0..n_terms {
                normal[row][column] += terms[row] * terms[column];
            }
            for (sum, part) in right[row].iter_mut().zip(stress.components()) {
                *sum += terms[row] * part;
            }
        }
    }
    solve_in_place(&mut normal, &mut right, n_terms);
    for (stress, &at) in at_nodes.iter_mut().zip(element.reference_nodes()) {
        *stress = Stress::default();
        for (term, coefficients) in polynomial(at).iter().zip(right).take(n_terms) {
            stress.add_scaled(*term, coefficients);
        }
    }
}

fn polynomial([xi, eta]: [f64; 2]) -> [f64; 4] {
    [1.0, xi, eta, xi * eta]
}

/// Gauss–Jordan elimination of the first `n` rows of a positive definite system, four right-hand sides at once.
///
/// A term the points cannot tell apart from earlier ones has no pivot left, and gets coefficient zero.
fn solve_in_place(matrix: &mut [[f64; 4]; 4], right: &mut [[f64; 4]; 4], n: usize) {
    let diagonal = [0, 1, 2, 3].map(|i| matrix[i][i]);
    for pivot in 0..n {
        let independent = matrix[pivot][pivot] > rounding::ITERATED * diagonal[pivot];
        let scale = if independent {
            1.0 / matrix[pivot][pivot]
        } else {
            0.0
        };
        matrix[pivot].iter_mut().for_each(|entry| *entry *= scale);
        right[pivot].iter_mut().for_each(|entry| *entry *= scale);
        let (pivot_row, pivot_right) = (matrix[pivot], right[pivot]);
        for row in (0..n).filter(|&row| row != pivot) {
            let factor = matrix[row][pivot];
            for column in 0..n {
                matrix[row][column] -= factor * pivot_row[column];
            }
            for column in 0..4 {
                right[row][column] -= factor * pivot_right[column];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fe::element::{Quad4, Tri3, Tri6};
    use crate::fe::material::LinearElastic;

    /// A stress as a function of natural coordinates.
    type Field = fn([f64; 2]) -> Stress;

    fn stress(xx: f64, yy: f64, xy: f64, zz: f64) -> Stress {
        Stress { xx, yy, xy, zz }
    }

    #[test]
    fn von_mises_is_the_pull_in_a_bar_and_root_three_times_a_pure_shear() {
        assert_eq!(stress(-5.0, 0.0, 0.0, 0.0).von_mises(), 5.0);
        let shear = stress(0.0, 0.0, 2.0, 0.0).von_mises();
        assert!((shear - 2.0 * 3f64.sqrt()).abs() < 1e-15);
        assert_eq!(
            stress(7.0, 7.0, 0.0, 7.0).von_mises(),
            0.0,
            "pressure alone"
        );
    }

    #[test]
    fn the_out_of_plane_stress_counts_in_plane_strain() {
        // Equal pulls p in plane strain: s_zz = 2 nu p, so von Mises is p (1 - 2 nu); in plane stress it is p.
        let strain = [0.01, 0.01, 0.0];
        let slice = LinearElastic::plane_strain(100.0, 0.3).density(1.0);
        let s = Stress::of(&slice, strain);
        assert!((s.von_mises() - 0.4 * s.xx).abs() < 1e-14);
        let sheet = LinearElastic::plane_stress(100.0, 0.3).density(1.0);
        let s = Stress::of(&sheet, strain);
        assert!((s.von_mises() - s.xx).abs() < 1e-14);
    }

    #[test]
    fn principal_stresses_rebuild_the_tensor() {
        for s in [
            stress(3.0, -1.0, 2.0, 0.0),
            stress(-4.0, 5.0, -0.5, 0.0),
            stress(0.0, 0.0, 1.0, 0.0),
            stress(-2.0, 1.0, 0.0, 0.0),
        ] {
            let (s1, s2, angle) = s.principal();
            let (sin, cos) = angle.sin_cos();
            assert!(s1 >= s2);
            assert!((s1 * cos * cos + s2 * sin * sin - s.xx).abs() < 1e-14);
            assert!((s1 * sin * sin + s2 * cos * cos - s.yy).abs() < 1e-14);
            assert!(((s1 - s2) * sin * cos - s.xy).abs() < 1e-14);
        }
        assert_eq!(stress(2.0, 2.0, 0.0, 0.0).principal(), (2.0, 2.0, 0.0));
    }

    #[test]
    fn extrapolation_is_exact_for_what_the_points_can_tell() {
        let constant: Field = |_| stress(1.0, 2.0, 3.0, 4.0);
        let linear: Field = |[x, y]| stress(1.0 + 2.0 * x - y, 3.0 * y, x - 0.5, 4.0);
        let bilinear: Field = |[x, y]| stress(x * y, 1.0 - x * y, x + y, x * y - y);
        let cases: [(&dyn Element, Field); 3] =
            [(&Tri3, constant), (&Tri6, linear), (&Quad4, bilinear)];
        for (element, field) in cases {
            let points: Vec<Stress> = element.quadrature().iter().map(|q| field(q.at)).collect();
            let mut at_nodes = vec![Stress::default(); element.n_nodes()];
            extrapolate(element, &points, &mut at_nodes);
            for (found, &at) in at_nodes.iter().zip(element.reference_nodes()) {
                let expected = field(at).components();
                for (a, b) in found.components().iter().zip(expected) {
                    assert!((a - b).abs() < 1e-13, "{}: {a} for {b}", element.name());
                }
            }
        }
    }

    #[test]
    fn smoothing_averages_by_weight_and_leaves_lone_nodes_at_zero() {
        let (one, four) = ([stress(1.0, 0.0, 0.0, 0.0)], [stress(4.0, 0.0, 0.0, 0.0)]);
        let cell = |nodes, stresses, weight| CellStress {
            nodes,
            element: &Tri3,
            stresses,
            weight,
        };
        let cells = [cell(&[0, 1, 2], &one, 1.0), cell(&[1, 3, 2], &four, 2.0)];
        let mut weights = [0.0; 5];
        let mut nodal = [stress(9.0, 9.0, 9.0, 9.0); 5];
        smooth_to_nodes(cells, &mut weights, &mut nodal);
        let xx = nodal.map(|s| s.xx);
        for (found, expected) in xx.iter().zip([1.0, 3.0, 3.0, 4.0, 0.0]) {
            assert!((found - expected).abs() < 1e-15, "{xx:?}");
        }
        assert_eq!(weights, [1.0, 3.0, 3.0, 2.0, 0.0]);
    }
}
