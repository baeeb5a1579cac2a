//! Boundary of a mesh: the edges that belong to one cell only, linked into closed loops.
//!
//! For a segment from `a` to `b` the material lies on the left and the outward normal is
//! `n = (dy, -dx) / l` with `(dx, dy) = b - a` and `l` its length.

use std::ops::Range;

use crate::math::hypot;

use super::{Cells, MeshError, crossing, geometry};

const NONE: usize = usize::MAX;

/// One closed loop of the boundary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoundaryLoop {
    nodes: Vec<usize>,
    first_segment: usize,
}

impl BoundaryLoop {
    /// Node indices along the loop, material on the left, midside nodes included; the first node is
    /// the corner of lowest index and is not repeated at the end.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Segments of this loop within [`Boundary::segments`].
    pub fn segments(&self) -> Range<usize> {
        self.first_segment..self.first_segment + self.nodes.len()
    }
}

/// Closed loops around a mesh: the outer one first and counter-clockwise, then the holes, clockwise
/// and sorted by the lowest corner index.
///
/// The boundary passes every node at most once, so segment `s` starts at `nodes()[s]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    loops: Vec<BoundaryLoop>,
    segments: Vec<[usize; 2]>,
    nodes: Vec<usize>,
    next: Vec<usize>,
    previous: Vec<usize>,
    is_boundary: Vec<bool>,
    is_midside: Vec<bool>,
    mean_length: f64,
}

/// Side of a cell in mesh node numbers, the cell on its left; `midside` is `NONE` if it has none.
#[derive(Debug, Clone, Copy)]
struct Side {
    from: usize,
    to: usize,
    midside: usize,
    cell: usize,
}

impl Side {
    /// The same for both sides of an edge.
    fn edge(&self) -> [usize; 2] {
        [self.from.min(self.to), self.from.max(self.to)]
    }
}

impl Boundary {
    /// The loops, the outer one first.
    pub fn loops(&self) -> &[BoundaryLoop] {
        &self.loops
    }

    /// Straight segments over all loops consecutively, each from its first to its second node with
    /// the material on the left. An edge with a midside node gives two.
    pub fn segments(&self) -> &[[usize; 2]] {
        &self.segments
    }

    /// Mean length of a segment (m).
    pub fn mean_segment_length(&self) -> f64 {
        self.mean_length
    }

    /// Distinct boundary nodes in loop order.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Number of the segment that starts where `segment` ends.
    ///
    /// # Panics
    /// If there is no such segment.
    pub fn next_segment(&self, segment: usize) -> usize {
        self.next[segment]
    }

    /// Number of the segment that ends where `segment` starts.
    ///
    /// # Panics
    /// If there is no such segment.
    pub fn previous_segment(&self, segment: usize) -> usize {
        self.previous[segment]
    }

    /// Whether a node lies on the boundary; `false` for indices beyond the mesh.
    pub fn is_boundary(&self, node: usize) -> bool {
        self.is_boundary.get(node).copied().unwrap_or(false)
    }

    /// Whether a node lies on the boundary between the two corners of an edge; `false` for indices beyond the mesh.
    pub fn is_midside(&self, node: usize) -> bool {
        self.is_midside.get(node).copied().unwrap_or(false)
    }

    /// Shares of a segment that its first and its second node stand for (-): what a uniform load on it comes to at the nodes, by the
    /// shape functions of its edge. A half each, or a third at the corner and two thirds at the midside node.
    ///
    /// # Panics
    /// If there is no such segment.
    pub fn node_shares(&self, segment: usize) -> [f64; 2] {
        let [first, second] = self.segments[segment].map(|node| self.is_midside[node]);
        match (first, second) {
            (false, true) => [1.0 / 3.0, 2.0 / 3.0],
            (true, false) => [2.0 / 3.0, 1.0 / 3.0],
            _ => [0.5; 2],
        }
    }

    /// Finds the loops of cells whose indices and shapes have been checked.
    pub(super) fn new(nodes: &[[f64; 2]], cells: &Cells) -> Result<Self, MeshError> {
        let free = free_sides(cells, nodes.len())?;
        let mut rings = link(&free, nodes.len())?;
        // rings come sorted by their lowest corner; the largest encloses all others
        let areas: Vec<f64> = rings.iter().map(|ring| ring_area(nodes, ring)).collect();
        let outer = (0..rings.len()).max_by(|&a, &b| areas[a].total_cmp(&areas[b]));
        if let Some(outer) = outer {
            rings[..=outer].rotate_right(1);
        }
        let mut boundary = Self::from_rings(rings, nodes.len());
        boundary.mean_length = boundary.mean_length(nodes);
        for side in free.iter().filter(|side| side.midside != NONE) {
            boundary.is_midside[side.midside] = true;
        }
        Ok(boundary)
    }

    fn mean_length(&self, nodes: &[[f64; 2]]) -> f64 {
        let length = |&[a, b]: &[usize; 2]| {
            let ([a_x, a_y], [b_x, b_y]) = (nodes[a], nodes[b]);
            hypot(b_x - a_x, b_y - a_y)
        };
        self.segments.iter().map(length).sum::<f64>() / self.segments.len() as f64
    }

