//! Which nodes of a mesh have blocks with each other.

use crate::math::mix;

/// Where the blocks of a matrix are: compressed rows of nodes, both triangles, columns ascending.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Pattern {
    /// Where each row begins in `columns`, and where the last one ends.
    pub row_start: Vec<usize>,
    pub columns: Vec<u32>,
    /// A number that is the same for the same places, on every machine.
    pub fingerprint: u64,
}

impl Pattern {
    /// Couples the nodes of every cell with each other, and every node with itself.
    pub fn from_cells<'a>(
        n_nodes: usize,
        cells: impl Iterator<Item = &'a [usize]> + Clone,
    ) -> Self {
        assert!(
            u32::try_from(n_nodes).is_ok(),
            "{n_nodes} nodes need more than 32-bit numbers"
        );
        let (cell_start, cells_of_node) = cells_around_nodes(n_nodes, cells.clone());
        let cells: Vec<&[usize]> = cells.collect();
        let mut row_start = Vec::with_capacity(n_nodes + 1);
        let mut columns: Vec<u32> = Vec::new();
        let mut last_row_seen = vec![usize::MAX; n_nodes];
        row_start.push(0);
        for node in 0..n_nodes {
            let start = columns.len();
            last_row_seen[node] = node;
            columns.push(node as u32);
            for &cell in &cells_of_node[cell_start[node]..cell_start[node + 1]] {
                for &other in cells[cell] {
                    if last_row_seen[other] != node {
                        last_row_seen[other] = node;
                        columns.push(other as u32);
                    }
                }
            }
            columns[start..].sort_unstable();
            row_start.push(columns.len());
        }
        let starts = row_start.iter().map(|&start| start as u64);
        let places = starts.chain(columns.iter().map(|&column| u64::from(column)));
        let fingerprint = places.fold(0, mix);
        Self {
            row_start,
            columns,
            fingerprint,
        }
    }

    /// The places of one row's blocks.
    pub fn row(&self, node: usize) -> std::ops::Range<usize> {
        self.row_start[node]..self.row_start[node + 1]
    }
}

/// Lists the cells around each node, compressed: those of `node` are `list[start[node]..start[node
/// + 1]]`.
fn cells_around_nodes<'a>(
    n_nodes: usize,
    cells: impl Iterator<Item = &'a [usize]> + Clone,
) -> (Vec<usize>, Vec<usize>) {
    let mut start = vec![0; n_nodes + 1];
    for &node in cells.clone().flatten() {
        assert!(
            node < n_nodes,
            "a cell names node {node}, but there are only {n_nodes} nodes"
        );
        start[node + 1] += 1;
    }
    for node in 0..n_nodes {
        start[node + 1] += start[node];
    }
    let mut next = start.clone();
    let mut list = vec![0; start[n_nodes]];
    for (cell, nodes) in cells.enumerate() {
        for &node in nodes {
            list[next[node]] = cell;
            next[node] += 1;
        }
    }
    (start, list)
}
