//! Mass redistribution: nodes in contact lose their inertia, the body as a whole keeps its own.

use foil2d::fe::frequency::largest_frequency;
use foil2d::fe::mass::{
    MassError, Redistribution, move_inwards, nearness, redistribute, redistribute_by,
};
use foil2d::fe::model::MassKind;
use foil2d::prelude::*;

/// A set of nodes with lumped masses and the neighbours of each.
struct Body {
    nodes: Vec<[f64; 2]>,
    mass: Vec<f64>,
    neighbours: Vec<Vec<usize>>,
    massless: Vec<bool>,
}

impl Body {
    /// A rectangle of `cells` equal four-node cells, node `(i, j)` at index `i (ny + 1) + j`, density 1.
    fn rectangle(size: [f64; 2], cells: [usize; 2]) -> Self {
        let [nx, ny] = cells;
        let [dx, dy] = [size[0] / nx as f64, size[1] / ny as f64];
        let end = |index: usize, last: usize| {
            if index == 0 || index == last {
                0.5
            } else {
                1.0
            }
        };
        let index = |i: usize, j: usize| i * (ny + 1) + j;
        let (mut nodes, mut mass, mut neighbours) = (vec![], vec![], vec![]);
        for i in 0..=nx {
            for j in 0..=ny {
                nodes.push([i as f64 * dx, j as f64 * dy]);
                mass.push(dx * dy * end(i, nx) * end(j, ny));
                let around = (i.saturating_sub(1)..=nx.min(i + 1))
                    .flat_map(|a| (j.saturating_sub(1)..=ny.min(j + 1)).map(move |b| index(a, b)));
                neighbours.push(around.filter(|&other| other != index(i, j)).collect());
            }
        }
        let massless = vec![false; nodes.len()];
        Self {
            nodes,
            mass,
            neighbours,
            massless,
        }
    }

    /// The unit disc as rings of nodes about its centre, each node with the area it stands for.
    fn disc(n_rings: usize) -> Self {
        let (mut nodes, mut mass, mut massless) = (vec![[0.0; 2]], vec![], vec![false]);
        let dr = 1.0 / n_rings as f64;
        mass.push(std::f64::consts::PI * 0.25 * dr * dr);
        for ring in 1..=n_rings {
            let n = 6 * ring;
            let (inner, outer) = (
                (ring as f64 - 0.5) * dr,
                ((ring as f64 + 0.5) * dr).min(1.0),
            );
            let share = std::f64::consts::PI * (outer * outer - inner * inner) / n as f64;
            for k in 0..n {
                let angle = std::f64::consts::TAU * k as f64 / n as f64;
                nodes.push([
                    ring as f64 * dr * angle.cos(),
                    ring as f64 * dr * angle.sin(),
                ]);
                mass.push(share);
                massless.push(ring == n_rings);
            }
        }
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1.3 * dr;
        let neighbours = (0..nodes.len())
            .map(|a| {
                (0..nodes.len())
                    .filter(|&b| a != b && near(nodes[a], nodes[b]))
                    .collect()
            })
            .collect();
        Self {
            nodes,
            mass,
            neighbours,
            massless,
        }
    }

    fn without_inertia(mut self, choose: impl Fn([f64; 2]) -> bool) -> Self {
        self.massless = self.nodes.iter().map(|&x| choose(x)).collect();
        self
    }

    /// Total mass, centre from node 0 (so that distance from the origin costs no digits), and second moments about it.
    fn moments(&self) -> [f64; 6] {
        let from = self.nodes[0];
        let sum = |value: &dyn Fn([f64; 2]) -> f64| -> f64 {
            let local = self.nodes.iter().map(|x| [x[0] - from[0], x[1] - from[1]]);
            local.zip(&self.mass).map(|(x, m)| m * value(x)).sum()
        };
        let total = sum(&|_| 1.0);
        let [x, y] = [sum(&|x| x[0]) / total, sum(&|x| x[1]) / total];
        let (dx, dy) = (move |p: [f64; 2]| p[0] - x, move |p: [f64; 2]| p[1] - y);
        let (xx, yy) = (sum(&|p| dx(p) * dx(p)), sum(&|p| dy(p) * dy(p)));
        [total, x, y, xx, yy, sum(&|p| dx(p) * dy(p))]
    }

    fn redistribute(&mut self) -> Result<Redistribution, MassError> {
        let neighbours = &self.neighbours;
        redistribute(&self.nodes, &mut self.mass, &self.massless, |node| {
            &neighbours[node]
        })
    }

    fn assert_masses_are_nonnegative_and_zero_where_asked(&self) {
        for (node, (&mass, &massless)) in self.mass.iter().zip(&self.massless).enumerate() {
            assert_eq!(mass == 0.0, massless, "node {node} has {mass}");
            assert!(mass >= 0.0, "node {node} has {mass}");
        }
    }
}

