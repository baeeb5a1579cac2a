//! What is known of a system once its pattern is.

use super::problem::ConeProblem;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::BlockCholesky;

/// The patterns of `A` and of `H`, and their orders of elimination.
#[derive(Debug, Clone)]
pub(super) struct Analysis {
    /// The values of `A` of which `bodies` is the factor, if one was made.
    pub matrix: BlockMatrix,
    pub bodies: BlockCholesky,
    /// `H`.
    pub hull: BlockMatrix,
    /// `A` in the pattern of `H`.
    pub base: Vec<[f64; 4]>,
    pub factor: BlockCholesky,
    /// The place in `hull` of every block of `A`.
    pub matrix_places: Vec<u32>,
}

impl Analysis {
    /// The pattern that couples the nodes of each cell, beside those that `A` couples.
    pub fn new<Nodes: Iterator<Item = usize>>(
        matrix: &BlockMatrix,
        cells: impl Iterator<Item = Nodes>,
    ) -> Self {
        let hull = hull_of(matrix, cells);
        let mut analysis = Self {
            matrix: matrix.clone(),
            bodies: BlockCholesky::analyze(matrix),
            factor: BlockCholesky::analyze(&hull),
            hull,
            base: Vec::new(),
            matrix_places: Vec::new(),
        };
        analysis.place_matrix(matrix);
        analysis
    }

    /// Couples the nodes of these cells instead; `A` has the pattern that is known.
    pub fn couple<Nodes: Iterator<Item = usize>>(
        &mut self,
        matrix: &BlockMatrix,
        cells: impl Iterator<Item = Nodes>,
    ) {
        self.hull = hull_of(matrix, cells);
        self.factor = BlockCholesky::analyze(&self.hull);
        self.place_matrix(matrix);
    }

    fn place_matrix(&mut self, matrix: &BlockMatrix) {
        self.matrix_places.clear();
        for node in 0..matrix.n_nodes() {
            let neighbours = matrix.neighbours(node).iter();
            let places = neighbours.filter_map(|&other| place(&self.hull, node as u32, other));
            self.matrix_places.extend(places);
        }
        self.base.clear();
        self.base.resize(self.hull.blocks().len(), [0.0; 4]);
        for (&place, block) in self.matrix_places.iter().zip(matrix.blocks()) {
            self.base[place as usize] = *block;
        }
    }
}

fn hull_of<Nodes: Iterator<Item = usize>>(
    matrix: &BlockMatrix,
    cells: impl Iterator<Item = Nodes>,
) -> BlockMatrix {
    let mut members: Vec<usize> = Vec::new();
    let mut ends = vec![0];
    for node in 0..matrix.n_nodes() {
        let neighbours = matrix.neighbours(node).iter().map(|&other| other as usize);
        for other in neighbours.filter(|&other| other > node) {
            members.extend([node, other]);
            ends.push(members.len());
        }
    }
    for nodes in cells {
        members.extend(nodes);
        ends.push(members.len());
    }
    let cells = ends.windows(2).map(|ends| &members[ends[0]..ends[1]]);
    BlockMatrix::from_cells(matrix.n_nodes(), cells)
}

/// Whether the pattern couples all nodes of each row.
pub(super) fn covers(matrix: &BlockMatrix, problem: &ConeProblem) -> bool {
    problem.rows.iter().all(|row| {
        let entries = problem.entries_of(row);
        let mut pairs = entries
            .iter()
            .flat_map(|one| entries.iter().map(move |other| [one.node, other.node]));
        pairs.all(|[one, other]| place(matrix, one, other).is_some())
    })
}

/// The place of a block among all of a matrix.
pub(super) fn place(matrix: &BlockMatrix, row: u32, column: u32) -> Option<u32> {
    let found = matrix
        .neighbours(row as usize)
        .binary_search(&column)
        .ok()?;
    u32::try_from(matrix.row_start(row as usize) + found).ok()
}