    fn from_rings(rings: Vec<Vec<usize>>, n_nodes: usize) -> Self {
        let mut boundary = Self {
            loops: Vec::with_capacity(rings.len()),
            segments: Vec::new(),
            nodes: Vec::new(),
            next: Vec::new(),
            previous: Vec::new(),
            is_boundary: vec![false; n_nodes],
            is_midside: vec![false; n_nodes],
            mean_length: 0.0,
        };
        for ring in rings {
            let (n, first_segment) = (ring.len(), boundary.segments.len());
            for (position, &node) in ring.iter().enumerate() {
                let following = (position + 1) % n;
                let preceding = (position + n - 1) % n;
                boundary.segments.push([node, ring[following]]);
                boundary.next.push(first_segment + following);
                boundary.previous.push(first_segment + preceding);
                boundary.is_boundary[node] = true;
            }
            boundary.nodes.extend_from_slice(&ring);
            boundary.loops.push(BoundaryLoop {
                nodes: ring,
                first_segment,
            });
        }
        boundary
    }

    /// Checks that the loops neither meet themselves nor each other and that one of them is outer.
    ///
    /// A point is covered as often as loops wind around it. With simple loops that stay apart, one
    /// of them counter-clockwise, that is once inside and never elsewhere: no cells overlap.
    pub(super) fn check_simple(&self, nodes: &[[f64; 2]]) -> Result<(), MeshError> {
        let tolerance = geometry::tolerance(nodes.iter().copied());
        if let Some(crossing) = crossing::find_crossing(nodes, &self.segments, tolerance) {
            return Err(MeshError::BoundaryCrossing {
                first: self.segments[crossing.first],
                second: self.segments[crossing.second],
                at: crossing.at,
            });
        }
        let mut outer = self
            .loops
            .iter()
            .filter(|ring| ring_area(nodes, &ring.nodes) > 0.0)
            .map(|ring| ring.nodes[0]);
        match (outer.next(), outer.next()) {
            (Some(first), Some(second)) => Err(MeshError::SeveralOuterLoops {
                n_outer: 2 + outer.count(),
                first,
                second,
            }),
            _ => Ok(()),
        }
    }
}

fn ring_area(nodes: &[[f64; 2]], ring: &[usize]) -> f64 {
    let points: Vec<[f64; 2]> = ring.iter().map(|&node| nodes[node]).collect();
    geometry::polygon_area(&points)
}

/// Sides that belong to one cell only, after checking that the others pair up.
fn free_sides(cells: &Cells, n_nodes: usize) -> Result<Vec<Side>, MeshError> {
    let mut is_taken = vec![false; n_nodes];
    let mut sides = Vec::with_capacity(4 * cells.len());
    for (index, cell) in cells.iter().enumerate() {
        for &corner in cell.corners() {
            is_taken[corner] = true;
        }
        sides.extend(cell.kind.edges().map(|edge| Side {
            from: cell.nodes[edge.from],
            to: cell.nodes[edge.to],
            midside: edge.midside.map_or(NONE, |midside| cell.nodes[midside]),
            cell: index,
        }));
    }
    sides.sort_unstable_by_key(|side| (side.edge(), side.cell));

    let mut free = Vec::new();
    for edge in sides.chunk_by(|a, b| a.edge() == b.edge()) {
        check_edge(edge)?;
        // a midside node belongs to its edge alone
        let midside = edge[0].midside;
        if midside != NONE && std::mem::replace(&mut is_taken[midside], true) {
            return Err(MeshError::HangingNode { node: midside });
        }
        if let [side] = edge {
            free.push(*side);
        }
    }
    Ok(free)
}

/// At most two cells meet at an edge, on different sides of it and with the same midside node.
fn check_edge(edge: &[Side]) -> Result<(), MeshError> {
    let [a, b] = edge[0].edge();
    match edge {
        [_] => Ok(()),
        [first, second] if first.from == second.from => Err(MeshError::OverlappingCells {
            first: first.cell,
            second: second.cell,
            a: first.from,
            b: first.to,
        }),
        [first, second] if first.midside != second.midside => Err(MeshError::MismatchedMidside {
            first: first.cell,
            second: second.cell,
            a,
            b,
        }),
        [_, _] => Ok(()),
        _ => Err(MeshError::NonManifoldEdge {
            a,
            b,
            n_cells: edge.len(),
        }),
    }
}

/// Links free sides to closed rings, each starting at its lowest corner, in ascending order of it.
fn link(free: &[Side], n_nodes: usize) -> Result<Vec<Vec<usize>>, MeshError> {
    let mut leaving = vec![NONE; n_nodes];
    for (index, side) in free.iter().enumerate() {
        if leaving[side.from] != NONE {
            return Err(MeshError::TouchingLoops { node: side.from });
        }
        leaving[side.from] = index;
    }
    let mut rings = Vec::new();
    for start in 0..n_nodes {
        let mut ring = Vec::new();
        let mut node = start;
        // every cell enters each of its corners once and leaves it once, so the ring closes
        while leaving[node] != NONE {
            let side = free[std::mem::replace(&mut leaving[node], NONE)];
            ring.push(node);
            if side.midside != NONE {
                ring.push(side.midside);
            }
            node = side.to;
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    Ok(rings)
}
