//! What a step is expected to cost, against known counts and against what steps tell of themselves: no clock is asked.

mod common;

use common::*;
use foil2d::doctor::{BodyCost, ExpectedCost};
use foil2d::linalg::block_matrix::BlockMatrix;
use foil2d::linalg::cholesky::BlockCholesky;

const DT: f64 = 1.0 / 60.0;

fn cost_of(builder: FlexBodyBuilder) -> BodyCost {
    let mut scene = Scene::new(DT);
    scene.flexible(builder);
    ExpectedCost::of(&scene.bodies).bodies.remove(0)
}

fn block(n: usize) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [n, n]).material(elastic(1e6, 1000.0, 5e-3))
}

/// `Σ l²` for `l` from 1 to N is `N (N + 1) (2 N + 1) / 6`.
#[test]
fn a_factorization_of_a_full_matrix_takes_a_third_of_its_size_cubed() {
    for n_nodes in [1_usize, 3, 8, 20] {
        let all: Vec<usize> = (0..n_nodes).collect();
        let matrix = BlockMatrix::from_cells(n_nodes, [&all[..]].into_iter());
        let n = 2.0 * n_nodes as f64;
        let expected = n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
        assert_eq!(BlockCholesky::analyze(&matrix).n_operations(), expected);
    }
}

/// Nested dissection of n by n nodes with nine-point stars keeps `31/4 n² log₂ n` entries in `829/84 n³` multiplications (George 1973), by leading terms;
/// four times as many entries and eight times as many multiplications with two dofs a node, and as many additions.
#[test]
fn a_factor_grows_with_a_square_as_nested_dissection_lets_it() {
    for n in [32_usize, 64, 128] {
        let cost = cost_of(block(n - 1));
        let n = n as f64;
        let entries = 4.0 * 31.0 / 4.0 * n * n * n.log2();
        let operations = 2.0 * 8.0 * 829.0 / 84.0 * n.powi(3);
        let [kept, taken] = [
            cost.n_entries as f64 / entries,
            cost.factorization / operations,
        ];
        assert!(
            (0.3..1.2).contains(&kept),
            "{n}: {kept} of {entries} entries"
        );
        assert!(
            (0.2..1.5).contains(&taken),
            "{n}: {taken} of {operations} operations"
        );
    }
}

/// Factorizations of bodies that lie, roll, swing and hang.
#[test]
fn bodies_are_factorized_about_as_often_as_expected() {
    let rope = || {
        FlexBodyBuilder::rectangle([2.0, 0.05], [40, 1])
            .material(elastic(1e7, 1000.0, 5e-3))
            .pin_where(|[x, _]| x < 1e-9, Pin::both())
            .translation([0.0, 3.0])
    };
    let scenes: [(&str, FlexBodyBuilder); 4] = [
        ("lies", block(10).translation([0.0, 1e-3])),
        (
            "rolls",
            FlexBodyBuilder::disc(0.5, 0.12)
                .material(elastic(1e6, 1000.0, 5e-3))
                .translation([0.0, 0.51])
                .angvel(-5.0),
        ),
        ("falls", block(10).translation([0.0, 50.0]).angvel(3.0)),
        ("swings", rope()),
    ];
    for (what, builder) in scenes {
        let mut scene = Scene::new(DT);
        scene.ground(0.5);
        scene.flexible(builder.can_sleep(false));
        let n_steps = 120;
        let counts = (0..n_steps).map(|_| scene.step().n_factorizations());
        let mean = counts.sum::<u64>() as f64 / f64::from(n_steps);
        let ratio = mean / ExpectedCost::FACTORIZATIONS;
        if what == "lies" {
            assert!(ratio < 0.25, "it keeps its factor: {mean} a step");
        } else {
            assert!((0.25..4.0).contains(&ratio), "{what}: {mean} a step");
        }
    }
    // One of small strain is factorized once.
    let mut scene = Scene::new(DT);
    scene.flexible(block(10).small_strain().translation([0.0, 1.0]));
    let counts: Vec<u64> = (0..30).map(|_| scene.step().n_factorizations()).collect();
    assert_eq!(counts.iter().sum::<u64>(), 1);
}

#[test]
fn a_finer_mesh_large_strain_and_contact_cost_more() {
    let [coarse, fine] = [10, 40].map(|n| cost_of(block(n)));
    assert!(
        fine.step(0.0) > 16.0 * coarse.step(0.0),
        "at least as its dofs"
    );
    assert!(fine.step(0.25) > fine.step(0.0));
    let small = cost_of(block(40).small_strain());
    assert!(!small.is_large && small.step(0.0) < 0.2 * fine.step(0.0));
    assert_eq!(
        [fine.n_dofs, fine.n_cells, fine.n_surface],
        [2 * 41 * 41, 1600, 160]
    );
}
