//! The pattern of the factor: panels of up to four node columns that share their rows.
//!
//! Columns with the same rows below them ("supernodes") are stored together, so that a row is
//! looked up once for eight dofs instead of once for two. A child that nearly fits its parent is
//! joined to it, at the price of stored zeros, whenever a model of the solve says that the joined
//! panel is cheaper (Ashcraft, Grimes 1989).

use super::ordering::Ordering;
use crate::linalg::block_matrix::BlockMatrix;

/// The most node columns in one panel: eight dofs, two AVX registers.
pub(super) const MAX_WIDTH: usize = 4;

/// Some successive node columns of the factor and the rows below them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Panel {
    /// The position of the first column.
    pub first: u32,
    /// The number of node columns, at most [`MAX_WIDTH`].
    pub width: u32,
    /// The rows below the panel, as a range of [`Panels::rows`], even in length.
    pub rows: [u32; 2],
    /// Where its values begin, in units of four.
    pub values: u32,
    /// The panels that change this one, as a range of [`Panels::updates`].
    pub updates: [u32; 2],
}

/// Says that the rows `rows[0]..rows[1]` of panel `source` are columns of the panel it is listed
/// for.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Update {
    pub source: u32,
    pub rows: [u32; 2],
}

/// All panels of a factor, in the order of elimination.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    pub panels: Vec<Panel>,
    /// Positions, ascending within a panel; `n_nodes` stands for a row that fills up a pair.
    pub rows: Vec<u32>,
    pub updates: Vec<Update>,
    /// The length of the values, in units of four.
    pub n_values: usize,
}

/// What one panel stores, as slices.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    /// The rows below the panel, in pairs.
    pub indices: &'a [u32],
    /// `L⁻¹` of the diagonal block, one tile per four rows; rows that fill up a tile are zero.
    pub diagonal: &'a [[f64; 4]],
    /// `L` below it, one tile per pair of node rows.
    pub tiles: &'a [[f64; 4]],
}

impl Panels {
    /// The parts of a panel of `K` dof columns. A tile is four dof rows by `K` columns, column
    /// after column.
    #[inline(always)]
    pub fn view<'a, const K: usize>(&'a self, panel: &Panel, values: &'a [[f64; 4]]) -> View<'a> {
        let indices = &self.rows[panel.rows[0] as usize..panel.rows[1] as usize];
        let n_diagonal = K.div_ceil(4) * K;
        let values = &values[panel.values as usize..][..n_diagonal + indices.len() / 2 * K];
        let (diagonal, tiles) = values.split_at(n_diagonal);
        View {
            indices,
            diagonal,
            tiles,
        }
    }
}

/// A set of columns `first..end` with the positions of their common rows below.
struct Supernode {
    first: u32,
    end: u32,
    rows: Vec<u32>,
}

impl Panels {
    pub fn new(matrix: &BlockMatrix, ordering: &Ordering) -> Self {
        let mut this = Self::default();
        for supernode in supernodes(matrix, ordering) {
            this.push_supernode(&supernode, ordering.node_at.len() as u32);
        }
        this.list_updates(ordering.node_at.len());
        this
    }

    /// The number of stored entries of the lower triangle, joined columns' zeros included.
    pub fn n_nonzeros(&self, n_nodes: usize) -> usize {
        let entries = |panel: &Panel| {
            let columns = 2 * panel.width as usize;
            let rows = &self.rows[panel.rows[0] as usize..panel.rows[1] as usize];
            let n_rows = rows.iter().filter(|&&row| (row as usize) < n_nodes).count();
            columns * (columns + 1) / 2 + 2 * n_rows * columns
        };
        self.panels.iter().map(entries).sum()
    }

    /// The sum of the squares of the columns' lengths, diagonal entries and joined columns' zeros included.
    pub fn n_operations(&self, n_nodes: usize) -> f64 {
        let of_panel = |panel: &Panel| {
            let columns = 2 * panel.width as usize;
            let rows = &self.rows[panel.rows[0] as usize..panel.rows[1] as usize];
            let n_rows = rows.iter().filter(|&&row| (row as usize) < n_nodes).count();
            let lengths = (1..=columns).map(|within| (within + 2 * n_rows) as f64);
            lengths.map(|length| length * length).sum::<f64>()
        };
        self.panels.iter().map(of_panel).sum()
    }

    /// The panels that hold a wanted position, and all that those depend on: a panel's rows are among the columns of
    /// its ancestors, and its first row is a column of its parent.
    ///
    /// - `is_wanted_position`: one for each position; parents of wanted ones are added.
    /// - `is_wanted`: overwritten, one for each panel.
    pub fn close_upwards(&self, is_wanted_position: &mut [bool], is_wanted: &mut Vec<bool>) {
        let n_nodes = is_wanted_position.len();
        is_wanted.clear();
        for panel in &self.panels {
            let mut own = panel.first as usize..(panel.first + panel.width) as usize;
            let wanted = own.any(|position| is_wanted_position[position]);
            let parent = self.rows[panel.rows[0] as usize..panel.rows[1] as usize].first();
            if let (true, Some(&row)) = (wanted, parent)
                && (row as usize) < n_nodes
            {
                is_wanted_position[row as usize] = true;
            }
            is_wanted.push(wanted);
        }
    }

