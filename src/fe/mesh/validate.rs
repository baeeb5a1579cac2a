//! Checks of nodes and cells: `det J > 0` at every node of every cell, one piece, no spare nodes.

use crate::math::rounding;
use std::collections::HashMap;

use super::{Cells, MeshError, geometry};

/// A Jacobian below this fraction of the squared longest side counts as zero: rounding of the
/// coordinates leaves about 1e-16, and no usable cell comes near.
const DEGENERATE: f64 = rounding::ITERATED;

pub(super) fn check_nodes(nodes: &[[f64; 2]]) -> Result<(), MeshError> {
    if nodes.is_empty() {
        return Err(MeshError::NoNodes);
    }
    for (node, &at) in nodes.iter().enumerate() {
        if !at.iter().all(|x| x.is_finite()) {
            return Err(MeshError::NonFiniteNode { node, at });
        }
    }
    Ok(())
}

/// Every cell names existing, distinct nodes and every node is named by a cell.
pub(super) fn check_indices(cells: &Cells, n_nodes: usize) -> Result<(), MeshError> {
    if cells.len() == 0 {
        return Err(MeshError::NoCells);
    }
    let mut used = vec![false; n_nodes];
    for (cell, nodes) in cells.iter().map(|cell| cell.nodes).enumerate() {
        for (local, &node) in nodes.iter().enumerate() {
            if node >= n_nodes {
                return Err(MeshError::NodeOutOfRange {
                    cell,
                    node,
                    n_nodes,
                });
            }
            if nodes[..local].contains(&node) {
                return Err(MeshError::RepeatedNode { cell, node });
            }
            used[node] = true;
        }
    }
    match used.iter().position(|&used| !used) {
        Some(node) => Err(MeshError::OrphanNode { node }),
        None => Ok(()),
    }
}

/// No two nodes lie at the same place; a hash grid of the width of the tolerance finds them.
pub(super) fn check_coincidence(nodes: &[[f64; 2]]) -> Result<(), MeshError> {
    let [low, high] = geometry::bounds(nodes.iter().copied());
    let tolerance = geometry::RELATIVE_TOLERANCE * geometry::distance(low, high);
    let width = tolerance.max(f64::MIN_POSITIVE);
    let mut grid: HashMap<[i64; 2], usize> = HashMap::with_capacity(nodes.len());
    for (second, &at) in nodes.iter().enumerate() {
        let key = [0, 1].map(|axis| ((at[axis] - low[axis]) / width).floor() as i64);
        for shift in 0..9 {
            let neighbour = [key[0] + shift % 3 - 1, key[1] + shift / 3 - 1];
            let found = grid.get(&neighbour).copied();
            // of two nodes in one grid square the later would hide the earlier, so these count too
            let is_close = |first: &usize| geometry::distance(nodes[*first], at) <= 2.0 * tolerance;
            if let Some(first) = found.filter(is_close) {
                return Err(MeshError::CoincidentNodes { first, second, at });
            }
        }
        grid.insert(key, second);
    }
    Ok(())
}

/// Every cell is counter-clockwise, has area and is not folded at a node.
pub(super) fn check_shapes(nodes: &[[f64; 2]], cells: &Cells) -> Result<(), MeshError> {
    for (index, cell) in cells.iter().enumerate() {
        let points = cell.points(nodes);
        let n = cell.kind.n_corners();
        let size = (0..n)
            .map(|corner| geometry::distance(points[corner], points[(corner + 1) % n]))
            .fold(0.0, f64::max);
        let smallest = DEGENERATE * size * size;
        let area = geometry::polygon_area(&points[..n]);
        if area.abs() <= smallest {
            return Err(MeshError::DegenerateCell {
                cell: index,
                area,
                size,
            });
        }
        if area < 0.0 {
            return Err(MeshError::InvertedCell { cell: index, area });
        }
        let jacobians = geometry::nodal_jacobians(cell.kind, &points);
        for (&node, &jacobian) in cell.nodes.iter().zip(&jacobians) {
            if jacobian <= smallest {
                return Err(MeshError::FoldedCell {
                    cell: index,
                    kind: cell.kind,
                    node,
                    jacobian,
                });
            }
        }
    }
    Ok(())
}

/// All cells hang together; every node belongs to a cell.
pub(super) fn check_connected(cells: &Cells, n_nodes: usize) -> Result<(), MeshError> {
    let mut parent: Vec<usize> = (0..n_nodes).collect();
    for cell in cells.iter() {
        for &node in &cell.nodes[1..] {
            let (a, b) = (
                find_root(&mut parent, cell.nodes[0]),
                find_root(&mut parent, node),
            );
            // the lower index becomes the root, so node 0 stands for the first piece
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut roots = (0..n_nodes).filter(|&node| parent[node] == node);
    let first = roots.next();
    match (first, roots.next()) {
        (Some(first), Some(second)) => Err(MeshError::Disconnected {
            n_pieces: 2 + roots.count(),
            first,
            second,
        }),
        _ => Ok(()),
    }
}

fn find_root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}
