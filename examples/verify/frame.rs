//! The mesh of Lee's frame, for the book and for tests.

use foil2d::fe::mesh::{CellKind, Mesh, MeshError};

/// A frame of two legs 120 long and `thick` thick, their centre lines from (0, 0) and (120, 120) meeting at (0, 120): six-node triangles, one
/// cell across and so many along each leg.
///
/// A multiple of five puts a node at 24 from the corner.
///
/// # Errors
/// If there is no such mesh.
pub fn frame(thick: f64, n_sections: u32) -> Result<Mesh, MeshError> {
    let half = 0.5 * thick;
    // Sections along a leg, from its hinge to the edge of the corner.
    let along: Vec<f64> = (0..n_sections)
        .map(|k| 120.0 * f64::from(k) / f64::from(n_sections))
        .chain([120.0 - half])
        .collect();
    let upright = along.iter().map(|&y| [[half, y], [-half, y]]);
    let level = along
        .iter()
        .rev()
        .map(|&s| [[120.0 - s, 120.0 - half], [120.0 - s, 120.0 + half]]);
    let nodes: Vec<[f64; 2]> = upright
        .chain(level)
        .flatten()
        .chain([[-half, 120.0 + half]])
        .collect();
    let n = along.len();
    let mut cells = Vec::new();
    let mut add = |[a, b, c, d]: [usize; 4]| cells.extend([[a, b, c], [a, c, d]]);
    for k in 0..n - 1 {
        // Upright: right and left below, left and right above; level: lower and upper, to the right of both.
        add([2 * k + 1, 2 * k, 2 * k + 2, 2 * k + 3]);
        let at = 2 * (n + k);
        add([at, at + 2, at + 3, at + 1]);
    }
    // The corner's lower right node is that of both legs.
    let (right, left, upper) = (2 * n - 2, 2 * n - 1, 2 * n + 1);
    add([left, right, upper, 4 * n]);
    let merged = |node: usize| {
        if node == 2 * n {
            right
        } else {
            node - usize::from(node > 2 * n)
        }
    };
    let cells: Vec<[usize; 3]> = cells.into_iter().map(|cell| cell.map(merged)).collect();
    let mut nodes = nodes;
    nodes.remove(2 * n);
    let mesh = Mesh::from_cells(nodes, CellKind::Tri3, &cells)?;
    mesh.to_tri6()
}
