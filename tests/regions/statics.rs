//! Equilibria of bodies of two materials with known answers.

use crate::common::*;
use foil2d::fe::material::hyperelastic::principal_stress;
use foil2d::large::{LargeSettings, LoadCase, LoadStepper};
use foil2d::linalg::cholesky::BlockCholesky;

const KINDS: [CellKind; 4] = [
    CellKind::Tri3,
    CellKind::Tri6,
    CellKind::Quad4,
    CellKind::Quad8,
];

/// Displacements of a body of small strain under nodal loads (N), with some dofs held at zero.
fn deflect(body: &FlexBody, load: &[f64], is_held: &[bool]) -> Vec<f64> {
    let mut stiffness = body.model().stiffness().clone();
    stiffness.constrain(is_held);
    let mut factor = BlockCholesky::analyze(&stiffness);
    factor.factorize(&stiffness).expect("the body is held");
    let mut u: Vec<f64> = load
        .iter()
        .zip(is_held)
        .map(|(load, &is_held)| if is_held { 0.0 } else { *load })
        .collect();
    factor.solve_in_place(&mut u);
    u
}

fn held(body: &FlexBody, is_held: impl Fn([f64; 2], usize) -> bool) -> Vec<bool> {
    let nodes = body.mesh().nodes().iter();
    nodes
        .flat_map(|&at| [is_held(at, 0), is_held(at, 1)])
        .collect()
}

/// Nodal loads of a traction `[0, H] -> t_x` (Pa) that is linear within the straight edges on `x = length`, of a body 1 m thick.
fn pull(body: &FlexBody, length: f64, traction: impl Fn(f64, bool) -> f64) -> Vec<f64> {
    let mesh = body.mesh();
    let mut load = vec![0.0; 2 * mesh.n_nodes()];
    let mut ends: Vec<usize> = (0..mesh.n_nodes())
        .filter(|&node| (mesh.nodes()[node][0] - length).abs() < 1e-12)
        .collect();
    ends.sort_by(|&a, &b| mesh.nodes()[a][1].total_cmp(&mesh.nodes()[b][1]));
    let y = |node: usize| mesh.nodes()[node][1];
    let is_quadratic = mesh.cell(0).kind.is_quadratic();
    let stride = if is_quadratic { 2 } else { 1 };
    for edge in ends.windows(stride + 1).step_by(stride) {
        let (low, high) = (edge[0], edge[stride]);
        let (size, a, b) = (
            y(high) - y(low),
            traction(y(low), true),
            traction(y(high), false),
        );
        if is_quadratic {
            load[2 * low] += size * a / 6.0;
            load[2 * edge[1]] += size * (a + b) / 3.0;
            load[2 * high] += size * b / 6.0;
        } else {
            load[2 * low] += size * (2.0 * a + b) / 6.0;
            load[2 * high] += size * (a + 2.0 * b) / 6.0;
        }
    }
    load
}

