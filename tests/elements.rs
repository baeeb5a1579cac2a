//! Elements against textbook answers: conformance, bending, Cook's membrane, MacNeal and Harder's beam, orders.

#[path = "elements/support.rs"]
mod support;

use foil2d::fe::element::conformance::check_element;
use foil2d::fe::element::kinematics::physical_gradient;
use foil2d::fe::element::{
    Element, ElementError, Quad4, Quad8, QuadraturePoint, Tri3, Tri6, default_element,
};
use foil2d::fe::material::{LinearElastic, Material};
use foil2d::fe::recovery::{CellStress, Stress, point_stresses, smooth_to_nodes};
use std::f64::consts::PI;
use support::{GAUSS_4, Grid, QUAD4, TRI3, TRI6, fine_rule, gather, scatter};

#[test]
fn every_element_passes_the_conformance_suite() {
    assert_eq!(check_element(&Tri3), Ok(()));
    assert_eq!(check_element(&Tri6), Ok(()));
    assert_eq!(check_element(&Quad4), Ok(()));
    assert_eq!(check_element(&Quad8), Ok(()));
}

#[test]
fn the_default_elements_have_the_nodes_asked_for() {
    for n_nodes in [3, 4, 6, 8] {
        let element = default_element(n_nodes).unwrap();
        assert_eq!(element.n_nodes(), n_nodes);
    }
    assert!(default_element(5).is_none());
}

/// The plain bilinear element with one-point integration: a classic mistake, two hourglass modes.
#[derive(Debug)]
struct Hourglass;

impl Element for Hourglass {
    fn name(&self) -> &'static str {
        "Hourglass"
    }
    fn n_corners(&self) -> usize {
        4
    }
    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        Quad4.reference_nodes()
    }
    fn edges(&self) -> &'static [&'static [usize]] {
        Quad4.edges()
    }
    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &[QuadraturePoint {
            at: [0.0, 0.0],
            weight: 4.0,
        }]
    }
    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        Quad4.mass_quadrature()
    }
    fn shape(&self, at: [f64; 2], shape: &mut [f64]) {
        Quad4.shape(at, shape);
    }
    fn shape_gradient(&self, at: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        Quad4.shape_gradient(at, shape_gradient);
    }
}

#[test]
fn the_suite_finds_the_hourglass_modes_of_a_one_point_quadrilateral() {
    let failure = check_element(&Hourglass).unwrap_err();
    assert_eq!(failure.check, "exactly three eigenvalues are zero");
    assert_eq!((failure.measured, failure.allowed), (5.0, 3.0));
}

#[test]
fn a_collapsed_or_infinite_cell_is_refused_with_its_jacobian() {
    let rubber = LinearElastic::plane_stress(1.0, 0.3).density(1.0);
    let mut k = [0.0; 36];
    let line = [[0.1, 0.1], [0.2, 0.2], [0.7, 0.7]];
    let refused = Tri3.stiffness(&line, &rubber, 1.0, &mut k);
    assert!(
        matches!(refused, Err(ElementError::NonPositiveJacobian { .. })),
        "{refused:?}"
    );
    let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
    let message = Tri3
        .stiffness(&clockwise, &rubber, 1.0, &mut k)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("-1e0 m^2") && message.contains("counter-clockwise"),
        "{message}"
    );
    let nan = [[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]];
    assert!(Tri3.stiffness(&nan, &rubber, 1.0, &mut k).is_err());
}

#[test]
fn a_material_that_was_never_validated_does_not_pass_through_condensation() {
    let nodes = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let poor = LinearElastic::plane_strain(1.0, 0.5).density(1.0);
    let refused = Quad4.stiffness(&nodes, &poor, 1.0, &mut [0.0; 64]);
    assert!(
        matches!(refused, Err(ElementError::SingularModes { .. })),
        "{refused:?}"
    );
}

/// The tip deflection (m, downwards) of a clamped 1 x 0.1 cantilever under its own weight, per unit thickness.
///
/// E = 1e6, nu = 0.3, rho = 1000, gravity 0.1, plane stress; the converged answer is 15.1218 mm (Timoshenko:
/// 15 mm of bending and the rest shear).
fn sagging_tip(element: &'static dyn Element, cells: [usize; 2]) -> f64 {
    let grid = Grid::new(element, cells, |[s, t]| [s, 0.1 * t]);
    let sheet = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let force = grid.body_force(1.0, [0.0, -0.1 * Material::density(&sheet)]);
    let u = grid.solve(&sheet, 1.0, &force, |x| x[0] == 0.0);
    -u[2 * grid.node_at([1.0, 0.05]) + 1]
}