/// Entries within `tolerance` of the scale of their kind: the total, the size of the body, total times size squared.
fn assert_same_moments(found: [f64; 6], expected: [f64; 6], size: f64, tolerance: f64) {
    let second = expected[0] * size * size;
    let scales = [expected[0], size, size, second, second, second];
    for (moment, scale) in scales.iter().enumerate() {
        let error = (found[moment] - expected[moment]).abs() / scale;
        assert!(error <= tolerance, "moment {moment} is off by {error:e}");
    }
}

fn on_rectangle_edge([x, y]: [f64; 2]) -> bool {
    x == 0.0 || y == 0.0 || x == 1.0 || y == 1.0
}

#[test]
fn a_square_without_boundary_inertia_keeps_every_moment() {
    let mut body = Body::rectangle([1.0, 1.0], [16, 16]).without_inertia(on_rectangle_edge);
    let before = body.moments();
    let report = body.redistribute().unwrap();
    // Sums of 289 terms of rounding 1e-16 each.
    assert_same_moments(body.moments(), before, 1.0, 1e-14);
    assert!(report.keeps_centre && report.keeps_polar_moment && report.keeps_second_moments);
    body.assert_masses_are_nonnegative_and_zero_where_asked();
    // Edges carry 60 cells of half and 4 of a quarter: (30 + 1) / 256 of the mass.
    assert!((report.moved - 31.0 / 256.0).abs() < 1e-15);
}

#[test]
fn a_slender_turned_strip_far_from_the_origin_keeps_every_moment() {
    let mut body = Body::rectangle([10.0, 0.1], [200, 4]);
    body.massless = body
        .nodes
        .iter()
        .map(|x| x[1] == 0.0 || x[0] == 0.0)
        .collect();
    let (sin, cos) = 0.6f64.sin_cos();
    for x in &mut body.nodes {
        *x = [
            100.0 + cos * x[0] - sin * x[1],
            -40.0 + sin * x[0] + cos * x[1],
        ];
    }
    let before = body.moments();
    let report = body.redistribute().unwrap();
    // Sums of 1005 terms of rounding 1e-16 each.
    assert_same_moments(body.moments(), before, 10.0, 1e-13);
    assert!(report.keeps_centre && report.keeps_polar_moment && report.keeps_second_moments);
    body.assert_masses_are_nonnegative_and_zero_where_asked();
}

#[test]
fn a_disc_keeps_every_moment_and_its_symmetry() {
    let mut body = Body::disc(8);
    let before = body.moments();
    let report = body.redistribute().unwrap();
    assert_same_moments(body.moments(), before, 1.0, 1e-14);
    assert!(report.keeps_second_moments);
    body.assert_masses_are_nonnegative_and_zero_where_asked();
    // p has the symmetry of the mass: the six nodes of the first ring stay equal.
    let first_ring = &body.mass[1..7];
    assert!(
        first_ring
            .iter()
            .all(|m| (m / first_ring[0] - 1.0).abs() < 1e-12)
    );
}

#[test]
fn half_a_boundary_moves_the_mass_but_not_the_centre() {
    let mut body = Body::rectangle([2.0, 1.0], [12, 6]).without_inertia(|x| x[1] == 0.0);
    let before = body.moments();
    let neighbours = body.neighbours.clone();
    let mut moved_only = body.mass.clone();
    move_inwards(&mut moved_only, &body.massless, |node| &neighbours[node]).unwrap();
    let lifted = Body {
        mass: moved_only,
        ..Body::rectangle([2.0, 1.0], [12, 6])
    };
    assert!(
        lifted.moments()[2] > before[2] + 0.01,
        "moving alone lifts the centre"
    );
    let report = body.redistribute().unwrap();
    assert!(report.keeps_second_moments);
    assert_same_moments(body.moments(), before, 2.0, 1e-14);
}

#[test]
fn a_row_of_nodes_keeps_the_moments_along_it() {
    // A bar of ten cells as a row: nothing is known, or needed, across it.
    let mut body = Body::rectangle([10.0, 1.0], [10, 1]);
    body.nodes.retain(|x| x[1] == 0.0);
    body.mass = (0..11)
        .map(|i| if i % 10 == 0 { 0.5 } else { 1.0 })
        .collect();
    body.neighbours = (0..11usize)
        .map(|i| {
            [i.wrapping_sub(1), i + 1]
                .into_iter()
                .filter(|&j| j < 11)
                .collect()
        })
        .collect();
    body.massless = (0..11).map(|i| i == 0).collect();
    let before = body.moments();
    let report = body.redistribute().unwrap();
    assert!(report.keeps_centre && report.keeps_second_moments);
    assert_same_moments(body.moments(), before, 10.0, 1e-15);
    body.assert_masses_are_nonnegative_and_zero_where_asked();
}