/// Two layers, E 200 and 30, h 0.3 and 0.5 m, bent by a couple at the end.
///
/// ```text
///   |=============| ) M     Σ E A (y - y0) = 0,  κ = M / Σ E (I + A (y - y0)²),  w = κ x²/2, exactly as ν = 0
///   |-------------|
/// ```
#[test]
fn a_cantilever_of_two_layers_bends_about_the_axis_of_the_composite_beam() {
    let (young, height, length) = ([200.0, 30.0], [0.3, 0.5], 4.0);
    let layer = |k: usize| LinearElastic::plane_stress(young[k], 0.0).density(1.0);
    let nodes = |[x, y]: [f64; 2]| {
        // Rows of 0.1 m below 0.3 m and 0.125 m above.
        [
            x,
            if y <= 3.0 {
                0.1 * y
            } else {
                0.3 + 0.125 * (y - 3.0)
            },
        ]
    };
    let plain = foil2d::fe::mesh::generate::rectangle([length, 7.0], [8, 7], CellKind::Tri3)
        .expect("a rectangle");
    let cells: Vec<Vec<usize>> = plain.cells().map(|cell| cell.nodes.to_vec()).collect();
    let placed = plain.nodes().iter().copied().map(nodes).collect();
    let mesh = Mesh::from_cells(placed, CellKind::Tri3, &cells)
        .expect("rows of two heights")
        .with_regions_by(|[_, y]| u32::from(y > height[0]))
        .to_tri6()
        .expect("triangles");
    let body = FlexBodyBuilder::mesh(mesh)
        .region_material(0, layer(0))
        .region_material(1, layer(1))
        .small_strain()
        .build()
        .expect("two layers");
    let middle = [0.5 * height[0], height[0] + 0.5 * height[1]];
    let sum = |of: &dyn Fn(usize) -> f64| of(0) + of(1);
    let axis = sum(&|k| young[k] * height[k] * middle[k]) / sum(&|k| young[k] * height[k]);
    let bending = sum(&|k| {
        let own = height[k].powi(3) / 12.0;
        young[k] * (own + height[k] * (middle[k] - axis).powi(2))
    });
    let curvature = 1e-3;
    let of_layer = |y: f64, is_low: bool| {
        // On the interface an edge above begins, and one below ends.
        let upper = y > height[0] + 1e-9 || (is_low && y > height[0] - 1e-9);
        young[usize::from(upper)] * -curvature * (y - axis)
    };
    let load = pull(&body, length, of_layer);
    let couple: f64 = (0..body.n_nodes())
        .map(|node| -load[2 * node] * (body.mesh().nodes()[node][1] - axis))
        .sum();
    assert!(
        (couple / (bending * curvature) - 1.0).abs() < 1e-12,
        "{couple}"
    );
    let foot = |[x, y]: [f64; 2], axis| x == 0.0 && (axis == 0 || y == 0.0);
    let u = deflect(&body, &load, &held(&body, foot));
    for (node, &[x, y]) in body.mesh().nodes().iter().enumerate() {
        let exact = [-curvature * (y - axis) * x, 0.5 * curvature * x * x];
        for k in 0..2 {
            let error = u[2 * node + k] - exact[k];
            assert!(error.abs() < 1e-12, "{x} {y}: {error:e}");
        }
    }
}

/// Bodies of two materials that are uniformly stressed: one behind the other, and side by side.
///
/// ```text
///  series   [  E1  |  E2  ] -> s     strain s/E each; ν/E is one, so that both widen alike
///  parallel [     E2      ] -> e     stress E e each
///           [     E1      ]
/// ```
#[test]
fn patches_of_two_materials_are_uniformly_stressed_to_the_interface() {
    let (young, poisson) = ([100.0, 200.0], [0.2, 0.4]);
    let layer = |k: usize| LinearElastic::plane_stress(young[k], poisson[k]).density(1.0);
    for kind in KINDS {
        for in_series in [true, false] {
            let body = FlexBodyBuilder::rectangle_of([4.0, 2.0], [4, 4], kind)
                .regions_by(|[x, y]| u32::from(if in_series { x > 2.0 } else { y > 1.0 }))
                .material(layer(0))
                .region_material(1, layer(1))
                .small_strain()
                .build()
                .expect("a patch");
            let strain = 1e-3;
            let stress = |at: [f64; 2]| match (in_series, at[1] > 1.0) {
                (true, _) => 0.1,
                (false, upper) => young[usize::from(upper)] * strain,
            };
            let traction = |y: f64, is_low: bool| {
                let within = if is_low { 1e-6 } else { -1e-6 };
                stress([4.0, y + within])
            };
            let load = pull(&body, 4.0, traction);
            let foot = |[x, y]: [f64; 2], axis| x == 0.0 && (axis == 0 || y == 0.0);
            let u = deflect(&body, &load, &held(&body, foot));
            for (index, cell) in body.mesh().cells().enumerate() {
                let k = cell.region as usize;
                let s = stress(if k == 1 { [3.0, 1.5] } else { [1.0, 0.5] });
                let e = s / young[k];
                for (found, stress) in body.model().cell_stress(index, &u).expect("a cell") {
                    for (found, exact) in found.iter().zip([e, -poisson[k] * e, 0.0]) {
                        assert!((found - exact).abs() < 1e-14, "{kind} {in_series}");
                    }
                    assert!((stress.xx - s).abs() < 1e-12 && stress.yy.abs() < 1e-12);
                    assert!(stress.xy.abs() < 1e-12 && stress.zz == 0.0);
                }
            }
        }
    }
}