const SAG: f64 = 15.1218e-3;

#[test]
fn a_cantilever_under_its_own_weight_sags_as_much_as_it_should() {
    // Measured: -0.33, -0.20 and, for a single layer of triangles through the height, -1.006 %.
    for (element, cells, allowed) in [
        (QUAD4, [20, 2], 0.01),
        (TRI6, [20, 2], 0.01),
        (TRI6, [10, 1], 0.012),
    ] {
        let error = sagging_tip(element, cells) / SAG - 1.0;
        println!("{} {cells:?}: {:+.3} %", element.name(), 100.0 * error);
        assert!(
            error.abs() < allowed,
            "{} {cells:?}: {error:+.4}",
            element.name()
        );
    }
}

#[test]
fn constant_strain_triangles_lock_in_bending_by_more_than_a_third() {
    // A documented weakness, held here so that the documentation stays true.
    let error = sagging_tip(TRI3, [20, 2]) / SAG - 1.0;
    println!("Tri3: {:+.2} %", 100.0 * error);
    assert!((error + 0.38).abs() < 0.02, "{error:+.4}");
}

/// Cook's membrane: the upward displacement at (48, 52), as a part of the converged 23.968.
///
/// ```text
///                 . (48, 60)
///            .    |
///  (0, 44)        | ^ F = 1, spread evenly
///   |             | |
///   |             . (48, 44)
///   |        .           clamped at x = 0, thickness 1, E = 1, nu = 1/3
///  (0, 0)
/// ```
fn cook(element: &'static dyn Element, n: usize) -> f64 {
    let grid = Grid::new(element, [n, n], |[s, t]| {
        [48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s)]
    });
    let sheet = LinearElastic::plane_stress(1.0, 1.0 / 3.0).density(1.0);
    let force = end_force(&grid, 48.0, |_| [0.0, 1.0 / 16.0]);
    let u = grid.solve(&sheet, 1.0, &force, |x| x[0] == 0.0);
    u[2 * grid.node_at([48.0, 52.0]) + 1] / 23.968
}

/// Consistent nodal forces of a traction (N/m) along the edges on the line `x = place`.
fn end_force(grid: &Grid, place: f64, traction: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<f64> {
    let mut total = vec![0.0; 2 * grid.nodes.len()];
    let mut shape = vec![0.0; grid.element.n_nodes()];
    let reference = grid.element.reference_nodes();
    for cell in &grid.cells {
        let nodes = grid.positions(cell);
        for edge in grid.element.edges() {
            let (first, last) = (edge[0], edge[edge.len() - 1]);
            if [first, last]
                .iter()
                .any(|&end| (nodes[end][0] - place).abs() > 1e-12)
            {
                continue;
            }
            let length = (nodes[last][1] - nodes[first][1]).abs();
            for (s, weight) in GAUSS_4 {
                let between = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| a[i] + s * (b[i] - a[i]));
                grid.element
                    .shape(between(reference[first], reference[last]), &mut shape);
                let pull = traction(between(nodes[first], nodes[last]));
                let local: Vec<f64> = shape
                    .iter()
                    .flat_map(|n| pull.map(|p| n * weight * length * p))
                    .collect();
                scatter(cell, &local, &mut total);
            }
        }
    }
    total
}

#[test]
fn cooks_membrane_converges() {
    for (element, n, least) in [
        (QUAD4, 8, 0.985),
        (QUAD4, 16, 0.99),
        (TRI6, 8, 0.985),
        (TRI6, 16, 0.99),
    ] {
        let ratio = cook(element, n);
        println!("{} {n}: {ratio:.5}", element.name());
        assert!(
            (least..1.003).contains(&ratio),
            "{} {n}: {ratio}",
            element.name()
        );
    }
}