    fn push_supernode(&mut self, supernode: &Supernode, n_nodes: u32) {
        let mut first = supernode.first;
        while first < supernode.end {
            let end = supernode.end.min(first + MAX_WIDTH as u32);
            let start = self.rows.len() as u32;
            self.rows.extend(end..supernode.end);
            self.rows.extend(&supernode.rows);
            if (self.rows.len() as u32 - start) % 2 == 1 {
                self.rows.push(n_nodes);
            }
            let rows = [start, self.rows.len() as u32];
            self.panels.push(Panel {
                first,
                width: end - first,
                rows,
                values: self.n_values as u32,
                updates: [0, 0],
            });
            let n_tiles = (end - first).div_ceil(2) + (rows[1] - rows[0]) / 2;
            self.n_values += (n_tiles * 2 * (end - first)) as usize;
            first = end;
        }
    }

    /// Lists for each panel the earlier panels with rows in its columns.
    fn list_updates(&mut self, n_nodes: usize) {
        let mut panel_of = vec![0; n_nodes];
        for (index, panel) in self.panels.iter().enumerate() {
            panel_of[panel.first as usize..(panel.first + panel.width) as usize].fill(index);
        }
        let mut lists: Vec<Vec<Update>> = vec![Vec::new(); self.panels.len()];
        for (source, panel) in self.panels.iter().enumerate() {
            let [mut row, end] = panel.rows;
            while row < end && (self.rows[row as usize] as usize) < n_nodes {
                let target = panel_of[self.rows[row as usize] as usize];
                let beyond = self.panels[target].first + self.panels[target].width;
                let mut last = row + 1;
                while last < end && self.rows[last as usize] < beyond {
                    last += 1;
                }
                lists[target].push(Update {
                    source: source as u32,
                    rows: [row, last],
                });
                row = last;
            }
        }
        for (panel, list) in self.panels.iter_mut().zip(lists) {
            let start = self.updates.len() as u32;
            self.updates.extend(list);
            panel.updates = [start, self.updates.len() as u32];
        }
    }
}

/// The modelled cost of a solve with `width` columns of a supernode over `n_rows` common rows: two
/// per column of each tile, and for each panel its diagonal block and a start.
fn solve_cost(width: u32, n_rows: u32) -> u32 {
    let mut cost = 0;
    let mut left = width;
    while left > 0 {
        let columns = left.min(MAX_WIDTH as u32);
        left -= columns;
        cost += PANEL_COST + columns * columns + (left + n_rows).div_ceil(2) * 2 * columns;
    }
    cost
}

/// The start of a panel in [`solve_cost`]. Of 2, 4 and 6, 4 solves fastest at 126 and 1,458 dofs
/// (by 10 to 20 %), and all are within 2 % at 8,442; 2 would factorize small bodies a quarter
/// faster.
const PANEL_COST: u32 = 4;

/// Groups the columns into supernodes and finds their rows.
fn supernodes(matrix: &BlockMatrix, ordering: &Ordering) -> Vec<Supernode> {
    let ranges = joined_columns(ordering);
    let n = ordering.node_at.len();
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); ranges.len()];
    let mut range_of = vec![0; n];
    for (index, range) in ranges.iter().enumerate() {
        range_of[range.0 as usize..range.1 as usize].fill(index);
    }
    let mut supernodes: Vec<Supernode> = Vec::with_capacity(ranges.len());
    let mut last_seen = vec![usize::MAX; n];
    for (index, &(first, end)) in ranges.iter().enumerate() {
        let mut rows = Vec::new();
        let mut take = |row: u32| {
            if row >= end && last_seen[row as usize] != index {
                last_seen[row as usize] = index;
                rows.push(row);
            }
        };
        for position in first..end {
            let neighbours = matrix.neighbours(ordering.node_at[position as usize] as usize);
            neighbours
                .iter()
                .for_each(|&node| take(ordering.position_of[node as usize]));
        }
        for &child in &children[index] {
            supernodes[child].rows.iter().for_each(|&row| take(row));
        }
        rows.sort_unstable();
        if let Some(&row) = rows.first() {
            children[range_of[row as usize]].push(index);
        }
        supernodes.push(Supernode { first, end, rows });
    }
    supernodes
}

/// Joins successive columns into ranges `(first, end)` as long as the modelled solve becomes
/// cheaper.
fn joined_columns(ordering: &Ordering) -> Vec<(u32, u32)> {
    // A column opens as a range of its own; the range before it is joined to it if it is its child.
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for position in 0..ordering.node_at.len() as u32 {
        let n_below = ordering.n_below[position as usize];
        let (mut first, end) = (position, position + 1);
        while let Some(&(child_first, child_end)) = ranges.last() {
            let child_below = ordering.n_below[child_end as usize - 1];
            let is_child = child_end == first
                && (first..end).contains(&ordering.parent[child_end as usize - 1]);
            let apart =
                solve_cost(child_end - child_first, child_below) + solve_cost(end - first, n_below);
            if !is_child || solve_cost(end - child_first, n_below) > apart {
                break;
            }
            first = child_first;
            ranges.pop();
        }
        ranges.push((first, end));
    }
    ranges
}
