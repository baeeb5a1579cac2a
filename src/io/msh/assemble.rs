//! From the elements of a file to a mesh with named cells and nodes.

use super::element::{ElementKind, turn};
use super::error::MshError;
use super::file::{Element, File, Group};
use super::reader::Reader;
use super::{MshMesh, NamedCells, NamedNodes};
use crate::fe::mesh::{CellKind, Mesh, MeshError};
use std::collections::{BTreeMap, HashMap};

/// Coordinates z may differ by this part of the size of the mesh: they have been computed.
const FLATNESS: f64 = 1e-9;

/// A cell with the number it has in the file; nodes are indices of the file's list.
struct FileCell {
    tag: u64,
    kind: CellKind,
    nodes: Vec<usize>,
}

/// A file whose references have been resolved.
struct Resolved {
    /// Numbers of the nodes and coordinates in the plane (m).
    tags: Vec<u64>,
    points: Vec<[f64; 2]>,
    cells: Vec<FileCell>,
    /// By dimension (2 first) and number of the group: cells, or nodes.
    regions: BTreeMap<i64, Vec<usize>>,
    curves: BTreeMap<i64, Vec<usize>>,
    corners: BTreeMap<i64, Vec<usize>>,
    names: HashMap<(i64, i64), String>,
}

pub(super) fn whole(bytes: &[u8]) -> Result<MshMesh, MshError> {
    let resolved = Resolved::new(bytes)?;
    let cells: Vec<usize> = (0..resolved.cells.len()).collect();
    resolved.mesh_of(&cells)
}

pub(super) fn pieces(bytes: &[u8]) -> Result<Vec<MshMesh>, MshError> {
    let resolved = Resolved::new(bytes)?;
    let pieces = resolved.pieces();
    pieces.iter().map(|cells| resolved.mesh_of(cells)).collect()
}

impl Resolved {
    fn new(bytes: &[u8]) -> Result<Self, MshError> {
        let mut reader = Reader::new(bytes);
        let file = File::read(&mut reader)?;
        let mut index_of = HashMap::with_capacity(file.nodes.len());
        for (index, node) in file.nodes.iter().enumerate() {
            if index_of.insert(node.tag, index).is_some() {
                return Err(MshError::RepeatedNode {
                    place: reader.place(node.offset),
                    tag: node.tag,
                });
            }
        }
        let mut resolved = Self {
            tags: file.nodes.iter().map(|node| node.tag).collect(),
            points: file
                .nodes
                .iter()
                .map(|node| [node.at[0], node.at[1]])
                .collect(),
            cells: Vec::new(),
            regions: BTreeMap::new(),
            curves: BTreeMap::new(),
            corners: BTreeMap::new(),
            names: HashMap::new(),
        };
        // Version 2 repeats an element for each of its groups.
        let mut cell_of: HashMap<Vec<usize>, usize> = HashMap::new();
        for element in &file.elements {
            let nodes = nodes_of(element, &file, &index_of, &reader)?;
            resolved.enter(element, nodes, &file.entities, &mut cell_of);
        }
        if resolved.cells.is_empty() {
            return Err(MshError::NoCells);
        }
        resolved.check_plane(&file, &reader)?;
        resolved.names = file.names;
        Ok(resolved)
    }

    /// Enters an element into the cells, or its nodes into its groups.
    fn enter(
        &mut self,
        element: &Element,
        mut nodes: Vec<usize>,
        entities: &HashMap<(i64, i64), Vec<i64>>,
        cell_of: &mut HashMap<Vec<usize>, usize>,
    ) {
        let physical;
        let groups: &[i64] = match element.group {
            Group::Physical(0) => &[],
            Group::Physical(group) => {
                physical = [group];
                &physical
            }
            Group::Entity(dimension, tag) => {
                entities.get(&(dimension, tag)).map_or(&[], Vec::as_slice)
            }
        };
        let ElementKind::Cell(kind) = element.kind else {
            let sets = if element.kind.dimension() == 1 {
                &mut self.curves
            } else {
                &mut self.corners
            };
            for &group in groups {
                sets.entry(group).or_default().extend_from_slice(&nodes);
            }
            return;
        };
        if corner_area(kind, &nodes, &self.points) < 0.0 {
            turn(kind, &mut nodes);
        }
        let mut key = nodes.clone();
        key.sort_unstable();
        let cell = *cell_of.entry(key).or_insert(self.cells.len());
        if cell == self.cells.len() {
            let tag = element.tag;
            self.cells.push(FileCell { tag, kind, nodes });
        }
        for &group in groups {
            self.regions.entry(group).or_default().push(cell);
        }
    }