/// MacNeal and Harder's straight beam (1985), 6 x 0.2 x 0.1, six cells, E = 1e7, nu = 0.3.
///
/// `lean` tilts the inner cell walls by 45 degrees: `+1` for all of them (parallelograms), in turn for trapezoids.
fn straight_beam(lean: fn(usize) -> f64, shear: bool) -> f64 {
    let grid = Grid::new(QUAD4, [6, 1], |[s, t]| {
        let wall = (6.0 * s).round() as usize;
        [6.0 * s + lean(wall) * 0.1 * (2.0 * t - 1.0), 0.2 * t]
    });
    let sheet = LinearElastic::plane_stress(1e7, 0.3).density(1.0);
    let pull = if shear {
        [0.0, 1.0 / 0.2]
    } else {
        [1.0 / 0.2, 0.0]
    };
    let force = end_force(&grid, 6.0, |_| pull);
    let u = grid.solve(&sheet, 0.1, &force, |x| x[0] == 0.0);
    let (low, high) = (grid.node_at([6.0, 0.0]), grid.node_at([6.0, 0.2]));
    let mean = |direction: usize| 0.5 * (u[2 * low + direction] + u[2 * high + direction]);
    if shear {
        mean(1) / 0.1081
    } else {
        mean(0) / 3.0e-5
    }
}

const RECTANGLES: fn(usize) -> f64 = |_| 0.0;
const PARALLELOGRAMS: fn(usize) -> f64 = |wall| if wall % 6 == 0 { 0.0 } else { 1.0 };
const TRAPEZOIDS: fn(usize) -> f64 = |wall| match wall % 6 {
    0 => 0.0,
    odd if odd % 2 == 1 => 1.0,
    _ => -1.0,
};

