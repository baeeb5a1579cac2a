//! Bodies that several tests use.

use foil2d::fe::material::LinearElastic;
use foil2d::fe::mesh::{CellKind, Mesh, generate};
use foil2d::fe::model::{MassKind, Model, ModelDescription};
use std::sync::Arc;

pub const KINDS: [CellKind; 3] = [CellKind::Tri3, CellKind::Quad4, CellKind::Tri6];
pub const MASSES: [MassKind; 2] = [MassKind::Lumped, MassKind::Consistent];

pub fn rectangle(size: [f64; 2], divisions: [usize; 2], kind: CellKind) -> Mesh {
    generate::rectangle(size, divisions, kind).expect("a sound rectangle")
}

/// A body of plane stress, .1 m thick.
pub fn model(mesh: Mesh, material: LinearElastic, mass_kind: MassKind) -> Model {
    describe(mesh, material, mass_kind, Vec::new())
}

pub fn describe(
    mesh: Mesh,
    material: LinearElastic,
    mass_kind: MassKind,
    massless: Vec<bool>,
) -> Model {
    Model::assemble(ModelDescription {
        rest_positions: mesh.nodes().iter().flatten().copied().collect(),
        placed_positions: Vec::new(),
        mesh: Arc::new(mesh),
        elements: Vec::new(),
        material: Arc::new(material),
        regions: Vec::new(),
        thickness: 0.1,
        mass_kind,
        massless,
        held: Vec::new(),
    })
    .expect("a sound mesh")
}

pub fn soft(poisson: f64) -> LinearElastic {
    LinearElastic::plane_stress(2e6, poisson).density(1200.0)
}

/// Holds both dofs of nodes that are chosen.
pub fn held(mesh: &Mesh, is_chosen: impl Fn([f64; 2]) -> bool) -> Vec<bool> {
    let nodes = mesh.nodes().iter();
    nodes.flat_map(|&x| [is_chosen(x); 2]).collect()
}

/// A mesh whose nodes are moved by a map.
pub fn mapped(mesh: &Mesh, kind: CellKind, map: impl Fn([f64; 2]) -> [f64; 2]) -> Mesh {
    let nodes: Vec<[f64; 2]> = mesh.nodes().iter().map(|&x| map(x)).collect();
    let cells: Vec<&[usize]> = mesh.cells().map(|cell| cell.nodes).collect();
    Mesh::from_cells(nodes, kind, &cells).expect("a sound mesh")
}

/// Fails unless `|found/expected - 1|` is within a tolerance.
#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let error = found / expected - 1.0;
    println!("{what}: {found:.8} for {expected:.8}, {error:+.2e}");
    assert!(
        error.abs() <= tolerance,
        "{what}: {found} for {expected}, {error:e}"
    );
}