/// Two rubbers side by side, pulled to 1.5 times their length: each has its own width, and the pull is the sum of theirs.
#[test]
fn rubbers_side_by_side_share_a_large_pull_as_their_own_laws_say() {
    let laws = [
        NeoHookean::plane_strain(100.0, 0.3),
        NeoHookean::plane_strain(300.0, 0.45),
    ];
    let solid = |k: usize| HyperelasticSolid::new(laws[k]).with_density(1.0);
    // The side is free: its stretch by bisection, the pull from it.
    let bar = |k: usize| {
        let [mut low, mut high] = [0.3, 1.5];
        for _ in 0..100 {
            let mid = 0.5 * (low + high);
            let is_pulled = principal_stress(&laws[k], [1.5, mid])[1] > 0.0;
            *(if is_pulled { &mut high } else { &mut low }) = mid;
        }
        (low, principal_stress(&laws[k], [1.5, low])[0])
    };
    let [(side_0, pull_0), (side_1, pull_1)] = [bar(0), bar(1)];
    for kind in KINDS {
        let body = FlexBodyBuilder::rectangle_of([2.0, 2.0], [4, 4], kind)
            .regions_by(|[_, y]| u32::from(y > 0.5))
            .region_material(0, solid(0))
            .region_material(1, solid(1))
            .build()
            .expect("two rubbers");
        let large = body.large().expect("a body of large strain");
        let at_end = |x: f64| x == 0.0 || x == 2.0;
        let is_held = held(&body, |[x, y], axis| {
            (axis == 0 && at_end(x)) || (axis == 1 && y == 0.0)
        });
        let zeros = vec![0.0; body.model().n_dofs()];
        let mut x = large.rest_positions().to_vec();
        let places: Vec<f64> = x.chunks(2).flat_map(|at| [1.5 * at[0], at[1]]).collect();
        let case = LoadCase {
            from: &zeros,
            to: &zeros,
            is_held: &is_held,
            places: &places,
            n_increments: 4,
        };
        let settings = LargeSettings::conserving().with_tolerance(1e-12);
        let mut solver = LoadStepper::new(large.clone(), settings).expect("settings");
        solver.solve(case, &mut x).expect("the pull is found");
        let mut pull = 0.0;
        for (node, at) in body.mesh().nodes().iter().enumerate() {
            let lower = at[1].min(0.5);
            let exact = side_0 * lower + side_1 * (at[1] - lower);
            assert!((x[2 * node + 1] - exact).abs() < 1e-10, "{kind}");
            if at[0] == 2.0 {
                pull += solver.reaction()[2 * node];
            }
        }
        let exact = 0.5 * pull_0 + 1.5 * pull_1;
        assert!(
            (pull / exact - 1.0).abs() < 1e-10,
            "{kind}: {pull} for {exact}"
        );
        // Cauchy's stress in the current width.
        for (index, cell) in body.mesh().cells().enumerate() {
            let (side, pull) = [(side_0, pull_0), (side_1, pull_1)][cell.region as usize];
            for stress in large.cell_stress(index, &x) {
                assert!((stress.xx - pull / side).abs() < 1e-8 * pull, "{kind}");
                assert!(stress.yy.abs() < 1e-8 * pull, "{kind}");
            }
        }
    }
}
