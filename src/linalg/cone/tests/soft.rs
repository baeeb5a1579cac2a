//! A mesh of springs on the ground.

use super::*;

/// A lattice of springs with its mass in the nodes, pressed on the ground by the nodes of its lowest row, the first ones, and pulled sideways.
pub(super) fn soft_block([wide, high]: [usize; 2], pull: f64, friction: f64) -> Scene {
    let at = |i: usize, j: usize| i + wide * j;
    let mut cells: Vec<[usize; 2]> = Vec::new();
    for j in 0..high {
        for i in 0..wide {
            let reach = [(1, 0), (0, 1), (1, 1)];
            cells.extend(
                reach
                    .iter()
                    .filter(|(x, y)| i + x < wide && j + y < high)
                    .map(|(x, y)| [at(i, j), at(i + x, j + y)]),
            );
        }
    }
    let mut matrix = BlockMatrix::from_cells(wide * high, cells.iter().map(|cell| &cell[..]));
    for cell in &cells {
        let (dx, dy) = (
            (cell[1] % wide) as f64 - (cell[0] % wide) as f64,
            (cell[1] / wide) as f64 - (cell[0] / wide) as f64,
        );
        let along = [-dx, -dy, dx, dy].map(|x| x / (dx * dx + dy * dy).sqrt());
        let spring: Vec<f64> = along
            .iter()
            .flat_map(|a| along.iter().map(move |b| 300.0 * a * b))
            .collect();
        matrix.add_cell(cell, &spring);
    }
    let n_nodes = wide * high;
    (0..n_nodes).for_each(|node| matrix.add_diagonal(node, [1.0; 2]));
    let load = (0..n_nodes).flat_map(|_| [pull * 10.0, -10.0]).collect();
    let mut scene = Scene {
        matrix,
        load,
        rows: Vec::new(),
        entries: Vec::new(),
    };
    for i in 0..wide {
        scene.row(
            ConeLaw::Contact { friction },
            [0.0; 2],
            [1.0; 2],
            &[(at(i, 0), [0.0, 1.0], [1.0, 0.0])],
        );
    }
    scene.estimate();
    scene
}

#[test]
fn a_soft_block_rests_and_slides_on_the_nodes_of_its_edge() {
    for (pull, friction) in [(0.3, 0.5), (0.9, 0.5)] {
        let scene = soft_block([12, 5], pull, friction);
        let answer = solve(&scene);
        let (violated, missing) = violation(&scene, &answer);
        assert!(
            answer.outcome.is_solved && violated < 1e-7 && missing < 1e-11,
            "{:?} {violated:e} {missing:e}",
            answer.outcome
        );
        let total = answer
            .p
            .iter()
            .fold([0.0; 2], |sum, p| [sum[0] + p[0], sum[1] + p[1]]);
        if pull > friction {
            assert!(
                (total[1] + friction * total[0]).abs() < 1e-6 * total[0],
                "everything slides"
            );
        }
        assert!(
            answer.outcome.n_factorizations <= 40,
            "{:?}",
            answer.outcome
        );
    }
}
