//! What may be wrong with a file of gmsh.

use crate::fe::mesh::MeshError;
use std::fmt;
use std::path::PathBuf;
use thiserror::Error;

/// Where in a file: lines where it is text, bytes where its numbers are binary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MshPlace {
    /// Line, from 1.
    Line(usize),
    /// Byte, from 0.
    Byte(usize),
}

impl fmt::Display for MshPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Why a file of gmsh gives no mesh.
#[derive(Debug, Error)]
pub enum MshError {
    /// The file could not be read.
    #[error("{} cannot be read: {source}", .path.display())]
    Unreadable {
        /// Its path.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// Something else stands where the format asks for a number, a name or the mark of a section.
    #[error("{place}: expected {expected}, found `{found}`")]
    Unexpected {
        /// Where.
        place: MshPlace,
        /// What the format asks for.
        expected: &'static str,
        /// What stands there, shortened.
        found: String,
    },
    /// The file ends too early.
    #[error("{place}: the file ends where {expected} should be: write it again, it has been cut")]
    Cut {
        /// Where.
        place: MshPlace,
        /// What the format asks for.
        expected: &'static str,
    },
    /// The file is of a version that is not read.
    #[error(
        "line 2: version {version} of the format is not read: let gmsh write 4.1 or 2.2 (Mesh.MshFileVersion = 4.1)"
    )]
    Version {
        /// The version, as it is written.
        version: String,
    },
    /// The file has no section that a mesh needs.
    #[error(
        "the file has no section {section}: let gmsh mesh the surfaces before it writes (gmsh -2)"
    )]
    MissingSection {
        /// Name of the section.
        section: &'static str,
    },
    /// A section is not read, and without it the mesh would be another.
    #[error("{place}: section {section} is not read: {cure}")]
    UnsupportedSection {
        /// Where.
        place: MshPlace,
        /// Name of the section.
        section: &'static str,
        /// What to do.
        cure: &'static str,
    },
    /// An element is of a type that is not in the library.
    #[error("{place}: element {tag} is a {name} (gmsh's type {kind}): {cure}")]
    UnsupportedElement {
        /// Where.
        place: MshPlace,
        /// Gmsh's number of the element.
        tag: u64,
        /// Name of the type.
        name: &'static str,
        /// Gmsh's number of the type.
        kind: i64,
        /// What to do.
        cure: &'static str,
    },
    /// Two nodes have the same number.
    #[error("{place}: node {tag} is there twice: give each node a number of its own")]
    RepeatedNode {
        /// Where the second stands.
        place: MshPlace,
        /// Gmsh's number of the node.
        tag: u64,
    },
    /// An element names a node that does not exist.
    #[error("{place}: element {tag} names node {node}, which the file does not have")]
    MissingNode {
        /// Where.
        place: MshPlace,
        /// Gmsh's number of the element.
        tag: u64,
        /// Gmsh's number of the node.
        node: u64,
    },
    /// The cells do not lie in a plane of constant z.
    #[error(
        "{place}: node {tag} lies at z = {z} m, others at {other} m: the mesh must lie in a plane of constant z"
    )]
    NotPlane {
        /// Where.
        place: MshPlace,
        /// Gmsh's number of the node.
        tag: u64,
        /// Its z (m).
        z: f64,
        /// That of the first node (m).
        other: f64,
    },
    /// There are no cells of two dimensions.
    #[error(
        "the file has no triangles and no quadrilaterals: mesh the surfaces (gmsh -2), and put them into physical groups if there are any"
    )]
    NoCells,
    /// The mesh is none that a body can be made of; cells and nodes are counted as in the file, without what is dropped.
    #[error("{source}{}", in_gmsh(*.element, *.nodes))]
    Mesh {
        /// What is wrong.
        source: MeshError,
        /// Gmsh's number of the element it is about.
        element: Option<u64>,
        /// Gmsh's numbers of the nodes it is about.
        nodes: [Option<u64>; 2],
    },
}

fn in_gmsh(element: Option<u64>, nodes: [Option<u64>; 2]) -> String {
    let element = element.map(|tag| format!("element {tag}"));
    let nodes = nodes.into_iter().flatten().map(|tag| format!("node {tag}"));
    let all: Vec<String> = element.into_iter().chain(nodes).collect();
    if all.is_empty() {
        return String::new();
    }
    format!(" (in the file: {})", all.join(", "))
}