#[test]
fn a_row_off_the_centre_keeps_the_total_and_reports_the_lost_centre() {
    // Two cells through the height, and only the top row keeps its mass: its centre is its own.
    let mut body = Body::rectangle([4.0, 1.0], [8, 2]).without_inertia(|x| x[1] < 0.9);
    let before = body.moments();
    let report = body.redistribute().unwrap();
    let after = body.moments();
    assert!(!report.keeps_centre && !report.keeps_second_moments);
    assert!(
        (after[0] / before[0] - 1.0).abs() < 1e-15,
        "the total is kept"
    );
    assert!(
        (after[1] - before[1]).abs() < 1e-14,
        "the centre along the row is kept"
    );
    assert_eq!(after[2], 1.0, "across the row there is no choice");
    body.assert_masses_are_nonnegative_and_zero_where_asked();
}

#[test]
fn the_end_of_a_bar_one_cell_thick_gives_its_mass_to_the_next_pair() {
    // Source: the 'mr' schemes of the one-dimensional study, where the first cell's whole mass sits on node 1.
    let (n, dx) = (100, 0.1);
    let mut body = Body::rectangle([n as f64 * dx, 1.0], [n, 1]);
    body.massless = body.nodes.iter().map(|x| x[0] == 0.0).collect();
    let neighbours = body.neighbours.clone();
    let moved = move_inwards(&mut body.mass, &body.massless, |node| &neighbours[node]).unwrap();
    assert!((moved - 0.5 * dx).abs() < 1e-16);
    for (node, &mass) in body.mass.iter().enumerate() {
        let expected = match node / 2 {
            0 => 0.0,
            1 => 0.75 * dx,
            100 => 0.25 * dx,
            _ => 0.5 * dx,
        };
        assert!(
            (mass - expected).abs() < 1e-15,
            "node {node}: {mass} for {expected}"
        );
    }
}

#[test]
fn restoring_the_moments_of_a_bar_changes_its_other_masses_little() {
    // Moving half a cell's mass by one cell shifts moments by (dx / L)^2 / 2; p - 1 is of the same order, times
    // the conditioning of quadratics at the end of an interval (9, the square of their number).
    let mut body = Body::rectangle([10.0, 1.0], [100, 1]);
    body.massless = body.nodes.iter().map(|x| x[0] == 0.0).collect();
    let before = body.moments();
    let report = body.redistribute().unwrap();
    assert!(report.keeps_second_moments);
    assert_same_moments(body.moments(), before, 10.0, 1e-14);
    assert!(
        report.smallest_factor > 0.998 && report.largest_factor < 1.002,
        "{report:?}"
    );
}

#[test]
fn several_rings_hand_their_mass_inwards_one_after_another() {
    // A chain of five, massive only at one end: everything arrives there.
    let neighbours: [&[usize]; 5] = [&[1], &[0, 2], &[1, 3], &[2, 4], &[3]];
    let mut mass = [1.0, 2.0, 4.0, 8.0, 16.0];
    let massless = [true, true, true, true, false];
    assert_eq!(
        move_inwards(&mut mass, &massless, |node| neighbours[node]),
        Ok(15.0)
    );
    assert_eq!(mass, [0.0, 0.0, 0.0, 0.0, 31.0]);
}

#[test]
fn moments_that_would_take_a_mass_below_a_tenth_are_given_up_and_reported() {
    // Nine nodes, the eight outer ones heavy and two of them massive beside a light centre: with all the mass of
    // the far side gone, no positive masses on the left hold the centre.
    let mut body = Body::rectangle([2.0, 2.0], [2, 2]).without_inertia(|x| x[0] > 0.5);
    let before = body.moments();
    let report = body.redistribute().unwrap();
    assert!(!report.keeps_centre);
    assert!(report.smallest_factor >= 0.1);
    assert!((body.moments()[0] / before[0] - 1.0).abs() < 1e-15);
    body.assert_masses_are_nonnegative_and_zero_where_asked();
    // A coarse square with one inner node: the centre holds by symmetry, the polar moment cannot.
    let mut body = Body::rectangle([2.0, 2.0], [2, 2]).without_inertia(|x| x != [1.0, 1.0]);
    let report = body.redistribute().unwrap();
    assert!(report.keeps_centre && !report.keeps_polar_moment);
    assert!(
        (body.mass[4] - 4.0).abs() < 1e-15,
        "all mass on the inner node"
    );
}

