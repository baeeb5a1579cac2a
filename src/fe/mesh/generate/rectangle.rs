//! Rectangle `[0, w] x [0, h]`, divided evenly.

use super::{NODE_LIMIT, check_divisions, check_positive, check_size, split};
use crate::fe::mesh::{CellKind, Mesh, MeshError};

/// Meshes a rectangle with its lower left corner at the origin.
///
/// Node `j (n_x + 1) + i` lies at `(i w / n_x, j h / n_y)`; the midside nodes of [`CellKind::Tri6`]
/// and [`CellKind::Quad8`] follow as [`Mesh::to_quadratic`] numbers them. Quadrilateral `j n_x + i` has node `(i, j)` at its
/// lower left; triangles halve the quadrilaterals, two in the place of each, by diagonals that
/// alternate like the colours of a chessboard. With even divisions no triangle has all its corners
/// on the boundary.
///
/// ```text
///  Quad4, divisions [2, 2]       Tri3, divisions [2, 2]
///  6-----7-----8                 6-----7-----8
///  |  2  |  3  |                 | \ 5 | 7 / |
///  |     |     |                 |4  \ | / 6 |
///  3-----4-----5                 3-----4-----5
///  |  0  |  1  |                 | 1 / | \ 3 |
///  |     |     |                 | / 0 |2  \ |
///  0-----1-----2                 0-----1-----2
/// ```
///
/// - `size`: width and height (m).
/// - `divisions`: number of intervals along x and y.
///
/// # Errors
/// [`MeshError::InvalidArgument`] if a size is not positive or a division is zero,
/// [`MeshError::TooManyNodes`].
pub fn rectangle(size: [f64; 2], divisions: [usize; 2], kind: CellKind) -> Result<Mesh, MeshError> {
    check_positive("rectangle width", size[0])?;
    check_positive("rectangle height", size[1])?;
    check_divisions("rectangle divisions along x", divisions[0], 1)?;
    check_divisions("rectangle divisions along y", divisions[1], 1)?;
    let [n_x, n_y] = divisions;
    check_size((n_x as f64 + 1.0) * (n_y as f64 + 1.0), NODE_LIMIT)?;

    let row = n_x + 1;
    let nodes = (0..=n_y).flat_map(|j| {
        (0..=n_x).map(move |i| {
            // the product is divided, not the step multiplied, so that the far sides are exact
            [
                size[0] * i as f64 / n_x as f64,
                size[1] * j as f64 / n_y as f64,
            ]
        })
    });
    let nodes: Vec<[f64; 2]> = nodes.collect();
    let quads = (0..n_y).flat_map(|j| {
        (0..n_x).map(move |i| {
            let corner = j * row + i;
            (
                [corner, corner + 1, corner + row + 1, corner + row],
                (i + j) % 2 == 1,
            )
        })
    });
    if kind.n_corners() == 4 {
        let cells: Vec<[usize; 4]> = quads.map(|(quad, _)| quad).collect();
        let mesh = Mesh::from_cells(nodes, CellKind::Quad4, &cells)?;
        return match kind {
            CellKind::Quad8 => mesh.to_quadratic(),
            _ => Ok(mesh),
        };
    }
    let cells: Vec<[usize; 3]> = quads
        .flat_map(|(quad, flipped)| split(quad, flipped))
        .collect();
    let mesh = Mesh::from_cells(nodes, CellKind::Tri3, &cells)?;
    if kind == CellKind::Tri6 {
        mesh.to_tri6()
    } else {
        Ok(mesh)
    }
}