    /// The nodes of cells have one z.
    fn check_plane(&self, file: &File, reader: &Reader<'_>) -> Result<(), MshError> {
        let used = || self.cells.iter().flat_map(|cell| &cell.nodes);
        let [mut low, mut high] = [self.points[self.cells[0].nodes[0]]; 2];
        for &node in used() {
            let [x, y] = self.points[node];
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        let first = file.nodes[self.cells[0].nodes[0]].at[2];
        let off = used().find(|&&node| (file.nodes[node].at[2] - first).abs() > FLATNESS * size);
        match off {
            Some(&node) => Err(MshError::NotPlane {
                place: reader.place(file.nodes[node].offset),
                tag: self.tags[node],
                z: file.nodes[node].at[2],
                other: first,
            }),
            None => Ok(()),
        }
    }

    /// Cells that hang together by nodes, in lists ordered by their first cells.
    fn pieces(&self) -> Vec<Vec<usize>> {
        let mut parent: Vec<usize> = (0..self.points.len()).collect();
        for cell in &self.cells {
            for &node in &cell.nodes[1..] {
                let (a, b) = (root(&mut parent, cell.nodes[0]), root(&mut parent, node));
                parent[a.max(b)] = a.min(b);
            }
        }
        let mut pieces: Vec<Vec<usize>> = Vec::new();
        let mut piece_of: HashMap<usize, usize> = HashMap::new();
        for (index, cell) in self.cells.iter().enumerate() {
            let root = root(&mut parent, cell.nodes[0]);
            let piece = *piece_of.entry(root).or_insert(pieces.len());
            if piece == pieces.len() {
                pieces.push(Vec::new());
            }
            pieces[piece].push(index);
        }
        pieces
    }

    /// The mesh of some of the cells, ascending.
    fn mesh_of(&self, chosen: &[usize]) -> Result<MshMesh, MshError> {
        let mut is_used = vec![false; self.points.len()];
        let nodes = chosen.iter().flat_map(|&cell| &self.cells[cell].nodes);
        nodes.for_each(|&node| is_used[node] = true);
        let kept: Vec<usize> = (0..is_used.len()).filter(|&node| is_used[node]).collect();
        let mut new_node = vec![usize::MAX; is_used.len()];
        for (new, &old) in kept.iter().enumerate() {
            new_node[old] = new;
        }
        let cells: Vec<(CellKind, Vec<usize>)> = chosen
            .iter()
            .map(|&cell| {
                let cell = &self.cells[cell];
                let nodes = cell.nodes.iter().map(|&node| new_node[node]).collect();
                (cell.kind, nodes)
            })
            .collect();
        let points = kept.iter().map(|&node| self.points[node]).collect();
        let mesh = Mesh::from_mixed_cells(points, &cells)
            .map_err(|source| self.explain(source, chosen, &kept))?;
        Ok(MshMesh {
            regions: self.named_cells(chosen),
            boundaries: self.named_nodes(&new_node),
            n_dropped_nodes: self.points.len() - kept.len(),
            mesh,
        })
    }

    fn named_cells(&self, chosen: &[usize]) -> Vec<NamedCells> {
        let is_whole = chosen.len() == self.cells.len();
        let mut regions = Vec::new();
        for (&group, cells) in &self.regions {
            let mut cells: Vec<usize> = cells
                .iter()
                .filter_map(|cell| chosen.binary_search(cell).ok())
                .collect();
            cells.sort_unstable();
            cells.dedup();
            if is_whole || !cells.is_empty() {
                let name = self.name(2, group);
                regions.push(NamedCells { name, cells });
            }
        }
        regions
    }

    /// `new_node`: by node of the file its index in the mesh, or `usize::MAX`.
    fn named_nodes(&self, new_node: &[usize]) -> Vec<NamedNodes> {
        let mut sets: Vec<NamedNodes> = Vec::new();
        let mut set_of: HashMap<String, usize> = HashMap::new();
        for (dimension, groups) in [(1, &self.curves), (0, &self.corners)] {
            for (&group, nodes) in groups {
                let name = self.name(dimension, group);
                let known = nodes.iter().map(|&node| new_node[node]);
                let known = known.filter(|&node| node != usize::MAX);
                let set = *set_of.entry(name.clone()).or_insert(sets.len());
                if set == sets.len() {
                    let nodes = Vec::new();
                    sets.push(NamedNodes { name, nodes });
                }
                sets[set].nodes.extend(known);
            }
        }
        for set in &mut sets {
            set.nodes.sort_unstable();
            set.nodes.dedup();
        }
        sets
    }

    fn name(&self, dimension: i64, group: i64) -> String {
        let name = self.names.get(&(dimension, group));
        name.cloned().unwrap_or_else(|| group.to_string())
    }

    /// Adds the numbers that the file has for what an error is about.
    fn explain(&self, source: MeshError, chosen: &[usize], kept: &[usize]) -> MshError {
        let (cell, nodes) = subject(&source);
        let tag_of = |node: usize| kept.get(node).map(|&old| self.tags[old]);
        let element = cell.and_then(|cell| chosen.get(cell));
        MshError::Mesh {
            element: element.map(|&cell| self.cells[cell].tag),
            nodes: nodes.map(|node| node.and_then(tag_of)),
            source,
        }
    }
}

/// The cell and the nodes that an error is about.
fn subject(error: &MeshError) -> (Option<usize>, [Option<usize>; 2]) {
    match *error {
        MeshError::DegenerateCell { cell, .. } | MeshError::InvertedCell { cell, .. } => {
            (Some(cell), [None; 2])
        }
        MeshError::RepeatedNode { cell, node } | MeshError::FoldedCell { cell, node, .. } => {
            (Some(cell), [Some(node), None])
        }
        MeshError::CoincidentNodes { first, second, .. }
        | MeshError::Disconnected { first, second, .. }
        | MeshError::SeveralOuterLoops { first, second, .. } => (None, [Some(first), Some(second)]),
        MeshError::NonManifoldEdge { a, b, .. } => (None, [Some(a), Some(b)]),
        MeshError::OverlappingCells { first, a, b, .. }
        | MeshError::MismatchedMidside { first, a, b, .. } => (Some(first), [Some(a), Some(b)]),
        MeshError::HangingNode { node } | MeshError::TouchingLoops { node } => {
            (None, [Some(node), None])
        }
        MeshError::BoundaryCrossing { first, second, .. } => {
            (None, [Some(first[0]), Some(second[0])])
        }
        _ => (None, [None; 2]),
    }
}

fn nodes_of(
    element: &Element,
    file: &File,
    index_of: &HashMap<u64, usize>,
    reader: &Reader<'_>,
) -> Result<Vec<usize>, MshError> {
    let tags = &file.element_nodes[element.first_node..element.first_node + element.n_nodes];
    let nodes = tags.iter().map(|tag| {
        index_of.get(tag).copied().ok_or(MshError::MissingNode {
            place: reader.place(element.offset),
            tag: element.tag,
            node: *tag,
        })
    });
    nodes.collect()
}

/// Signed area (m²) of the polygon of corners.
fn corner_area(kind: CellKind, nodes: &[usize], points: &[[f64; 2]]) -> f64 {
    let n = kind.n_corners();
    let [x0, y0] = points[nodes[0]];
    let arm = |corner: usize| {
        let [x, y] = points[nodes[corner]];
        [x - x0, y - y0]
    };
    let pairs = (1..n - 1).map(|corner| (arm(corner), arm(corner + 1)));
    pairs.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}
