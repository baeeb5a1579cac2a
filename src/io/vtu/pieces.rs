//! Bodies and contacts as pieces of unstructured grids.

use super::xml::{Array, Piece, Values};
use crate::body::FlexBody;
use crate::fe::mesh::CellKind;
use crate::fe::model::ModelError;
use crate::io::scene::RigidShape;
use crate::io::stress::world_stress;
use crate::pipeline::ContactReport;

/// VTK's numbers of cells that are not of a mesh.
const VERTEX: u8 = 1;
const POLY_LINE: u8 = 4;
const POLYGON: u8 = 7;

/// VTK lists the nodes of all of these as [`CellKind`] does.
const fn vtk_type(kind: CellKind) -> u8 {
    match kind {
        CellKind::Tri3 => 5,
        CellKind::Quad4 => 9,
        CellKind::Tri6 => 22,
        CellKind::Quad8 => 23,
    }
}

impl Piece {
    fn push_cell(&mut self, kind: u8, nodes: impl Iterator<Item = usize>) {
        self.connectivity.extend(nodes.map(|node| node as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.types.push(kind);
    }
}

/// A flexible body; `index` is told at its cells.
pub(super) fn flexible(body: &FlexBody, index: u32) -> Result<Piece, ModelError> {
    let nodes = || 0..body.n_nodes();
    let mut piece = Piece {
        points: nodes().map(|node| body.position(node)).collect(),
        ..Piece::default()
    };
    for cell in body.mesh().cells() {
        piece.push_cell(vtk_type(cell.kind), cell.nodes.iter().copied());
    }
    let stresses = world_stress(body)?;
    let tensors = stresses
        .iter()
        .flat_map(|s| [s.xx, s.yy, s.zz, s.xy, 0.0, 0.0]);
    let tensors = Array {
        name: "cauchy_stress",
        n_components: 6,
        values: Values::Real(tensors.collect()),
    };
    let von_mises = stresses.iter().map(|stress| stress.von_mises()).collect();
    piece.at_points = vec![
        Array::vectors("displacement", nodes().map(|node| body.displacement(node))),
        Array::vectors("velocity", nodes().map(|node| body.velocity(node))),
        tensors,
        Array::scalars("von_mises", von_mises),
        Array::vectors(
            "contact_force",
            nodes().map(|node| body.contact_force(node)),
        ),
        Array::vectors("reaction", nodes().map(|node| body.reaction(node))),
        Array::integers("node", nodes().map(|node| node as i64).collect()),
    ];
    piece.at_cells = vec![Array::integers(
        "body",
        vec![i64::from(index); piece.types.len()],
    )];
    Ok(piece)
}

/// A rigid collider.
pub(super) fn rigid(shape: &RigidShape) -> Piece {
    let mut piece = Piece::default();
    for line in &shape.lines {
        let first = piece.points.len();
        let points = line.points.iter().map(|&point| shape.place(point));
        piece.points.extend(points);
        let kind = if line.is_closed { POLYGON } else { POLY_LINE };
        piece.push_cell(kind, first..first + line.points.len());
    }
    let n_cells = piece.types.len();
    let velocities = piece.points.iter().map(|&point| shape.velocity(point));
    piece.at_points = vec![Array::vectors("velocity", velocities)];
    let (index, _) = shape.collider.into_raw_parts();
    piece.at_cells = vec![
        Array::integers("collider", vec![i64::from(index); n_cells]),
        Array::vectors("contact_force", (0..n_cells).map(|_| shape.force)),
    ];
    piece
}

/// All contacts of a step.
pub(super) fn contacts(contacts: &[ContactReport]) -> Piece {
    let mut piece = Piece {
        points: contacts.iter().map(|contact| contact.position).collect(),
        ..Piece::default()
    };
    for point in 0..contacts.len() {
        piece.push_cell(VERTEX, std::iter::once(point));
    }
    piece.at_points = vec![
        Array::vectors("force", contacts.iter().map(ContactReport::force)),
        Array::vectors("normal", contacts.iter().map(|contact| contact.normal)),
        Array::scalars("gap", contacts.iter().map(|contact| contact.gap).collect()),
    ];
    piece
}
