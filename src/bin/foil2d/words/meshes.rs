//! What is wrong with a mesh or an outline.

use foil2d::fe::mesh::MeshError;

/// Memory of a node of a body of large strain (bytes), factors of its matrices included: 5.5e3 were measured on 40,000 nodes of a square on a floor.
const BYTES_OF_A_NODE: f64 = 6e3;

/// What of a shape is at fault.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum MeshCulprit {
    /// The outline is ring 0, holes follow.
    Ring(usize),
    /// The length of edges.
    Edge,
    All,
}

/// Says that a mesh is too large.
pub fn too_many_nodes(n_nodes: f64, most_nodes: usize) -> String {
    let gigabytes = BYTES_OF_A_NODE * n_nodes / 1e9;
    let memory = match gigabytes {
        0.0..0.1 => String::new(),
        0.1..1e4 => format!(", where there are some {gigabytes:.1} GB of memory for them"),
        _ => ", but there is no memory for so many".to_owned(),
    };
    format!(
        "about {} nodes are needed where {most_nodes} are left of `most_nodes`: take larger cells, or raise `most_nodes`{memory}",
        rounded(n_nodes)
    )
}

/// A number, without digits that nobody reads.
pub fn rounded(number: f64) -> String {
    match number.abs() {
        0.0..1e3 if number.fract() != 0.0 => format!("{number:.1}"),
        0.0..1e9 => format!("{number:.0}"),
        _ => format!("{number:.1e}"),
    }
}

/// What is wrong, and with what.
pub fn of_mesh(error: &MeshError) -> (MeshCulprit, String) {
    let ring = |ring: usize| match ring {
        0 => "the outline".to_owned(),
        hole => format!("hole {hole}"),
    };
    match error {
        MeshError::TooFewPoints {
            ring: index,
            n_points,
        } => (
            MeshCulprit::Ring(*index),
            format!("{} has {n_points} points: give three or more", ring(*index)),
        ),
        MeshError::NonFinitePoint {
            ring: index,
            point,
            at: [x, y],
        } => (
            MeshCulprit::Ring(*index),
            format!(
                "point {} of {} lies at ({x:?}, {y:?}) m: coordinates must be finite, and up to 1e18",
                point + 1,
                ring(*index)
            ),
        ),
        MeshError::RepeatedPoint { ring: index, point } => (
            MeshCulprit::Ring(*index),
            format!(
                "point {} of {} repeats the one before it: give each once, and not the first again at the end",
                point + 1,
                ring(*index)
            ),
        ),
        MeshError::OutlineCrossing {
            rings: [one, other],
            at: [x, y],
            ..
        } => {
            let what = match one == other {
                true => format!("{} meets itself", ring(*one)),
                false => format!("{} and {} meet", ring(*one), ring(*other)),
            };
            let what =
                format!("{what} at ({x:.6}, {y:.6}) m: outline and holes must be simple and apart");
            (MeshCulprit::Ring(*one.max(other)), what)
        }
        MeshError::HoleOutside { hole } => (
            MeshCulprit::Ring(hole + 1),
            format!(
                "hole {} lies outside of the outline: leave it out, or move it inside",
                hole + 1
            ),
        ),
        MeshError::NestedHole { inner, outer } => (
            MeshCulprit::Ring(inner + 1),
            format!(
                "hole {} lies within hole {}: make what is between a body of its own",
                inner + 1,
                outer + 1
            ),
        ),
        // Midside nodes make four of each.
        MeshError::TooManyNodes { n_nodes, limit } => (
            MeshCulprit::Edge,
            too_many_nodes(4.0 * *n_nodes as f64, limit.saturating_mul(4)),
        ),
        MeshError::RefinementIncomplete { limit, .. } => (
            MeshCulprit::Edge,
            format!(
                "no good mesh was found with {} nodes: take longer edges, smooth the outline where it has sharp corners, or raise `most_nodes`",
                limit.saturating_mul(4)
            ),
        ),
        MeshError::FoldedCell { .. } => (
            MeshCulprit::All,
            format!("{error}; where cells are made of an edge's length, take a shorter one"),
        ),
        error => (MeshCulprit::All, error.to_string()),
    }
}