#[test]
fn a_beam_of_six_rectangles_bends_like_a_beam() {
    let ratio = straight_beam(RECTANGLES, true);
    println!("rectangles, shear: {ratio:.4}");
    assert!((0.99..1.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_beam_stretches_rightly_on_any_cells() {
    // The clamped end holds the contraction too, which stiffens the beam by half a per cent.
    for (name, lean) in [
        ("rectangles", RECTANGLES),
        ("parallelograms", PARALLELOGRAMS),
        ("trapezoids", TRAPEZOIDS),
    ] {
        let ratio = straight_beam(lean, false);
        println!("{name}, extension: {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.01, "{name}: {ratio}");
    }
}

#[test]
fn distorted_cells_of_one_layer_bend_too_little_and_are_documented_to() {
    // Measured .632 and .052; Altair publishes .624 and .047 for its eight-node brick on these meshes. MacNeal
    // (1987) proves that no four-node trapezoid that passes the patch test bends well.
    let slanted = straight_beam(PARALLELOGRAMS, true);
    let trapezoid = straight_beam(TRAPEZOIDS, true);
    println!("parallelograms {slanted:.3}, trapezoids {trapezoid:.3}, shear");
    assert!((0.60..0.66).contains(&slanted), "{slanted}");
    assert!((0.04..0.06).contains(&trapezoid), "{trapezoid}");
}

/// A displacement that vanishes around the unit square, its gradient, and the load that makes it so.
mod manufactured {
    use super::PI;

    pub fn displacement([x, y]: [f64; 2]) -> [f64; 2] {
        let (sx, sy) = ((PI * x).sin(), (PI * y).sin());
        [sx * sy, (2.0 * PI * x).sin() * sy]
    }

    /// `-div sigma` with Hooke's `normal`, `cross` and `shear` moduli.
    pub fn load([x, y]: [f64; 2], normal: f64, cross: f64, shear: f64) -> [f64; 2] {
        let (sx, sy, cx, cy) = (
            (PI * x).sin(),
            (PI * y).sin(),
            (PI * x).cos(),
            (PI * y).cos(),
        );
        let (s2, c2) = ((2.0 * PI * x).sin(), (2.0 * PI * x).cos());
        let p = PI * PI;
        // Second derivatives of u = sx sy and v = s2 sy.
        let (u_xx, u_yy, u_xy) = (-p * sx * sy, -p * sx * sy, p * cx * cy);
        let (v_xx, v_yy, v_xy) = (-4.0 * p * s2 * sy, -p * s2 * sy, 2.0 * p * c2 * cy);
        [
            -(normal * u_xx + (cross + shear) * v_xy + shear * u_yy),
            -(normal * v_yy + (cross + shear) * u_xy + shear * v_xx),
        ]
    }
}

/// The L2 error of the manufactured displacement on a smoothly distorted grid of `n x n`.
fn manufactured_error(element: &'static dyn Element, n: usize) -> f64 {
    let grid = Grid::new(element, [n, n], |[s, t]| {
        let bump = (2.0 * PI * s).sin() * (2.0 * PI * t).sin();
        [s + 0.04 * bump, t - 0.03 * bump]
    });
    let sheet = LinearElastic::plane_stress(1.0, 0.3).density(1.0);
    let d = sheet.tangent([0.0; 3]);
    let rule = fine_rule(element);
    let (mut shape, mut gradient) = (
        vec![0.0; element.n_nodes()],
        vec![[0.0; 2]; element.n_nodes()],
    );
    let mut force = vec![0.0; 2 * grid.nodes.len()];
    let place = |shape: &[f64], nodes: &[[f64; 2]]| {
        [0, 1].map(|i| shape.iter().zip(nodes).map(|(n, x)| n * x[i]).sum::<f64>())
    };
    for cell in &grid.cells {
        let nodes = grid.positions(cell);
        for &(at, weight) in &rule {
            element.shape(at, &mut shape);
            let area = weight * physical_gradient(element, &nodes, at, &mut gradient).unwrap();
            let load = manufactured::load(place(&shape, &nodes), d[0][0], d[0][1], d[2][2]);
            let local: Vec<f64> = shape
                .iter()
                .flat_map(|n| load.map(|f| n * area * f))
                .collect();
            scatter(cell, &local, &mut force);
        }
    }
    let edge = |x: f64| x.abs() < 1e-12 || (x - 1.0).abs() < 1e-12;
    let u = grid.solve(&sheet, 1.0, &force, |x| edge(x[0]) || edge(x[1]));
    let mut square = 0.0;
    for cell in &grid.cells {
        let (nodes, local) = (grid.positions(cell), gather(cell, &u));
        for &(at, weight) in &rule {
            element.shape(at, &mut shape);
            let area = weight * physical_gradient(element, &nodes, at, &mut gradient).unwrap();
            let exact = manufactured::displacement(place(&shape, &nodes));
            for (i, exact) in exact.iter().enumerate() {
                let found: f64 = shape
                    .iter()
                    .zip(local.iter().skip(i).step_by(2))
                    .map(|(n, u)| n * u)
                    .sum();
                square += area * (found - exact) * (found - exact);
            }
        }
    }
    square.sqrt()
}

#[test]
fn displacements_converge_at_the_order_of_their_polynomials_plus_one() {
    // Halving the cells once more, from where the asymptotic range begins; +-0.15 covers what is left of it.
    for (element, n, order) in [(TRI3, 16, 2.0), (QUAD4, 12, 2.0), (TRI6, 8, 3.0)] {
        let measured = (manufactured_error(element, n) / manufactured_error(element, 2 * n)).log2();
        println!("{}: order {measured:.3}", element.name());
        assert!(
            (measured - order).abs() < 0.15,
            "{}: {measured}",
            element.name()
        );
    }
}

#[test]
fn smoothed_stress_in_a_bent_beam_is_that_of_the_outermost_fibre() {
    // Source: pure bending with nu = 0, u = k x y and v = -k x^2 / 2, so that s_xx = 60 y at a clamped end too.
    // Inner modes hold the parabola of a rectangular cell and linear edges the linear traction: all is exact.
    let grid = Grid::new(QUAD4, [12, 2], |[s, t]| [4.0 * s, t - 0.5]);
    let sheet = LinearElastic::plane_stress(1e5, 0.0).density(1.0);
    let force = end_force(&grid, 4.0, |x| [2.0 * 30.0 * x[1], 0.0]);
    let u = grid.solve(&sheet, 1.0, &force, |x| x[0] == 0.0);
    let mut stresses = Vec::new();
    for cell in &grid.cells {
        let mut points = [Stress::default(); 4];
        let nodes = grid.positions(cell);
        point_stresses(QUAD4, &nodes, &sheet, &gather(cell, &u), &mut points).unwrap();
        stresses.push((points, QUAD4.area(&nodes).unwrap()));
    }
    let cells = grid
        .cells
        .iter()
        .zip(&stresses)
        .map(|(nodes, (points, area))| CellStress {
            nodes,
            element: QUAD4,
            stresses: points,
            weight: *area,
        });
    let mut nodal = vec![Stress::default(); grid.nodes.len()];
    smooth_to_nodes(cells, &mut vec![0.0; grid.nodes.len()], &mut nodal);
    for (stress, x) in nodal.iter().zip(&grid.nodes) {
        // Rounding, times the condition of a beam of 12 cells (1e5).
        let error = (stress.xx - 60.0 * x[1]).abs() + stress.yy.abs() + stress.xy.abs();
        assert!(error < 30.0 * 1e-10, "{x:?}: {stress:?}");
    }
    assert_eq!(grid.n_across, 3);
}
