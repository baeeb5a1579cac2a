//! The order in which nodes are eliminated: `P A Pᵀ` has a sparser Cholesky factor than `A`.
//!
//! Approximate minimum degree (Amestoy, Davis, Duff 1996; faer's implementation) on the graph of
//! nodes, then a postorder of the elimination tree, so that columns with nearly the same pattern
//! become neighbours.

use crate::linalg::block_matrix::BlockMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Marks the root of a tree, and an unset entry.
pub(super) const NONE: u32 = u32::MAX;

/// An elimination order with its elimination tree; every position below refers to that order.
pub(super) struct Ordering {
    /// The node eliminated at each position.
    pub node_at: Vec<u32>,
    /// The position of each node.
    pub position_of: Vec<u32>,
    /// The parent of each position in the elimination tree, above it, or [`NONE`].
    pub parent: Vec<u32>,
    /// The number of blocks below the diagonal in each column of the factor.
    pub n_below: Vec<u32>,
}

impl Ordering {
    /// Orders the nodes of `matrix` for little fill, postordered.
    pub fn new(matrix: &BlockMatrix) -> Self {
        let by_degree = Self::with_order(matrix, minimum_degree(matrix));
        let postorder = by_degree.postorder();
        let order = postorder
            .iter()
            .map(|&position| by_degree.node_at[position as usize])
            .collect();
        Self::with_order(matrix, order)
    }

    fn with_order(matrix: &BlockMatrix, node_at: Vec<u32>) -> Self {
        let mut position_of = vec![0; node_at.len()];
        for (position, &node) in node_at.iter().enumerate() {
            position_of[node as usize] = position as u32;
        }
        let parent = elimination_tree(matrix, &node_at, &position_of);
        let n_below = column_counts(matrix, &node_at, &position_of, &parent);
        Self {
            node_at,
            position_of,
            parent,
            n_below,
        }
    }

    /// Visits children before parents, and among siblings the one with the longest column last: it
    /// is the one that shares most of its parent's pattern, and so the one worth joining to it.
    fn postorder(&self) -> Vec<u32> {
        let n = self.parent.len();
        let mut by_length: Vec<u32> = (0..n as u32).collect();
        by_length.sort_by_key(|&position| self.n_below[position as usize]);
        let (mut first_child, mut next_sibling) = (vec![NONE; n], vec![NONE; n]);
        let mut stack: Vec<u32> = Vec::new();
        // Pushing at the front: the shortest child ends up last in the list and first off the
        // stack.
        for &position in &by_length {
            match self.parent[position as usize] {
                NONE => stack.push(position),
                parent => {
                    next_sibling[position as usize] = first_child[parent as usize];
                    first_child[parent as usize] = position;
                }
            }
        }
        let mut order = Vec::with_capacity(n);
        while let Some(&position) = stack.last() {
            let mut child = std::mem::replace(&mut first_child[position as usize], NONE);
            if child == NONE {
                order.push(position);
                stack.pop();
            }
            while child != NONE {
                stack.push(child);
                child = next_sibling[child as usize];
            }
        }
        order
    }
}

/// The positions coupled with `position` and eliminated before it.
fn earlier<'a>(
    matrix: &'a BlockMatrix,
    node_at: &[u32],
    position_of: &'a [u32],
    position: usize,
) -> impl Iterator<Item = usize> + 'a {
    let neighbours = matrix.neighbours(node_at[position] as usize);
    neighbours
        .iter()
        .map(|&node| position_of[node as usize] as usize)
        .filter(move |&other| other < position)
}

/// Liu's algorithm, with path compression.
fn elimination_tree(matrix: &BlockMatrix, node_at: &[u32], position_of: &[u32]) -> Vec<u32> {
    let n = node_at.len();
    let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
    for position in 0..n {
        for mut other in earlier(matrix, node_at, position_of, position) {
            loop {
                let next = std::mem::replace(&mut ancestor[other], position as u32);
                if next == NONE {
                    parent[other] = position as u32;
                    break;
                }
                if next as usize >= position {
                    break;
                }
                other = next as usize;
            }
        }
    }
    parent
}

/// Counts the blocks below the diagonal of each column, walking the subtree that makes up each row
/// of the factor.
fn column_counts(
    matrix: &BlockMatrix,
    node_at: &[u32],
    position_of: &[u32],
    parent: &[u32],
) -> Vec<u32> {
    let n = node_at.len();
    let (mut count, mut last_row_seen) = (vec![0; n], vec![NONE; n]);
    for position in 0..n {
        last_row_seen[position] = position as u32;
        for mut other in earlier(matrix, node_at, position_of, position) {
            while last_row_seen[other] != position as u32 {
                last_row_seen[other] = position as u32;
                count[other] += 1;
                other = parent[other] as usize;
            }
        }
    }
    count
}

/// faer's approximate minimum degree; the given order if it fails, which costs fill but no
/// correctness.
fn minimum_degree(matrix: &BlockMatrix) -> Vec<u32> {
    let n = matrix.n_nodes();
    let mut order: Vec<u32> = (0..n as u32).collect();
    if n < 3 {
        return order;
    }
    let (mut column_start, mut rows) = (vec![0], Vec::new());
    for node in 0..n {
        rows.extend(
            matrix
                .neighbours(node)
                .iter()
                .copied()
                .filter(|&other| other as usize <= node),
        );
        column_start.push(rows.len() as u32);
    }
    let upper = SymbolicSparseColMatRef::new_checked(n, n, &column_start, None, &rows);
    let mut inverse = vec![0; n];
    let mut memory = MemBuffer::new(amd::order_maybe_unsorted_scratch::<u32>(n, rows.len()));
    let stack = MemStack::new(&mut memory);
    if amd::order_maybe_unsorted(
        &mut order,
        &mut inverse,
        upper,
        amd::Control::default(),
        stack,
    )
    .is_err()
    {
        order = (0..n as u32).collect();
    }
    order
}