#[test]
fn without_massless_nodes_nothing_changes() {
    let mut body = Body::rectangle([3.0, 2.0], [6, 5]);
    let before = body.mass.clone();
    let report = body.redistribute().unwrap();
    for (after, before) in body.mass.iter().zip(before) {
        assert!((after / before - 1.0).abs() < 1e-14);
    }
    assert_eq!(report.moved, 0.0);
    assert!(report.keeps_second_moments);
}

#[test]
fn a_body_that_cannot_be_redistributed_is_refused_and_left_alone() {
    let mut body = Body::rectangle([1.0, 1.0], [1, 1]).without_inertia(|_| true);
    let before = body.mass.clone();
    assert_eq!(
        body.redistribute(),
        Err(MassError::NoMassiveNode { n_nodes: 4 })
    );
    assert_eq!(body.mass, before);
    let neighbours: [&[usize]; 3] = [&[1], &[0], &[]];
    let mut mass = [1.0; 3];
    let result = move_inwards(&mut mass, &[true, false, true], |node| neighbours[node]);
    assert_eq!(result, Err(MassError::Unreachable { node: 2 }));
    assert_eq!(mass, [1.0; 3]);
    let mut mass = [1.0, -0.5, 1.0];
    let result = move_inwards(&mut mass, &[true, false, true], |node| neighbours[node]);
    assert_eq!(
        result,
        Err(MassError::NotPositive {
            node: 1,
            value: -0.5
        })
    );
}

/// A bar of 20 cells whose left end gives its mass away.
fn bar(kind: MassKind, gives: bool) -> FlexBody {
    let nodes = if gives { vec![0, 21] } else { vec![] };
    FlexBodyBuilder::rectangle([10.0, 0.5], [20, 1])
        .material(LinearElastic::plane_stress(900.0, 0.0).density(1.0))
        .mass_kind(kind)
        .contact_inertia(ContactInertia::RedistributedAt(nodes))
        .build()
        .expect("a sound bar")
}

/// Total, first moments and polar moment of the mass matrix about the origin, `1·M 1`, `1·M x` and `x·M x`.
fn moments(body: &FlexBody) -> [f64; 4] {
    let places: Vec<f64> = body.mesh().nodes().iter().flatten().copied().collect();
    let ones = |axis: usize| -> Vec<f64> {
        let pattern = [1.0 - axis as f64, axis as f64];
        pattern.into_iter().cycle().take(places.len()).collect()
    };
    let mass = body.model().mass();
    let [x, y] = [ones(0), ones(1)];
    [
        mass.inner(&x, &x),
        mass.inner(&x, &places),
        mass.inner(&y, &places),
        mass.inner(&places, &places),
    ]
}

#[test]
fn a_consistent_mass_that_moves_inwards_keeps_total_centre_and_polar_moment() {
    let (before, after) = (
        bar(MassKind::Consistent, false),
        bar(MassKind::Consistent, true),
    );
    for (kept, is) in moments(&before).into_iter().zip(moments(&after)) {
        assert!((is / kept - 1.0).abs() < 1e-12, "{is} instead of {kept}");
    }
    let mass = after.model().mass();
    let n_dofs = after.model().n_dofs();
    for node in [0, 21] {
        assert!(after.model().is_massless(node));
        let mut unit = vec![0.0; n_dofs];
        unit[2 * node] = 1.0;
        let mut row = vec![0.0; n_dofs];
        mass.multiply_add(1.0, &unit, &mut row);
        assert!(
            row.iter().all(|&entry| entry == 0.0),
            "node {node} has a row"
        );
    }
    // Positive definite on the others: the largest frequency is found by a Cholesky factor of the mass.
    let found = largest_frequency(after.model(), &[], 1e-6).expect("the mass has a factor");
    assert!(found.frequency.is_finite() && found.frequency > 0.0);
}

/// A wave that comes from afar must not meet another density: moments are restored near the nodes that gave their mass.
#[test]
fn weights_by_nearness_keep_the_moments_and_leave_the_far_half_alone() {
    let change = |weight: Option<Vec<f64>>| {
        let mut body = Body::rectangle([10.0, 0.5], [20, 1]);
        (body.massless[0], body.massless[1]) = (true, true);
        let before = body.mass.clone();
        let neighbours = body.neighbours.clone();
        let around = |node: usize| &neighbours[node][..];
        let weight = weight.unwrap_or_else(|| nearness(&body.massless, around));
        let report = redistribute_by(&body.nodes, &mut body.mass, &body.massless, around, &weight);
        let report = report.expect("twenty cells carry the mass of one end");
        assert!(report.keeps_second_moments, "{report:?}");
        let far = (0..before.len()).filter(|&node| body.nodes[node][0] >= 5.0);
        let squares = far.map(|node| (body.mass[node] / before[node] - 1.0).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let (whole, near) = (change(Some(vec![1.0; 42])), change(None));
    assert!(near < 0.3 * whole, "{near} beside {whole}");
}
