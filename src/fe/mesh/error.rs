//! What can be wrong with a mesh or with the data of a generator.

use super::CellKind;

/// Why a mesh was refused, with the numbers needed to find the culprit and what to do about it.
///
/// Lengths are in m, areas and Jacobians in m^2. Rings of an outline are counted with the outline
/// as ring 0 and the holes after it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// The node list is empty.
    #[error("the mesh has no nodes: give at least the corners of one cell")]
    NoNodes,
    /// The cell list is empty.
    #[error("the mesh has no cells: give at least one cell")]
    NoCells,
    /// A cell lists too few or too many nodes for its kind.
    #[error("cell {cell} is a {kind} and needs {expected} nodes, but lists {found}")]
    WrongNodeCount {
        /// Index of the cell.
        cell: usize,
        /// Kind of the cell.
        kind: CellKind,
        /// Nodes the kind has.
        expected: usize,
        /// Nodes the cell lists.
        found: usize,
    },
    /// A cell names a node that does not exist.
    #[error(
        "cell {cell} names node {node}, but the mesh has {n_nodes} nodes: count nodes from zero"
    )]
    NodeOutOfRange {
        /// Index of the cell.
        cell: usize,
        /// The missing node.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A cell names the same node twice.
    #[error("cell {cell} names node {node} twice: list every node of a cell once")]
    RepeatedNode {
        /// Index of the cell.
        cell: usize,
        /// The repeated node.
        node: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("node {node} lies at ({}, {}) m: coordinates must be finite", .at[0], .at[1])]
    NonFiniteNode {
        /// Index of the node.
        node: usize,
        /// Its coordinates (m).
        at: [f64; 2],
    },
    /// A node belongs to no cell.
    #[error("node {node} belongs to no cell: remove it, for it would have no mass")]
    OrphanNode {
        /// Index of the node.
        node: usize,
    },
    /// Two nodes lie at the same place.
    #[error("nodes {first} and {second} both lie at ({}, {}) m: merge them", .at[0], .at[1])]
    CoincidentNodes {
        /// The lower index.
        first: usize,
        /// The higher index.
        second: usize,
        /// Where they lie (m).
        at: [f64; 2],
    },
    /// A cell has next to no area for its size.
    #[error("cell {cell} has area {area:e} m^2 but edges up to {size:e} m: remove or reshape it")]
    DegenerateCell {
        /// Index of the cell.
        cell: usize,
        /// Signed area (m^2).
        area: f64,
        /// Longest side between corners (m).
        size: f64,
    },
    /// A cell has negative area.
    #[error("cell {cell} has area {area:e} m^2: list its nodes counter-clockwise")]
    InvertedCell {
        /// Index of the cell.
        cell: usize,
        /// Signed area (m^2).
        area: f64,
    },
    /// A cell of positive area is folded at one of its nodes.
    #[error(
        "cell {cell} ({kind}) has Jacobian {jacobian:e} m^2 at node {node}: make a quadrilateral \
         convex, or move the midside nodes of a triangle nearer to the middle of its sides"
    )]
    FoldedCell {
        /// Index of the cell.
        cell: usize,
        /// Kind of the cell.
        kind: CellKind,
        /// Index of the node in the mesh.
        node: usize,
        /// Determinant of the Jacobian there (m^2).
        jacobian: f64,
    },
    /// More than two cells share an edge.
    #[error("edge {a}-{b} is shared by {n_cells} cells: at most two cells can meet at an edge")]
    NonManifoldEdge {
        /// One end.
        a: usize,
        /// Other end.
        b: usize,
        /// Number of cells at the edge.
        n_cells: usize,
    },
    /// Two cells lie on the same side of an edge.
    #[error("cells {first} and {second} lie on the same side of edge {a}-{b} and overlap")]
    OverlappingCells {
        /// The lower cell.
        first: usize,
        /// The higher cell.
        second: usize,
        /// Start of the edge, the cells being on its left.
        a: usize,
        /// End of the edge.
        b: usize,
    },
    /// Two cells at an edge disagree about its midside node.
    #[error(
        "cells {first} and {second} share edge {a}-{b} but not its midside node: use cells with \
         the same number of nodes on a shared edge"
    )]
    MismatchedMidside {
        /// The lower cell.
        first: usize,
        /// The higher cell.
        second: usize,
        /// One end of the edge.
        a: usize,
        /// Other end of the edge.
        b: usize,
    },
    /// A midside node is used in a second role.
    #[error(
        "node {node} is a midside node of one edge and a corner or midside node elsewhere: give \
         each edge a midside node of its own"
    )]
    HangingNode {
        /// Index of the node.
        node: usize,
    },
    /// The boundary passes a node more than once.
    #[error(
        "the boundary passes node {node} more than once, so that the body hangs together in a \
         point there: add a cell that bridges it or give each part a node of its own"
    )]
    TouchingLoops {
        /// Index of the node.
        node: usize,
    },
    /// The mesh falls apart.
    #[error(
        "the mesh has {n_pieces} pieces (nodes {first} and {second} are not connected): make each \
         piece a mesh, and a body, of its own"
    )]
    Disconnected {
        /// Number of pieces.
        n_pieces: usize,
        /// A node of the first piece.
        first: usize,
        /// A node of another piece.
        second: usize,
    },
    /// The boundary meets itself.
    #[error(
        "boundary segments {}-{} and {}-{} meet at ({:e}, {:e}) m: move the nodes apart, the body \
         may not overlap itself", .first[0], .first[1], .second[0], .second[1], .at[0], .at[1]
    )]
    BoundaryCrossing {
        /// Nodes of one segment.
        first: [usize; 2],
        /// Nodes of the other segment.
        second: [usize; 2],
        /// Where they meet (m).
        at: [f64; 2],
    },
    /// Several loops run counter-clockwise, so that the mesh covers some points twice.
    #[error(
        "{n_outer} boundary loops run counter-clockwise, through nodes {first} and {second}: the \
         cells overlap like the turns of a winding stair, unwind them"
    )]
    SeveralOuterLoops {
        /// Number of counter-clockwise loops.
        n_outer: usize,
        /// A node of one of them.
        first: usize,
        /// A node of another one.
        second: usize,
    },
    /// Cells with midside nodes cannot be given any.
    #[error("cell {cell} is a {kind}: only Tri3 and Quad4 cells can be given midside nodes")]
    NotLinear {
        /// Index of the cell.
        cell: usize,
        /// Its kind.
        kind: CellKind,
    },
    /// Only meshes of 3-node triangles can be turned into 6-node ones.
    #[error("cell {cell} is a {kind}: only meshes of Tri3 cells can be turned into Tri6")]
    NotTri3 {
        /// Index of the cell.
        cell: usize,
        /// Its kind.
        kind: CellKind,
    },
    /// A number given to a generator is out of range.
    #[error("{name} is {value}, but must be {requirement}")]
    InvalidArgument {
        /// Name of the argument.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it has to satisfy.
        requirement: &'static str,
    },
    /// A generator would make, or has made, more nodes than allowed.
    #[error("the mesh needs about {n_nodes} nodes, the limit is {limit}: use a longer target edge")]
    TooManyNodes {
        /// Estimate, or count at which the generator stopped.
        n_nodes: usize,
        /// The limit.
        limit: usize,
    },
    /// A ring of an outline has fewer than three points.
    #[error("ring {ring} has {n_points} points: an outline needs at least three")]
    TooFewPoints {
        /// Index of the ring.
        ring: usize,
        /// Its number of points.
        n_points: usize,
    },
    /// A point of an outline is not finite.
    #[error("point {point} of ring {ring} lies at ({}, {}) m: coordinates must be finite", .at[0], .at[1])]
    NonFinitePoint {
        /// Index of the ring.
        ring: usize,
        /// Index of the point in the ring.
        point: usize,
        /// Its coordinates (m).
        at: [f64; 2],
    },
    /// A point of an outline repeats the one before it.
    #[error(
        "point {point} of ring {ring} repeats the point before it: list each point once and do \
         not repeat the first one at the end"
    )]
    RepeatedPoint {
        /// Index of the ring.
        ring: usize,
        /// Index of the point in the ring.
        point: usize,
    },
    /// Edges of the outline and of the holes cross or touch.
    #[error(
        "edge {} of ring {} and edge {} of ring {} meet at ({:e}, {:e}) m: outline and holes must \
         be simple and apart", .edges[0], .rings[0], .edges[1], .rings[1], .at[0], .at[1]
    )]
    OutlineCrossing {
        /// Rings of the two edges.
        rings: [usize; 2],
        /// Index, in its ring, of the point at which each edge starts.
        edges: [usize; 2],
        /// Where they meet (m).
        at: [f64; 2],
    },
    /// A hole lies outside the outline.
    #[error("hole {hole} lies outside the outline: remove it or move it inside")]
    HoleOutside {
        /// Index of the hole.
        hole: usize,
    },
    /// A hole lies within another hole.
    #[error("hole {inner} lies within hole {outer}: make the island a mesh of its own")]
    NestedHole {
        /// Index of the enclosed hole.
        inner: usize,
        /// Index of the enclosing hole.
        outer: usize,
    },
    /// Delaunay refinement stopped at the node limit before every angle was large enough.
    #[error(
        "refinement was not finished with {limit} nodes: lower the minimum angle ({min_angle} deg), \
         use a longer target edge or raise the limit"
    )]
    RefinementIncomplete {
        /// The node limit.
        limit: usize,
        /// The minimum angle asked for (deg).
        min_angle: f64,
    },
    /// The triangulator refused the points.
    #[error("the outline could not be triangulated: {reason}")]
    Triangulation {
        /// What the triangulator said.
        reason: String,
    },
    /// There is not one region per cell.
    #[error("{found} regions were given for {expected} cells: give one per cell")]
    RegionCount {
        /// Numbers given.
        found: usize,
        /// Cells of the mesh.
        expected: usize,
    },
    /// A region without cells was named.
    #[error("no cell is in region {region}: put some into it by `with_regions` first")]
    NoRegion {
        /// The region.
        region: u32,
    },
    /// Two regions were given one name.
    #[error("regions {} and {} are both named `{name}`: give each its own name", .regions[0], .regions[1])]
    RegionName {
        /// The name.
        name: String,
        /// The region that has it, and the one that was to get it.
        regions: [u32; 2],
    },
}
