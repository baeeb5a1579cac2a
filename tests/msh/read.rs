//! Files written by gmsh 4.15 (`tests/data/msh/make.py`), against what gmsh counted itself.

use foil2d::fe::mesh::{CellKind, MeshError};
use foil2d::io::{MshError, MshMesh, MshPlace};
use foil2d::prelude::*;
use foil2d::rapier::prelude::PhysicsWorld;
use std::path::PathBuf;

pub fn path(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/msh");
    PathBuf::from(folder).join(format!("{name}.msh"))
}

fn read(name: &str) -> MshMesh {
    MshMesh::read(path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Area of a cell (m²): that of its corners, and two thirds of chord times sagitta for a side through a midside node.
fn area(msh: &MshMesh, cell: usize) -> f64 {
    let nodes = msh.mesh.nodes();
    let cell = msh.mesh.cell(cell);
    let corners = cell.corners();
    let n = corners.len();
    let cross = |o: [f64; 2], a: [f64; 2], b: [f64; 2]| {
        (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
    };
    let sides = (0..n).map(|side| {
        let (a, b) = (nodes[corners[side]], nodes[corners[(side + 1) % n]]);
        let bulge = cell
            .nodes
            .get(n + side)
            .map_or(0.0, |&midside| 2.0 / 3.0 * cross(a, nodes[midside], b));
        0.5 * cross([0.0, 0.0], a, b) + bulge
    });
    sides.sum()
}

/// Cells and area (m²) of a physical surface, or nodes of a physical curve or point.
enum Fact {
    Region(&'static str, usize, f64),
    Boundary(&'static str, usize),
}
use Fact::{Boundary, Region};

/// Every file, and what gmsh says of it.
fn facts() -> Vec<(&'static [&'static str], CellKind, Vec<Fact>)> {
    let plate = |steel: f64, clamped: usize, hole: usize| {
        vec![
            Region("steel plate", 46, steel),
            Region("rubber", 22, 0.5),
            Boundary("clamped", clamped),
            Boundary("hole", hole),
            Boundary("corner", 1),
        ]
    };
    let beam = || vec![Region("beam", 12, 0.48), Boundary("clamped", 3)];
    vec![
        (
            &[
                "plate_tri3_22_ascii",
                "plate_tri3_22_little",
                "plate_tri3_41_ascii",
                "plate_tri3_41_little",
            ],
            CellKind::Tri3,
            plate(0.459270649404, 5, 8),
        ),
        (
            &[
                "plate_tri6_22_ascii",
                "plate_tri6_41_little",
                "plate_tri6_41_big",
            ],
            CellKind::Tri6,
            plate(0.454796274988, 9, 16),
        ),
        (
            &["grid_quad4_22_little", "grid_quad4_41_ascii"],
            CellKind::Quad4,
            beam(),
        ),
        (
            &["turned_22_little", "turned_41_ascii"],
            CellKind::Quad4,
            beam(),
        ),
        (
            &[
                "strip_mixed_22_ascii",
                "strip_mixed_22_little",
                "strip_mixed_22_big",
                "strip_mixed_41_little",
                "strip_mixed_41_big",
            ],
            CellKind::Quad4,
            vec![
                Region("left", 8, 0.5),
                Region("right", 22, 0.5),
                Region("4", 30, 1.0),
                Boundary("clamped", 3),
                Boundary("tip", 3),
            ],
        ),
    ]
}

/// Areas are told by gmsh to twelve digits.
#[test]
fn regions_and_boundaries_are_what_gmsh_counts() {
    let (mut n_files, mut n_facts) = (0, 0);
    for (names, kind, facts) in facts() {
        for name in names {
            let msh = read(name);
            n_files += 1;
            assert!(msh.mesh.cells().any(|cell| cell.kind == kind), "{name}");
            for fact in &facts {
                n_facts += 1;
                match *fact {
                    Region(region, n_cells, expected) => {
                        let cells = msh.region(region).unwrap_or_default();
                        assert_eq!(cells.len(), n_cells, "{name}: {region}");
                        let found: f64 = cells.iter().map(|&cell| area(&msh, cell)).sum();
                        assert!(
                            (found - expected).abs() < 2e-12,
                            "{name}: {region}: {found}"
                        );
                    }
                    Boundary(boundary, n_nodes) => {
                        let nodes = msh.boundary(boundary).unwrap_or_default();
                        assert_eq!(nodes.len(), n_nodes, "{name}: {boundary}");
                    }
                }
            }
            let n_told = msh.regions.len() + msh.boundaries.len();
            assert_eq!(n_told, facts.len(), "{name} has more groups than gmsh");
            let whole: f64 = (0..msh.mesh.n_cells()).map(|cell| area(&msh, cell)).sum();
            assert!((whole - msh.mesh.area()).abs() < 1e-13, "{name}");
        }
    }
    assert_eq!((n_files, n_facts), (16, 68));
}

/// The boundaries lie where the shapes were drawn; midside nodes of the hole on the circle as well.
#[test]
fn boundaries_lie_where_they_were_drawn() {
    for name in ["plate_tri3_41_little", "plate_tri6_22_ascii"] {
        let msh = read(name);
        let at = |name: &str| -> Vec<[f64; 2]> {
            let nodes = msh.boundary(name).expect("the group is there").iter();
            nodes.map(|&node| msh.mesh.nodes()[node]).collect()
        };
        assert!(at("clamped").iter().all(|[x, _]| *x == 0.0), "{name}");
        let off = |[x, y]: &[f64; 2]| (x - 0.25).hypot(y - 0.5) - 0.12;
        assert!(
            at("hole").iter().all(|point| off(point).abs() < 1e-12),
            "{name}"
        );
        assert_eq!(at("corner"), [[1.0, 1.0]]);
        let hole = msh.boundary("hole").expect("the group is there");
        assert!(
            hole.iter()
                .all(|&node| msh.mesh.boundary().is_boundary(node))
        );
        // The centre of the arcs is a node of no cell.
        let centre = |[x, y]: &[f64; 2]| (*x, *y) == (0.25, 0.5);
        assert!(!msh.mesh.nodes().iter().any(centre), "{name}");
    }
}

/// Nodes of a cell, with the names of the regions it is in.
fn cells_with_regions(msh: &MshMesh) -> Vec<(Vec<usize>, Vec<&str>)> {
    let cell = |cell: usize| {
        let regions = msh.regions.iter();
        let of_cell = regions.filter(|region| region.cells.contains(&cell));
        let names = of_cell.map(|region| region.name.as_str()).collect();
        (msh.mesh.cell(cell).nodes.to_vec(), names)
    };
    let mut cells: Vec<_> = (0..msh.mesh.n_cells()).map(cell).collect();
    cells.sort();
    cells
}

/// Text has 16 digits, so nodes agree to the last one. Gmsh lists mixed cells by type in version 2, by surface in version 4.
#[test]
fn every_encoding_gives_the_same_mesh() {
    for (names, ..) in facts() {
        let first = read(names[0]);
        for name in &names[1..] {
            let other = read(name);
            assert_eq!(other.boundaries, first.boundaries, "{name}");
            let [found, expected] = [&other, &first].map(cells_with_regions);
            assert_eq!(found, expected, "{name}");
            for (a, b) in other.mesh.nodes().iter().zip(first.mesh.nodes()) {
                assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-15, "{name}");
            }
        }
    }
    for stem in ["plate_tri6_41", "strip_mixed_22", "strip_mixed_41"] {
        let [little, big] = ["little", "big"].map(|order| read(&format!("{stem}_{order}")));
        assert_eq!(little, big, "{stem}");
    }
}

#[test]
fn cells_of_a_surface_that_looks_down_are_turned() {
    let [down, up] = ["turned_41_ascii", "grid_quad4_41_ascii"].map(read);
    assert_eq!(down.mesh.n_cells(), up.mesh.n_cells());
    assert!((down.mesh.area() - 0.48).abs() < 1e-14);
    // Six nodes turned over: the midside nodes follow their sides.
    let file = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 5\n2 1 0 5\n3 0 1 5\n4 .5 -.1 5\n5 .6 .6 5\n6 0 .5 5\n$EndNodes\n\
                $Elements\n1\n1 9 2 0 1 1 3 2 6 5 4\n$EndElements\n";
    let msh = MshMesh::from_bytes(file.as_bytes()).expect("the triangle is sound");
    assert_eq!(msh.mesh.cell(0).nodes, [0, 1, 2, 3, 4, 5]);
}

#[test]
fn pieces_become_meshes_of_their_own() {
    let file = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"all\"\n2 2 \"far\"\n$EndPhysicalNames\n\
        $Nodes\n7\n1 0 0 0\n2 1 0 0\n3 0 1 0\n9 0.3 0.3 0\n11 5 0 0\n12 6 0 0\n13 5 1 0\n$EndNodes\n\
        $Elements\n4\n1 2 2 1 1 1 2 3\n2 2 2 1 2 11 12 13\n3 2 2 2 2 11 12 13\n4 1 2 8 2 11 13\n$EndElements\n";
    let error = MshMesh::from_bytes(file).expect_err("a body is one piece");
    let MshError::Mesh { source, nodes, .. } = &error else {
        panic!("{error}");
    };
    assert!(matches!(
        source,
        MeshError::Disconnected { n_pieces: 2, .. }
    ));
    assert_eq!(nodes, &[Some(1), Some(11)]);
    let pieces = MshMesh::pieces_from_bytes(file).expect("both pieces are sound");
    assert_eq!(pieces.len(), 2);
    assert_eq!(pieces[0].region("all"), Some(&[0][..]));
    assert_eq!(pieces[0].region("far"), None);
    assert_eq!(pieces[0].n_dropped_nodes, 4);
    assert_eq!(pieces[1].region("far"), Some(&[0][..]));
    assert_eq!(pieces[1].boundary("8"), Some(&[0, 2][..]));
    assert_eq!(pieces[1].mesh.nodes(), [[5.0, 0.0], [6.0, 0.0], [5.0, 1.0]]);
}

/// A body of the mesh has its mass, and stays where its clamped nodes are.
#[test]
fn a_body_is_made_of_it_and_pinned_by_name() -> Result<(), Box<dyn std::error::Error>> {
    let msh = MshMesh::read(path("strip_mixed_41_little"))?;
    let clamped = msh
        .boundary("clamped")
        .expect("the group is there")
        .to_vec();
    let [tip, _, _] = *msh.boundary("tip").expect("the group is there") else {
        panic!("three nodes at the tip");
    };
    let material = LinearElastic::plane_stress(1e6, 0.3).density(800.0);
    let mut body = FlexBodyBuilder::mesh(msh.mesh)
        .material(material)
        .thickness(0.5);
    for &node in &clamped {
        body = body.pin(node, Pin::both());
    }
    let mut world = PhysicsWorld::new();
    let mut bodies = FlexBodySet::new();
    let handle = bodies.insert(body, &mut world)?;
    let mut pipeline = FlexPipeline::new();
    for _ in 0..5 {
        pipeline.step(&mut world, &mut bodies)?;
    }
    let body = &bodies[handle];
    assert!((body.mass() - 1.0 * 0.5 * 800.0).abs() < 1e-9);
    assert!(
        clamped
            .iter()
            .all(|&node| body.displacement(node) == [0.0, 0.0])
    );
    assert!(body.displacement(tip)[1] < -1e-3);
    Ok(())
}

/// The strip has a group of all its cells besides its two halves.
#[test]
fn groups_become_regions_the_smallest_first() {
    let msh = read("strip_mixed_22_ascii");
    let mesh = msh.mesh_with_regions().expect("names differ");
    for name in ["left", "right"] {
        let number = mesh.region_named(name).expect("it has cells");
        let cells = mesh.cells().enumerate();
        let own: Vec<usize> = cells
            .filter(|(_, cell)| cell.region == number)
            .map(|(index, _)| index)
            .collect();
        assert_eq!(Some(own.as_slice()), msh.region(name), "{name}");
    }
    assert_eq!(mesh.region_named("4"), None, "no cell is left for it");
}

#[test]
fn quadrilaterals_of_eight_nodes_are_those_of_the_library() {
    let msh = read("grid_quad8_41_ascii");
    assert!(msh.mesh.cells().all(|cell| cell.kind == CellKind::Quad8));
    let sum: f64 = (0..msh.mesh.n_cells()).map(|cell| area(&msh, cell)).sum();
    assert!((sum - msh.mesh.area()).abs() < 1e-13);
    // Midside nodes are in the middle of the sides that gmsh drew straight.
    for cell in msh.mesh.cells() {
        for side in 0..4 {
            let at = |local: usize| msh.mesh.nodes()[cell.nodes[local]];
            let [from, to, middle] = [at(side), at((side + 1) % 4), at(4 + side)];
            for axis in 0..2 {
                let mean = 0.5 * (from[axis] + to[axis]);
                assert!((middle[axis] - mean).abs() < 1e-9, "side {side}");
            }
        }
    }
}

#[test]
fn what_is_no_cell_of_the_library_is_told_by_its_name_and_line() {
    let text = std::fs::read_to_string(path("grid_quad8_41_ascii")).expect("it is there");
    // The block of cells, said to have a node in their middle too.
    let text = text.replacen("\n2 1 16 ", "\n2 1 10 ", 1);
    let error = MshMesh::from_bytes(text.as_bytes()).expect_err("no cells of nine nodes");
    let MshError::UnsupportedElement {
        place, name, kind, ..
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!((name, kind), ("9-node quadrilateral", 10));
    assert!(
        matches!(place, MshPlace::Line(line) if line > 70),
        "{place}"
    );
    let error = MshMesh::read(path("no_such_file")).expect_err("it is not there");
    assert!(error.to_string().contains("no_such_file.msh"), "{error}");
}
